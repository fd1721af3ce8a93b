//! A scene: two bodies, or one and a rigid disc, and the case file that has them.

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

/// How a scene is stepped, and what of it is rigid. Explicit steps take no rigid bodies, and in space no beams but those along the axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pose {
    /// The theta scheme; the body that moves is rigid, unless it is a beam.
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
    /// Its bodies, of the names of [`NAMES`].
    pub bodies: Vec<Body>,
    /// What a single body meets.
    pub disc: Option<Disc>,
    /// Time at the end, s.
    pub end: f64,
    /// Steps, s.
    pub steps: [f64; 2],
    pose: Pose,
    has_contact: bool,
    /// Young's modulus, Pa, at a density of 1000 kg/m³: so soft that waves cross the smallest cell in more than the larger step.
    young: f64,
}

/// Names of the bodies.
pub const NAMES: [&str; 2] = ["a", "b"];

impl Scene {
    /// Two bodies, of which the second one falls on the first; its way is `way` (m) at `speed` (m/s).
    pub fn falling(
        name: &'static str,
        (parts, pose): ([Part; 2], Pose),
        (speed, way): (f64, f64),
    ) -> Scene {
        let mut velocity = [0.0; 3];
        velocity[parts[0].up()] = -speed;
        let [lower, upper] = parts;
        let is_rigid = pose == Pose::Rigid && upper.cells != Cells::Lines;
        let body = |part, velocity, is_rigid| Body {
            part,
            velocity,
            is_rigid,
        };
        Scene {
            name,
            fate: Fate::Open,
            bodies: vec![
                body(lower, [0.0; 3], false),
                body(upper, velocity, is_rigid),
            ],
            disc: None,
            end: way / speed,
            steps: [2e-4, 4e-4],
            pose,
            has_contact: true,
            young: 1e6,
        }
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
            steps,
            ..self
        }
    }

    /// With nothing between the bodies.
    pub fn without_contact(self) -> Scene {
        Scene {
            has_contact: false,
            ..self
        }
    }

    /// The case file beside the mesh `m.msh`.
    pub fn case(&self, step: f64) -> String {
        let young = self.young;
        let mut text = format!(
            "carom = 1\nmesh.file = \"m.msh\"\n\
             material.solid = {{ density = 1000.0, neo-hooke = {{ young = {young:?}, poisson = 0.3 }} }}\n\
             material.beam = {{ density = 1000.0, elastic = {{ young = {young:?}, poisson = 0.3 }} }}\n"
        );
        for (body, name) in self.bodies.iter().zip(NAMES) {
            text += &self.body(body, name);
        }
        text += &match (self.disc, self.has_contact) {
            (Some(Disc { centre, radius }), _) => format!(
                "contact.disc = {{ secondary = \"a-skin\", obstacle.sphere = {{ centre = {:?}, radius = {radius:?} }}, law.velocity = {{}} }}\n",
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
        text + &format!("time = {{ end = {end:?}, step = {step:?}, scheme.{scheme} = {{}} }}\n")
    }

    fn body(&self, body: &Body, name: &str) -> String {
        let plane = body.part.cells.are_plane();
        let is_beam = body.part.cells == Cells::Lines;
        let material = if is_beam { "beam" } else { "solid" };
        // beams turn by any angle in steps with iterations alone
        let rotations = match self.pose {
            Pose::Explicit => "small",
            Pose::Rigid | Pose::Deformable => "finite",
        };
        let diameter = 2.0 * body.part.radius;
        let section = match is_beam {
            true => format!(
                ", section.beam = {{ shape.circle.diameter = {diameter:?}, rotations = \"{rotations}\" }}"
            ),
            false if plane => ", section.plane-strain.thickness = 1.0".to_owned(),
            false => String::new(),
        };
        let rigid = if body.is_rigid { ", rigid = {}" } else { "" };
        let velocity = &body.velocity[..if plane { 2 } else { 3 }];
        format!(
            "body.{name} = {{ region = \"{name}\", material = \"{material}\"{section}{rigid}, initial.velocity = {velocity:?} }}\n"
        )
    }
}
