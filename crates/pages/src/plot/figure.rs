//! What a figure shows.

use crate::Error;

/// A figure: panels in rows from left to right.
#[derive(Clone, Debug)]
pub struct Figure<'a> {
    /// Title over all panels.
    pub title: String,
    /// What the abscissa of every panel is; all show the same range.
    pub abscissa: Axis,
    /// The panels.
    pub panels: Vec<Panel<'a>>,
    /// Panels in a row.
    pub columns: usize,
}

/// One pair of axes with its curves.
#[derive(Clone, Debug)]
pub struct Panel<'a> {
    /// Title over the panel.
    pub title: String,
    /// What the ordinate is.
    pub ordinate: Axis,
    /// The curves; exact ones are drawn under computed ones.
    pub curves: Vec<Curve<'a>>,
    /// Whether rare spikes may be clipped, so that the rest can be seen: see [`Figure::svg`].
    pub clip: bool,
}

/// A quantity with its unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Axis {
    /// Name of the quantity: `displacement`.
    pub quantity: &'static str,
    /// SI unit without prefix: `m`, `m/s²`; empty for a pure number. The data are in this unit; the axis chooses the
    /// prefix.
    pub unit: &'static str,
}

/// One curve.
#[derive(Clone, Copy, Debug)]
pub struct Curve<'a> {
    /// Name in the legend; curves of one name share one entry.
    pub name: &'a str,
    /// Abscissae, never decreasing. Twice the same: a jump.
    pub x: &'a [f64],
    /// Ordinates, as many.
    pub y: &'a [f64],
    /// How it is drawn.
    pub role: Role,
}

/// What a curve is, which decides how it is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// A result: a thin line in a colour of its own.
    Computed,
    /// What it should be: a broad pale line under all others.
    Exact,
}

impl Panel<'_> {
    pub(super) fn check(&self) -> Result<(), Error> {
        self.curves.iter().try_for_each(Curve::check)
    }

    pub(super) fn has_data(&self) -> bool {
        self.curves.iter().any(|curve| !curve.x.is_empty())
    }
}

impl Curve<'_> {
    fn check(&self) -> Result<(), Error> {
        let curve = || self.name.to_owned();
        if self.x.len() != self.y.len() {
            return Err(Error::CurveLength {
                curve: curve(),
                x: self.x.len(),
                y: self.y.len(),
            });
        }
        for (axis, values) in [("abscissa", self.x), ("ordinate", self.y)] {
            if let Some(index) = values.iter().position(|value| !value.is_finite()) {
                return Err(Error::NotFinite {
                    curve: curve(),
                    axis,
                    index,
                    value: values[index],
                });
            }
        }
        match self.x.windows(2).position(|pair| pair[1] < pair[0]) {
            Some(before) => Err(Error::Backwards {
                curve: curve(),
                index: before + 1,
                value: self.x[before + 1],
            }),
            None => Ok(()),
        }
    }
}
