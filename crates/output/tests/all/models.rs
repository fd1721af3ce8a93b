//! Small models for whole runs.

use std::path::Path;
use std::sync::Arc;

use carom_bodies::{BodySpec, Kinematics};
use carom_contact::law::{Capture, Displacement, Reading, Velocity};
use carom_contact::{Law, Plane};
use carom_dynamics::scheme::{Newmark, Theta};
use carom_dynamics::{Model, ModelBody, ModelContact, ModelTarget, Scheme, Support, System};
use carom_exact::{Bar, Impact};
use carom_materials::Elastic;
use carom_mesh::{Surface, generate};
use carom_output::{Checkpoints, Fields, Probe, Reference, Settings};

pub const LENGTH: f64 = 0.254;
pub const AREA: f64 = 6.45e-4;
pub const SPEED: f64 = 5.1359;
pub const STEEL: Elastic = Elastic {
    density: 7844.0,
    young: 2.07e11,
    poisson: 0.0,
};

pub fn wave_speed() -> f64 {
    (STEEL.young / STEEL.density).sqrt()
}

/// Exact duration of the contact of the two bars, s.
pub fn duration() -> f64 {
    2.0 * LENGTH / wave_speed()
}

pub fn velocity_law() -> Law {
    Law::Velocity(Velocity {
        capture: Capture::Half,
        reading: Reading::Closed,
    })
}

/// Two equal bars, `n` elements each, Courant number 1/2, theta 1/2, velocity law.
pub fn two_bars(n: usize) -> Arc<System> {
    let line = |name: &str, from: f64| {
        generate::line(name, [from, 0.0, 0.0], [from + LENGTH, 0.0, 0.0], n, 1)
    };
    let mut mesh = line("striker", -LENGTH);
    mesh.merge("target", line("target", 0.0)).unwrap();
    let body = |name: &str, speed: f64| ModelBody {
        velocity: [speed, 0.0, 0.0],
        ..ModelBody::new(BodySpec::new(
            name,
            mesh.groups[name].elements.clone(),
            Kinematics::Bar { area: AREA },
            STEEL,
        ))
    };
    let bodies = vec![body("striker", SPEED), body("target", 0.0)];
    let surface = |group: &str, body: &ModelBody| {
        Surface::new(&mesh, &mesh.groups[group], &body.spec.cells).unwrap()
    };
    let contacts = vec![ModelContact::new(
        "shock",
        surface("striker.right", &bodies[0]),
        ModelTarget::Surface(surface("target.left", &bodies[1])),
        velocity_law(),
    )];
    let model = Model {
        contacts,
        ..Model::new(
            bodies,
            mesh,
            Scheme::Theta(Theta { theta: 0.5 }),
            0.5 * LENGTH / n as f64 / wave_speed(),
        )
    };
    System::new(model).unwrap()
}

/// The exact solution of the two bars, up to `end`.
pub fn exact(end: f64) -> Reference {
    let bar = Bar::new(LENGTH, AREA, STEEL.young, STEEL.density);
    let impact = Impact::TwoBars {
        secondary: bar.with_velocity(-SPEED),
        primary: bar,
        gap: 0.0,
    };
    Reference {
        name: "two-bars".to_owned(),
        solution: carom_exact::solve(&impact, end).unwrap(),
        contact: 0,
        axis: [1.0, 0.0, 0.0],
    }
}

/// A soft block that drops on a rigid plane at 5 m/s: `n` cells a side, Newmark's trapezoid with the displacement law.
/// Without a plane it flies freely.
pub fn block(n: usize, plane: bool) -> Arc<System> {
    let mesh = generate::box_("block", [0.0, 0.0, 0.001], [1.0; 3], [n; 3], false);
    let body = ModelBody {
        velocity: [0.0, 0.0, -5.0],
        ..ModelBody::new(BodySpec::new(
            "block",
            mesh.groups["block"].elements.clone(),
            Kinematics::Solid,
            Elastic {
                density: 1000.0,
                young: 1e9,
                poisson: 0.3,
            },
        ))
    };
    let bottom = Surface::new(&mesh, &mesh.groups["block.bottom"], &body.spec.cells).unwrap();
    let ground = ModelContact::new(
        "ground",
        bottom,
        ModelTarget::rigid(Plane {
            point: [0.0; 3],
            normal: [0.0, 0.0, 1.0],
        }),
        Law::Displacement(Displacement::default()),
    );
    let model = Model {
        supports: Vec::<Support>::new(),
        gravity: [0.0, 0.0, -9.81],
        contacts: if plane { vec![ground] } else { Vec::new() },
        ..Model::new(
            vec![body],
            mesh,
            Scheme::Newmark(Newmark {
                beta: 0.49,
                gamma: 0.9,
            }),
            1e-4,
        )
    };
    System::new(model).unwrap()
}

/// Histories only.
pub fn settings(folder: &Path) -> Settings {
    Settings {
        folder: folder.to_owned(),
        title: "A test".to_owned(),
        case_text: "carom = 1\n".to_owned(),
        version: "0.1.0".to_owned(),
        scheme: "a scheme".to_owned(),
        study: None,
        end: duration(),
        probes: Vec::new(),
        contact_filters: Default::default(),
        levels: Vec::new(),
        allowables: Vec::new(),
        expected: carom_output::expectations::Expected::default(),
        history_every: None,
        compress_histories: false,
        fields: None,
        reference: None,
        zoning: None,
        piece: None,
        warnings: Vec::new(),
        doubts: Vec::new(),
        checkpoints: Checkpoints {
            every: None,
            wall: None,
            keep: 2,
            origin: "a case".to_owned(),
        },
    }
}

pub fn all_fields(every: f64) -> Option<Fields> {
    Some(Fields {
        every,
        displacement: true,
        velocity: true,
        acceleration: true,
        stress: true,
        strain: true,
        principal_stress: true,
        nodal_stress: true,
        rotation: false,
        section_forces: false,
        vtkhdf: false,
    })
}

/// A probe of everything on a group.
pub fn probe(system: &System, name: &str, group: &str) -> Probe {
    Probe {
        name: name.to_owned(),
        nodes: {
            let nodes = system.mesh.group_nodes(&system.mesh.groups[group]);
            nodes.into_iter().map(|node| (node, 1.0)).collect()
        },
        cell: None,
        section: None,
        displacement: true,
        velocity: true,
        acceleration: true,
        absolute_acceleration: false,
        contact: false,
        spectrum: None,
        filters: Vec::new(),
    }
}
