//! The given motion of a rigid obstacle: a translation and a turn about an axis.

/// Translation d(t) of an obstacle, m.
#[derive(Clone, Debug, PartialEq)]
pub enum Translation {
    /// d = velocity · t, in m/s.
    Velocity([f64; 3]),
    /// Straight between given displacements (time in s, displacement in m), times ascending; at rest before the first
    /// and after the last. Not empty.
    Table(Vec<(f64, [f64; 3])>),
}

/// A turn at constant rate about an axis that takes part in the translation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn {
    /// A point of the axis at time 0, m.
    pub point: [f64; 3],
    /// Unit vector along the axis. In the plane: z.
    pub axis: [f64; 3],
    /// Angular velocity ω, rad/s.
    pub rate: f64,
}

/// How an obstacle moves: its particle X at time 0 is at time t at x = p + d(t) + R(ω t) (X - p), p on the axis.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Motion {
    /// The translation; `None` for none.
    pub translation: Option<Translation>,
    /// The turn; `None` for none.
    pub turn: Option<Turn>,
}

/// Where a motion has brought an obstacle, and how it goes on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pose {
    /// p.
    point: [f64; 3],
    /// d.
    displacement: [f64; 3],
    /// R.
    rotation: [[f64; 3]; 3],
    /// ḋ.
    velocity: [f64; 3],
    /// ω a.
    spin: [f64; 3],
}

impl Translation {
    /// d and ḋ at a time; where a table bends, ḋ of what follows.
    pub(super) fn at(&self, t: f64) -> ([f64; 3], [f64; 3]) {
        let table = match self {
            Translation::Velocity(v) => return (v.map(|v| v * t), *v),
            Translation::Table(table) => table,
        };
        let next = table.partition_point(|(time, _)| *time <= t);
        let end = |k: usize| table.get(k).map_or([0.0; 3], |(_, d)| *d);
        if next == 0 || next == table.len() {
            return (end(next.saturating_sub(1)), [0.0; 3]);
        }
        let ((t0, d0), (t1, d1)) = (table[next - 1], table[next]);
        let v = [0, 1, 2].map(|i| (d1[i] - d0[i]) / (t1 - t0));
        ([0, 1, 2].map(|i| d0[i] + v[i] * (t - t0)), v)
    }
}

impl Motion {
    /// Whether there is any motion.
    pub fn moves(&self) -> bool {
        self.translation.is_some() || self.turn.is_some()
    }

    /// The pose at a time in s; `None` without motion, so that an obstacle at rest is computed without rounding.
    pub(super) fn at(&self, t: f64) -> Option<Pose> {
        if !self.moves() {
            return None;
        }
        let (displacement, velocity) = self
            .translation
            .as_ref()
            .map_or(([0.0; 3], [0.0; 3]), |translation| translation.at(t));
        Some(Pose {
            point: self.turn.map_or([0.0; 3], |turn| turn.point),
            displacement,
            rotation: self
                .turn
                .map_or(identity(), |turn| rotation(&turn.axis, turn.rate * t)),
            velocity,
            spin: self
                .turn
                .map_or([0.0; 3], |turn| turn.axis.map(|a| turn.rate * a)),
        })
    }
}

impl Pose {
    /// Particle X that is at x: p + Rᵀ (x - p - d).
    pub(super) fn back(&self, x: &[f64; 3]) -> [f64; 3] {
        let r = [0, 1, 2].map(|i| x[i] - self.point[i] - self.displacement[i]);
        [0, 1, 2].map(|i| {
            let turned: f64 = (0..3).map(|k| self.rotation[k][i] * r[k]).sum();
            self.point[i] + turned
        })
    }

    /// Place of particle X: p + d + R (X - p).
    pub(super) fn forth(&self, particle: &[f64; 3]) -> [f64; 3] {
        let r = self.turned(&[0, 1, 2].map(|i| particle[i] - self.point[i]));
        [0, 1, 2].map(|i| self.point[i] + self.displacement[i] + r[i])
    }

