//! The parts of a system that ranks other than the first build and keep.

use std::collections::BTreeSet;
use std::fmt::Write;
use std::path::Path;

use carom_case::model;
use carom_dynamics::System;

use crate::ranks::{METAL, block, built, compare_on_ranks, driver_on, on_all, read};

/// Three plates of different thickness that nothing brings together: one is held, one pulled and one left to its weight.
const PLATES: &str = r#"
carom = 1
[mesh]
generate.held.rectangle = { origin = [0.0, 0.0], size = [0.2, 0.1], elements = [8, 4] }
generate.pulled.rectangle = { origin = [0.3, 0.0], size = [0.1, 0.3], elements = [4, 9] }
generate.left.rectangle = { origin = [0.5, 0.0], size = [0.1, 0.1], elements = [3, 5] }
[material.soft]
density = 1000.0
elastic = { young = "50 MPa", poisson = 0.3 }
[body.held]
region = "held"
material = "soft"
section.plane-strain = { thickness = 0.5 }
mass-scaling.factor = 1.5
[body.pulled]
region = "pulled"
material = "soft"
section.plane-strain = { thickness = 2.0 }
initial = { velocity = [0.1, 0.0] }
[body.left]
region = "left"
material = "soft"
section.plane-strain = { thickness = 1.0 }
initial = { velocity = [0.0, 2.0], displacement = [0.001, 0.0] }
[support.wall]
on = "held.left"
fix = ["x", "y"]
[load.weight]
acceleration = [0.0, -9.81]
[load.pull]
on = "pulled.top"
traction = ["1 kPa", "20 kPa"]
amplitude = [{ time = "0 ms", factor = 0.0 }, { time = "1 ms", factor = 1.0 }]
[load.pushed]
on = "held.top"
force = [0.0, 10.0]
[probe.end]
on = "pulled.bottom"
record = ["displacement", "velocity"]
[time]
end = "2 ms"
step = { critical = 0.5 }
scheme.central-difference = {}
"#;

/// A block of which two layers are wedges, in the format of Gmsh.
fn mixed(path: &Path) {
    const N: [usize; 3] = [4, 3, 5];
    let number = |[i, j, k]: [usize; 3]| 1 + i + (N[0] + 1) * (j + (N[1] + 1) * k);
    let (mut nodes, mut elements) = (String::new(), Vec::new());
    for k in 0..=N[2] {
        for j in 0..=N[1] {
            for i in 0..=N[0] {
                let (x, y, z) = (0.02 * i as f64, 0.02 * j as f64, 0.002 + 0.02 * k as f64);
                writeln!(nodes, "{} {x} {y} {z}", number([i, j, k])).unwrap();
            }
        }
    }
    let mut push = |kind: usize, group: usize, corners: &[usize]| {
        let corners: Vec<String> = corners.iter().map(ToString::to_string).collect();
        elements.push(format!("{kind} 2 {group} {group} {}", corners.join(" ")));
    };
    for k in 0..N[2] {
        for j in 0..N[1] {
            for i in 0..N[0] {
                let square = |k: usize| {
                    [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[a, b]| number([i + a, j + b, k]))
                };
                let [a, b, c, d] = square(k);
                let [e, f, g, h] = square(k + 1);
                if k == 0 {
                    push(3, 1, &[a, d, c, b]);
                }
                if k < 3 {
                    push(5, 2, &[a, b, c, d, e, f, g, h]);
                } else {
                    push(6, 2, &[a, b, c, e, f, g]);
                    push(6, 2, &[a, c, d, e, g, h]);
                }
            }
        }
    }
    let elements: Vec<String> = (1..)
        .zip(elements)
        .map(|(k, e)| format!("{k} {e}"))
        .collect();
    let text = format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 1 \"bottom\"\n3 2 \"block\"\n$EndPhysicalNames\n$Nodes\n{}\n{nodes}$EndNodes\n$Elements\n{}\n{}\n$EndElements\n",
        number(N),
        elements.len(),
        elements.join("\n")
    );
    std::fs::write(path, text).unwrap();
}

#[test]
fn bodies_that_nothing_joins_are_those_of_one_process_on_several_ranks() {
    compare_on_ranks("plates", PLATES, &[2, 3, 4]);
}

/// Ranks for which no element is left, and which have none of the nodes of a body.
#[test]
fn more_ranks_than_elements_are_one_process() {
    let few = |text: &str| text.replace("elements = [5, 4, 6]", "elements = [2, 1, 1]");
    compare_on_ranks("few", &few(&block(METAL)), &[5]);
    let none = PLATES
        .replace("elements = [8, 4]", "elements = [1, 1]")
        .replace("elements = [4, 9]", "elements = [1, 2]")
        .replace("elements = [3, 5]", "elements = [1, 1]");
    compare_on_ranks("few plates", &none, &[6]);
}

