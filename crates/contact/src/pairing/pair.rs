//! The points of a contact at a configuration, appended to rows or to a pairing.

use carom_elements::MAX_FACE_NODES;
use carom_mesh::{Face, Projection};

use super::Pairing;
use super::stencil::Stencil;
use crate::crossing::Opposite;
use crate::{Contact, Distance, Integration, Places, Point, Rows, Search, Target};

impl Contact {
    /// Appends the rows of all points at the given configuration.
    ///
    /// Against a surface each point is projected on the closest face (the first of equals). It faces nothing, and gets
    /// an infinite gap, where the foot lies beyond the rim: where the way from the foot to the point runs sideways by
    /// more than it runs along the normal. With [`Contact::sight`] only faces in view count, and gaps beyond its reach are
    /// infinite. What `search` holds from before does not matter to the result. Integration by mortar has the rows of
    /// [`Contact::pair_fully`], through a pairing made for the call.
    pub fn pair(&self, places: &Places, search: &mut Search, rows: &mut Rows) {
        if self.mortar.is_some() {
            let mut pairing = Pairing::default();
            pairing.clear();
            self.pair_fully(places, search, &mut pairing);
            rows.append(&pairing.rows);
            return;
        }
        self.renew(places, search);
        let offset = |k: usize| self.offset(k) - self.points[k].radius;
        match &self.target {
            Target::Rigid(obstacle) => {
                let placed = obstacle.at(places.time);
                for (k, point) in self.points.iter().enumerate() {
                    let (point, counts) = obstacle.faced_by(point, places);
                    if !counts {
                        rows.push(f64::INFINITY, [0.0; 3]);
                        continue;
                    }
                    let x = point.place(places);
                    let Distance { gap, normal, .. } = placed.distance_of(&point, places);
                    rows.push(gap + offset(k), normal);
                    rows.set_rate(placed.gap_rate(&x, &normal));
                    add_point(places, &point, &normal, rows);
                }
            }
            Target::Surface(faces) => {
                self.each_opposite((places, faces), search, |k, found| match found {
                    Some(Opposite {
                        point, foot, face, ..
                    }) => {
                        rows.push(foot.gap + offset(k), foot.normal);
                        rows.set_resultant(point.on_secondary(foot.normal));
                        add_row(places, &point, &foot, face, rows);
                    }
                    None => rows.push(f64::INFINITY, [0.0; 3]),
                });
            }
        }
    }

    /// Appends all points of the contact at the given configuration, with tangents and curvature.
    ///
    /// Which points face what is decided as in [`Contact::pair`]; the gaps are the same, and so are the rows of points
    /// whose foot is not at a rim.
    pub fn pair_fully(&self, places: &Places, search: &mut Search, pairing: &mut Pairing) {
        pairing.dim = places.dim();
        self.renew(places, search);
        let first = pairing.len();
        self.pair_points(places, search, (first, pairing));
        for k in 0..self.points.len() {
            pairing.rows.shift(first + k, self.offset(k));
        }
    }

    /// Pairs all points; the first of them is that of the number `first` in the pairing.
    pub(super) fn pair_points(
        &self,
        places: &Places,
        search: &mut Search,
        (first, pairing): (usize, &mut Pairing),
    ) {
        if let (Integration::Mortar { basis }, Some(mortar)) = (self.integration, &self.mortar)
            && !mortar.is_ends()
        {
            return mortar.pair((self, basis), places, search, (first, pairing));
        }
        let span = pairing.span;
        let mut place = |k: usize, stencil: Option<Stencil>| {
            let of = (first + k, self.points[k].area);
            pairing.place(places, of, stencil.as_ref());
        };
        match &self.target {
            Target::Rigid(obstacle) => {
                for (k, point) in self.points.iter().enumerate() {
                    place(k, Stencil::on_obstacle(places, point, obstacle, span));
                }
            }
            Target::Surface(faces) => self.each_opposite((places, faces), search, |k, found| {
                place(k, found.map(|found| Stencil::opposite_to(places, &found)));
            }),
        }
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
    use carom_mesh::{ElementId, Rim, face_nodes};

    use super::*;
    use crate::law::Displacement;
    use crate::{Frames, Law, Sliding};

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
                radius: None,
                rim: Rim::default(),
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
            edges: None,
            offsets: Vec::new(),
            near_only: false,
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
