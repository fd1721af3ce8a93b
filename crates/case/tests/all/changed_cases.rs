//! What must not change the answers of the cases of the project: the numbers of nodes and elements, the order of names, the choice of the ends of a
//! stop, the side of a contact that is the secondary one, where the origin lies (a kilometre and a thousand of them away) and how the axes stand.
//!
//! Twenty steps of each at its smallest, as it is and changed: largest forces and impulses of contacts, displacements at the end, and all
//! grades. What is compared is stated with [`BOUND`]. Places are known to 1e-16 of the distance of the origin, and a displacement of twenty steps is
//! wrong by that times the number of operations, a hundred, at each step. Where something differs by more, its condition
//! is measured: eight starts nearby, in which each node is elsewhere by up to a hundred roundings of its place, and twice what they change.
//! That a case which is stopped and goes on repeats its steps to the
//! last bit is in `resume_cases`.

use crate::project::{Answer, BOUND, Compared, Frame, Map, Project, STEPS, differences};
use crate::resume_cases::{BARS, MIXED, PLANE, SOLID, STATIC, Small, THIN};

/// Rounding of a place, relative.
const ROUNDING: f64 = 1e-16;

/// Starts nearby.
const STARTS: u64 = 8;

/// Cases that take minutes together: with the variable `CAROM_WHOLE` of the environment, as the last stage of CI has it, they are run too.
const LONG: [&str; 6] = [
    "assembly-row",
    "beam-and-solid",
    "bird-on-plate",
    "drop-test",
    "tied-bar",
    "tori",
];

/// What differs, after a look at starts nearby where something does.
fn broken_of(
    case: &Project,
    (one, other): (&Answer, &Answer),
    (place, compared): (f64, &Compared),
) -> Vec<String> {
    let all = differences(case.name, (one, other), &[], compared);
    if all.is_empty() {
        return all;
    }
    let distance = 100.0 * ROUNDING * place;
    let near = (1..=STARTS).filter_map(|seed| Some(case.nudged(seed, distance)?.answer()));
    let near: Vec<Answer> = near.collect();
    differences(case.name, (one, other), &near, compared)
}

/// The nodes of a case, in their order.
fn all(answer: &Answer) -> Vec<u32> {
    (0..answer.motion.len() as u32).collect()
}

fn numbers(case: &Project, one: &Answer) -> Vec<String> {
    let Some((other, nodes)) = case.renumbered(1) else {
        return Vec::new();
    };
    // which side of a cut has the node of the mesh is for the order of elements to say
    let nodes = match case.has("pretension") {
        true => Vec::new(),
        false => nodes,
    };
    let compared = Compared {
        nodes,
        ..Compared::default()
    };
    broken_of(case, (one, &other.answer()), (1.0, &compared))
}

fn names(case: &Project, one: &Answer) -> Vec<String> {
    let (other, names) = case.reversed();
    // nodes that rigid bodies add stand in the order of these
    let of_file = case.renumbered(1).map(|(_, nodes)| nodes.len());
    let mut nodes = all(one);
    nodes.truncate(of_file.unwrap_or(nodes.len()));
    let compared = Compared {
        nodes,
        names,
        ..Compared::default()
    };
    broken_of(case, (one, &other.answer()), (1.0, &compared))
}

fn ends_of_stops(case: &Project, one: &Answer) -> Vec<String> {
    let Some(other) = case.with_ends_swapped() else {
        return Vec::new();
    };
    let compared = Compared {
        nodes: all(one),
        ..Compared::default()
    };
    broken_of(case, (one, &other.answer()), (1.0, &compared))
}

/// A case in another frame.
fn frame(case: &Project, one: &Answer, frame: Frame) -> Vec<String> {
    let Some(map) = Map::new(case, frame) else {
        return Vec::new();
    };
    let (place, bound) = match frame {
        Frame::Far(distance) => {
            let lost = 100.0 * ROUNDING * distance * STEPS as f64 / one.largest();
            (distance, BOUND + lost)
        }
        _ => (1.0, BOUND),
    };
    let compared = Compared {
        nodes: all(one),
        vector: &|x| map.vector(x),
        bound,
        ..Compared::default()
    };
    let other = case.in_frame(&map).answer();
    let broken = broken_of(case, (one, &other), (place, &compared));
    let told = |text: &String| format!("{frame:?}, bound {bound:.1e}: {text}");
    broken.iter().map(told).collect()
}

fn changed(list: &[Small]) {
    let whole = std::env::var_os("CAROM_WHOLE").is_some();
    let taken = |(name, _): &&Small| whole || !LONG.iter().any(|long| name.starts_with(long));
    let mut broken = Vec::new();
    for case in list.iter().filter(taken).map(Project::read) {
        let one = case.answer();
        broken.extend(numbers(&case, &one));
        broken.extend(ends_of_stops(&case, &one));
        for other in [
            Frame::Far(1e3),
            Frame::Far(1e6),
            Frame::Turned,
            Frame::Mirrored,
        ] {
            broken.extend(frame(&case, &one, other));
        }
        // levels name contacts by patterns
        let mut unlevelled = case.clone();
        let one = match unlevelled.table.remove("level") {
            Some(_) => unlevelled.answer(),
            None => one,
        };
        broken.extend(names(&unlevelled, &one));
    }
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}

#[test]
fn cases_of_bars_and_masses_are_the_same_changed() {
    changed(BARS);
}

#[test]
fn cases_of_thin_bodies_are_the_same_changed() {
    changed(THIN);
}

#[test]
fn cases_of_plane_bodies_are_the_same_changed() {
    changed(PLANE);
}

#[test]
fn static_cases_are_the_same_changed() {
    changed(STATIC);
}

#[test]
fn cases_of_solids_are_the_same_changed() {
    changed(SOLID);
}

#[test]
fn cases_of_solids_beside_other_bodies_are_the_same_changed() {
    changed(MIXED);
}

/// Where a node meets a node: elsewhere the sides have other points.
#[test]
fn the_choice_of_the_secondary_side_changes_no_case() {
    let mut broken = Vec::new();
    let matching = ["arlequin-bars", "bars-in-zones", "two-bars"];
    let matches = |small: &&Small| matching.iter().any(|name| small.0.starts_with(name));
    for case in BARS.iter().filter(matches).map(Project::read) {
        let [one, other] = [&case, &case.with_sides_swapped()].map(Project::answer);
        let compared = Compared {
            nodes: all(&one),
            ..Compared::default()
        };
        broken.extend(broken_of(&case, (&one, &other), (1.0, &compared)));
    }
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}
