//! Bars and beams of metal that flows: they are the elastic ones until they do, their tangents, their section forces, refusals.

use carom_algebra::csr::Csr;
use carom_algebra::pattern::Cliques;
use carom_algebra::rotation::Rotation;
use carom_algebra::unknowns::{NodeKind, Unknowns};
use carom_bodies::{
    BeamSection, BeamTheory, Body, BodySpec, CellWeights, Error, Kinematics, Placement, Release,
    Rotations, Scratch, SectionShape, Stored,
};
use carom_materials::{Elastic, J2Plasticity, Law, NeoHooke};
use carom_mesh::Mesh;
use carom_testing::{Random, allocations};

use crate::beams::mesh;

const STEEL: Elastic = Elastic {
    density: 7800.0,
    young: 2e11,
    poisson: 0.25,
};

const METAL: J2Plasticity = J2Plasticity {
    initial: STEEL,
    yield_stress: 3e8,
    hardening: 2e10,
};

const SHAPE: SectionShape = SectionShape::I {
    height: 0.2,
    width: 0.1,
    web: 0.01,
    flange: 0.015,
};

/// A kind of body on the mesh, and the kind of its nodes.
#[derive(Clone, Copy, Debug)]
struct Sample {
    dim: usize,
    kinematics: Kinematics,
    nodes: NodeKind,
}

fn samples() -> Vec<Sample> {
    let mut samples = Vec::new();
    for dim in [2, 3] {
        samples.push(Sample {
            dim,
            kinematics: Kinematics::Bar { area: 0.02 },
            nodes: NodeKind::Translations,
        });
        for theory in [BeamTheory::EulerBernoulli, BeamTheory::Timoshenko] {
            let section = BeamSection {
                shape: Some(SHAPE),
                orientation: (dim == 3).then_some([0.1, 0.2, 1.0]),
                ..BeamSection::new(theory, SHAPE.properties(STEEL.poisson))
            };
            let beside = BeamSection {
                offset: [0.07, if dim == 3 { -0.04 } else { 0.0 }],
                foundation: [1e7, 2e7, if dim == 3 { 3e7 } else { 2e7 }],
                ..section
            };
            let large = BeamSection {
                rotations: Rotations::Finite,
                ..section
            };
            for (section, nodes) in [
                (section, NodeKind::SmallRotations),
                (beside, NodeKind::SmallRotations),
                (large, NodeKind::Turning),
            ] {
                samples.push(Sample {
                    dim,
                    kinematics: Kinematics::Beam(section),
                    nodes,
                });
            }
        }
    }
    samples
}

impl Sample {
    fn unknowns(&self) -> Unknowns {
        Unknowns::new(self.dim, [self.nodes; 3])
    }

    fn spec(&self, law: impl Into<Law>) -> (Mesh, BodySpec) {
        let (mesh, cells) = mesh(self.dim);
        (mesh, BodySpec::new("b", cells, self.kinematics, law))
    }

    fn body(&self, law: impl Into<Law>) -> Body {
        let (mesh, spec) = self.spec(law);
        Body::new(&mesh, spec, &[0, 1, 2], &self.unknowns()).unwrap()
    }

    fn is_large(&self) -> bool {
        matches!(self.nodes, NodeKind::Turning)
    }

    /// A random motion with strains of about this size.
    fn motion(&self, random: &mut Random, size: f64) -> Vec<f64> {
        (0..self.unknowns().len())
            .map(|_| random.between(-size, size))
            .collect()
    }
}

const FRAMES: [Rotation; 3] = [Rotation::IDENTITY; 3];

fn at<'a>(u: &'a [f64], v: &'a [f64], old: &'a [f64]) -> Placement<'a> {
    Placement {
        u,
        v,
        from: None,
        frames: &FRAMES,
        dt: 1.0,
        old,
    }
}

fn fresh(body: &Body) -> Vec<f64> {
    let mut history = vec![f64::NAN; body.history_len()];
    body.start_history(&mut history);
    history
}

/// Forces, energies and the history after a step to `u`.
fn stepped(body: &Body, u: &[f64], old: &[f64]) -> (Vec<f64>, Stored, Vec<f64>) {
    let (mut f, mut new) = (vec![0.0; u.len()], old.to_vec());
    let v = vec![0.0; u.len()];
    let stored = body.force(&at(u, &v, old), &mut new, &mut Scratch::default(), &mut f);
    (f, stored.unwrap(), new)
}

