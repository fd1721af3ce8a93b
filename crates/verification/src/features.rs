//! Small models with an impact, each with one feature: what batteries run over besides schemes and laws.
//!
//! A block of 0.6 m x 0.4 m comes down at 5 m/s and 1 m/s sideways on a block of 1 m x 0.5 m, in plane strain, meshes that do not match; where a surface faces itself, a hairpin whose prongs are flung at each other; of shells, a plate that falls
//! on a plate; of links that turn, a bar of a solid and a beam that falls on a plane; with a static stage, a block that is held at one side and pressed down by a traction after the stage.

use std::sync::Arc;

use carom_arlequin::trace;
use carom_bodies::{MassKind, Rotations};
use carom_contact::{Basis, Integration, Law, Sliding};
use carom_dynamics::{
    Adaptive, Amplitude, Closing, Driver, Load, LoadKind, Model, ModelLink, Preload, Scheme, State,
    Stepper, System,
};
use carom_materials::{Branch, Elastic, J2Plasticity, Law as Material, Maxwell, NeoHooke, Plane};
use carom_mesh::{ElementId, Mesh};
use carom_reduction::{Keep, Ratios, damp, reduce};
use carom_zones::{LinkKind, ModelZone, Whole, Zoned};

use crate::battery::laws;
use crate::blocks::{Blocks, RUBBER, SMALLEST, SPEED};
use crate::build::{support, surface};
use crate::hairpin::{self, Hairpin};
use crate::reasons::reason;
use crate::shell_edges::Pair;
use crate::shells::Grid;
use crate::{Error, features_links, glued_turning};

/// What a model has besides scheme and law.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Feature {
    Friction,
    FiniteStrain,
    Plasticity,
    Viscosity,
    Mortar,
    FiniteSliding,
    SelfContact,
    Adaptive,
    EqualZones,
    UnequalZones,
    StaticStage,
    Massless,
    BetweenZones,
    AdaptiveZones,
    Reduced,
    ReducedStage,
    ReducedZones,
    DampedModes,
    DampedModesZones,
    Shells,
    TurningShells,
    TurningLinks,
    TurningLinksApart,
}

