//! Quantities written as text: a number, a unit, a dimension to check.
//!
//! `"254 mm"`, `"210 GPa"`, `"7.8 t/m^3"` and `"1.2e5 N*s/m^3"` become SI numbers. A unit is a product or quotient of symbols, read
//! from left to right, each with an SI prefix where that is usual and an integer exponent. Powers of ten go into the exponent of the
//! decimal number before it is rounded, so `"254 mm"` has the bits of `0.254`.

use std::fmt;

/// Exponents of length, mass and time: m^l kg^m s^t. Angles count as numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dimension {
    /// Exponent of the metre.
    pub length: i32,
    /// Exponent of the kilogram.
    pub mass: i32,
    /// Exponent of the second.
    pub time: i32,
}

/// Dimensions that have a name, with their SI unit: for messages.
const NAMED: &[(&str, &str, Dimension)] = &[
    ("number", "no unit", dimension(0, 0, 0)),
    ("angle", "rad", dimension(0, 0, 0)),
    ("length", "m", dimension(1, 0, 0)),
    ("area", "m^2", dimension(2, 0, 0)),
    ("second moment of area", "m^4", dimension(4, 0, 0)),
    ("volume", "m^3", dimension(3, 0, 0)),
    ("time", "s", dimension(0, 0, 1)),
    ("mass", "kg", dimension(0, 1, 0)),
    ("density", "kg/m^3", dimension(-3, 1, 0)),
    ("stress", "Pa", dimension(-1, 1, -2)),
    ("velocity", "m/s", dimension(1, 0, -1)),
    ("acceleration", "m/s^2", dimension(1, 0, -2)),
    ("force", "N", dimension(1, 1, -2)),
    ("moment of inertia", "kg*m^2", dimension(2, 1, 0)),
    ("mass per length", "kg/m", dimension(-1, 1, 0)),
    ("energy", "J", dimension(2, 1, -2)),
    ("impulse", "N*s", dimension(1, 1, -1)),
    ("angular momentum", "N*m*s", dimension(2, 1, -1)),
    ("moment", "N*m", dimension(2, 1, -2)),
    ("power", "W", dimension(2, 1, -3)),
    ("frequency", "Hz", dimension(0, 0, -1)),
    ("stiffness", "N/m", dimension(0, 1, -2)),
    ("stiffness per area", "Pa/m", dimension(-2, 1, -2)),
    ("damping", "N*s/m", dimension(0, 1, -1)),
    ("damping per area", "Pa*s/m", dimension(-2, 1, -1)),
];

const fn dimension(length: i32, mass: i32, time: i32) -> Dimension {
    Dimension { length, mass, time }
}

impl Dimension {
    /// The dimension called `name` (`"length"`, `"stiffness per area"` ...), if there is one.
    pub fn named(name: &str) -> Option<Dimension> {
        NAMED
            .iter()
            .find(|entry| entry.0 == name)
            .map(|entry| entry.2)
    }

    /// The dimension of a unit such as `N s`; a number has the unit `""`.
    ///
    /// # Errors
    /// [`UnitError`]: an unknown unit.
    pub fn of_unit(unit: &str) -> Result<Dimension, UnitError> {
        match unit {
            "" => Ok(dimension(0, 0, 0)),
            unit => parse_unit(unit).map(|unit| unit.dimension),
        }
    }

    /// The SI unit of this dimension, as a user would write it.
    pub fn unit(self) -> String {
        match NAMED.iter().find(|entry| entry.2 == self) {
            Some((_, unit, _)) => (*unit).to_owned(),
            None => format!("m^{} kg^{} s^{}", self.length, self.mass, self.time),
        }
    }

    fn add(&mut self, other: Dimension, times: i32) {
        self.length += times * other.length;
        self.mass += times * other.mass;
        self.time += times * other.time;
    }
}

impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match NAMED.iter().find(|entry| entry.2 == *self) {
            Some((name, _, _)) => f.write_str(name),
            None => f.write_str(&self.unit()),
        }
    }
}

