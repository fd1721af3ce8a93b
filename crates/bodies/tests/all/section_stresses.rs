//! The largest stresses in sections of beams: those of the handbook, for one element along x under the motions of simple loads.

use std::f64::consts::PI;

use carom_algebra::rotation::Rotation;
use carom_algebra::unknowns::{NodeKind, Unknowns};
use carom_bodies::{
    BeamSection, BeamTheory, Body, BodySpec, Extremes, Kinematics, Placement, Rotations, Scratch,
    SectionShape, SectionStress,
};
use carom_elements::Kind;
use carom_materials::{Elastic, J2Plasticity, Law};
use carom_mesh::Mesh;

const STEEL: Elastic = Elastic {
    density: 7800.0,
    young: 2e11,
    poisson: 0.25,
};

const LENGTH: f64 = 0.8;

pub(crate) const SHAPES: [SectionShape; 4] = [
    SectionShape::Circle { diameter: 0.04 },
    SectionShape::Tube {
        diameter: 0.06,
        thickness: 0.004,
    },
    SectionShape::Rectangle {
        height: 0.05,
        width: 0.02,
    },
    SectionShape::I {
        height: 0.1,
        width: 0.06,
        web: 0.005,
        flange: 0.008,
    },
];

/// Half the sizes of a shape along y and z.
fn halves(shape: &SectionShape) -> [f64; 2] {
    match *shape {
        SectionShape::Circle { diameter } | SectionShape::Tube { diameter, .. } => {
            [0.5 * diameter; 2]
        }
        SectionShape::Rectangle { height, width } | SectionShape::I { height, width, .. } => {
            [0.5 * height, 0.5 * width]
        }
    }
}

pub(crate) fn section(shape: &SectionShape) -> BeamSection {
    BeamSection {
        shape: Some(*shape),
        orientation: Some([0.0, 1.0, 0.0]),
        ..BeamSection::new(BeamTheory::EulerBernoulli, shape.properties(STEEL.poisson))
    }
}

/// An element along x from the origin.
pub(crate) fn body(section: BeamSection, law: impl Into<Law>) -> Body {
    let mut mesh = Mesh::new(3);
    mesh.nodes = vec![[0.0; 3], [LENGTH, 0.0, 0.0]];
    let cells = vec![mesh.push(Kind::Bar2, &[0, 1])];
    let kind = match section.rotations {
        Rotations::Small => NodeKind::SmallRotations,
        Rotations::Finite => NodeKind::Turning,
    };
    let spec = BodySpec::new("b", cells, Kinematics::Beam(section), law);
    Body::new(&mesh, spec, &[0, 1], &Unknowns::new(3, [kind; 2])).unwrap()
}

/// Displacements of the second node of a cantilever under forces and moments at its end.
fn deflection(section: &BeamSection, force: [f64; 3], moment: [f64; 3]) -> Vec<f64> {
    let (p, l) = (&section.properties, LENGTH);
    let [along_z, along_y] = p.second_moments.map(|i| STEEL.young * i);
    let twist = moment[0] * l / (STEEL.shear_modulus() * p.torsion);
    let bends = |force: f64, moment: f64, stiffness: f64| {
        let moved = force * l.powi(3) / (3.0 * stiffness) + moment * l * l / (2.0 * stiffness);
        let turned = force * l * l / (2.0 * stiffness) + moment * l / stiffness;
        (moved, turned)
    };
    let (v, about_z) = bends(force[1], moment[2], along_y);
    let (w, against_y) = bends(force[2], -moment[1], along_z);
    let along = force[0] * l / (STEEL.young * p.area);
    let mut u = vec![0.0; 6];
    u.extend([along, v, w, twist, -against_y, about_z]);
    u
}

fn stress(section: &BeamSection, u: &[f64]) -> SectionStress {
    let frames = [Rotation::IDENTITY; 2];
    let all = body(*section, STEEL).section_stresses(u, &frames, &[]);
    all.unwrap()[0]
}

fn near(found: f64, expected: f64, part: f64) {
    assert!((found / expected - 1.0).abs() < part, "{found} {expected}");
}

