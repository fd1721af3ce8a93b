//! Static stages, constraints and motions of supports before and in the steps of zones that step apart.

use carom_algebra::unknowns::Kind;
use carom_arlequin::trace;
use carom_bodies::{BodySpec, Kinematics};
use carom_contact::law::Displacement;
use carom_contact::{Law, Plane, Sliding};
use carom_dynamics::scheme::{CentralDifference, GeneralisedAlpha, Newmark, NonsmoothAlpha, Theta};
use carom_dynamics::{
    Amplitude, Model, ModelBody, ModelConstraint, ModelContact, ModelLink, ModelTarget, Preload,
    Scheme, Stepper,
};
use carom_materials::Elastic;
use carom_mesh::{Surface, generate};
use carom_system::{Prescribed, Support};
use carom_zones::{LinkKind, ModelZone, Whole, Zoned, Zones};

const RUBBER: Elastic = Elastic {
    density: 1000.0,
    young: 1e6,
    poisson: 0.0,
};
const MID_POINT: Scheme = Scheme::Theta(Theta { theta: 0.5 });
const GRAVITY: f64 = 9.81;

fn held(nodes: Vec<u32>) -> Support {
    Support {
        nodes,
        fix: [true; 3],
        fix_rotations: [true; 3],
    }
}

/// Three bars of 1 m that hang one on the other, in zones of one, `m[0]` and `m[1]` steps; the joints are a link and a constraint.
fn hanging(m: [u32; 2]) -> Zoned {
    let line = |name: &str, from: f64| {
        generate::line(name, [from, 0.0, 0.0], [from + 1.0, 0.0, 0.0], 6, 1)
    };
    let mut mesh = line("a", 0.0);
    mesh.merge("b", line("b", 1.0)).unwrap();
    mesh.merge("c", line("c", 2.0)).unwrap();
    let body = |name: &str| {
        let cells = mesh.groups[name].elements.clone();
        let kinematics = Kinematics::Bar { area: 0.01 };
        ModelBody::new(BodySpec::new(name, cells, kinematics, RUBBER))
    };
    let bodies = ["a", "b", "c"].map(body).to_vec();
    let nodes = |group: &str| mesh.group_nodes(&mesh.groups[group]);
    let rows = trace(&mesh, &nodes("a"), &nodes("b"), 1e-9).unwrap().rows;
    let (end, begin) = (nodes("b.right")[0], nodes("c.left")[0]);
    let along = Kind::Translation(0);
    let constraint = ModelConstraint {
        name: "hook".into(),
        rows: vec![vec![(end, along, 1.0), (begin, along, -1.0)]],
    };
    let top = held(nodes("a.left"));
    let mut model = Model::new(bodies, mesh, MID_POINT, 2e-3);
    model.constraints = vec![constraint];
    model.supports = vec![top];
    model.gravity = [GRAVITY, 0.0, 0.0];
    model.nonlinear.preload = Some(Preload { end: 1.0, steps: 3 });
    let zone = |name: &str, body, steps| ModelZone::new(name, vec![body], (MID_POINT, steps));
    Zoned {
        zones: vec![zone("a", 0, 1), zone("b", 1, m[0]), zone("c", 2, m[1])],
        links: vec![ModelLink {
            name: "tie".into(),
            zones: [0, 1],
            rows,
        }],
        kind: LinkKind::PrakashHjelmstad,
        model,
    }
}

fn whole(zoned: &Zoned) -> Whole {
    let system = zoned.whole().unwrap();
    Whole::new(zoned, system).unwrap()
}

