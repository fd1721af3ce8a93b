//! Mean dilatation between two displacements of several elements at a time. Formulas and letters are those of `between.rs`.

use carom_algebra::number::Number;
use carom_materials::tensor::{double, green_lagrange, plus, product, scaled};

use super::batch::{Bad, Energies, POINTS, Path, Watch};
use super::passes::{Elements, Room, add, stretch};

impl<const N: usize, const D: usize, const E: usize> Elements<'_, N, D, E> {
    /// Replaces H at both ends by the strain of F̄_1 and ΔĒ.
    #[inline(always)]
    pub(super) fn dilate_between<T: Number>(
        &self,
        room: &mut Room<T, N, D, E>,
    ) -> Result<(), Bad<T>> {
        let (zero, one) = (room.mean.like(0.0), room.mean.like(1.0));
        let (mut volume, mut change) = (zero, zero);
        // θ V - V at both ends
        let mut growth = [zero; 2];
        let (mut watch, mut changes) = (Watch::new(zero), [zero; POINTS]);
        let points = self.cell.points().len();
        for q in 0..points {
            let (path, d) = Path::between(&room.law.from[q], &room.law.h[q]);
            for grown in path.grown {
                watch.see(q, grown + one);
            }
            let own = room.metrics[q].volume();
            volume += own;
            changes[q] = double(&path.slope, &d);
            change = own.mul_add(changes[q], change);
            for k in 0..2 {
                growth[k] = own.mul_add(path.grown[k], growth[k]);
            }
            (room.paths[q], room.law.from[q]) = (path, d);
        }
        let inverse = one / volume;
        let theta = [growth[0] * inverse, growth[1] * inverse];
        change = change * inverse;
        (room.volume, room.mean) = (volume, (theta[0] + theta[1]).scale(0.5));
        for q in 0..points {
            let path = &mut room.paths[q];
            let (mut more, mut s) = ([zero; 2], [one; 2]);
            for k in 0..2 {
                let ratio = (theta[k] - path.grown[k]) / (path.grown[k] + one);
                more[k] = ratio.ln_1p().scale(1.0 / 3.0).exp_m1();
                s[k] = more[k] + one;
            }
            let squares = s[0] * s[0] + s[1] * s[1];
            path.square = squares.scale(0.5);
            let jacobians = (path.grown[0] + one) * (path.grown[1] + one);
            path.rate = (s[0] + s[1]) / ((squares + s[0] * s[1]) * jacobians);
            let growth = path.rate * (path.jacobian * change - (room.mean + one) * changes[q]);
            stretch(&mut room.law.h[q], s[1], more[1]);
            room.law.h[q] = green_lagrange(&room.law.h[q]);
            let own = scaled(&room.law.from[q], path.square);
            room.law.from[q] = plus(&own, growth.scale(0.5), &path.c_m);
        }
        watch.end()
    }

    /// Forces of mean dilatation between two displacements.
    #[inline(always)]
    pub(super) fn dilated_between<T: Number>(&self, room: &mut Room<T, N, D, E>) -> Energies<T> {
        let zero = room.mean.like(0.0);
        let (mut df, mut dv) = ([[[zero; D]; E]; D], [[[zero; D]; E]; D]);
        let mut by_volume = [[zero; D]; N];
        let (mut energies, mut whole) = ([zero; 5], zero);
        let (theta, share) = (room.mean + zero.like(1.0), zero.like(1.0) / room.volume);
        for q in 0..self.cell.points().len() {
            let (metric, answer) = (&room.metrics[q], &room.law.answers[q]);
            let (weight, path) = (room.law.weights[q], &room.paths[q]);
            let weighted = metric.volume() * weight;
            add(&mut energies, (answer, room.law.viscous.works[q]), weighted);
            let pressure = (path.rate * double(&answer.stress, &path.c_m)).scale(0.5);
            whole = (weighted * path.jacobian).mul_add(pressure, whole);
            let own = scaled(&answer.stress, path.square);
            let stress = product(&path.f_m, &plus(&own, -(pressure * theta), &path.slope));
            self.spread((q, metric), &stress, weight, (&mut df, &mut room.f));
            let slope = product(&path.f_m, &path.slope);
            self.spread((q, metric), &slope, share, (&mut dv, &mut by_volume));
        }
        self.cell.add_differences(&df, &mut room.f);
        self.cell.add_differences(&dv, &mut by_volume);
        for a in 0..N {
            for i in 0..D {
                room.f[a][i] = by_volume[a][i].mul_add(whole, room.f[a][i]);
            }
        }
        energies
    }
}
