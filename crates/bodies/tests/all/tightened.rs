//! Cells of beams and springs that a static stage tightens.

use carom_algebra::unknowns::{NodeKind, Unknowns};
use carom_bodies::{
    BeamSection, BeamTheory, Body, BodySpec, Curve, DiscreteKind, DiscreteSpec, Kinematics, Link,
    Scratch, SectionShape, Tightened, TightenedCell,
};
use carom_materials::Elastic;
use carom_testing::Random;

use crate::beams::mesh;

const STEEL: Elastic = Elastic {
    density: 7800.0,
    young: 2e11,
    poisson: 0.25,
};

/// Two elements with a corner, beside their nodes, of which the second is a bolt.
fn beam(dim: usize, tightens: bool) -> Body {
    let (mesh, cells) = mesh(dim);
    let shape = SectionShape::Rectangle {
        height: 0.2,
        width: 0.1,
    };
    let section = BeamSection {
        orientation: (dim == 3).then_some([0.1, 0.2, 1.0]),
        offset: [0.07, if dim == 3 { -0.04 } else { 0.0 }],
        ..BeamSection::new(BeamTheory::Timoshenko, shape.properties(STEEL.poisson))
    };
    let bolt = TightenedCell {
        name: "bolt".into(),
        cell: cells[1],
        force: 5e3,
        tightens,
    };
    let mut spec = BodySpec::new("b", cells, Kinematics::Beam(section), STEEL);
    spec.tightened = vec![bolt];
    let unknowns = Unknowns::new(dim, [NodeKind::SmallRotations; 3]);
    Body::new(&mesh, spec, &[0, 1, 2], &unknowns).unwrap()
}

fn force(body: &Body, u: &[f64]) -> Vec<f64> {
    let mut f = vec![0.0; u.len()];
    body.internal_force(u, &mut Scratch::default(), &mut f);
    f
}

#[test]
fn a_cell_that_is_tightened_lacks_its_normal_force_and_no_other() {
    let mut random = Random(5);
    for dim in [2, 3] {
        let [held, loose] = [false, true].map(|tightens| beam(dim, tightens));
        let n = if dim == 2 { 9 } else { 18 };
        let u: Vec<f64> = (0..n).map(|_| random.between(-1e-3, 1e-3)).collect();
        let [bolt] = held.bolts() else {
            panic!("{:?}", held.bolts())
        };
        // the bolt is the same in both stages, and its tension the normal force of the cell
        assert_eq!(loose.bolts(), held.bolts());
        let section = held.section_forces(&u, &[], &[0.0]).unwrap();
        let normal = section[1].force[0];
        assert!((bolt.tension(&u, 0.0) / normal - 1.0).abs() < 1e-10);
        let kept = held.section_forces(&u, &[], &[700.0]).unwrap();
        assert!((kept[1].force[0] - normal - 700.0).abs() < 1e-6);
        assert_eq!(kept[0], section[0]);
        // what pulls the ends together in the one is the stiffness in the other
        let mut expected = force(&loose, &u);
        bolt.add_load(-bolt.tension(&u, 0.0), &mut expected);
        let all = force(&held, &u);
        let scale = all.iter().fold(0.0, |most: f64, f| most.max(f.abs()));
        for (found, expected) in all.iter().zip(&expected) {
            assert!(
                (found - expected).abs() < 1e-11 * scale,
                "{found} {expected}"
            );
        }
    }
}

#[test]
fn what_a_cell_without_its_normal_force_holds_is_all_but_its_elongation_and_rigid_motions() {
    for dim in [2, 3] {
        let body = beam(dim, true);
        let mut rows = Vec::new();
        body.each_spring(&mut |row| rows.push(row.to_vec()));
        // of the six or twelve unknowns of two nodes, less three or six rigid motions and the elongation
        assert_eq!(rows.len(), if dim == 2 { 2 } else { 5 });
        let mut joined = 0;
        body.each_joining_element(&mut |_| joined += 1);
        assert_eq!(joined, 1);
        // it holds no rigid motion
        let per = if dim == 2 { 3 } else { 6 };
        for row in &rows {
            // a translation of all nodes along each axis
            for axis in 0..dim {
                let moved: f64 = row
                    .iter()
                    .filter(|(i, _)| i % per == axis)
                    .map(|(_, c)| c)
                    .sum();
                assert!(moved.abs() < 1e-12, "{row:?}");
            }
        }
    }
}

