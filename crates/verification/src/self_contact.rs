//! A hairpin whose prongs are flung at each other: a surface that faces itself.
//!
//! Problem: a strip 0.1 m thick is bent into two straight prongs of 1 m, 40 mm apart; neo-Hooke, E = 1 MPa, ν = 0.3,
//! ρ = 1000 kg/m³; plane strain, or 0.1 m wide in space. Nothing holds it. All of its skin, inside and outside, is one surface that
//! faces itself, so each prong is secondary and primary at once and has its own far side behind it.
//!
//! Closed facts: prongs flung with unequal velocities keep linear and angular momentum and, with the energy-momentum scheme,
//! energy. Flung with equal ones they are mirror images of each other, and half of the hairpin between its plane of symmetry and a
//! frictionless wall in that plane moves as the whole does, a second formulation. There the two points of each pair meet each other's faces with the same
//! condition written twice: their compliance is singular, and only the sum of their forces is known.
//!
//! Tolerances: momenta 1e-10 and energy 1e-8, as stated for this scheme elsewhere. Half and whole are compared until 20 steps after the
//! prongs meet; later they rattle, and the smallest difference decides which step meets a closed point. The displacement law ends its
//! steps with gaps of zero, feet then are mirror images, and the two agree to the iterations: 1e-8. Under the velocity law points
//! penetrate by g = v dt; the foot on a face inclined by α ≈ 0.03 is the mirror image but for g sin α, and the gap is 2 |y| cos α: of
//! motion and force a part of α², 1e-3. The mean gaps of the mortar method belong to the part of a face that has another
//! opposite, which two inclined faces have less of than a face has of a wall: of that order too, and a few times more, 3e-3. Penetration: the bound of the law's viability with the speed of the fling.
//! Sizes: quick 16 x 2 elements in each half and 10 x 1 x 1 in space, dt = 4 ms; full 24 x 2 and 16 x 1 x 2, dt = 2 ms.

use carom_contact::{Basis, Integration, Law};
use carom_dynamics::scheme::EnergyMomentum;
use carom_dynamics::{Driver, Scheme};
use carom_exact::closed_forms::penetration_bound_now;

use crate::Error;
use crate::build::{DISPLACEMENT, NOW, newmark};
use crate::check::{Check, Row, Size};
use crate::hairpin::{HALF_GAP, Hairpin};
use crate::kept::Kept;

const MORTAR: Integration = Integration::Mortar {
    basis: Basis::Standard,
};
const CONSERVING: Scheme = Scheme::EnergyMomentum(EnergyMomentum {});
/// Velocity of the ends, m/s.
const SPEED: f64 = 0.2;
/// Steps compared after the prongs meet.
const TOGETHER: usize = 20;

/// Part of the force on the upper half along its axis of approach, N.
fn force(newton: &Driver) -> f64 {
    let system = newton.system();
    let up = system.dim - 1;
    let upper = |node: &usize| system.x[*node][up] > 0.0;
    let nodes = (0..system.x.len()).filter(upper);
    nodes
        .map(|node| newton.state().motion.contact_force[system.unknowns.first(node as u32) + up])
        .sum()
}

/// The unknowns of the whole that are those of the half, in their order.
fn image(half: &Driver, whole: &Driver) -> Vec<usize> {
    let (unknowns, all) = (&whole.system().unknowns, &whole.system().x);
    let same = |a: &[f64; 3], b: &[f64; 3]| (0..3).all(|i| (a[i] - b[i]).abs() < 1e-9);
    let nodes = half.system().x.iter();
    let nodes = nodes.filter_map(|x| all.iter().position(|y| same(x, y)));
    nodes.flat_map(|node| unknowns.of(node as u32)).collect()
}

/// Largest differences of motion, over half the distance, and of force, over the largest force.
fn mirrored(pin: Hairpin) -> Result<[f64; 2], Error> {
    let (mut whole, mut half) = (pin.newton()?, Hairpin { half: true, ..pin }.newton()?);
    let image = image(&half, &whole);
    let (mut motion, mut apart, mut largest) = (0.0_f64, 0.0_f64, 0.0_f64);
    let mut left = None;
    while left != Some(0) {
        whole.step()?;
        half.step()?;
        let [u, v] = [&half, &whole].map(|run| &run.state().motion.u);
        let pairs = u.iter().zip(&image);
        motion = pairs.fold(motion, |most, (u, &k)| most.max((u - v[k]).abs()));
        let [one, other] = [&half, &whole].map(force);
        apart = apart.max((one - other).abs());
        largest = largest.max(one.abs());
        left = match left {
            None if largest > 0.0 => Some(TOGETHER),
            left => left.map(|left| left - 1),
        };
    }
    Ok([motion / HALF_GAP, apart / largest])
}

