//! Steps of zones allocate what their drivers do.

use carom_dynamics::Stepper;
use carom_testing::allocations;
use carom_zones::Zones;

use crate::whole;

#[test]
fn the_whole_of_zones_needs_no_memory_beyond_that_of_their_steps() {
    let zoned = whole::bar();
    let mut zones = Zones::new(&zoned).unwrap();
    let mut whole = whole::whole(&zoned);
    let counted = |step: &mut dyn FnMut()| {
        let before = allocations();
        step();
        allocations() - before
    };
    for step in 0..100 {
        let alone = counted(&mut || zones.step().unwrap());
        let gathered = counted(&mut || whole.step().unwrap());
        // the first step makes the places of the samples
        // (what is made once for all drivers, the zones alone have made)
        assert!(step == 0 || gathered <= alone, "{step}: {gathered} {alone}");
    }
    assert!(whole.report().contacts[0].closed > 0, "in contact");
}
