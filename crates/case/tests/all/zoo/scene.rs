//! A scene: bodies, or one and a rigid disc, and the case file that has them.

use std::fmt;

use super::parts::{Cells, Part, Vec3};

/// What a scene comes to, as it is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fate {
    /// The bodies go through each other: nothing acts between them, or they pass within a step.
    Crosses,
    /// They stay apart.
    Misses,
    /// Contact keeps them apart, or does not.
    Open,
}

/// The size of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// A time, s.
    Of(f64),
    /// A part of the critical step.
    Critical(f64),
}

impl fmt::Display for Step {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Step::Of(step) => write!(f, "{step:?}"),
            Step::Critical(part) => write!(f, "{{ critical = {part:?} }}"),
        }
    }
}

/// The steps at which a scene is run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pace {
    /// These, s, and where the fate is open a longer one, or a shorter one of explicit schemes.
    These([f64; 2]),
    /// This, s, a quarter of it and four times it. Of explicit schemes, which bound it, parts of the critical step.
    Around(f64),
}

/// How a scene is stepped, and what of it is rigid. Explicit steps take no rigid bodies, and in space no beams but those along the axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pose {
    /// The theta scheme; the body that moves is rigid, unless it is a beam or a shell.
    Rigid,
    /// The scheme of energy and momentum, or the theta scheme with beams.
    Deformable,
    /// Central differences.
    Explicit,
}

/// A body of a scene.
#[derive(Clone, Debug)]
pub struct Body {
    /// Its cells.
    pub part: Part,
    /// Its velocity at the start, m/s.
    pub velocity: Vec3,
    /// Whether it is rigid.
    pub is_rigid: bool,
}

/// A rigid disc at rest.
#[derive(Clone, Copy, Debug)]
pub struct Disc {
    /// Its centre.
    pub centre: Vec3,
    /// Its radius, m.
    pub radius: f64,
}

/// A scene.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Its name.
    pub name: &'static str,
    /// What it comes to.
    pub fate: Fate,
    /// Its bodies.
    pub bodies: Vec<Body>,
    /// What a single body meets.
    pub disc: Option<Disc>,
    /// Time at the end, s.
    pub end: f64,
    /// Its steps.
    pub pace: Pace,
    /// The body that may meet itself.
    pub folds: Option<usize>,
    /// Whether the program refuses to run it in its pose.
    pub is_refused: bool,
    pose: Pose,
    has_contact: bool,
    /// Whether its third step is a short one.
    is_gentle: bool,
    /// Young's modulus, Pa, at a density of 1000 kg/m³: so soft that waves cross the smallest cell in more than the larger step.
    young: f64,
    /// The same of beams and shells, which are thin: they may be stiffer.
    young_of_sections: f64,
}

/// Part of the shorter one of two steps that the third one is, or that the longer one is of a third, rude one.
const SHORT: f64 = 0.25;

/// Name of a body by its number.
pub fn name(body: usize) -> String {
    format!("b{body}")
}

impl Scene {
    /// Bodies with their velocities (m/s). In [`Pose::Rigid`] the last one is rigid, unless it is a beam or a shell: these have
    /// no cells from which the inertia follows.
    pub fn of(name: &'static str, (bodies, pose): (Vec<(Part, Vec3)>, Pose), end: f64) -> Scene {
        let last = bodies.len() - 1;
        let body = |(k, (part, velocity)): (usize, (Part, Vec3))| Body {
            is_rigid: k == last && pose == Pose::Rigid && !part.cells.have_section(),
            part,
            velocity,
        };
        Scene {
            name,
            fate: Fate::Open,
            bodies: bodies.into_iter().enumerate().map(body).collect(),
            disc: None,
            end,
            pace: Pace::These([2e-4, 4e-4]),
            folds: None,
            is_refused: false,
            pose,
            has_contact: true,
            is_gentle: false,
            young: 1e6,
            young_of_sections: 1e6,
        }
    }

    /// Two bodies, of which the second one falls on the first; its way is `way` (m) at `speed` (m/s).
    pub fn falling(
        name: &'static str,
        ([lower, upper], pose): ([Part; 2], Pose),
        (speed, way): (f64, f64),
    ) -> Scene {
        let mut velocity = [0.0; 3];
        velocity[lower.up()] = -speed;
        let bodies = vec![(lower, [0.0; 3]), (upper, velocity)];
        Scene::of(name, (bodies, pose), way / speed)
    }

    /// One body that falls on a disc around the origin.
    pub fn onto_disc(
        name: &'static str,
        radius: f64,
        (part, pose): (Part, Pose),
        fall: (f64, f64),
    ) -> Scene {
        let mut scene = Scene::falling(name, ([part.clone(), part], pose), fall);
        scene.bodies.remove(0);
        scene.disc = Some(Disc {
            centre: [0.0; 3],
            radius,
        });
        scene
    }

    /// With the lower body rigid too where the upper one is.
    pub fn both_rigid(mut self) -> Scene {
        self.bodies[0].is_rigid = self.pose == Pose::Rigid;
        self
    }

    /// With what it comes to.
    pub fn fated(self, fate: Fate) -> Scene {
        Scene { fate, ..self }
    }

    /// With another modulus (Pa) and other steps (s).
    pub fn timed(self, young: f64, steps: [f64; 2]) -> Scene {
        Scene {
            young,
            young_of_sections: young,
            pace: Pace::These(steps),
            ..self
        }
    }

