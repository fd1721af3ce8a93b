//! The model of a case: its sections one after another.

use carom_dynamics::{
    Model, ModelBody, ModelConstraint, ModelContact, ModelDiscrete, ModelLink, Nonlinear,
};
use carom_mesh::{ElementId, Mesh};

use super::added::{self, AddedForce};
use super::built::BuiltProbe;
use super::context::Context;
use super::general_sides::Scope;
use super::hinged::{self, Joined};
use super::joints::Joints;
use super::laws::{self, Spring};
use super::loads::{self, Loads};
use super::pieces::{self, Joining};
use super::problems::Problems;
use super::supports::{self, Supports};
use super::time::{self, Size};
use super::{
    arlequin, bodies, constraints, contact_pairs, contacts, damped, discrete, explicit, fluids,
    general, materials, mesh, nonlinear, pretensions, probes, reductions, stops, transitions,
    zones,
};

/// A model, and what is built of a case beside it.
pub(super) struct Modelled {
    pub(super) model: Model,
    pub(super) probes: Vec<BuiltProbe>,
    pub(super) joints: Joints,
    /// The springs of damped laws.
    pub(super) springs: Vec<Spring>,
    /// Bodies whose reduction has a file, and where the reduction comes from.
    pub(super) reductions: Vec<(String, String)>,
}

/// The model, without its step.
pub(super) fn lower(
    context: &Context,
    forces: &[AddedForce],
    problems: &mut Problems,
) -> Option<Modelled> {
    let mut parts = parts(context, forces, problems)?;
    let joints = joints(context, &mut parts, problems);
    let contacts = contacts(context, &parts, &joints, problems);
    check(context, &parts, &joints, &contacts, problems)?;
    let springs = laws::springs(context, &parts.mesh, &parts.bodies, &contacts);
    let Parts {
        supports, loads, ..
    } = parts;
    let mut model = Model {
        named_supports: supports::named(context.case, &parts.mesh),
        mesh: parts.mesh,
        bodies: parts.bodies,
        discrete: parts.discrete,
        supports: supports.supports,
        gravity: loads.gravity,
        contacts,
        scheme: time::outer_scheme(context),
        dt: f64::MIN_POSITIVE,
        zones: Vec::new(),
        links: parts.links,
        constraints: parts.constraints,
        adaptive: None,
        critical_fraction: None,
        nonlinear: Nonlinear {
            loads: loads.surfaces,
            nodal: loads.nodal,
            base: loads.base,
            motions: supports.motions,
            turns: supports.turns,
            ..nonlinear::lower(context)
        },
    };
    model.nonlinear.waiting = nonlinear::waiting(context, &model, problems);
    let reductions = reductions::lower(context, &mut model, &joints.links, problems);
    damped::lower(context, &mut model, problems);
    problems.is_empty().then_some(Modelled {
        model,
        probes: parts.probes,
        joints,
        springs,
        reductions,
    })
}

/// The model of a case without zones as its steps need it, but for their size.
pub(super) fn in_one(context: &Context, mut model: Model) -> Model {
    let far = model.slide_far();
    contacts::default_sliding(context, &mut model.contacts, &far);
    contacts::look_both_ways(context, &mut model);
    model.critical_fraction = match time::size(context) {
        (_, Size::Critical(fraction)) => Some(fraction),
        _ => None,
    };
    model
}

/// The mesh, and what is at its nodes.
struct Parts {
    mesh: Mesh,
    bodies: Vec<ModelBody>,
    discrete: Vec<ModelDiscrete>,
    constraints: Vec<ModelConstraint>,
    /// Links of transitions.
    links: Vec<ModelLink>,
    supports: Supports,
    loads: Loads,
    probes: Vec<BuiltProbe>,
}

