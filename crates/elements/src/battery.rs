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
        assert_eq!(element.reference.len(), element.nodes);
        assert!(element.nodes <= MAX_NODES);
        assert_eq!(Kind::from_gmsh(element.gmsh), Some(kind));
        for face in element.faces {
            assert_eq!(face.nodes.len(), face.kind.table().nodes);
            assert_eq!(face.kind.table().dim + 1, element.dim);
        }
    }
    assert_eq!(Kind::from_gmsh(0), None);
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
    // The shape functions are of degree one in each variable, so the difference is exact but for round-off.
    let h = 1e-3;
    for element in tables() {
        for xi in probes(element) {
            let dn = gradient(element, &xi);
            for j in 0..element.dim {
                let at = |side: f64| {
                    let mut xi = xi;
                    xi[j] += side * h;
                    shape(element, &xi)
                };
                for (a, (up, down)) in at(1.0).into_iter().zip(at(-1.0)).enumerate() {
                    let difference = (up - down) / (2.0 * h);
                    assert!((dn[a][j] - difference).abs() < 1e-12, "{}", element.name);
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

fn is_simplex(element: &Element) -> bool {
    element.dim > 1 && element.nodes == element.dim + 1
}

/// ∫ ξ^i η^j ζ^k over the reference cell, in closed form.
fn monomial(element: &Element, powers: [usize; 3]) -> f64 {
    if is_simplex(element) {
        let above: f64 = powers.iter().map(|&p| factorial(p)).product();
        return above / factorial(powers.iter().sum::<usize>() + element.dim);
    }
    let line = |p: usize| {
        if p.is_multiple_of(2) {
            2.0 / (p + 1) as f64
        } else {
            0.0
        }
    };
    powers[..element.dim].iter().map(|&p| line(p)).product()
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
                let degree = match is_simplex(element) {
                    true => powers.iter().sum(),
                    false => powers.into_iter().max().unwrap(),
                };
                let value = integrate(rule, |xi| {
                    (0..3).map(|i| xi[i].powi(powers[i] as i32)).product()
                });
                let error = (value - monomial(element, powers)).abs();
                if degree <= rule.degree {
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
        // N_a N_b has degree two, in each variable or in all.
        assert!(element.mass_rule.degree >= 2 || element.dim == 0);
        // Every entry of a stiffness matrix is a combination of the ∫ dN_a/dξ_i dN_b/dξ_j.
        for code in 0..9 * element.nodes * element.nodes {
            let (i, j) = (code % 3, code / 3 % 3);
            let (a, b) = (code / 9 % element.nodes, code / 9 / element.nodes);
            let product = |xi: &[f64; 3]| {
                let dn = gradient(element, xi);
                dn[a][i] * dn[b][j]
            };
            let exact = integrate(element.mass_rule, product);
            let found = integrate(element.stiffness_rule, product);
            assert!((found - exact).abs() < 1e-14, "{}", element.name);
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
            let beyond = [0, 1, 2].map(|i| centre[i] + 1.1 * (xi[i] - centre[i]));
            assert!((element.contains)(xi, 0.0));
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
fn the_jacobian_is_the_derivative_of_the_map() {
    let h = 1e-3;
    for element in tables() {
        let x = bent(element);
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
                    assert!((jacobian[i][j] - difference).abs() < 1e-11);
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
