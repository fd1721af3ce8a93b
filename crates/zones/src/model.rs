//! What zones and links are made of.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::error::Error;
use carom_schemes::Scheme;
use carom_system::{Adaptive, Model, ModelLink, NodalLoad, Nonlinear, Solver, System, sides};

/// A group of bodies with its own scheme and step.
#[derive(Clone, Debug)]
pub struct ModelZone {
    /// Name as in the case file.
    pub name: String,
    /// Indices of its bodies in the model.
    pub bodies: Vec<usize>,
    /// Time scheme.
    pub scheme: Scheme,
    /// Steps to one outer step.
    pub substeps: u32,
    /// Steps to one outer step in which none of its contacts can close; `None` for as many.
    pub far: Option<u32>,
}

impl ModelZone {
    /// A zone that takes as many steps whether its contacts are near or far. `substeps`: steps to one outer step.
    pub fn new(
        name: impl Into<String>,
        bodies: Vec<usize>,
        (scheme, substeps): (Scheme, u32),
    ) -> ModelZone {
        ModelZone {
            name: name.into(),
            bodies,
            scheme,
            substeps,
            far: None,
        }
    }
}

/// How the multipliers of links run over an outer step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum LinkKind {
    /// Velocities are equal at every inner instant, those of the outer zone without link forces interpolated (Gravouil and
    /// Combescure 2001). Dissipates with more than one inner step.
    GravouilCombescure,
    /// Multipliers are linear over the outer step, velocities equal at its end (Prakash and Hjelmstad 2004).
    PrakashHjelmstad,
}

/// A model in zones. The step of the model is the outer one, its scheme counts for nothing.
#[derive(Clone, Debug)]
pub struct Zoned {
    /// Bodies, contacts, supports.
    pub model: Model,
    /// Zones; each body is in one of them.
    pub zones: Vec<ModelZone>,
    /// Links.
    pub links: Vec<ModelLink>,
    /// How their multipliers run.
    pub kind: LinkKind,
}

impl Zoned {
    /// The systems of the zones, each with its own scheme and step, and the contacts that have no side elsewhere.
    ///
    /// # Errors
    /// Schemes or steps that do not go together, and [`Error::Zone`] where a zone cannot be built.
    pub fn systems(&self) -> Result<Vec<Arc<System>>, Error> {
        self.check_steps()?;
        let system = |(k, contacts): (usize, &Vec<usize>)| {
            System::new(self.zone(k, contacts)).map_err(|cause| Error::Zone {
                zone: self.zones[k].name.clone(),
                cause: Box::new(cause.into()),
            })
        };
        self.contacts().iter().enumerate().map(system).collect()
    }

    /// The whole model as one system, with assemblies joined by links: what [`crate::Whole`] tells and grades
    /// runs by. It takes no step.
    ///
    /// # Errors
    /// A model that cannot be built.
    pub fn whole(&self) -> Result<Arc<System>, Error> {
        let links = self.links.clone();
        let model = self.model.clone();
        Ok(System::whole(Model { links, ..model })?)
    }

    /// For each contact of the model, whether its sides may move far along each other ([`Model::slide_far`]); those between zones may.
    pub fn slide_far(&self) -> Vec<bool> {
        let mut far = vec![true; self.model.contacts.len()];
        for (k, contacts) in self.contacts().iter().enumerate() {
            let of_zone = self.zone(k, contacts).slide_far();
            for (&contact, slides) in contacts.iter().zip(of_zone) {
                far[contact] = slides;
            }
        }
        far
    }

    /// Zones of the two sides of a contact.
    pub(crate) fn zones_of(&self, contact: usize) -> [usize; 2] {
        let zone_of = |body: usize| {
            let mut zones = self.zones.iter();
            let zone = zones.position(|zone| zone.bodies.contains(&body));
            // discrete elements count on after the bodies
            let discrete = body.checked_sub(self.model.bodies.len());
            zone.unwrap_or_else(|| discrete.map_or(0, |some| self.zone_of_discrete(some)))
        };
        let (secondary, primary) = sides(&self.model.contacts[contact], &self.model);
        let zone = zone_of(secondary);
        [zone, primary.map_or(zone, zone_of)]
    }