impl Feature {
    pub(crate) const ALL: [Feature; 23] = [
        Feature::Friction,
        Feature::FiniteStrain,
        Feature::Plasticity,
        Feature::Viscosity,
        Feature::Mortar,
        Feature::FiniteSliding,
        Feature::SelfContact,
        Feature::Adaptive,
        Feature::EqualZones,
        Feature::UnequalZones,
        Feature::StaticStage,
        Feature::Massless,
        Feature::BetweenZones,
        Feature::AdaptiveZones,
        Feature::Reduced,
        Feature::ReducedStage,
        Feature::ReducedZones,
        Feature::DampedModes,
        Feature::DampedModesZones,
        Feature::Shells,
        Feature::TurningShells,
        Feature::TurningLinks,
        Feature::TurningLinksApart,
    ];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Feature::Friction => "friction",
            Feature::FiniteStrain => "finite strain",
            Feature::Plasticity => "plasticity",
            Feature::Viscosity => "viscoelasticity",
            Feature::Mortar => "mortar",
            Feature::FiniteSliding => "finite sliding",
            Feature::SelfContact => "self-contact",
            Feature::Adaptive => "adaptive",
            Feature::EqualZones => "zones, m = 1",
            Feature::UnequalZones => "zones, m = 4",
            Feature::StaticStage => "static stage",
            Feature::Massless => "massless",
            Feature::BetweenZones => "contact between zones, m = 4",
            Feature::AdaptiveZones => "adaptive zones, m = 4",
            Feature::Reduced => "reduced body",
            Feature::ReducedStage => "reduced body, static stage",
            Feature::ReducedZones => "reduced body, zones, m = 4",
            Feature::DampedModes => "damped modes",
            Feature::DampedModesZones => "damped modes, zones, m = 4",
            Feature::Shells => "shells",
            Feature::TurningShells => "shells, finite rotations",
            Feature::TurningLinks => "links that turn",
            Feature::TurningLinksApart => "links that turn, m = 4",
        }
    }

    /// Steps after which the bodies have pressed for some steps; most have parted.
    pub(crate) fn steps(self) -> u64 {
        match self {
            Feature::SelfContact => 40,
            _ => 24,
        }
    }

    pub(crate) fn material(self) -> Material {
        match self {
            Feature::FiniteStrain => Material::NeoHooke(NeoHooke { initial: RUBBER }),
            // a third of the pressure of the impact ρ c v / 2
            Feature::Plasticity => Material::J2Plasticity(J2Plasticity {
                initial: RUBBER,
                yield_stress: 1e6,
                hardening: 1e8,
            }),
            // relaxes within the impact
            Feature::Viscosity => Material::Maxwell(Maxwell {
                initial: RUBBER,
                branches: [
                    Some(Branch {
                        ratio: 0.3,
                        time: 3e-4,
                    }),
                    None,
                    None,
                    None,
                ],
            }),
            _ => RUBBER.into(),
        }
    }

    /// Whether points are paired at every step: so is what moves or turns far.
    fn sliding(self) -> Sliding {
        match self {
            Feature::Friction
            | Feature::Adaptive
            | Feature::StaticStage
            | Feature::Massless
            | Feature::Reduced
            | Feature::DampedModes
            | Feature::ReducedStage => Sliding::Small,
            _ => Sliding::Finite,
        }
    }

    pub(crate) fn blocks(self, refinement: usize) -> Blocks {
        let elements = match self {
            // enough layers to take the mass of the nodes in contact
            Feature::Massless => [[4, 1, 4], [4, 1, 3]],
            _ => [[3, 1, 2], [2, 1, 2]],
        };
        Blocks {
            dim: 2,
            elements: elements.map(|[x, _, z]| [x * refinement, 1, z * refinement]),
            ..SMALLEST
        }
    }

    /// Laws with their names, one of each kind and the displacement law with projection.
    pub(crate) fn laws(self) -> Result<Vec<(&'static str, Law)>, Error> {
        let all = match self {
            Feature::Shells | Feature::TurningShells => laws(&SHEET, PLATE, 4.0 * PLATE * PLATE)?,
            Feature::TurningLinks | Feature::TurningLinksApart => laws(
                &features_links::SOFT,
                features_links::CELL,
                features_links::SIDE,
            )?,
            Feature::SelfContact => laws(&hairpin::RUBBER, hairpin::THICKNESS, hairpin::LENGTH)?,
            // E, h, and the lower side of the upper block, 1 m thick
            _ => laws(&RUBBER, 0.2, 0.6)?,
        };
        let mut chosen: Vec<(&'static str, Law)> = Vec::new();
        for (_, law) in all {
            let name = match law.projects() {
                true => "displacement, projection",
                false => law.get().name(),
            };
            if chosen.iter().all(|(other, _)| *other != name) {
                chosen.push((name, law));
            }
        }
        Ok(chosen)
    }

    /// The model, with meshes `refinement` times as fine.
    ///
    /// # Errors
    /// A combination that is refused.
    pub(crate) fn built(self, scheme: Scheme, law: Law, refinement: usize) -> Result<Built, Error> {
        let rotations = match self {
            Feature::SelfContact => return flung(scheme, law, refinement),
            Feature::Shells => Some(Rotations::Small),
            Feature::TurningShells => Some(Rotations::Finite),
            Feature::TurningLinks => {
                let model = features_links::bar((scheme, law), refinement)?;
                return Ok(Built::One(System::new(model)?, None));
            }
            Feature::TurningLinksApart => {
                let model = features_links::bar((scheme, law), refinement)?;
                return Built::zoned(glued_turning::apart(model, (scheme, 4)));
            }
            _ => None,
        };
        if let Some(rotations) = rotations {
            let model = plates(rotations, (scheme, law), refinement)?;
            return Ok(Built::One(crate::witness::system(model)?, None));
        }
        let blocks = self.blocks(refinement);
        let mut model = blocks.model(scheme, law, self.sliding())?;
        for body in &mut model.bodies {
            body.spec.material = self.material();
        }
        match self {
            Feature::Friction => model.contacts[0].friction = 0.3.into(),
            Feature::Mortar => {
                model.contacts[0].integration = Integration::Mortar {
                    basis: Basis::Standard,
                }
            }
            Feature::Adaptive => fly(&mut model),
            Feature::AdaptiveZones => {
                fly(&mut model);
                return Built::zoned(zones(model, 4)?);
            }
            Feature::BetweenZones => return Built::zoned(in_contact(model, 4)),
            Feature::StaticStage => preloaded(&mut model)?,
            Feature::Massless => model.contacts[0].massless = true,
            Feature::EqualZones => return Built::zoned(zones(model, 1)?),
            Feature::UnequalZones => return Built::zoned(zones(model, 4)?),
            Feature::Reduced => reduced(&mut model)?,
            Feature::ReducedStage => {
                preloaded(&mut model)?;
                reduced(&mut model)?;
            }
            Feature::DampedModes => damped(&mut model)?,
            Feature::DampedModesZones => {
                damped(&mut model)?;
                return Built::zoned(in_contact(model, 4));
            }
            Feature::ReducedZones => {
                reduced(&mut model)?;
                return Built::zoned(in_contact(model, 4));
            }
            _ => {}
        }
        Ok(Built::One(crate::witness::system(model)?, None))
    }
}

