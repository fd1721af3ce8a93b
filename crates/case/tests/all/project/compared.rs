//! What differs between a case and the same changed.

use std::collections::BTreeMap;

use super::Answer;

/// What is solved at once differs by the rounding of the order of sums, what is iterated by the tolerance of the iterations: twenty steps of 1e-10 times
/// the condition of the equations of a contact, a thousand.
pub const BOUND: f64 = 1e-6;

/// How a changed case answers the questions of the case.
pub struct Compared<'a> {
    /// Node of the case that each of the changed case is.
    pub nodes: Vec<u32>,
    /// Old names of what has new ones.
    pub names: BTreeMap<String, String>,
    /// A displacement as the changed case has it.
    pub vector: &'a dyn Fn([f64; 3]) -> [f64; 3],
    /// Most that a force or a displacement may differ by, relative to the largest.
    pub bound: f64,
}

impl Default for Compared<'_> {
    fn default() -> Self {
        Compared {
            nodes: Vec::new(),
            names: BTreeMap::new(),
            vector: &|x| x,
            bound: BOUND,
        }
    }
}

impl Compared<'_> {
    /// A line or a name as the case has it.
    fn old(&self, name: &str) -> String {
        let mut old = name.to_owned();
        for (new, name) in &self.names {
            old = old.replace(new, name);
        }
        old
    }
}

/// The forces of a contact; of two bodies of a general contact, which is called by both, in either order.
fn of_contact(forces: &BTreeMap<String, [f64; 2]>, name: &str) -> [f64; 2] {
    let turned = name
        .strip_prefix("all-")
        .and_then(|both| both.split_once('-'));
    let turned = turned.map(|(one, other)| format!("all-{other}-{one}"));
    let found = forces.get(name).or_else(|| forces.get(&turned?));
    *found.unwrap_or_else(|| panic!("no contact {name}"))
}

/// What differs between the answers of a case and the same changed, beyond the bound and twice what starts nearby differ by; a grade that these change is
/// at its bound.
pub fn differences(
    name: &str,
    (one, other): (&Answer, &Answer),
    near: &[Answer],
    how: &Compared,
) -> Vec<String> {
    let mut all = Vec::new();
    let old = |name: &String| how.old(name);
    let forces: BTreeMap<String, [f64; 2]> =
        other.forces.iter().map(|(k, v)| (old(k), *v)).collect();
    for (k, unit) in ["N", "N s"].into_iter().enumerate() {
        let largest = one
            .forces
            .values()
            .map(|of| of[k].abs())
            .fold(0.0, f64::max);
        for (contact, one) in &one.forces {
            let (one, other) = (one[k], of_contact(&forces, contact)[k]);
            let by = near
                .iter()
                .map(|near| (one - near.forces[contact][k]).abs());
            let condition = by.fold(0.0, f64::max);
            if (one - other).abs() > how.bound * largest + 2.0 * condition {
                all.push(format!(
                    "{name}: {contact}: {one:e} {unit}, {other:e} {unit}, {condition:e}"
                ));
            }
        }
    }
    let by = |[one, other]: [&[f64; 3]; 2]| {
        (0..3)
            .map(|i| (one[i] - other[i]).abs())
            .fold(0.0, f64::max)
    };
    let by_near = |near: &Answer| {
        one.motion
            .iter()
            .zip(&near.motion)
            .map(|(one, near)| by([one, near]))
            .fold(0.0, f64::max)
    };
    let condition = near.iter().map(by_near).fold(0.0, f64::max);
    let bound = how.bound * one.largest() + 2.0 * condition;
    for (&node, other) in how.nodes.iter().zip(&other.motion) {
        let one = (how.vector)(one.motion[node as usize]);
        if by([&one, other]) > bound {
            all.push(format!(
                "{name}: node {node}: {one:?} m, {other:?} m, bound {bound:e} m"
            ));
            break;
        }
    }
    let grades: BTreeMap<String, _> = other.grades.iter().map(|(k, v)| (old(k), *v)).collect();
    for (line, grade) in &one.grades {
        let other = grades.get(line);
        if other != Some(grade) && near.iter().all(|near| near.grades.get(line) != other) {
            all.push(format!("{name}: {line}: {grade:?}, {other:?}"));
        }
    }
    all
}
