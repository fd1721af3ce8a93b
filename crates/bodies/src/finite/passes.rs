//! The two functions around the law of a batch of elements at finite strain: gradients before it, forces behind it.

use carom_algebra::number::Number;
use carom_elements::Kind;
use carom_materials::tensor::determinant_less_1;
use carom_materials::{Answer, Tensor};
use pulp::NullaryFnOnce;

use super::batch::{AtLaw, Bad, Energies, POINTS, Path, Together, Watch};
use super::hourglass::{pattern, patterns};
use crate::force::{self, Cell, Metric, OfEdges};

/// What is the same for all batches of a chunk.
pub(super) struct Elements<'a, const N: usize, const D: usize, const E: usize> {
    pub(super) cell: Cell<'a, N, D, E>,
    pub(super) together: Together,
    pub(super) kind: Kind,
    /// Whether the internal work has weights.
    pub(super) weighted: bool,
    /// Whether forces are those between two displacements.
    pub(super) between: bool,
}

/// Several elements on their way through the functions.
pub(super) struct Room<T, const N: usize, const D: usize, const E: usize> {
    /// Places and displacements of the nodes, m.
    pub(super) x: [[T; D]; N],
    pub(super) u: [[T; D]; N],
    /// Displacements at the start of a step, for forces between the two, m.
    pub(super) from: [[T; D]; N],
    /// Forces on them, N.
    pub(super) f: [[T; D]; N],
    pub(super) law: AtLaw<T>,
    pub(super) metrics: [Metric<T, D>; POINTS],
    /// With mean dilatation.
    stretches: [T; POINTS],
    /// With mean dilatation between two displacements.
    pub(super) paths: [Path<T>; POINTS],
    /// θ - 1, its mean over a step less 1, and with one point its ∫ δ dV.
    pub(super) mean: T,
    /// V.
    pub(super) volume: T,
    /// Mean gradients of one point, in 1/m, and those around the axis.
    gradients: [[T; D]; N],
    ring: [[T; D]; N],
}

impl<T: Number, const N: usize, const D: usize, const E: usize> Room<T, N, D, E> {
    /// Zeros like this one.
    #[inline(always)]
    pub(super) fn new(zero: T) -> Self {
        Room {
            x: [[zero; D]; N],
            u: [[zero; D]; N],
            from: [[zero; D]; N],
            f: [[zero; D]; N],
            law: AtLaw::new(zero),
            metrics: [Metric::zero(zero); POINTS],
            stretches: [zero; POINTS],
            paths: [Path::new(zero); POINTS],
            mean: zero,
            volume: zero,
            gradients: [[zero; D]; N],
            ring: [[zero; D]; N],
        }
    }
}

/// Displacement gradients at all points.
pub(super) struct Gradients<'a, T, const N: usize, const D: usize, const E: usize>(
    pub(super) &'a Elements<'a, N, D, E>,
    pub(super) &'a mut Room<T, N, D, E>,
);

/// Forces and energies.
pub(super) struct Forces<'a, T, const N: usize, const D: usize, const E: usize>(
    pub(super) &'a Elements<'a, N, D, E>,
    pub(super) &'a mut Room<T, N, D, E>,
);

impl<T: Number, const N: usize, const D: usize, const E: usize> NullaryFnOnce
    for Gradients<'_, T, N, D, E>
{
    type Output = Result<(), Bad<T>>;

    #[inline(always)]
    fn call(self) -> Result<(), Bad<T>> {
        let Gradients(elements, room) = self;
        let batch = elements.cell.batch(&room.x, &room.u);
        if let Together::OnePoint(_) = elements.together {
            let mean = elements.mean_gradient(&batch, &room.law.weights);
            (room.gradients, room.ring, room.mean) = (mean.gradients, mean.ring, mean.weighted);
            room.law.h[0] = elements.whole(&mean.h, mean.hoop);
            if elements.between {
                let (h, hoop) = elements.by_mean((&room.gradients, &room.ring), &room.from);
                room.law.from[0] = elements.whole(&h, hoop);
            }
            return Ok(());
        }
        for (q, point) in elements.cell.points().iter().enumerate() {
            let (metric, h, hoop) = elements.cell.at_point(point, &batch);
            room.metrics[q] = metric;
            room.law.h[q] = elements.whole(&h, hoop);
        }
        if elements.between {
            let before = elements.cell.differences(&room.from);
            for (q, point) in elements.cell.points().iter().enumerate() {
                let at = (point, &room.metrics[q]);
                let (h, hoop) = elements.cell.slope(at, &before, &room.from);
                room.law.from[q] = elements.whole(&h, hoop);
            }
        }
        match (elements.together, elements.between) {
            (Together::Dilated, false) => elements.dilate(room),
            (Together::Dilated, true) => elements.dilate_between(room),
            _ => Ok(()),
        }
    }
}