    /// With a short step for a third one, in place of a long one, or not.
    pub fn gently(self, is_gentle: bool) -> Scene {
        Scene { is_gentle, ..self }
    }

    /// With another modulus (Pa) of all bodies, and steps around one (s).
    pub fn around(self, young: f64, step: f64) -> Scene {
        Scene {
            young,
            young_of_sections: young,
            pace: Pace::Around(step),
            ..self
        }
    }

    /// With another modulus (Pa) of beams and shells.
    pub fn with_sections(self, young_of_sections: f64) -> Scene {
        Scene {
            young_of_sections,
            ..self
        }
    }

    /// With its first body meeting itself.
    pub fn folding(self) -> Scene {
        Scene {
            folds: Some(0),
            ..self
        }
    }

    /// Not in explicit steps, which take no rigid bodies.
    pub fn not_explicit(self) -> Scene {
        Scene {
            is_refused: self.pose == Pose::Explicit,
            ..self
        }
    }

    /// With no body rigid.
    pub fn never_rigid(mut self) -> Scene {
        for body in &mut self.bodies {
            body.is_rigid = false;
        }
        self
    }

    /// With its last body rigid in all poses.
    pub fn always_rigid(mut self) -> Scene {
        if let Some(body) = self.bodies.last_mut() {
            body.is_rigid = true;
        }
        self
    }

    /// The steps at which it is run.
    pub fn steps(&self) -> Vec<Step> {
        let is_explicit = self.pose == Pose::Explicit;
        match (self.pace, self.fate) {
            (Pace::Around(_), _) if is_explicit => [0.2, 0.5, 0.9].map(Step::Critical).to_vec(),
            (Pace::Around(step), _) => vec![
                Step::Of(SHORT * step),
                Step::Of(step),
                Step::Of(step / SHORT),
            ],
            (Pace::These(steps), Fate::Crosses | Fate::Misses) => steps.map(Step::Of).to_vec(),
            (Pace::These([short, long]), Fate::Open) => {
                let is_gentle = is_explicit || self.is_gentle;
                let more = if is_gentle {
                    SHORT * short
                } else {
                    long / SHORT
                };
                [short, long, more].map(Step::Of).to_vec()
            }
        }
    }

    /// Whether its scheme keeps the energy of what turns far in a step. Theta does not, of shells: it gains while nothing touches, and nothing
    /// in steps of a quarter.
    pub fn keeps_energy(&self) -> bool {
        let mut bodies = self.bodies.iter();
        self.pose != Pose::Rigid || !bodies.any(|body| body.part.cells == Cells::Shells)
    }

    /// With nothing between the bodies.
    pub fn without_contact(self) -> Scene {
        Scene {
            has_contact: false,
            ..self
        }
    }

    /// The case file beside the mesh `m.msh`.
    pub fn case(&self, step: Step) -> String {
        let (young, of_sections) = (self.young, self.young_of_sections);
        let mut text = format!(
            "carom = 1\nmesh.file = \"m.msh\"\n\
             material.solid = {{ density = 1000.0, neo-hooke = {{ young = {young:?}, poisson = 0.3 }} }}\n\
             material.beam = {{ density = 1000.0, elastic = {{ young = {of_sections:?}, poisson = 0.3 }} }}\n"
        );
        for (number, body) in self.bodies.iter().enumerate() {
            text += &self.body(body, &name(number));
        }
        text += &match (self.disc, self.has_contact) {
            (Some(Disc { centre, radius }), _) => format!(
                "contact.disc = {{ secondary = \"b0-skin\", obstacle.sphere = {{ centre = {:?}, radius = {radius:?} }}, law.velocity = {{}} }}\n",
                &centre[..2]
            ),
            (None, true) => "general-contact.law.velocity = {}\n".to_owned(),
            (None, false) => String::new(),
        };
        let has_beam = self
            .bodies
            .iter()
            .any(|body| body.part.cells == Cells::Lines);
        let scheme = match self.pose {
            Pose::Explicit => "central-difference",
            Pose::Deformable if !has_beam => "energy-momentum",
            Pose::Rigid | Pose::Deformable => "theta",
        };
        let end = self.end;
        text + &format!("time = {{ end = {end:?}, step = {step}, scheme.{scheme} = {{}} }}\n")
    }

    fn body(&self, body: &Body, name: &str) -> String {
        let plane = body.part.cells.are_plane();
        let material = match body.part.cells.have_section() {
            true => "beam",
            false => "solid",
        };
        // beams turn by any angle in steps with iterations alone
        let rotations = match self.pose {
            Pose::Explicit => "small",
            Pose::Rigid | Pose::Deformable => "finite",
        };
        let size = 2.0 * body.part.radius;
        let section = match body.part.cells {
            Cells::Lines => format!(
                ", section.beam = {{ shape.circle.diameter = {size:?}, rotations = \"{rotations}\" }}"
            ),
            Cells::Shells => {
                format!(", section.shell = {{ thickness = {size:?}, rotations = \"finite\" }}")
            }
            _ if plane => ", section.plane-strain.thickness = 1.0".to_owned(),
            _ => String::new(),
        };
        let rigid = if body.is_rigid { ", rigid = {}" } else { "" };
        let velocity = &body.velocity[..if plane { 2 } else { 3 }];
        format!(
            "body.{name} = {{ region = \"{name}\", material = \"{material}\"{section}{rigid}, initial.velocity = {velocity:?} }}\n"
        )
    }
}