/// A system, or zones, from which runs begin and go on.
pub(crate) enum Built {
    /// A system with the velocities of its start where the model does not say them.
    One(Arc<System>, Option<Vec<f64>>),
    Zoned(Box<Zoned>, Arc<System>),
}

impl Built {
    pub(crate) fn zoned(zoned: Zoned) -> Result<Built, Error> {
        if let Some(system) = zoned.together()? {
            return Ok(Built::One(system, None));
        }
        zoned.systems()?;
        let system = zoned.whole()?;
        Ok(Built::Zoned(Box::new(zoned), system))
    }

    /// A run at its start.
    pub(crate) fn start(&self) -> Result<Box<dyn Stepper>, Error> {
        match self {
            Built::One(..) => Ok(Box::new(self.driver()?)),
            Built::Zoned(zoned, system) => Ok(Box::new(Whole::new(zoned, system.clone())?)),
        }
    }

    /// A run that goes on from [`Stepper::saved`].
    pub(crate) fn resume(&self, bytes: &[u8]) -> Result<Box<dyn Stepper>, Error> {
        match self {
            Built::One(system, _) => {
                let state = State::from_bytes(system, bytes)?;
                Ok(Box::new(Driver::resume(system.clone(), state)?))
            }
            Built::Zoned(zoned, system) => {
                Ok(Box::new(Whole::resume(zoned, system.clone(), bytes)?))
            }
        }
    }

    /// The driver at its start, of a model without zones.
    ///
    /// # Errors
    /// As [`Driver::new`].
    pub(crate) fn driver(&self) -> Result<Driver, Error> {
        let (Built::One(system, _) | Built::Zoned(_, system)) = self;
        let mut driver = Driver::new(system.clone())?;
        if let Built::One(_, Some(velocity)) = self {
            driver.restart(&vec![0.0; velocity.len()], velocity)?;
        }
        Ok(driver)
    }
}

/// A hairpin whose prongs meet after 25 steps.
fn flung(scheme: Scheme, law: Law, refinement: usize) -> Result<Built, Error> {
    let pin = Hairpin {
        dim: 2,
        elements: [8 * refinement, 0, refinement],
        half: false,
        flung: [3.0, 1.0],
        scheme,
        law,
        integration: Integration::Node,
        dt: 4e-4 / refinement as f64,
    };
    let system = crate::witness::system(pin.model()?)?;
    let velocity = pin.fling(&system);
    Ok(Built::One(system, Some(velocity)))
}

