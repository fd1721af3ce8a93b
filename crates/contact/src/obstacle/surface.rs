//! A rigid surface made of faces of a mesh.

use std::collections::BTreeMap;

use carom_elements::{MAX_FACE_NODES, map};
use carom_mesh::{Bounds, BoxTree, Face, Mesh, Projection, Rim, Surface, project};

use super::distance::Distance;
use crate::passed::passed_face;
use crate::search::{Stand, faces_point};

/// Rigid surface of faces: the material must stay on the side to which their normals point.
///
/// Faces meet at angles where the mesh is not smooth; there the gap is as against a deformable surface of the same faces.
#[derive(Clone, Debug, PartialEq)]
pub struct RigidSurface {
    /// Their nodes by place in `x`.
    faces: Vec<Face>,
    /// Places of the nodes at time 0, m.
    x: Vec<[f64; 3]>,
    tree: BoxTree,
}

impl RigidSurface {
    /// The surface at the places that its nodes have in the mesh ([`Surface::of_facets`]).
    pub fn new(mesh: &Mesh, surface: &Surface) -> RigidSurface {
        let place = |node: u32| surface.index_of(node).map_or(u32::MAX, |k| k as u32);
        let renumbered = |face: &Face| {
            let mut face = *face;
            for k in 0..face.corners().len() {
                face.nodes[k] = place(face.nodes[k]);
            }
            face
        };
        let mut faces: Vec<Face> = surface.faces.iter().map(renumbered).collect();
        let nodes = surface.nodes.iter();
        let x: Vec<[f64; 3]> = nodes.map(|&node| mesh.nodes[node as usize]).collect();
        let first = firsts(&x);
        Rim::mark(
            &mut faces,
            |node| x[node as usize],
            |node| first[node as usize],
        );
        let boxes: Vec<Bounds> = faces
            .iter()
            .map(|face| Bounds::of_face(face.kind, &places(&x, face)[..face.corners().len()]))
            .collect();
        RigidSurface {
            tree: BoxTree::new(&boxes),
            faces,
            x,
        }
    }

    /// The faces, their nodes by place in the second list, and the places of the nodes at time 0, m.
    pub fn faces(&self) -> (&[Face], &[[f64; 3]]) {
        (&self.faces, &self.x)
    }

    /// The least diagonal of the boxes of its faces, m.
    pub(crate) fn least_size(&self) -> f64 {
        let sizes = self.faces.iter().map(|face| {
            let places = places(&self.x, face);
            Bounds::of_face(face.kind, &places[..face.corners().len()]).diagonal()
        });
        sizes.fold(f64::INFINITY, f64::min)
    }

    /// The normal where the straight way between two places passes a face from before it to behind it, if it does.
    pub(crate) fn passed(&self, from: &[f64; 3], to: &[f64; 3]) -> Option<[f64; 3]> {
        let mut found = Vec::new();
        self.tree
            .overlapping(&Bounds::of(&[*from, *to]), &mut found);
        found.iter().find_map(|&item| {
            let face = &self.faces[item as usize];
            let places = places(&self.x, face);
            passed_face((face, &places[..face.corners().len()]), [from, to])
        })
    }

    /// Gap over the closest face (the first of equals) of a place x in m; a place beyond the rim faces nothing.
    pub fn distance(&self, x: &[f64; 3]) -> Distance {
        self.distance_of(&Stand { x, of: None })
    }

    pub(crate) fn distance_of(&self, stand: &Stand) -> Distance {
        let x = stand.x;
        let foot = |item: u32| {
            let face = &self.faces[item as usize];
            let places = places(&self.x, face);
            project(face, &places[..face.corners().len()], x)
        };
        let closest = self
            .tree
            .closest(x, f64::INFINITY, 0.0, |item| foot(item).distance);
        let found = closest.map(|(item, _)| (foot(item), &self.faces[item as usize]));
        match found {
            Some((foot, face))
                if faces_point((*stand, &foot), face, true, || places(&self.x, face)) =>
            {
                Distance {
                    gap: foot.gap,
                    normal: foot.normal,
                    hessian: self.hessian(&foot, face),
                }
            }
            _ => Distance {
                gap: f64::INFINITY,
                normal: [0.0; 3],
                hessian: [[0.0; 3]; 3],
            },
        }
    }

    /// ∂²g/∂x² = -Σ b_αβ (a⁻¹ t)_α ⊗ (A⁻¹ t)_β over a foot inside its face, with tangents t_α = ∂y/∂ξ_α, metric
    /// a_αβ = t_α·t_β, curvature b_αβ = n·∂²y/∂ξ_α∂ξ_β and A = a - g b.
    ///
    /// From t_α·(x - y) = 0: dξ = A⁻¹ t·dx, and dn = -b_βα (a⁻¹ t)_α dξ_β (Weingarten). Zero on flat faces, and beyond an
    /// edge, where the way to the foot is no longer along n.
    fn hessian(&self, foot: &Projection, face: &Face) -> [[f64; 3]; 3] {
        let dim = face.kind.table().dim;
        let mut hessian = [[0.0; 3]; 3];
        if !foot.inside || dim == 0 {
            return hessian;
        }
        let places = places(&self.x, face);
        let t = tangents(face, &places, &foot.xi);
        let bend = curvature(face, &places, foot);
        let (mut metric, mut rest) = ([[1.0, 0.0], [0.0, 1.0]], [[1.0, 0.0], [0.0, 1.0]]);
        for i in 0..dim {
            for j in 0..dim {
                metric[i][j] = (0..3).map(|k| t[i][k] * t[j][k]).sum::<f64>();
                rest[i][j] = metric[i][j] - foot.gap * bend[i][j];
            }
        }
        let (raised, ways) = (solved(&metric, &t), solved(&rest, &t));
        for a in 0..dim {
            for b in 0..dim {
                for (i, row) in hessian.iter_mut().enumerate() {
                    for (j, entry) in row.iter_mut().enumerate() {
                        *entry -= bend[a][b] * raised[a][i] * ways[b][j];
                    }
                }
            }
        }
        hessian
    }
}

