//! Contact nodes without mass: their mass is redistributed over the body.
//!
//! A node without mass follows its equilibrium: it stops dead when it touches and leaves without a kick, so that the
//! displacement law neither oscillates nor gains energy. Along a bar, the mass m of the node goes to the two next nodes,
//! +2m and -m at equal distances, which keeps mass and centre of mass. In the plane and in space every other node of the
//! body takes part, `m_i ← m_i (1 + p(x_i))`, p the polynomial of degree two that keeps the mass, the centre of mass and
//! the moments of second order: the change that is least in `Σ (Δm_i)² / m_i` under these conditions. Where degree two
//! would leave a mass that is not positive, or the nodes lie on too few planes, the moments of second order are not kept.
//! A body of several pieces that share no node keeps all this in each of them.
//!
//! Source: Khenous, Laborde, Renard, European Journal of Mechanics A 27 (2008), mass redistribution under conservation of
//! mass, centre of mass and inertia; the weights of the least change are derived here.

use std::collections::BTreeMap;

use carom_algebra::unknowns::Unknowns;
use carom_bodies::{Body, MassKind};

use crate::error::Error;
use crate::mass::Mass;
use crate::model::{Model, ModelContact, ModelTarget};

/// Unknowns without mass, and the masses of the bodies brought in line with them.
///
/// # Errors
/// A body with consistent mass, or one whose other nodes cannot take the mass.
pub(crate) fn redistribute(
    model: &Model,
    bodies: &[Body],
    number: &[u32],
    (x, unknowns): (&[[f64; 3]], &Unknowns),
    (mass, body_masses): (&mut Mass, &mut [Vec<(u32, f64)>]),
) -> Result<Vec<u32>, Error> {
    let dim = model.mesh.dim;
    let mut bare = vec![false; x.len()];
    for contact in model.contacts.iter().filter(|contact| contact.massless) {
        for node in nodes(contact) {
            bare[number[node as usize] as usize] = true;
        }
    }
    for (k, masses) in body_masses.iter_mut().enumerate() {
        if let Body::Reduced(reduced) = &bodies[k] {
            let own = reduced.reduction();
            let mut retained = own
                .retained
                .iter()
                .map(|&node| number[node as usize] as usize);
            if own.is_massless {
                retained.for_each(|node| bare[node] = true);
            } else if retained.any(|node| bare[node]) {
                return Err(Error::Massless {
                    body: reduced.name().to_owned(),
                    cause: "its reduction leaves mass at the retained nodes; reduce it with massless = true",
                });
            }
            continue;
        }
        if !masses.iter().any(|&(node, _)| bare[node as usize]) {
            continue;
        }
        let Some(spec) = model.bodies.get(k) else {
            return Err(Error::Massless {
                body: bodies[k].name().to_owned(),
                cause: "a point mass has no other nodes that could take it",
            });
        };
        let refused = |cause| Error::Massless {
            body: spec.spec.name.clone(),
            cause,
        };
        if bodies[k].as_beam().is_some() {
            return Err(refused(
                "nodes of beams have rotations, whose inertia has no other node",
            ));
        }
        if spec.mass == MassKind::Consistent {
            return Err(refused(
                "its mass is consistent: only a lumped one can be redistributed",
            ));
        }
        let new = by_pieces(&bodies[k], masses, &bare, &|own| match dim {
            1 => along(&bodies[k], own, &bare, x),
            _ => spread(own, &bare, x, dim),
        });
        let new = new.ok_or_else(|| {
            refused("its other nodes are too few to take the mass of its contact nodes and keep the centre of mass")
        })?;
        for (&(node, old), m) in masses.iter().zip(&new) {
            for unknown in unknowns.translations_of(node) {
                mass.lumped[unknown] += m - old;
            }
        }
        for (entry, m) in masses.iter_mut().zip(new) {
            entry.1 = m;
        }
    }
    let without: Vec<u32> = (0..unknowns.len() as u32)
        .filter(|&unknown| bare[unknowns.node(unknown as usize) as usize])
        .collect();
    for &unknown in &without {
        mass.lumped[unknown as usize] = 0.0;
    }
    Ok(without)
}

/// New masses of nodes with these masses, if there are any.
type Spread<'a> = dyn Fn(&[(u32, f64)]) -> Option<Vec<f64>> + 'a;

/// New masses of a body: `one` gives those of a connected piece. Pieces without a bare node keep theirs.
fn by_pieces(body: &Body, masses: &[(u32, f64)], bare: &[bool], one: &Spread) -> Option<Vec<f64>> {
    let mut new: Vec<f64> = masses.iter().map(|(_, m)| *m).collect();
    for piece in pieces(body, masses, bare.len()) {
        let own: Vec<(u32, f64)> = piece.iter().map(|&place| masses[place]).collect();
        if !own.iter().any(|&(node, _)| bare[node as usize]) {
            continue;
        }
        for (place, m) in piece.into_iter().zip(one(&own)?) {
            new[place] = m;
        }
    }
    Some(new)
}