fn tangent(body: &Body, unknowns: &Unknowns, u: &[f64], old: &[f64]) -> Csr {
    let mut cliques = Cliques::new();
    body.each_element(&mut |nodes| {
        let of_node = |&node: &u32| unknowns.of(node).map(|i| i as u32);
        let own: Vec<u32> = nodes.iter().flat_map(of_node).collect();
        cliques.push(&own);
    });
    let mut matrix = Csr::from_cliques(unknowns.len(), &cliques);
    let v = vec![0.0; u.len()];
    body.add_tangent(&at(u, &v, old), [1.0, 0.0], &mut matrix)
        .unwrap();
    matrix
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, x| most.max(x.abs()))
}

fn near(found: &[f64], expected: &[f64], part: f64, what: &Sample) {
    let size = largest(expected);
    for (found, expected) in found.iter().zip(expected) {
        let difference = (found - expected).abs();
        assert!(difference < part * size, "{found} {expected} {what:?}");
    }
}

#[test]
fn what_does_not_flow_is_the_elastic_body() {
    let mut random = Random(3);
    for sample in samples() {
        let (metal, elastic) = (sample.body(METAL_LAW), sample.body(STEEL));
        assert!(!metal.is_linear());
        assert_eq!(metal.has_finite_motion(), sample.is_large());
        // strains of about 1e-4: the yield strain is 1.5e-3
        let u = sample.motion(&mut random, 5e-5);
        let old = fresh(&metal);
        let (f, stored, new) = stepped(&metal, &u, &old);
        let (g, plain, _) = stepped(&elastic, &u, &[]);
        assert!(new.iter().all(|kept| *kept == 0.0));
        // sums of some hundred fibres, and rigid motions that cancel
        near(&f, &g, 1e-11, &sample);
        assert!((stored.strain - plain.strain).abs() < 1e-11 * plain.strain);
        assert_eq!((stored.dissipated, stored.hardening), (0.0, 0.0));
        let unknowns = sample.unknowns();
        let matrices = [(&metal, &old[..]), (&elastic, &[][..])]
            .map(|(body, old)| tangent(body, &unknowns, &u, old));
        let x: Vec<f64> = u.iter().map(|_| random.next()).collect();
        let images = matrices.map(|matrix| {
            let mut image = vec![0.0; x.len()];
            matrix.multiply(&x, &mut image);
            image
        });
        near(&images[0], &images[1], 1e-11, &sample);
        for ((volume, stress), (other, expected)) in metal
            .stresses(&u, &new)
            .iter()
            .zip(elastic.stresses(&u, &[]))
        {
            assert!((volume / other - 1.0).abs() < 1e-12);
            assert!((stress - expected).norm() < 1e-10 * expected.norm());
        }
        let bounds = [&metal, &elastic].map(Body::frequency_bound);
        assert_eq!(bounds[0], bounds[1]);
    }
}

const METAL_LAW: Law = Law::J2Plasticity(METAL);

#[test]
fn the_tangent_is_the_derivative_of_the_force() {
    let mut random = Random(4);
    for sample in samples() {
        let body = sample.body(METAL_LAW);
        let (_, stored, old) = stepped(&body, &sample.motion(&mut random, 4e-3), &fresh(&body));
        assert!(stored.dissipated > 0.0 && stored.hardening > 0.0);
        // all fibres flow on, far from the border of yield: those nearest to it decide the size of the step
        let u = sample.motion(&mut random, 4e-3);
        let matrix = tangent(&body, &sample.unknowns(), &u, &old);
        let direction: Vec<f64> = u.iter().map(|_| random.next()).collect();
        let mut image = vec![0.0; u.len()];
        matrix.multiply(&direction, &mut image);
        let moved = |step: f64| {
            let u: Vec<f64> = u
                .iter()
                .zip(&direction)
                .map(|(u, d)| u + step * d)
                .collect();
            stepped(&body, &u, &old).0
        };
        let step = 1e-9;
        let (after, before) = (moved(step), moved(-step));
        let slope: Vec<f64> = after
            .iter()
            .zip(&before)
            .map(|(a, b)| (a - b) / (2.0 * step))
            .collect();
        // that of finite rotations is the symmetric part: forces times rotations of the step, 1e-2, are left out; a fibre may begin to
        // flow within the step
        let part = if sample.is_large() { 1e-2 } else { 1e-5 };
        near(&image, &slope, part, &sample);
    }
}

