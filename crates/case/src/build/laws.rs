//! Contact laws, with their defaults from the material of the two sides.

use carom_bodies::height;
use carom_contact::Law;
use carom_contact::law::{
    Adhesion, Capture, Compliance, Crush, Curve, CurveError, Damped, Displacement, Penalty,
    Reading, Restitution, Stop, Velocity,
};
use carom_dynamics::{ModelBody, ModelTarget};
use carom_mesh::{Mesh, Surface};

use super::Builder;
use crate::error::Problem;
use crate::schema::{self, ComplianceLaw, DampedLaw, Scheme, StopLaw};

/// Part of the energy of an impact from which on the loss in a compliance is worth a warning.
const LOSS: f64 = 0.01;

impl Builder<'_> {
    /// The law of the contact `name`; `sides`: one for each deformable surface, the softer one first; `scheme`: that of
    /// its zone.
    pub(super) fn law(
        &mut self,
        name: &str,
        law: &schema::Law,
        (sides, scheme): (&[Side], &Scheme),
    ) -> Option<Law> {
        let capture = |given| capture(given).unwrap_or_else(|| default_capture(scheme));
        Some(match law {
            schema::Law::Displacement(law) => Law::Displacement(Displacement {
                projection: law.projection,
            }),
            schema::Law::Velocity(velocity) => Law::Velocity(Velocity {
                capture: capture(velocity.capture),
                reading: match velocity.sign {
                    schema::Sign::Closed => Reading::Closed,
                    schema::Sign::AsPrinted => Reading::AsPrinted,
                },
            }),
            schema::Law::Compliance(compliance) => {
                let law = Compliance {
                    damping: compliance_damping(compliance, sides),
                    capture: capture(compliance.capture),
                };
                self.warn_of_loss(name, law.damping, sides);
                Law::Compliance(law)
            }
            schema::Law::Restitution(restitution) => Law::Restitution(Restitution {
                coefficient: restitution.coefficient,
                capture: capture(restitution.capture),
            }),
            schema::Law::Damped(damped) => {
                let law = damped_law(damped, sides);
                let rate = 2.0 * spring_rate(law.stiffness, &sides[0]);
                self.springs.push((name.to_string(), rate));
                Law::Damped(law)
            }
            schema::Law::Penalty(penalty) => Law::Penalty(Penalty(Damped {
                stiffness: penalty.stiffness.0,
                damping: penalty.damping.map_or(0.0, |damping| damping.0),
                adhesion: adhesion(penalty.adhesion),
            })),
            schema::Law::Stop(stop) => Law::Stop(self.stop(name, stop)?),
        })
    }

    fn stop(&mut self, name: &str, law: &StopLaw) -> Option<Stop> {
        let points: Vec<[f64; 2]> = law
            .curve
            .iter()
            .map(|point| [point.penetration.0, point.force.0])
            .collect();
        let crush = match law.crush {
            schema::Crush::Recovered => Crush::Recovered,
            schema::Crush::Permanent => Crush::Permanent,
        };
        let problem = match Curve::new(&points) {
            Ok(curve) => match curve.first_steeper() {
                Some(point) if crush == Crush::Permanent => too_steep(name, &points, point),
                _ => {
                    return Some(Stop {
                        clearance: law.clearance.map_or(0.0, |clearance| clearance.0),
                        curve,
                        crush,
                        damping: law.damping.map_or(0.0, |damping| damping.0),
                        adhesion: adhesion(law.adhesion),
                    });
                }
            },
            Err(error) => no_curve(name, &error),
        };
        self.problems.push(problem);
        None
    }

    /// Warns where a compliance absorbs more than a part [`LOSS`] of an impact: 2 φ (1 - φ) between equal bars and twice
    /// that on an obstacle, φ = C / (C + Z).
    fn warn_of_loss(&mut self, name: &str, damping: f64, sides: &[Side]) {
        let impedance = 1.0 / sides.iter().map(|side| 1.0 / side.impedance).sum::<f64>();
        let phi = damping / (damping + impedance);
        let loss = phi * (1.0 - phi) * if sides.len() == 1 { 4.0 } else { 2.0 };
        if loss > LOSS {
            let enough = if sides.len() == 1 { 400.0 } else { 200.0 } * impedance;
            self.warnings.push(format!(
                "contact `{name}`: the compliance absorbs {:.2} % of the energy of an impact between bars; {enough:.3e} Pa s/m absorbs 1 %",
                100.0 * loss
            ));
        }
    }
}

fn no_curve(name: &str, error: &CurveError) -> Problem {
    let path = format!("contact.{name}.law.stop.curve");
    match error {
        CurveError::Count { points } => Problem::new(path, error.to_string()).found(points),
        CurveError::NotIncreasing {
            point,
            found,
            before,
        } => Problem::new(
            format!("{path}[{}]", point - 1),
            "the points of the curve must increase in penetration and in force",
        )
        .found(format!("{} m, {} N", found[0], found[1]))
        .accepted([format!("more than {} m and {} N", before[0], before[1])]),
    }
}

