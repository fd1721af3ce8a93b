//! Contacts of which several ranks have points.

use crate::ranks::{
    assert_same, built, compare_on_ranks, driver_on, last, on_all, resume_on, run_alone, run_on,
};

/// A block between a floor that slides, with friction, a ball, and a wall that crushes; another block that strikes its corner; and a
/// probe of the pressure on the floor.
const CORNER: &str = r#"
carom = 1
[mesh]
generate.block.box = { origin = [0.0, 0.0, 0.0005], size = [0.1, 0.08, 0.12], elements = [6, 5, 7] }
generate.head.box = { origin = [0.03, 0.03, 0.121], size = [0.1, 0.06, 0.06], elements = [6, 4, 3] }
[material.soft]
density = 1000.0
neo-hooke = { young = "5 MPa", poisson = 0.3 }
[body.block]
region = "block"
material = "soft"
initial = { velocity = [2.0, 0.5, -3.0] }
[body.head]
region = "head"
material = "soft"
initial = { velocity = [0.0, 0.0, -6.0] }
[contact.floor]
secondary = "block.bottom"
obstacle.plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0], motion.velocity = [0.0, -1.0, 0.2] }
law.velocity = {}
friction.coulomb = 0.3
[contact.wall]
secondary = "block.right"
obstacle.plane = { point = [0.1008, 0.0, 0.0], normal = [-1.0, 0.0, 0.05] }
law.stop = { curve = [{ penetration = "1 mm", force = "400 N" }, { penetration = "3 mm", force = "600 N" }], crush = "permanent" }
moment-about = [0.1, 0.0, 0.0]
[contact.ball]
secondary = "block.back"
obstacle.sphere = { centre = [0.02, 0.13, 0.09], radius = 0.0495 }
law.velocity = {}
[contact.strike]
secondary = "head.bottom"
primary = "block.top"
law.velocity = {}
sliding = "finite"
[time]
end = "2.5 ms"
step = { critical = 0.1 }
scheme.central-difference = {}
[probe.foot]
on = "block.bottom"
record = ["displacement", "contact"]
[probe.side]
on = "block.right"
record = ["contact"]
"#;

/// Points of a block on several ranks, each of which has some of every contact with an obstacle.
#[test]
fn contacts_of_several_kinds_are_those_of_one_process_on_several_ranks() {
    let shares = on_all(4, |ranks| {
        driver_on(ranks, CORNER).rank_share().unwrap().points
    });
    let (_, _, built) = built(CORNER);
    assert_eq!(shares.iter().sum::<usize>(), built.system.points());
    assert!(shares.iter().all(|own| *own > 0), "{shares:?}");
    compare_on_ranks("corner", CORNER, &[2, 3, 4]);
    let folder = tempfile::tempdir().unwrap();
    run_alone(CORNER, folder.path());
    let state = last(CORNER, folder.path());
    let records = &state.records.contacts;
    // all of them touch, and the wall is crushed: the comparison is of something
    assert!(records.iter().all(|record| record.closings > 0));
    assert!(records.iter().any(|record| record.energy_crushed > 0.0));
    assert!(records.iter().any(|record| record.friction_loss() > 0.0));
}

/// A plate on whose ends two blocks land and slide along: one contact at two places, and one of the plate with itself.
const ENDS: &str = r#"
carom = 1
[mesh]
generate.plate.box = { origin = [0.0, 0.0, 0.0], size = [0.4, 0.06, 0.02], elements = [24, 4, 2] }
generate.left.box = { origin = [0.02, 0.011, 0.0204], size = [0.06, 0.04, 0.03], elements = [5, 3, 2] }
generate.right.box = { origin = [0.31, 0.008, 0.0208], size = [0.06, 0.04, 0.03], elements = [5, 3, 2] }
[material.soft]
density = 1000.0
neo-hooke = { young = "5 MPa", poisson = 0.3 }
[material.hard]
density = 2000.0
neo-hooke = { young = "20 MPa", poisson = 0.3 }
[body.plate]
region = "plate"
material = "soft"
[body.left]
region = "left"
material = "hard"
initial.velocity = [30.0, 1.0, -3.0]
[body.right]
region = "right"
material = "hard"
initial.velocity = [-25.0, 0.0, -4.0]
[general-contact]
by = "materials"
law.velocity = {}
friction.coulomb = 0.2
[time]
end = "2.5 ms"
step = { critical = 0.2 }
scheme.central-difference = {}
"#;

/// A contact at two places is computed by the ranks that are there, and where the places move, by others.
#[test]
fn one_contact_at_two_places_is_shared_out_and_moves_from_rank_to_rank() {
    compare_on_ranks("ends", ENDS, &[2, 3, 4]);
    let folder = tempfile::tempdir().unwrap();
    run_alone(ENDS, folder.path());
    let state = last(ENDS, folder.path());
    let closings = state.records.contacts.iter().map(|record| record.closings);
    assert!(closings.max().unwrap() > 0);
    let shares = on_all(3, |ranks| {
        let mut driver = driver_on(ranks, ENDS);
        let mut seen = vec![driver.rank_share().unwrap()];
        for _ in 0..40 {
            (0..10).for_each(|_| driver.step().unwrap());
            seen.push(driver.rank_share().unwrap());
        }
        seen
    });
    // the blocks begin near the parts of two ranks, and come to that of the third
    let begin = shares.iter().map(|share| share[0].looked_points > 0);
    assert_eq!(begin.collect::<Vec<_>>(), [true, false, true]);
    assert!(shares[1].iter().any(|share| share.looked_points > 0));
    assert!(shares[1][40].contact_shares > 3);
}

#[test]
fn contacts_at_two_places_go_on_from_a_checkpoint_on_other_ranks() {
    let folder = tempfile::tempdir().unwrap();
    let [alone, cut] = ["alone", "cut"].map(|name| folder.path().join(name));
    run_alone(ENDS, &alone);
    run_on(4, ENDS, &cut, 150);
    let state = last(ENDS, &cut);
    assert_eq!(state.step, 150);
    // in the midst of the contacts
    let closed = state.interface.force.iter().filter(|force| **force > 0.0);
    assert!(closed.count() > 3);
    resume_on(3, &cut);
    assert_same("resumed", &last(ENDS, &alone), &last(ENDS, &cut));
}
