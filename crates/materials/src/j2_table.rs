//! Metal plasticity with hardening by a table.

use carom_algebra::number::Number;
use carom_quantities::Modulus;
use schemars::JsonSchema;
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::flow::{PLASTIC, flows};
use crate::hardening::Hardening;
use crate::range::{OutOfRange, require};
use crate::{Elastic, Material, Parameters, PlaneStress, Uniaxial};

/// Most points of a [`J2Table`].
pub const MAX_HARDENING_POINTS: usize = 16;

/// A point of the yield stress over the plastic strain.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(description = "Yield stress at a plastic strain.", extend("additionalProperties" = false))]
pub struct HardeningPoint {
    /// Equivalent plastic strain, without unit.
    #[schemars(description = "Equivalent plastic strain.")]
    pub strain: f64,
    /// Yield stress there, Pa.
    #[serde(deserialize_with = "Modulus::si")]
    #[schemars(with = "Modulus", description = "Yield stress there.")]
    pub stress: f64,
}

/// J2 (von Mises) plasticity with isotropic hardening by a table, in logarithmic strain: σ_y(ε_p) is linear between its points, of
/// which the first is at ε_p = 0, and constant beyond the last.
///
/// The return goes through the pieces in closed form: in each, the imbalance q - 3μ Δε_p - σ_y falls with the slope 3μ + H.
/// Stored in hardening: ∫ (σ_y(ε) - σ_y(0)) dε; dissipated in a step: σ_y(0) Δε_p. Elastic law, flow and history: those of all
/// metals here, theory/materials.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(description = "Von Mises plasticity with a hardening table.", extend("additionalProperties" = false))]
pub struct J2Table {
    /// The law at small elastic strain, with the density.
    #[serde(flatten)]
    pub initial: Elastic,
    /// Points with increasing strains, the first at 0, and stresses that do not fall.
    #[serde(serialize_with = "listed", deserialize_with = "list")]
    #[schemars(with = "Vec<HardeningPoint>", extend("minItems" = 1, "maxItems" = MAX_HARDENING_POINTS))]
    pub hardening: [Option<HardeningPoint>; MAX_HARDENING_POINTS],
}

/// Writes the points as a list.
fn listed<S: Serializer>(
    points: &[Option<HardeningPoint>; MAX_HARDENING_POINTS],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(points.iter().flatten())
}

/// Reads a list of points.
fn list<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<[Option<HardeningPoint>; MAX_HARDENING_POINTS], D::Error> {
    let given = Vec::<HardeningPoint>::deserialize(deserializer)?;
    if !(1..=MAX_HARDENING_POINTS).contains(&given.len()) {
        let found = given.len();
        return Err(D::Error::custom(format!(
            "a hardening table of {found} points: it has 1 to {MAX_HARDENING_POINTS}"
        )));
    }
    Ok(std::array::from_fn(|point| given.get(point).copied()))
}

/// A piece of the table.
struct Piece {
    /// Strain and stress at its beginning.
    strain: f64,
    stress: f64,
    /// Strain at its end, and slope in Pa.
    end: f64,
    slope: f64,
}

impl J2Table {
    /// A table of these points; `None` without any, or of more than [`MAX_HARDENING_POINTS`].
    pub fn new(initial: Elastic, points: &[HardeningPoint]) -> Option<J2Table> {
        let inside = (1..=MAX_HARDENING_POINTS).contains(&points.len());
        inside.then(|| J2Table {
            initial,
            hardening: std::array::from_fn(|point| points.get(point).copied()),
        })
    }

    /// Yield stress of the virgin material, Pa.
    fn first(&self) -> f64 {
        self.hardening[0].map_or(0.0, |point| point.stress)
    }

    #[inline(always)]
    fn pieces(&self) -> impl Iterator<Item = Piece> + '_ {
        let points = self.hardening.iter().flatten();
        points.clone().enumerate().map(|(k, point)| {
            let next = self.hardening.get(k + 1).copied().flatten();
            let (end, slope) = next.map_or((f64::INFINITY, 0.0), |next| {
                let slope = (next.stress - point.stress) / (next.strain - point.strain);
                (next.strain, slope)
            });
            Piece {
                strain: point.strain,
                stress: point.stress,
                end,
                slope,
            }
        })
    }
}

impl Parameters for J2Table {
    fn finite(&self) -> Option<&dyn Material> {
        Some(self)
    }

    fn undeformed(&self) -> Elastic {
        self.initial
    }

    fn check(&self) -> Result<(), OutOfRange> {
        self.initial.check()?;
        let mut before: Option<HardeningPoint> = None;
        for point in self.hardening.iter().flatten() {
            let (strain, stress) = (point.strain, point.stress);
            match before {
                None => {
                    require("strain", strain, strain == 0.0, "0 at the first point")?;
                    require("stress", stress, stress > 0.0, "positive")?;
                }
                Some(last) => {
                    let rises = strain > last.strain;
                    require("strain", strain, rises, "above that of the point before")?;
                    let holds = stress >= last.stress;
                    require(
                        "stress",
                        stress,
                        holds,
                        "not below that of the point before",
                    )?;
                }
            }
            before = Some(*point);
        }
        require("hardening", 0.0, before.is_some(), "one point or more")
    }

    fn dissipates(&self) -> bool {
        true
    }

    fn uniaxial(&self) -> Option<Box<dyn Uniaxial>> {
        Some(Box::new(*self))
    }

    fn plane_stress(&self) -> Option<Box<dyn PlaneStress>> {
        Some(Box::new(*self))
    }

    fn plastic_strain(&self, history: &[f64]) -> Option<f64> {
        Some(history[PLASTIC])
    }
}

impl Hardening for J2Table {
    fn elastic(&self) -> &Elastic {
        &self.initial
    }

    #[inline(always)]
    fn slip<T: Number>(&self, q: T, stiffness: f64, old: &[T], _dt: f64) -> [T; 2] {
        let (zero, plastic) = (q.like(0.0), old[0]);
        let mut over = q - q.like(self.first());
        for piece in self.pieces() {
            let gained = plastic - q.like(piece.strain);
            let gained = gained.most(zero).least(q.like(piece.end - piece.strain));
            over -= gained.scale(piece.slope);
        }
        let mut over = over.most(zero);
        let (mut slip, mut slope) = (zero, zero);
        for piece in self.pieces() {
            let room = (q.like(piece.end) - plastic.most(q.like(piece.strain))).most(zero);
            let whole = over.scale(1.0 / (stiffness + piece.slope));
            let inside = whole.least(room);
            // what is left after a piece is nothing where it ends inside, to the last digit
            slope = zero.if_below(over, zero.if_below(room, q.like(piece.slope), slope), slope);
            let rest = over - inside.scale(stiffness + piece.slope);
            over = inside.if_below(whole, rest, zero);
            slip += inside;
        }
        [slip, slope]
    }

    #[inline(always)]
    fn spent<T: Number>(&self, slip: T, _q: T, (_, new): (&[T], &mut [T])) -> [T; 2] {
        let (zero, plastic) = (slip.like(0.0), new[0]);
        let mut stored = zero;
        for piece in self.pieces() {
            let gained = plastic - slip.like(piece.strain);
            let gained = gained.most(zero).least(slip.like(piece.end - piece.strain));
            let mean = gained.scale_add(0.5 * piece.slope, slip.like(piece.stress - self.first()));
            stored += mean * gained;
        }
        [stored, slip.scale(self.first())]
    }
}

flows!(J2Table);
