//! From where a model is looked at.

/// From the viewer's side: the direction in which a solid is looked at, against the line of sight, with x to the right and z
/// upward.
pub(super) const EYE: [f64; 3] = [0.38, -0.79, 0.48];

/// Place in the plane of the picture, and how near to the viewer, m.
pub(super) fn project(dim: usize, x: &[f64; 3]) -> ([f64; 2], f64) {
    if dim < 3 {
        return ([x[0], x[1]], 0.0);
    }
    let length = EYE.iter().map(|e| e * e).sum::<f64>().sqrt();
    let eye = EYE.map(|e| e / length);
    let flat = eye[0].hypot(eye[1]);
    let right = [-eye[1] / flat, eye[0] / flat, 0.0];
    let up = [
        eye[1] * right[2] - eye[2] * right[1],
        eye[2] * right[0] - eye[0] * right[2],
        eye[0] * right[1] - eye[1] * right[0],
    ];
    let along = |axis: [f64; 3]| (0..3).map(|i| axis[i] * x[i]).sum::<f64>();
    ([along(right), along(up)], along(eye))
}
