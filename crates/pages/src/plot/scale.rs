//! Ranges, prefixes and numbers of an axis.

use super::{Axis, Panel, Role};

/// Margin beyond the data, as a part of their range.
const MARGIN: f64 = 0.06;

/// A range is clipped to percentiles if the full one is this many times as long.
const SPIKY: f64 = 1.6;

/// Part of the full range below which what is usual is rounding beside the spikes, not a curve.
const ROUNDING: f64 = 1e-12;

/// Smaller numbers are drawn and prefixed as if they were none: a range of them, or a factor that brings them near one, would
/// lose its digits below the smallest normal number, 2.2e-308.
const NOTHING: f64 = 1e-290;

/// Prefixes of units, one per factor of a thousand from 1e-15.
const PREFIXES: [&str; 10] = ["f", "p", "n", "µ", "m", "", "k", "M", "G", "T"];

/// What an axis shows.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Scale {
    /// Data are divided by this before they are drawn.
    pub factor: f64,
    /// Lower end of the axis, after division.
    pub low: f64,
    /// Upper end of the axis, after division; above `low`.
    pub high: f64,
    /// Quantity and unit with its prefix: `Contact force (kN)`.
    pub label: String,
}

impl Scale {
    /// The axis that shows `low..high` (SI), which is widened if it is empty.
    pub fn new(axis: Axis, low: f64, high: f64, margin: bool) -> Scale {
        let (low, high) = match low.abs().max(high.abs()) < NOTHING {
            true => (0.0, 0.0),
            false => (low, high),
        };
        let largest = low.abs().max(high.abs());
        let (factor, unit) = engineering(axis.unit, largest);
        let (low, high) = (low / factor, high / factor);
        let (low, high) = match (high - low, largest / factor) {
            // A constant, up to rounding: put it in the middle of a range on which it looks constant.
            (span, size) if span <= 1e-9 * size || span == 0.0 => {
                let half = if size > 0.0 { 0.1 * size } else { 1.0 };
                let middle = 0.5 * (low + high);
                (middle - half, middle + half)
            }
            (span, _) if margin => (low - MARGIN * span, high + MARGIN * span),
            _ => (low, high),
        };
        Scale {
            factor,
            low,
            high,
            label: label(axis.quantity, &unit),
        }
    }

    /// A number beside a tick: as few decimals as tell neighbouring ticks apart.
    pub fn tick(&self, value: f64) -> String {
        let decimals = (1.7 - (self.high - self.low).log10())
            .ceil()
            .clamp(0.0, 9.0) as usize;
        let text = format!("{value:.decimals$}");
        let text = match text.contains('.') {
            true => text.trim_end_matches('0').trim_end_matches('.'),
            false => &text,
        };
        match text {
            "-0" => "0".to_owned(),
            _ => text.replace('-', "−"),
        }
    }
}

/// Smallest and largest of some numbers; `None` if there are none.
pub fn extremes(values: impl IntoIterator<Item = f64>) -> Option<(f64, f64)> {
    values.into_iter().fold(None, |range, value| match range {
        Some((low, high)) => Some((value.min(low), value.max(high))),
        None => Some((value, value)),
    })
}

/// What of a panel's ordinates is shown.
pub struct Shown {
    /// Lowest value shown, SI.
    pub low: f64,
    /// Highest value shown, SI.
    pub high: f64,
    /// If something is not shown: number of samples beyond, and the value of largest magnitude among them, SI.
    pub beyond: Option<(usize, f64)>,
}

/// The ordinates to show: all, or without rare spikes ([`super::Figure::svg`]).
pub fn shown(panel: &Panel) -> Shown {
    let of = |role: Role| {
        let curves = panel.curves.iter().filter(move |curve| curve.role == role);
        curves.flat_map(|curve| curve.y.iter().copied())
    };
    let (low, high) = extremes(of(Role::Computed).chain(of(Role::Exact))).unwrap_or((0.0, 0.0));
    let everything = Shown {
        low,
        high,
        beyond: None,
    };
    let mut computed: Vec<f64> = of(Role::Computed).collect();
    if !panel.clip || computed.is_empty() {
        return everything;
    }
    computed.sort_unstable_by(f64::total_cmp);
    let last = computed.len() - 1;
    let usual = [computed[last / 100], computed[last - last / 100]];
    let Some((usual_low, usual_high)) = extremes(of(Role::Exact).chain(usual)) else {
        return everything;
    };
    let usual = usual_high - usual_low;
    if high - low <= SPIKY * usual || usual <= ROUNDING * (high - low) {
        return everything;
    }
    let margin = MARGIN * (usual_high - usual_low);
    let inside = usual_low - margin..=usual_high + margin;
    let beyond = computed.into_iter().filter(|y| !inside.contains(y));
    let (count, farthest) = beyond.fold((0, 0.0), |(count, far), y| {
        (count + 1, if y.abs() > f64::abs(far) { y } else { far })
    });
    Shown {
        low: usual_low,
        high: usual_high,
        beyond: Some((count, farthest)),
    }
}