/// Nodes of linear bars under their weight are where the exact solution has them, `u = ρ g (L x - x²/2)/E`. The stage leaves forces at 1e-10 of the
/// largest; what hangs in balance stays where it is.
#[test]
fn bars_of_unequal_steps_hang_still_after_a_static_stage() {
    for m in [[1, 1], [2, 3], [4, 1]] {
        let zoned = hanging(m);
        let mut run = whole(&zoned);
        for _ in 0..3 {
            run.step().unwrap();
        }
        assert_eq!(run.state().time, 1.0);
        let exact = |x: f64| RUBBER.density * GRAVITY * (3.0 * x - 0.5 * x * x) / RUBBER.young;
        let check = |run: &Whole| {
            let (system, motion) = (run.system(), &run.state().motion);
            for (x, u) in system.x.iter().zip(&motion.u) {
                assert!(
                    (u - exact(x[0])).abs() < 1e-9 * exact(3.0),
                    "{m:?} {x:?} {u}"
                );
            }
        };
        check(&run);
        for _ in 0..40 {
            run.step().unwrap();
        }
        check(&run);
        assert!((run.state().time - 1.08).abs() < 1e-12);
        let speed = run
            .state()
            .motion
            .v
            .iter()
            .fold(0.0_f64, |m, v| m.max(v.abs()));
        assert!(speed < 1e-9, "{m:?} {speed}");
    }
}

/// A run that was cut in the static stage, at its end and after it ends in the same bytes.
#[test]
fn a_run_that_was_cut_about_a_static_stage_ends_in_the_same_bytes() {
    let zoned = hanging([2, 3]);
    let mut run = whole(&zoned);
    let mut saved = vec![run.saved().unwrap()];
    for _ in 0..6 {
        run.step().unwrap();
        saved.push(run.saved().unwrap());
    }
    for cut in [1, 3, 4] {
        let system = zoned.whole().unwrap();
        let mut resumed = Whole::resume(&zoned, system, &saved[cut]).unwrap();
        for _ in cut..6 {
            resumed.step().unwrap();
        }
        assert!(resumed.saved().unwrap() == saved[6], "cut after {cut}");
    }
}

/// A block on a block, which holds it by friction; each a zone, the upper one with `m` steps. Both lie on a slope of `angle`.
fn stacked(m: u32, (friction, angle): (f64, f64), staged: bool) -> Zoned {
    let block = |name: &str, origin: [f64; 2], size: [f64; 2], n: [usize; 2]| {
        generate::rectangle(name, origin, size, n, false)
    };
    let mut mesh = block("below", [0.0, -0.2], [1.0, 0.2], [5, 2]);
    mesh.merge("above", block("above", [0.3, 0.0], [0.4, 0.2], [3, 2]))
        .unwrap();
    let body = |name: &str| {
        let cells = mesh.groups[name].elements.clone();
        let kinematics = Kinematics::PlaneStrain { thickness: 1.0 };
        ModelBody::new(BodySpec::new(name, cells, kinematics, RUBBER))
    };
    let bodies = vec![body("below"), body("above")];
    let side = |group: &str, body: usize| {
        let cells: &[_] = &bodies[body].spec.cells;
        Surface::new(&mesh, &mesh.groups[group], cells).unwrap()
    };
    let law = Law::Displacement(Displacement::default());
    let (secondary, primary) = (side("above.bottom", 1), side("below.top", 0));
    let mut contact = ModelContact::new("c", secondary, ModelTarget::Surface(primary), law);
    contact.friction = friction.into();
    contact.sliding = Sliding::Finite;
    let floor = held(mesh.group_nodes(&mesh.groups["below.bottom"]));
    let mut model = Model::new(bodies, mesh, MID_POINT, 1e-3);
    model.contacts = vec![contact];
    model.supports = vec![floor];
    let (sin, cos) = f64::to_radians(angle).sin_cos();
    model.gravity = [GRAVITY * sin, -GRAVITY * cos, 0.0];
    model.nonlinear.preload = staged.then_some(Preload { end: 1.0, steps: 2 });
    let zone = |name: &str, body, steps| ModelZone::new(name, vec![body], (MID_POINT, steps));
    Zoned {
        zones: vec![zone("below", 0, 1), zone("above", 1, m)],
        links: Vec::new(),
        kind: LinkKind::PrakashHjelmstad,
        model,
    }
}

