//! H: the velocity that multipliers leave in the rows of the links, without contact and of the linearised zones.

use carom_algebra::dense::DenseCholesky;

use crate::error::Error;
use crate::model::LinkKind;
use crate::zones::Zones;
use carom_dynamics::condensed::{Answer, Condensed, DENSE, Joined, Matrix};
use carom_dynamics::linked::Growth;
use carom_dynamics::operator::assembled;
use carom_system::{LinkRow, System};

impl Zones {
    /// Makes the factor of H anew in the joined form, whatever the number of rows: to compare the two.
    ///
    /// # Errors
    /// Redundant rows.
    pub fn join(&mut self) -> Result<(), Error> {
        self.factor = Some(self.joined()?);
        Ok(())
    }

    fn joined(&self) -> Result<Condensed, Error> {
        let zones = self.drivers.iter().zip(&self.rows);
        let answers: Vec<Answer> = zones
            .map(|(driver, rows)| {
                let (mass, stiffness, velocity) = driver.effective();
                let scale = velocity * driver.link_weights()[1];
                answer((driver.system(), rows), [mass, stiffness], scale)
            })
            .collect();
        let joined = Joined::new(&answers, self.norms.len())?;
        Ok(Condensed::Joined(Box::new(joined)))
    }

    /// Makes and factors H of the multipliers that a pass looks for.
    pub(crate) fn factorise(&mut self) -> Result<(), Error> {
        if let Some(links) = &mut self.turning {
            links.at_origins(&self.origins, &mut self.rows);
        }
        let n = self.norms.len();
        let alike = self.substeps.iter().all(|m| *m == 1);
        if n > DENSE && alike {
            return self.join();
        }
        if n == 0 {
            return Ok(());
        }
        let (mut h, mut outer) = (vec![0.0; n * n], vec![0.0; n * n]);
        for (k, driver) in self.drivers.iter_mut().enumerate() {
            let rows = &self.rows[k];
            let steps = match self.kind {
                LinkKind::GravouilCombescure => 1,
                LinkKind::PrakashHjelmstad => self.substeps[k],
            };
            let [own, _] = driver.ramp((rows, (steps, Growth::Linear)), &self.origins[k])?;
            for (i, (row, _)) in rows.iter().enumerate() {
                for (j, (column, _)) in rows.iter().enumerate() {
                    let place = *row as usize * n + *column as usize;
                    let entry = 0.5 * (own[i * rows.len() + j] + own[j * rows.len() + i]);
                    h[place] += entry;
                    if self.substeps[k] == 1 {
                        outer[place] += entry;
                    }
                }
            }
        }
        self.outer = outer;
        let factor = DenseCholesky::new(n, &h);
        let factor = factor.map_err(|cause| carom_dynamics::Error::Redundant { rows: n, cause })?;
        self.factor = Some(Condensed::Dense(factor));
        Ok(())
    }
}

/// A zone in H, with A = `mass` M + `stiffness` K.
pub(crate) fn answer<'a>(
    (system, rows): (&'a System, &[(u32, LinkRow)]),
    [mass, stiffness]: [f64; 2],
    scale: f64,
) -> Answer<'a> {
    let span = 0..system.unknowns();
    let matrix = match stiffness == 0.0 && system.mass.is_lumped() {
        true => Matrix::Diagonal(system.mass.lumped.iter().map(|m| mass * m).collect()),
        false => Matrix::Sparse(assembled(system, &span, [mass, 0.0], &|_| stiffness)),
    };
    Answer {
        system,
        span,
        rows: rows.to_vec(),
        matrix,
        scale,
    }
}
