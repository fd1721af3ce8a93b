use super::graph::is_permutation;
use super::*;
use crate::pattern::Cliques;
use carom_testing::Random;

/// Grid of cells with `dofs` unknowns per node; every third cell leaves its last node's first unknown out.
fn grid(cells: [usize; 3], dofs: usize) -> (Csr, Vec<u32>) {
    let [nx, ny, nz] = cells;
    let node = |x: usize, y: usize, z: usize| x + (nx + 1) * (y + (ny + 1) * z);
    let mut cliques = Cliques::new();
    for c in 0..nx * ny * nz.max(1) {
        let (x, y, z) = (c % nx, c / nx % ny, c / (nx * ny));
        let depth = if nz == 0 { 0..1 } else { 0..2 };
        let nodes = depth
            .flat_map(|k| [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| node(x + i, y + j, z + k)));
        let list: Vec<u32> = nodes
            .flat_map(|a| (0..dofs).map(move |d| (dofs * a + d) as u32))
            .collect();
        cliques.push(&list[usize::from(c % 3 == 0)..]);
    }
    let n = dofs * (nx + 1) * (ny + 1) * (nz + 1);
    (
        Csr::from_cliques(n, &cliques),
        (0..n).map(|i| (i / dofs) as u32).collect(),
    )
}

/// Places of the nodes of a grid of that shape, moved by up to `part` of an edge, and turned about two axes.
fn places(cells: [usize; 3], part: f64, turn: f64) -> Vec<[f64; 3]> {
    let [nx, ny, nz] = cells.map(|n| n + 1);
    let mut random = Random(1);
    let (s, c) = turn.sin_cos();
    let place = |k: usize| {
        let [x, y, z] =
            [k % nx, k / nx % ny, k / (nx * ny)].map(|x| x as f64 + part * random.next());
        let [x, y] = [c * x - s * y, s * x + c * y];
        [x, c * y - s * z, s * y + c * z]
    };
    (0..nx * ny * nz).map(place).collect()
}

/// Cubes of six tetrahedra each, three unknowns per node.
fn tetrahedra(cubes: [usize; 3]) -> (Csr, Vec<u32>) {
    let [nx, ny, nz] = cubes.map(|n| n + 1);
    let mut cliques = Cliques::new();
    for first in 0..nx * ny * nz {
        let inside = [first % nx, first / nx % ny, first / (nx * ny)];
        if inside.iter().zip(cubes).any(|(&k, n)| k == n) {
            continue;
        }
        let steps = [1, nx, nx * ny];
        for [i, j] in [[0, 1], [0, 2], [1, 0], [1, 2], [2, 0], [2, 1]] {
            let [b, c] = [first + steps[i], first + steps[i] + steps[j]];
            let nodes = [first, b, c, first + steps.iter().sum::<usize>()];
            let list: Vec<u32> = nodes
                .iter()
                .flat_map(|&a| (0..3).map(move |d| (3 * a + d) as u32))
                .collect();
            cliques.push(&list);
        }
    }
    let n = 3 * nx * ny * nz;
    let nodes = (0..n).map(|i| (i / 3) as u32).collect();
    (Csr::from_cliques(n, &cliques), nodes)
}

fn graph(matrix: &Csr, nodes: &[u32]) -> Graph {
    let unknowns: Vec<u32> = (0..matrix.n as u32).collect();
    Graph::new(matrix, &Groups::new(&unknowns, nodes))
}

fn cases() -> Vec<(Csr, Vec<u32>)> {
    let mut fixed = grid([6, 5, 4], 3);
    let marks: Vec<bool> = (0..fixed.0.n).map(|i| i % 4 == 1 || i < 50).collect();
    fixed.0 = fixed.0.with_identity(&marks).into_owned();
    vec![
        grid([1, 1, 0], 1),
        grid([40, 3, 0], 2),
        grid([7, 6, 5], 3),
        grid([15, 15, 15], 3),
        fixed,
    ]
}

/// Entries of the factor of the matrix eliminated in that order, from the patterns of its rows.
fn entries(matrix: &Csr, permutation: &[u32]) -> f64 {
    let unknowns: Vec<u32> = (0..matrix.n as u32).collect();
    let groups = Groups::new(&unknowns, &unknowns);
    Graph::new(matrix, &groups).work(permutation).entries
}

#[test]
fn orders_are_permutations_with_the_isolated_unknowns_last() {
    for (matrix, nodes) in cases() {
        let ordering = Ordering::new(&matrix, &nodes, None).unwrap();
        assert_eq!(ordering.permutation.len(), matrix.n);
        assert!(is_permutation(&ordering.permutation));
        for (k, &i) in ordering.permutation.iter().enumerate() {
            assert_eq!(matrix.row(i as usize).0.len() > 1, k < ordering.connected);
        }
    }
}

#[test]
fn the_elimination_tree_is_postordered() {
    for (matrix, nodes) in cases() {
        let ordering = Ordering::new(&matrix, &nodes, None).unwrap();
        let parent = elimination_tree(&matrix, &ordering.permutation[..ordering.connected]);
        // In a postorder a subtree is a run of positions that ends with its root.
        let mut first: Vec<usize> = (0..parent.len()).collect();
        let mut size = vec![1; parent.len()];
        for k in 0..parent.len() {
            assert_eq!(k + 1 - first[k], size[k]);
            if parent[k] != ROOT {
                let p = parent[k] as usize;
                assert!(p > k);
                first[p] = first[p].min(first[k]);
                size[p] += size[k];
            }
        }
    }
}

