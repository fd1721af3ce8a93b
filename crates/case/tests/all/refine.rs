//! `mesh.refine` from the text to the model.

use carom_case::{Built, Input, build, parse};

/// A box on a plane, its elements along x, y and z and how often they are cut.
fn built(elements: [usize; 3], refine: u32) -> Built {
    let text = format!(
        r#"
carom = 1
mesh.generate.block.box = {{ origin = [0.0, 0.0, 0.0], size = [2.0, 1.0, 1.0], elements = {elements:?} }}
mesh.refine = {refine}
material.rubber = {{ density = 1000.0, elastic = {{ young = "1 GPa", poisson = 0.3 }} }}
body.block = {{ region = "block", material = "rubber" }}
time = {{ end = "4 ms", step.courant = 0.5, scheme.theta.theta = 0.5 }}
[contact.ground]
secondary = "block.bottom"
obstacle.plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
law.velocity = {{}}
"#
    );
    let input = Input::from_text("case.toml", &text, &[]);
    let (case, locator) = parse(&input).unwrap();
    build(&case, &locator, &input).unwrap()
}

#[test]
fn a_box_cut_twice_is_the_box_with_four_times_the_elements_along_each_side() {
    let (cut, direct) = (built([2, 1, 1], 2), built([8, 4, 4], 0));
    // coordinates are multiples of 1/4: exact either way
    let sorted = |built: &Built| {
        let mut x = built.system.x.clone();
        x.sort_by(|a, b| a.partial_cmp(b).unwrap());
        x
    };
    assert_eq!(sorted(&cut), sorted(&direct));
    assert_eq!(cut.system.points(), 9 * 5);
    assert_eq!(cut.system.points(), direct.system.points());
    assert!((cut.system.dt / direct.system.dt - 1.0).abs() < 1e-14);
}
