//! Supports: nodes held, and nodes that move as prescribed.

use std::collections::BTreeMap;

use carom_dynamics::{Amplitude, NamedSupport, Prescribed, PrescribedTurn, Support};
use carom_mesh::Mesh;

use super::Builder;
use crate::error::Problem;
use crate::schema::{Case, MovementCourse};

/// Supports, prescribed motions and prescribed rotations.
pub(super) type Held = (Vec<Support>, Vec<Prescribed>, Vec<PrescribedTurn>);

/// What the supports of a case hold or move.
pub(super) fn named(case: &Case, mesh: &Mesh) -> Vec<NamedSupport> {
    let named = case.support.iter().filter_map(|(name, support)| {
        let nodes = mesh.group_nodes(mesh.groups.get(&support.on)?);
        let (mut axes, mut rotations) = ([false; 3], [false; 3]);
        for (axis, turns) in support.fix.iter().map(|axis| axis.index()) {
            match turns {
                true => rotations[axis] = true,
                false => axes[axis] = true,
            }
        }
        if let Some(motion) = &support.motion {
            let moved = [&motion.x, &motion.y, &motion.z].map(|points| points.is_some());
            let turned = [&motion.rx, &motion.ry, &motion.rz].map(|points| points.is_some());
            (0..3).for_each(|i| axes[i] |= moved[i]);
            (0..3).for_each(|i| rotations[i] |= turned[i]);
        }
        Some(NamedSupport {
            name: name.to_owned(),
            nodes,
            axes,
            rotations,
        })
    });
    named.collect()
}

/// Names of the axes.
pub(super) const AXES: [&str; 3] = ["x", "y", "z"];

impl Builder<'_> {
    /// Supports and prescribed motions; no node is held or moved twice in one direction where one of both is a motion.
    pub(super) fn supports(&mut self, mesh: &Mesh) -> Held {
        let (mut supports, mut motions, mut turns) = (Vec::new(), Vec::new(), Vec::new());
        let mut moved: BTreeMap<(u32, usize), &str> = BTreeMap::new();
        let mut held: BTreeMap<(u32, usize), &str> = BTreeMap::new();
        for (name, support) in self.case.support.iter() {
            let path = format!("support.{name}");
            for (k, axis) in support.fix.iter().enumerate() {
                let (axis, turns) = axis.index();
                let path = format!("{path}.fix[{k}]");
                match turns {
                    true => self.turns(mesh, &path, (axis, &support.on)),
                    false => self.within(mesh, &path, axis),
                }
            }
            let Some(group) = self.group(mesh, &format!("{path}.on"), &support.on) else {
                continue;
            };
            let nodes = mesh.group_nodes(group);
            let (mut fix, mut fix_rotations) = ([false; 3], [false; 3]);
            for (axis, turns) in support.fix.iter().map(|axis| axis.index()) {
                match turns {
                    true => fix_rotations[axis] = true,
                    false => fix[axis] = true,
                }
            }
            self.whole_if_rigid(mesh, &path, &nodes, &support.on);
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
                let given = [&motion.rx, &motion.ry, &motion.rz];
                for (axis, points) in given.iter().enumerate() {
                    let Some(points) = points else { continue };
                    let path = format!("{path}.move.r{}", AXES[axis]);
                    self.turns(mesh, &path, (axis, &support.on));
                    let points = points.iter().map(|point| [point.time.0, point.angle.0]);
                    let angle = self.amplitude(&path, points.collect());
                    let beams = self.are_of_beams(mesh, &nodes);
                    // a rigid body has one rotation, beams one at each node
                    let own = if beams { &nodes[..] } else { &nodes[..1] };
                    turns.extend(angle.into_iter().flat_map(|angle| {
                        let turn = move |&node: &u32| PrescribedTurn {
                            node,
                            axis,
                            angle: angle.clone(),
                        };
                        own.iter().map(turn)
                    }));
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
                fix_rotations,
            });
        }
        self.not_held(&moved, &held);
        (supports, motions, turns)
    }

    /// Whether all these nodes are nodes of beams or shells.
    fn are_of_beams(&self, mesh: &Mesh, nodes: &[u32]) -> bool {
        let beams = self.nodes_with_rotations(mesh);
        nodes.iter().all(|node| beams.binary_search(node).is_ok())
    }

    /// Refuses a rotation of what has none: rigid bodies and nodes of beams turn.
    fn turns(&mut self, mesh: &Mesh, path: &str, (axis, on): (usize, &str)) {
        let mut bodies = self.case.body.iter();
        let rigid = bodies.any(|(_, body)| body.region == on && body.rigid.is_some());
        let group = mesh.groups.get(on);
        let beams = group.is_some_and(|group| self.are_of_beams(mesh, &mesh.group_nodes(group)));
        let (message, accepted) = match (rigid || beams, mesh.dim) {
            (false, _) => (
                "nodes of a body that deforms have no rotations, except those of beams and shells",
                "the region of a rigid body, or nodes of beams or shells",
            ),
            (true, 3) => return,
            (true, 2) if axis == 2 => return,
            (true, 2) => ("in the plane a body turns about z only", "rz"),
            (true, _) => ("on a line nothing turns", "x"),
        };
        let problem = Problem::new(path, message).found(on.to_string());
        self.problems.push(problem.accepted([accepted]));
    }

    /// Refuses a part of a rigid body: it is held or moved as a whole.
    fn whole_if_rigid(&mut self, mesh: &Mesh, path: &str, nodes: &[u32], on: &str) {
        let regions: Vec<(String, bool)> = self
            .case
            .body
            .iter()
            .filter(|(_, body)| body.rigid.is_some() && body.region != on)
            .filter_map(|(_, body)| {
                let group = mesh.groups.get(&body.region)?;
                let own = mesh.group_nodes(group);
                let shares = nodes.iter().any(|node| own.binary_search(node).is_ok());
                Some((body.region.clone(), shares))
            })
            .collect();
        for (region, _) in regions.iter().filter(|(_, shares)| *shares) {
            let message = "a rigid body is held or moved as a whole";
            let problem = Problem::new(format!("{path}.on"), message).found(on.to_string());
            self.problems
                .push(problem.accepted([format!("its region, `{region}`")]));
        }
    }

    /// Refuses a direction that the mesh does not have.
    pub(super) fn within(&mut self, mesh: &Mesh, path: &str, axis: usize) {
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
            self.doubt(format!(
                "{path}: the displacement is {start:.4e} m at time 0: the nodes jump there in the first step, which is a shock to the body; begin with displacement = 0 at time = 0"
            ));
        }
    }

    fn movement(&mut self, path: &str, course: &MovementCourse) -> Option<Amplitude> {
        match course {
            MovementCourse::Signal(name) => self.displacement_signal(path, name),
            MovementCourse::Points(points) => {
                let points = points.iter();
                let points = points.map(|point| [point.time.0, point.displacement.0]);
                self.amplitude(path, points.collect())
            }
        }
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
