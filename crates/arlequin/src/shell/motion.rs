//! The motion of a shell element in its volume.

use carom_elements::{Kind, MAX_NODES};

use super::model::ShellCell;
use crate::polytope::{cross, sub};

pub(super) const MOST: usize = 4;

/// A matrix.
pub(super) type Mat = [[f64; 3]; 3];

/// Shape functions of an element at a place: u = Σ N_b u_b + G_b θ_b.
pub(super) struct Motion {
    pub n: [f64; MOST],
    /// z d.
    pub arm: [f64; 3],
    /// G_b = -N_b [e D_b + z d_b]× + d ℓ_bᵀ.
    pub turned: [Mat; MOST],
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
        let mut d = [0.0; 3];
        for (n, own) in n.iter().zip(&self.directors) {
            (0..3).for_each(|i| d[i] += n * own[i]);
        }
        let bent = self.bent(&quadratic);
        let mut motion = Motion {
            n: [0.0; MOST],
            arm: d.map(|d| z * d),
            turned: [[[0.0; 3]; 3]; MOST],
        };
        for (b, own) in self.directors.iter().enumerate() {
            motion.n[b] = n[b];
            let [x, y, w] = own.map(|d| n[b] * (self.offset + z) * d);
            let spin = [[0.0, w, -y], [-w, 0.0, x], [y, -x, 0.0]];
            motion.turned[b] = [0, 1, 2].map(|i| [0, 1, 2].map(|j| spin[i][j] + d[i] * bent[b][j]));
        }
        motion
    }

    /// ℓ_b: the deflection Σ ℓ_b·θ_b without shear beside that of the nodes. An edge e from i to j has in its middle
    /// (θ_j·(d_j × e) - θ_i·(d_i × e))/8, a quadrilateral in its centre c Σ θ_a·(d_a × (x_a - c))/8. Exact for constant curvatures.
    fn bent(&self, quadratic: &[f64; MAX_NODES]) -> [[f64; 3]; MOST] {
        let count = self.x.len();
        let mut bent = [[0.0; 3]; MOST];
        let mut add = |node: usize, way: &[f64; 3], factor: f64| {
            let by = cross(&self.directors[node], way);
            (0..3).for_each(|i| bent[node][i] += 0.125 * factor * by[i]);
        };
        for i in 0..count {
            let j = (i + 1) % count;
            let edge = sub(&self.x[j], &self.x[i]);
            add(j, &edge, quadratic[count + i]);
            add(i, &edge, -quadratic[count + i]);
        }
        if count == 4 {
            let centre = crate::polytope::Polytope::mean(&self.x);
            for (node, x) in self.x.iter().enumerate() {
                add(node, &sub(x, &centre), quadratic[8]);
            }
        }
        bent
    }
}

#[cfg(test)]
mod tests {
    use super::*;
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
                    for i in 0..3 {
                        at[i] += motion.n[b] * x[i];
                        let row = motion.turned[b][i];
                        found[i] += (0..3).map(|j| row[j] * theta[j]).sum::<f64>();
                    }
                    found[2] += motion.n[b] * w(x);
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