/// Why a text is not the quantity that is wanted.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum UnitError {
    /// The text does not begin with a decimal number.
    #[error("a quantity begins with a number")]
    NoNumber,
    /// The number is beyond the range of a 64-bit float.
    #[error("the number is too large")]
    TooLarge,
    /// A text without a unit: numbers are written bare.
    #[error("a quantity in quotes needs its unit; a number without quotes is in SI units")]
    NoUnit,
    /// A symbol that is no unit, with the nearest one.
    #[error("`{symbol}` is not a unit")]
    UnknownSymbol {
        /// The symbol as found.
        symbol: String,
        /// The known unit nearest to it.
        nearest: Option<String>,
    },
    /// An exponent that is not an integer from -9 to 9, other than 0.
    #[error("`{exponent}` is not an exponent: write an integer, as in m^3")]
    BadExponent {
        /// The exponent as found.
        exponent: String,
    },
    /// A unit that is well formed, of another dimension.
    #[error("{} instead of {}", with_article(&.found.to_string()), with_article(&.wanted.to_string()))]
    WrongDimension {
        /// Dimension of the text.
        found: Dimension,
        /// Dimension that the key takes.
        wanted: Dimension,
    },
}

impl UnitError {
    /// The unit that was meant, where that can be told: the known one nearest to an unknown one, or the standard gravity `gn` where an acceleration is in
    /// `g`, which is a gram.
    pub fn meant(&self) -> Option<String> {
        const GRAM: Dimension = dimension(0, 1, 0);
        const ACCELERATION: Dimension = dimension(1, 0, -2);
        match self {
            UnitError::UnknownSymbol { nearest, .. } => nearest.clone(),
            UnitError::WrongDimension { found, wanted } => {
                (*found == GRAM && *wanted == ACCELERATION).then(|| "gn".to_owned())
            }
            _ => None,
        }
    }
}

/// `an area`, `a length`.
pub fn with_article(noun: &str) -> String {
    let article = if noun.starts_with(['a', 'e', 'i', 'o', 'u']) {
        "an"
    } else {
        "a"
    };
    format!("{article} {noun}")
}

/// A unit: the SI value of one of it is `factor` 10^`power`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Unit {
    factor: f64,
    power: i32,
    dimension: Dimension,
}

/// Symbols: name, whether SI prefixes are allowed, factor, power of ten, dimension.
const SYMBOLS: &[(&str, bool, f64, i32, Dimension)] = &[
    ("m", true, 1.0, 0, dimension(1, 0, 0)),
    ("g", true, 1.0, -3, dimension(0, 1, 0)),
    ("s", true, 1.0, 0, dimension(0, 0, 1)),
    ("N", true, 1.0, 0, dimension(1, 1, -2)),
    ("Pa", true, 1.0, 0, dimension(-1, 1, -2)),
    ("J", true, 1.0, 0, dimension(2, 1, -2)),
    ("W", true, 1.0, 0, dimension(2, 1, -3)),
    ("Hz", true, 1.0, 0, dimension(0, 0, -1)),
    ("t", false, 1.0, 3, dimension(0, 1, 0)),
    ("bar", false, 1.0, 5, dimension(-1, 1, -2)),
    // standard gravity
    ("gn", false, 980_665.0, -5, dimension(1, 0, -2)),
    ("min", false, 60.0, 0, dimension(0, 0, 1)),
    ("h", false, 3600.0, 0, dimension(0, 0, 1)),
    ("in", false, 254.0, -4, dimension(1, 0, 0)),
    ("ft", false, 3048.0, -4, dimension(1, 0, 0)),
    ("rad", false, 1.0, 0, dimension(0, 0, 0)),
    (
        "deg",
        false,
        std::f64::consts::PI / 180.0,
        0,
        dimension(0, 0, 0),
    ),
];

/// SI prefixes and their powers of ten. `µ` is both the micro sign and the Greek letter.
const PREFIXES: &[(&str, i32)] = &[
    ("p", -12),
    ("n", -9),
    ("u", -6),
    ("µ", -6),
    ("μ", -6),
    ("m", -3),
    ("c", -2),
    ("d", -1),
    ("da", 1),
    ("h", 2),
    ("k", 3),
    ("M", 6),
    ("G", 9),
    ("T", 12),
];

/// The SI value of `text`, which must have the dimension `wanted`.
///
/// # Errors
/// [`UnitError`]: no number, no unit, an unknown unit, or another dimension.
pub fn parse_quantity(text: &str, wanted: Dimension) -> Result<f64, UnitError> {
    let text = text.trim();
    let (number, exponent, unit) = split_number(text).ok_or(UnitError::NoNumber)?;
    if unit.is_empty() {
        return Err(UnitError::NoUnit);
    }
    let unit = parse_unit(unit)?;
    if unit.dimension != wanted {
        return Err(UnitError::WrongDimension {
            found: unit.dimension,
            wanted,
        });
    }
    let power = exponent.saturating_add(unit.power);
    let decimal = |power: i32| {
        format!("{number}e{power}")
            .parse::<f64>()
            .map_err(|_| UnitError::NoNumber)
    };
    let value = if unit.factor == 1.0 {
        decimal(power)?
    } else {
        decimal(0)? * unit.factor / 10.0_f64.powi(-power)
    };
    if value.is_finite() {
        Ok(value)
    } else {
        Err(UnitError::TooLarge)
    }
}

