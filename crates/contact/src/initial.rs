//! Surfaces that overlap before anything has moved, and what is done about it.

use carom_mesh::{Bounds, Face};

use crate::{Contact, Near, Pairing, Places, Point, Search, Sliding, Target};

/// What is done about points that penetrate at the start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Initial {
    /// Nothing: the law pushes them out.
    #[default]
    Keep,
    /// Where surfaces touch, negative mean gaps of multipliers count from where they are ([`Contact::offset_touching`]). What
    /// penetrates is kept: the caller refuses it.
    Touch,
    /// The model is refused, but not for surfaces that touch.
    Refuse,
    /// Their gaps count from where they are: the overlap stays and carries no force ([`Contact::offsets`]).
    Offset,
    /// Their nodes are moved onto the other surface before bodies are built: the mesh changes, no stress arises.
    Remove,
    /// All gaps are this one (m) in the reference position, wherever the surfaces are: a clearance that the mesh does not show.
    Gap(f64),
    /// All gaps are larger by this (m) than the surfaces say.
    Further(f64),
}

/// A point that penetrates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Penetration {
    /// Its place in [`Contact::points`].
    pub point: usize,
    /// Its node, or the node nearest to it, by system number.
    pub node: u32,
    /// Depth -g, m, positive.
    pub depth: f64,
    /// Unit normal out of what is penetrated: the point is free once it has moved by `depth` along it.
    pub normal: [f64; 3],
}

impl Contact {
    /// The points that penetrate by more than `slack` (m) at a configuration, in their order.
    ///
    /// The gap of a multiplier of the dual basis is a mean with weights of both signs: of surfaces that touch and part as
    /// x²/2R over faces of length h it is -h²/12R at the node that touches. A multiplier therefore penetrates only where a
    /// place of the surface that it averages over does ([`Contact::offset_touching`] for the others).
    pub fn penetrations(&self, places: &Places, slack: f64) -> Vec<Penetration> {
        self.below(places, slack, true)
    }

    /// Takes the gaps below `-slack` (m) at a configuration as zero from now on, those of surfaces that touch too.
    pub fn offset_penetrations(&mut self, places: &Places, slack: f64) {
        self.offset_all(self.below(places, slack, true));
        self.offset_touching(places, slack);
    }

    /// Takes the mean gaps below `-slack` (m) at a configuration as zero from now on where no place of the surface penetrates
    /// by that much.
    pub fn offset_touching(&mut self, places: &Places, slack: f64) {
        self.offset_all(self.below(places, slack, false));
    }

    /// Makes the gap of all points that face something `gap` (m) at these places.
    pub fn offset_to(&mut self, places: &Places, gap: f64) {
        let mut pairing = Pairing::default();
        pairing.clear();
        self.pair_fully(places, &mut Search::default(), &mut pairing);
        let rows = &pairing.rows;
        let facing = (0..rows.len()).filter(|&point| rows.gap(point).is_finite());
        let found = facing.map(|point| Penetration {
            point,
            node: self.points[point].node(),
            depth: gap - rows.gap(point),
            normal: rows.normal(point),
        });
        self.offset_all(found.collect());
    }

    /// Makes all gaps larger by `distance` (m).
    pub fn offset_by(&mut self, distance: f64) {
        self.offsets.resize(self.points.len(), 0.0);
        for offset in &mut self.offsets {
            *offset += distance;
        }
    }

    fn offset_all(&mut self, found: Vec<Penetration>) {
        for found in found {
            self.offsets.resize(self.points.len(), 0.0);
            self.offsets[found.point] += found.depth;
        }
    }

    /// The points with a gap below `-slack` around which some place, or no place, is as deep.
    fn below(&self, places: &Places, slack: f64, deep: bool) -> Vec<Penetration> {
        if self.is_apart(places) {
            return Vec::new();
        }
        let pairing = self.pair_deep(places);
        let rows = &pairing.rows;
        let below = (0..rows.len()).filter(|&point| rows.gap(point) < -slack);
        let least = |point: usize| pairing.least_gap(point) + self.offset(point);
        let kept = below.filter(|&point| (least(point) < -slack) == deep);
        kept.map(|point| Penetration {
            point,
            node: self.points[point].node(),
            depth: -rows.gap(point),
            normal: rows.normal(point),
        })
        .collect()
    }
}

