//! A state as pictures need it: motion of the nodes that are seen, fields of the cells that are seen.

use carom_bodies::{Body, Placement, Scratch};
use carom_contact::law::Status;
use carom_dynamics::{InterfaceState, Motion, Order, System};
use serde::{Deserialize, Serialize};

use crate::results::cells::{Bent, all_bodies, cell_stresses, deleted, plastic_strains};
use crate::results::derived::largest_principal_strain;
use crate::results::stills::Seen;

/// A state that is kept, in single precision but for its largest values.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Still {
    pub(crate) step: u64,
    /// s.
    pub(crate) time: f64,
    /// Displacement of the nodes, m.
    pub(crate) moved: Vec<[f32; 3]>,
    /// Speed of the nodes, m/s.
    pub(crate) speed: Vec<f32>,
    /// Contact pressure at the nodes, Pa, and what they do: 0 no contact point, 1 open, 2 closed, 3 slipping; empty without contacts.
    pub(crate) contact: Vec<(f32, u8)>,
    /// Equivalent stress of the cells, Pa.
    pub(crate) von_mises: Vec<f32>,
    /// The principal stress of the largest magnitude of the cells, positive in tension, Pa.
    pub(crate) principal: Vec<f32>,
    /// Mean pressure of the cells, positive in compression, Pa.
    pub(crate) pressure: Vec<f32>,
    /// Equivalent plastic strain of the cells; none without plasticity.
    pub(crate) plastic: Option<Vec<f32>>,
    /// Whether each cell of all bodies is deleted; none where no body has deletion.
    pub(crate) deleted: Option<Vec<bool>>,
    /// Largest equivalent stress (Pa), plastic strain and magnitude of a principal strain of all cells.
    pub(crate) largest: [Option<Largest>; 3],
    /// Largest equivalent stress (Pa) and plastic strain of each body, each with its cell among those of all bodies.
    pub(crate) of_bodies: Vec<[Option<(f64, u32)>; 2]>,
    /// Kinetic energy ½ Σ m |v|² of each body with lumped masses, J.
    pub(crate) kinetic: Vec<f64>,
    /// Strain energy of each body, J; not finite where a body has none at this state.
    pub(crate) strain: Vec<f64>,
    /// Places with a contact force in the plane, m.
    pub(crate) marks: Vec<[f64; 3]>,
}

/// The largest value of a field at cells.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(crate) struct Largest {
    pub(crate) value: f64,
    /// The cell among those of all bodies.
    pub(crate) cell: u32,
    /// Displacement of its middle, m.
    pub(crate) moved: [f64; 3],
}

impl Still {
    /// Whether it is of this system.
    pub(crate) fn is_of(&self, system: &System, seen: &Seen) -> bool {
        let (nodes, cells) = (seen.nodes.len(), seen.cells.len());
        let (all, bodies) = (seen.body_of_cell.len(), system.bodies.len());
        let contact = if system.contacts.is_empty() { 0 } else { nodes };
        let largest = self.largest.iter().flatten();
        self.time.is_finite()
            && [self.moved.len(), self.speed.len()] == [nodes; 2]
            && self.contact.len() == contact
            && [
                self.von_mises.len(),
                self.principal.len(),
                self.pressure.len(),
            ] == [cells; 3]
            && self.plastic.as_ref().is_none_or(|own| own.len() == cells)
            && self.deleted.as_ref().is_none_or(|own| own.len() == all)
            && [self.kinetic.len(), self.strain.len(), self.of_bodies.len()] == [bodies; 3]
            && largest.into_iter().all(|one| (one.cell as usize) < all)
            && self
                .of_bodies
                .iter()
                .flatten()
                .flatten()
                .all(|(_, cell)| (*cell as usize) < all)
    }

