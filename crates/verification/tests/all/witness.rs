//! What checks show.

use carom_dynamics::Model;
use carom_verification::inside::{look, looks, slow_bars, system};

#[test]
fn a_look_sees_the_largest_model_and_nothing_is_kept_after_it() {
    let build = |elements: usize| {
        system(slow_bars(elements).unwrap()).unwrap();
    };
    let ((), shown) = look(|| [4, 8, 2].into_iter().for_each(build));
    let cells = |model: Model| model.bodies[0].spec.cells.len();
    assert_eq!(shown.model.map(cells), Some(8));
    build(4);
    assert!(!looks());
}