#[test]
fn postordering_keeps_the_fill() {
    let (matrix, nodes) = grid([7, 6, 5], 3);
    let groups = Groups::new(&(0..matrix.n as u32).collect::<Vec<_>>(), &nodes);
    let degree = Graph::new(&matrix, &groups)
        .minimum_degree(matrix.n)
        .unwrap();
    let expanded: Vec<u32> = degree
        .iter()
        .flat_map(|&g| groups.members(g))
        .copied()
        .collect();
    let before = entries(&matrix, &expanded);
    assert_eq!(entries(&matrix, &postordered(&matrix, expanded)), before);
}

#[test]
fn nested_dissection_is_kept_in_three_dimensions_only() {
    let name = |cells| {
        let (matrix, nodes) = grid(cells, 3);
        Ordering::new(&matrix, &nodes, None).unwrap().name
    };
    assert_eq!(name([15, 15, 15]), "nested dissection");
    assert_eq!(name([8, 8, 8]), "minimum degree");
    assert_eq!(name([80, 80, 0]), "minimum degree");
    assert_eq!(name([2000, 1, 1]), "minimum degree");
}

#[test]
fn what_is_no_permutation_is_recognised() {
    assert!(is_permutation(&[2, 0, 1]));
    assert!(is_permutation(&[]));
    assert!(!is_permutation(&[0, 0, 1]));
    assert!(!is_permutation(&[0, 1, 3]));
}

#[test]
fn a_dissection_by_planes_of_a_cube_takes_half_of_the_operations_of_minimum_degree_away() {
    let cells = [14, 14, 14];
    let (matrix, nodes) = grid(cells, 3);
    let graph = graph(&matrix, &nodes);
    let degree = graph.minimum_degree(matrix.n).unwrap();
    let (planes, _) = dissection::by_planes(&graph, &places(cells, 0.0, 0.0));
    assert!(is_permutation(&planes) && planes.len() == graph.len());
    let least = 0.5 * graph.work(&degree).operations;
    assert!(graph.work(&planes).operations <= least);
    // moved nodes stay in their layers
    let (planes, _) = dissection::by_planes(&graph, &places(cells, 0.15, 0.0));
    assert!(graph.work(&planes).operations <= least);
}

#[test]
fn places_never_make_an_order_worse() {
    let cells = [15, 14, 13];
    for (matrix, nodes) in [grid(cells, 3), tetrahedra(cells)] {
        let before = Ordering::new(&matrix, &nodes, None).unwrap().work()[1];
        for (part, turn) in [
            (0.0, 0.0),
            (0.15, 0.0),
            (0.15, 0.1),
            (0.0, 0.7),
            (0.15, 0.7),
        ] {
            let places = places(cells, part, turn);
            let place = |unknown: usize| places[nodes[unknown] as usize];
            let order = Ordering::new(&matrix, &nodes, Some(&place)).unwrap();
            assert!(is_permutation(&order.permutation));
            assert!(order.work()[1] <= before);
            if turn == 0.0 {
                assert_eq!(order.name, "nested dissection by planes");
            }
        }
    }
}

#[test]
fn the_graph_of_nodes_tells_the_work_of_the_matrix() {
    for cells in [[6, 5, 4], [15, 14, 13]] {
        let (matrix, node_of) = grid(cells, 3);
        let places = places(cells, 0.1, 0.0);
        // a side is held, and one unknown of each node of an edge
        let [nx, ny, _] = cells.map(|n| n + 1);
        let held: Vec<bool> = (0..matrix.n)
            .map(|i| i / 3 < nx * ny || (i / 3) % nx == 0 && i % 3 == 1)
            .collect();
        let matrix = matrix.with_identity(&held);
        let place = |unknown: usize| places[node_of[unknown] as usize];
        let order = Ordering::new(&matrix, &node_of, Some(&place)).unwrap();
        let mut weights = vec![0; places.len()];
        let mut cliques = Cliques::new();
        for i in (0..matrix.n).filter(|&i| !held[i]) {
            weights[node_of[i] as usize] += 1;
            for &j in matrix.row(i).0 {
                cliques.push(&[node_of[i], node_of[j as usize]]);
            }
        }
        let nodes = Csr::from_cliques(places.len(), &cliques);
        let place = |node: usize| places[node];
        let found = counted(&nodes, &weights, &place).unwrap();
        assert_eq!(found, (order.name, order.work()));
    }
}

#[test]
fn separators_of_layers_are_flat_and_others_are_not() {
    let cells = [15, 14, 13];
    for (matrix, nodes) in [grid(cells, 3), tetrahedra(cells)] {
        let graph = graph(&matrix, &nodes);
        let roughness = |part, turn| dissection::by_planes(&graph, &places(cells, part, turn)).1;
        assert_eq!(roughness(0.0, 0.0), 0.0);
        // a number from -0.15 to 0.15 is 0.075 on the mean, of a step of one
        let moved = roughness(0.15, 0.0);
        assert!((0.06..0.09).contains(&moved), "{moved}");
        assert!(roughness(0.0, 0.7) > 2.0 * FLAT);
        assert!(roughness(0.15, 0.1) > FLAT);
    }
}

#[test]
fn places_that_tell_nothing_do_no_harm() {
    let (matrix, nodes) = grid([9, 9, 9], 3);
    let graph = graph(&matrix, &nodes);
    for x in [0.0, f64::NAN, f64::INFINITY] {
        let places = vec![[x; 3]; graph.len()];
        let (order, roughness) = dissection::by_planes(&graph, &places);
        assert!(is_permutation(&order));
        assert_eq!(roughness, f64::INFINITY);
    }
}
