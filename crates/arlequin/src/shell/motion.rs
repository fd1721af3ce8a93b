//! The motion of a shell element in its volume.

use carom_elements::{Kind, MAX_NODES};

use super::model::ShellCell;
use crate::polytope::sub;

pub(super) const MOST: usize = 4;

/// The motion of an element at a place: with places x_b of the nodes, their rotations R_b and directors d_b, the place is
/// Σ N_b x_b + (e + z) N_b R_b d_b + R_b w_b, the last without what rotations about the normal do in it.
pub(super) struct Motion {
    pub n: [f64; MOST],
    /// z d, with d = Σ N_b d_b.
    pub arm: [f64; 3],
    /// (e + z) N_b d_b.
    pub ends: [[f64; 3]; MOST],
    /// w_b, whose sum is zero.
    pub bent: [[f64; 3]; MOST],
}

impl ShellCell {
    /// The motion at a place of the extruded element.
    pub(super) fn motion(&self, [r, s, height]: &[f64; 3]) -> Motion {
        let count = self.x.len();
        let kinds = match count {
            3 => [Kind::Tri3, Kind::Tri6],
            _ => [Kind::Quad4, Kind::Quad9],
        };
        let z = 0.5 * height * self.thickness;
        let (mut n, mut quadratic) = ([0.0; MAX_NODES], [0.0; MAX_NODES]);
        for (kind, out) in kinds.into_iter().zip([&mut n, &mut quadratic]) {
            let table = kind.table();
            (table.shape)(&[*r, *s, 0.0], &mut out[..table.nodes]);
        }
        let mut motion = Motion {
            n: [0.0; MOST],
            arm: [0.0; 3],
            ends: [[0.0; 3]; MOST],
            bent: self.bent(&quadratic),
        };
        for (b, own) in self.directors.iter().enumerate() {
            motion.n[b] = n[b];
            motion.ends[b] = own.map(|d| n[b] * (self.offset + z) * d);
            (0..3).for_each(|i| motion.arm[i] += z * n[b] * own[i]);
        }
        motion
    }

    /// w_b: the deflection Σ R_b w_b without shear beside that of the nodes. An edge e from i to j has in its middle
    /// (R_i - R_j) e/8, a quadrilateral in its centre c -Σ R_a (x_a - c)/8. Exact for constant curvatures.
    fn bent(&self, quadratic: &[f64; MAX_NODES]) -> [[f64; 3]; MOST] {
        let count = self.x.len();
        let mut bent = [[0.0; 3]; MOST];
        let mut add = |node: usize, way: &[f64; 3], factor: f64| {
            (0..3).for_each(|i| bent[node][i] += 0.125 * factor * way[i]);
        };
        for i in 0..count {
            let j = (i + 1) % count;
            let edge = sub(&self.x[j], &self.x[i]);
            add(i, &edge, quadratic[count + i]);
            add(j, &edge, -quadratic[count + i]);
        }
        if count == 4 {
            let centre = crate::polytope::Polytope::mean(&self.x);
            for (node, x) in self.x.iter().enumerate() {
                add(node, &sub(x, &centre), -quadratic[8]);
            }
        }
        bent
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polytope::cross;
    use carom_mesh::generate;

    #[test]
    fn constant_curvatures_have_their_deflection_in_a_distorted_element() {
        let x = [[0.0, 0.0], [1.1, 0.2], [0.9, 1.3], [-0.2, 0.8]].map(|[x, y]| [x, y, 0.0]);
        let mesh = generate::rectangle("a", [0.0; 2], [1.0; 2], [1, 1], false);
        // w = x² + 3 x y - 2 y², slopes w,x = -θ_y and w,y = θ_x
        let w = |x: &[f64; 3]| x[0] * x[0] + 3.0 * x[0] * x[1] - 2.0 * x[1] * x[1];
        let turned = |x: &[f64; 3]| [3.0 * x[0] - 4.0 * x[1], -2.0 * x[0] - 3.0 * x[1], 0.0];
        for count in [3, 4] {
            let shell = ShellCell {
                cell: mesh.groups["a"].elements[0],
                x: x[..count].to_vec(),
                directors: vec![[0.0, 0.0, 1.0]; count],
                thickness: 0.1,
                offset: 0.0,
            };
            for place in [[0.2, 0.3, 0.0], [0.1, 0.6, 1.0], [0.3, 0.3, -1.0]] {
                let motion = shell.motion(&place);
                let (mut at, mut found) = ([0.0; 3], [0.0; 3]);
                for (b, x) in shell.x.iter().enumerate() {
                    let theta = turned(x);
                    let ends = cross(&theta, &motion.ends[b]);
                    for i in 0..3 {
                        at[i] += motion.n[b] * x[i];
                        found[i] += ends[i];
                    }
                    found[2] += motion.n[b] * w(x) + cross(&theta, &motion.bent[b])[2];
                }
                let theta = turned(&at);
                let z = 0.05 * place[2];
                let exact = [z * theta[1], -z * theta[0], w(&at)];
                for i in 0..3 {
                    assert!(
                        (found[i] - exact[i]).abs() < 1e-14,
                        "{count} {found:?} {exact:?}"
                    );
                }
            }
        }
    }
}
