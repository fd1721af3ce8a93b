//! A contact seen from its other side.
//!
//! Points of the secondary surface are kept out of the primary one, not the reverse: what is narrower than a face of the secondary surface
//! gets between its points. Where nodes of the primary surface are behind the secondary one tells of it.

use carom_mesh::{Face, Rim};

use crate::sight::Parts;
use crate::{Contact, Integration, Point, Sight, Sliding, Target};

impl Contact {
    /// A contact that looks both ways as nodes of its secondary side, the first of its points, that see all of the primary one, at any depth. `secondary`: number of
    /// its faces.
    pub fn one_way(&self, secondary: usize) -> Contact {
        let points = self.points.iter();
        let own = points.take_while(|point| !point.is_on_primary() && !point.crosses());
        Contact {
            points: own.copied().collect(),
            target: Target::Surface(self.faces_of_primary(secondary).to_vec()),
            edges: None,
            sight: None,
            ..self.clone()
        }
    }

    /// The nodes of the primary surface as points that face the secondary one, up to a `depth` (m) behind it; none of surfaces that face
    /// themselves, lie around axes or middles or keep what they were paired with, and where gaps count from elsewhere. `secondary`: its faces, by
    /// system number; `x`: reference coordinates by system number, m.
    pub fn reversed(&self, secondary: &[Face], x: &[[f64; 3]], depth: f64) -> Option<Contact> {
        let Target::Surface(primary) = &self.target else {
            return None;
        };
        let mut faces = secondary.iter().chain(primary);
        let plain = faces.all(|face| face.radius.is_none() && face.kind.table().dim > 0);
        let follows = self.sliding == Sliding::Finite && self.offsets.is_empty();
        if !plain || !follows || self.has_both_sides() {
            return None;
        }
        let mut nodes: Vec<u32> = primary.iter().flat_map(Face::corners).copied().collect();
        nodes.sort_unstable();
        nodes.dedup();
        let points = nodes.iter().map(|&node| Point::at_node(node, 0.0, 0.0));
        let mut points: Vec<Point> = points.collect();
        for face in primary {
            for node in face.corners() {
                let own = nodes.binary_search(node);
                own.into_iter()
                    .for_each(|k| points[k].add_face(face.corners()));
            }
        }
        let mut target = secondary.to_vec();
        Rim::mark(&mut target, |node| x[node as usize], |node| node);
        let sight = Sight::new((&points, primary), &target, x, Some(depth));
        let parts = self.sight.as_ref().and_then(Sight::parts);
        Some(Contact {
            integration: Integration::Node,
            points,
            mortar: None,
            target: Target::Surface(target),
            edges: None,
            sight: Some(match parts {
                Some(parts) => sight.with_parts(&Parts {
                    secondary: parts.primary.clone(),
                    primary: parts.secondary.clone(),
                    apart: parts.apart.clone(),
                }),
                None => sight,
            }),
            ..self.clone()
        })
    }
}