/// A piece that would give back more than it took; `point`: its end, from 1.
fn too_steep(name: &str, points: &[[f64; 2]], point: usize) -> Problem {
    let (end, start) = (points[point - 1], points[point - 2]);
    let stiffness = (end[1] - start[1]) / (end[0] - start[0]);
    Problem::new(
        format!("contact.{name}.law.stop.curve[{}]", point - 1),
        "with crush = \"permanent\" no piece of the curve may be steeper than the first, along which the stop is unloaded",
    )
    .found(format!("{stiffness:.4e} N/m up to this point"))
    .accepted([format!("at most {:.4e} N/m", points[0][1] / points[0][0])])
}

fn capture(given: Option<schema::Capture>) -> Option<Capture> {
    given.map(|capture| match capture {
        schema::Capture::Now => Capture::Now,
        schema::Capture::Half => Capture::Half,
        schema::Capture::Full => Capture::Full,
        schema::Capture::Free => Capture::Free,
        schema::Capture::GapTarget => Capture::GapTarget,
    })
}

fn adhesion(given: schema::Adhesion) -> Adhesion {
    match given {
        schema::Adhesion::Clip => Adhesion::Clip,
        schema::Adhesion::AsPrinted => Adhesion::AsPrinted,
    }
}

/// Half for theta = 1/2, now otherwise: what each scheme needs to close without a false start.
fn default_capture(scheme: &Scheme) -> Capture {
    match scheme {
        Scheme::Theta(theta) if theta.theta == 0.5 => Capture::Half,
        Scheme::Theta(_)
        | Scheme::Newmark(_)
        | Scheme::CentralDifference(_)
        | Scheme::GeneralisedAlpha(_)
        | Scheme::Hht(_)
        | Scheme::TchamwaWielgosz(_)
        | Scheme::PaoliSchatzman(_)
        | Scheme::LaursenChawla(_)
        | Scheme::LaursenLove(_)
        | Scheme::NonsmoothAlpha(_)
        | Scheme::Krenk(_)
        | Scheme::Kane(_)
        | Scheme::ContactStabilised(_)
        | Scheme::EnergyMomentum(_) => Capture::Now,
    }
}

/// The deformable sides of a contact, the softer one first.
pub(super) fn sides(
    mesh: &Mesh,
    bodies: &[ModelBody],
    secondary: &Surface,
    primary: &ModelTarget,
) -> Vec<Side> {
    let mut sides = vec![side(mesh, bodies, secondary)];
    if let ModelTarget::Surface(primary) = primary {
        sides.push(side(mesh, bodies, primary));
    }
    let softness = |side: &Side| side.size / side.young;
    sides.sort_by(|a, b| softness(b).total_cmp(&softness(a)));
    sides
}

/// One side of a contact: Young's modulus (Pa), impedance per area rho c (Pa s/m), wave speed (m/s), element size normal to it
/// (m).
pub(super) struct Side {
    pub(super) young: f64,
    pub(super) impedance: f64,
    wave_speed: f64,
    pub(super) size: f64,
}

/// The side with the thickest cells and the material of the first.
fn side(mesh: &Mesh, bodies: &[ModelBody], surface: &Surface) -> Side {
    let mut side = Side {
        young: 0.0,
        impedance: 0.0,
        wave_speed: 0.0,
        size: 0.0,
    };
    for face in &surface.faces {
        side.size = side
            .size
            .max(height(mesh, face.parent, face.kind, face.corners()));
    }
    let owner = surface.faces.first().and_then(|face| {
        bodies
            .iter()
            .find(|body| body.spec.cells.binary_search(&face.parent).is_ok())
    });
    if let Some(body) = owner {
        let material = body.spec.material.initial();
        side.young = material.young;
        side.wave_speed = material.wave_speed(body.spec.kinematics.plane());
        side.impedance = material.density * side.wave_speed;
    }
    side
}

/// k_p = E/h_e and C_n = c_f sqrt(k_p h_e / E) rho c of the softer side, unless the case gives them.
fn damped_law(law: &DampedLaw, sides: &[Side]) -> Damped {
    let soft = &sides[0];
    let stiffness = law.stiffness.map_or(soft.young / soft.size, |k| k.0);
    let factor = law.damping_factor.unwrap_or(0.5);
    let from_factor = factor * (stiffness * soft.size / soft.young).sqrt() * soft.impedance;
    Damped {
        stiffness,
        damping: law.damping.map_or(from_factor, |damping| damping.0),
        adhesion: adhesion(law.adhesion),
    }
}

/// sqrt(k h/E) c/h in 1/s, for k in Pa/m: the frequency of a spring on half an element, over sqrt 2.
fn spring_rate(stiffness: f64, side: &Side) -> f64 {
    (stiffness * side.size / side.young).sqrt() * side.wave_speed / side.size
}

/// C, given or as a multiple of rho c of the softer side.
fn compliance_damping(law: &ComplianceLaw, sides: &[Side]) -> f64 {
    let from_factor = law.damping_factor.unwrap_or(0.0) * sides[0].impedance;
    law.damping.map_or(from_factor, |damping| damping.0)
}