// rounding of stiff elements that bend: products of K with displacements that cancel
const ROUNDING: f64 = 1e-11;

#[test]
fn a_cantilever_has_the_stress_of_its_moment_at_the_root_and_of_its_normal_force() {
    for shape in &SHAPES {
        let (section, [c, b]) = (section(shape), halves(shape));
        let [about_y, about_z] = section.properties.second_moments;
        let (pull, load) = (2e3, 30.0);
        let mean = pull / section.properties.area;
        for (along, extreme) in [
            (1, load * LENGTH * c / about_z),
            (2, load * LENGTH * b / about_y),
        ] {
            let mut force = [pull, 0.0, 0.0];
            force[along] = load;
            let found = stress(&section, &deflection(&section, force, [0.0; 3]));
            near(found.normal[0], mean + extreme, ROUNDING);
            near(found.normal[1], mean - extreme, ROUNDING);
            // the beam is slender: its extreme fibres decide, where it has no shear stress or, at flanges, little
            near(found.von_mises, mean + extreme, 1e-3);
            near(found.principal[0], mean + extreme, 1e-3);
        }
    }
}

#[test]
fn a_round_section_bends_alike_in_all_directions() {
    for shape in &SHAPES[..2] {
        let (section, [c, _]) = (section(shape), halves(shape));
        let [_, about_z] = section.properties.second_moments;
        for k in 0..50 {
            let (sine, cosine) = (0.1 * f64::from(k)).sin_cos();
            let moment = [0.0, 40.0 * sine, 40.0 * cosine];
            let found = stress(&section, &deflection(&section, [0.0; 3], moment));
            near(found.von_mises, 40.0 * c / about_z, ROUNDING);
        }
    }
}

#[test]
fn torques_and_shear_forces_have_the_shear_stresses_of_the_handbook() {
    let torque = |shape: &SectionShape| {
        let section = section(shape);
        let found = stress(&section, &deflection(&section, [0.0; 3], [25.0, 0.0, 0.0]));
        near(found.von_mises, 3.0_f64.sqrt() * found.shear, ROUNDING);
        near(found.principal[0], found.shear, ROUNDING);
        found.shear
    };
    // T r/J
    near(
        torque(&SHAPES[0]),
        16.0 * 25.0 / (PI * 0.04_f64.powi(3)),
        1e-10,
    );
    // Timoshenko and Goodier, table of §109, of four digits: T/(0.208 a³), T/(0.258 a b²) with a = 2.5 b
    let square = SectionShape::Rectangle {
        height: 0.03,
        width: 0.03,
    };
    near(torque(&square), 25.0 / (0.208 * 0.03_f64.powi(3)), 2e-3);
    near(
        torque(&SHAPES[2]),
        25.0 / (0.258 * 0.05 * 0.02 * 0.02),
        2e-3,
    );
    // the thickest wall of an I
    let i = section(&SHAPES[3]).properties;
    near(torque(&SHAPES[3]), 25.0 * 0.008 / i.torsion, ROUNDING);
    // a short stub: its shear force alone, 3/2 V/A of a rectangle, 4/3 V/A of a circle, 2 V/A of a thin tube
    for (shape, factor, part) in [
        (SHAPES[0], 4.0 / 3.0, ROUNDING),
        (SHAPES[2], 1.5, ROUNDING),
        (
            SectionShape::Tube {
                diameter: 0.06,
                thickness: 1e-5,
            },
            2.0,
            1e-6,
        ),
    ] {
        let section = section(&shape);
        let u = deflection(&section, [0.0, 90.0, 0.0], [0.0, 0.0, -45.0 * LENGTH]);
        near(
            stress(&section, &u).shear,
            factor * 90.0 / section.properties.area,
            part,
        );
    }
}

