//! The instant of the largest force of each level, or of all contacts: the structure there, for a picture.
//!
//! A state is kept whenever a force is larger than all before, so memory is one displacement for each level.

use carom_contact::Point;
use carom_dynamics::{Order, State, StepReport, System};
use carom_pages::plot::{Frame, Lines, Scene, digits, film_figure, quantity, structure_figure};
use serde::{Deserialize, Serialize};

use crate::results::outlines::{Outlines, gap, size};
use crate::results::settings::LevelSettings;
use crate::results::stills::GROWTH;

/// Most instants that are drawn.
const DRAWN: usize = 3;

/// Most lines of a structure that is drawn.
const LINES: usize = 20_000;

/// Largest displacement drawn of solids, as a part of the longest side of the model; larger ones are drawn as they are.
const SHOWN: f64 = 0.06;

/// The instants kept.
#[derive(Debug)]
pub(crate) struct Instants {
    /// Nodes of each line of a structure that has nothing but lines.
    lines: Vec<[u32; 2]>,
    /// Nodes whose displacement is kept, ascending.
    nodes: Vec<u32>,
    instants: Vec<Instant>,
}

#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Instant {
    /// Name of the level; none for all contacts.
    level: Option<String>,
    contacts: Vec<usize>,
    force: f64,
    /// The contact of the force.
    contact: usize,
    time: f64,
    /// Displacement of the nodes that are kept, m.
    moved: Vec<[f64; 3]>,
    /// The contacts that have a force.
    forces: Vec<Acting>,
}

/// A contact with a force.
#[derive(Debug, Serialize, Deserialize)]
struct Acting {
    contact: usize,
    /// N.
    force: f64,
    /// Node of the point with its largest force.
    node: u32,
}

impl Instants {
    /// Nothing yet.
    pub(crate) fn new(system: &System, levels: &[LevelSettings]) -> Instants {
        let outlines = Outlines::new(system, |_, _| true);
        let mut lines = Vec::new();
        for body in &system.bodies {
            for cell in body.cells() {
                let nodes = system.mesh.element_nodes(*cell);
                if let ([one, other, ..], 1) = (nodes, system.mesh.kind(*cell).table().dim) {
                    lines.push([*one, *other].map(|node| system.number[node as usize]));
                }
            }
        }
        let mut nodes = outlines.nodes();
        if !outlines.has_patches() {
            nodes.extend(lines.iter().flatten());
        }
        // a mark may be where nothing is drawn: at a mass
        let points = system.contacts.iter().flat_map(|contact| &contact.points);
        nodes.extend(points.map(Point::node));
        nodes.sort_unstable();
        nodes.dedup();
        let drawn = outlines.has_patches() || (1..=LINES).contains(&lines.len());
        let of_level = |level: &LevelSettings| Instant::new(Some(&level.name), &level.contacts);
        let all: Vec<usize> = (0..system.contacts.len()).collect();
        let instants = match levels {
            _ if system.dim < 2 || !drawn => Vec::new(),
            [] => vec![Instant::new(None, &all)],
            levels => levels.iter().map(of_level).collect(),
        };
        if outlines.has_patches() {
            lines.clear();
        }
        Instants {
            lines,
            nodes,
            instants,
        }
    }

    /// What was kept so far.
    pub(crate) fn kept(&self) -> &[Instant] {
        &self.instants
    }

    /// Whether this can be gone on with.
    pub(crate) fn takes(&self, system: &System, kept: &[Instant]) -> bool {
        let contacts = system.contacts.len();
        let is_of = |(own, kept): (&Instant, &Instant)| {
            let acting = |one: &Acting| one.contact < contacts && self.nodes.contains(&one.node);
            own.level == kept.level
                && own.contacts == kept.contacts
                && kept.contact < contacts.max(1)
                && [0, self.nodes.len()].contains(&kept.moved.len())
                && kept.forces.iter().all(acting)
        };
        kept.len() == self.instants.len() && self.instants.iter().zip(kept).all(is_of)
    }

    /// Goes on from what was kept.
    pub(crate) fn go_on(&mut self, kept: Vec<Instant>) {
        self.instants = kept;
    }

