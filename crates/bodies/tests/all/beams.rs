//! Beams: rigid motions, mass, energies, tangents, refusals.

use carom_algebra::csr::Csr;
use carom_algebra::pattern::Cliques;
use carom_algebra::tensor::{Mat3, Vec3};
use carom_algebra::unknowns::{NodeKind, Unknowns};
use carom_bodies::{
    BeamSection, BeamTheory, Body, BodySpec, CellWeights, Error, Kinematics, Placement, Scratch,
    SectionShape,
};
use carom_elements::Kind;
use carom_materials::{Elastic, J2Plasticity, Law, NeoHooke};
use carom_mesh::{ElementId, Mesh};
use carom_testing::Random;

const STEEL: Elastic = Elastic {
    density: 7800.0,
    young: 2e11,
    poisson: 0.25,
};

const RECTANGLE: SectionShape = SectionShape::Rectangle {
    height: 0.2,
    width: 0.1,
};

fn section(theory: BeamTheory, orientation: Option<[f64; 3]>, offset: [f64; 2]) -> BeamSection {
    BeamSection {
        orientation,
        offset,
        ..BeamSection::new(theory, RECTANGLE.properties(STEEL.poisson))
    }
}

/// Two elements with a corner.
pub fn mesh(dim: usize) -> (Mesh, Vec<ElementId>) {
    let mut mesh = Mesh::new(dim);
    mesh.nodes = vec![[0.5, 0.1, 0.0], [1.3, 0.4, 0.0], [1.5, 1.2, 0.0]];
    if dim == 3 {
        mesh.nodes[1][2] = 0.3;
        mesh.nodes[2][2] = -0.2;
    }
    let cells = vec![
        mesh.push(Kind::Bar2, &[0, 1]),
        mesh.push(Kind::Bar2, &[1, 2]),
    ];
    (mesh, cells)
}

fn map(dim: usize) -> Unknowns {
    Unknowns::new(dim, [NodeKind::SmallRotations; 3])
}

fn built(dim: usize, section: BeamSection) -> Result<Body, Error> {
    let (mesh, cells) = mesh(dim);
    let spec = BodySpec::new("b", cells, Kinematics::Beam(section), STEEL);
    Body::new(&mesh, spec, &[0, 1, 2], &map(dim))
}

/// Both theories in the plane and in space, with and without offset.
fn bodies() -> Vec<(usize, [f64; 2], Body)> {
    let mut bodies = Vec::new();
    for theory in [BeamTheory::EulerBernoulli, BeamTheory::Timoshenko] {
        for (dim, offset) in [
            (2, [0.0, 0.0]),
            (2, [0.07, 0.0]),
            (3, [0.0, 0.0]),
            (3, [0.07, -0.04]),
        ] {
            let orientation = (dim == 3).then_some([0.1, 0.2, 1.0]);
            let body = built(dim, section(theory, orientation, offset)).unwrap();
            bodies.push((dim, offset, body));
        }
    }
    bodies
}

/// A rigid motion of all nodes: translation and rotation about the origin.
fn rigid(dim: usize, translation: Vec3, rotation: Vec3) -> Vec<f64> {
    let (mesh, _) = mesh(dim);
    let mut u = Vec::new();
    for x in &mesh.nodes {
        let moved = translation + rotation.cross(&Vec3::from(*x));
        u.extend(moved.iter().take(dim));
        u.extend(rotation.iter().skip(if dim == 2 { 2 } else { 0 }));
    }
    u
}

fn force(body: &Body, u: &[f64]) -> (Vec<f64>, f64) {
    let mut f = vec![0.0; u.len()];
    let energy = body.internal_force(u, &mut Scratch::default(), &mut f);
    (f, energy)
}

fn matrix(body: &Body, dim: usize, factors: [f64; 3]) -> Csr {
    let unknowns = map(dim);
    let mut cliques = Cliques::new();
    body.each_element(&mut |nodes| {
        let own: Vec<u32> = nodes
            .iter()
            .flat_map(|&node| unknowns.of(node).map(|i| i as u32))
            .collect();
        cliques.push(&own);
    });
    let mut matrix = Csr::from_cliques(unknowns.len(), &cliques);
    body.assemble(factors, &(0..unknowns.len()), &mut matrix);
    matrix
}