/// The sections that stand for themselves.
fn parts(context: &Context, forces: &[AddedForce], problems: &mut Problems) -> Option<Parts> {
    let materials = materials::lower(context, problems);
    time::schemes(context, problems);
    if context.plan.zones.is_empty() {
        time::laws(context, |_| context.case.time.scheme(), problems);
    }
    let mut mesh = mesh::lower(context, problems)?;
    discrete::own_nodes(context, &mut mesh, problems);
    let mut bodies = bodies::lower(context, &mesh, &materials, problems);
    let mut discrete = discrete::lower(context, &mut mesh, problems);
    discrete.extend(fluids::lower(context, &mut mesh, problems));
    let bolts = pretensions::lower(context, &mut mesh, &mut bodies, problems);
    discrete.extend(bolts);
    let mut constraints = constraints::lower(context, &mesh, &bodies, problems);
    let transitions = transitions::lower(context, &mesh, &bodies, problems);
    constraints.extend(transitions.constraints);
    let supports = supports::lower(context, &mesh, problems);
    let mut loads = loads::lower(context, &mesh, &bodies, problems);
    let added = added::lower(context, &mesh, forces, problems);
    loads.nodal.extend(added);
    let probes = probes::lower(context, &mesh, &bodies, problems);
    probes::formats(context, problems);
    problems.is_empty().then_some(Parts {
        mesh,
        bodies,
        discrete,
        constraints,
        links: transitions.links,
        supports,
        loads,
        probes,
    })
}

/// The joints of zones, which change cells and weights of bodies.
fn joints(context: &Context, parts: &mut Parts, problems: &mut Problems) -> Joints {
    let Parts { mesh, bodies, .. } = parts;
    let supports = &parts.supports;
    pieces::unglued(context, mesh, bodies, problems);
    let joined = Joined {
        constraints: &parts.constraints,
        supports: &supports.supports,
        turns: &supports.turns,
    };
    hinged::check(context, mesh, bodies, &joined, problems);
    let mut joints = arlequin::lower(context, mesh, bodies, &supports.supports, problems);
    if !context.plan.zones.is_empty() {
        joints.links.append(&mut parts.links);
    }
    joints
}

/// The contacts of the case, those of the general contact and those of stops.
fn contacts(
    context: &Context,
    parts: &Parts,
    joints: &Joints,
    problems: &mut Problems,
) -> Vec<ModelContact> {
    let Parts { mesh, bodies, .. } = parts;
    let cells = cells_of(bodies);
    let mut contacts = contacts::lower(context, mesh, bodies, &cells, problems);
    contact_pairs::check(&contacts, problems);
    let scope = Scope {
        context,
        mesh,
        bodies,
        cells: &cells,
        named: &contacts,
        joints,
    };
    let general = general::lower(&scope, problems);
    contacts.extend(general);
    explicit::check_contacts(context, bodies, &contacts, problems);
    let stops = stops::lower(context, mesh, bodies, &parts.discrete, problems);
    contacts.extend(stops);
    contacts
}

/// What sections must be together.
fn check(
    context: &Context,
    parts: &Parts,
    joints: &Joints,
    contacts: &[ModelContact],
    problems: &mut Problems,
) -> Option<()> {
    let Parts {
        mesh,
        bodies,
        discrete,
        ..
    } = parts;
    let joining = Joining {
        contacts,
        constraints: &parts.constraints,
        links: &joints.links,
        discrete,
    };
    pieces::check(mesh, bodies, &joining, problems);
    nonlinear::stresses_between(context, bodies, problems);
    explicit::check(context, bodies, problems);
    arlequin::contacts_outside(context, mesh, contacts, joints, problems);
    let mut cells = cells_of(bodies);
    zones::laws(context, contacts, &cells, problems);
    cells.extend(discrete.iter().map(|some| some.spec.cells.clone()));
    probes::within_bodies(context, mesh, &parts.probes, &cells, problems);
    problems.is_empty().then_some(())
}

/// Cells of each body.
fn cells_of(bodies: &[ModelBody]) -> Vec<Vec<ElementId>> {
    bodies.iter().map(|body| body.spec.cells.clone()).collect()
}
