//! Stage two: names resolved, meshes read, ranges that need the mesh checked; a system, or every problem found.

mod added;
mod advice;
mod allowables;
mod arlequin;
mod beams;
mod bodies;
mod builder;
mod constraints;
mod contacts;
mod course;
mod damped;
mod discrete;
mod explicit;
mod fluids;
mod general;
mod held;
mod hinged;
mod laws;
mod layers;
mod levels;
mod loads;
mod materials;
mod mesh;
mod nonlinear;
mod obstacles;
mod oscillators;
mod penetration;
mod pieces;
mod plan;
mod pretensions;
mod probes;
mod profiles;
mod reductions;
mod reference;
mod refused;
mod rigid;
mod shells;
mod signals;
mod stops;
mod supports;
mod surfaces;
mod thickness;
mod thin_overlaps;
mod tied;
mod ties;
mod time;
mod transitions;
mod turning;
mod unfit;
mod zones;

use std::sync::Arc;

use carom_dynamics::{Model, Nonlinear, System};
use carom_output::{AllowableSettings, LevelSettings, Spectrum};
use carom_zones::Zoned;

use crate::error::Problem;
use crate::input::Input;
use crate::locate::Locator;
use crate::schema::{Case, Motion};

pub use added::AddedForce;
pub use arlequin::BuiltOverlap;
use arlequin::Joints;
pub(crate) use builder::plural;
use builder::{Builder, dimensions};
use pieces::Joining;
pub use reference::ExactReference;
use time::Size;

/// What a case amounts to.
#[derive(Debug)]
pub struct Built {
    /// The system, ready to be driven unless zones step apart.
    pub system: Arc<System>,
    /// The model in zones, if the case has some.
    pub zoned: Option<Zoned>,
    /// Whether the zones step apart: the system is then all of the model, for output.
    pub apart: bool,
    /// Its overlaps, in the order of their names.
    pub overlaps: Vec<BuiltOverlap>,
    /// Time at the end, s.
    pub end: f64,
    /// End (s) and steps of the static stage before the dynamics, if there is one.
    pub stage: Option<(f64, u32)>,
    /// Contacts that are judged together, in the order of their names.
    pub levels: Vec<LevelSettings>,
    /// What bodies, supports, springs and bolts may bear.
    pub allowables: Vec<AllowableSettings>,
    /// Probes, in the order of their names.
    pub probes: Vec<BuiltProbe>,
    /// The exact solution that the case names.
    pub reference: Option<ExactReference>,
    /// What is strange but not wrong.
    pub warnings: Vec<String>,
    /// Those of them that concern the result.
    pub doubts: Vec<String>,
    /// Bodies whose reduction has a file, and where the reduction comes from.
    pub reductions: Vec<(String, String)>,
    /// Signals, and what they have in words.
    pub signals: Vec<(String, String)>,
}

impl Built {
    /// What another rank than the first has of a case to the time `end` (s): its part of the system.
    pub(crate) fn beside(system: Arc<System>, end: f64) -> Built {
        Built {
            system,
            zoned: None,
            apart: false,
            overlaps: Vec::new(),
            end,
            stage: None,
            levels: Vec::new(),
            allowables: Vec::new(),
            probes: Vec::new(),
            reference: None,
            warnings: Vec::new(),
            doubts: Vec::new(),
            reductions: Vec::new(),
            signals: Vec::new(),
        }
    }
}

/// A probe with its nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct BuiltProbe {
    /// Name.
    pub name: String,
    /// Nodes of the mesh, each with its weight in the mean, relative to the others.
    pub nodes: Vec<(u32, f64)>,
    /// Cell whose stress is recorded.
    pub cell: Option<carom_mesh::ElementId>,
    /// Cell of a beam or a shell in whose section forces are recorded, and the end of a beam.
    pub section: Option<(carom_mesh::ElementId, usize)>,
    /// What is recorded.
    pub record: Vec<Motion>,
    /// Response spectrum of its absolute acceleration.
    pub spectrum: Option<Spectrum>,
    /// Classes (Hz) of the filters of its accelerations.
    pub filters: Vec<u32>,
}

/// Builds the system of a case.
///
/// # Errors
/// All problems that stage two can tell, with their places.
pub fn build(case: &Case, locator: &Locator, input: &Input) -> Result<Built, Vec<Problem>> {
    build_with((case, locator, input), &[])
}