/// Of plates: soft, so that steps are long and the rounding of places, in the forces of stiff sections, is little of the momentum.
const SHEET: Elastic = Elastic {
    young: 1e8,
    ..RUBBER
};
/// Elements of the upper plate, and thickness of both, m.
const PLATE: f64 = 0.2;
const THICKNESS: f64 = 0.05;

/// A plate of two by two elements that falls on a plate of two by two wider ones, with a corner over a node and an edge across an edge of it.
fn plates(
    rotations: Rotations,
    (scheme, law): (Scheme, Law),
    refinement: usize,
) -> Result<Model, Error> {
    // waves of bending: critical steps go with the square of the elements
    let dt = 0.09 * PLATE / refinement.pow(2) as f64 / SHEET.wave_speed(Plane::Stress);
    let grid = Grid::new(2 * refinement, 2 * refinement);
    let place = |side: f64, corner: [f64; 2], height: f64| {
        let at = move |s: f64, t: f64| [corner[0] + s * side, corner[1] + t * side, height];
        grid.mesh(&at)
    };
    let height = THICKNESS + 1.2 * dt * SPEED;
    let upper = place(2.0 * PLATE, [0.1, 0.3], height);
    let pair = Pair::new(
        [upper, place(3.0 * PLATE, [0.0; 2], 0.0)],
        (THICKNESS, rotations, SHEET),
    )?;
    let mut model = pair.model(law, (scheme, dt));
    for body in &mut model.bodies {
        body.mass = match scheme.get().needs_lumped_mass() {
            true => MassKind::Lumped,
            false => MassKind::Consistent,
        };
    }
    model.bodies[0].velocity = [1.0, 0.0, -SPEED];
    // what iterations leave of the forces is more of the momentum than in blocks
    model.nonlinear.iteration.tolerance = 1e-11;
    Ok(model)
}

/// A flight of some steps, which adapt themselves to its end.
pub(crate) fn fly(model: &mut Model) {
    let speed = -model.bodies[0].velocity[1];
    model.bodies[0].displacement[1] = 2.3 * model.dt * speed;
    model.adaptive = Some(Adaptive {
        smallest: model.dt / 16.0,
        closing: Closing::Cut,
        growth: None,
        patience: 10,
    });
}

/// The upper block has its nodes in contact, those of loads, and six modes.
pub(crate) fn reduced(model: &mut Model) -> Result<(), Error> {
    let keep = Keep {
        modes: 6,
        ..Keep::default()
    };
    Ok(reduce(model, 0, &keep)?)
}

/// The lowest modes of the upper block are damped.
pub(crate) fn damped(model: &mut Model) -> Result<(), Error> {
    damp(model, 0, &Ratios::Each(vec![0.02, 0.1, 0.05]))?;
    Ok(())
}

/// Each block is a zone; the lower one takes `substeps` steps in one of the upper.
pub(crate) fn in_contact(model: Model, substeps: u32) -> Zoned {
    let zone = |body: usize, substeps| {
        ModelZone::new(
            model.bodies[body].spec.name.clone(),
            vec![body],
            (model.scheme, substeps),
        )
    };
    Zoned {
        zones: vec![zone(0, 1), zone(1, substeps)],
        links: Vec::new(),
        kind: LinkKind::PrakashHjelmstad,
        model,
    }
}

/// Static steps under the weight, then a traction that presses the upper block down for some steps.
pub(crate) fn preloaded(model: &mut Model) -> Result<(), Error> {
    let held = [true, true, false];
    model.supports = vec![
        support(&model.mesh, "upper.left", held)?,
        support(&model.mesh, "lower.bottom", held)?,
    ];
    model.gravity = [0.0, -10.0, 0.0];
    let end = 4.0 * model.dt;
    model.nonlinear.preload = Some(Preload { end, steps: 4 });
    let at = |steps: f64, value: f64| [end + steps * model.dt, value];
    let amplitude = vec![at(0.0, 0.0), at(1.0, 1.0), at(8.0, 1.0), at(9.0, -1.0)];
    model.nonlinear.loads = vec![Load {
        name: "press".to_string(),
        surface: surface(&model.mesh, "upper.top", &model.bodies[0])?,
        kind: LoadKind::Traction([0.0, -5e6, 0.0]),
        amplitude: Amplitude::new(amplitude)?,
    }];
    Ok(())
}

