//! Two rods with finite rotations that cross, strike, slide along each other and turn: momenta, energy, and that they do not pass through each other.

use carom_algebra::tensor::Vec3;
use carom_bodies::{BeamSection, BeamTheory, BodySpec, Kinematics, Rotations, SectionShape};
use carom_contact::law::{Capture, Reading, Velocity};
use carom_contact::{Law, Sliding};
use carom_dynamics::scheme::EnergyMomentum;
use carom_dynamics::{Driver, Model, ModelBody, ModelContact, ModelTarget, Order, Scheme, System};
use carom_materials::Elastic;
use carom_mesh::{Surface, generate};

const SOFT: Elastic = Elastic {
    density: 1000.0,
    young: 1e8,
    poisson: 0.3,
};
const RADIUS: f64 = 0.01;
/// Elements of each rod, of 1 m.
const ELEMENTS: [usize; 2] = [20, 23];
const DT: f64 = 5e-5;
/// Velocity of the second rod, m/s.
const THROWN: [f64; 3] = [-3.0, 0.5, -6.0];

/// A rod along x at rest, and one along y, 1 mm above it and beside the middle of both, that is thrown down and along the first.
fn rods(friction: f64) -> Model {
    let line = |name: &str, from, to, n| generate::line(name, from, to, n, 3);
    let mut mesh = line("a", [-0.5, 0.0, 0.0], [0.5, 0.0, 0.0], ELEMENTS[0]);
    let height = 2.0 * RADIUS + 1e-3;
    let [from, to] = [-0.75, 0.25].map(|y| [0.35, y, height]);
    mesh.merge("b", line("b", from, to, ELEMENTS[1])).unwrap();
    let shape = SectionShape::Circle {
        diameter: 2.0 * RADIUS,
    };
    let section = BeamSection {
        radius: Some(RADIUS),
        orientation: Some([0.0, 0.0, 1.0]),
        rotations: Rotations::Finite,
        ..BeamSection::new(BeamTheory::Timoshenko, shape.properties(SOFT.poisson))
    };
    let body = |name: &str, velocity| {
        let cells = mesh.groups[name].elements.clone();
        ModelBody {
            velocity,
            ..ModelBody::new(BodySpec::new(name, cells, Kinematics::Beam(section), SOFT))
        }
    };
    let bodies = vec![body("a", [0.0; 3]), body("b", THROWN)];
    let around = |k: usize, name: &str| {
        let cells = &bodies[k].spec.cells;
        Surface::of_axes(&mesh, &mesh.groups[name], cells, |_| RADIUS).unwrap()
    };
    let law = Law::Velocity(Velocity {
        capture: Capture::Half,
        reading: Reading::Closed,
    });
    let target = ModelTarget::Surface(around(0, "a"));
    let contact = ModelContact {
        sliding: Sliding::Finite,
        friction: friction.into(),
        ..ModelContact::new("crossing", around(1, "b"), target, law)
    };
    let scheme = Scheme::EnergyMomentum(EnergyMomentum {});
    Model {
        contacts: vec![contact],
        ..Model::new(bodies, mesh.clone(), scheme, DT)
    }
}

/// Places of the nodes of both rods, m.
fn axes(driver: &Driver) -> [Vec<Vec3>; 2] {
    let system = driver.system();
    let place = |node: usize| {
        let number = system.number[node];
        let u = system.of_node(number, &driver.state().motion, Order::Displacement);
        Vec3::from(system.x[number as usize]) + Vec3::from(u)
    };
    let first = ELEMENTS[0] + 1;
    [0..first, first..first + ELEMENTS[1] + 1].map(|nodes| nodes.map(place).collect())
}