impl<T: Number, const N: usize, const D: usize, const E: usize> NullaryFnOnce
    for Forces<'_, T, N, D, E>
{
    type Output = Energies<T>;

    #[inline(always)]
    fn call(self) -> Energies<T> {
        let Forces(elements, room) = self;
        let zero = room.mean.like(0.0);
        room.f = [[zero; D]; N];
        match elements.together {
            Together::Full => elements.full(room),
            Together::Dilated if elements.between => elements.dilated_between(room),
            Together::Dilated => elements.dilated(room),
            Together::OnePoint(modulus) => elements.one_point(modulus, room),
        }
    }
}

impl<const N: usize, const D: usize, const E: usize> Elements<'_, N, D, E> {
    /// H with all its components.
    #[inline(always)]
    fn whole<T: Number>(&self, h: &[[T; D]; D], hoop: T) -> Tensor<T> {
        let mut whole = [[hoop.like(0.0); 3]; 3];
        for i in 0..D {
            for j in 0..D {
                whole[i][j] = h[i][j];
            }
        }
        if self.cell.has_hoop() {
            whole[2][2] = hoop;
        }
        whole
    }

    /// Adds what a stress at a point makes of forces. `factor`: of dV.
    #[inline(always)]
    pub(super) fn spread<T: Number>(
        &self,
        (q, metric): (usize, &Metric<T, D>),
        stress: &Tensor<T>,
        factor: T,
        (df, f): (&mut OfEdges<T, D, E>, &mut [[T; D]; N]),
    ) {
        let point = &self.cell.points()[q];
        let weight = factor * metric.measure;
        self.cell
            .spread((point, metric), &inner(stress), weight, df);
        if self.cell.has_hoop() {
            self.cell
                .spread_hoop((point, metric), stress[2][2], factor, f);
        }
    }

    /// Full integration.
    #[inline(always)]
    fn full<T: Number>(&self, room: &mut Room<T, N, D, E>) -> Energies<T> {
        let zero = room.mean.like(0.0);
        let mut df = [[[zero; D]; E]; D];
        let mut energies = [zero; 5];
        for q in 0..self.cell.points().len() {
            let (metric, answer) = (&room.metrics[q], &room.law.answers[q]);
            let weight = room.law.weights[q];
            let (energy, volume) = ((answer, room.law.viscous.works[q]), metric.volume());
            add(&mut energies, energy, volume * weight);
            self.spread((q, metric), &answer.stress, weight, (&mut df, &mut room.f));
        }
        self.cell.add_differences(&df, &mut room.f);
        energies
    }

    /// Replaces H by that of F̄ = s F, s = (θ/J)^(1/3).
    #[inline(always)]
    fn dilate<T: Number>(&self, room: &mut Room<T, N, D, E>) -> Result<(), Bad<T>> {
        // V and θ V - V: the change of volume keeps its digits
        let (zero, one) = (room.mean.like(0.0), room.mean.like(1.0));
        let (mut volume, mut growth) = (zero, zero);
        let (mut grown, mut watch) = ([zero; POINTS], Watch::new(zero));
        let points = self.cell.points().len();
        for q in 0..points {
            grown[q] = determinant_less_1(&room.law.h[q]);
            watch.see(q, grown[q] + one);
            let own = room.metrics[q].volume();
            volume += own;
            growth = own.mul_add(grown[q], growth);
        }
        (room.volume, room.mean) = (volume, growth / volume);
        for q in 0..points {
            let ratio = (room.mean - grown[q]) / (grown[q] + one);
            let more = ratio.ln_1p().scale(1.0 / 3.0).exp_m1();
            room.stretches[q] = more + one;
            stretch(&mut room.law.h[q], room.stretches[q], more);
        }
        watch.end()
    }

    /// Mean dilatation.
    #[inline(always)]
    fn dilated<T: Number>(&self, room: &mut Room<T, N, D, E>) -> Energies<T> {
        let (zero, one) = (room.mean.like(0.0), room.mean.like(1.0));
        let (mut df, mut dv) = ([[[zero; D]; E]; D], [[[zero; D]; E]; D]);
        let mut by_volume = [[zero; D]; N];
        let (mut energies, mut mean) = ([zero; 5], zero);
        let theta = room.mean + one;
        for q in 0..self.cell.points().len() {
            let (metric, answer) = (&room.metrics[q], &room.law.answers[q]);
            let (weight, s) = (room.law.weights[q], room.stretches[q]);
            let weighted = metric.volume() * weight;
            add(&mut energies, (answer, room.law.viscous.works[q]), weighted);
            let (deviator, slope, pressure) = split(&answer.stress, &room.law.h[q], s, theta);
            mean = weighted.mul_add(pressure, mean);
            self.spread((q, metric), &deviator, weight, (&mut df, &mut room.f));
            // J/(θ V), J = θ/s³
            let share = one / (s * s * s * room.volume);
            self.spread((q, metric), &slope, share, (&mut dv, &mut by_volume));
        }
        self.cell.add_differences(&df, &mut room.f);
        self.cell.add_differences(&dv, &mut by_volume);
        for a in 0..N {
            for i in 0..D {
                room.f[a][i] = by_volume[a][i].mul_add(mean, room.f[a][i]);
            }
        }
        energies
    }

    /// One point with mean gradients, and hourglass control.
    #[inline(always)]
    fn one_point<T: Number>(&self, modulus: f64, room: &mut Room<T, N, D, E>) -> Energies<T> {
        let (answer, weighted) = (room.law.answers[0], room.mean);
        let zero = weighted.like(0.0);
        let mut energies = [zero; 5];
        add(
            &mut energies,
            (&answer, room.law.viscous.works[0]),
            weighted,
        );
        let mut pull = inner(&answer.stress);
        for i in 0..D {
            for j in 0..D {
                pull[i][j] = pull[i][j] * weighted;
            }
        }
        energies[3] = self.hourglass(modulus, room, &mut pull);
        energies[0] += energies[3];
        // the first node bears what the others give, so that the sum is nothing
        for a in 1..N {
            for i in 0..D {
                let mut force = zero;
                for j in 0..D {
                    force = pull[i][j].mul_add(room.gradients[a][j], force);
                }
                room.f[a][i] += force;
                room.f[0][i] -= force;
            }
        }
        if self.cell.has_hoop() {
            let hoop = answer.stress[2][2] * weighted;
            for a in 0..N {
                room.f[a][0] = hoop.mul_add(room.ring[a][0], room.f[a][0]);
            }
        }
        energies
    }

    /// Adds the hourglass forces to those of the nodes and to the stress that acts through the mean gradients: the shape of a
    /// pattern is γ_a = (h_a - Σ_j X_hj dN_a/dX_j)/N, X_hj = Σ_b h_b X_bj, so that its amplitude is (Σ h_a u_a - H X_h)/N.
    /// Returns the energies.
    #[inline(always)]
    fn hourglass<T: Number>(
        &self,
        modulus: f64,
        room: &mut Room<T, N, D, E>,
        pull: &mut [[T; D]; D],
    ) -> T {
        let zero = room.mean.like(0.0);
        let mut square = zero;
        for a in 0..N {
            for i in 0..D {
                square = room.gradients[a][i].mul_add(room.gradients[a][i], square);
            }
        }
        let stiffness = (room.mean * square).scale(modulus);
        let mut energy = zero;
        for axes in patterns(self.kind) {
            let mut signs = [0.0; N];
            for a in 0..N {
                signs[a] = pattern(axes, &self.kind.table().reference[a]);
            }
            let x_h = along(&signs, &room.x);
            let end = amplitudes(&room.law.h[0], &x_h, along(&signs, &room.u));
            let mut middle = end;
            if self.between {
                let begin = amplitudes(&room.law.from[0], &x_h, along(&signs, &room.from));
                for i in 0..D {
                    middle[i] = (end[i] + begin[i]).scale(0.5);
                }
            }
            for i in 0..D {
                energy += (stiffness * end[i] * end[i]).scale(0.5);
                let spread = (stiffness * middle[i]).scale(1.0 / N as f64);
                for a in 0..N {
                    room.f[a][i] = spread.scale_add(signs[a], room.f[a][i]);
                }
                for j in 0..D {
                    pull[i][j] -= spread * x_h[j];
                }
            }
        }
        energy
    }
}

