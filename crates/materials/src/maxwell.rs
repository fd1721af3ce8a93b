//! Linear viscoelasticity at finite strain.

use carom_algebra::number::Number;
use carom_algebra::tensor::Mat3;
use carom_quantities::Duration;
use schemars::JsonSchema;
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::lagrange::{Derivative, Moduli};
use crate::material::positive;
use crate::range::{OutOfRange, require};
use crate::tensor::{
    Tensor, determinant, double, green_lagrange, pack, plus, plus_unit, product, rows, scaled,
    trace, unpack,
};
use crate::{
    Answer, Conserving, Elastic, Failure, Material, Parameters, Plane, Pointwise, Response, Want,
};

/// Most branches of a [`Maxwell`] material.
pub const MAX_BRANCHES: usize = 4;

/// A spring and a dashpot in series.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(description = "A spring and a dashpot in series.", extend("additionalProperties" = false))]
pub struct Branch {
    /// Fraction of the instantaneous shear modulus that relaxes in this branch.
    #[schemars(
        description = "Fraction of the shear modulus that relaxes in this branch.",
        extend("exclusiveMinimum" = 0.0, "exclusiveMaximum" = 1.0)
    )]
    pub ratio: f64,
    /// Relaxation time, s.
    #[serde(deserialize_with = "Duration::si")]
    #[schemars(with = "Duration", description = "Relaxation time.")]
    pub time: f64,
}

/// Generalised Maxwell material, linear in the Green-Lagrange strain E: a spring beside branches of spring and dashpot, in the
/// deviator e = dev E. The volume stays elastic.
///
/// With x_i the strain of the spring of branch i, dx_i/dt = de/dt - x_i/τ_i,
///
/// ψ = κ/2 (tr E)² + μ (1 - Σ g_i) e:e + μ Σ g_i x_i:x_i,   S = ∂ψ/∂E,   dissipated power Σ 2μ g_i x_i:x_i/τ_i,
///
/// κ and μ the instantaneous moduli: shear relaxes as μ (1 - Σ g_i (1 - exp(-t/τ_i))). A step solves this exactly for a strain
/// that grows evenly over it, and its dissipation is the exact integral. At once, and at last, this is St Venant-Kirchhoff
/// elasticity, with its limit to moderate strains. The history is e and all x_i (11, 22, 33, 12, 23, 13).
/// Simo and Hughes (1998), Computational Inelasticity, chapter 10.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(description = "Linear viscoelasticity.", extend("additionalProperties" = false))]
pub struct Maxwell {
    /// Instantaneous law at small strain, with the density.
    #[serde(flatten)]
    pub initial: Elastic,
    /// Branches; the sum of their ratios is less than 1.
    #[serde(serialize_with = "listed", deserialize_with = "list")]
    #[schemars(with = "Vec<Branch>", extend("minItems" = 1, "maxItems" = MAX_BRANCHES))]
    pub branches: [Option<Branch>; MAX_BRANCHES],
}

impl Parameters for Maxwell {
    fn finite(&self) -> Option<&dyn Material> {
        Some(self)
    }

    fn undeformed(&self) -> Elastic {
        self.initial
    }

    fn check(&self) -> Result<(), OutOfRange> {
        self.initial.check()?;
        for branch in self.branches.iter().flatten() {
            require("ratio", branch.ratio, branch.ratio > 0.0, "positive")?;
            require("time", branch.time, branch.time > 0.0, "positive")?;
        }
        let sum = 1.0 - self.lasting();
        require("sum of the ratios", sum, sum < 1.0, "less than 1")
    }

    fn dissipates(&self) -> bool {
        true
    }
}

/// Writes the branches as a list.
fn listed<S: Serializer>(
    branches: &[Option<Branch>; MAX_BRANCHES],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(branches.iter().flatten())
}

/// Reads a list of branches.
fn list<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<[Option<Branch>; MAX_BRANCHES], D::Error> {
    let given = Vec::<Branch>::deserialize(deserializer)?;
    if given.len() > MAX_BRANCHES {
        return Err(D::Error::custom(format!(
            "more than {MAX_BRANCHES} branches"
        )));
    }
    Ok(std::array::from_fn(|branch| given.get(branch).copied()))
}

/// A branch over a step of h = dt/τ: x_1 = decay x_0 + gain (e_1 - e_0), and the integral of x:x over the time in units of τ,
/// `squares` times (x_0:x_0, x_0:(e_1 - e_0), (e_1 - e_0):(e_1 - e_0)).
struct Relaxation {
    decay: f64,
    gain: f64,
    squares: [f64; 3],
}

impl Relaxation {
    /// With u = 1 - exp(-h): gain u/h, squares u - u²/2, u²/h, (h - u - u²/2)/h². Times from 0 to infinity.
    fn new(h: f64) -> Relaxation {
        if h == 0.0 {
            return Relaxation {
                decay: 1.0,
                gain: 1.0,
                squares: [0.0; 3],
            };
        }
        let u = -(-h).exp_m1();
        let gain = u / h;
        let last = if u < 0.1 {
            // h = u + u²/2 + u³/3 + ...; 0.1¹⁵ is below the last digit of the first term
            let series = (3..18)
                .rev()
                .fold(0.0, |sum, k| sum * u + 1.0 / f64::from(k));
            series * u * gain * gain
        } else {
            (1.0 - gain * (1.0 + 0.5 * u)) / h
        };
        Relaxation {
            decay: (-h).exp(),
            gain,
            squares: [u - 0.5 * u * u, u * gain, last],
        }
    }
}

