//! Linear functionals of the motion: the component of a node, the mean of a group.

use carom_contact::{Point, Rows, Search, Target};
use carom_dynamics::{Motion, Order, System};

use crate::Error;
use crate::results::{Probe, Reference};

/// Names of the components.
pub(crate) const COMPONENTS: [&str; 3] = ["x", "y", "z"];

/// Σ c · q over nodes of their displacements, velocities or accelerations q.
#[derive(Clone, Debug)]
pub struct Sensor {
    terms: Vec<(u32, [f64; 3])>,
}

impl Sensor {
    /// The component along `axis` (unit vector) of the motion of a node (system number).
    fn node(node: u32, axis: [f64; 3]) -> Sensor {
        Sensor {
            terms: vec![(node, axis)],
        }
    }

    /// Its nodes.
    pub fn nodes(&self) -> impl Iterator<Item = u32> + '_ {
        self.terms.iter().map(|(node, _)| *node)
    }

    /// The value in a motion.
    pub fn of(&self, system: &System, motion: &Motion, order: Order) -> f64 {
        let products = self.terms.iter().map(|(node, c)| {
            let q = system.of_node(*node, motion, order);
            c[0] * q[0] + c[1] * q[1] + c[2] * q[2]
        });
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
                let mut c = [0.0; 3];
                c[i] = weight / total;
                (*node, c)
            })
            .collect(),
    };
    Ok((0..system.dim).map(component).collect())
}

/// The contact point whose motion is drawn.
#[derive(Clone, Debug)]
pub struct ContactPoint {
    /// Index of the contact.
    pub contact: usize,
    /// Direction in which the motion is measured.
    pub axis: [f64; 3],
    /// Name of the side and its motion along the axis: the secondary node, and the primary node unless that side is
    /// rigid.
    pub sides: Vec<(String, Sensor)>,
}

/// The secondary node nearest the centroid of the surface (of its points, weighted by their areas), and the primary
/// node nearest to that one, unless it is the same; of the contact `chosen`, else of that of the exact solution, else of the first one. The axis is
/// that of the exact solution, else the normal at the point, turned so that its largest component is positive.
pub fn contact_point(
    system: &System,
    reference: Option<&Reference>,
    chosen: Option<usize>,
) -> Option<ContactPoint> {
    let index = chosen.or(reference.map(|reference| reference.contact));
    let index = index.unwrap_or(0);
    let contact = system.contacts.get(index)?;
    let own = || contact.points.iter().filter(|point| !point.is_on_primary());
    let total: f64 = own().map(|point| point.area).sum();
    let at_rest = vec![0.0; system.unknowns()];
    let places = system.places(0.0, &at_rest, &system.initial.frames);
    let mut centroid = [0.0; 3];
    for point in own() {
        let place = point.place(&places);
        for i in 0..3 {
            centroid[i] += point.area / total * place[i];
        }
    }
    let secondary = nearest(system, own().map(Point::node), &centroid)?;
    let place = system.x[secondary as usize];
    let primary = match &contact.target {
        Target::Rigid(_) => None,
        Target::Surface(_) => {
            let corners = contact
                .primary_faces()
                .iter()
                .flat_map(|face| face.corners().iter().copied());
            // of a surface that faces itself both would be the same node, or neighbours
            let part =
                |node: u32| system.part_of(system.unknowns.first(system.unknowns.moved_by(node)));
            let faces_itself = contact.has_both_sides() && !contact.looks_both_ways();
            let own = faces_itself.then(|| part(secondary));
            nearest(
                system,
                corners.filter(|&node| own != Some(part(node))),
                &place,
            )
            .filter(|&node| node != secondary)
        }
    };
    let axis = match reference {
        Some(reference) => reference.axis,
        None => normal(system, index, secondary, primary),
    };
    let contact = &system.contacts[index];
    let mut names = [Some(contact.secondary_body), contact.primary_body]
        .map(|body| body.map(|b| system.bodies[b].name()));
    if names[0] == names[1] || system.is_of_many(index) {
        names = [Some("secondary"), Some("primary")];
    }
    let nodes = [Some(secondary), primary].into_iter().zip(names);
    let side = |(node, name): (Option<u32>, Option<&str>)| {
        let sensor = Sensor::node(node?, axis);
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

/// Normal at a secondary node at the start, or at the place between nodes that is nearer to what it faces than any node is; where nothing faces anything
/// yet, the way to the primary node.
fn normal(system: &System, contact: usize, secondary: u32, primary: Option<u32>) -> [f64; 3] {
    let places = system.places(0.0, &system.initial.displacement, &system.initial.frames);
    let mut rows = Rows::default();
    rows.clear();
    let contact = &system.contacts[contact];
    contact.pair(&places, &mut Search::default(), &mut rows);
    let points = contact.points.iter().enumerate();
    let mut normals = points
        .filter(|(_, point)| point.node() == secondary)
        .map(|(point, _)| rows.normal(point));
    let mut n = normals.find(|n| *n != [0.0; 3]).unwrap_or_default();
    let nearest = (0..rows.len()).min_by(|&a, &b| rows.gap(a).total_cmp(&rows.gap(b)));
    let between =
        |&point: &usize| rows.gap(point).is_finite() && contact.points[point].stands_between();
    if let Some(point) = nearest.filter(between) {
        n = rows.normal(point);
    }
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
