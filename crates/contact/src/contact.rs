//! One contact: secondary points that carry the forces, what they face, and the law between them.

use carom_elements::MAX_FACE_NODES;
use carom_mesh::{Face, Projection};

use crate::sight::View;
use crate::{
    Basis, Distance, Held, Law, Mortar, Obstacle, Places, Point, Rows, Search, Shape, Sight,
};

/// What the secondary points face.
#[derive(Clone, Debug, PartialEq)]
pub enum Target {
    /// Faces of deformable bodies, their nodes by system number; normals point out of the bodies.
    Surface(Vec<Face>),
    /// A rigid obstacle.
    Rigid(Obstacle),
}

/// How far bodies slide along each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sliding {
    /// Much less than an element: points are paired once, where all nodes are at their reference places, and their rows and
    /// responses kept. Of an obstacle that moves, with the obstacle where it is now.
    Small,
    /// Any distance: points are paired anew at every step.
    Finite,
}

/// Where the law holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Integration {
    /// At the nodes of the secondary surface: collocation.
    Node,
    /// At the Gauss points of its faces, in each by itself: for laws that give the pressure as a function.
    Points,
    /// In the weak form with a multiplier at the nodes and a sign at each Gauss point: for exact laws.
    Weak {
        /// r of the augmented pressure p - r q, in Pa/m for a law in the gap, in Pa s/m for one in the rate.
        r: f64,
    },
    /// At the corners of the faces in the mean: the weak gap of each multiplier, segment to segment.
    Mortar {
        /// Shape functions of the multipliers.
        basis: Basis,
    },
}

/// A frictionless contact.
#[derive(Clone, Debug)]
pub struct Contact {
    /// Name as in the case file.
    pub name: String,
    /// The law.
    pub law: Law,
    /// Extent of the sliding.
    pub sliding: Sliding,
    /// Where the law holds.
    pub integration: Integration,
    /// Secondary points: nodes, or Gauss points.
    pub points: Vec<Point>,
    /// Faces of the secondary surface, where integration is by mortar; the points are then its own.
    pub mortar: Option<Mortar>,
    /// What they face.
    pub target: Target,
    /// What they see of it; `None` for everything: each point then faces the closest face.
    pub sight: Option<Sight>,
    /// What is added to the gap of each point, m: initial penetrations that are to count as contact without any
    /// ([`Initial::Offset`](crate::Initial)). Empty for none.
    pub offsets: Vec<f64>,
}

impl Contact {
    /// Appends the rows of all points at the given configuration.
    ///
    /// Against a surface each point is projected on the closest face (the first of equals). It faces nothing, and gets
    /// an infinite gap, where the foot lies beyond the rim: where the way from the foot to the point runs sideways by
    /// more than it runs along the normal. With [`Contact::sight`] only faces in view count, and gaps beyond its reach are
    /// infinite. What `search` holds from before does not matter to the result. Integration by mortar has the rows of
    /// [`Contact::pair_fully`].
    pub fn pair(&self, places: &Places, search: &mut Search, rows: &mut Rows) {
        if self.mortar.is_some() {
            let mut pairing = std::mem::take(&mut search.pairing);
            pairing.clear();
            self.pair_fully(places, search, &mut pairing);
            rows.append(&pairing.rows);
            search.pairing = pairing;
            return;
        }
        self.renew(places, search);
        for (k, point) in self.points.iter().enumerate() {
            let x = point.place(places);
            match &self.target {
                Target::Rigid(obstacle) => {
                    let placed = obstacle.at(places.time);
                    let Distance { gap, normal, .. } = placed.distance(&x);
                    rows.push(gap + self.offset(k), normal);
                    rows.set_rate(placed.gap_rate(&x, &normal));
                    add_point(places, point, &normal, rows);
                }
                Target::Surface(faces) => match search.facing(places, faces, self.view(k), &x) {
                    Some((foot, face)) => {
                        rows.push(foot.gap + self.offset(k), foot.normal);
                        add_row(places, point, &foot, face, rows);
                    }
                    None => rows.push(f64::INFINITY, [0.0; 3]),
                },
            }
        }
    }

    /// The points that the iterations of a step have made stay with a face ([`Search::begin_step`]). `search` is that of
    /// these places.
    pub fn held(&self, places: &Places, search: &Search) -> Vec<Held> {
        match &self.target {
            Target::Rigid(_) => Vec::new(),
            Target::Surface(faces) => {
                search.held(places, faces, |point| self.points[point].place(places))
            }
        }
    }

    /// Brings the search to a configuration.
    pub(crate) fn renew(&self, places: &Places, search: &mut Search) {
        if let Target::Surface(faces) = &self.target {
            search.renew(places, faces, self.sight.as_ref());
        }
    }

    /// Whether the surface faces itself.
    pub fn faces_itself(&self) -> bool {
        self.sight.as_ref().is_some_and(Sight::is_of_itself)
    }

