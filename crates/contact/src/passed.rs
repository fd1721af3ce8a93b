//! Faces that a straight way passes.

use carom_mesh::{Face, Projection, project};

/// The normal of a face that stands where the straight way between two places passes it from before it to behind it, if it does.
pub(crate) fn passed_face(
    (face, x): (&Face, &[[f64; 3]]),
    [from, to]: [&[f64; 3]; 2],
) -> Option<[f64; 3]> {
    let [before, behind] = [from, to].map(|place| over(&project(face, x, place), place));
    if before < 0.0 || behind >= 0.0 {
        return None;
    }
    let part = before / (before - behind);
    let through = [0, 1, 2].map(|i| from[i] + part * (to[i] - from[i]));
    let foot = project(face, x, &through);
    foot.inside.then_some(foot.normal)
}

/// Height of a place over the plane that touches a face in its foot, m.
fn over(foot: &Projection, place: &[f64; 3]) -> f64 {
    (0..3)
        .map(|i| foot.normal[i] * (place[i] - foot.point[i]))
        .sum()
}