#[test]
fn section_forces_balance_the_forces_at_the_nodes_and_the_known_history_gives_them_again() {
    let mut random = Random(5);
    for sample in samples() {
        let Kinematics::Beam(section) = sample.kinematics else {
            continue;
        };
        if section.foundation != [0.0; 3] {
            continue;
        }
        let body = sample.body(METAL_LAW);
        let u = sample.motion(&mut random, 8e-3);
        let (f, _, new) = stepped(&body, &u, &fresh(&body));
        let forces = body.section_forces(&u, &FRAMES, &new).unwrap();
        let strains = body.plastic_strains(&new).unwrap();
        assert!(strains.iter().any(|strain| *strain > 0.0));
        // the last node belongs to the second element alone: its force has the size of that in the section
        let dim = sample.dim;
        let last = &f[f.len() - if dim == 2 { 3 } else { 6 }..];
        let size = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
        let at_node = size(&last[..dim]);
        assert!((size(&forces[1].force) / at_node - 1.0).abs() < 1e-10);
        let moment = size(&last[dim..]);
        // moments of the increments of finite rotations differ from those in space by these, 8e-3
        let part = if sample.is_large() { 2e-2 } else { 1e-10 };
        assert!((size(&forces[1].moment_second) / moment - 1.0).abs() < part);
        if sample.is_large() {
            continue;
        }
        for (stress, forces) in body.stresses(&u, &new).iter().zip(&forces) {
            let mean = forces.force[0] / section.properties.area;
            assert!((stress.1.trace() - mean).abs() < 1e-9 * mean.abs());
        }
    }
}

#[test]
fn forces_allocate_nothing() {
    let mut random = Random(8);
    for sample in samples() {
        let body = sample.body(METAL_LAW);
        let (u, old) = (sample.motion(&mut random, 8e-3), fresh(&body));
        let (mut new, mut f, v) = (old.clone(), vec![0.0; u.len()], vec![0.0; u.len()]);
        let mut scratch = Scratch::default();
        let before = allocations();
        let stored = body.force(&at(&u, &v, &old), &mut new, &mut scratch, &mut f);
        assert_eq!(allocations() - before, 0, "{sample:?}");
        assert!(stored.unwrap().strain > 0.0);
    }
}

#[test]
fn bars_that_share_their_volume_are_together_the_whole_bar() {
    let sample = samples()[0];
    let mut random = Random(6);
    let u = sample.motion(&mut random, 4e-3);
    let whole = sample.body(METAL_LAW);
    let (f, energies, _) = stepped(&whole, &u, &fresh(&whole));
    let weights = [0.2, 0.9, 0.5, 0.1];
    let mut sum = vec![0.0; f.len()];
    let mut dissipated = 0.0;
    for part in [weights, weights.map(|w| 1.0 - w)] {
        let (mesh, mut spec) = sample.spec(METAL_LAW);
        spec.weights = Some(CellWeights {
            inertia: part.to_vec(),
            stiffness: part.to_vec(),
        });
        let body = Body::new(&mesh, spec, &[0, 1, 2], &sample.unknowns()).unwrap();
        let (own, stored, _) = stepped(&body, &u, &fresh(&body));
        dissipated += stored.dissipated;
        for (sum, own) in sum.iter_mut().zip(own) {
            *sum += own;
        }
    }
    near(&sum, &f, 1e-13, &sample);
    assert!((dissipated / energies.dissipated - 1.0).abs() < 1e-13);
}

#[test]
fn forces_between_two_displacements_hinges_sections_without_shape_and_other_laws_are_refused() {
    for sample in samples() {
        let body = sample.body(METAL_LAW);
        let (u, old) = (vec![0.0; sample.unknowns().len()], fresh(&body));
        let between = Placement {
            from: Some(&u),
            ..at(&u, &u, &old)
        };
        let mut f = u.clone();
        let found = body.force(&between, &mut old.clone(), &mut Scratch::default(), &mut f);
        assert!(matches!(found, Err(Error::NoBetween { .. })));
        let refused = |sample: &Sample, law: Law, releases: Vec<Release>| {
            let (mesh, mut spec) = sample.spec(law);
            spec.releases = releases;
            Body::new(&mesh, spec, &[0, 1, 2], &sample.unknowns()).unwrap_err()
        };
        let soft = Law::NeoHooke(NeoHooke { initial: STEEL });
        let error = refused(&sample, soft, vec![]);
        assert!(error.to_string().contains("johnson-cook"), "{error}");
        if let Kinematics::Beam(section) = sample.kinematics {
            let unknown = Sample {
                kinematics: Kinematics::Beam(BeamSection {
                    shape: None,
                    ..section
                }),
                ..sample
            };
            let error = refused(&unknown, METAL_LAW, vec![]);
            assert!(matches!(error, Error::NoShape { .. }));
            let release = Release {
                cell: sample.spec(METAL_LAW).1.cells[0],
                end: 1,
                rotations: [false, false, true],
            };
            let error = refused(&sample, METAL_LAW, vec![release]);
            assert!(matches!(error, Error::FlowingHinges { .. }));
        }
    }
}