/// On two ranks one has the hexahedra and the other the wedges; frequencies are found anew, and gathered for the checkpoint.
#[test]
fn a_body_of_two_kinds_of_elements_is_that_of_one_process_on_several_ranks() {
    let folder = tempfile::tempdir().unwrap();
    let mesh = folder.path().join("mixed.msh");
    mixed(&mesh);
    let text = block(METAL)
        .replace("-5.0]", "-15.0]")
        .replace("critical = 0.2", "critical = 0.7")
        .replace("block.bottom", "bottom")
        .replace("on = \"block.top\"", "at = [0.0, 0.0, 0.002]");
    let begin = text.find("generate.block").unwrap();
    let end = begin + text[begin..].find('\n').unwrap();
    let text = format!("{}file = {:?}{}", &text[..begin], mesh, &text[end..]);
    let (_, _, built) = built(&text);
    assert_eq!(built.system.bodies[0].cells().len(), 36 + 48);
    compare_on_ranks("mixed", &text, &[2, 4]);
}

/// Masses, loads and initial motion of a part are those of the whole at its nodes, which come in the same order; what is known of bodies as wholes is
/// told.
#[test]
fn a_part_of_a_system_is_that_of_the_whole() {
    for text in [PLATES.to_owned(), block(METAL)] {
        let (input, case, locator) = read(&text);
        let (_, _, built) = built(&text);
        let whole = &*built.system;
        let count = |body: usize| whole.bodies[body].cells().len() as u32;
        // the last body is with one rank, and of the others each third element
        let last = whole.bodies.len() - 1;
        let ranks = (0..=last).map(|body| match body == last && body > 0 {
            true => vec![1; count(body) as usize],
            false => (0..count(body)).map(|place| place % 3).collect(),
        });
        let ranks: Vec<Vec<u32>> = ranks.collect();
        for rank in 0..3 {
            let mut model = model(&case, &locator, &input).unwrap();
            model.dt = whole.dt;
            let (around, places) = System::around(model, &ranks, rank).unwrap();
            let own: BTreeSet<u32> = own_nodes(&around, &places, (&ranks, rank));
            let in_whole = |node: u32| whole.number[around.mesh_node[node as usize] as usize];
            let numbers: Vec<u32> = (0..around.x.len() as u32).map(in_whole).collect();
            assert!(numbers.windows(2).all(|pair| pair[0] < pair[1]));
            let dim = whole.dim;
            let most = whole.load.iter().fold(0.0f64, |most, f| most.max(f.abs()));
            for (node, number) in own.iter().map(|node| (*node, in_whole(*node))) {
                for axis in 0..dim {
                    let [i, j] = [node, number].map(|node| dim * node as usize + axis);
                    // the elements at a node are added in the same order
                    assert_eq!(around.mass.lumped[i], whole.mass.lumped[j]);
                    assert!((around.load[i] - whole.load[j]).abs() <= 1e-15 * most);
                    assert_eq!(around.fixed[i], whole.fixed[j]);
                    assert_eq!(around.initial.velocity[i], whole.initial.velocity[j]);
                    assert_eq!(
                        around.initial.displacement[i],
                        whole.initial.displacement[j]
                    );
                }
            }
            let mut told = around;
            told.know_whole(&whole.facts_of_whole());
            assert_eq!(told.facts_of_whole(), whole.facts_of_whole());
        }
    }
}

/// Nodes of the elements of a rank among those around them.
fn own_nodes(
    around: &System,
    places: &[Vec<u32>],
    (ranks, rank): (&[Vec<u32>], u32),
) -> BTreeSet<u32> {
    let mut nodes = BTreeSet::new();
    for (k, body) in around.bodies.iter().enumerate() {
        let mut places = places[k].iter();
        body.each_element(&mut |own| {
            if ranks[k][*places.next().unwrap() as usize] == rank {
                nodes.extend(own.iter().copied());
            }
        });
    }
    nodes
}

/// Other ranks than the first have the nodes of their own elements and of contacts, and no others.
#[test]
fn a_rank_has_unknowns_of_its_own_elements_and_of_contacts_alone() {
    let text = block(METAL)
        .replace("0.12]", "0.5]")
        .replace("elements = [5, 4, 6]", "elements = [5, 4, 24]");
    let (_, _, built) = built(&text);
    let bottom = 6 * 5;
    let sizes = on_all(4, |ranks| {
        let driver = driver_on(ranks, &text);
        let share = driver.rank_share().unwrap();
        (driver.system().x.len(), share.nodes, share.elements)
    });
    assert_eq!(sizes[0].0, built.system.x.len());
    // parts of six layers, of which the lowest has the contact
    for (nodes, own, elements) in &sizes[1..] {
        assert_eq!(*elements, 5 * 4 * 6);
        assert_eq!(*own, bottom * 7);
        assert!([*own, *own + bottom].contains(nodes), "{nodes} {own}");
    }
}