    /// R n.
    pub(super) fn turned(&self, n: &[f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|i| (0..3).map(|k| self.rotation[i][k] * n[k]).sum())
    }

    /// R H Rᵀ.
    pub(super) fn turned_tensor(&self, h: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
        let rows = h.map(|row| self.turned(&row));
        let columns = [0, 1, 2].map(|j| self.turned(&[rows[0][j], rows[1][j], rows[2][j]]));
        [0, 1, 2].map(|i| [0, 1, 2].map(|j| columns[j][i]))
    }

    /// Velocity of the particle that is at x: ḋ + ω a × (x - p - d), m/s.
    pub(super) fn velocity(&self, x: &[f64; 3]) -> [f64; 3] {
        let r = [0, 1, 2].map(|i| x[i] - self.point[i] - self.displacement[i]);
        let w = &self.spin;
        [
            self.velocity[0] + w[1] * r[2] - w[2] * r[1],
            self.velocity[1] + w[2] * r[0] - w[0] * r[2],
            self.velocity[2] + w[0] * r[1] - w[1] * r[0],
        ]
    }
}

fn identity() -> [[f64; 3]; 3] {
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
}

/// R = cos φ I + sin φ [a]ₓ + (1 - cos φ) a ⊗ a: the turn by φ about a unit vector a (Rodrigues).
fn rotation(a: &[f64; 3], angle: f64) -> [[f64; 3]; 3] {
    let (sin, cos) = angle.sin_cos();
    let cross = [[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]];
    let identity = identity();
    [0, 1, 2].map(|i| {
        [0, 1, 2].map(|j| cos * identity[i][j] + sin * cross[i][j] + (1.0 - cos) * a[i] * a[j])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_is_straight_between_its_entries_and_at_rest_outside() {
        let table = Translation::Table(vec![
            (1.0, [0.0; 3]),
            (3.0, [4.0, 0.0, -2.0]),
            (4.0, [4.0, 1.0, 0.0]),
        ]);
        assert_eq!(table.at(0.0), ([0.0; 3], [0.0; 3]));
        assert_eq!(table.at(1.0), ([0.0; 3], [2.0, 0.0, -1.0]));
        assert_eq!(table.at(2.0), ([2.0, 0.0, -1.0], [2.0, 0.0, -1.0]));
        assert_eq!(table.at(3.0), ([4.0, 0.0, -2.0], [0.0, 1.0, 2.0]));
        assert_eq!(table.at(9.0), ([4.0, 1.0, 0.0], [0.0; 3]));
    }

    #[test]
    fn the_velocity_of_a_particle_is_the_derivative_of_its_place() {
        let motion = Motion {
            translation: Some(Translation::Velocity([0.3, -1.0, 0.2])),
            turn: Some(Turn {
                point: [1.0, 2.0, -0.5],
                axis: [2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0],
                rate: 1.7,
            }),
        };
        // the place at t of the particle that is at x at 0.4
        let x = [0.1, -0.4, 0.9];
        let particle = motion.at(0.4).unwrap().back(&x);
        let place = |t: f64| {
            let pose = motion.at(t).unwrap();
            let turned = pose.turned(&[0, 1, 2].map(|i| particle[i] - pose.point[i]));
            [0, 1, 2].map(|i| pose.point[i] + pose.displacement[i] + turned[i])
        };
        let (before, now, after) = (place(0.4 - 1e-5), place(0.4), place(0.4 + 1e-5));
        let v = motion.at(0.4).unwrap().velocity(&x);
        for i in 0..3 {
            assert!((now[i] - x[i]).abs() < 1e-14);
            // central difference: (ω h)² r / 6 = 1e-10 and rounding 1e-16 / 1e-5
            assert!(((after[i] - before[i]) / 2e-5 - v[i]).abs() < 1e-9);
        }
    }
}