impl Contact {
    /// Whether no point can be as deep as it may, since the boxes of both sides are apart by more.
    fn is_apart(&self, places: &Places) -> bool {
        let (Some(sight), Target::Surface(faces)) = (&self.sight, &self.target) else {
            return false;
        };
        let both = self.looks_both_ways();
        let flat = |face: &Face| !face.kind.table().is_quadratic();
        if self.mortar.is_some() || sight.has_both_sides() && !both || !faces.iter().all(flat) {
            return false;
        }
        let of_points = |on_primary: bool| {
            let points = self.points.iter();
            let own = points.filter(move |point| point.is_on_primary() == on_primary);
            let nodes = own.flat_map(Point::carriers);
            nodes.map(|(node, _)| places.of(node)).collect()
        };
        let own: Vec<[f64; 3]> = of_points(false);
        let other = match both {
            true => of_points(true),
            false => {
                let nodes = faces.iter().flat_map(Face::corners);
                nodes.map(|&node| places.of(node)).collect()
            }
        };
        let [own, other] = [own, other].map(|places| Bounds::of(&places));
        own.apart(&other) > sight.deepest() + self.thickest()
    }

    /// A pairing that has at least the points that penetrate: with a sight nothing counts that is deeper than its depth.
    fn pair_deep(&self, places: &Places) -> Pairing {
        let (mut pairing, mut search) = (Pairing::default(), Search::default());
        match &self.sight {
            Some(sight) if self.mortar.is_none() && self.sliding == Sliding::Finite => {
                pairing.open_all(std::slice::from_ref(self), places.dim());
                let near = Near {
                    first: 0,
                    reach: sight.deepest(),
                    step: None,
                    start: None,
                    inside: &|_| false,
                    initial: &Pairing::default(),
                    own: None,
                };
                self.pair_near(places, &mut search, &near, &mut pairing);
            }
            _ => {
                pairing.clear();
                self.pair_fully(places, &mut search, &mut pairing);
            }
        }
        pairing
    }
}

#[cfg(test)]
mod tests {
    use carom_algebra::unknowns::Unknowns;

    use super::*;
    use crate::Frames;
    use crate::law::Displacement;
    use crate::{Integration, Law, Plane, Point, Sliding, Target};

    #[test]
    fn penetrations_are_found_and_become_gaps_of_zero_that_move_on() {
        let floor = Plane {
            point: [0.0; 3],
            normal: [0.0, 1.0, 0.0],
        };
        let mut contact = Contact {
            name: "floor".into(),
            law: Law::Displacement(Displacement::default()),
            sliding: Sliding::Finite,
            integration: Integration::Node,
            points: (0..3).map(|k| Point::at_node(k, 1.0, 1.0 / 3.0)).collect(),
            mortar: None,
            target: Target::Rigid(floor.into()),
            sight: None,
            edges: None,
            offsets: Vec::new(),
            near_only: false,
        };
        let x = [[0.0, 0.5, 0.0], [1.0, -0.25, 0.0], [2.0, -1e-12, 0.0]];
        let places = Places {
            unknowns: &Unknowns::translations(2, 3),
            time: 0.0,
            x: &x,
            u: &[0.0; 6],
            frames: Frames::default(),
        };
        let expected = Penetration {
            point: 1,
            node: 1,
            depth: 0.25,
            normal: floor.normal,
        };
        assert_eq!(contact.penetrations(&places, 1e-9), [expected]);
        contact.offset_penetrations(&places, 1e-9);
        assert_eq!(contact.offsets, [0.0, 0.25, 0.0]);
        assert_eq!(contact.penetrations(&places, 1e-9), []);
        let places = Places {
            u: &[0.0, 0.0, 0.0, -0.5, 0.0, 0.0],
            ..places
        };
        let found = contact.penetrations(&places, 1e-9);
        assert_eq!((found.len(), found[0].depth), (1, 0.5));
    }
}
