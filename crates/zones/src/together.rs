//! Zones of equal steps as one system: each with its scheme, links and contacts between them in one problem.

use std::collections::BTreeMap;
use std::sync::Arc;

use carom_mesh::{Mesh, Surface};

use crate::error::Error;
use crate::model::{ModelZone, Zoned};
use carom_system::{self as system, Model, ModelLink, ModelScheme, ModelTarget, System};

impl Zoned {
    /// The zones as one system, which one driver takes through its steps; `None` where they step apart: with unequal steps, with links behind a static
    /// stage, or with schemes that do not go in one model.
    ///
    /// # Errors
    /// A model that cannot be built; zones that step apart with a contact between them, rigid bodies or discrete elements.
    pub fn together(&self) -> Result<Option<Arc<System>>, Error> {
        self.check_steps()?;
        let apart = |error: Option<Error>| match self.check().and_then(|()| self.check_across()) {
            Ok(()) => Ok(None),
            Err(own) => Err(error.unwrap_or(own)),
        };
        let equal = |zone: &ModelZone| zone.substeps == 1 && zone.far.unwrap_or(1) == 1;
        if !self.zones.iter().all(equal) || self.has_stage() {
            return apart(None);
        }
        match System::new(self.separated()) {
            Ok(system) => Ok(Some(system)),
            Err(
                error @ (system::Error::SchemeAlone { .. } | system::Error::BetweenSchemes { .. }),
            ) => apart(Some(error.into())),
            Err(error) => Err(error.into()),
        }
    }

    /// Whether a static stage comes before links, which join velocities, or supports move as prescribed, of which links of one system take no
    /// account.
    fn has_stage(&self) -> bool {
        let given = &self.model.nonlinear;
        let follows = !given.motions.is_empty() || !given.turns.is_empty();
        let links = !self.links.is_empty();
        let rows = links || !self.model.constraints.is_empty();
        rows && given.preload.is_some() || links && follows
    }

    /// The model as one, in which no zones share nodes: each but the first has nodes of its own at the same places.
    pub fn separated(&self) -> Model {
        let mut model = self.model.clone();
        let copies = self.copies(&mut model.mesh);
        let zone_of_body = |body: usize| {
            let mut zones = self.zones.iter();
            zones.position(|zone| zone.bodies.contains(&body))
        };
        let mut zone_of_cell = BTreeMap::new();
        for (k, body) in model.bodies.iter().enumerate() {
            let zone = zone_of_body(k).unwrap_or(0);
            zone_of_cell.extend(body.spec.cells.iter().map(|&cell| (cell, zone)));
        }
        let own = |zone: usize, node: u32| copies.get(&(zone, node)).copied().unwrap_or(node);
        let renumber = |surface: &mut Surface| {
            for face in &mut surface.faces {
                let Some(&zone) = zone_of_cell.get(&face.parent) else {
                    continue;
                };
                let count = face.corners().len();
                for node in &mut face.nodes[..count] {
                    *node = own(zone, *node);
                }
            }
            let nodes = surface
                .faces
                .iter()
                .flat_map(|face| face.corners().to_vec());
            surface.nodes = nodes.collect();
            surface.nodes.sort_unstable();
            surface.nodes.dedup();
        };
        for contact in &mut model.contacts {
            renumber(&mut contact.secondary);
            if let ModelTarget::Surface(surface) = &mut contact.primary {
                renumber(surface);
            }
        }
        for load in &mut model.nonlinear.loads {
            renumber(&mut load.surface);
        }
        let mut all: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for (&(_, node), &copy) in &copies {
            all.entry(node).or_default().push(copy);
        }
        let spread = |nodes: &mut Vec<u32>| {
            let more: Vec<u32> = nodes
                .iter()
                .filter_map(|node| all.get(node))
                .flatten()
                .copied()
                .collect();
            nodes.extend(more);
        };
        model
            .supports
            .iter_mut()
            .for_each(|support| spread(&mut support.nodes));
        for motion in &mut model.nonlinear.motions {
            spread(&mut motion.nodes);
        }
        let link = |link: &ModelLink| {
            let mut link = link.clone();
            for row in &mut link.rows {
                for (zone, terms) in link.zones.iter().zip([&mut row.inner, &mut row.outer]) {
                    for term in terms {
                        term.node = own(*zone, term.node);
                    }
                }
            }
            link
        };
        model.links = self.links.iter().map(link).collect();
        let schemes = self.zones.iter().map(|zone| ModelScheme {
            bodies: zone.bodies.clone(),
            scheme: zone.scheme,
        });
        model.zones = schemes.collect();
        model
    }

    /// Gives the cells of each zone nodes that no zone before it has; the copy of each node by zone.
    fn copies(&self, mesh: &mut Mesh) -> BTreeMap<(usize, u32), u32> {
        let mut owner: Vec<Option<usize>> = vec![None; mesh.nodes.len()];
        let mut copies = BTreeMap::new();
        for (k, zone) in self.zones.iter().enumerate() {
            let bodies = zone.bodies.iter().map(|&body| &self.model.bodies[body]);
            for &cell in bodies.flat_map(|body| &body.spec.cells) {
                let count = mesh.element_nodes(cell).len();
                let first = cell.index as usize * count;
                for place in first..first + count {
                    let node = mesh.blocks[cell.block as usize].nodes[place];
                    if *owner[node as usize].get_or_insert(k) == k {
                        continue;
                    }
                    let copy = *copies.entry((k, node)).or_insert_with(|| {
                        mesh.nodes.push(mesh.nodes[node as usize]);
                        mesh.nodes.len() as u32 - 1
                    });
                    mesh.blocks[cell.block as usize].nodes[place] = copy;
                }
            }
        }
        copies
    }
}
