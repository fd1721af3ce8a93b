//! Conjugate directions between sweeps: sweeps alone creep along forces that D hardly sees.
//!
//! The change s_k of a sweep takes the part of a negative gradient in the method of conjugate gradients of Fletcher and Reeves (Silcowitz,
//! Niebe and Erleben 2010): with β = |s_k|²/|s_{k-1}|², the forces go on by β d_{k-1}, d_k = s_k + β d_{k-1}; where β > 1 all
//! begins anew with d_k = 0. What the laws do not allow of such forces the next sweep takes back, and a point where a sweep changes
//! nothing stays.

/// The direction of the last sweeps.
#[derive(Default)]
pub(super) struct Conjugate {
    /// Forces before the sweep, and what is kept of them.
    before: [Vec<f64>; 2],
    /// d, and what is kept of it.
    direction: [Vec<f64>; 2],
    /// |s|² of the last sweep, N².
    last: f64,
}

impl Conjugate {
    /// Forgets all directions, and takes note of the forces, and of what is kept of them, which is linear in the forces.
    pub fn begin(&mut self, forces: &[f64], kept: &[f64]) {
        for (direction, like) in self.direction.iter_mut().zip([forces, kept]) {
            direction.clear();
            direction.resize(like.len(), 0.0);
        }
        self.last = f64::INFINITY;
        self.note(forces, kept);
    }

    /// Takes note of the forces before a sweep.
    pub fn note(&mut self, forces: &[f64], kept: &[f64]) {
        for (before, now) in self.before.iter_mut().zip([forces, kept]) {
            before.clear();
            before.extend_from_slice(now);
        }
    }

    /// Goes on from the forces after the sweep, and takes note of those that it ends with.
    pub fn go_on(&mut self, forces: &mut [f64], kept: &mut [f64]) {
        let changes = forces.iter().zip(&self.before[0]);
        let square: f64 = changes.map(|(now, before)| (now - before).powi(2)).sum();
        let beta = square / self.last;
        self.last = square;
        let (beta, goes_on) = if beta <= 1.0 { (beta, 1.0) } else { (0.0, 0.0) };
        let pairs = self.direction.iter_mut().zip(&mut self.before);
        for ((direction, before), now) in pairs.zip([forces, kept]) {
            for ((d, before), now) in direction.iter_mut().zip(before).zip(now) {
                let (change, along) = (*now - *before, beta * *d);
                *now += along;
                *before = *now;
                *d = goes_on * (change + along);
            }
        }
    }
}