#[test]
fn rigid_motions_have_no_force_and_all_forces_no_resultant() {
    for (dim, _, body) in bodies() {
        let mut random = Random(7);
        let mut vector = || Vec3::new(random.next(), random.next(), random.next());
        let (mut move_, mut turn) = (vector(), vector());
        if dim == 2 {
            (move_.z, turn.x, turn.y) = (0.0, 0.0, 0.0);
        }
        let u = rigid(dim, move_, turn);
        let deformed: Vec<f64> = u
            .iter()
            .enumerate()
            .map(|(i, u)| u * (i % 3) as f64)
            .collect();
        let (f, energy) = force(&body, &u);
        let (other, strain) = force(&body, &deformed);
        let size = other.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
        // rounding of products with K
        assert!(f.iter().all(|f| f.abs() < 1e-12 * size));
        assert!(energy.abs() < 1e-12 * strain);
        for mode in 0..6 {
            let mut six = [0.0; 6];
            six[mode] = 1.0;
            if dim == 2 && [2, 3, 4].contains(&mode) {
                continue;
            }
            let motion = rigid(
                dim,
                Vec3::new(six[0], six[1], six[2]),
                Vec3::new(six[3], six[4], six[5]),
            );
            let work: f64 = other.iter().zip(&motion).map(|(f, u)| f * u).sum();
            assert!(work.abs() < 1e-12 * size);
        }
    }
}

/// ½ v·M v of a rigid motion: that of two prisms with mass m, their centroids, and moments of inertia J of a prism about its
/// middle; Euler-Bernoulli neglects the part of J that comes from bending rotations of the section.
#[test]
fn consistent_mass_has_the_kinetic_energy_of_rigid_motions() {
    for (dim, offset, body) in bodies() {
        let beam = body.as_beam().unwrap();
        let SectionPropertiesOf { area, y, z } = properties(beam.section());
        let timoshenko = beam.section().theory == BeamTheory::Timoshenko;
        let mut random = Random(11);
        let mut vector = || Vec3::new(random.next(), random.next(), random.next());
        let (mut move_, mut turn) = (vector(), vector());
        if dim == 2 {
            (move_.z, turn.x, turn.y) = (0.0, 0.0, 0.0);
        }
        let v = rigid(dim, move_, turn);
        let mass = matrix(&body, dim, [0.0, 0.0, 1.0]);
        let mut momentum = vec![0.0; v.len()];
        mass.multiply(&v, &mut momentum);
        let found = 0.5 * v.iter().zip(&momentum).map(|(v, p)| v * p).sum::<f64>();
        let (mesh, _) = mesh(dim);
        let mut exact = 0.0;
        for ends in [[0, 1], [1, 2]] {
            let [a, b] = ends.map(|k| Vec3::from(mesh.nodes[k]));
            let l = (b - a).norm();
            let x = (b - a) / l;
            let near = match dim {
                2 => Vec3::z().cross(&x),
                _ => Vec3::new(0.1, 0.2, 1.0),
            };
            let ey = (near - x * x.dot(&near)).normalize();
            let ez = x.cross(&ey);
            let m = STEEL.density * area * l;
            let middle = (a + b) * 0.5 + ey * offset[0] + ez * offset[1];
            let speed = move_ + turn.cross(&middle);
            let rotary = if timoshenko { STEEL.density * l } else { 0.0 };
            let along = m * l * l / 12.0;
            let inertia = Mat3::from_diagonal(&Vec3::new(
                STEEL.density * l * (y + z),
                along + rotary * y,
                along + rotary * z,
            ));
            let own = Vec3::new(turn.dot(&x), turn.dot(&ey), turn.dot(&ez));
            exact += 0.5 * m * speed.norm_squared() + 0.5 * own.dot(&(inertia * own));
        }
        assert!((found / exact - 1.0).abs() < 1e-12, "{dim} {found} {exact}");
    }
}

struct SectionPropertiesOf {
    area: f64,
    y: f64,
    z: f64,
}

fn properties(section: &BeamSection) -> SectionPropertiesOf {
    let [y, z] = section.properties.second_moments;
    SectionPropertiesOf {
        area: section.properties.area,
        y,
        z,
    }
}

#[test]
fn forces_are_the_matrix_times_the_motion_and_their_work_between_two_states_is_the_energy() {
    for (dim, _, body) in bodies() {
        let n = map(dim).len();
        let mut random = Random(5);
        let mut vector = || -> Vec<f64> { (0..n).map(|_| 1e-3 * random.next()).collect() };
        let (from, to) = (vector(), vector());
        let (f, energy) = force(&body, &to);
        let mut product = vec![0.0; n];
        matrix(&body, dim, [1.0, 0.0, 0.0]).multiply(&to, &mut product);
        let size = f.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
        for (f, p) in f.iter().zip(&product) {
            assert!((f - p).abs() < 1e-12 * size);
        }
        let at = Placement {
            u: &to,
            v: &[],
            from: Some(&from),
            frames: &[],
            dt: 1.0,
            old: &[],
        };
        let mut between = vec![0.0; n];
        let stored = body
            .force(&at, &mut [], &mut Scratch::default(), &mut between)
            .unwrap();
        assert!((stored.strain - energy).abs() < 1e-12 * energy);
        let work: f64 = (0..n).map(|i| between[i] * (to[i] - from[i])).sum();
        let change = energy - force(&body, &from).1;
        assert!((work - change).abs() < 1e-12 * energy.max(change.abs()));
        // the tangent is that of the mean
        let mut tangent = matrix(&body, dim, [0.0; 3]);
        body.add_tangent(&at, [2.0, 0.0], &mut tangent).unwrap();
        let mut twice = vec![0.0; n];
        tangent.multiply(&to, &mut twice);
        for (f, p) in f.iter().zip(&twice) {
            assert!((f - p).abs() < 1e-12 * size);
        }
    }
}

