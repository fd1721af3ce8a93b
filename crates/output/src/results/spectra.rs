//! Response spectra of the absolute accelerations of probes: what an oscillator on the structure there would feel, which is called
//! the floor spectrum.

use carom_dynamics::{Order, State, StepReport, System};
use carom_pages::plot::{Logarithmic, Series};
use carom_signals::{Record, response_spectrum};

use crate::results::sensor::{COMPONENTS, Sensor};
use crate::results::settings::{Settings, Spectrum};
use crate::rows::Cell;
use crate::table::write_csv;
use crate::{Error, Folder, column};

/// The accelerations of the probes with a spectrum.
#[derive(Debug)]
pub(crate) struct Spectra {
    probes: Vec<OfProbe>,
}

#[derive(Debug)]
struct OfProbe {
    name: String,
    spectrum: Spectrum,
    sensors: Vec<Sensor>,
    /// Time (s) and acceleration (m/s²) in each direction.
    histories: Vec<Vec<[f64; 2]>>,
}

/// Accelerations at times that are closer than this part of the shortest period are thinned out: an oscillator feels their mean.
const RESOLVED: f64 = 40.0;

impl Spectra {
    /// Nothing yet; `sensors`: of each probe.
    pub(crate) fn new(settings: &Settings, sensors: &[Vec<Sensor>]) -> Spectra {
        let probes = settings.probes.iter().zip(sensors);
        let probes = probes.filter_map(|(probe, sensors)| {
            Some(OfProbe {
                name: probe.name.clone(),
                spectrum: probe.spectrum.clone()?,
                sensors: sensors.clone(),
                histories: vec![Vec::new(); sensors.len()],
            })
        });
        Spectra {
            probes: probes.collect(),
        }
    }

    /// What was kept so far: the histories of each probe.
    pub(crate) fn kept(&self) -> Vec<&[Vec<[f64; 2]>]> {
        self.probes.iter().map(|p| &p.histories[..]).collect()
    }

    /// Whether this can be gone on with.
    pub(crate) fn takes(&self, kept: &[Vec<Vec<[f64; 2]>>]) -> bool {
        let mut pairs = self.probes.iter().zip(kept);
        kept.len() == self.probes.len()
            && pairs.all(|(probe, histories)| {
                let length = histories.first().map_or(0, Vec::len);
                histories.len() == probe.histories.len()
                    && histories.iter().all(|history| history.len() == length)
            })
    }

    /// Goes on from what was kept.
    pub(crate) fn go_on(&mut self, kept: Vec<Vec<Vec<[f64; 2]>>>) {
        for (probe, histories) in self.probes.iter_mut().zip(kept) {
            probe.histories = histories;
        }
    }

    pub(crate) fn push(&mut self, system: &System, state: &State, report: &StepReport) {
        for probe in &mut self.probes {
            let frame = system.frame_acceleration(report.time, report.dt);
            let sensors = probe.sensors.iter().zip(&mut probe.histories);
            for ((sensor, history), frame) in sensors.zip(frame) {
                let own = sensor.of(system, &state.motion, Order::Acceleration);
                history.push([report.time, frame + own]);
            }
        }
    }

