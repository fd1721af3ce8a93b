//! The cores of the bodies and of the rigid shapes of a system, which are not to pass through each other.

use std::collections::BTreeMap;

use carom_bodies::{Body, Kinematics};
use carom_contact::certificate::Core;
use carom_contact::{Cylinder, Obstacle, Shape, Side, Sphere, Target};
use carom_elements::Kind;
use carom_mesh::{ElementId, Face, Parts, Surface};

use crate::system::System;

type Vec3 = [f64; 3];

/// Depth of a vertex of a core below the surface, over the size of the elements normal to it.
pub const DEPTH: f64 = 0.05;

/// Distance that others keep from a vertex, over its depth.
const KEPT: f64 = 0.05;

/// Part of half a thickness that others are to stay out of.
const HALF: f64 = 0.5;

/// Part of half the thickness of a shell or a beam that the core of a solid may be below its surface against it: a point of the solid that has passed the
/// middle faces the other side.
const WITHIN: f64 = 0.25;

/// The same of the radius of a rigid shape.
const OF_RADIUS: f64 = 0.9;

/// Half the length of the axis of a rigid cylinder, over that of the model.
const AXIS: f64 = 100.0;

/// The core of a body, or of the rigid shape that a contact is with.
#[derive(Clone, Debug)]
pub struct CoreOf {
    /// The core.
    pub core: Core,
    /// Whose it is.
    pub owner: CoreOwner,
}

/// Whose a core is.
#[derive(Clone, Debug)]
pub enum CoreOwner {
    /// A body, by its number.
    Body(usize),
    /// The rigid shape of a contact, by the number of that, with the vertices of its core at time 0, m.
    Shape(usize, Vec<[f64; 3]>),
}

impl System {
    /// The cores of all bodies with cells, but for those whose elements are deleted, and of spheres and cylinders that bodies stay outside of. A
    /// body in pieces has a core for each that shares no nodes with the others, not through other bodies either. None where there is one alone.
    ///
    /// A vertex of a solid is 1/20 of the size of its elements below the surface: `x + mean of α (c - x)` over the elements around it, c the middle of
    /// an element, α the depth over the part of the element that c is above a face. That of a shell or a beam is the node, from which
    /// others keep half the way to the surface.
    pub fn cores(&self) -> Vec<CoreOf> {
        let cells = self.bodies.iter().flat_map(|body| body.cells());
        let parts = Parts::new(&self.mesh, cells.copied());
        let mut pieces: BTreeMap<(usize, Option<u32>), Vec<ElementId>> = BTreeMap::new();
        for (number, body) in self.bodies.iter().enumerate() {
            for &cell in body.cells() {
                let first = self.mesh.element_nodes(cell)[0];
                let piece = (number, parts.of(first));
                pieces.entry(piece).or_default().push(cell);
            }
        }
        let contacts = self.contacts.iter().enumerate();
        let shapes = contacts.filter_map(|(number, contact)| match &contact.target {
            Target::Rigid(obstacle) => self.core_of_shape(number, obstacle),
            Target::Surface(_) => None,
        });
        let shapes: Vec<CoreOf> = shapes.collect();
        // one alone meets nothing
        if pieces.len() + shapes.len() < 2 {
            return Vec::new();
        }
        let of_pieces = pieces.into_iter().filter_map(|((number, _), cells)| {
            Some(CoreOf {
                core: self.core_of(&self.bodies[number], &cells)?,
                owner: CoreOwner::Body(number),
            })
        });
        of_pieces.chain(shapes).collect()
    }

    fn core_of(&self, body: &Body, cells: &[ElementId]) -> Option<Core> {
        if body.as_discrete().is_some() || body.has_deletion() {
            return None;
        }
        let dim = |cell: &ElementId| self.mesh.kind(*cell).table().dim;
        let fills = cells.iter().all(|cell| dim(cell) == self.mesh.dim);
        match fills {
            true => Some(self.below_surface(cells)),
            false => self.about_middle(body, cells),
        }
    }

