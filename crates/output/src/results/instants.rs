//! The instant of the largest force of each level, or of all contacts: the structure there, for a picture.
//!
//! A state is kept whenever a force is larger than all before, so memory is one displacement for each level.

use carom_dynamics::{Order, State, StepReport, System};

use crate::Error;
use crate::plot::{Lines, quantity, structure_figure};
use crate::results::settings::LevelSettings;

/// Most instants that are drawn.
const DRAWN: usize = 3;
/// Most lines of a structure that is drawn.
const LINES: usize = 20_000;

/// The instants kept.
#[derive(Debug)]
pub(crate) struct Instants {
    /// Nodes of each line of the structure.
    lines: Vec<[u32; 2]>,
    instants: Vec<Instant>,
}

#[derive(Debug)]
struct Instant {
    /// Name of the level; none for all contacts.
    level: Option<String>,
    contacts: Vec<usize>,
    force: f64,
    /// The contact of the force.
    contact: usize,
    time: f64,
    /// Displacement of the nodes, m.
    moved: Vec<[f64; 3]>,
    /// Forces of all contacts that have one: contact, N.
    forces: Vec<(usize, f64)>,
}

impl Instants {
    /// Nothing yet. Structures of lines are drawn: bars, beams, springs.
    pub(crate) fn new(system: &System, levels: &[LevelSettings]) -> Instants {
        let mut lines = Vec::new();
        for body in &system.bodies {
            for cell in body.cells() {
                let nodes = system.mesh.element_nodes(*cell);
                if let ([one, other, ..], 1) = (nodes, system.mesh.kind(*cell).table().dim) {
                    lines.push([*one, *other].map(|node| system.number[node as usize]));
                }
            }
        }
        let of_level = |level: &LevelSettings| Instant::new(Some(&level.name), &level.contacts);
        let all: Vec<usize> = (0..system.contacts.len()).collect();
        let instants = match (levels, system.dim, lines.len()) {
            (_, 0 | 1, _) | (_, _, 0) => Vec::new(),
            (_, _, count) if count > LINES => Vec::new(),
            ([], ..) => vec![Instant::new(None, &all)],
            (levels, ..) => levels.iter().map(of_level).collect(),
        };
        Instants { lines, instants }
    }

    pub(crate) fn push(&mut self, system: &System, state: &State, report: &StepReport) {
        for instant in &mut self.instants {
            let force = |k: &usize| report.contacts[*k].force;
            let largest = |a: &&usize, b: &&usize| force(a).total_cmp(&force(b));
            let Some(&contact) = instant.contacts.iter().max_by(largest) else {
                continue;
            };
            if force(&contact) <= instant.force {
                continue;
            }
            (instant.force, instant.contact) = (force(&contact), contact);
            instant.time = report.time;
            instant.moved.clear();
            let of = |node| system.of_node(node, &state.motion, Order::Displacement);
            let nodes = 0..system.x.len() as u32;
            instant.moved.extend(nodes.map(of));
            instant.forces.clear();
            let acting = report.contacts.iter().enumerate();
            let acting = acting.filter(|(_, contact)| contact.force > 0.0);
            instant
                .forces
                .extend(acting.map(|(k, contact)| (k, contact.force)));
        }
    }

    /// The pictures of the largest forces, the largest first; none where nothing touched or the structure has no lines.
    pub(crate) fn draw(&self, system: &System) -> Option<Result<String, Error>> {
        let mut shown: Vec<&Instant> = self.instants.iter().filter(|i| i.force > 0.0).collect();
        shown.sort_by(|a, b| b.force.total_cmp(&a.force));
        shown.truncate(DRAWN);
        if shown.is_empty() {
            return None;
        }
        let pictures: Vec<Lines> = shown.iter().map(|i| self.picture(system, i)).collect();
        Some(structure_figure(system.dim, &pictures))
    }

    fn picture(&self, system: &System, instant: &Instant) -> Lines {
        let line = |nodes: &[u32; 2]| {
            nodes.map(|node| (system.x[node as usize], instant.moved[node as usize]))
        };
        let place = |contact: usize| {
            let node = system.contacts[contact].points.first()?.node();
            Some((system.x[node as usize], instant.moved[node as usize]))
        };
        let marks = instant.forces.iter();
        let own = |k: usize| k == instant.contact;
        let marks = marks.filter_map(|(k, force)| Some((place(*k)?, *force, own(*k))));
        let name = &system.contacts[instant.contact].name;
        let level = instant.level.as_deref().map(|level| format!("{level}: "));
        Lines {
            caption: format!(
                "{}{} on {name} at {}",
                level.unwrap_or_default(),
                quantity(instant.force, "N"),
                quantity(instant.time, "s")
            ),
            lines: self.lines.iter().map(line).collect(),
            marks: marks.collect(),
        }
    }
}

impl Instant {
    fn new(level: Option<&str>, contacts: &[usize]) -> Instant {
        Instant {
            level: level.map(str::to_owned),
            contacts: contacts.to_vec(),
            force: 0.0,
            contact: 0,
            time: 0.0,
            moved: Vec::new(),
            forces: Vec::new(),
        }
    }
}