/// As [`build`], to look at: nothing is written, a reduction that has a file and is made anew is not saved.
///
/// # Errors
/// As [`build`].
pub fn build_to_look(case: &Case, locator: &Locator, input: &Input) -> Result<Built, Vec<Problem>> {
    let mut builder = Builder::new(case, input);
    builder.saves = false;
    let built = builder.build(input, &[]);
    finished(built, builder.problems, locator)
}

/// As [`build`], with forces that are in no case file.
///
/// # Errors
/// As [`build`]; those of the forces have no place.
pub fn build_with(
    (case, locator, input): (&Case, &Locator, &Input),
    forces: &[AddedForce],
) -> Result<Built, Vec<Problem>> {
    let mut builder = Builder::new(case, input);
    let built = builder.build(input, forces);
    finished(built, builder.problems, locator)
}

/// What is built, or the problems with their places.
fn finished<T>(
    built: Option<T>,
    problems: Vec<Problem>,
    locator: &Locator,
) -> Result<T, Vec<Problem>> {
    match built {
        Some(built) if problems.is_empty() => Ok(built),
        _ => Err(locator.locate_all(problems)),
    }
}

/// The model of a case without zones, for another rank than the first, which builds its part of it ([`Driver::beside`](carom_dynamics::Driver::beside)).
/// Its step is not known.
///
/// # Errors
/// As [`build`], but for what the system tells.
pub fn model(case: &Case, locator: &Locator, input: &Input) -> Result<Model, Vec<Problem>> {
    let mut builder = Builder::new(case, input);
    let modelled = builder.model(input, &[]);
    let modelled = modelled.map(|modelled| builder.in_one(modelled.model));
    finished(modelled, builder.problems, locator)
}

/// A model, and what is built of a case beside it.
struct Modelled {
    model: Model,
    probes: Vec<BuiltProbe>,
    joints: Joints,
}