/// Σ_a h_a φ_a of a pattern h.
#[inline(always)]
fn along<T: Number, const N: usize, const D: usize>(
    signs: &[f64; N],
    nodes: &[[T; D]; N],
) -> [T; D] {
    let mut sum = [nodes[0][0].like(0.0); D];
    for a in 0..N {
        for i in 0..D {
            sum[i] = nodes[a][i].scale_add(signs[a], sum[i]);
        }
    }
    sum
}

/// (u_h - H X_h)/N, N = 2^D.
#[inline(always)]
fn amplitudes<T: Number, const D: usize>(h: &Tensor<T>, x_h: &[T; D], u_h: [T; D]) -> [T; D] {
    let mut amplitudes = u_h;
    for i in 0..D {
        for j in 0..D {
            amplitudes[i] -= h[i][j] * x_h[j];
        }
        amplitudes[i] = amplitudes[i].scale(1.0 / (1 << D) as f64);
    }
    amplitudes
}

/// The components in space.
#[inline(always)]
fn inner<T: Number, const D: usize>(stress: &Tensor<T>) -> [[T; D]; D] {
    let mut inner = [[stress[0][0]; D]; D];
    for i in 0..D {
        for j in 0..D {
            inner[i][j] = stress[i][j];
        }
    }
    inner
}