/// Of each node the first at the same place, bit for bit: a rigid surface does not part where faces share none.
fn firsts(x: &[[f64; 3]]) -> Vec<u32> {
    let mut first = BTreeMap::new();
    let numbered = x.iter().zip(0..);
    numbered
        .map(|(x, node)| *first.entry(x.map(|x| (x + 0.0).to_bits())).or_insert(node))
        .collect()
}

fn places(x: &[[f64; 3]], face: &Face) -> [[f64; 3]; MAX_FACE_NODES] {
    let mut places = [[0.0; 3]; MAX_FACE_NODES];
    for (place, &node) in places.iter_mut().zip(face.corners()) {
        *place = x[node as usize];
    }
    places
}

/// ∂y/∂ξ_α.
fn tangents(face: &Face, places: &[[f64; 3]], xi: &[f64; 3]) -> [[f64; 3]; 2] {
    let mut dn = [[0.0; 3]; MAX_FACE_NODES];
    (face.kind.table().gradient)(xi, &mut dn[..face.corners().len()]);
    [0, 1].map(|i| map::point(places, &dn.map(|dn| dn[i])))
}

/// b_αβ = n·∂²y/∂ξ_α∂ξ_β: half the difference of the tangents one unit to both sides, which is exact because no shape
/// function is of more than the second degree in one coordinate.
fn curvature(face: &Face, places: &[[f64; 3]; MAX_FACE_NODES], foot: &Projection) -> [[f64; 2]; 2] {
    let mut bend = [[0.0; 2]; 2];
    for j in 0..face.kind.table().dim {
        let at = |step: f64| {
            let mut xi = foot.xi;
            xi[j] += step;
            tangents(face, places, &xi)
        };
        let (before, after) = (at(-1.0), at(1.0));
        for (i, row) in bend.iter_mut().enumerate() {
            row[j] = (0..3)
                .map(|k| 0.5 * foot.normal[k] * (after[i][k] - before[i][k]))
                .sum();
        }
    }
    bend
}

/// M⁻¹ t of a symmetric M.
fn solved(m: &[[f64; 2]; 2], t: &[[f64; 3]; 2]) -> [[f64; 3]; 2] {
    let det = m[0][0] * m[1][1] - m[0][1] * m[1][0];
    let row = |a: f64, b: f64| [0, 1, 2].map(|k| (a * t[0][k] + b * t[1][k]) / det);
    [row(m[1][1], -m[0][1]), row(-m[1][0], m[0][0])]
}

#[cfg(test)]
mod tests {
    use carom_elements::Kind;
    use carom_mesh::Group;

    use super::*;
    use crate::obstacle::tests::assert_derivatives;
    use crate::{Motion, Obstacle, Shape, Translation};

    /// A saddle of 6 x 6 quadrilaterals, none of them flat.
    fn saddle() -> RigidSurface {
        let mut mesh = Mesh::new(3);
        for i in 0..49 {
            let [x, y] = [f64::from(i % 7), f64::from(i / 7)];
            mesh.nodes.push([x, y, 0.1 * x * y]);
        }
        let cells = (0..36u32).map(|i| {
            let first = i % 6 + 7 * (i / 6);
            mesh.push(Kind::Quad4, &[first, first + 1, first + 8, first + 7])
        });
        let group = Group::new(2, cells.collect());
        let surface = Surface::of_facets(&mesh, &group, false).unwrap();
        RigidSurface::new(&mesh, &surface)
    }

    #[test]
    fn normal_and_hessian_of_warped_faces_are_the_derivatives_of_the_gap() {
        let saddle = saddle();
        for x in [[2.3, 3.6, 1.2], [4.4, 1.7, 0.5]] {
            assert!(saddle.distance(&x).gap.abs() > 0.1);
            assert_derivatives(|x| saddle.distance(x), &x);
        }
    }

    #[test]
    fn a_moved_surface_gives_the_gap_of_the_place_moved_back() {
        let saddle = saddle();
        let x = [2.3, 3.6, 1.2];
        let gap = saddle.distance(&x).gap;
        let shape = Shape::Surface(Box::new(saddle));
        let moving = Obstacle {
            shape,
            motion: Motion {
                translation: Some(Translation::Velocity([10.0, -4.0, 1.0])),
                turn: None,
            },
        };
        let there = [x[0] + 5.0, x[1] - 2.0, x[2] + 0.5];
        assert!((moving.at(0.5).distance(&there).gap - gap).abs() < 1e-14);
        // where it was before it has left: beyond the rim
        assert_eq!(moving.at(0.5).distance(&[0.5, 3.0, 1.0]).gap, f64::INFINITY);
    }
}
