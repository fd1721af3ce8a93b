//! What the output knows of a model in zones beside its system.

use carom_dynamics::{ModelBody, System};
use carom_pages::plot::Shape;
use carom_zones::Zoned;

/// Zones and weights of the bodies, in the order of the model.
#[derive(Clone, Debug, PartialEq)]
pub struct Zoning {
    /// Names of the zones.
    pub zones: Vec<String>,
    /// Steps of each zone to an outer one.
    pub substeps: Vec<u32>,
    /// Zone of each body.
    pub of_body: Vec<usize>,
    /// The bodies that links make one with each body, itself included, ascending.
    pub joined: Vec<Vec<usize>>,
    /// Mean weights α and δ of the cells of each body: 1 where a body is alone.
    pub weights: Vec<[Vec<f64>; 2]>,
}

impl Zoning {
    /// The zoning of a model.
    pub fn of(zoned: &Zoned) -> Zoning {
        let model = &zoned.model;
        let of_body = |body| {
            let mut zones = zoned.zones.iter();
            zones.position(|zone| zone.bodies.contains(&body))
        };
        // discrete elements are bodies after the others, in the zone of their nodes
        let discrete = model.discrete.iter().map(|some| {
            let cells = some.spec.cells.len();
            [vec![1.0; cells], vec![1.0; cells]]
        });
        let count = model.bodies.len() + model.discrete.len();
        let weights = |body: &ModelBody| {
            let cells = &body.spec.cells;
            match &body.spec.weights {
                Some(weights) => [&weights.inertia, &weights.stiffness]
                    .map(|values| carom_arlequin::means(&model.mesh, cells, values)),
                None => [vec![1.0; cells.len()], vec![1.0; cells.len()]],
            }
        };
        Zoning {
            zones: zoned.zones.iter().map(|zone| zone.name.clone()).collect(),
            substeps: zoned.zones.iter().map(|zone| zone.substeps).collect(),
            of_body: (0..count).map(|body| of_body(body).unwrap_or(0)).collect(),
            joined: joined(zoned),
            weights: model.bodies.iter().map(weights).chain(discrete).collect(),
        }
    }

    /// The cells for the picture of the model.
    pub(crate) fn shapes(&self, system: &System) -> Vec<Shape> {
        let mesh = &system.mesh;
        let mut shapes = Vec::new();
        // discrete elements come after the bodies
        let bodies = system.bodies.iter().zip(&self.weights).enumerate();
        for (number, (body, [inertia, stiffness])) in bodies {
            for (k, &cell) in body.cells().iter().enumerate() {
                let nodes = mesh.element_nodes(cell).iter();
                shapes.push(Shape {
                    zone: self.of_body[number],
                    points: nodes.map(|node| mesh.nodes[*node as usize]).collect(),
                    weights: [inertia[k], stiffness[k]],
                });
            }
        }
        shapes
    }

    /// Whether a body is a part of one that links join.
    pub(crate) fn is_part(&self, body: usize) -> bool {
        self.joined[body].len() > 1
    }

    /// Whether steps have parts.
    pub(crate) fn has_parts(&self) -> bool {
        self.substeps.iter().any(|steps| *steps > 1)
    }
}

/// The bodies that are one with each body by the links between their nodes.
fn joined(zoned: &Zoned) -> Vec<Vec<usize>> {
    let mesh = &zoned.model.mesh;
    let count = zoned.model.bodies.len() + zoned.model.discrete.len();
    let mut of_node = vec![Vec::new(); mesh.nodes.len()];
    for (number, body) in zoned.model.bodies.iter().enumerate() {
        for &cell in &body.spec.cells {
            for &node in mesh.element_nodes(cell) {
                let bodies = &mut of_node[node as usize];
                if bodies.last() != Some(&number) {
                    bodies.push(number);
                }
            }
        }
    }
    // the least body of its group stands for each
    let mut group: Vec<usize> = (0..count).collect();
    let mut met = Vec::new();
    for link in &zoned.links {
        for row in &link.rows {
            met.clear();
            for (zone, terms) in link.zones.iter().zip([&row.inner, &row.outer]) {
                let bodies = terms.iter().flat_map(|term| &of_node[term.node as usize]);
                let inside = bodies.filter(|body| zoned.zones[*zone].bodies.contains(body));
                met.extend(inside.map(|body| group[*body]));
            }
            let least = met.iter().min().copied();
            for of in group.iter_mut().filter(|of| met.contains(of)) {
                *of = least.unwrap_or(*of);
            }
        }
    }
    let members = |body: usize| {
        let all = 0..count;
        all.filter(|other| group[*other] == group[body]).collect()
    };
    (0..count).map(members).collect()
}