#[test]
fn the_lumped_mass_is_diagonal_in_the_plane_and_along_the_axes_of_space() {
    for (dim, offset, body) in bodies() {
        assert_eq!(body.lumps(), dim == 2 && offset == [0.0; 2]);
    }
    let mut mesh = Mesh::new(3);
    mesh.nodes = vec![[0.0; 3], [0.0, 2.0, 0.0]];
    let cells = vec![mesh.push(Kind::Bar2, &[0, 1])];
    let section = section(BeamTheory::Timoshenko, Some([0.0, 0.3, 1.0]), [0.0; 2]);
    let spec = BodySpec::new("b", cells, Kinematics::Beam(section), STEEL);
    let unknowns = Unknowns::new(3, [NodeKind::SmallRotations; 2]);
    let body = Body::new(&mesh, spec, &[0, 1], &unknowns).unwrap();
    assert!(body.lumps());
    let mut mass = vec![0.0; 12];
    body.add_lumped_mass(&mut mass);
    let m = STEEL.density * 0.02 * 2.0;
    for unknown in [0, 1, 2, 6, 7, 8] {
        assert!((mass[unknown] - 0.5 * m).abs() < 1e-12 * m);
    }
    let polar = STEEL.density * 2.0 * (0.1 * 0.2_f64.powi(3) + 0.2 * 0.1_f64.powi(3)) / 12.0;
    assert!((mass[4] - 0.5 * polar).abs() < 1e-12 * polar);
}

#[test]
fn what_is_no_beam_is_refused() {
    let plain = |orientation| section(BeamTheory::Timoshenko, orientation, [0.0; 2]);
    assert!(matches!(
        built(3, plain(None)),
        Err(Error::BeamAxes { why, .. }) if why.contains("needs an orientation")
    ));
    let along = [0.8, 0.3, 0.3];
    assert!(matches!(
        built(3, plain(Some(along))),
        Err(Error::BeamAxes { why, .. }) if why.contains("parallel")
    ));
    // round ones need none, unless they stand beside their nodes
    let mut round = plain(None);
    round.properties = SectionShape::Circle { diameter: 0.1 }.properties(0.3);
    assert!(built(3, round).is_ok());
    round.offset = [0.1, 0.0];
    assert!(matches!(built(3, round), Err(Error::BeamAxes { .. })));
    let refused = |mesh: &Mesh, spec: BodySpec| {
        let unknowns = Unknowns::new(mesh.dim, vec![NodeKind::SmallRotations; mesh.nodes.len()]);
        let number: Vec<u32> = (0..mesh.nodes.len() as u32).collect();
        Body::new(mesh, spec, &number, &unknowns).unwrap_err()
    };
    let spec = |cells, law: Law| BodySpec::new("b", cells, Kinematics::Beam(plain(None)), law);
    let (mut short, cells) = mesh(2);
    short.nodes[1] = short.nodes[0];
    let error = refused(&short, spec(cells, STEEL.into()));
    assert!(error.to_string().contains("has no length"), "{error}");
    let mut line = Mesh::new(1);
    line.nodes = vec![[0.0; 3], [1.0, 0.0, 0.0]];
    let cells = vec![line.push(Kind::Bar2, &[0, 1])];
    let error = refused(&line, spec(cells, STEEL.into()));
    assert!(matches!(error, Error::BeamOnLine { .. }));
    let (plane, cells) = mesh(2);
    let soft = Law::NeoHooke(NeoHooke { initial: STEEL });
    let error = refused(&plane, spec(cells.clone(), soft));
    assert!(matches!(error, Error::FiniteKinematics { .. }));
    let mut glued = spec(cells, STEEL.into());
    let weights = |stiffness: f64| CellWeights {
        inertia: vec![1.0; 4],
        stiffness: vec![stiffness; 4],
    };
    glued.weights = Some(weights(-0.1));
    let error = refused(&plane, glued.clone());
    assert!(matches!(error, Error::NegativeStiffness { .. }));
    glued.weights = Some(weights(0.5));
    let mut large = plain(None);
    large.rotations = carom_bodies::Rotations::Finite;
    glued.kinematics = Kinematics::Beam(large);
    let unknowns = Unknowns::new(2, [NodeKind::Turning; 3]);
    assert!(Body::new(&plane, glued.clone(), &[0, 1, 2], &unknowns).is_ok());
    glued.material = Law::J2Plasticity(J2Plasticity {
        initial: STEEL,
        yield_stress: 4e8,
        hardening: 1e9,
    });
    let error = Body::new(&plane, glued, &[0, 1, 2], &unknowns).unwrap_err();
    assert!(matches!(error, Error::BeamWeights { .. }));
}
