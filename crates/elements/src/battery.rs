//! What every element kind must satisfy, checked over [`Kind::ALL`].

use crate::{Element, Kind, MAX_NODES, Rule, map};

fn tables() -> impl Iterator<Item = &'static Element> {
    Kind::ALL.into_iter().map(Kind::table)
}

/// Points in and a little outside the cell: the nodes, the integration points, and some of no symmetry.
fn probes(element: &Element) -> Vec<[f64; 3]> {
    let odd = [[0.31, -0.17, 0.43], [0.11, 0.23, 0.07], [-0.6, 0.9, 1.1]];
    let mut points: Vec<[f64; 3]> = odd
        .iter()
        .map(|x| [0, 1, 2].map(|i| if i < element.dim { x[i] } else { 0.0 }))
        .collect();
    points.extend(element.reference);
    points.extend(element.mass_rule.points);
    points
}

fn shape(element: &Element, xi: &[f64; 3]) -> Vec<f64> {
    let mut n = vec![f64::NAN; element.nodes];
    (element.shape)(xi, &mut n);
    n
}

fn gradient(element: &Element, xi: &[f64; 3]) -> Vec<[f64; 3]> {
    let mut dn = vec![[f64::NAN; 3]; element.nodes];
    (element.gradient)(xi, &mut dn);
    dn
}

/// Node positions of a cell bent out of any special shape, still of positive Jacobian and filling its dimension.
fn bent(element: &Element) -> Vec<[f64; 3]> {
    let map = [[1.3, 0.2, -0.1], [0.3, 0.9, 0.2], [-0.2, 0.1, 1.1]];
    element
        .reference
        .iter()
        .map(|xi| {
            let bump = 0.1 * xi[0] * xi[1] + 0.07 * xi[1] * xi[2] - 0.05 * xi[0] * xi[2];
            [0, 1, 2].map(|i| {
                let linear: f64 = (0..3).map(|j| map[i][j] * xi[j]).sum();
                let x = 2.0 + linear + bump * (1.0 - 0.3 * i as f64);
                if i < element.dim { x } else { 0.0 }
            })
        })
        .collect()
}

fn volume(element: &Element, x: &[[f64; 3]]) -> f64 {
    let rule = element.mass_rule;
    let points = rule.points.iter().zip(rule.weights);
    points
        .map(|(xi, w)| w * map::jacobian(x, &gradient(element, xi), element.dim).1)
        .sum()
}

#[test]
fn the_table_is_consistent() {
    for (kind, element) in Kind::ALL.into_iter().zip(tables()) {
        assert_eq!(element.kind, kind);
        assert_eq!(element.nodes, kind.listed_nodes());
        assert_eq!(element.reference.len(), element.nodes);
        assert!(element.nodes <= MAX_NODES);
        assert_eq!(Kind::from_gmsh(element.gmsh), Some(kind));
        for order in [element.gmsh_order, element.vtk_order] {
            let mut places = order.to_vec();
            places.sort_unstable();
            assert_eq!(places, (0..element.nodes).collect::<Vec<_>>());
        }
        for face in element.faces {
            assert_eq!(face.nodes.len(), face.kind.table().nodes);
            assert_eq!(face.kind.table().dim + 1, element.dim);
        }
    }
    assert_eq!(Kind::from_gmsh(0), None);
}

#[test]
fn the_corners_are_the_nodes_of_the_linear_kind() {
    for element in tables() {
        let linear = element.linear.table();
        assert!(!linear.is_quadratic());
        assert_eq!(linear.reference, &element.reference[..linear.nodes]);
        assert_eq!(element.faces.len(), linear.faces.len());
        for (face, straight) in element.faces.iter().zip(linear.faces) {
            assert_eq!(face.kind.table().linear, straight.kind);
            assert_eq!(&face.nodes[..straight.nodes.len()], straight.nodes);
            // the others lie where the shape functions of the corners put them
            let corners: Vec<_> = straight
                .nodes
                .iter()
                .map(|&a| element.reference[a])
                .collect();
            for (&node, xi) in face.nodes.iter().zip(face.kind.table().reference) {
                let place = map::point(&corners, &shape(straight.kind.table(), xi));
                assert_eq!(place, element.reference[node], "{}", element.name);
            }
        }
    }
}

/// The point in the middle of some corners.
fn middle(element: &Element, corners: &[usize]) -> [f64; 3] {
    [0, 1, 2].map(|i| {
        let sum: f64 = corners.iter().map(|&a| element.reference[a][i]).sum();
        sum / corners.len() as f64
    })
}