/// The SI value of one `text`, a unit of length such as `"mm"`.
///
/// # Errors
/// [`UnitError`]: an unknown unit, or one of another dimension.
pub fn length_of_unit(text: &str) -> Result<f64, UnitError> {
    parse_quantity(&format!("1 {text}"), dimension(1, 0, 0))
}

/// Mantissa, decimal exponent, and what follows.
fn split_number(text: &str) -> Option<(&str, i32, &str)> {
    let digits = |from: usize| from + text[from..].bytes().take_while(u8::is_ascii_digit).count();
    let byte = |at: usize| text.as_bytes().get(at).copied();
    let start = usize::from(matches!(byte(0), Some(b'+' | b'-')));
    let mut end = digits(start);
    let mut count = end - start;
    if byte(end) == Some(b'.') {
        let after = digits(end + 1);
        count += after - end - 1;
        end = after;
    }
    if count == 0 {
        return None;
    }
    let mantissa = &text[..end];
    if matches!(byte(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(byte(end + 1), Some(b'+' | b'-')));
        let after = digits(end + 1 + sign);
        if let Ok(exponent) = text[end + 1..after].parse() {
            return Some((mantissa, exponent, text[after..].trim_start()));
        }
    }
    Some((mantissa, 0, text[end..].trim_start()))
}

/// Reads `N*s/m^3`: factors joined by `*`, `.`, `·`, a space (products) or `/` (quotient by the next factor alone).
fn parse_unit(text: &str) -> Result<Unit, UnitError> {
    let mut unit = Unit {
        factor: 1.0,
        power: 0,
        dimension: dimension(0, 0, 0),
    };
    let mut sign = 1;
    let mut rest = text;
    loop {
        let end = rest.find(['*', '/', '.', '·', ' ']).unwrap_or(rest.len());
        let (symbol, exponent) = split_exponent(&rest[..end])?;
        let one = find_symbol(symbol)?;
        let times = sign * exponent;
        unit.factor *= one.factor.powi(times);
        unit.power += times * one.power;
        unit.dimension.add(one.dimension, times);
        rest = rest[end..].trim_start();
        if rest.is_empty() {
            return Ok(unit);
        }
        sign = if rest.starts_with('/') { -1 } else { 1 };
        rest = rest.trim_start_matches(['*', '.', '·', ' ']);
        if sign == -1 {
            rest = rest[1..].trim_start();
        }
    }
}

/// `m^3`, `m³` and `m3` give `("m", 3)`; no exponent gives 1.
fn split_exponent(factor: &str) -> Result<(&str, i32), UnitError> {
    let (symbol, exponent) = match factor.find(['^', '²', '³']) {
        Some(at) => factor.split_at(at),
        None => factor.split_at(
            factor
                .find(|c: char| c.is_ascii_digit() || c == '-')
                .unwrap_or(factor.len()),
        ),
    };
    let bad = || UnitError::BadExponent {
        exponent: exponent.to_owned(),
    };
    let value = match exponent {
        "" => 1,
        "²" => 2,
        "³" => 3,
        _ => exponent
            .trim_start_matches('^')
            .parse::<i32>()
            .map_err(|_| bad())?,
    };
    if value == 0 || value.abs() > 9 {
        Err(bad())
    } else {
        Ok((symbol, value))
    }
}

/// The symbol itself if it is one (so `min` is a minute), else a prefix and a symbol.
fn find_symbol(symbol: &str) -> Result<Unit, UnitError> {
    let exact = SYMBOLS
        .iter()
        .find(|entry| entry.0 == symbol)
        .map(|entry| (entry, 0));
    let prefixed = || {
        PREFIXES.iter().find_map(|&(prefix, power)| {
            let rest = symbol.strip_prefix(prefix)?;
            SYMBOLS
                .iter()
                .find(|entry| entry.1 && entry.0 == rest)
                .map(|entry| (entry, power))
        })
    };
    match exact.or_else(prefixed) {
        Some((&(_, _, factor, power, dimension), prefix)) => Ok(Unit {
            factor,
            power: power + prefix,
            dimension,
        }),
        None => Err(UnitError::UnknownSymbol {
            symbol: symbol.to_owned(),
            nearest: nearest_symbol(symbol),
        }),
    }
}

