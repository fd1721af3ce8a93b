//! Shells and what they lie on, looked for both ways.

use carom_contact::Parts;

use super::*;

/// Half the thickness of shells, in edges: thicker than points look far.
const HALF: f64 = 0.65;

/// A shell over another side that it goes through, both ways: over a plate with both its sides, or over another shell.
pub(super) fn shell_over(is_shell: bool) -> (Scene, Contact) {
    let mut scene = Scene::default();
    scene.add(6, [0.0; 3], true);
    if !is_shell {
        scene.add(6, [0.0, 0.0, -2.0], false);
    }
    scene.add(5, [0.4, 0.3, 3.0], false);
    let last = scene.sheets.len() - 1;
    let first = scene.faces.len() - 25;
    for (k, face) in scene.faces.iter_mut().enumerate() {
        face.radius = (is_shell || k >= first).then_some(HALF);
    }
    let mut points = Vec::new();
    for sheet in 0..=last {
        let (faces, is_last) = (scene.of(sheet), sheet == last);
        points.extend(nodes_of(&scene, sheet).into_iter().map(|point| {
            let radius = if is_shell || is_last { HALF } else { 0.0 };
            let mut point = point.around(radius);
            let node = point.node();
            let own = faces.iter().filter(|face| face.corners().contains(&node));
            own.for_each(|face| point.add_face(face.corners()));
            if is_last { point.on_primary() } else { point }
        }));
    }
    let parts = Parts::both_ways(None, [first, 25], 0);
    let depth = if is_shell { 2.0 * HALF } else { 2.0 };
    let sight = Sight::both_ways(
        &points,
        (&scene.faces, &[]),
        &scene.x,
        (Some(depth), &parts),
    );
    let mut faces = scene.faces.clone();
    Rim::mark(&mut faces, |node| scene.x[node as usize], |node| node);
    let contact = Contact {
        sight: Some(sight),
        ..contact(Target::Surface(faces), points)
    };
    (scene, contact)
}

#[test]
fn a_shell_and_what_it_lies_on_both_ways() {
    for is_shell in [false, true] {
        let (scene, contact) = shell_over(is_shell);
        let last = *scene.sheets.last().unwrap();
        check(&scene, &contact, last);
    }
}
