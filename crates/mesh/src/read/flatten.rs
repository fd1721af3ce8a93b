//! The dimension of the space of a mesh.

/// Sets to zero what is round-off and gives the dimension of the space: the last direction in which a coordinate is
/// not zero, at least `least` and 1.
pub fn flatten(nodes: &mut [[f64; 3]], least: usize) -> usize {
    let largest = nodes.iter().flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
    let extends = |&i: &usize| nodes.iter().any(|x| x[i].abs() > 1e-12 * largest);
    let dim = (0..3).rev().find(extends).map_or(1, |i| i + 1).max(least);
    for x in nodes {
        x[dim..].fill(0.0);
    }
    dim
}
