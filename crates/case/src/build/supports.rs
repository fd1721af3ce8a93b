//! Supports: nodes held, and nodes that move as prescribed.

use std::collections::BTreeMap;

use carom_dynamics::{Amplitude, Prescribed, Support};
use carom_mesh::Mesh;

use super::Builder;
use crate::error::Problem;
use crate::schema::MovementPoint;

/// Names of the axes.
const AXES: [&str; 3] = ["x", "y", "z"];

impl Builder<'_> {
    /// Supports and prescribed motions; no node is held or moved twice in one direction where one of both is a motion.
    pub(super) fn supports(&mut self, mesh: &Mesh) -> (Vec<Support>, Vec<Prescribed>) {
        let (mut supports, mut motions) = (Vec::new(), Vec::new());
        let mut moved: BTreeMap<(u32, usize), &str> = BTreeMap::new();
        let mut held: BTreeMap<(u32, usize), &str> = BTreeMap::new();
        for (name, support) in self.case.support.iter() {
            let path = format!("support.{name}");
            for (k, axis) in support.fix.iter().enumerate() {
                self.within(mesh, &format!("{path}.fix[{k}]"), axis.index());
            }
            let Some(group) = self.group(mesh, &format!("{path}.on"), &support.on) else {
                continue;
            };
            let nodes = mesh.group_nodes(group);
            let mut fix = [false; 3];
            support.fix.iter().for_each(|axis| fix[axis.index()] = true);
            for axis in (0..3).filter(|&axis| fix[axis]) {
                held.extend(nodes.iter().map(|&node| ((node, axis), name)));
            }
            if let Some(motion) = &support.motion {
                let given = [&motion.x, &motion.y, &motion.z];
                let mut displacement = [None, None, None];
                for (axis, points) in given.iter().enumerate() {
                    let Some(points) = points else { continue };
                    let path = format!("{path}.move.{}", AXES[axis]);
                    self.within(mesh, &path, axis);
                    self.once(&path, &nodes, axis, &moved);
                    moved.extend(nodes.iter().map(|&node| ((node, axis), name)));
                    displacement[axis] = self.movement(&path, points);
                    self.warn_of_a_jump(&path, displacement[axis].as_ref());
                }
                let nodes = nodes.clone();
                motions.push(Prescribed {
                    nodes,
                    displacement,
                });
            }
            supports.push(Support {
                nodes,
                fix,
                fix_rotations: [false; 3],
            });
        }
        self.not_held(&moved, &held);
        (supports, motions)
    }

    /// Refuses a direction that the mesh does not have.
    fn within(&mut self, mesh: &Mesh, path: &str, axis: usize) {
        if axis < mesh.dim {
            return;
        }
        let message = format!(
            "a direction beyond the {} of the mesh",
            super::dimensions(mesh.dim)
        );
        let problem = Problem::new(path, message).found(AXES[axis]);
        self.problems
            .push(problem.accepted(AXES[..mesh.dim].to_vec()));
    }

    /// Refuses a motion of nodes that move already.
    fn once(
        &mut self,
        path: &str,
        nodes: &[u32],
        axis: usize,
        moved: &BTreeMap<(u32, usize), &str>,
    ) {
        let mut twice = nodes.iter().filter_map(|&node| {
            let name = moved.get(&(node, axis))?;
            Some((node, *name))
        });
        if let Some((node, other)) = twice.next() {
            self.problems.push(clash(path, node, "moves", other));
        }
    }

    /// Refuses motions of nodes that are held.
    fn not_held(
        &mut self,
        moved: &BTreeMap<(u32, usize), &str>,
        held: &BTreeMap<(u32, usize), &str>,
    ) {
        let mut told = Vec::new();
        for (&(node, axis), name) in moved {
            let Some(other) = held.get(&(node, axis)) else {
                continue;
            };
            let path = format!("support.{name}.move.{}", AXES[axis]);
            if !told.contains(&path) {
                self.problems.push(clash(&path, node, "holds", other));
                told.push(path);
            }
        }
    }

    /// Warns of a prescribed displacement that is not zero at the start: its nodes jump in the first step. A static stage takes
    /// it as any other load.
    fn warn_of_a_jump(&mut self, path: &str, motion: Option<&Amplitude>) {
        let start = motion.map_or(0.0, |motion| motion.at(0.0));
        if start != 0.0 && self.case.time.stage.is_none() {
            self.warnings.push(format!(
                "{path}: the displacement is {start:.4e} m at time 0: the nodes jump there in the first step, which is a shock to the body; begin with displacement = 0 at time = 0"
            ));
        }
    }

    fn movement(&mut self, path: &str, points: &[MovementPoint]) -> Option<Amplitude> {
        let points = points.iter();
        let points = points.map(|point| [point.time.0, point.displacement.0]);
        self.amplitude(path, points.collect())
    }

    /// A function of time, or a problem at the first time that does not ascend.
    pub(super) fn amplitude(&mut self, path: &str, points: Vec<[f64; 2]>) -> Option<Amplitude> {
        let times: Vec<f64> = points.iter().map(|point| point[0]).collect();
        self.ascending(path, &times);
        Amplitude::new(points).ok()
    }

    /// Refuses times that do not ascend.
    pub(super) fn ascending(&mut self, path: &str, times: &[f64]) {
        let late = |k: &usize| times[*k] <= times[k - 1];
        if let Some(k) = (1..times.len()).find(late) {
            let problem = Problem::new(format!("{path}[{k}].time"), "the times must ascend");
            self.problems.push(
                problem
                    .found(format!("{} s", times[k]))
                    .accepted([format!("more than {} s", times[k - 1])]),
            );
        }
    }
}

fn clash(path: &str, node: u32, verb: &str, other: &str) -> Problem {
    let message = format!("the support `{other}` {verb} node {node} in this direction already");
    Problem::new(path, message).accepted(["one support for each node and direction"])
}