    /// Writes `spectra.csv`; the figure, if there is a spectrum that is not zero.
    ///
    /// # Errors
    /// The file cannot be written.
    pub(crate) fn write(&mut self, folder: &mut Folder) -> Result<Option<Logarithmic>, Error> {
        let mut names = Vec::new();
        let mut series: Vec<Series> = Vec::new();
        for probe in &mut self.probes {
            for (axis, history) in probe.histories.iter_mut().enumerate() {
                let shortest = probe.spectrum.frequencies.last().map_or(0.0, |f| 1.0 / f);
                let record = match Record::new(averaged(history, shortest / RESOLVED)) {
                    Ok(record) => record,
                    // one state alone is no record
                    Err(_) => continue,
                };
                let Spectrum {
                    damping,
                    frequencies,
                } = &probe.spectrum;
                let found = response_spectrum(&record, frequencies, *damping);
                let direction = COMPONENTS[axis];
                let what = format!("absolute acceleration {direction}");
                names.push(column(&["probe", &probe.name, &what], "m/s²"));
                let points = found.frequencies.into_iter().zip(found.acceleration);
                series.push(Series {
                    name: format!(
                        "{}, {direction}, {} %",
                        probe.name,
                        carom_pages::plot::digits(100.0 * damping, 3)
                    ),
                    points: points.collect(),
                    law: None,
                });
            }
        }
        if series.is_empty() {
            return Ok(None);
        }
        self.table(folder, &names, &series)?;
        // zeros have no logarithm: a probe at rest is in the table alone
        series.retain(Series::is_shown);
        if series.is_empty() {
            return Ok(None);
        }
        Ok(Some(Logarithmic {
            title: "Response spectra of absolute accelerations".to_owned(),
            abscissa: "frequency (Hz)".to_owned(),
            ordinate: "acceleration (m/s²)".to_owned(),
            series,
        }))
    }

    /// A row for each frequency of any probe.
    fn table(&self, folder: &mut Folder, names: &[String], series: &[Series]) -> Result<(), Error> {
        let mut frequencies: Vec<f64> = series
            .iter()
            .flat_map(|s| s.points.iter().map(|p| p.0))
            .collect();
        frequencies.sort_by(f64::total_cmp);
        frequencies.dedup();
        let row = |frequency: &f64| -> Vec<Cell> {
            let of = |series: &Series| {
                let point = series.points.iter().find(|point| point.0 == *frequency);
                Cell::from(point.map(|point| point.1))
            };
            let first = std::iter::once(Cell::Number(*frequency));
            first.chain(series.iter().map(of)).collect()
        };
        let rows: Vec<Vec<Cell>> = frequencies.iter().map(row).collect();
        let names: Vec<String> = std::iter::once(column(&["frequency"], "Hz"))
            .chain(names.iter().cloned())
            .collect();
        write_csv(&folder.file("spectra.csv")?, &names, &rows)
    }
}

/// A history in means over `step` (s) where it has more points than that.
fn averaged(history: &[[f64; 2]], step: f64) -> Vec<[f64; 2]> {
    let mut means: Vec<[f64; 2]> = Vec::new();
    let mut from = 0;
    while from < history.len() {
        let start = history[from][0];
        let rest = history[from..].iter();
        let count = rest.take_while(|[t, _]| *t < start + step).count().max(1);
        let part = &history[from..from + count];
        let sum = part
            .iter()
            .fold([0.0; 2], |s, p| [s[0] + p[0], s[1] + p[1]]);
        means.push(sum.map(|s| s / count as f64));
        from += count;
    }
    means
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_keep_the_integral_and_a_coarse_history_stays_as_it_is() {
        let history: Vec<[f64; 2]> = (0..1000)
            .map(|k| [1e-3 * f64::from(k), (0.05 * f64::from(k)).sin()])
            .collect();
        // ten points each, whatever rounding does to their times
        let means = averaged(&history, 9.5e-3);
        assert_eq!(means.len(), 100);
        let sum = |points: &[[f64; 2]]| points.iter().map(|p| p[1]).sum::<f64>();
        assert!((10.0 * sum(&means) - sum(&history)).abs() < 1e-10);
        assert_eq!(averaged(&history, 1e-4), history);
    }

    #[test]
    fn frequencies_are_in_a_constant_ratio_from_the_first_to_the_last() {
        let spectrum = Spectrum::between([1.0, 16.0], 5, 0.05);
        for (found, exact) in spectrum.frequencies.iter().zip([1.0, 2.0, 4.0, 8.0, 16.0]) {
            assert!((found / exact - 1.0).abs() < 1e-14);
        }
    }
}