/// Places among the masses of the nodes of each connected piece of a body, ascending, in the order of their first nodes. `nodes`: their number in
/// the system.
fn pieces(body: &Body, masses: &[(u32, f64)], nodes: usize) -> Vec<Vec<usize>> {
    fn root(leader: &mut [u32], mut node: u32) -> u32 {
        while leader[node as usize] != node {
            leader[node as usize] = leader[leader[node as usize] as usize];
            node = leader[node as usize];
        }
        node
    }
    let mut leader: Vec<u32> = (0..nodes as u32).collect();
    body.each_element(&mut |own| {
        for pair in own.windows(2) {
            let [a, b] = [pair[0], pair[1]].map(|node| root(&mut leader, node));
            leader[a.max(b) as usize] = a.min(b);
        }
    });
    let mut of_leader: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for (place, &(node, _)) in masses.iter().enumerate() {
        let leader = root(&mut leader, node);
        of_leader.entry(leader).or_default().push(place);
    }
    of_leader.into_values().collect()
}

/// Mesh nodes of both surfaces of a contact.
fn nodes(contact: &ModelContact) -> impl Iterator<Item = u32> + '_ {
    let primary = match &contact.primary {
        ModelTarget::Surface(surface) => &surface.nodes[..],
        ModelTarget::Rigid(_) => &[],
    };
    contact.secondary.nodes.iter().chain(primary).copied()
}

/// New masses of a bar: that of a bare node goes to the two nodes that follow it.
fn along(body: &Body, masses: &[(u32, f64)], bare: &[bool], x: &[[f64; 3]]) -> Option<Vec<f64>> {
    let mut pairs = Vec::new();
    body.each_element(&mut |nodes| pairs.push([nodes[0], nodes[1]]));
    let beside = |node: u32, not: u32| {
        let other = |&[a, b]: &[u32; 2]| match node {
            n if n == a => Some(b),
            n if n == b => Some(a),
            _ => None,
        };
        pairs
            .iter()
            .filter_map(other)
            .find(|&other| other != not && !bare[other as usize])
    };
    let place = |node: u32| masses.iter().position(|&(other, _)| other == node);
    let mut new: Vec<f64> = masses.iter().map(|(_, m)| *m).collect();
    for (k, &(node, m)) in masses.iter().enumerate() {
        if !bare[node as usize] {
            continue;
        }
        let next = beside(node, node)?;
        let after = beside(next, node)?;
        let distance = |other: u32| (x[other as usize][0] - x[node as usize][0]).abs();
        let [one, two] = [distance(next), distance(after)];
        new[k] = 0.0;
        new[place(next)?] += m * two / (two - one);
        new[place(after)?] -= m * one / (two - one);
    }
    positive(new, masses, bare)
}

/// The masses if those of all nodes but the bare ones are positive.
fn positive(new: Vec<f64>, masses: &[(u32, f64)], bare: &[bool]) -> Option<Vec<f64>> {
    let mut kept = new
        .iter()
        .zip(masses)
        .filter(|(_, (node, _))| !bare[*node as usize]);
    kept.all(|(m, _)| *m > 0.0).then_some(new)
}

/// New masses of a body in the plane or in space: those of the other nodes times a polynomial.
fn spread(masses: &[(u32, f64)], bare: &[bool], x: &[[f64; 3]], dim: usize) -> Option<Vec<f64>> {
    let moments = moments(masses, x, dim);
    let linear = 1 + dim;
    [moments.len(), linear].into_iter().find_map(|count| {
        let new = least_change(masses, bare, &moments[..count], linear)?;
        positive(new, masses, bare)
    })
}

/// Values at the nodes of 1, of the coordinates and of their products, about the centre of mass and over the radius of
/// gyration.
fn moments(masses: &[(u32, f64)], x: &[[f64; 3]], dim: usize) -> Vec<Vec<f64>> {
    let total: f64 = masses.iter().map(|(_, m)| m).sum();
    let mean = |f: &dyn Fn(&[f64; 3]) -> f64| {
        let terms = masses.iter().map(|&(node, m)| m * f(&x[node as usize]));
        terms.sum::<f64>() / total
    };
    let centre = [0, 1, 2].map(|i| mean(&|x| x[i]));
    let radius = mean(&|x| (0..dim).map(|i| (x[i] - centre[i]).powi(2)).sum()).sqrt();
    let of_nodes = |f: &dyn Fn([f64; 3]) -> f64| -> Vec<f64> {
        let scaled = |node: u32| [0, 1, 2].map(|i| (x[node as usize][i] - centre[i]) / radius);
        masses.iter().map(|&(node, _)| f(scaled(node))).collect()
    };
    let mut functions = vec![of_nodes(&|_| 1.0)];
    functions.extend((0..dim).map(|i| of_nodes(&|x| x[i])));
    let products = (0..dim).flat_map(|i| (i..dim).map(move |j| (i, j)));
    functions.extend(products.map(|(i, j)| of_nodes(&|x| x[i] * x[j])));
    functions
}