/// A scheme of each kind that takes forces which stand over the outer step: as those of a step, and from a jump of the acceleration on.
fn kinds_of_schemes() -> [Scheme; 5] {
    [
        MID_POINT,
        Scheme::Newmark(Newmark::default()),
        Scheme::GeneralisedAlpha(GeneralisedAlpha::default()),
        Scheme::NonsmoothAlpha(NonsmoothAlpha::default()),
        Scheme::CentralDifference(CentralDifference {}),
    ]
}

/// tan 10° is below the coefficient: the contact carries the whole weight in its two parts from the stage on, at the tolerance of the stage.
#[test]
fn a_block_stays_on_a_slope_by_the_friction_of_another_zone() {
    let schemes = kinds_of_schemes().into_iter();
    for (scheme, m) in schemes.flat_map(|scheme| [(scheme, 1), (scheme, 3)]) {
        let mut zoned = stacked(m, (0.3, 10.0), true);
        zoned.zones[1].scheme = scheme;
        let mut run = whole(&zoned);
        let weight = 0.4 * 0.2 * RUBBER.density * GRAVITY;
        let (sin, cos) = f64::to_radians(10.0).sin_cos();
        for step in 0..42 {
            run.step().unwrap();
            if step < 1 {
                continue;
            }
            let report = &run.report().contacts[0];
            let [along, normal, _] = report.resultant;
            let missed = [along + weight * sin, normal - weight * cos];
            let missed = missed.map(|force| force.abs() / weight);
            assert!(missed.iter().all(|m| *m < 1e-8), "{m} {step}: {missed:?}");
            assert_eq!(report.slipping, 0);
        }
        let speed = run
            .state()
            .motion
            .v
            .iter()
            .fold(0.0_f64, |m, v| m.max(v.abs()));
        assert!(speed < 1e-8, "{m}: {speed}");
    }
}

/// A block that slides on a block of another zone: while all that carries slips in one direction, friction is μ times the force of the
/// contact, its work is what the balance loses, and momentum stays.
#[test]
fn friction_between_zones_of_unequal_steps_takes_what_it_should() {
    let schemes = kinds_of_schemes().into_iter();
    for (scheme, m) in schemes.flat_map(|scheme| [(scheme, 1), (scheme, 4)]) {
        let mut zoned = stacked(m, (0.2, 0.0), false);
        zoned.zones[0].scheme = scheme;
        zoned.model.bodies[1].velocity = [1.0, 0.0, 0.0];
        let mut run = whole(&zoned);
        let start = run.state().ledger.balance;
        let (mut lost, mut closed) = (0.0, 0);
        for _ in 0..60 {
            run.step().unwrap();
            let report = &run.report().contacts[0];
            assert!(report.friction_loss >= -1e-15);
            lost += report.friction_loss;
            if report.closed > 0 && report.slipping == report.closed {
                closed += 1;
                let points = &run.state().interface;
                for (t, p) in points.friction.iter().zip(&points.force) {
                    let missed = (t[0].abs() - 0.2 * p).abs();
                    assert!(missed <= 1e-12 * p, "{m}: {t:?} {p}");
                }
            }
        }
        assert!(closed > 20, "{closed} steps in which all slip");
        let balance = run.state().ledger.balance;
        let left = balance.energy_residual.abs() / start.energy();
        assert!(left < 1e-11, "{m}: energy {left:e}");
        let taken = (balance.dissipation_friction - lost).abs() / lost;
        assert!(taken < 1e-12 && lost > 0.0, "{m}: {lost} {taken:e}");
        let left = balance.impulse_links.largest() / start.momentum.largest();
        assert!(left < 1e-12, "{m}: impulses between the zones {left:e}");
    }
}

