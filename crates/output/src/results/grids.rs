//! The grids of the fields of one instant: of the bodies, and of the contact points of each contact.

use std::borrow::Cow;
use std::ops::Range;
use std::path::Path;

use carom_bodies::Body;
use carom_contact::law::{Level, Status};
use carom_contact::{Contact, Integration, Point};
use carom_dynamics::{Motion, Order, System};
use carom_elements::Kind;
use carom_mesh::Face;

use crate::Error;
use crate::results::beams::{SECTION_FORCES, rotations, section_forces};
use crate::results::cells::{Bent, all_bodies, cell_stresses, deleted, plastic_strains};
use crate::results::derived::Derived;
use crate::results::pieces::{self, Piece};
use crate::results::snapshot::Snapshot;
use crate::results::{Fields, Zoning};
use crate::vtu::{Cells, Field, Grid, Values, write};

/// All bodies as one grid on the system's nodes, or the elements of one of several ranks on their own.
#[derive(Default)]
pub(super) struct Volume {
    /// Of a rank its elements.
    own: Option<Own>,
    cells: Vec<(Kind, Vec<u32>)>,
    /// Number of the body of each cell, in the order of the case.
    body: Vec<i32>,
    /// Zone of each cell, and its mean weights of inertia and internal work; empty without zones.
    zone: Vec<i32>,
    weights: [Vec<f64>; 2],
}

impl Volume {
    pub(super) fn new(system: &System, zoning: Option<&Zoning>) -> Volume {
        let mut volume = Volume::default();
        if let Some(zoning) = zoning {
            for (zone, weights) in zoning.of_body.iter().zip(&zoning.weights) {
                let zone = *zone as i32;
                volume.zone.extend(weights[0].iter().map(|_| zone));
                for (all, own) in volume.weights.iter_mut().zip(weights) {
                    all.extend(own);
                }
            }
        }
        volume.add_cells(system, &mut system.bodies.iter());
        volume
    }

    /// The elements of a rank.
    pub(super) fn of_piece(system: &System, piece: &Piece) -> Volume {
        let own = Own::new(system, piece);
        let mut volume = Volume::default();
        volume.add_cells(system, &mut own.bodies.iter().map(|(body, _)| body));
        for node in volume.cells.iter_mut().flat_map(|(_, nodes)| nodes) {
            // the nodes are those of these cells
            *node = own.nodes.partition_point(|other| other < node) as u32;
        }
        Volume {
            own: Some(own),
            ..volume
        }
    }

    fn add_cells(&mut self, system: &System, bodies: &mut dyn Iterator<Item = &Body>) {
        for (number, body) in bodies.enumerate() {
            let mut last = None;
            for &cell in body.cells() {
                let kind = system.mesh.kind(cell);
                if last != Some(kind) {
                    self.cells.push((kind, Vec::new()));
                    last = Some(kind);
                }
                let nodes = system.mesh.element_nodes(cell).iter();
                if let Some((_, block)) = self.cells.last_mut() {
                    block.extend(nodes.map(|node| system.number[*node as usize]));
                }
                self.body.push(number as i32);
            }
        }
    }

    /// One vector of three components for each point.
    fn vectors(&self, system: &System, motion: &Motion, order: Order) -> Vec<[f64; 3]> {
        let Some(own) = &self.own else {
            return vectors(system, motion, order);
        };
        let nodes = own.nodes.iter();
        nodes
            .map(|node| system.of_node(*node, motion, order))
            .collect()
    }

