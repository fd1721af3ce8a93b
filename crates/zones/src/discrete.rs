//! The zones of discrete elements: those of the bodies whose nodes they have, or that they hang on.

use crate::error::Error;
use crate::model::Zoned;
use carom_system::ModelDiscrete;

impl Zoned {
    /// The zone of each node and of each group of discrete elements. A node of several zones belongs to the first of them; what
    /// hangs on no body is in the first zone that takes the outer step.
    fn zones_of_discrete(&self) -> (Vec<Option<usize>>, Vec<usize>) {
        let model = &self.model;
        let mut of_node: Vec<Option<usize>> = vec![None; model.mesh.nodes.len()];
        for (k, zone) in self.zones.iter().enumerate() {
            let cells = zone
                .bodies
                .iter()
                .flat_map(|&body| &model.bodies[body].spec.cells);
            for &node in cells.flat_map(|&cell| model.mesh.element_nodes(cell)) {
                of_node[node as usize].get_or_insert(k);
            }
        }
        let outer = self.zones.iter().position(|zone| zone.substeps == 1);
        let mut zones: Vec<Option<usize>> = vec![None; model.discrete.len()];
        while let Some(first) = zones.iter().position(Option::is_none) {
            let known = |some: &ModelDiscrete| {
                let mut nodes = self.nodes_of(some);
                nodes.find_map(|node| of_node[node as usize])
            };
            let pairs = || model.discrete.iter().enumerate();
            let mut open = pairs().filter(|(k, _)| zones[*k].is_none());
            let next = open.find_map(|(k, some)| Some((k, known(some)?)));
            let (k, zone) = next.unwrap_or((first, outer.unwrap_or(0)));
            zones[k] = Some(zone);
            for node in self.nodes_of(&model.discrete[k]) {
                of_node[node as usize].get_or_insert(zone);
            }
        }
        (of_node, zones.into_iter().flatten().collect())
    }

    /// The zone of some discrete elements.
    pub(crate) fn zone_of_discrete(&self, some: usize) -> usize {
        let (_, zones) = self.zones_of_discrete();
        zones.get(some).copied().unwrap_or(0)
    }

    fn nodes_of<'a>(&'a self, some: &'a ModelDiscrete) -> impl Iterator<Item = u32> + 'a {
        let cells = some.spec.cells.iter();
        cells.flat_map(|&cell| self.model.mesh.element_nodes(cell).iter().copied())
    }

    /// The zone of each node that a body or a discrete element has.
    pub(crate) fn zones_of_nodes(&self) -> Vec<Option<usize>> {
        self.zones_of_discrete().0
    }

    /// Refuses discrete elements that join zones which step apart.
    pub(crate) fn check_discrete(&self) -> Result<(), Error> {
        let (of_node, zones) = self.zones_of_discrete();
        for (some, &zone) in self.model.discrete.iter().zip(&zones) {
            let mut elsewhere = self
                .nodes_of(some)
                .filter_map(|node| of_node[node as usize]);
            if let Some(other) = elsewhere.find(|other| *other != zone) {
                return Err(Error::DiscreteInZones {
                    element: some.spec.name.clone(),
                    one: self.zones[zone].name.clone(),
                    other: self.zones[other].name.clone(),
                });
            }
        }
        Ok(())
    }

    /// The discrete elements of a zone, without those that join it to another one.
    pub(crate) fn discrete_of(&self, zone: usize) -> Vec<ModelDiscrete> {
        let (of_node, _) = self.zones_of_discrete();
        let inside = |some: &&ModelDiscrete| {
            let mut nodes = self.nodes_of(some);
            nodes.all(|node| of_node[node as usize] == Some(zone))
        };
        self.model.discrete.iter().filter(inside).cloned().collect()
    }
}