impl Maxwell {
    /// 1 - Σ g_i.
    fn lasting(&self) -> f64 {
        let ratios = self.branches.iter().flatten().map(|branch| branch.ratio);
        1.0 - ratios.sum::<f64>()
    }

    fn bulk_modulus(&self) -> f64 {
        self.initial.lame_1(Plane::Full) + 2.0 / 3.0 * self.initial.shear_modulus()
    }

    /// Second Piola-Kirchhoff stress at the strain `e`, and energies.
    #[inline(always)]
    fn relaxed<T: Number>(
        &self,
        strain: &Tensor<T>,
        dt: f64,
        old: &[T],
        new: &mut [T],
    ) -> (Tensor<T>, [T; 2]) {
        let sum = trace(strain);
        let e = plus_unit(strain, sum.scale(-1.0 / 3.0));
        let change = plus(&e, sum.like(-1.0), &unpack(old));
        pack(&e, new);
        let (mu, bulk) = (self.initial.shear_modulus(), self.bulk_modulus());
        // shear stress and energy over 2μ
        let mut shear = scaled(&e, sum.like(self.lasting()));
        let mut energy = double(&e, &e).scale(0.5 * self.lasting());
        let mut dissipated = sum.like(0.0);
        for (place, branch) in self.branches.iter().flatten().enumerate() {
            let kept = 6 + 6 * place..12 + 6 * place;
            let step = Relaxation::new(dt / branch.time);
            let x_0 = unpack(&old[kept.clone()]);
            let x_1 = plus(
                &scaled(&x_0, sum.like(step.decay)),
                sum.like(step.gain),
                &change,
            );
            pack(&x_1, &mut new[kept]);
            shear = plus(&shear, sum.like(branch.ratio), &x_1);
            energy += double(&x_1, &x_1).scale(0.5 * branch.ratio);
            let integral = double(&x_0, &x_0).scale(step.squares[0])
                + double(&x_0, &change).scale(step.squares[1])
                + double(&change, &change).scale(step.squares[2]);
            // round-off can leave less than zero of an integral of squares
            dissipated += integral.most(sum.like(0.0)).scale(branch.ratio);
        }
        let s = plus_unit(&scaled(&shear, sum.like(2.0 * mu)), sum.scale(bulk));
        let stored = (sum * sum).scale(0.5 * bulk) + energy.scale(2.0 * mu);
        (s, [stored, dissipated.scale(2.0 * mu)])
    }

    /// ∂S/∂E at the end of a step.
    fn moduli(&self, dt: f64) -> Moduli<f64> {
        let gains = self.branches.iter().flatten();
        let gains = gains.map(|branch| branch.ratio * Relaxation::new(dt / branch.time).gain);
        let modulus = self.lasting() + gains.sum::<f64>();
        let mu = self.initial.shear_modulus();
        Moduli {
            trace: self.bulk_modulus() - 2.0 / 3.0 * mu * modulus,
            identity: 2.0 * mu * modulus,
            product: 0.0,
            cross: 0.0,
            b: [[0.0; 3]; 3],
        }
    }
}

impl Pointwise for Maxwell {
    #[inline(always)]
    fn answer<T: Number>(&self, h: &Tensor<T>, dt: f64, old: &[T], new: &mut [T]) -> Answer<T> {
        let f = plus_unit(h, h[0][0].like(1.0));
        let (s, [stored, dissipated]) = self.relaxed(&green_lagrange(h), dt, old, new);
        Answer {
            stress: product(&f, &s),
            stored,
            hardening: stored.like(0.0),
            dissipated,
            positive: determinant(&f),
        }
    }
}

impl Material for Maxwell {
    fn history_len(&self) -> usize {
        6 + 6 * self.branches.iter().flatten().count()
    }

    fn start(&self, history: &mut [f64]) {
        history.fill(0.0);
    }

    fn update(
        &self,
        f: &Mat3,
        dt: f64,
        (old, new): (&[f64], &mut [f64]),
        want: Want,
    ) -> Result<Response, Failure> {
        positive(f.determinant())?;
        let h = rows(&(f - Mat3::identity()));
        let answer = self.answer(&h, dt, old, new);
        let tangent = want.has_tangent().then(|| {
            let (s, _) = self.relaxed(&green_lagrange(&h), dt, old, new);
            let f = rows(f);
            let derivative = Derivative {
                sides: [f, f],
                moduli: self.moduli(dt),
                stress: s,
                bent: None,
                positive: answer.positive,
            };
            derivative.tangent()
        });
        Ok(Response::of(&answer, tangent))
    }

    fn between(&self, _f_0: &Mat3, _f_1: &Mat3, _want: Want) -> Option<Result<Response, Failure>> {
        None
    }

    fn between_strains(
        &self,
        _e_1: &Mat3,
        _d: &Mat3,
        _want: Want,
    ) -> Option<Result<Conserving, Failure>> {
        None
    }

    fn initial(&self) -> Elastic {
        self.initial
    }
}