#[inline(always)]
pub(super) fn add<T: Number>(sum: &mut Energies<T>, (answer, viscous): (&Answer<T>, T), volume: T) {
    sum[0] = volume.mul_add(answer.stored, sum[0]);
    sum[1] = volume.mul_add(answer.hardening, sum[1]);
    sum[2] = volume.mul_add(answer.dissipated, sum[2]);
    sum[4] = volume.mul_add(viscous, sum[4]);
}

/// Replaces H by s H + (s - 1) I.
#[inline(always)]
pub(super) fn stretch<T: Number>(h: &mut Tensor<T>, s: T, more: T) {
    for i in 0..3 {
        for j in 0..3 {
            h[i][j] = h[i][j] * s;
        }
        h[i][i] += more;
    }
}

/// s P̄ - m g, g = F^-T, and m = P̄ : F̄ / 3, from F̄ = I + `h` = s F whose determinant is θ.
#[inline(always)]
fn split<T: Number>(
    stress: &Tensor<T>,
    h: &Tensor<T>,
    s: T,
    theta: T,
) -> (Tensor<T>, Tensor<T>, T) {
    let (zero, one) = (s.like(0.0), s.like(1.0));
    let mut f = *h;
    for i in 0..3 {
        f[i][i] += one;
    }
    let (mut deviator, mut pressure) = (*stress, zero);
    for i in 0..3 {
        for j in 0..3 {
            pressure = stress[i][j].mul_add(f[i][j], pressure);
        }
    }
    let pressure = pressure.scale(1.0 / 3.0);
    let mut slope = force::cofactor(&f);
    let inverse = s / theta;
    for i in 0..3 {
        for j in 0..3 {
            slope[i][j] = slope[i][j] * inverse;
            deviator[i][j] = stress[i][j] * s - slope[i][j] * pressure;
        }
    }
    (deviator, slope, pressure)
}
