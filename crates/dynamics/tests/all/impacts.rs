//! The table of impacts: which intervals of contact are one impact, and whose momenta restitution is made of.

use carom_bodies::{BodySpec, Kinematics};
use carom_contact::Law;
use carom_contact::law::{Capture, Displacement, Reading, Velocity};
use carom_dynamics::NoRestitution;
use carom_dynamics::scheme::{Newmark, Theta};
use carom_dynamics::{
    Driver, Impact, Model, ModelBody, ModelContact, ModelTarget, Scheme, Support, System,
};
use carom_materials::Elastic;
use carom_mesh::{Mesh, Surface, generate};

const THETA: Scheme = Scheme::Theta(Theta { theta: 0.5 });
const HALF: Law = Law::Velocity(Velocity {
    capture: Capture::Half,
    reading: Reading::Closed,
});

/// Bars of these lengths (m), unit section and wave speed, end to end with `gap` between them, and their velocities; each
/// touches the next.
struct Row {
    lengths: Vec<f64>,
    velocities: Vec<f64>,
    gap: f64,
    scheme: Scheme,
    law: Law,
    elements: usize,
    held: Option<&'static str>,
}

impl Row {
    fn new(lengths: &[f64], velocities: &[f64]) -> Row {
        Row {
            lengths: lengths.to_vec(),
            velocities: velocities.to_vec(),
            gap: 0.01,
            scheme: THETA,
            law: HALF,
            elements: 100,
            held: None,
        }
    }

    fn model(&self) -> Model {
        let mut start = 0.0;
        let mut whole: Option<Mesh> = None;
        let name = |k: usize| format!("b{k}");
        for (k, length) in self.lengths.iter().enumerate() {
            let count = (length * self.elements as f64) as usize;
            let end = start + length;
            let part = generate::line(&name(k), [start, 0.0, 0.0], [end, 0.0, 0.0], count, 1);
            match &mut whole {
                None => whole = Some(part),
                Some(whole) => whole.merge(&name(k), part).unwrap(),
            }
            start = end + self.gap;
        }
        let mesh = whole.unwrap();
        let cells = |k: usize| mesh.groups[&name(k)].elements.clone();
        let material = Elastic {
            density: 1.0,
            young: 1.0,
            poisson: 0.0,
        };
        let body = |k: usize| ModelBody {
            velocity: [self.velocities[k], 0.0, 0.0],
            ..ModelBody::new(BodySpec::new(
                name(k),
                cells(k),
                Kinematics::Bar { area: 1.0 },
                material,
            ))
        };
        let side = |k: usize, end: &str| {
            let group = &mesh.groups[&format!("b{k}.{end}")];
            Surface::new(&mesh, group, &cells(k)).unwrap()
        };
        let contact = |k: usize| {
            ModelContact::new(
                format!("c{k}"),
                side(k, "right"),
                ModelTarget::Surface(side(k + 1, "left")),
                self.law,
            )
        };
        let supports = self.held.iter().map(|group| Support {
            nodes: mesh.group_nodes(&mesh.groups[*group]),
            fix: [true; 3],
            fix_rotations: [false; 3],
        });
        Model {
            contacts: (1..self.lengths.len()).map(|k| contact(k - 1)).collect(),
            supports: supports.collect(),
            ..Model::new(
                (0..self.lengths.len()).map(body).collect(),
                mesh.clone(),
                self.scheme,
                0.5 / self.elements as f64,
            )
        }
    }

    /// The impacts until `end` (s), and the driver there.
    fn impacts(&self, end: f64) -> (Vec<Impact>, Driver) {
        Row::impacts_of(self.model(), end)
    }

    fn impacts_of(model: Model, end: f64) -> (Vec<Impact>, Driver) {
        let mut driver = Driver::new(System::new(model).unwrap()).unwrap();
        while driver.state().time < end {
            driver.step().unwrap();
        }
        let (system, state) = (driver.system(), driver.state());
        (state.impacts(system), driver)
    }
}