/// What unequal prongs keep.
fn kept(name: &str, pin: Hairpin, steps: usize) -> Result<Vec<Row>, Error> {
    let flung = [3.0 * SPEED, 0.0];
    let bound = penetration_bound_now(0.5, flung[0], pin.dt);
    let mut newton = Hairpin { flung, ..pin }.newton()?;
    let mut kept = Kept::new(newton.system(), newton.state());
    let mut closed = 0;
    for _ in 0..steps {
        newton.step()?;
        kept.follow(newton.state());
        closed = closed.max(newton.report().contacts[0].closed);
    }
    let penetration = newton.state().records.contacts[0].penetration;
    let row = |what: &str| format!("{name}: {what}");
    Ok(vec![
        Row::at_most(row("change of momentum, relative"), kept.linear, 1e-10),
        Row::at_most(
            row("change of angular momentum, relative"),
            kept.angular,
            1e-10,
        ),
        Row::at_most(row("change of energy, relative"), kept.energy, 1e-8),
        Row::at_least(row("most points with a force"), closed as f64, 1.0),
        Row::at_most(row("penetration, m"), penetration, bound),
    ])
}

fn pin(elements: [usize; 3], dim: usize, dt: f64) -> Hairpin {
    Hairpin {
        dim,
        elements,
        half: false,
        flung: [SPEED; 2],
        scheme: CONSERVING,
        law: NOW,
        integration: Integration::Node,
        dt,
    }
}

pub(crate) const CHECK: Check = Check {
    name: "self-contact",
    fact: "a hairpin whose prongs meet keeps momenta and energy, and moves as its half does against a wall",
    run: |size| {
        let (plane, solid, steps) = match size {
            Size::Quick => (pin([16, 0, 2], 2, 4e-3), pin([10, 1, 1], 3, 4e-3), 50),
            Size::Full => (pin([24, 0, 2], 2, 2e-3), pin([16, 1, 2], 3, 2e-3), 200),
        };
        let mut rows = Vec::new();
        let trapezoid: (Scheme, Law) = (newmark(0.25, 0.5), DISPLACEMENT);
        for (name, pin, (scheme, law), integration, tolerance) in [
            (
                "plane, trapezoid, displacement, nodes",
                plane,
                trapezoid,
                Integration::Node,
                1e-8,
            ),
            (
                "plane, energy-momentum, velocity, nodes",
                plane,
                (CONSERVING, NOW),
                Integration::Node,
                1e-3,
            ),
            (
                "plane, energy-momentum, velocity, mortar",
                plane,
                (CONSERVING, NOW),
                MORTAR,
                3e-3,
            ),
            (
                "space, trapezoid, displacement, nodes",
                solid,
                trapezoid,
                Integration::Node,
                1e-8,
            ),
            (
                "space, energy-momentum, velocity, nodes",
                solid,
                (CONSERVING, NOW),
                Integration::Node,
                1e-3,
            ),
            (
                "space, energy-momentum, velocity, mortar",
                solid,
                (CONSERVING, NOW),
                MORTAR,
                3e-3,
            ),
        ] {
            let [motion, force] = mirrored(Hairpin {
                scheme,
                law,
                integration,
                ..pin
            })?;
            let row = |what: &str| format!("{name}: {what}");
            rows.push(
                Row::at_most(
                    row("motion, whole - half / half the distance"),
                    motion,
                    tolerance,
                )
                .second_formulation(),
            );
            rows.push(
                Row::at_most(row("force, whole - half / largest"), force, tolerance)
                    .second_formulation(),
            );
        }
        for (name, pin) in [("plane", plane), ("space", solid)] {
            for (points, integration) in [("nodes", Integration::Node), ("mortar", MORTAR)] {
                let name = format!("{name}, energy-momentum, velocity, {points}");
                rows.extend(kept(&name, Hairpin { integration, ..pin }, steps)?);
            }
        }
        Ok(rows)
    },
};