impl Builder<'_> {
    /// The model, without its step.
    fn model(&mut self, input: &Input, forces: &[AddedForce]) -> Option<Modelled> {
        self.signals = self.signals(input);
        let materials = self.materials();
        self.schemes();
        if self.plan.zones.is_empty() {
            let one = |_: &str| self.case.time.scheme();
            self.laws(one);
        }
        let mut mesh = self.mesh(input)?;
        self.own_nodes(&mut mesh);
        let mut bodies = self.bodies(&mesh, &materials);
        let mut discrete = self.discrete(&mut mesh);
        discrete.extend(self.fluids(&mut mesh));
        discrete.extend(self.pretensions(&mut mesh, &mut bodies));
        let mut constraints = self.constraints(&mesh, &bodies);
        let turning = self.nodes_with_rotations(&mesh);
        let (transitions, mut links) = self.transitions(&mesh, &bodies, &turning);
        constraints.extend(transitions);
        let (supports, motions, turns) = self.supports(&mesh);
        let gravity = self.gravity(&mesh);
        let loads = self.loads(&mesh, &bodies);
        let mut nodal = self.nodal_loads(&mesh);
        nodal.extend(self.added_forces(&mesh, forces));
        let base = self.base_acceleration(&mesh);
        let probes = self.probes(&mesh, &bodies);
        self.formats();
        if !self.problems.is_empty() {
            return None;
        }
        self.unglued(&mesh, &bodies);
        let joined = hinged::Joined {
            constraints: &constraints,
            supports: &supports,
            turns: &turns,
        };
        self.hinges_to_solids(&mesh, &bodies, &joined);
        let mut joints = self.joints_of(&mesh, &mut bodies, &supports);
        if !self.plan.zones.is_empty() {
            joints.links.append(&mut links);
        }
        let cells: Vec<Vec<carom_mesh::ElementId>> =
            bodies.iter().map(|body| body.spec.cells.clone()).collect();
        let mut contacts = self.contacts(&mesh, &bodies, &cells);
        self.listed_twice(&contacts);
        contacts.extend(self.general_contact(&mesh, (&bodies, &cells), (&contacts, &joints)));
        self.contacts_of_deleted(&bodies, &contacts);
        contacts.extend(self.stops(&mesh, &bodies, &discrete));
        let joining = Joining {
            contacts: &contacts,
            constraints: &constraints,
            links: &joints.links,
            discrete: &discrete,
        };
        self.pieces(&mesh, &bodies, &joining);
        self.nonlinear_in_zones();
        self.stresses_between(&bodies);
        self.explicit_alone(&bodies);
        self.contacts_outside(&mesh, &contacts, &joints);
        self.zones_of_contacts(&contacts, &cells);
        let points = discrete.iter().map(|some| some.spec.cells.clone());
        let all: Vec<_> = cells.iter().cloned().chain(points).collect();
        self.within_bodies(&mesh, &probes, &all);
        if !self.problems.is_empty() {
            return None;
        }
        let mut model = Model {
            named_supports: supports::named(self.case, &mesh),
            mesh,
            bodies,
            discrete,
            supports,
            gravity,
            contacts,
            scheme: self.outer_scheme(),
            dt: f64::MIN_POSITIVE,
            zones: Vec::new(),
            links,
            constraints,
            adaptive: None,
            critical_fraction: None,
            nonlinear: Nonlinear {
                nodal,
                base,
                ..self.nonlinear(loads, (motions, turns))
            },
        };
        model.nonlinear.waiting = self.waiting(&model);
        self.reduce(&mut model, &joints.links, &input.folder);
        self.damp_modes(&mut model);
        self.problems.is_empty().then_some(Modelled {
            model,
            probes,
            joints,
        })
    }

    /// The model of a case without zones as its steps need it, but for their size.
    fn in_one(&mut self, mut model: Model) -> Model {
        let far = model.slide_far();
        self.default_sliding(&mut model.contacts, &far);
        model.critical_fraction = match self.size() {
            (_, Size::Critical(fraction)) => Some(fraction),
            _ => None,
        };
        model
    }

    fn build(&mut self, input: &Input, forces: &[AddedForce]) -> Option<Built> {
        let Modelled {
            mut model,
            probes,
            joints,
        } = self.model(input, forces)?;
        let nodes = model.mesh.nodes.clone();
        let mut zoned = None;
        if self.plan.zones.is_empty() {
            model = self.in_one(model);
            model.dt = self.step(&model.mesh, &model.bodies, || {
                Ok(vec![System::new(model.clone())?])
            })?;
            model.adaptive = self.adaptive(model.dt);
        } else {
            let mut parts = Zoned {
                model: model.clone(),
                zones: self.plan.model_zones(),
                links: joints.links,
                kind: self.plan.kind,
            };
            let far = parts.slide_far();
            for contacts in [&mut model.contacts, &mut parts.model.contacts] {
                self.default_sliding(contacts, &far);
            }
            model.dt = self.step(&model.mesh, &model.bodies, || parts.systems())?;
            parts.model.dt = model.dt;
            parts.model.adaptive = self.adaptive(model.dt);
            zoned = Some(parts);
        }
        if !self.problems.is_empty() {
            return None;
        }
        let system = match &zoned {
            None => System::new(model)
                .map(|system| (system, false))
                .map_err(carom_zones::Error::from),
            Some(zoned) => of_zones(zoned, model),
        };
        let (system, apart) = match system {
            Ok((system, apart)) => (system, apart),
            Err(error) => {
                self.problems.push(self.refused_zones(&error));
                return None;
            }
        };
        self.warn_of_steps(system.dt);
        self.able_to_act(&system);
        self.with_area(&system);
        self.fine_enough(system.dt);
        self.warn_of_oscillators(&system);
        self.penetration(&system);
        self.moved(&system, &nodes);
        self.startable(&system);
        self.advise(&system);
        let levels = self.levels(&system);
        let allowables = self.allowables(&system);
        self.probes_at_contacts(&probes, &system);
        let probes = self.weighed(probes, &system);
        let end = self.case.time.end.0;
        let reference = self.reference(&system, end);
        Some(Built {
            system,
            zoned,
            apart,
            overlaps: joints.overlaps,
            end,
            stage: self.case.time.stage.map(|stage| (stage.end.0, stage.steps)),
            levels,
            allowables,
            probes,
            reference,
            warnings: std::mem::take(&mut self.warnings),
            doubts: std::mem::take(&mut self.doubts),
            reductions: std::mem::take(&mut self.reductions),
            signals: std::mem::take(&mut self.told_signals),
        })
    }
}

/// The system of a model in zones, and whether these step apart.
fn of_zones(zoned: &Zoned, model: Model) -> Result<(Arc<System>, bool), carom_zones::Error> {
    // errors that lie in one zone name it
    zoned.systems()?;
    match zoned.together()? {
        Some(system) => Ok((system, false)),
        None => Ok((System::whole(model)?, true)),
    }
}