    /// Of an accepted state.
    pub(crate) fn of(
        system: &System,
        seen: &Seen,
        (step, time): (u64, f64),
        (motion, interface): (&Motion, &InterfaceState),
    ) -> Still {
        let moved = seen.nodes.iter().map(|node| {
            let u = system.of_node(*node, motion, Order::Displacement);
            u.map(|u| u as f32)
        });
        let speed = seen.nodes.iter().map(|node| {
            let v = system.of_node(*node, motion, Order::Velocity);
            v.iter().map(|v| v * v).sum::<f64>().sqrt() as f32
        });
        let bodies = all_bodies(system, &motion.history);
        let stress = cell_stresses(&bodies, &motion.u);
        let bent = Bent::new(system, motion, &stress);
        let von_mises = bent.von_mises(&stress);
        let principal = bent.principal(&stress).into_iter();
        let principal = principal.map(|[largest, _, smallest]| match -smallest > largest {
            true => smallest,
            false => largest,
        });
        let principal: Vec<f64> = principal.collect();
        let plastic = plastic_strains(&bodies);
        let deleted = deleted(system, &motion.history);
        let shown = |values: &[f64]| -> Vec<f32> {
            let cells = seen.cells.iter();
            cells.map(|cell| values[*cell as usize] as f32).collect()
        };
        let pressure: Vec<f64> = stress.iter().map(|s| -(s[0] + s[1] + s[2]) / 3.0).collect();
        let is_there = |cell: usize| deleted.as_ref().is_none_or(|deleted| !deleted[cell]);
        let strained = largest_principal_strain((system, &bodies), motion, is_there);
        let at = |(value, cell): (f64, u32)| Largest {
            value,
            cell,
            moved: middle_moved(system, motion, cell),
        };
        let of_bodies = [Some(&von_mises), plastic.as_ref()].map(|values| {
            let values = values.map_or(&[][..], |values| &values[..]);
            by_body(values, (seen, system.bodies.len()), is_there)
        });
        let largest = |values: &[f64]| largest(values, is_there).map(at);
        Still {
            step,
            time,
            moved: moved.collect(),
            speed: speed.collect(),
            contact: contact(system, seen, interface),
            von_mises: shown(&von_mises),
            principal: shown(&principal),
            pressure: shown(&pressure),
            plastic: plastic.as_deref().map(shown),
            largest: [
                largest(&von_mises),
                plastic.and_then(|plastic| largest(&plastic)),
                strained.map(at),
            ],
            of_bodies: {
                let [stress, plastic] = of_bodies;
                stress
                    .into_iter()
                    .zip(plastic)
                    .map(|(stress, plastic)| [stress, plastic])
                    .collect()
            },
            kinetic: kinetic(system, motion),
            strain: strain(system, motion),
            marks: marks(system, motion, interface, time),
            deleted,
        }
    }
}

/// The largest of the values of the cells that are there, and its cell; the first of equals.
fn largest(values: &[f64], is_there: impl Fn(usize) -> bool) -> Option<(f64, u32)> {
    let cells = values.iter().enumerate();
    let cells = cells.filter(|(cell, value)| value.is_finite() && is_there(*cell));
    let larger = |best: (f64, u32), (cell, value): (usize, &f64)| match *value > best.0 {
        true => (*value, cell as u32),
        false => best,
    };
    let best = cells.fold((f64::NEG_INFINITY, 0), larger);
    best.0.is_finite().then_some(best)
}

/// The largest of the values of the cells of each body that are there, and its cell; none of a body without such values.
fn by_body(
    values: &[f64],
    (seen, bodies): (&Seen, usize),
    is_there: impl Fn(usize) -> bool,
) -> Vec<Option<(f64, u32)>> {
    let mut most: Vec<Option<(f64, u32)>> = vec![None; bodies];
    for (cell, (value, body)) in values.iter().zip(&seen.body_of_cell).enumerate() {
        if value.is_finite() && is_there(cell) {
            let most = &mut most[*body as usize];
            if most.is_none_or(|(most, _)| *value > most) {
                *most = Some((*value, cell as u32));
            }
        }
    }
    most
}

/// Mean displacement of the nodes of a cell, m.
fn middle_moved(system: &System, motion: &Motion, cell: u32) -> [f64; 3] {
    let mut elements = system.bodies.iter().flat_map(|body| body.cells());
    let element = elements.nth(cell as usize);
    let nodes = element.map_or(&[][..], |element| system.mesh.element_nodes(*element));
    let count = nodes.len() as f64;
    nodes.iter().fold([0.0; 3], |sum, node| {
        let number = system.number[*node as usize];
        let u = system.of_node(number, motion, Order::Displacement);
        [0, 1, 2].map(|i| sum[i] + u[i] / count)
    })
}

