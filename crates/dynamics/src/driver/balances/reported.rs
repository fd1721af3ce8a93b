//! Forces of the supports by their names, as the step has them in the balance of momentum.

use carom_algebra::rotation::Rotation;
use carom_algebra::tensor::Vec3;
use carom_algebra::unknowns::Kind;

use crate::resultant::Resultant;
use crate::system::{ReportedSupport, System};

/// Writes the forces of the named supports. `force`: on an unknown that is held, N or N m. `at`: frames, and the displacement from which
/// moments have their arms, nothing for those of the reference configuration.
pub(crate) fn write(
    out: &mut Vec<Resultant>,
    system: &System,
    at: (&[Rotation], Option<&[f64]>),
    force: impl Fn(usize) -> f64,
) {
    out.clear();
    let supports = system.supports.iter();
    out.extend(supports.map(|support| resultant(system, support, at, &force)));
}

/// Force of a support on the bodies, and its moment about the centre of the support. In axisymmetry only the axial force is one.
fn resultant(
    system: &System,
    support: &ReportedSupport,
    (frames, displacement): (&[Rotation], Option<&[f64]>),
    force: &impl Fn(usize) -> f64,
) -> Resultant {
    let mut sum = Resultant::default();
    let unknowns = &system.unknowns;
    for held in &support.held {
        let unknown = held.unknown as usize;
        let (node, force) = (unknowns.node(unknown), force(unknown));
        match unknowns.kind(unknown) {
            Kind::Translation(axis) => {
                let mut x = system.x[node as usize];
                if let Some(u) = displacement.filter(|_| !held.undeformed) {
                    let own = unknowns.translations_of(node);
                    for (x, unknown) in x.iter_mut().zip(own) {
                        *x += u[unknown];
                    }
                }
                let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
                let arm = [0, 1, 2].map(|i| x[i] - support.centre[i]);
                sum.linear[axis] += force;
                // arm × force
                sum.angular[j] += arm[k] * force;
                sum.angular[k] -= arm[j] * force;
            }
            Kind::Rotation(axis) => match (unknowns.frame(node), displacement) {
                (None, _) => sum.angular[axis] += force,
                (Some(frame), u) => {
                    let spin = u.map_or([0.0; 3], |u| unknowns.spin(node, u));
                    let turned = frames[frame].then(&Rotation::cayley(&spin.into()));
                    let mut moment = Vec3::zeros();
                    moment[axis] = force;
                    let moment = turned.matrix() * moment;
                    (0..3).for_each(|i| sum.angular[i] += moment[i]);
                }
            },
            Kind::Amplitude(_) => {}
        }
    }
    if system.axisymmetric {
        sum.linear[0] = 0.0;
        sum.angular = [0.0; 3];
    }
    sum
}