    pub(super) fn write(
        &self,
        path: &Path,
        system: &System,
        fields: &Fields,
        snapshot: &Snapshot,
    ) -> Result<(), Error> {
        let histories = self.own.as_ref().map(|own| own.histories(system, snapshot));
        let bodies = match (&self.own, &histories) {
            (Some(own), Some(histories)) => own.with(histories),
            _ => all_bodies(system, &snapshot.motion.history),
        };
        let chosen = [
            ("displacement", fields.displacement, Order::Displacement),
            ("velocity", fields.velocity, Order::Velocity),
            ("acceleration", fields.acceleration, Order::Acceleration),
        ];
        let chosen = chosen.into_iter().filter(|(_, on, _)| *on);
        let motions: Vec<(&str, Vec<[f64; 3]>)> = chosen
            .map(|(name, _, order)| (name, self.vectors(system, &snapshot.motion, order)))
            .collect();
        let point_fields = motions.iter().map(|(name, values)| Field {
            name,
            values: Values::Vector(values),
        });
        let mut point_fields: Vec<Field> = point_fields.collect();
        let rotation = match fields.rotation {
            true => rotations(system, &snapshot.motion.u),
            false => Vec::new(),
        };
        if fields.rotation {
            point_fields.push(Field {
                name: "rotation",
                values: Values::Vector(&rotation),
            });
        }
        let forces = match fields.section_forces {
            true => section_forces(system, &snapshot.motion),
            false => Default::default(),
        };
        let stress = match fields.stress {
            true => cell_stresses(&bodies, &snapshot.motion.u),
            false => Vec::new(),
        };
        let plastic = plastic_strains(&bodies);
        let bent = match fields.stress || fields.section_forces {
            true => Some(Bent::new(system, &snapshot.motion, &stress)),
            false => None,
        };
        let mises = match &bent {
            Some(bent) if fields.stress => bent.von_mises(&stress),
            _ => Vec::new(),
        };
        let derived = Derived::new((system, &bodies), &snapshot.motion, fields);
        point_fields.extend(derived.point_fields());
        let mut cell_fields = vec![Field {
            name: "body",
            values: Values::Integer(&self.body),
        }];
        // they never change: the first file has them
        if snapshot.first && !self.zone.is_empty() {
            let [inertia, stiffness] = &self.weights;
            cell_fields.extend([
                Field {
                    name: "zone",
                    values: Values::Integer(&self.zone),
                },
                Field {
                    name: "inertia_weight",
                    values: Values::Scalar(inertia),
                },
                Field {
                    name: "stiffness_weight",
                    values: Values::Scalar(stiffness),
                },
            ]);
        }
        if fields.stress {
            cell_fields.push(Field {
                name: "stress",
                values: Values::SymmetricTensor(&stress),
            });
            cell_fields.push(Field {
                name: "von_mises",
                values: Values::Scalar(&mises),
            });
        }
        cell_fields.extend(derived.cell_fields());
        if let Some(shells) = bent.as_ref().and_then(|bent| bent.shells.as_ref()) {
            cell_fields.extend(shells.fields(fields));
        }
        if let Some(beams) = bent.as_ref().and_then(|bent| bent.beams.as_ref()) {
            cell_fields.extend(fields.stress.then(|| beams.field()));
        }
        let forces = SECTION_FORCES.iter().zip(&forces);
        cell_fields.extend(
            forces
                .filter(|_| fields.section_forces)
                .map(|(name, values)| Field {
                    name,
                    values: Values::Vector(values),
                }),
        );
        if let Some(plastic) = &plastic {
            cell_fields.push(Field {
                name: "plastic_strain",
                values: Values::Scalar(plastic),
            });
        }
        let rank: Vec<i32> = match &self.own {
            Some(own) => vec![own.rank as i32; self.body.len()],
            None => Vec::new(),
        };
        if self.own.is_some() {
            cell_fields.push(Field {
                name: "rank",
                values: Values::Integer(&rank),
            });
        }
        // elements of ranks are not deleted
        let deleted = match &self.own {
            Some(_) => None,
            None => deleted(system, &snapshot.motion.history),
        };
        let deleted = deleted.map(|all| all.into_iter().map(i32::from).collect::<Vec<_>>());
        if let Some(deleted) = &deleted {
            cell_fields.push(Field {
                name: "deleted",
                values: Values::Integer(deleted),
            });
        }
        let x = match &self.own {
            Some(own) => Cow::Owned(own.places(system)),
            None => Cow::Borrowed(&system.x[..]),
        };
        let displacement = self.vectors(system, &snapshot.motion, Order::Displacement);
        let grid = Grid {
            time: snapshot.time,
            points: &places(system, &x, &displacement),
            cells: &borrowed(&self.cells),
            point_fields: &point_fields,
            cell_fields: &cell_fields,
        };
        let Some(own) = &self.own else {
            return write(path, &grid);
        };
        write(&pieces::path(path, own.rank), &grid)?;
        match own.rank {
            0 => pieces::join(path, &grid, own.ranks),
            _ => Ok(()),
        }
    }
}