/// Pressure and status of the nodes: of a node that carries several points the mean of their pressures, weighted by shape functions,
/// and the last of open, closed, slipping.
fn contact(system: &System, seen: &Seen, interface: &InterfaceState) -> Vec<(f32, u8)> {
    if system.contacts.is_empty() {
        return Vec::new();
    }
    let mut found = vec![(0.0, 0.0, 0_u8); seen.nodes.len()];
    let points = system.contacts.iter().flat_map(|contact| &contact.points);
    for (number, point) in points.enumerate() {
        let force = interface.force[number];
        let friction = interface.friction.get(number).copied();
        let closed = force != 0.0 || interface.status[number] != Status::Open;
        // with friction below its bound a point sticks; the bound itself is not kept
        let slips = closed && friction.is_some() && slips(system, number, interface);
        let status = match (closed, slips) {
            (false, _) => 1,
            (true, false) => 2,
            (true, true) => 3,
        };
        let pressure = match point.area > 0.0 {
            true => force / point.area,
            false => 0.0,
        };
        // of a point between nodes that is open nothing is to be seen
        if point.stands_between() && !closed {
            continue;
        }
        for (node, weight) in point.carriers().filter(|(_, weight)| *weight > 0.0) {
            let Some(place) = seen.node(node) else {
                continue;
            };
            let entry = &mut found[place];
            entry.0 += weight * pressure;
            entry.1 += weight;
            entry.2 = entry.2.max(status);
        }
    }
    let mean = |(sum, weight, status): (f64, f64, u8)| match weight > 0.0 {
        true => ((sum / weight) as f32, status),
        false => (0.0, status),
    };
    found.into_iter().map(mean).collect()
}

/// Whether the friction force of a point is at its bound μ P, to a millionth of it; where it depends on the speed, above that of fast
/// sliding.
pub(crate) fn slips(system: &System, point: usize, interface: &InterfaceState) -> bool {
    let Some([one, other]) = interface.friction.get(point) else {
        return false;
    };
    let law = system.contacts[system.contact_of(point)].friction;
    let bound = law.get().slides(f64::INFINITY) * interface.force[point];
    bound > 0.0 && one.hypot(*other) >= bound * (1.0 - 1e-6)
}

/// Kinetic energy of each body, J.
fn kinetic(system: &System, motion: &Motion) -> Vec<f64> {
    let of_body = |masses: &Vec<(u32, f64)>| {
        let terms = masses.iter().map(|(node, m)| {
            let v = system.of_node(*node, motion, Order::Velocity);
            0.5 * m * v.iter().map(|v| v * v).sum::<f64>()
        });
        terms.sum()
    };
    system.body_masses.iter().map(of_body).collect()
}

/// Strain energy of each body, J.
fn strain(system: &System, motion: &Motion) -> Vec<f64> {
    let mut forces = vec![0.0; system.unknowns()];
    let bodies = system.bodies.iter().enumerate();
    let of_body = |(k, body): (usize, &Body)| {
        let old = system.history(k, &motion.history);
        let at = Placement {
            u: &motion.u,
            v: &motion.v,
            from: None,
            frames: &motion.frames,
            // nothing moves: the state stays as it is
            dt: 0.0,
            old,
        };
        let mut new = old.to_vec();
        let stored = body.force(&at, &mut new, &mut Scratch::default(), &mut forces);
        stored.map_or(f64::NAN, |stored| stored.strain)
    };
    bodies.map(of_body).collect()
}

/// Places of the points with a force, in the plane.
fn marks(system: &System, motion: &Motion, interface: &InterfaceState, time: f64) -> Vec<[f64; 3]> {
    if system.dim != 2 {
        return Vec::new();
    }
    let places = system.places(time, &motion.u, &motion.frames);
    let points = system.contacts.iter().flat_map(|contact| &contact.points);
    let closed = points.zip(&interface.force).filter(|(_, f)| **f != 0.0);
    closed.map(|(point, _)| point.place(&places)).collect()
}