    /// The contacts of each zone, without those between zones.
    pub(crate) fn contacts(&self) -> Vec<Vec<usize>> {
        let mut of_zone = vec![Vec::new(); self.zones.len()];
        for k in 0..self.model.contacts.len() {
            let [one, other] = self.zones_of(k);
            if one == other {
                of_zone[one].push(k);
            }
        }
        of_zone
    }

    /// The contacts whose sides are in different zones.
    pub(crate) fn contacts_across(&self) -> Vec<usize> {
        let across = |k: &usize| {
            let [one, other] = self.zones_of(*k);
            one != other
        };
        (0..self.model.contacts.len()).filter(across).collect()
    }

    /// The model of one zone with its own step.
    pub(crate) fn zone(&self, zone: usize, contacts: &[usize]) -> Model {
        let part = &self.zones[zone];
        let whole = &self.model;
        Model {
            mesh: whole.mesh.clone(),
            discrete: self.discrete_of(zone),
            bodies: part
                .bodies
                .iter()
                .map(|&body| whole.bodies[body].clone())
                .collect(),
            supports: whole.supports.clone(),
            // a node of a link would have a part of its force in each zone
            named_supports: Vec::new(),
            gravity: whole.gravity,
            contacts: contacts
                .iter()
                .map(|&contact| whole.contacts[contact].clone())
                .collect(),
            scheme: part.scheme,
            zones: Vec::new(),
            links: Vec::new(),
            constraints: Vec::new(),
            dt: whole.dt / f64::from(part.substeps),
            adaptive: whole.adaptive.map(|rules| Adaptive {
                smallest: rules.smallest / f64::from(part.substeps),
                ..rules
            }),
            // zones end together
            critical_fraction: None,
            nonlinear: self.nonlinear(part),
        }
    }

    /// What belongs to one zone: the loads on its bodies, their damping, the motions of its nodes.
    fn nonlinear(&self, zone: &ModelZone) -> Nonlinear {
        let whole = &self.model.nonlinear;
        let bodies = || {
            zone.bodies
                .iter()
                .map(|&body| &self.model.bodies[body].spec)
        };
        let loads = whole.loads.iter().filter(|load| {
            let first = load.surface.faces.first();
            first.is_some_and(|face| bodies().any(|body| body.cells.contains(&face.parent)))
        });
        let mut used = vec![false; self.model.mesh.nodes.len()];
        for &cell in bodies().flat_map(|body| &body.cells) {
            for &node in self.model.mesh.element_nodes(cell) {
                used[node as usize] = true;
            }
        }
        let motions = whole.motions.iter().map(|motion| {
            let mut motion = motion.clone();
            motion.nodes.retain(|&node| used[node as usize]);
            motion
        });
        let damping = |&body: &usize| whole.damping.get(body).copied().unwrap_or_default();
        let mut iteration = whole.iteration;
        if iteration.solver == Solver::Auto {
            // passes and forces of links solve with a matrix many times in a step
            iteration.solver = Solver::Direct;
        }
        Nonlinear {
            loads: loads.cloned().collect(),
            motions: motions.filter(|motion| !motion.nodes.is_empty()).collect(),
            nodal: self.nodal(zone, &used),
            base: whole.base.clone(),
            turns: (whole.turns.iter())
                .filter(|turn| used[turn.node as usize])
                .cloned()
                .collect(),
            damping: zone.bodies.iter().map(damping).collect(),
            preload: None,
            waiting: Vec::new(),
            iteration,
        }
    }

    /// The loads at nodes of one zone: a node of several zones belongs to the first of them. `used`: nodes of the zone.
    fn nodal(&self, zone: &ModelZone, used: &[bool]) -> Vec<NodalLoad> {
        let model = &self.model;
        let before = self
            .zones
            .iter()
            .take_while(|other| other.name != zone.name);
        let mut taken = vec![false; used.len()];
        for &body in before.flat_map(|zone| &zone.bodies) {
            let cells = model.bodies[body].spec.cells.iter();
            for &node in cells.flat_map(|&cell| model.mesh.element_nodes(cell)) {
                taken[node as usize] = true;
            }
        }
        let own = |node: &u32| used[*node as usize] && !taken[*node as usize];
        let loads = model.nonlinear.nodal.iter().map(|load| NodalLoad {
            nodes: load.nodes.iter().copied().filter(own).collect(),
            ..load.clone()
        });
        loads.filter(|load| !load.nodes.is_empty()).collect()
    }
}