#[test]
fn a_contact_that_chatters_is_one_impact_whose_restitution_is_that_of_the_momenta() {
    // the displacement law under the trapezoid opens and closes at every other step
    let row = Row {
        scheme: Scheme::Newmark(Newmark {
            beta: 0.25,
            gamma: 0.5,
        }),
        law: Law::Displacement(Displacement { projection: false }),
        ..Row::new(&[1.0, 1.5], &[1.0, 0.0])
    };
    let (impacts, driver) = row.impacts(5.0);
    let [impact] = &impacts[..] else {
        panic!("{} impacts", impacts.len());
    };
    assert!(impact.intervals > 5, "it chatters: {}", impact.intervals);
    let (system, v) = (driver.system(), &driver.state().motion.v);
    let [one, two] = [0, 1].map(|body| system.mean_velocity(body, v)[0]);
    // free flight since then: the momenta are still those after the impact, to rounding
    assert!((impact.restitution.unwrap() - (two - one)).abs() < 1e-9);
    assert!((impact.impulse - 1.5 * two).abs() < 1e-9);
    assert!(!impact.unfinished && impact.approach > 0.999_999);
}

#[test]
fn an_impact_ends_when_its_flight_has_lasted_and_is_told_before() {
    let row = Row::new(&[1.0, 1.0], &[1.0, 0.0]);
    // equal bars: closed from 0.01 to 2.01, within an element's crossing; a wave crosses a bar in 1
    for end in [2.3, 3.5] {
        let (impacts, driver) = row.impacts(end);
        assert_eq!(impacts.len(), 1);
        assert!(!impacts[0].unfinished);
        assert_eq!(driver.state().records.ended().count(), 1);
        assert_eq!(driver.state().records.impacts.len(), usize::from(end > 3.0));
        // nearly all of the speed is exchanged: 1 - n^-0.69 or so
        let e = impacts[0].restitution.unwrap();
        assert!(e > 0.95 && e <= 1.0, "{e}");
    }
    let (impacts, _) = row.impacts(1.0);
    assert!(impacts[0].unfinished && impacts[0].restitution.is_none());
    assert_eq!(impacts[0].no_restitution, Some(NoRestitution::Unfinished));
}

#[test]
fn bodies_that_share_a_node_hit_as_one() {
    let row = Row::new(&[1.0, 1.5], &[1.0, 0.0]);
    let (whole, _) = row.impacts(4.0);
    // the same bar of two bodies; the contact is that of the one in front
    let mut model = row.model();
    let rear = model.bodies[0].spec.cells.drain(..60).collect();
    let mut behind = model.bodies[0].clone();
    behind.spec.name = "rear".to_owned();
    behind.spec.cells = rear;
    model.bodies.push(behind);
    let (joined, _) = Row::impacts_of(model, 4.0);
    let [whole, joined] = [&whole[0], &joined[0]];
    // rounding alone: the mean of the masses, 1 and 1.5 kg
    assert!((joined.approach - 1.0).abs() < 1e-9, "{joined:?}");
    assert!((joined.energy_given - 0.5 / (1.0 + 1.0 / 1.5)).abs() < 1e-9);
    let e = [whole, joined].map(|impact| impact.restitution.unwrap());
    assert!((e[0] - e[1]).abs() < 1e-9, "{e:?}");
}

#[test]
fn two_impacts_with_a_long_flight_between_them_are_two() {
    // the first bar hits the second, which flies at its speed to the third
    let row = Row {
        gap: 1.5,
        ..Row::new(&[1.0, 1.0, 1.0], &[1.0, 0.0, 0.0])
    };
    let (impacts, _) = row.impacts(6.5);
    let contacts: Vec<u32> = impacts.iter().map(|impact| impact.contact).collect();
    assert_eq!(contacts, [0, 1]);
    for impact in impacts {
        let e = impact.restitution.unwrap();
        assert!(e > 0.95 && e <= 1.0, "{e}");
    }
}