#[test]
fn shear_stresses_in_the_web_of_an_i_add_up_to_the_shear_force() {
    let SectionShape::I {
        height,
        width,
        web,
        flange,
    } = SHAPES[3]
    else {
        unreachable!()
    };
    let section = section(&SHAPES[3]);
    let found = stress(&section, &deflection(&section, [0.0, 90.0, 0.0], [0.0; 3]));
    // V Q/(I t) at the middle of the web
    let [_, about_z] = section.properties.second_moments;
    let half = 0.5 * height - flange;
    let first = width * flange * 0.5 * (height - flange) + 0.5 * web * half * half;
    near(found.shear, 90.0 * first / (about_z * web), ROUNDING);
}

#[test]
fn properties_have_stresses_where_their_extreme_fibres_are_known() {
    let given = section(&SHAPES[2]);
    let [c, b] = halves(&SHAPES[2]);
    let without = BeamSection {
        shape: None,
        ..given
    };
    let u = deflection(&given, [2e3, 30.0, 10.0], [0.0; 3]);
    assert!(stress(&without, &u).von_mises.is_nan());
    let known = BeamSection {
        extremes: Some(Extremes {
            fibres: [c, b],
            torsion: b,
        }),
        ..without
    };
    let [own, others] = [stress(&known, &u), stress(&given, &u)];
    for k in 0..2 {
        near(own.normal[k], others.normal[k], ROUNDING);
    }
    let u = deflection(&given, [0.0; 3], [25.0, 0.0, 0.0]);
    near(
        stress(&known, &u).shear,
        25.0 * b / given.properties.torsion,
        ROUNDING,
    );
}

#[test]
fn finite_rotations_have_the_stresses_of_small_ones_under_small_loads() {
    for shape in &SHAPES {
        let small = section(shape);
        let large = BeamSection {
            rotations: Rotations::Finite,
            ..small
        };
        // slopes of 1e-6
        let u = deflection(&small, [0.2, 2e-3, 1e-3], [1e-3, 2e-3, 1e-3]);
        let [own, other] = [stress(&large, &u), stress(&small, &u)];
        // the element shears in place of bending within: both have the moments of the ends to first order in the slopes
        near(own.von_mises, other.von_mises, 1e-5);
        near(own.normal[0], other.normal[0], 1e-5);
        near(own.normal[1], other.normal[1], 1e-5);
        near(own.shear, other.shear, 1e-5);
    }
}

#[test]
fn where_a_section_has_flowed_its_stress_is_that_of_its_fibres() {
    let metal = J2Plasticity {
        initial: STEEL,
        yield_stress: 3e8,
        hardening: 0.0,
    };
    for rotations in [Rotations::Small, Rotations::Finite] {
        let section = BeamSection {
            rotations,
            ..section(&SHAPES[2])
        };
        let body = body(section, Law::J2Plasticity(metal));
        // five times the curvature of first yield, of an elastic beam 1.5 GPa
        let [_, about_z] = section.properties.second_moments;
        let moment = 5.0 * 3e8 * about_z / 0.025;
        let mut u = deflection(&section, [0.0; 3], [0.0, 0.0, moment]);
        if rotations == Rotations::Finite {
            // an arc as long as the element; rotations are those of Cayley's map
            let turn = u[11];
            let radius = LENGTH / turn;
            (u[6], u[7]) = (radius * turn.sin() - LENGTH, radius * (1.0 - turn.cos()));
            u[11] = 2.0 * (0.5 * turn).tan();
        }
        let (frames, v) = ([Rotation::IDENTITY; 2], vec![0.0; 12]);
        let mut old = vec![0.0; body.history_len()];
        body.start_history(&mut old);
        let mut new = old.clone();
        let at = Placement {
            u: &u,
            v: &v,
            from: None,
            frames: &frames,
            dt: 1.0,
            old: &old,
        };
        let mut f = vec![0.0; 12];
        body.force(&at, &mut new, &mut Scratch::default(), &mut f)
            .unwrap();
        let found = body.section_stresses(&u, &frames, &new).unwrap()[0];
        // the chord of the arc over its length, 1 - 0.24²/24, changes the strain of the axis, but no fibre at the surface unloads
        near(found.normal[0], 3e8, 1e-9);
        near(found.normal[1], -3e8, 1e-9);
        near(found.von_mises, 3e8, 1e-9);
    }
}