/// Corners that the other nodes are in the middle of.
type Middles = &'static [&'static [usize]];

/// Edges, faces and centre of Gmsh's hexahedra.
const GMSH_HEX: Middles = &[
    &[0, 1],
    &[0, 3],
    &[0, 4],
    &[1, 2],
    &[1, 5],
    &[2, 3],
    &[2, 6],
    &[3, 7],
    &[4, 5],
    &[4, 7],
    &[5, 6],
    &[6, 7],
    &[0, 1, 2, 3],
    &[0, 1, 4, 5],
    &[0, 3, 4, 7],
    &[1, 2, 5, 6],
    &[2, 3, 6, 7],
    &[4, 5, 6, 7],
    &[0, 6],
];

#[test]
fn nodes_of_a_gmsh_file_are_where_gmsh_has_them() {
    // Gmsh's reference manual, "Node ordering"; the same in the coordinates that its interface gives.
    let cases: [(Kind, Middles); 4] = [
        (
            Kind::Tet10,
            &[&[0, 1], &[1, 2], &[0, 2], &[0, 3], &[2, 3], &[1, 3]],
        ),
        (Kind::Hex20, GMSH_HEX.split_at(12).0),
        (Kind::Hex27, GMSH_HEX),
        (
            Kind::Wedge15,
            &[
                &[0, 1],
                &[0, 2],
                &[0, 3],
                &[1, 2],
                &[1, 4],
                &[2, 5],
                &[3, 4],
                &[3, 5],
                &[4, 5],
            ],
        ),
    ];
    for (kind, middles) in cases {
        let element = kind.table();
        let corners = element.linear.table().nodes;
        assert_eq!(corners + middles.len(), element.nodes);
        for (a, &place) in element.gmsh_order.iter().enumerate() {
            let expected = match place.checked_sub(corners) {
                None => element.reference[place],
                Some(k) => middle(element, middles[k]),
            };
            assert_eq!(element.reference[a], expected, "{} {a}", element.name);
        }
    }
}

#[test]
fn nodes_of_a_vtk_file_are_where_vtk_has_them() {
    // The edge and face arrays of VTK's cell classes.
    let tet: Middles = &[&[0, 1], &[1, 2], &[2, 0], &[0, 3], &[1, 3], &[2, 3]];
    let wedge: Middles = &[
        &[0, 1],
        &[1, 2],
        &[2, 0],
        &[3, 4],
        &[4, 5],
        &[5, 3],
        &[0, 3],
        &[1, 4],
        &[2, 5],
    ];
    let hex: Middles = &[
        &[0, 1],
        &[1, 2],
        &[2, 3],
        &[3, 0],
        &[4, 5],
        &[5, 6],
        &[6, 7],
        &[7, 4],
        &[0, 4],
        &[1, 5],
        &[2, 6],
        &[3, 7],
        &[0, 4, 7, 3],
        &[1, 2, 6, 5],
        &[0, 1, 5, 4],
        &[3, 7, 6, 2],
        &[0, 3, 2, 1],
        &[4, 5, 6, 7],
        &[0, 6],
    ];
    let cases = [
        (Kind::Tet10, tet),
        (Kind::Hex20, hex.split_at(12).0),
        (Kind::Hex27, hex),
        (Kind::Wedge15, wedge),
    ];
    for (kind, middles) in cases {
        let element = kind.table();
        let corners = element.linear.table().nodes;
        for (k, middles) in middles.iter().enumerate() {
            let place = element.vtk_order.iter().position(|&p| p == corners + k);
            assert_eq!(element.reference[place.unwrap()], middle(element, middles));
        }
    }
    // VTK's wedge of six nodes has its first triangle turned outward.
    let element = Kind::Wedge6.table();
    let node = |place: usize| element.vtk_order.iter().position(|&p| p == place).unwrap();
    assert_eq!([0, 1, 2].map(node), element.faces[0].nodes);
}

#[test]
fn shape_functions_sum_to_one_and_their_gradients_to_zero() {
    for element in tables() {
        for xi in probes(element) {
            let sum: f64 = shape(element, &xi).iter().sum();
            assert!((sum - 1.0).abs() < 1e-14, "{}", element.name);
            for i in 0..3 {
                let sum: f64 = gradient(element, &xi).iter().map(|dn| dn[i]).sum();
                assert!(sum.abs() < 1e-14, "{}", element.name);
            }
        }
    }
}