#[test]
fn a_bolt_between_nodes_has_no_stiffness_while_it_is_tightened() {
    let (mut mesh, _) = mesh(2);
    let cell = mesh.push(carom_elements::Kind::Bar2, &[0, 2]);
    let unknowns = Unknowns::new(2, [NodeKind::SmallRotations; 3]);
    let u: Vec<f64> = (0..9).map(|i| 1e-3 * f64::from(i * i)).collect();
    let bolt = |tightens| {
        let link = Link {
            curve: Curve::line(3e6),
            axis: Some([0.6, 0.8, 0.0]),
        };
        let kind = DiscreteKind::Bolt(Tightened {
            link,
            force: 2e3,
            tightens,
        });
        let spec = DiscreteSpec {
            name: "bolt".into(),
            cells: vec![cell],
            kind,
        };
        Body::discrete(&mesh, spec, &[0, 1, 2], &unknowns).unwrap()
    };
    let (held, loose) = (bolt(false), bolt(true));
    assert_eq!(force(&loose, &u), vec![0.0; 9]);
    assert!(loose.balances_itself() && !held.balances_itself());
    let elongation = 0.6 * (u[6] - u[0]) + 0.8 * (u[7] - u[1]);
    let own = &held.bolts()[0];
    assert!((own.elongation(&u) / elongation - 1.0).abs() < 1e-14);
    let mut expected = vec![0.0; 9];
    own.add_load(-3e6 * elongation, &mut expected);
    for (found, expected) in force(&held, &u).iter().zip(&expected) {
        assert!((found - expected).abs() < 1e-9);
    }
    // at the end of the stage its tension is F, and it keeps the rest
    let kept = own.kept(&u, 2e3);
    assert!((own.tension(&u, kept) - 2e3).abs() < 1e-9);
}

/// Two cells by one by three in space, of which the middle layer is tightened across an axis that is none of coordinates.
fn block(tightens: bool) -> (Body, Vec<[f64; 3]>, [f64; 3]) {
    let mut mesh = carom_mesh::generate::box_("b", [0.0; 3], [0.2, 0.1, 0.3], [2, 1, 3], false);
    let turn = carom_algebra::rotation::Rotation::cayley(&[0.3, -0.5, 0.2].into()).matrix();
    for x in &mut mesh.nodes {
        *x = (turn * carom_algebra::tensor::Vec3::from(*x)).into();
    }
    let axis: [f64; 3] = turn.column(2).into_owned().into();
    let cells = mesh.groups["b"].elements.clone();
    let height = |cell: &carom_mesh::ElementId| {
        let nodes = mesh.element_nodes(*cell).iter();
        let all = nodes.map(|&node| {
            (0..3)
                .map(|i| axis[i] * mesh.nodes[node as usize][i])
                .sum::<f64>()
        });
        all.sum::<f64>() / 8.0
    };
    let layer = cells
        .iter()
        .filter(|cell| (height(cell) - 0.15).abs() < 0.01);
    let layer = carom_bodies::TightenedLayer {
        name: "bolt".into(),
        cells: layer.copied().collect(),
        axis,
        force: 5e3,
        tightens,
    };
    assert_eq!(layer.cells.len(), 2);
    let mut spec = BodySpec::new("b", cells, Kinematics::Solid, STEEL);
    spec.layers = vec![layer];
    let count = mesh.nodes.len();
    let unknowns = Unknowns::translations(3, count);
    let number: Vec<u32> = (0..count as u32).collect();
    let body = Body::new(&mesh, spec, &number, &unknowns).unwrap();
    (body, mesh.nodes, axis)
}

