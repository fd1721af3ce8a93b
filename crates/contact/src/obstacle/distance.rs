//! What a shape says of a place, and what round shapes have in common.

/// Where a place stands over an obstacle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distance {
    /// g in m, positive when open, infinite where the place faces nothing.
    pub gap: f64,
    /// Unit normal out of the obstacle: ∂g/∂x. Zero where the place faces nothing.
    pub normal: [f64; 3],
    /// ∂²g/∂x², symmetric, 1/m.
    pub hessian: [[f64; 3]; 3],
}

/// The side of a round obstacle on which the material must stay.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Side {
    /// Outside: a ball, a shaft.
    #[default]
    Outside,
    /// Inside: a hollow, a bore.
    Inside,
}

/// Gap ± (|d| - radius) over a round shape, n = ± d/|d|, Hessian ± (I - a ⊗ a - n ⊗ n) / |d|.
///
/// `d`: way from the centre or the axis, m; `axis`: direction along which the shape does not bend, zero for a sphere.
pub(super) fn round(d: &[f64; 3], axis: &[f64; 3], radius: f64, side: Side) -> Distance {
    let sign = match side {
        Side::Outside => 1.0,
        Side::Inside => -1.0,
    };
    let length = d.iter().map(|d| d * d).sum::<f64>().sqrt();
    if length == 0.0 {
        return Distance {
            gap: -sign * radius,
            normal: across(axis).map(|n| sign * n),
            hessian: [[0.0; 3]; 3],
        };
    }
    let n = d.map(|d| d / length);
    let delta = |i: usize, j: usize| if i == j { 1.0 } else { 0.0 };
    let bend = |i: usize, j: usize| delta(i, j) - axis[i] * axis[j] - n[i] * n[j];
    Distance {
        gap: sign * (length - radius),
        normal: n.map(|n| sign * n),
        hessian: [0, 1, 2].map(|i| [0, 1, 2].map(|j| sign * bend(i, j) / length)),
    }
}

/// A unit vector across another; the last axis if that one is zero.
fn across(axis: &[f64; 3]) -> [f64; 3] {
    // of the unit vectors the one least along the axis, the last of equals
    let least = (0..3).fold(2, |best, i| {
        if axis[i].abs() < axis[best].abs() {
            i
        } else {
            best
        }
    });
    let n = [0, 1, 2].map(|i| f64::from(i == least) - axis[least] * axis[i]);
    let length = n.iter().map(|n| n * n).sum::<f64>().sqrt();
    n.map(|n| n / length)
}
