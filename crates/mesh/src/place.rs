//! Parts of a model put where they belong.

use crate::Mesh;
use crate::read::flatten::flatten;

/// Where a part stands.
#[derive(Clone, Copy, Debug)]
pub struct Placement {
    /// Unit vector of an axis through the origin, and the angle by which the part turns about it, rad, counter-clockwise against the axis.
    pub turn: ([f64; 3], f64),
    /// By what it is moved afterwards, m.
    pub shift: [f64; 3],
}

impl Mesh {
    /// Turns and moves all nodes: x' = c x + s n × x + (1 - c) (n·x) n + shift, with the cosine and sine of the angle. The dimension is found anew.
    pub fn place(&mut self, placement: &Placement) {
        let (n, angle) = placement.turn;
        let (s, c) = angle.sin_cos();
        for x in &mut self.nodes {
            let along: f64 = (0..3).map(|i| n[i] * x[i]).sum();
            let across: [f64; 3] = std::array::from_fn(|i| {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                n[j] * x[k] - n[k] * x[j]
            });
            *x = std::array::from_fn(|i| {
                c * x[i] + s * across[i] + (1.0 - c) * along * n[i] + placement.shift[i]
            });
        }
        let kinds = self.blocks.iter().map(|block| block.kind.table().dim);
        let least = kinds.max().unwrap_or(1);
        self.dim = flatten(&mut self.nodes, least);
    }

    /// Puts a name and a dot before the names of all groups.
    pub fn prefix(&mut self, name: &str) {
        let groups = std::mem::take(&mut self.groups).into_iter();
        self.groups = groups
            .map(|(group, elements)| (format!("{name}.{group}"), elements))
            .collect();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate;

    #[test]
    fn a_part_turns_about_its_axis_and_then_moves() {
        let mut mesh = generate::box_("a", [0.0; 3], [2.0, 1.0, 3.0], [1; 3], false);
        mesh.place(&Placement {
            turn: ([0.0, 0.0, 1.0], std::f64::consts::FRAC_PI_2),
            shift: [10.0, 0.0, -1.0],
        });
        mesh.prefix("one");
        // the corner (2, 1, 3) goes to (-1, 2, 3) and on
        let expected = [9.0, 2.0, 2.0];
        let distance =
            |x: &[f64; 3]| (0..3).fold(0.0_f64, |d, i| d.max((x[i] - expected[i]).abs()));
        assert!(mesh.nodes.iter().any(|x| distance(x) < 1e-15));
        let cells = &mesh.groups["one.a"].elements;
        assert!(mesh.check(cells).is_empty());
        assert!(mesh.groups.contains_key("one.a.top"));
    }

    #[test]
    fn a_plane_part_that_is_turned_out_of_the_plane_is_in_space() {
        let mut mesh = generate::rectangle("a", [0.0; 2], [1.0; 2], [1; 2], false);
        assert_eq!(mesh.dim, 2);
        mesh.place(&Placement {
            turn: ([1.0, 0.0, 0.0], std::f64::consts::FRAC_PI_2),
            shift: [0.0; 3],
        });
        assert_eq!(mesh.dim, 3);
    }
}