/// The nearest two segments: their distance, with the sign of (b - a)·(t_a × t_b), and whether they are nearest inside both rods.
fn apart([a, b]: &[Vec<Vec3>; 2]) -> (f64, bool) {
    let mut nearest = (f64::INFINITY, 0.0, false);
    for (i, p) in a.windows(2).enumerate() {
        for (j, q) in b.windows(2).enumerate() {
            let (s, t, gap) = (p[1] - p[0], q[1] - q[0], q[0] - p[0]);
            let (ss, tt, st) = (s.dot(&s), t.dot(&t), s.dot(&t));
            let det = ss * tt - st * st;
            let k = ((gap.dot(&s) * tt - gap.dot(&t) * st) / det).clamp(0.0, 1.0);
            let l = ((k * st - gap.dot(&t)) / tt).clamp(0.0, 1.0);
            let k = ((gap.dot(&s) + l * st) / ss).clamp(0.0, 1.0);
            let between = gap + t * l - s * k;
            let inside = !(i == 0 && k == 0.0
                || i + 1 == ELEMENTS[0] && k == 1.0
                || j == 0 && l == 0.0
                || j + 1 == ELEMENTS[1] && l == 1.0);
            if between.norm() < nearest.0 {
                nearest = (between.norm(), between.dot(&s.cross(&t)), inside);
            }
        }
    }
    (nearest.0.copysign(nearest.1), nearest.2)
}

/// What of two rods is judged after 120 ms.
struct Run {
    driver: Driver,
    /// Least signed distance of the axes where they are nearest inside both rods, m.
    least: f64,
    /// Way of a node of the thrown rod against the middle of the other one between the first and the last touch, m.
    slid: f64,
    /// Cosines of the angles by which the ends have turned.
    turned: [f64; 2],
}

fn run(friction: f64) -> Run {
    let mut driver = Driver::new(System::new(rods(friction)).unwrap()).unwrap();
    let (mut least, mut places) = (f64::INFINITY, Vec::new());
    for _ in 0..2400 {
        driver.step().unwrap();
        let axes = axes(&driver);
        let (distance, inside) = apart(&axes);
        if inside {
            least = least.min(distance);
        }
        if driver.report().contacts[0].force > 0.0 {
            places.push(axes[1][17] - axes[0][10]);
        }
    }
    let [first, last] = [&places[0], &places[places.len() - 1]];
    let slid = (last - first).norm();
    let along = |axis: &[Vec3]| (axis[axis.len() - 1] - axis[0]).normalize();
    let [a, b] = axes(&driver);
    let turned = [along(&a).x, along(&b).y];
    Run {
        driver,
        least,
        slid,
        turned,
    }
}

/// Axes that pass through each other would change the sign of their distance. Laws in the rate stop an approach in the step in which the rods touch: of the way of that step,
/// at the speed of the throw, they may be closer than both radii. Balances: what iterations to 1e-10 leave, 1e-7 of the energy as the verdict allows, and of momenta 1e-8.
#[test]
fn rods_that_cross_and_slide_do_not_pass_through_each_other() {
    let way = Vec3::from(THROWN).norm() * DT;
    for friction in [0.0, 0.3] {
        let Run {
            driver,
            least,
            slid,
            turned,
        } = run(friction);
        assert!(least > 2.0 * RADIUS - way, "{friction}: {least}");
        assert!(least < 2.0 * RADIUS + way, "they touch: {least}");
        assert!(slid > 0.1, "over two elements: {slid}");
        assert!(turned.iter().all(|c| *c < 0.8), "over 36°: {turned:?}");
        let ledger = &driver.state().ledger;
        let energy = ledger.largest_energy_residual / ledger.largest_energy;
        assert!(energy < 1e-7, "{friction}: energy {energy:e}");
        let momentum = ledger.largest_momentum_residual / ledger.largest_momentum;
        assert!(momentum < 1e-8, "{friction}: momentum {momentum:e}");
        let angular = ledger.largest_angular_residual / ledger.largest_angular_momentum;
        assert!(angular < 1e-8, "{friction}: angular momentum {angular:e}");
        let balance = &ledger.balance;
        // normal forces of the conserving scheme do no work, friction only takes
        let work = balance.work_contact.abs() / ledger.largest_energy;
        assert!(work < 1e-8, "{friction}: work {work:e}");
        assert_eq!(balance.dissipation_friction > 0.0, friction > 0.0);
    }
}