#[test]
fn a_layer_of_a_solid_that_is_tightened_lacks_its_normal_force_and_no_other() {
    let mut random = Random(8);
    let ([held, loose], x, n) = {
        let [(held, x, n), (loose, ..)] = [false, true].map(block);
        ([held, loose], x, n)
    };
    let [bolt] = held.bolts() else {
        panic!("{:?}", held.bolts())
    };
    assert_eq!(loose.bolts(), held.bolts());
    let u: Vec<f64> = (0..3 * x.len())
        .map(|_| random.between(-1e-3, 1e-3))
        .collect();
    let mut expected = force(&loose, &u);
    bolt.add_load(-bolt.tension(&u, 0.0), &mut expected);
    let all = force(&held, &u);
    let scale = all.iter().fold(0.0, |most: f64, f| most.max(f.abs()));
    for (found, expected) in all.iter().zip(&expected) {
        assert!(
            (found - expected).abs() < 1e-11 * scale,
            "{found} {expected}"
        );
    }
    // a stretch along the axis that contracts across: E A ε
    let stretched: Vec<f64> = x
        .iter()
        .flat_map(|x| {
            let along: f64 = (0..3).map(|i| n[i] * x[i]).sum();
            (0..3).map(move |i| 1e-3 * (1.25 * along * n[i] - 0.25 * x[i]))
        })
        .collect();
    let normal = bolt.tension(&stretched, 0.0);
    assert!(
        (normal / (2e11 * 0.02 * 1e-3) - 1.0).abs() < 1e-10,
        "{normal}"
    );
    // which the loose layer does not resist: its force does the work of nothing
    let stress = held
        .as_solid()
        .unwrap()
        .stresses(&vec![0.0; u.len()], &[700.0]);
    let kept: Vec<f64> = stress
        .iter()
        .map(|(volume, stress)| {
            let n = carom_algebra::tensor::Vec3::from(n);
            volume * n.dot(&(stress * n)) / 0.1
        })
        .collect();
    assert!((kept.iter().sum::<f64>() - 700.0).abs() < 1e-8, "{kept:?}");
}

#[test]
fn what_a_loose_layer_of_a_solid_holds_is_all_but_its_elongation_and_rigid_motions() {
    let (body, x, n) = block(true);
    let mut rows = Vec::new();
    body.each_spring(&mut |row| rows.push(row.to_vec()));
    assert_eq!(rows.len(), 5);
    let on = |row: &[(usize, f64)], motion: &dyn Fn(&[f64; 3]) -> [f64; 3]| {
        let terms = row.iter().map(|&(i, c)| c * motion(&x[i / 3])[i % 3]);
        terms.sum::<f64>()
    };
    let middle = 0.15;
    for row in &rows {
        for axis in 0..3 {
            let turn = |x: &[f64; 3]| {
                let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
                let mut v = [0.0; 3];
                (v[j], v[k]) = (-x[k], x[j]);
                v
            };
            assert!(on(row, &turn).abs() < 1e-12);
            assert!(
                on(row, &|_| std::array::from_fn(|i| f64::from(u8::from(
                    i == axis
                ))))
                .abs()
                    < 1e-12
            );
        }
        let opens = |x: &[f64; 3]| {
            let along: f64 = (0..3).map(|i| n[i] * x[i]).sum();
            if along > middle { n } else { [0.0; 3] }
        };
        assert!(on(row, &opens).abs() < 1e-12);
        // and none of them is nothing
        assert!(row.iter().any(|(_, c)| c.abs() > 1e-3));
    }
    let mut joined = Vec::new();
    body.each_joining_element(&mut |nodes| joined.push(nodes.len()));
    // the four cells of the other layers, and both sides of this one
    assert_eq!(joined, [8, 8, 8, 8, 6, 6]);
}