/// The elements of a rank.
struct Own {
    rank: usize,
    ranks: usize,
    /// Some elements of each body, and where their histories are in that of all of its.
    bodies: Vec<(Body, Vec<Range<usize>>)>,
    /// Their nodes (system numbers), ascending.
    nodes: Vec<u32>,
}

impl Own {
    fn new(system: &System, piece: &Piece) -> Own {
        let solids = system.bodies.iter().zip(&piece.elements);
        let bodies = solids.filter_map(|(body, places)| {
            let solid = body.as_solid()?;
            Some(solid.share(places.clone()).into_body())
        });
        let bodies: Vec<(Body, Vec<Range<usize>>)> = bodies.collect();
        let mut nodes = Vec::new();
        for (body, _) in &bodies {
            for &cell in body.cells() {
                let own = system.mesh.element_nodes(cell).iter();
                nodes.extend(own.map(|node| system.number[*node as usize]));
            }
        }
        nodes.sort_unstable();
        nodes.dedup();
        Own {
            rank: piece.rank,
            ranks: piece.ranks,
            bodies,
            nodes,
        }
    }

    /// Histories of the elements of each body.
    fn histories(&self, system: &System, snapshot: &Snapshot) -> Vec<Vec<f64>> {
        let bodies = self.bodies.iter().enumerate();
        let of_body = |(k, (_, ranges)): (usize, &(Body, Vec<Range<usize>>))| {
            let all = system.history(k, &snapshot.motion.history);
            let own = ranges.iter().flat_map(|range| &all[range.clone()]);
            own.copied().collect()
        };
        bodies.map(of_body).collect()
    }

    fn with<'a>(&'a self, histories: &'a [Vec<f64>]) -> Vec<(&'a Body, &'a [f64])> {
        let bodies = self.bodies.iter().zip(histories);
        bodies
            .map(|((body, _), history)| (body, &history[..]))
            .collect()
    }

    fn places(&self, system: &System) -> Vec<[f64; 3]> {
        let nodes = self.nodes.iter();
        nodes.map(|node| system.x[*node as usize]).collect()
    }
}

/// The places to draw points at: as they were, so that a viewer may add displacements of any scale, or, where
/// displacements are large, as they are.
fn places<'a>(
    system: &System,
    x: &'a [[f64; 3]],
    displacement: &[[f64; 3]],
) -> Cow<'a, [[f64; 3]]> {
    match system.is_nonlinear() {
        false => Cow::Borrowed(x),
        true => {
            let moved = x.iter().zip(displacement);
            Cow::Owned(moved.map(|(x, u)| [0, 1, 2].map(|i| x[i] + u[i])).collect())
        }
    }
}

/// The contact points of a contact: nodes on the secondary surface, or Gauss points by themselves.
pub(super) struct SurfaceGrid {
    contact: usize,
    points: Vec<[f64; 3]>,
    cells: Vec<(Kind, Vec<u32>)>,
}

impl SurfaceGrid {
    pub(super) fn new(system: &System, contact: usize) -> SurfaceGrid {
        let Contact {
            points,
            integration,
            ..
        } = &system.contacts[contact].contact;
        if let Integration::Points | Integration::Weak { .. } = integration {
            return SurfaceGrid::of_points(system, contact, points);
        }
        let nodes: Vec<u32> = points.iter().map(Point::node).collect();
        let numbered = nodes.iter().copied().zip(0..).zip(points);
        let at_nodes = numbered.filter(|(_, point)| !point.crosses());
        let mut places: Vec<(u32, u32)> = at_nodes.map(|(place, _)| place).collect();
        places.sort_unstable();
        let place = |node: &u32| {
            let found = places.binary_search_by_key(node, |(node, _)| *node);
            found.ok().map(|k| places[k].1)
        };
        let mut cells = Vec::new();
        for kind in Kind::ALL {
            let faces = system.contacts[contact].faces_of_points().iter();
            let of_kind = faces.filter_map(|face| shown(face, &place));
            let of_kind = of_kind.filter(|(shown, _)| *shown == kind);
            let nodes: Vec<u32> = of_kind.flat_map(|(_, nodes)| nodes).collect();
            if !nodes.is_empty() {
                cells.push((kind, nodes));
            }
        }
        SurfaceGrid {
            contact,
            points: nodes.iter().map(|node| system.x[*node as usize]).collect(),
            cells,
        }
    }