/// A value with its unit and prefix, three digits: `66.7 kN`; with a power of ten where no prefix serves:
/// `2.20·10⁻¹⁶ J`. A pure number has no unit: `0.990`.
pub fn quantity(value: f64, unit: &str) -> String {
    rounded(value, unit, 3)
}

/// As [`quantity`], with this many significant digits.
pub fn rounded(value: f64, unit: &str, figures: i32) -> String {
    if value == 0.0 || !value.is_finite() {
        // a zero has no sign
        return format!("{} {unit}", value + 0.0).trim_end().to_owned();
    }
    let (factor, prefixed) = engineering(unit, value.abs());
    let plain = unit.is_empty() && (1e-3..1e6).contains(&value.abs());
    let text = match prefixed.starts_with("10") || value.abs() < NOTHING {
        true if plain => format!("{} {unit}", digits(value, figures)),
        true => format!("{} {unit}", scientific(value, figures as usize - 1)),
        false => format!("{} {prefixed}", digits(value / factor, figures)),
    };
    text.trim_end().to_owned()
}

/// A number with so many significant digits and no power of ten, not rounded before the point.
pub fn digits(value: f64, count: i32) -> String {
    let before = value.abs().log10().floor() as i32;
    let decimals = (count - 1 - before).clamp(0, 12) as usize;
    format!("{value:.decimals$}").replace('-', "−")
}

/// A number as one digit, so many decimals and a power of ten: `−2.20·10⁻¹⁶`.
pub fn scientific(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$e}");
    let (mantissa, power) = text.split_once('e').unwrap_or((&text, "0"));
    format!("{}·10{}", mantissa.replace('-', "−"), superscript(power))
}

/// The factor which brings `largest` between 1 and 1000, and the unit with it: a prefix where the unit takes one,
/// a power of ten before it otherwise.
pub(crate) fn engineering(unit: &str, largest: f64) -> (f64, String) {
    let plain = (1.0, unit.to_owned());
    if largest < NOTHING || !largest.is_finite() {
        return plain;
    }
    let thousands = (largest.log10() / 3.0 + 1e-9).floor() as i32;
    let bare = matches!(unit, "m" | "s" | "N" | "J" | "Pa" | "m/s" | "N s" | "W");
    let prefix = usize::try_from(thousands + 5)
        .ok()
        .and_then(|index| PREFIXES.get(index));
    match prefix {
        _ if thousands == 0 => plain,
        // Nobody writes kiloseconds, and metres and metres per second beyond a thousand stay what they are, up to a million.
        _ if thousands == 1 && matches!(unit, "s" | "m" | "m/s") => plain,
        // A power of ten reads worse than a few zeros.
        _ if !bare && (1e-2..1e4).contains(&largest) => plain,
        Some(prefix) if bare && !(thousands > 1 && matches!(unit, "s" | "m" | "m/s")) => {
            (1000_f64.powi(thousands), format!("{prefix}{unit}"))
        }
        _ => {
            let power = superscript(&(3 * thousands).to_string());
            (
                1000_f64.powi(thousands),
                format!("10{power} {unit}").trim_end().to_owned(),
            )
        }
    }
}

fn superscript(power: &str) -> String {
    let raised = |digit| match digit {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '0' => '⁰',
        _ => char::from_u32('⁰' as u32 + digit as u32 - '0' as u32).unwrap_or(digit),
    };
    power.chars().map(raised).collect()
}