/// Bars whose end is moved at their own speed move as one, to rounding; the support holds a row of the link too.
#[test]
fn supports_that_move_carry_what_links_and_constraints_join() {
    for m in [[1, 2], [3, 2]] {
        let mut zoned = hanging(m);
        zoned.model.nonlinear.preload = None;
        zoned.model.gravity = [0.0; 3];
        let top = zoned.model.supports.remove(0);
        for body in &mut zoned.model.bodies {
            body.velocity = [0.3, 0.0, 0.0];
        }
        let moved = Amplitude::new(vec![[0.0, 0.0], [1.0, 0.3]]).unwrap();
        let prescribed = |nodes| Prescribed {
            nodes,
            displacement: [Some(moved.clone()), None, None],
        };
        let joint = zoned.links[0].rows[0].outer[0].node;
        let motions = [top.nodes, vec![joint]].map(prescribed);
        zoned.model.nonlinear.motions = motions.to_vec();
        let mut run = whole(&zoned);
        for _ in 0..40 {
            run.step().unwrap();
        }
        let way = 0.3 * run.state().time;
        for u in &run.state().motion.u {
            assert!((u - way).abs() < 1e-12 * way, "{m:?}: {u} {way}");
        }
    }
}

/// Multipliers at inner instants are found before the outer step has its end, on which contacts between zones depend.
#[test]
fn contacts_between_zones_and_rows_at_inner_instants_are_refused() {
    let mut zoned = stacked(3, (0.0, 0.0), false);
    zoned.kind = LinkKind::GravouilCombescure;
    assert!(Zones::new(&zoned).is_ok(), "no rows");
    let (one, other) = (0, zoned.model.mesh.nodes.len() as u32 - 1);
    let along = Kind::Translation(0);
    zoned.model.constraints = vec![ModelConstraint {
        name: "hook".into(),
        rows: vec![vec![(one, along, 1.0), (other, along, -1.0)]],
    }];
    let error = Zones::new(&zoned).map(|_| ()).unwrap_err().to_string();
    assert!(error.contains("prakash-hjelmstad"), "{error}");
    zoned.kind = LinkKind::PrakashHjelmstad;
    assert!(Zones::new(&zoned).is_ok());
}

/// Friction of a contact between zones, none of one inside a zone, and the other way round: both carry their forces over the end of the stage.
#[test]
fn contacts_with_and_without_friction_go_on_from_one_static_stage() {
    for frictions in [[0.3, 0.0], [0.0, 0.3]] {
        let mut zoned = stacked(3, (frictions[0], 0.0), true);
        let lid = ModelTarget::Rigid(
            Plane {
                point: [0.0, -0.2, 0.0],
                normal: [0.0, 1.0, 0.0],
            }
            .into(),
        );
        let body = &zoned.model.bodies[0].spec;
        let group = &zoned.model.mesh.groups["below.bottom"];
        let foot = Surface::new(&zoned.model.mesh, group, &body.cells).unwrap();
        let law = Law::Displacement(Displacement::default());
        let mut floor = ModelContact::new("floor", foot, lid, law);
        floor.friction = frictions[1].into();
        floor.sliding = Sliding::Finite;
        zoned.model.contacts.push(floor);
        // the floor carries what the support did; it holds one node along, so that nothing slides away
        zoned.model.supports[0].fix = [true, false, true];
        if frictions[0] == 0.0 {
            let nodes = zoned
                .model
                .mesh
                .group_nodes(&zoned.model.mesh.groups["above.left"]);
            zoned.model.supports.push(Support {
                fix: [true, false, false],
                ..held(nodes)
            });
        }
        let mut run = whole(&zoned);
        for _ in 0..22 {
            run.step().unwrap();
        }
        let weight = |body: f64| body * RUBBER.density * GRAVITY;
        let found = [0, 1].map(|k| run.report().contacts[k].resultant[1]);
        let expected = [weight(0.4 * 0.2), weight(0.4 * 0.2 + 0.2)];
        for (found, expected) in found.iter().zip(expected) {
            assert!(
                (found - expected).abs() < 1e-8 * expected,
                "{frictions:?}: {found} {expected}"
            );
        }
    }
}
