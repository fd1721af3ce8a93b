//! Layers of a solid that a static stage tightens: their elongation, and what they hold beside it ([`Layers`]).

use std::collections::BTreeSet;

use carom_algebra::dense::DenseCholesky;
use carom_algebra::tensor::{Mat3, Vec3};
use carom_algebra::unknowns::Unknowns;
use carom_mesh::ElementId;

use crate::layers::{Layer, Layers, TightenedLayer};
use crate::{Bolt, Kinematics, Solid};

impl Solid {
    /// Nodes that move as one: of each element but those of layers that are tightened, and of either side of these.
    pub(crate) fn each_joining_element(&self, visit: &mut dyn FnMut(&[u32])) {
        let mut place = 0;
        self.each_element(&mut |nodes| {
            if !self.layers.loosens(place) {
                visit(nodes);
            }
            place += 1;
        });
        self.layers.each_side(visit);
    }

    /// The layers of a body at small strain. `x`: reference places by system number, m.
    pub(crate) fn layers_of(
        &self,
        given: &[TightenedLayer],
        (x, unknowns): (&[[f64; 3]], &Unknowns),
    ) -> Layers {
        let mut layers = Layers::default();
        for given in given {
            layers.push(self.layer(given, (x, unknowns)));
        }
        layers
    }