/// The new masses that keep the sums of `functions` with the least change; `None` where one of the first `binding` sums
/// cannot be kept.
///
/// By Gram and Schmidt in the product weighted with the masses of the nodes that keep theirs: the change of the masses is
/// `m_i Σ c_k q_k(x_i)`, and the sum of each function gives one c after the other.
fn least_change(
    masses: &[(u32, f64)],
    bare: &[bool],
    functions: &[Vec<f64>],
    binding: usize,
) -> Option<Vec<f64>> {
    let weight = |k: usize| match bare[masses[k].0 as usize] {
        true => 0.0,
        false => masses[k].1,
    };
    let n = masses.len();
    let product = |f: &[f64], g: &[f64]| -> f64 { (0..n).map(|k| weight(k) * f[k] * g[k]).sum() };
    let mut change = vec![0.0; n];
    let mut basis: Vec<(Vec<f64>, f64)> = Vec::new();
    for (rank, function) in functions.iter().enumerate() {
        let mut missing: f64 = (0..n)
            .map(|k| (masses[k].1 - weight(k)) * function[k])
            .sum();
        let size = product(function, function).sqrt();
        let mut rest = function.clone();
        for (q, c) in &basis {
            let part = product(&rest, q);
            missing -= c * part;
            for k in 0..n {
                rest[k] -= part * q[k];
            }
        }
        let norm = product(&rest, &rest).sqrt();
        if norm <= 1e-8 * size {
            let bound = 1e-9 * masses.iter().map(|(_, m)| m).sum::<f64>();
            if rank < binding && missing.abs() > bound {
                return None;
            }
            continue;
        }
        let c = missing / norm;
        for k in 0..n {
            rest[k] /= norm;
            change[k] += c * weight(k) * rest[k];
        }
        basis.push((rest, c));
    }
    Some((0..n).map(|k| weight(k) + change[k]).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_change_keeps_mass_centre_and_inertia_of_a_block() {
        let nodes = 6usize;
        let mut x = Vec::new();
        let mut masses = Vec::new();
        let mut bare = Vec::new();
        for i in 0..nodes.pow(3) {
            let at = [i % nodes, i / nodes % nodes, i / nodes.pow(2)];
            let edges = at.iter().filter(|k| **k == 0 || **k == nodes - 1).count();
            x.push([
                0.1 * at[0] as f64,
                0.2 * at[1] as f64,
                3.0 + 0.1 * at[2] as f64,
            ]);
            masses.push((i as u32, 0.5_f64.powi(edges as i32)));
            bare.push(at[2] == 0);
        }
        let new = spread(&masses, &bare, &x, 3).unwrap();
        let sum = |f: &dyn Fn(&[f64; 3]) -> f64, m: &dyn Fn(usize) -> f64| -> f64 {
            (0..x.len()).map(|k| m(k) * f(&x[k])).sum()
        };
        let kept = |f: &dyn Fn(&[f64; 3]) -> f64| {
            let before = sum(f, &|k| masses[k].1);
            (sum(f, &|k| new[k]) - before).abs() < 1e-12 * before
        };
        assert!(kept(&|_| 1.0));
        for i in 0..3 {
            assert!(kept(&|x| x[i]));
            for j in 0..3 {
                assert!(kept(&|x| x[i] * x[j]));
            }
        }
        let bare_masses = new.iter().zip(&bare).filter(|(_, bare)| **bare);
        assert!(bare_masses.clone().count() > 0 && bare_masses.into_iter().all(|(m, _)| *m == 0.0));
    }

    #[test]
    fn two_layers_cannot_keep_the_centre_of_mass_without_one_of_them() {
        let x: Vec<[f64; 3]> = (0..4)
            .map(|i| [f64::from(i % 2), f64::from(i / 2), 0.0])
            .collect();
        let masses: Vec<(u32, f64)> = (0..4).map(|i| (i, 1.0)).collect();
        assert!(spread(&masses, &[true, true, false, false], &x, 2).is_none());
    }
}