#[test]
fn a_shape_function_is_one_at_its_node_and_zero_at_the_others() {
    for element in tables() {
        for (a, xi) in element.reference.iter().enumerate() {
            for (b, n) in shape(element, xi).into_iter().enumerate() {
                assert_eq!(n, if a == b { 1.0 } else { 0.0 }, "{}", element.name);
            }
        }
    }
}

#[test]
fn gradients_equal_central_differences() {
    // The shape functions are of degree two at most in each variable, so the difference is exact but for round-off.
    let h = 1e-3;
    for element in tables() {
        // The pyramid's are rational in ζ: a sixth of the third derivative is below 1 / (1 - ζ)^4, at most 1e4 here.
        let rational = element.kind == Kind::Pyramid5;
        let tolerance = if rational { 1e4 * h * h } else { 1e-12 };
        for xi in probes(element) {
            if rational && xi[2] > 0.9 {
                continue;
            }
            let dn = gradient(element, &xi);
            for j in 0..element.dim {
                let at = |side: f64| {
                    let mut xi = xi;
                    xi[j] += side * h;
                    shape(element, &xi)
                };
                for (a, (up, down)) in at(1.0).into_iter().zip(at(-1.0)).enumerate() {
                    let difference = (up - down) / (2.0 * h);
                    assert!(
                        (dn[a][j] - difference).abs() < tolerance,
                        "{}",
                        element.name
                    );
                }
            }
            assert!(
                dn.iter()
                    .all(|dn| dn[element.dim..].iter().all(|&x| x == 0.0))
            );
        }
    }
}

fn factorial(n: usize) -> f64 {
    (1..=n).map(|i| i as f64).product()
}

/// ∫ ξ^i η^j ζ^k over the reference cell, in closed form.
fn monomial(element: &Element, powers: [usize; 3]) -> f64 {
    let [i, j, k] = powers;
    let simplex = |powers: &[usize]| {
        let above: f64 = powers.iter().map(|&p| factorial(p)).product();
        above / factorial(powers.iter().sum::<usize>() + powers.len())
    };
    let line = |p: usize| {
        if p.is_multiple_of(2) {
            2.0 / (p + 1) as f64
        } else {
            0.0
        }
    };
    match element.linear {
        Kind::Tri3 => simplex(&[i, j]),
        Kind::Tet4 => simplex(&[i, j, k]),
        Kind::Wedge6 => simplex(&[i, j]) * line(k),
        Kind::Pyramid5 => {
            let along = factorial(k) * factorial(i + j + 2) / factorial(i + j + k + 3);
            line(i) * line(j) * along
        }
        _ => powers[..element.dim].iter().map(|&p| line(p)).product(),
    }
}

/// The degree of a monomial in the sense of [`Rule::degree`].
fn degree_of(element: &Element, [i, j, k]: [usize; 3]) -> usize {
    match element.linear {
        Kind::Tri3 | Kind::Tet4 | Kind::Pyramid5 => i + j + k,
        Kind::Wedge6 => (i + j).max(k),
        _ => i.max(j).max(k),
    }
}

/// Points and weights of high degree: five Gauss points along each direction of a cube that is pressed into the shape of
/// the cell. Exact for products of shape functions or of their gradients, the pyramid's included.
fn fine_rule(element: &Element) -> Vec<([f64; 3], f64)> {
    let root = |sign: f64| (5.0 + sign * (40.0f64 / 7.0).sqrt()).sqrt() / 3.0;
    let weight = |sign: f64| (322.0 - sign * 13.0 * 70.0f64.sqrt()) / 900.0;
    let line = [
        (-root(1.0), weight(1.0)),
        (-root(-1.0), weight(-1.0)),
        (0.0, 128.0 / 225.0),
        (root(-1.0), weight(-1.0)),
        (root(1.0), weight(1.0)),
    ];
    let points = (0..5usize.pow(element.dim as u32)).map(|code| {
        let (mut x, mut weight) = ([0.0; 3], 1.0);
        for (i, x) in x.iter_mut().enumerate().take(element.dim) {
            let (place, w) = line[code / 5usize.pow(i as u32) % 5];
            (*x, weight) = (place, weight * w);
        }
        pressed(element, x, weight)
    });
    points.collect()
}

