use super::*;
use crate::random::Random;

fn random_boxes(random: &mut Random, n: usize) -> Vec<Bounds> {
    let boxes = (0..n).map(|_| Bounds::of(&[random.point(1.0)]).widened(0.1 * random.unit()));
    boxes.collect()
}

fn assert_equals_brute_force(tree: &BoxTree, boxes: &[Bounds], random: &mut Random) {
    let mut found = vec![7];
    for _ in 0..50 {
        let (point, distance) = (random.point(1.5), random.unit());
        tree.near(&point, distance, &mut found);
        let near = |b: &Bounds| b.distance_squared(&point) <= distance * distance;
        assert_eq!(found, brute_force(boxes, near));
        // items are the corners of their boxes, but every third does not count
        let corner = |i: u32| match i % 3 {
            0 => f64::INFINITY,
            _ => Bounds::of(&[boxes[i as usize].min])
                .distance_squared(&point)
                .sqrt(),
        };
        let all = (0..boxes.len() as u32).map(|i| (i, corner(i)));
        let closest = all
            .filter(|(_, d)| *d <= distance)
            .min_by(|a, b| a.1.total_cmp(&b.1));
        assert_eq!(tree.closest(&point, distance, 0.0, corner), closest);
        let query = Bounds::of(&[random.point(1.0), random.point(1.0)]);
        tree.overlapping(&query, &mut found);
        assert_eq!(found, brute_force(boxes, |b| b.overlaps(&query)));
    }
}

fn brute_force(boxes: &[Bounds], test: impl Fn(&Bounds) -> bool) -> Vec<u32> {
    (0..boxes.len() as u32)
        .filter(|&i| test(&boxes[i as usize]))
        .collect()
}

#[test]
fn answers_equal_brute_force_before_and_after_motion() {
    let mut random = Random::new(1);
    for n in [0, 1, 3, 4, 5, 9, 64, 333] {
        let boxes = random_boxes(&mut random, n);
        let mut tree = BoxTree::new(&boxes);
        assert_eq!((tree.len(), tree.is_empty()), (n, n == 0));
        assert_equals_brute_force(&tree, &boxes, &mut random);
        let moved = random_boxes(&mut random, n);
        tree.refit(|item| moved[item as usize]);
        assert_equals_brute_force(&tree, &moved, &mut random);
    }
}

#[test]
fn boxes_with_one_centre_are_all_found() {
    let boxes = vec![Bounds::of(&[[1.0; 3]]); 100];
    let tree = BoxTree::new(&boxes);
    let mut found = Vec::new();
    tree.near(&[1.0, 1.0, 3.0], 2.0, &mut found);
    assert_eq!(found, (0..100).collect::<Vec<u32>>());
    tree.near(&[1.0, 1.0, 3.0], 1.999, &mut found);
    assert!(found.is_empty());
}

#[test]
fn a_search_looks_at_a_small_part_of_the_boxes() {
    // 32 x 32 unit squares; a point sees the four around it, and the nodes it takes grow with the depth of the
    // tree, not with the number of boxes.
    let boxes: Vec<Bounds> = (0..1024)
        .map(|i| [(i % 32) as f64, (i / 32) as f64, 0.0])
        .map(|x| Bounds::of(&[x, [x[0] + 1.0, x[1] + 1.0, 0.0]]))
        .collect();
    let tree = BoxTree::new(&boxes);
    let mut found = Vec::new();
    let place = [16.0, 16.0, 0.0];
    let test = |b: &Bounds| b.distance_squared(&place) <= 0.25;
    let looks = tree.collect(&Bounds::of(&[place]), 0.5, test, &mut found);
    assert_eq!(found, [495, 496, 527, 528]);
    // on each of four levels the four squares are in four nodes at most
    assert_eq!(tree.levels.len(), 4);
    assert!(looks <= 16, "{looks}");
}