fn nearest_symbol(symbol: &str) -> Option<String> {
    const USUAL: &[&str] = &[
        "mm", "cm", "km", "kg", "ms", "us", "kN", "MN", "kPa", "MPa", "GPa", "kJ",
    ];
    let names = SYMBOLS
        .iter()
        .map(|entry| entry.0)
        .chain(USUAL.iter().copied());
    crate::nearest(symbol, names).map(str::to_owned)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn si(text: &str, name: &str) -> Result<f64, UnitError> {
        parse_quantity(text, Dimension::named(name).unwrap())
    }

    #[test]
    fn decimal_units_have_the_bits_of_the_si_number() {
        assert_eq!(si("254 mm", "length"), Ok(0.254));
        assert_eq!(si("645 mm^2", "area"), Ok(6.45e-4));
        assert_eq!(si("207 GPa", "stress"), Ok(2.07e11));
        assert_eq!(si("7.844 t/m^3", "density"), Ok(7844.0));
        assert_eq!(si("7.844e-9 t/mm^3", "density"), Ok(7844.0));
        assert_eq!(si("0.25 us", "time"), Ok(2.5e-7));
        assert_eq!(si("0.25 µs", "time"), Ok(2.5e-7));
        assert_eq!(si("0.25μs", "time"), Ok(2.5e-7));
        assert_eq!(si("-9.81 m/s²", "acceleration"), Ok(-9.81));
        assert_eq!(si("5135.9 mm/s", "velocity"), Ok(5.1359));
        assert_eq!(si("1 in", "length"), Ok(0.0254));
        assert_eq!(si("3 ft", "length"), Ok(0.9144));
    }

    #[test]
    fn products_quotients_and_spaces_are_read_from_left_to_right() {
        assert_eq!(si("2 N*s/m^3", "damping per area"), Ok(2.0));
        assert_eq!(si("2 N s / m^3", "damping per area"), Ok(2.0));
        assert_eq!(si("2 N.s/m/m/m", "damping per area"), Ok(2.0));
        assert_eq!(si("2 GPa/mm", "stiffness per area"), Ok(2e12));
        assert_eq!(si("36 km/h", "velocity"), Ok(10.0));
        assert_eq!(si("2 min", "time"), Ok(120.0));
        assert_eq!(si("1.5 daN", "force"), Ok(15.0));
        assert_eq!(si("3 mN s", "impulse"), Ok(3e-3));
        assert_eq!(Dimension::of_unit("N m s"), Ok(dimension(2, 1, -1)));
        assert_eq!(Dimension::of_unit("m/s²"), Ok(dimension(1, 0, -2)));
        assert_eq!(Dimension::of_unit(""), Ok(dimension(0, 0, 0)));
    }

    #[test]
    fn what_is_no_quantity_is_refused_with_its_reason() {
        assert_eq!(si("mm", "length"), Err(UnitError::NoNumber));
        assert_eq!(si("", "length"), Err(UnitError::NoNumber));
        assert_eq!(si("nan m", "length"), Err(UnitError::NoNumber));
        assert_eq!(si("254", "length"), Err(UnitError::NoUnit));
        assert_eq!(si("1e999 m", "length"), Err(UnitError::TooLarge));
        assert!(si("1e9999999999999 m", "length").is_err());
        let wrong = si("254 ms", "length").unwrap_err();
        assert_eq!(wrong.to_string(), "a time instead of a length");
        assert_eq!(wrong.meant(), None);
        let in_grams = si("0.3 g", "acceleration").unwrap_err();
        assert_eq!(in_grams.meant().as_deref(), Some("gn"));
        assert_eq!(
            si("3 Mpa", "stress"),
            Err(UnitError::UnknownSymbol {
                symbol: "Mpa".into(),
                nearest: Some("MPa".into())
            })
        );
        assert!(matches!(
            si("3 m^x", "length"),
            Err(UnitError::BadExponent { .. })
        ));
        assert!(matches!(
            si("3 m^0", "length"),
            Err(UnitError::BadExponent { .. })
        ));
        for text in [
            "1 /m", "1 m/", "1 m//s", "1 (m)", "2,5 mm", "1 m*", "1 ^2", "1 ²", "é", "1 é",
        ] {
            assert!(si(text, "length").is_err(), "{text}");
        }
    }
}