fn label(quantity: &str, unit: &str) -> String {
    let mut letters = quantity.chars();
    let capital: String = letters
        .next()
        .into_iter()
        .flat_map(char::to_uppercase)
        .collect();
    let name = capital + letters.as_str();
    match unit {
        "" => name,
        _ => format!("{name} ({unit})"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::Curve;

    const FORCE: Axis = Axis {
        quantity: "contact force",
        unit: "N",
    };

    /// A spike over nothing but rounding is all that there is; over a curve it is left out.
    #[test]
    fn a_spike_over_rounding_is_shown() {
        let x: Vec<f64> = (0..500).map(f64::from).collect();
        for (usual, is_shown) in [(1e-9, true), (1.0, false)] {
            let mut y: Vec<f64> = x.iter().map(|x| usual * x.sin()).collect();
            y[100] = 1e5;
            let panel = Panel {
                title: String::new(),
                ordinate: FORCE,
                curves: vec![Curve {
                    name: "a",
                    x: &x,
                    y: &y,
                    role: Role::Computed,
                }],
                clip: true,
            };
            assert_eq!(shown(&panel).beyond.is_none(), is_shown);
        }
    }

    #[test]
    fn a_zero_has_no_sign() {
        assert_eq!(quantity(-0.0, "N"), "0 N");
        assert_eq!(quantity(0.0, ""), "0");
    }

    #[test]
    fn prefixes_bring_the_largest_value_between_one_and_a_thousand() {
        assert_eq!(engineering("N", 66_740.0), (1e3, "kN".to_owned()));
        assert_eq!(engineering("N", 1000.0), (1e3, "kN".to_owned()));
        assert_eq!(engineering("s", 3.0e-4), (1e-6, "µs".to_owned()));
        assert_eq!(engineering("m", 0.0), (1.0, "m".to_owned()));
        assert_eq!(engineering("m/s²", 2.0e6).1, "10⁶ m/s²");
        assert_eq!(engineering("", 2.0e-4).1, "10⁻⁶");
        let (factor, _) = engineering("", 2.0e-4);
        assert!((2.0e-4 / factor - 200.0).abs() < 1e-10);
    }

    #[test]
    fn a_constant_stands_in_the_middle_of_a_range_that_is_not_empty() {
        for value in [0.0, 5.0, -7.0e4] {
            let scale = Scale::new(FORCE, value, value, true);
            assert!(scale.low < scale.high);
            let middle = 0.5 * (scale.low + scale.high) * scale.factor;
            assert!((middle - value).abs() <= 1e-12 * value.abs());
        }
    }

    #[test]
    fn numbers_next_to_the_smallest_have_a_range_that_can_be_drawn() {
        for high in [5e-324, 2.3e-308, 1.5e-305, 1e-291, 1e-289] {
            for low in [0.0, -high] {
                let scale = Scale::new(FORCE, low, high, true);
                assert!(scale.factor.is_normal(), "{high}");
                let ends = [scale.low, scale.high];
                assert!(ends.iter().all(|end| end.is_finite()), "{scale:?}");
                // plotters divides by the range in steps of a tenth of it
                assert!(scale.high - scale.low > 1e-12, "{scale:?}");
                let text = quantity(high, "N");
                assert!(text.contains("·10⁻") && text.ends_with(" N"), "{text}");
            }
        }
    }

    #[test]
    fn ticks_have_the_decimals_that_tell_them_apart_and_no_more() {
        let scale = Scale::new(FORCE, 0.0, 0.5, false);
        assert_eq!(scale.label, "Contact force (mN)");
        assert_eq!(scale.tick(100.0), "100");
        let narrow = Scale::new(FORCE, 1.0, 1.01, false);
        assert_eq!(narrow.tick(1.002), "1.002");
        assert_eq!(narrow.tick(-1.0), "−1");
        assert_eq!(narrow.tick(-1e-15), "0");
    }

    #[test]
    fn quantities_read_as_people_write_them() {
        assert_eq!(quantity(66_740.0, "N"), "66.7 kN");
        assert_eq!(quantity(-2.5e-6, "m"), "−2.50 µm");
        assert_eq!(quantity(0.0, "J"), "0 J");
        assert_eq!(quantity(7.7e149, "s"), "7.70·10¹⁴⁹ s");
        assert_eq!(quantity(2500.0, "s"), "2500 s");
        assert_eq!(quantity(2.0e6, "m/s²"), "2.00·10⁶ m/s²");
        assert_eq!(quantity(-2.2e-16, "J"), "−2.20·10⁻¹⁶ J");
        assert_eq!(quantity(0.9904, ""), "0.990");
        assert_eq!(quantity(999.96, "N"), "1000 N");
        assert_eq!(quantity(f64::NAN, "N"), "NaN N");
    }
}
