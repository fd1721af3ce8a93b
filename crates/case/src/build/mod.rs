//! Stage two: names resolved, meshes read, ranges that need the mesh checked; a system, or every problem found.

mod bodies;
mod contacts;
mod laws;
mod mesh;
mod reference;
mod time;

use std::collections::BTreeMap;
use std::sync::Arc;

use carom_dynamics::{Model, System, Zoned};
use carom_mesh::{Group, Mesh};

use crate::error::Problem;
use crate::input::Input;
use crate::locate::Locator;
use crate::schema::{Case, Motion, Vector};

pub use reference::ExactReference;

/// What a case amounts to.
#[derive(Debug)]
pub struct Built {
    /// The system, ready to be driven.
    pub system: Arc<System>,
    /// The model in zones; `None`: one driver for all. Then `system` is of the whole model ([`System::whole`]).
    pub zoned: Option<Zoned>,
    /// Time at the end, s.
    pub end: f64,
    /// Probes, in the order of their names.
    pub probes: Vec<BuiltProbe>,
    /// The exact solution that the case names.
    pub reference: Option<ExactReference>,
    /// What is strange but not wrong.
    pub warnings: Vec<String>,
}

/// A probe with its nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct BuiltProbe {
    /// Name.
    pub name: String,
    /// Nodes of the mesh.
    pub nodes: Vec<u32>,
    /// What is recorded.
    pub record: Vec<Motion>,
}

/// Builds the system of a case.
///
/// # Errors
/// All problems that stage two can tell, with their places.
pub fn build(case: &Case, locator: &Locator, input: &Input) -> Result<Built, Vec<Problem>> {
    let mut builder = Builder {
        case,
        problems: Vec::new(),
        warnings: Vec::new(),
    };
    let built = builder.build(input);
    match built {
        Some(built) if builder.problems.is_empty() => Ok(built),
        _ => Err(locator.locate_all(builder.problems)),
    }
}

/// Collects problems while it builds.
struct Builder<'a> {
    case: &'a Case,
    problems: Vec<Problem>,
    warnings: Vec<String>,
}

impl Builder<'_> {
    fn build(&mut self, input: &Input) -> Option<Built> {
        let materials = self.materials();
        self.scheme_and_laws();
        let mesh = self.mesh(input)?;
        let bodies = self.bodies(&mesh, &materials);
        let supports = self.supports(&mesh);
        let gravity = self.gravity(&mesh);
        let probes = self.probes(&mesh);
        if !self.problems.is_empty() {
            return None;
        }
        let contacts = self.contacts(&mesh, &bodies);
        if !self.problems.is_empty() {
            return None;
        }
        let scheme = self.scheme();
        let mut model = Model {
            mesh,
            bodies,
            supports,
            gravity,
            contacts,
            scheme,
            dt: f64::MIN_POSITIVE,
            adaptive: None,
        };
        model.dt = self.step(&model)?;
        model.adaptive = self.adaptive(model.dt);
        if !self.problems.is_empty() {
            return None;
        }
        let system = match System::new(model) {
            Ok(system) => system,
            Err(error) => {
                self.problems.push(self.refused(&error));
                return None;
            }
        };
        self.penetration(&system);
        self.advise(&system);
        let end = self.case.time.end.0;
        let reference = self.reference(&system, end);
        Some(Built {
            system,
            zoned: None,
            end,
            probes,
            reference,
            warnings: std::mem::take(&mut self.warnings),
        })
    }

    /// The group called `name`, or a problem at `path`.
    fn group<'m>(&mut self, mesh: &'m Mesh, path: &str, name: &str) -> Option<&'m Group> {
        match mesh.groups.get(name) {
            None => {
                let problem = Problem::new(path, "no group of this name in the mesh");
                self.problems
                    .push(problem.unknown(name, mesh.groups.keys().map(String::as_str)));
                None
            }
            Some(group) if group.elements.is_empty() => {
                let problem = Problem::new(path, "this group of the mesh is empty").found(name);
                self.problems
                    .push(problem.accepted(["a group with elements"]));
                None
            }
            Some(group) => Some(group),
        }
    }

    /// The components of a vector, or a problem where it has more than the mesh.
    fn vector<Q: Copy + Into<f64>>(
        &mut self,
        mesh: &Mesh,
        path: &str,
        vector: &Vector<Q>,
    ) -> [f64; 3] {
        let components = vector.si();
        if components[mesh.dim..].iter().any(|c| *c != 0.0) {
            let message = format!(
                "a component beyond the {} of the mesh",
                dimensions(mesh.dim)
            );
            let problem = Problem::new(path, message).found(format!("{components:?}"));
            self.problems.push(problem.accepted([format!(
                "{}, or zeros after it",
                plural(mesh.dim, "component")
            )]));
        }
        components
    }

    fn supports(&mut self, mesh: &Mesh) -> Vec<carom_dynamics::Support> {
        let mut supports = Vec::new();
        for (name, support) in self.case.support.iter() {
            for (k, axis) in support
                .fix
                .iter()
                .enumerate()
                .filter(|(_, axis)| axis.index() >= mesh.dim)
            {
                let message = format!(
                    "a direction beyond the {} of the mesh",
                    dimensions(mesh.dim)
                );
                let problem = Problem::new(format!("support.{name}.fix[{k}]"), message);
                self.problems.push(
                    problem
                        .found(["x", "y", "z"][axis.index()])
                        .accepted(["x", "y", "z"][..mesh.dim].to_vec()),
                );
            }
            if let Some(group) = self.group(mesh, &format!("support.{name}.on"), &support.on) {
                let mut fix = [false; 3];
                support.fix.iter().for_each(|axis| fix[axis.index()] = true);
                supports.push(carom_dynamics::Support {
                    nodes: mesh.group_nodes(group),
                    fix,
                });
            }
        }
        supports
    }

    fn gravity(&mut self, mesh: &Mesh) -> [f64; 3] {
        match &self.case.load.gravity {
            None => [0.0; 3],
            Some(gravity) => self.vector(mesh, "load.gravity.acceleration", &gravity.acceleration),
        }
    }

    fn probes(&mut self, mesh: &Mesh) -> Vec<BuiltProbe> {
        let mut probes = Vec::new();
        for (name, probe) in self.case.probe.iter() {
            if let Some(group) = self.group(mesh, &format!("probe.{name}.on"), &probe.on) {
                let nodes = mesh.group_nodes(group);
                probes.push(BuiltProbe {
                    name: name.to_string(),
                    nodes,
                    record: probe.record.clone(),
                });
            }
        }
        probes
    }

    fn materials(&mut self) -> BTreeMap<String, carom_materials::Elastic> {
        let of = |(name, material): (&str, &crate::schema::Material)| {
            let elastic = carom_materials::Elastic {
                density: material.density.0,
                young: material.elastic.young.0,
                poisson: material.elastic.poisson,
            };
            (name.to_string(), elastic)
        };
        self.case.material.iter().map(of).collect()
    }
}

fn dimensions(dim: usize) -> String {
    plural(dim, "dimension")
}

fn plural(count: usize, noun: &str) -> String {
    if count == 1 {
        format!("1 {noun}")
    } else {
        format!("{count} {noun}s")
    }
}