#[test]
fn boxes_of_before_serve_items_that_moved_by_less_than_the_slack() {
    let mut random = Random::new(5);
    let boxes = random_boxes(&mut random, 200);
    let tree = BoxTree::new(&boxes);
    let step = random.point(0.1);
    let moved = 0.1 * 3.0_f64.sqrt();
    let place = |i: u32| [0, 1, 2].map(|k| boxes[i as usize].max[k] + step[k]);
    for _ in 0..100 {
        let point = random.point(1.5);
        let measure = |i: u32| Bounds::of(&[place(i)]).distance_squared(&point).sqrt();
        let all = (0..200).map(|i| (i, measure(i)));
        let closest = all.min_by(|a, b| a.1.total_cmp(&b.1));
        assert_eq!(tree.closest(&point, f64::INFINITY, moved, measure), closest);
    }
}

#[test]
fn motion_is_how_far_places_are_from_the_boxes_of_before() {
    let mut random = Random::new(9);
    let boxes = random_boxes(&mut random, 200);
    let tree = BoxTree::new(&boxes);
    let step = random.point(0.1);
    let size = Bounds::of(&[step]).distance_squared(&[0.0; 3]).sqrt();
    let there = |x: [f64; 3]| [0, 1, 2].map(|k| x[k] + step[k]);
    let moved = |i: u32| Bounds {
        min: there(boxes[i as usize].min),
        max: there(boxes[i as usize].max),
    };
    // sums of three squares of order one
    let found = tree.motion(0.2, moved).unwrap();
    assert!((found - size).abs() < 1e-15, "{found} {size}");
    assert_eq!(tree.motion(0.99 * size, moved), None);
    assert_eq!(tree.motion(0.0, |i| *tree.bounds(i)), Some(0.0));
}

#[test]
fn the_first_of_equals_is_the_closest() {
    let boxes = vec![Bounds::of(&[[1.0; 3]]); 100];
    let tree = BoxTree::new(&boxes);
    let far = |i: u32| if i < 37 { 2.5 } else { 2.0 };
    let from = [1.0, 1.0, 3.0];
    assert_eq!(tree.closest(&from, 5.0, 0.0, far), Some((37, 2.0)));
    assert_eq!(tree.closest(&from, 1.9, 0.0, far), None);
}

#[test]
fn looks_for_the_closest_grow_with_the_logarithm_of_the_number_of_boxes() {
    let looks = |side: usize| {
        let boxes: Vec<Bounds> = (0..side * side)
            .map(|i| [(i % side) as f64, (i / side) as f64, 0.0])
            .map(|x| Bounds::of(&[x, [x[0] + 1.0, x[1] + 1.0, 0.0]]))
            .collect();
        let tree = BoxTree::new(&boxes);
        let mut random = Random::new(6);
        let (mut looks, queries) = (0, 200);
        for _ in 0..queries {
            let p = random.point(0.5 * side as f64);
            let p = [p[0] + 0.5 * side as f64, p[1] + 0.5 * side as f64, 0.3];
            let from = tree.from(&Bounds::of(&[p]));
            let (mut limit, mut least) = (f32::MAX, f64::INFINITY);
            let top = (tree.levels.len() - 1, 0);
            looks += tree.descend(&from, &mut limit, top, &mut |i| {
                least = least.min(boxes[i as usize].distance_squared(&p).sqrt());
                Some(from.limit(least))
            });
            assert!(least < f64::INFINITY);
        }
        looks as f64 / f64::from(queries)
    };
    // 3 levels and 6: a place is in one node of each, and now and then near a few others
    let (few, many) = (looks(16), looks(256));
    assert!(many - few < 3.0 * 3.0, "{few} {many}");
    assert!(many < 3.0 * 6.0, "{many}");
}

#[test]
fn a_tree_whose_items_part_gets_loose() {
    let mut random = Random::new(7);
    let boxes = random_boxes(&mut random, 300);
    let mut tree = BoxTree::new(&boxes);
    assert_eq!(tree.looseness(), 1.0);
    let turned: Vec<Bounds> = (0..300).map(|i| boxes[(i * 7) % 300]).collect();
    tree.refit(|item| turned[item as usize]);
    assert!(tree.looseness() > 2.0, "{}", tree.looseness());
    assert_eq!(tree.bytes(), BoxTree::new(&turned).bytes());
}