    /// Of cells that fill the space.
    fn below_surface(&self, cells: &[ElementId]) -> Core {
        let surface = Surface::outer(&self.mesh, cells);
        let mut around: Vec<Vec<ElementId>> = vec![Vec::new(); surface.nodes.len()];
        for &cell in cells {
            for &node in self.mesh.element_nodes(cell) {
                if let Some(place) = surface.index_of(node) {
                    around[place].push(cell);
                }
            }
        }
        let mut normals: Vec<Vec<Vec3>> = vec![Vec::new(); surface.nodes.len()];
        for face in &surface.faces {
            let normal = self.outward(face);
            for &node in face.corners() {
                if let Some(place) = surface.index_of(node) {
                    normals[place].push(normal);
                }
            }
        }
        let vertices = surface.nodes.iter().zip(around.iter().zip(&normals));
        let vertices: Vec<(Vec<(u32, f64)>, f64)> = vertices
            .map(|(&node, (cells, normals))| self.vertex(node, cells, normals))
            .collect();
        let patches = surface.faces.iter().map(|face| {
            let corners = face.corners().iter();
            let corners = corners.map(|&node| surface.index_of(node).unwrap_or_default() as u32);
            (face.kind, corners.collect())
        });
        let patches: Vec<(Kind, Vec<u32>)> = patches.collect();
        self.made(&vertices, &patches)
    }

    /// The unit normal of a face of a cell, out of that.
    fn outward(&self, face: &Face) -> Vec3 {
        let x = &self.mesh.nodes;
        let linear = face.kind.table().linear.table();
        let corners = &face.corners()[..linear.nodes];
        if corners.len() == 1 {
            return face.axis;
        }
        let from = x[corners[0] as usize];
        let side = |node: u32| [0, 1, 2].map(|i| x[node as usize][i] - from[i]);
        let mut normal = [0.0; 3];
        for pair in corners[1..].windows(2) {
            let part = cross(&side(pair[0]), &side(pair[1]));
            normal = [0, 1, 2].map(|i| normal[i] + part[i]);
        }
        if let [_, other] = corners {
            normal = cross(&side(*other), &[0.0, 0.0, 1.0]);
        }
        let middle = self.middle(face.parent);
        let inward = [0, 1, 2].map(|i| middle[i] - from[i]);
        let sign = if dot(&normal, &inward) > 0.0 {
            -1.0
        } else {
            1.0
        };
        let size = dot(&normal, &normal).sqrt().max(f64::MIN_POSITIVE);
        normal.map(|n| sign * n / size)
    }

    fn middle(&self, cell: ElementId) -> Vec3 {
        let nodes = self.mesh.element_nodes(cell);
        let places = nodes.iter().map(|&node| self.mesh.nodes[node as usize]);
        let sum = places.fold([0.0; 3], |sum, x| [0, 1, 2].map(|i| sum[i] + x[i]));
        sum.map(|sum: f64| sum / nodes.len() as f64)
    }

    /// The weights of a vertex below a node of the mesh, that of the node first, with the distance that others keep from it, m.
    ///
    /// At an inner corner, where the mean of the ways to the middles of the cells leads out of the body, it is on the way to the neighbour that is furthest
    /// below all faces there, if any is.
    fn vertex(&self, node: u32, cells: &[ElementId], normals: &[Vec3]) -> (Vec<(u32, f64)>, f64) {
        let share = 1.0 / cells.len() as f64;
        let alpha = |cell: ElementId| DEPTH / height_of_middle(self.mesh.kind(cell).table().linear);
        let mut weights = BTreeMap::from([(node, 1.0)]);
        for &cell in cells {
            let (alpha, nodes) = (share * alpha(cell), self.mesh.element_nodes(cell));
            *weights.entry(node).or_default() -= alpha;
            for &other in nodes {
                *weights.entry(other).or_default() += alpha / nodes.len() as f64;
            }
        }
        let mut shift = self.shift(node, &weights);
        let is_out = |way: &Vec3| dot(way, way) == 0.0 || below(way, normals) <= 0.0;
        if is_out(&shift) {
            // a neighbour is twice as far as the middle
            let alpha = cells
                .iter()
                .map(|&cell| 0.5 * share * alpha(cell))
                .sum::<f64>();
            let neighbours = weights.keys().filter(|other| **other != node);
            let ways =
                neighbours.map(|&other| BTreeMap::from([(node, 1.0 - alpha), (other, alpha)]));
            let depth = |way: &BTreeMap<u32, f64>| below(&self.shift(node, way), normals);
            let ways = ways.filter(|way| !is_out(&self.shift(node, way)));
            let best = ways.reduce(|best, way| match depth(&way) > depth(&best) {
                true => way,
                false => best,
            });
            weights = best.unwrap_or(weights);
            shift = self.shift(node, &weights);
        }
        let depth = dot(&shift, &shift).sqrt();
        let own = weights.remove(&node).map(|weight| (node, weight));
        let numbered = own
            .into_iter()
            .chain(weights)
            .map(|(node, weight)| (self.number[node as usize], weight));
        (numbered.collect(), KEPT * depth)
    }