/// The upper half of the upper block is a zone of its own; the rest takes `substeps` steps in one of it.
pub(crate) fn zones(mut model: Model, substeps: u32) -> Result<Zoned, Error> {
    let mesh = &model.mesh;
    let above = |cell: &ElementId| {
        let nodes = mesh.element_nodes(*cell);
        let heights = nodes.iter().map(|&node| mesh.nodes[node as usize][1]);
        heights.sum::<f64>() / nodes.len() as f64 > 0.2
    };
    let cells = model.bodies[0].spec.cells.iter();
    let (top, tip): (Vec<ElementId>, Vec<ElementId>) = cells.partition(|cell| above(cell));
    let rows = trace(mesh, &nodes(mesh, &tip), &nodes(mesh, &top), 1e-9)?.rows;
    let mut upper = model.bodies[0].clone();
    upper.spec.name = "top".to_string();
    upper.spec.cells = top;
    model.bodies[0].spec.cells = tip;
    model.bodies.push(upper);
    let zone = |name: &str, bodies: &[usize], substeps| {
        ModelZone::new(name, bodies.to_vec(), (model.scheme, substeps))
    };
    Ok(Zoned {
        zones: vec![zone("shock", &[0, 1], substeps), zone("rest", &[2], 1)],
        links: vec![ModelLink {
            name: "joint".to_string(),
            zones: [0, 1],
            rows,
        }],
        kind: match substeps {
            1 => LinkKind::GravouilCombescure,
            _ => LinkKind::PrakashHjelmstad,
        },
        model,
    })
}

fn nodes(mesh: &Mesh, cells: &[ElementId]) -> Vec<u32> {
    let nodes = cells
        .iter()
        .flat_map(|&cell| mesh.element_nodes(cell).to_vec());
    let mut nodes: Vec<u32> = nodes.collect();
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

/// Every scheme, that for large transformations too.
pub(crate) fn schemes() -> Vec<Scheme> {
    let mut schemes = Scheme::registered();
    schemes.push(Scheme::EnergyMomentum(
        carom_dynamics::scheme::EnergyMomentum {},
    ));
    schemes
}

/// Name of a scheme with its parameters.
pub(crate) fn label(scheme: Scheme) -> String {
    let debug = format!("{scheme:?}");
    let parameters = debug.split_once('{').and_then(|(_, rest)| {
        let inner = rest.split_once('}')?.0;
        Some(inner.trim().replace(": ", " = "))
    });
    match parameters {
        Some(parameters) => format!("{}, {parameters}", scheme.get().name()),
        None => scheme.get().name().to_string(),
    }
}

/// Every `stride`-th of the pairs of a feature and a scheme, with one of the laws that they take: another with each pair. Meshes are
/// `refinement` times as fine.
///
/// # Errors
/// A model that cannot be built and is not refused.
pub(crate) fn each_pair(
    (stride, refinement): (usize, usize),
    mut run: impl FnMut(Feature, &Built) -> Result<(), Error>,
) -> Result<(), Error> {
    for (k, feature) in Feature::ALL.into_iter().enumerate() {
        let laws = feature.laws()?;
        for (j, scheme) in schemes().into_iter().enumerate() {
            if (k + j) % stride != 0 {
                continue;
            }
            for i in 0..laws.len() {
                let law = laws[(i + j + k) % laws.len()].1;
                match feature.built(scheme, law, refinement) {
                    Ok(built) => {
                        run(feature, &built)?;
                        break;
                    }
                    Err(error) if reason(&error).is_some() => {}
                    Err(error) => return Err(error),
                }
            }
        }
    }
    Ok(())
}
