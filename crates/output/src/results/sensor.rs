//! Linear functionals of the motion: the component of a node, the mean of a group.

use carom_contact::{Places, Point, Rows, Search, Target};
use carom_dynamics::System;

use crate::Error;
use crate::results::{Probe, Reference};

/// Names of the components.
pub(crate) const COMPONENTS: [&str; 3] = ["x", "y", "z"];

/// Σ c_i q_i of a system vector q (displacement, velocity or acceleration).
#[derive(Clone, Debug)]
pub(crate) struct Sensor {
    terms: Vec<(u32, f64)>,
}

impl Sensor {
    /// The component along `axis` (unit vector) of the motion of a node (system number).
    fn node(system: &System, node: u32, axis: [f64; 3]) -> Sensor {
        let unknowns = system.unknowns.translations_of(node);
        let terms = unknowns.zip(axis).map(|(i, c)| (i as u32, c));
        Sensor {
            terms: terms.filter(|(_, c)| *c != 0.0).collect(),
        }
    }

    /// The value for a system vector.
    pub(crate) fn of(&self, vector: &[f64]) -> f64 {
        let products = self.terms.iter().map(|&(i, c)| c * vector[i as usize]);
        products.sum()
    }
}

/// Sensors of a probe: the weighted mean motion of its nodes, one per component of the system.
///
/// # Errors
/// [`Error::Probe`] if none of its nodes belongs to a body.
pub(crate) fn of_probe(system: &System, probe: &Probe) -> Result<Vec<Sensor>, Error> {
    let numbers = probe.nodes.iter();
    let numbers = numbers.map(|&(node, weight)| (system.number[node as usize], weight));
    let nodes: Vec<(u32, f64)> = numbers.filter(|(node, _)| *node != u32::MAX).collect();
    let total: f64 = nodes.iter().map(|(_, weight)| weight).sum();
    if nodes.is_empty() {
        return Err(Error::Probe {
            name: probe.name.clone(),
        });
    }
    let component = |i: usize| Sensor {
        terms: nodes
            .iter()
            .map(|(node, weight)| {
                let unknown = system.unknowns.first(*node) + i;
                (unknown as u32, weight / total)
            })
            .collect(),
    };
    Ok((0..system.dim).map(component).collect())
}

/// The contact point whose motion is drawn.
#[derive(Clone, Debug)]
pub(crate) struct ContactPoint {
    /// Index of the contact.
    pub(crate) contact: usize,
    /// Direction in which the motion is measured.
    pub(crate) axis: [f64; 3],
    /// Name of the side and its motion along the axis: the secondary node, and the primary node unless that side is
    /// rigid.
    pub(crate) sides: Vec<(String, Sensor)>,
}

/// The secondary node nearest the centroid of the surface (of its points, weighted by their areas), and the primary
/// node nearest to that one; of the contact `chosen`, else of that of the exact solution, else of the first one. The axis is
/// that of the exact solution, else the normal at the point, turned so that its largest component is positive.
pub(crate) fn contact_point(
    system: &System,
    reference: Option<&Reference>,
    chosen: Option<usize>,
) -> Option<ContactPoint> {
    let index = chosen.or(reference.map(|reference| reference.contact));
    let index = index.unwrap_or(0);
    let contact = system.contacts.get(index)?;
    let total: f64 = contact.points.iter().map(|point| point.area).sum();
    let at_rest = vec![0.0; system.unknowns()];
    let places = Places {
        unknowns: &system.unknowns,
        time: 0.0,
        x: &system.x,
        u: &at_rest,
    };
    let mut centroid = [0.0; 3];
    for point in &contact.points {
        let place = point.place(&places);
        for i in 0..3 {
            centroid[i] += point.area / total * place[i];
        }
    }
    let secondary = nearest(system, contact.points.iter().map(Point::node), &centroid)?;
    let place = system.x[secondary as usize];
    let primary = match &contact.target {
        Target::Rigid(_) => None,
        Target::Surface(faces) => {
            let corners = faces.iter().flat_map(|face| face.corners().iter().copied());
            nearest(system, corners, &place)
        }
    };
    let axis = match reference {
        Some(reference) => reference.axis,
        None => normal(system, index, secondary, primary),
    };
    let (body, other) = system.sides[index];
    let mut names = [Some(body), other].map(|body| body.map(|b| system.bodies[b].name()));
    if names[0] == names[1] {
        names = [Some("secondary"), Some("primary")];
    }
    let nodes = [Some(secondary), primary].into_iter().zip(names);
    let side = |(node, name): (Option<u32>, Option<&str>)| {
        let sensor = Sensor::node(system, node?, axis);
        Some((name.unwrap_or("primary").to_owned(), sensor))
    };
    Some(ContactPoint {
        contact: index,
        axis,
        sides: nodes.filter_map(side).collect(),
    })
}

/// The node nearest to a place; the first of equals.
fn nearest(system: &System, nodes: impl Iterator<Item = u32>, to: &[f64; 3]) -> Option<u32> {
    let squared = |node: u32| {
        let x = system.x[node as usize];
        (0..3).map(|i| (x[i] - to[i]).powi(2)).sum::<f64>()
    };
    nodes.min_by(|a, b| squared(*a).total_cmp(&squared(*b)))
}

/// Normal at a secondary node at the start; where it faces nothing yet, the way to the primary node.
fn normal(system: &System, contact: usize, secondary: u32, primary: Option<u32>) -> [f64; 3] {
    let places = Places {
        unknowns: &system.unknowns,
        time: 0.0,
        x: &system.x,
        u: &system.initial_displacement,
    };
    let mut rows = Rows::default();
    rows.clear();
    let contact = &system.contacts[contact];
    contact.pair(&places, &mut Search::default(), &mut rows);
    let point = contact.points.iter().position(|p| p.node() == secondary);
    let mut n = point.map_or([0.0; 3], |point| rows.normal(point));
    if let Some(primary) = primary.filter(|_| n == [0.0; 3]) {
        n = [0, 1, 2].map(|i| system.x[primary as usize][i] - system.x[secondary as usize][i]);
    }
    let length = n.iter().map(|c| c * c).sum::<f64>().sqrt();
    if length == 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let largest = n
        .iter()
        .fold(0.0_f64, |m, c| if c.abs() > m.abs() { *c } else { m });
    n.map(|c| c / length * largest.signum())
}