/// The image of a point of [-1, 1]^d in the reference cell, and its weight times the determinant.
fn pressed(element: &Element, x: [f64; 3], weight: f64) -> ([f64; 3], f64) {
    let [r, s, t] = x.map(|x| 0.5 * (1.0 + x));
    match element.linear {
        Kind::Tri3 => ([r, s * (1.0 - r), 0.0], weight * (1.0 - r) / 4.0),
        Kind::Wedge6 => ([r, s * (1.0 - r), x[2]], weight * (1.0 - r) / 4.0),
        Kind::Tet4 => {
            let (y, z) = (s * (1.0 - r), t * (1.0 - r) * (1.0 - s));
            ([r, y, z], weight * (1.0 - r).powi(2) * (1.0 - s) / 8.0)
        }
        Kind::Pyramid5 => {
            let width = 1.0 - t;
            (
                [x[0] * width, x[1] * width, t],
                0.5 * weight * width.powi(2),
            )
        }
        _ => (x, weight),
    }
}

fn integrate(rule: &Rule, f: impl Fn(&[f64; 3]) -> f64) -> f64 {
    let points = rule.points.iter().zip(rule.weights);
    points.map(|(xi, w)| w * f(xi)).sum()
}

#[test]
fn rules_are_exact_to_their_degree_and_no_further() {
    for element in tables() {
        for rule in [element.stiffness_rule, element.mass_rule] {
            let top = rule.degree + 1;
            let mut fails_above = false;
            for code in 0..(top + 1).pow(element.dim as u32) {
                let digit = |i: u32| code / (top + 1).pow(i) % (top + 1);
                let powers = [digit(0), digit(1), digit(2)];
                let value = integrate(rule, |xi| {
                    (0..3).map(|i| xi[i].powi(powers[i] as i32)).product()
                });
                let error = (value - monomial(element, powers)).abs();
                if degree_of(element, powers) <= rule.degree {
                    assert!(error < 1e-14, "{} {powers:?}: {error:e}", element.name);
                } else {
                    fails_above |= error > 1e-5;
                }
            }
            assert!(fails_above || element.dim == 0, "{}", element.name);
        }
    }
}

#[test]
fn rules_integrate_what_they_are_for() {
    for element in tables() {
        let fine = fine_rule(element);
        let exact =
            |f: &dyn Fn(&[f64; 3]) -> f64| fine.iter().map(|(xi, w)| w * f(xi)).sum::<f64>();
        for code in 0..element.nodes * element.nodes {
            let (a, b) = (code % element.nodes, code / element.nodes);
            let product = |xi: &[f64; 3]| {
                let n = shape(element, xi);
                n[a] * n[b]
            };
            let found = integrate(element.mass_rule, product);
            assert!((found - exact(&product)).abs() < 1e-14, "{}", element.name);
            // Every entry of a stiffness matrix is a combination of the ∫ dN_a/dξ_i dN_b/dξ_j.
            for (i, j) in [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)] {
                let product = |xi: &[f64; 3]| {
                    let dn = gradient(element, xi);
                    dn[a][i] * dn[b][j]
                };
                let found = integrate(element.stiffness_rule, product);
                // entries reach 10, and so does their round-off
                assert!((found - exact(&product)).abs() < 1e-13, "{}", element.name);
            }
        }
    }
}

#[test]
fn integration_points_are_in_the_cell_with_positive_weights() {
    for element in tables() {
        for rule in [element.stiffness_rule, element.mass_rule] {
            assert_eq!(rule.points.len(), rule.weights.len());
            assert!(rule.weights.iter().all(|&w| w > 0.0));
            assert!(rule.points.iter().all(|xi| (element.contains)(xi, 0.0)));
        }
    }
}

#[test]
fn a_cell_contains_its_nodes_and_its_slack_but_no_more() {
    for element in tables().filter(|element| element.dim > 0) {
        let centre = map::point(
            element.reference,
            &vec![1.0 / element.nodes as f64; element.nodes],
        );
        for xi in element.reference {
            assert!((element.contains)(xi, 0.0));
        }
        for xi in element.linear.table().reference {
            let beyond = [0, 1, 2].map(|i| centre[i] + 1.1 * (xi[i] - centre[i]));
            assert!(!(element.contains)(&beyond, 0.0));
            assert!((element.contains)(&beyond, 0.2));
        }
    }
}

#[test]
fn the_gradient_in_space_of_a_linear_field_is_its_slope() {
    let slope = [0.7, -1.9, 2.3];
    for element in tables().filter(|element| element.dim > 0) {
        let x = bent(element);
        for xi in element.mass_rule.points {
            let dn = gradient(element, xi);
            let (jacobian, det) = map::jacobian(&x, &dn, element.dim);
            let mut out = vec![[0.0; 3]; element.nodes];
            map::physical_gradient(&jacobian, det, &dn, &mut out);
            for i in 0..element.dim {
                let field = |x: &[f64; 3]| (0..3).map(|k| slope[k] * x[k]).sum::<f64>();
                let found: f64 = x.iter().zip(&out).map(|(x, dn)| field(x) * dn[i]).sum();
                assert!((found - slope[i]).abs() < 1e-13, "{}", element.name);
            }
        }
    }
}