    fn layer(
        &self,
        given: &TightenedLayer,
        (x, unknowns): (&[[f64; 3]], &Unknowns),
    ) -> (Layer, Bolt) {
        let n = given.axis;
        let (places, nodes) = self.places_and_nodes(&given.cells);
        let along = |node: u32| (0..3).map(|i| n[i] * x[node as usize][i]).sum::<f64>();
        let heights = nodes.iter().map(|&node| along(node));
        let [low, high] = heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], z| {
            [low.min(z), high.max(z)]
        });
        let (middle, length) = (0.5 * (low + high), high - low);
        let mut w = vec![0.0; unknowns.len()];
        for &node in &nodes {
            for (i, n) in n.iter().enumerate().take(self.dim) {
                w[unknowns.first(node) + i] = (along(node) - middle) * n;
            }
        }
        let q = self.forces_of_cells(&places, &w);
        let own = || {
            nodes
                .iter()
                .flat_map(|&node| unknowns.translations_of(node))
        };
        let stiffness = own().map(|i| w[i] * q[i]).sum::<f64>() / (length * length);
        let row = own().filter(|&i| q[i] != 0.0);
        let bolt = Bolt {
            name: given.name.clone(),
            force: given.force,
            stiffness,
            row: row.map(|i| (i, q[i] / (length * stiffness))).collect(),
        };
        // the stress of a strain n ⊗ n, over κ L: a force g that is kept is one of δ = -g/κ
        let place = places.first().copied().unwrap_or(0);
        let stresses = self.stresses_of(place..place + 1, (&w, &[]));
        let stress = stresses
            .first()
            .map_or(Mat3::zeros(), |(_, stress)| *stress);
        let side = |is_high: bool| {
            let own = nodes
                .iter()
                .filter(|&&node| (along(node) > middle) == is_high);
            own.copied().collect::<Vec<u32>>()
        };
        let sides = [side(false), side(true)];
        let layer = Layer {
            tightens: given.tightens,
            places,
            rows: self.rows_between(&sides, (x, unknowns), &n),
            sides,
            nodes,
            kept: stress / (stiffness * length),
        };
        (layer, bolt)
    }

    /// Places of some cells in the body, and their nodes, both ascending.
    fn places_and_nodes(&self, cells: &[ElementId]) -> (Vec<usize>, Vec<u32>) {
        let wanted: BTreeSet<ElementId> = cells.iter().copied().collect();
        let places = (0..self.cells.len()).filter(|&place| wanted.contains(&self.cells[place]));
        let places: Vec<usize> = places.collect();
        let (mut nodes, mut place) = (Vec::new(), 0);
        self.each_element(&mut |own| {
            if places.binary_search(&place).is_ok() {
                nodes.extend_from_slice(own);
            }
            place += 1;
        });
        nodes.sort_unstable();
        nodes.dedup();
        (places, nodes)
    }

    /// K u of some cells.
    fn forces_of_cells(&self, places: &[usize], u: &[f64]) -> Vec<f64> {
        let (mut f, mut place) = (vec![0.0; u.len()], 0);
        let mut unknowns: Vec<usize> = Vec::new();
        self.each_matrix(true, &mut |element| {
            if places.binary_search(&place).is_ok() {
                unknowns.clear();
                let of_node = |&first: &u32| first as usize..first as usize + self.dim;
                unknowns.extend(element.first.iter().flat_map(of_node));
                for (&i, k) in unknowns
                    .iter()
                    .zip(element.stiffness.chunks(unknowns.len()))
                {
                    f[i] += unknowns.iter().zip(k).map(|(&j, k)| k * u[j]).sum::<f64>();
                }
            }
            place += 1;
        });
        f
    }

    /// Differences of the rigid motions of both sides, by least squares, but for that along the axis: what a layer without stiffness against its elongation
    /// holds.
    fn rows_between(
        &self,
        sides: &[Vec<u32>; 2],
        (x, unknowns): (&[[f64; 3]], &Unknowns),
        n: &[f64; 3],
    ) -> Vec<Vec<(usize, f64)>> {
        let all = || {
            sides
                .iter()
                .flatten()
                .map(|&node| Vec3::from(x[node as usize]))
        };
        let centre = all().sum::<Vec3>() / all().count() as f64;
        let size = all().map(|x| (x - centre).norm()).fold(0.0, f64::max);
        let motions = self.rigid_motions(&Vec3::from(*n));
        let mut rows = vec![Vec::new(); motions.len()];
        for (nodes, sign) in sides.iter().zip([-1.0, 1.0]) {
            // motions of the side, one column a motion
            let (mut own, mut columns) = (Vec::new(), vec![Vec::new(); motions.len()]);
            for &node in nodes {
                let r = (Vec3::from(x[node as usize]) - centre) / size;
                own.extend(unknowns.translations_of(node));
                for ([way, turn], column) in motions.iter().zip(&mut columns) {
                    let v = way + turn.cross(&r);
                    column.extend((0..self.dim).map(|i| v[i]));
                }
            }
            let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            let products = columns
                .iter()
                .flat_map(|a| columns.iter().map(|b| dot(a, b)));
            let products: Vec<f64> = products.collect();
            // sides are faces of cells, which know all rigid motions
            let Ok(factor) = DenseCholesky::new(motions.len(), &products) else {
                return Vec::new();
            };
            for (place, unknown) in own.into_iter().enumerate() {
                let mut fit: Vec<f64> = columns.iter().map(|column| column[place]).collect();
                factor.solve(&mut fit);
                for (row, c) in rows.iter_mut().zip(fit).filter(|(_, c)| *c != 0.0) {
                    row.push((unknown, sign * c));
                }
            }
        }
        rows.split_off(1)
    }

    /// Translation and turn of the rigid motions of the body's kinematics, first the translation along the axis n.
    fn rigid_motions(&self, n: &Vec3) -> Vec<[Vec3; 2]> {
        let (zero, z) = (Vec3::zeros(), Vec3::z());
        if self.kinematics == Kinematics::Axisymmetric {
            return vec![[*n, zero]];
        }
        if self.dim == 2 {
            return vec![[*n, zero], [z.cross(n), zero], [zero, z]];
        }
        let flat = if n.x.abs() < 0.6 {
            Vec3::x()
        } else {
            Vec3::y()
        };
        let s = n.cross(&flat).normalize();
        let t = n.cross(&s);
        vec![
            [*n, zero],
            [s, zero],
            [t, zero],
            [zero, *n],
            [zero, s],
            [zero, t],
        ]
    }
}
