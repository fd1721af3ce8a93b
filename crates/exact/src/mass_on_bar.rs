//! A rigid mass that strikes the end of an elastic bar: Saint-Venant's problem.
//!
//! With Z the impedance of the bar, M the mass, s = Z/M and T = 2L/c, the compressive force that leaves the struck end is o(t), the
//! one that comes back r o(t - T), r = 1 from a fixed end and -1 from a free one. The force between mass and bar is
//! F = o + r o(· - T) and the velocity of the end (o - r o(· - T))/Z, so that with M v̇ = -F
//!
//! `ȯ + s o = r (ȯ(· - T) - s o(· - T))`.
//!
//! So o(t) = Σ_k q_k(t - kT) with q_k(τ) = Z V e^{-sτ} P_k(τ) for τ >= 0, polynomials with P_0 = 1 and
//! `P_k = r (P_{k-1} - 2 s ∫_0 P_{k-1})`: an exponential decay, with a step of 2 r Z V as the front returns.
//!
//! Barré de Saint-Venant, Flamant (1883); Timoshenko and Goodier, Theory of Elasticity, on longitudinal impact.

/// A mass and the bar that it strikes, at rest.
#[derive(Clone, Debug, PartialEq)]
pub struct MassOnBar {
    mass: f64,
    impedance: f64,
    speed: f64,
    transit: f64,
    /// r.
    returned: f64,
    /// Coefficients of P_k, ascending powers.
    waves: Vec<Vec<f64>>,
    /// When the force vanishes, s.
    end: f64,
}

/// Points per transit between which the end of the contact is looked for.
const POINTS: usize = 1000;

impl MassOnBar {
    /// `mass` M in kg, `impedance` Z = ρ c A in N s/m, `speed` V in m/s, `transit` T = 2L/c in s, `fixed`: whether the far end is
    /// held. The contact is over at the latest after `transits` times T.
    pub fn new(
        [mass, impedance, speed, transit]: [f64; 4],
        fixed: bool,
        transits: usize,
    ) -> MassOnBar {
        let (rate, returned) = (impedance / mass, if fixed { 1.0 } else { -1.0 });
        let mut waves = vec![vec![1.0]];
        for k in 0..transits {
            let last: &Vec<f64> = &waves[k];
            let mut next = vec![0.0; last.len() + 1];
            for (power, c) in last.iter().enumerate() {
                next[power] += returned * c;
                next[power + 1] -= returned * 2.0 * rate * c / (power + 1) as f64;
            }
            waves.push(next);
        }
        let mut made = MassOnBar {
            mass,
            impedance,
            speed,
            transit,
            returned,
            waves,
            end: f64::INFINITY,
        };
        made.end = made.release(transits);
        made
    }

    /// Force in N at a time in s after the mass has struck, as if it stuck to the bar; the limit from the right at a front.
    fn stuck(&self, t: f64) -> f64 {
        self.leaving(t) + self.returned * self.leaving(t - self.transit)
    }

    /// o(t).
    fn leaving(&self, t: f64) -> f64 {
        let waves = self.waves.iter().enumerate();
        let sum = waves.map(|(k, polynomial)| {
            let tau = t - k as f64 * self.transit;
            match tau >= 0.0 {
                true => {
                    let value = polynomial.iter().rev().fold(0.0, |sum, c| sum * tau + c);
                    value * (-self.impedance / self.mass * tau).exp()
                }
                false => 0.0,
            }
        });
        self.impedance * self.speed * sum.sum::<f64>()
    }

    /// The first zero of the force, s.
    fn release(&self, transits: usize) -> f64 {
        let step = self.transit / POINTS as f64;
        let first = (1..transits * POINTS).find(|k| self.stuck(*k as f64 * step) <= 0.0);
        let Some(first) = first else {
            return f64::INFINITY;
        };
        let (mut low, mut high) = ((first - 1) as f64 * step, first as f64 * step);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            match self.stuck(middle) > 0.0 {
                true => low = middle,
                false => high = middle,
            }
        }
        high
    }

    /// When the contact ends, s after it has begun.
    pub fn duration(&self) -> f64 {
        self.end
    }

    /// Contact force in N at a time in s after the mass has struck.
    pub fn force(&self, t: f64) -> f64 {
        match (0.0..self.end).contains(&t) {
            true => self.stuck(t),
            false => 0.0,
        }
    }

    /// Mean force in N over a span of time, by Simpson's rule on a thousand intervals: exact to 1e-9 without a front inside.
    pub fn mean(&self, [from, to]: [f64; 2]) -> f64 {
        let step = (to - from) / POINTS as f64;
        let at = |k: f64| self.force(from + k * step);
        let sum = (0..POINTS).map(|k| {
            let k = k as f64;
            (at(k) + 4.0 * at(k + 0.5) + at(k + 1.0)) / 6.0
        });
        sum.sum::<f64>() / POINTS as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_force_decays_steps_at_each_return_and_stops_the_mass() {
        let (mass, z, v, transit) = (2.0, 16000.0, 5.0, 2e-4);
        let exact = MassOnBar::new([mass, z, v, transit], true, 6);
        let rate = z / mass;
        assert_eq!(exact.force(0.0), z * v);
        let before = exact.force(0.999_999_999 * transit);
        assert!((before - z * v * (-rate * transit).exp()).abs() < 1e-6 * z * v);
        // the front comes back with twice its force
        let step = exact.force(transit * 1.000_000_001) - before;
        assert!((step - 2.0 * z * v).abs() < 1e-5 * z * v);
        // M v̇ = -F, with Z v = o - o(t - T): the momentum of the mass at the end
        let t = exact.duration();
        let pieces: f64 = (0..6)
            .map(|k| [k as f64 * transit, ((k + 1) as f64 * transit).min(t)])
            .filter(|[from, to]| from < to)
            .map(|[from, to]| {
                let inside = [from * (1.0 + 1e-12), to * (1.0 - 1e-12)];
                exact.mean(inside) * (to - from)
            })
            .sum();
        let end = (exact.leaving(t) - exact.leaving(t - transit)) / z;
        assert!((mass * (v - end) - pieces).abs() < 1e-6 * mass * v);
        assert!(t > transit && t < 6.0 * transit);
    }

    #[test]
    fn a_free_bar_leaves_as_its_wave_comes_back() {
        let exact = MassOnBar::new([2.0, 16000.0, 5.0, 2e-4], false, 2);
        assert!((exact.duration() - 2e-4).abs() < 1e-12);
    }
}