    /// Whether the largest force has grown so far that a state is asked for where other processes have it: by 2 %, as that of the stills.
    pub(crate) fn wants(&self, report: &StepReport) -> bool {
        self.instants.iter().any(|instant| {
            let forces = instant.contacts.iter().map(|&k| report.contacts[k].force);
            forces.fold(0.0, f64::max) > instant.force * GROWTH
        })
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
            let of = |node: &u32| system.of_node(*node, &state.motion, Order::Displacement);
            instant.moved.extend(self.nodes.iter().map(of));
            instant.forces.clear();
            let acting = report.contacts.iter().enumerate();
            let acting = acting.filter(|(_, contact)| contact.force > 0.0);
            let acting = acting.filter_map(|(contact, report)| {
                let forces = &state.interface.force[system.contacts[contact].range.start..];
                let points = system.contacts[contact].points.iter().zip(forces);
                let (point, _) = points.max_by(|a, b| a.1.total_cmp(b.1))?;
                Some(Acting {
                    contact,
                    force: report.force,
                    node: point.node(),
                })
            });
            instant.forces.extend(acting);
        }
    }

    /// The pictures of the largest forces, the largest first; none where nothing touched or nothing has a shape. A structure of lines is
    /// drawn along two axes, solids in perspective beside beams.
    pub(crate) fn draw(&self, system: &System) -> Option<Result<String, carom_pages::Error>> {
        let mut shown: Vec<&Instant> = self.instants.iter().filter(|i| i.force > 0.0).collect();
        shown.sort_by(|a, b| b.force.total_cmp(&a.force));
        shown.truncate(DRAWN);
        if shown.is_empty() {
            return None;
        }
        if self.lines.is_empty() {
            return Some(self.draw_solids(system, &shown));
        }
        let pictures: Vec<Lines> = shown.iter().map(|i| self.picture(system, i)).collect();
        Some(structure_figure(system.dim, &pictures))
    }

    fn picture(&self, system: &System, instant: &Instant) -> Lines {
        let moved = |node: u32| (system.x[node as usize], self.moved(instant, node));
        let own = |acting: &Acting| acting.contact == instant.contact;
        let marks = instant.forces.iter();
        let marks = marks.map(|acting| (moved(acting.node), acting.force, own(acting)));
        Lines {
            caption: instant.caption(system),
            lines: self.lines.iter().map(|line| line.map(moved)).collect(),
            marks: marks.collect(),
        }
    }

    fn draw_solids(
        &self,
        system: &System,
        shown: &[&Instant],
    ) -> Result<String, carom_pages::Error> {
        let outlines = Outlines::new(system, |_, _| true);
        let norm = |u: &[f64; 3]| u.iter().map(|u| u * u).sum::<f64>().sqrt();
        let moved = shown.iter().flat_map(|instant| &instant.moved);
        let largest = moved.map(norm).fold(f64::MIN_POSITIVE, f64::max);
        let factor = (SHOWN * size(system) / largest).max(1.0);
        let frame = |instant: &&Instant| {
            let place = |node: &u32| {
                let (x, u) = (&system.x[*node as usize], self.moved(instant, *node));
                [0, 1, 2].map(|i| x[i] + factor * u[i])
            };
            let value = |nodes: &[u32], _| {
                let of_node = |node: &u32| norm(&self.moved(instant, *node));
                nodes.iter().map(of_node).sum::<f64>() / nodes.len() as f64
            };
            let frame = Frame {
                time: instant.time,
                caption: instant.caption(system),
                marks: instant
                    .forces
                    .iter()
                    .map(|acting| place(&acting.node))
                    .collect(),
                ..Frame::default()
            };
            outlines.frame(system, &place, &value, frame)
        };
        let frames: Vec<Frame> = shown.iter().map(frame).collect();
        let scene = Scene {
            title: &format!("Largest forces: displacement × {}", digits(factor, 3)),
            dim: system.dim,
            field: ("displacement", "m"),
            gap: &|time, place| match factor == 1.0 {
                true => gap(system, time, place),
                // a magnified motion would be seen inside of what stops it
                false => f64::INFINITY,
            },
        };
        film_figure(&scene, &frames)
    }

    /// Displacement of a node, m; zero of one that is not drawn.
    fn moved(&self, instant: &Instant, node: u32) -> [f64; 3] {
        match self.nodes.binary_search(&node) {
            Ok(place) => instant.moved[place],
            Err(_) => [0.0; 3],
        }
    }
}

impl Instant {
    fn caption(&self, system: &System) -> String {
        let level = self.level.as_deref().map(|level| format!("{level}: "));
        format!(
            "{}{} on {} at {}",
            level.unwrap_or_default(),
            quantity(self.force, "N"),
            system.contacts[self.contact].name,
            quantity(self.time, "s")
        )
    }

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