    /// What a point sees; `None` for everything.
    pub(crate) fn view(&self, point: usize) -> Option<View<'_>> {
        self.sight.as_ref().map(|sight| sight.of(point))
    }

    /// What is added to the gap of a point, m.
    pub(crate) fn offset(&self, point: usize) -> f64 {
        self.offsets.get(point).copied().unwrap_or(0.0)
    }

    /// Whether rows depend on the places of the points: with finite sliding, and on anything but a rigid plane.
    pub fn turns(&self) -> bool {
        self.sliding == Sliding::Finite && !self.faces_plane()
    }

    /// Whether points keep the partner and the normal of their first pairing where another pairing would differ: with small
    /// sliding, on anything but a rigid plane.
    pub fn pairs_once(&self) -> bool {
        self.sliding == Sliding::Small && !self.faces_plane()
    }

    fn faces_plane(&self) -> bool {
        matches!(&self.target, Target::Rigid(rigid) if matches!(rigid.shape, Shape::Plane(_)))
    }

    /// Whether the target moves by itself: gaps then have a rate at bodies at rest ([`Rows::rate`]).
    pub fn moves(&self) -> bool {
        matches!(&self.target, Target::Rigid(obstacle) if obstacle.motion.moves())
    }
}

fn add_point(places: &Places, point: &Point, normal: &[f64; 3], rows: &mut Rows) {
    for (node, n) in point.carriers() {
        rows.add_node(places, node, &normal.map(|m| n * m));
    }
}

fn add_row(places: &Places, point: &Point, foot: &Projection, face: &Face, rows: &mut Rows) {
    add_point(places, point, &foot.normal, rows);
    let corners = face.corners();
    let mut shape = [0.0; MAX_FACE_NODES];
    (face.kind.table().shape)(&foot.xi, &mut shape[..corners.len()]);
    for (&node, n) in corners.iter().zip(shape) {
        rows.add_node(places, node, &foot.normal.map(|m| -n * m));
    }
}

#[cfg(test)]
mod tests {
    use carom_algebra::unknowns::Unknowns;
    use carom_elements::Kind;
    use carom_mesh::{ElementId, face_nodes};

    use super::*;
    use crate::Frames;
    use crate::law::Displacement;

    fn grid() -> (Vec<[f64; 3]>, Vec<Face>) {
        let mut x: Vec<[f64; 3]> = (0..25)
            .map(|i| [f64::from(i % 5), f64::from(i / 5), 0.0])
            .collect();
        x.push([1.3, 2.6, 0.25]);
        let faces = (0..16u32).map(|i| {
            let first = i % 4 + 5 * (i / 4);
            Face {
                kind: Kind::Quad4,
                nodes: face_nodes(&[first, first + 1, first + 6, first + 5]),
                parent: ElementId { block: 0, index: i },
                axis: [0.0; 3],
            }
        });
        (x, faces.collect())
    }

    fn rows_at(point: [f64; 3]) -> Rows {
        let (mut x, faces) = grid();
        x[25] = point;
        let contact = Contact {
            name: "patch".into(),
            law: Law::Displacement(Displacement::default()),
            sliding: Sliding::Finite,
            integration: Integration::Node,
            points: vec![Point::at_node(25, 1.0, 1.0)],
            mortar: None,
            target: Target::Surface(faces),
            sight: None,
            offsets: Vec::new(),
        };
        let mut rows = Rows::default();
        rows.clear();
        contact.pair(
            &Places {
                unknowns: &Unknowns::translations(3, 26),
                time: 0.0,
                x: &x,
                u: &vec![0.0; 78],
                frames: Frames::default(),
            },
            &mut Search::default(),
            &mut rows,
        );
        rows
    }

    #[test]
    fn row_is_the_derivative_of_the_gap_and_balances() {
        let rows = rows_at([1.3, 2.6, 0.25]);
        assert!((rows.gap(0) - 0.25).abs() < 1e-14);
        assert_eq!(rows.normal(0), [0.0, 0.0, 1.0]);
        let (dofs, coefficients) = rows.row(0);
        assert!(
            coefficients.iter().sum::<f64>().abs() < 1e-14,
            "no net force"
        );
        let node = |n: u32| {
            dofs.iter()
                .position(|&dof| dof == 3 * n + 2)
                .map(|k| coefficients[k])
        };
        assert_eq!(node(25), Some(1.0));
        assert!((node(11).unwrap() + 0.7 * 0.4).abs() < 1e-12);
        assert!((node(17).unwrap() + 0.3 * 0.6).abs() < 1e-12);
    }

    #[test]
    fn point_beside_the_rim_faces_nothing_and_one_on_it_does() {
        assert_eq!(rows_at([-0.5, 2.0, 0.1]).gap(0), f64::INFINITY);
        assert!((rows_at([0.0, 2.0, -0.1]).gap(0) + 0.1).abs() < 1e-14);
        assert!((rows_at([4.0, 4.0, 7.0]).gap(0) - 7.0).abs() < 1e-12);
    }
}