#[test]
fn a_chain_has_no_restitution_where_two_contacts_act_on_one_body() {
    // the middle bar is pushed on both sides at once
    let row = Row {
        gap: 0.0,
        ..Row::new(&[1.0, 0.5, 1.0], &[1.0, 0.0, 0.0])
    };
    let (impacts, _) = row.impacts(8.0);
    assert!(impacts.len() >= 2);
    for impact in impacts {
        assert_eq!(impact.restitution, None, "contact {}", impact.contact);
        let why = impact.no_restitution.unwrap();
        let told = [NoRestitution::OtherForces, NoRestitution::Unfinished];
        assert!(told.contains(&why), "{why:?}");
    }
}

#[test]
fn what_a_support_holds_of_a_body_has_no_part_in_its_velocity() {
    // one element, its right node held: half of its mass flies on nothing. It is hit by what rests; both at 1 m/s nominally
    let row = Row {
        elements: 1,
        held: Some("b0.left"),
        ..Row::new(&[1.0, 1.0], &[1.0, 0.0])
    };
    let (impacts, _) = row.impacts(1.0);
    let impact = &impacts[0];
    // masses of ½ and 1; within the few steps of the shock the spring of the held one does not slow it much
    assert!((impact.approach - 1.0).abs() < 0.02, "{}", impact.approach);
    let given = 0.5 / (1.0 / 0.5 + 1.0 / 1.0) * impact.approach * impact.approach;
    assert!((impact.energy_given - given).abs() < 1e-12);
    assert_eq!(
        impact.restitution, None,
        "its support takes a part of the impulse"
    );
}

#[test]
fn a_body_that_is_held_and_rests_stands_for_the_ground() {
    let row = Row {
        held: Some("b1.right"),
        ..Row::new(&[1.0, 1.5], &[1.0, 0.0])
    };
    let (impacts, driver) = row.impacts(9.0);
    let v = driver.system().mean_velocity(0, &driver.state().motion.v)[0];
    // exact: the striker gives all to the target from 0 to 2, and gets it back from 3 to 5, when the wave returns from the
    // clamp: a flight of 1, which a wave takes 1.5 to cross the target, is within the impact
    let last = &impacts[impacts.len() - 1];
    assert!(!last.unfinished && v < -0.9, "{v}");
    assert!(
        (last.restitution.unwrap() - -v).abs() < 1e-9,
        "{last:?} {v}"
    );
}

#[test]
fn an_oblique_impact_with_friction_has_the_approach_and_restitution_of_the_normal() {
    let theta = Scheme::Theta(Theta { theta: 0.5 });
    let mut model = super::newton::square(theta, HALF, super::newton::SOFT.into(), 4);
    model.gravity = [0.0; 3];
    model.bodies[0].velocity = [0.3, -0.2, 0.0];
    model.contacts[0].friction = 0.3.into();
    let mut newton = Driver::new(System::new(model).unwrap()).unwrap();
    for _ in 0..60 {
        newton.step().unwrap();
    }
    let (system, state) = (newton.system(), newton.state());
    let impacts = state.impacts(system);
    let [impact] = &impacts[..] else {
        panic!("{impacts:?}");
    };
    let v = system.mean_velocity(0, &state.motion.v);
    assert!(v[0] < 0.29, "friction has acted: {v:?}");
    // the plane is flat: its normal is that of the impact to rounding; sixty steps of Newton's iterations, 1e-10 each
    assert!((impact.approach - 0.2).abs() < 1e-8, "{}", impact.approach);
    assert!((impact.restitution.unwrap() - v[1] / 0.2).abs() < 1e-7);
    assert!(
        impact.impulse > SQUARE * (v[1] + 0.2) * 1.001,
        "with that of friction"
    );
}

/// Mass of the square, kg.
const SQUARE: f64 = 2.0 * 0.5;