    fn of_points(system: &System, contact: usize, points: &[Point]) -> SurfaceGrid {
        let reference = vec![0.0; system.unknowns()];
        let places = system.places(0.0, &reference, &system.initial.frames);
        SurfaceGrid {
            contact,
            points: points.iter().map(|point| point.place(&places)).collect(),
            cells: vec![(Kind::Point1, (0..points.len() as u32).collect())],
        }
    }

    pub(super) fn write(
        &self,
        path: &Path,
        system: &System,
        snapshot: &Snapshot,
    ) -> Result<(), Error> {
        let contact = &system.contacts[self.contact];
        let range = system.points_of(self.contact);
        let interface = &snapshot.interface;
        let (force, status) = (
            &interface.force[range.clone()],
            &interface.status[range.clone()],
        );
        // a point that faces nothing has no gap: viewers leave out what is not a number
        let gap = |gap: &f64| if gap.is_finite() { *gap } else { f64::NAN };
        let gap: Vec<f64> = interface.gap[range.clone()].iter().map(gap).collect();
        let points = contact.points.iter().zip(force);
        let pressure: Vec<f64> = points
            .map(|(point, force)| {
                match (*force == 0.0, point.area > 0.0) {
                    (true, _) => 0.0,
                    (false, true) => force / point.area,
                    // a node inside that the deletion of elements has laid bare
                    (false, false) => f64::NAN,
                }
            })
            .collect();
        let friction = interface.friction.get(range.clone()).unwrap_or(&[]);
        let traction: Vec<f64> = contact
            .points
            .iter()
            .zip(friction)
            .map(|(point, [one, other])| one.hypot(*other) / point.area)
            .collect();
        let sign = |on: bool| i32::from(on);
        let closed: Vec<i32> = status.iter().map(|s| sign(*s != Status::Open)).collect();
        let watched = interface.watched[range.clone()].iter();
        let watched: Vec<i32> = watched.map(|on| sign(*on)).collect();
        let all = vectors(system, &snapshot.motion, Order::Displacement);
        let moved = |point: &Point| {
            point.carriers().fold([0.0; 3], |sum: [f64; 3], (node, n)| {
                [0, 1, 2].map(|i| sum[i] + n * all[node as usize][i])
            })
        };
        let displacement: Vec<[f64; 3]> = contact.points.iter().map(moved).collect();
        let signs = match contact.law.get().level() {
            Level::Gap | Level::GapAndRate => vec![("S_g", &closed)],
            Level::Rate => vec![("S_d", &watched), ("S_v", &closed)],
        };
        let scalar = |name, values| Field {
            name,
            values: Values::Scalar(values),
        };
        let mut fields = vec![
            scalar("gap", &gap[..]),
            scalar("gap_rate", &interface.rate[range.clone()]),
            scalar("pressure", &pressure),
            scalar("force", force),
            Field {
                name: "displacement",
                values: Values::Vector(&displacement),
            },
        ];
        if system.contacts[self.contact].friction.acts() && !traction.is_empty() {
            fields.push(scalar("friction_traction", &traction));
        }
        fields.extend(signs.into_iter().map(|(name, values)| Field {
            name,
            values: Values::Integer(values),
        }));
        write(
            path,
            &Grid {
                time: snapshot.time,
                points: &places(system, &self.points, &displacement),
                cells: &borrowed(&self.cells),
                point_fields: &fields,
                cell_fields: &[],
            },
        )
    }
}

fn borrowed(cells: &[(Kind, Vec<u32>)]) -> Vec<Cells<'_>> {
    let blocks = cells
        .iter()
        .map(|(kind, nodes)| Cells { kind: *kind, nodes });
    blocks.collect()
}

/// One vector of three components per node.
fn vectors(system: &System, motion: &Motion, order: Order) -> Vec<[f64; 3]> {
    let nodes = 0..system.x.len() as u32;
    nodes
        .map(|node| system.of_node(node, motion, order))
        .collect()
}

/// A face as it is drawn, with the places of its nodes: in full, or by its corners where only these are points of the
/// contact.
fn shown(face: &Face, place: &impl Fn(&u32) -> Option<u32>) -> Option<(Kind, Vec<u32>)> {
    let linear = face.kind.table().linear;
    [face.kind, linear].into_iter().find_map(|kind| {
        let nodes = face.corners()[..kind.table().nodes].iter();
        let places: Option<Vec<u32>> = nodes.map(place).collect();
        Some((kind, places?))
    })
}
