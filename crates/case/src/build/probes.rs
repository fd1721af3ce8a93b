//! Probes: the nodes of their groups, each with its share of the group.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use carom_bodies::Kinematics;
use carom_dynamics::ModelBody;
use carom_elements::{MAX_NODES, map};
use carom_mesh::{ElementId, Group, Mesh};
use carom_output::Spectrum;
use carom_signals::ChannelFilter;

use super::{Builder, BuiltProbe};
use crate::error::Problem;
use crate::schema::Probe;

impl Builder<'_> {
    pub(super) fn probes(&mut self, mesh: &Mesh, bodies: &[ModelBody]) -> Vec<BuiltProbe> {
        let axisymmetric = bodies
            .iter()
            .any(|body| body.spec.kinematics == Kinematics::Axisymmetric);
        let mut probes = Vec::new();
        for (name, probe) in self.case.probe.iter() {
            let spectrum = self.spectrum(name, probe);
            if let Some(group) = self.group(mesh, &format!("probe.{name}.on"), &probe.on) {
                probes.push(BuiltProbe {
                    name: name.to_string(),
                    nodes: shares(mesh, group, axisymmetric),
                    record: probe.record.clone(),
                    spectrum,
                    filters: probe.filter.iter().map(|class| class.frequency()).collect(),
                });
            }
        }
        probes
    }

    fn spectrum(&mut self, name: &str, probe: &Probe) -> Option<Spectrum> {
        let given = probe.response_spectrum?;
        let [from, to] = [given.from.0, given.to.0];
        if to <= from {
            let path = format!("probe.{name}.response-spectrum.to");
            let message = "the highest frequency is not above the lowest one";
            let problem = Problem::new(path, message).found(format!("{to} Hz"));
            self.problems
                .push(problem.accepted([format!("more than {from} Hz")]));
            return None;
        }
        Some(Spectrum::between(
            [from, to],
            given.points as usize,
            given.damping,
        ))
    }

    /// Refuses filters for which the steps, of `dt` (s), are too long.
    pub(super) fn fine_enough(&mut self, dt: f64) {
        for (name, probe) in self.case.probe.iter() {
            for (place, class) in probe.filter.iter().enumerate() {
                let longest = ChannelFilter::longest_step(f64::from(class.frequency()));
                if dt > longest * (1.0 + 1e-9) {
                    let path = format!("probe.{name}.filter[{place}]");
                    let message = format!(
                        "the filter needs ten steps in the period of its class, and a step is {dt:.4e} s"
                    );
                    let problem = Problem::new(path, message).found(class.name());
                    self.problems.push(problem.accepted([
                        format!("steps of at most {longest:.4e} s"),
                        "a lower class".to_owned(),
                    ]));
                }
            }
        }
    }

    /// Refuses probes on nodes of no body. `of`: cells of each body; with overlaps without those that are removed.
    pub(super) fn within_bodies(
        &mut self,
        mesh: &Mesh,
        probes: &[BuiltProbe],
        of: &[Vec<ElementId>],
    ) {
        let mut used = vec![false; mesh.nodes.len()];
        let nodes = of
            .iter()
            .flatten()
            .flat_map(|&cell| mesh.element_nodes(cell));
        nodes.for_each(|&node| used[node as usize] = true);
        for probe in probes {
            let outside = |(node, _): &&(u32, f64)| !used[*node as usize];
            let (message, accepted) = match probe.nodes.iter().filter(outside).count() {
                0 => continue,
                _ if !self.case.arlequin.is_empty() => (
                    "the probe has nodes of cells that are removed inside an overlapping body",
                    "a group of the body that stays",
                ),
                count if count == probe.nodes.len() => (
                    "the probe is on a group without a node of a body",
                    "a group of a body or of its surface",
                ),
                _ => continue,
            };
            let path = format!("probe.{}.on", probe.name);
            let problem = Problem::new(path, message).accepted([accepted]);
            self.problems.push(match self.case.probe.get(&probe.name) {
                Some(given) if accepted.ends_with("surface") => problem.found(&given.on),
                _ => problem,
            });
        }
    }
}

/// The nodes of a group, each with ∫ N_a dΩ over the group: with these weights the mean of the nodes is that of the field over the
/// length, area or volume, in axisymmetry over the full turn. Points count alike.
fn shares(mesh: &Mesh, group: &Group, axisymmetric: bool) -> Vec<(u32, f64)> {
    let turned = integrals(mesh, group, &|x| match axisymmetric {
        true => TAU * x[0],
        false => 1.0,
    });
    // a group on the axis turns over no area: its mean is that along the axis
    match turned.values().sum::<f64>() > 0.0 {
        true => turned.into_iter().collect(),
        false => integrals(mesh, group, &|_| 1.0).into_iter().collect(),
    }
}

/// ∫ N_a `unit` dΩ of each node of a group.
pub(super) fn integrals(
    mesh: &Mesh,
    group: &Group,
    unit: &dyn Fn(&[f64; 3]) -> f64,
) -> BTreeMap<u32, f64> {
    let mut shares = BTreeMap::new();
    let (mut n, mut dn) = ([0.0; MAX_NODES], [[0.0; 3]; MAX_NODES]);
    for &element in &group.elements {
        let table = mesh.kind(element).table();
        let nodes = mesh.element_nodes(element);
        let x: Vec<[f64; 3]> = nodes.iter().map(|&a| mesh.nodes[a as usize]).collect();
        let (n, dn) = (&mut n[..table.nodes], &mut dn[..table.nodes]);
        for (xi, weight) in table.mass_rule.points.iter().zip(table.mass_rule.weights) {
            (table.shape)(xi, n);
            (table.gradient)(xi, dn);
            let measure = match table.dim {
                3 => map::jacobian(&x, dn, 3).1.abs(),
                dim => map::measure(&x, dn, dim).0,
            };
            let part = weight * measure * unit(&map::point(&x, n));
            for (&node, n) in nodes.iter().zip(&*n) {
                *shares.entry(node).or_insert(0.0) += n * part;
            }
        }
    }
    shares
}
