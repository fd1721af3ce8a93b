use super::tone::SQUARES;
use super::view::EYE;
use super::*;

fn no_obstacle(_: f64, _: [f64; 3]) -> f64 {
    f64::INFINITY
}

fn scene(dim: usize) -> Scene<'static> {
    Scene {
        title: "Motion",
        dim,
        field: ("stress", "Pa"),
        gap: &no_obstacle,
    }
}

/// The faces of a box seen from outside.
fn cube(from: [f64; 3], value: f64) -> Vec<Patch> {
    let corner = |k: usize| [0, 1, 2].map(|i| from[i] + (k >> i & 1) as f64);
    let faces = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let patch = |face: [usize; 4]| Patch {
        points: face.map(corner).to_vec(),
        value,
    };
    faces.map(patch).to_vec()
}

fn frame(patches: Vec<Patch>) -> Frame {
    Frame {
        patches,
        ..Frame::default()
    }
}

#[test]
fn of_a_cube_three_faces_are_seen_top_right_side_and_front() {
    let flats = flatten(3, &frame(cube([0.0; 3], 1.0)), 1.0);
    assert_eq!(flats.len(), 3);
    // a parallel projection of unit vectors: the areas are the cosines to the line of sight
    let mut areas: Vec<f64> = flats.iter().map(|flat| area(&flat.points)).collect();
    areas.sort_unstable_by(f64::total_cmp);
    let length = EYE.iter().map(|e| e * e).sum::<f64>().sqrt();
    let mut cosines = EYE.map(|e| e.abs() / length);
    cosines.sort_unstable_by(f64::total_cmp);
    for (area, cosine) in areas.iter().zip(cosines) {
        assert!((area - cosine).abs() < 1e-14);
    }
    // the light comes from above, in front and the left
    let shade = |k: usize| flats[k].tone.shade;
    let top = (0..3).max_by_key(|k| shade(*k)).unwrap();
    let highest = |flat: &Flat| flat.points.iter().map(|x| x[1]).fold(f64::MIN, f64::max);
    assert!(
        flats
            .iter()
            .all(|flat| highest(flat) <= highest(&flats[top]))
    );
    // z goes upward, x to the right
    let ([x, _], _) = project(3, &[1.0, 0.0, 0.0]);
    let ([_, y], _) = project(3, &[0.0, 0.0, 1.0]);
    assert!(x > 0.0 && y > 0.0);
}

#[test]
fn what_is_nearer_is_drawn_later() {
    let mut patches = cube([0.0, -5.0, 0.0], 1.0);
    patches.extend(cube([0.0; 3], 0.0));
    let flats = flatten(3, &frame(patches), 1.0);
    let levels: Vec<usize> = flats.iter().map(|flat| flat.tone.level).collect();
    assert_eq!(levels, [0, 0, 0, LEVELS - 1, LEVELS - 1, LEVELS - 1]);
}

#[test]
fn many_faces_are_drawn_in_squares_over_the_same_area() {
    let side = 60;
    let at = |i: usize, j: usize| [i as f64, j as f64, 0.0];
    let cell = |k: usize| {
        let (i, j) = (k % side, k / side);
        Patch {
            points: vec![at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)],
            value: 1.0,
        }
    };
    let many = frame((0..side * side).map(cell).collect());
    let svg = film_figure(&scene(2), &[many]).unwrap();
    assert!(!svg.contains("Z\"") && svg.len() < 20_000, "{}", svg.len());
    // one run in each row of squares, of the length of the model: 1/(1 + 2 MARGIN) of the frame
    let path = svg
        .split(&format!("stroke=\"{}\"", colour(Tone::bright(LEVELS - 1))))
        .next()
        .unwrap();
    let path = path.rsplit("<path d=\"").next().unwrap();
    let runs: Vec<f64> = path
        .split('h')
        .skip(1)
        .map(|run| run.split(['M', '"']).next().unwrap().parse().unwrap())
        .collect();
    let rows = SQUARES / (1.0 + 2.0 * MARGIN);
    assert!((runs.len() as f64 - rows).abs() <= 1.0, "{}", runs.len());
    let size = HEIGHT - CAPTION - SPACE;
    let side = svg.split("scale(").nth(1).unwrap();
    let side: f64 = side.split(')').next().unwrap().parse().unwrap();
    for run in runs.iter().map(|run| side * run) {
        let exact = size / (1.0 + 2.0 * MARGIN);
        assert!((run - exact).abs() < 1.1 * size / SQUARES, "{run} {exact}");
    }
}

#[test]
fn an_obstacle_is_grey_where_its_gap_is_negative() {
    let floor = |_: f64, x: [f64; 3]| x[1] - 0.25;
    let scene = Scene {
        gap: &floor,
        ..scene(2)
    };
    let square = Patch {
        points: vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
        value: 0.0,
    };
    let svg = film_figure(&scene, &[frame(vec![square])]).unwrap();
    let path = svg.split("stroke=\"#d5d2cb\"").next().unwrap();
    let stripes = path
        .rsplit("<path d=\"")
        .next()
        .unwrap()
        .matches('h')
        .count() as f64;
    // a quarter of the square and the margin under it, one stripe to a pixel
    let size = HEIGHT - CAPTION - SPACE;
    let height = size * (0.25 + MARGIN) / (1.0 + 2.0 * MARGIN);
    assert!(
        (stripes * STRIPE - height).abs() <= 1.5,
        "{stripes} {height}"
    );
}

#[test]
fn the_bar_of_length_is_round_and_nothing_is_an_error() {
    for (length, round) in [(0.9, 0.5), (1.0, 1.0), (4.99, 2.0), (73.0, 50.0)] {
        assert!((round_length(length) / round - 1.0).abs() < 1e-12);
    }
    assert!(film_figure(&scene(2), &[]).is_err());
    assert!(film_figure(&scene(2), &[frame(Vec::new())]).is_err());
}