    /// From a node to where weights put a vertex, m.
    fn shift(&self, node: u32, weights: &BTreeMap<u32, f64>) -> Vec3 {
        let x = &self.mesh.nodes;
        [0, 1, 2].map(|i| {
            let parts = weights
                .iter()
                .map(|(&other, weight)| weight * (x[other as usize][i] - x[node as usize][i]));
            parts.sum::<f64>()
        })
    }

    /// Of axes and middles, and what others keep from them; none of beams beside their nodes.
    fn about_middle(&self, body: &Body, cells: &[ElementId]) -> Option<Core> {
        let half = match body {
            Body::Beam(beam) => match beam.section().offset == [0.0; 2] {
                true => beam.section().radius.unwrap_or(0.0),
                false => return None,
            },
            Body::LargeBeam(beam) => match beam.small().section().offset == [0.0; 2] {
                true => beam.small().section().radius.unwrap_or(0.0),
                false => return None,
            },
            Body::Shell(shell) => 0.5 * shell.thickness_range()[0],
            Body::Solid(solid) if !matches!(solid.kinematics(), Kinematics::Bar { .. }) => {
                return None;
            }
            _ => 0.0,
        };
        let mut places = BTreeMap::new();
        let mut vertices = Vec::new();
        let mut patches = Vec::new();
        for &cell in cells {
            let corners = self.mesh.element_nodes(cell).iter().map(|&node| {
                *places.entry(node).or_insert_with(|| {
                    vertices.push((vec![(self.number[node as usize], 1.0)], HALF * half));
                    vertices.len() as u32 - 1
                })
            });
            patches.push((self.mesh.kind(cell), corners.collect()));
        }
        let core = self.made(&vertices, &patches);
        Some(core.with_depth(WITHIN * half))
    }

    /// Of spheres and cylinders that bodies stay outside of: of others no part comes between nodes unseen, or their faces tell.
    fn core_of_shape(&self, contact: usize, obstacle: &Obstacle) -> Option<CoreOf> {
        let (places, radius) = match &obstacle.shape {
            Shape::Sphere(Sphere {
                centre,
                radius,
                side: Side::Outside,
            }) => (vec![*centre], *radius),
            Shape::Cylinder(Cylinder {
                point,
                axis,
                radius,
                side: Side::Outside,
            }) => {
                let length = AXIS * self.extent();
                let end = |sign: f64| [0, 1, 2].map(|i| point[i] + sign * length * axis[i]);
                match self.dim == 3 {
                    true => (vec![end(-1.0), end(1.0)], *radius),
                    false => (vec![*point], *radius),
                }
            }
            _ => return None,
        };
        let kind = match places.len() {
            1 => Kind::Point1,
            _ => Kind::Bar2,
        };
        let vertices: Vec<(Vec<(u32, f64)>, f64)> = places
            .iter()
            .map(|_| (Vec::new(), OF_RADIUS * radius))
            .collect();
        let corners = (0..places.len() as u32).collect();
        Some(CoreOf {
            core: Core::new(&vertices, &[(kind, corners)], |_| [0.0; 3])
                .with_depth((1.0 - OF_RADIUS) * radius),
            owner: CoreOwner::Shape(contact, places),
        })
    }

    /// Length of the model, m.
    fn extent(&self) -> f64 {
        carom_mesh::Bounds::of(&self.x).diagonal()
    }

    fn made(&self, vertices: &[(Vec<(u32, f64)>, f64)], patches: &[(Kind, Vec<u32>)]) -> Core {
        Core::new(vertices, patches, |node| self.x[node as usize])
    }
}

/// The least sine of the angle at which a way goes below some faces with these normals; negative where it goes out of one.
fn below(way: &Vec3, normals: &[Vec3]) -> f64 {
    let size = dot(way, way).sqrt();
    let sines = normals.iter().map(|normal| -dot(way, normal) / size);
    sines.fold(f64::INFINITY, f64::min)
}

fn dot(a: &Vec3, b: &Vec3) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

fn cross(a: &Vec3, b: &Vec3) -> Vec3 {
    [0, 1, 2].map(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        a[j] * b[k] - a[k] * b[j]
    })
}

/// How far the middle of a cell is above a face, over its size normal to that.
fn height_of_middle(kind: Kind) -> f64 {
    match kind {
        Kind::Tri3 => 1.0 / 3.0,
        Kind::Tet4 | Kind::Pyramid5 => 0.25,
        Kind::Wedge6 => 0.4,
        _ => 0.5,
    }
}