#[test]
fn second_gradients_equal_differences_of_gradients() {
    let h = 1e-4;
    for element in tables().filter(|element| matches!(element.dim, 1 | 2)) {
        for xi in probes(element) {
            let mut second = vec![[f64::NAN; 3]; element.nodes];
            map::second_gradient(element, &xi, &mut second);
            for (component, [i, j]) in [[0, 0], [1, 1], [0, 1], [1, 0]].into_iter().enumerate() {
                let at = |side: f64| {
                    let mut xi = xi;
                    xi[j] += side * h;
                    gradient(element, &xi)
                };
                for (a, (up, down)) in at(1.0).into_iter().zip(at(-1.0)).enumerate() {
                    let difference = (up[i] - down[i]) / (2.0 * h);
                    let found = second[a][component.min(2)];
                    assert!((found - difference).abs() < 1e-11, "{}", element.name);
                }
            }
        }
    }
}

#[test]
fn the_jacobian_is_the_derivative_of_the_map() {
    let h = 1e-3;
    for element in tables() {
        let x = bent(element);
        // The difference is exact but for round-off; for the pyramid see the test of the gradients, ζ < 0.55 here.
        let rational = element.kind == Kind::Pyramid5;
        let tolerance = if rational { 100.0 * h * h } else { 1e-11 };
        for xi in element.mass_rule.points {
            let (jacobian, _) = map::jacobian(&x, &gradient(element, xi), element.dim);
            for j in 0..element.dim {
                let at = |side: f64| {
                    let mut xi = *xi;
                    xi[j] += side * h;
                    map::point(&x, &shape(element, &xi))
                };
                let (up, down) = (at(1.0), at(-1.0));
                for i in 0..element.dim {
                    let difference = (up[i] - down[i]) / (2.0 * h);
                    assert!((jacobian[i][j] - difference).abs() < tolerance);
                }
            }
        }
    }
}

#[test]
fn face_normals_point_out_of_the_cell() {
    for element in tables().filter(|element| element.dim > 1) {
        let centre = map::point(
            element.reference,
            &vec![1.0 / element.nodes as f64; element.nodes],
        );
        for face in element.faces {
            let kind = face.kind.table();
            let x: Vec<_> = face.nodes.iter().map(|&a| element.reference[a]).collect();
            let xi = &kind.stiffness_rule.points[0];
            let (_, normal) = map::measure(&x, &gradient(kind, xi), kind.dim);
            let point = map::point(&x, &shape(kind, xi));
            let outward: f64 = (0..3).map(|i| normal[i] * (point[i] - centre[i])).sum();
            assert!(outward > 0.1, "{} {:?}", element.name, face.nodes);
        }
    }
    // The faces of a bar carry no normal of their own; their order is the convention.
    let faces = Kind::Bar2.table().faces;
    assert_eq!([faces[0].nodes, faces[1].nodes], [[0], [1]]);
}

#[test]
fn the_volume_of_a_bent_cell_is_the_flux_of_x_through_its_faces() {
    // ∫ div x dV = dim V = Σ ∫ x·m dΓ: closes only if every face is there once and turned outward. The rules are
    // exact for both sides: per variable, degree two.
    for element in tables().filter(|element| element.dim > 1) {
        let x = bent(element);
        let mut flux = 0.0;
        for face in element.faces {
            let kind = face.kind.table();
            let x: Vec<_> = face.nodes.iter().map(|&a| x[a]).collect();
            flux += integrate(kind.mass_rule, |xi| {
                let (factor, normal) = map::measure(&x, &gradient(kind, xi), kind.dim);
                let point = map::point(&x, &shape(kind, xi));
                factor * (0..3).map(|i| point[i] * normal[i]).sum::<f64>()
            });
        }
        let volume = volume(element, &x);
        assert!(volume > 0.1);
        assert!((flux - element.dim as f64 * volume).abs() < 1e-13 * flux.abs());
    }
}

#[test]
fn a_degenerate_face_has_no_measure_and_no_normal() {
    let x = [[1.0, 2.0, 3.0]; 3];
    let dn = gradient(Kind::Tri3.table(), &[0.0; 3]);
    assert_eq!(map::measure(&x, &dn, 2), (0.0, [0.0; 3]));
}
