//! The mesh as it grows while a file is read: numbers of nodes and elements, sets, surfaces.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use carom_elements::Kind;

use super::card::{Card, Data};
use super::fault::Fault;
use super::kinds;
use crate::read::flatten::flatten;
use crate::{ElementId, Group, Mesh};

/// The most numbers that one line of a generated set may give.
const MOST_GENERATED: u64 = u32::MAX as u64;

/// Members by name in capital letters, with the name as it was written first and the line where it was.
struct Sets<T>(BTreeMap<String, (String, usize, Vec<T>)>);

impl<T> Sets<T> {
    fn of(&mut self, name: &str, line: usize) -> &mut Vec<T> {
        let new = || (name.to_owned(), line, Vec::new());
        &mut self.0.entry(name.to_uppercase()).or_insert_with(new).2
    }

    fn get(&self, name: &str) -> Option<&[T]> {
        self.0.get(&name.to_uppercase()).map(|(_, _, all)| &all[..])
    }
}

/// What has been read so far.
pub(super) struct Builder {
    mesh: Mesh,
    nodes: BTreeMap<u64, u32>,
    elements: BTreeMap<u64, ElementId>,
    node_sets: Sets<u32>,
    element_sets: Sets<ElementId>,
    surfaces: Sets<ElementId>,
    node_surfaces: Sets<u32>,
    /// Facets made for surfaces, by their nodes in ascending order.
    facets: BTreeMap<Vec<u32>, ElementId>,
}

impl Builder {
    pub fn new() -> Builder {
        Builder {
            mesh: Mesh::new(3),
            nodes: BTreeMap::new(),
            elements: BTreeMap::new(),
            node_sets: Sets(BTreeMap::new()),
            element_sets: Sets(BTreeMap::new()),
            surfaces: Sets(BTreeMap::new()),
            node_surfaces: Sets(BTreeMap::new()),
            facets: BTreeMap::new(),
        }
    }

    /// `*NODE`: number and coordinates; those left out are zero.
    pub fn nodes(&mut self, card: &Card) -> Result<(), Fault> {
        if card.has("SYSTEM") || card.has("INPUT") {
            let accepted = "Cartesian coordinates in the file itself";
            return Err(Fault::unsupported(
                card.line,
                "*NODE with SYSTEM or INPUT",
                accepted,
            ));
        }
        let mut added = Vec::new();
        for data in &card.data {
            let mut words = data.words();
            let number = data.number(words.next(), "the number of a node")?;
            let mut x = [0.0; 3];
            for x in &mut x {
                let Some(word) = words.next() else { break };
                *x = data.number(Some(word), "a coordinate")?;
                if !f64::is_finite(*x) {
                    return Err(data.fault(word, "a finite coordinate"));
                }
            }
            let node = self.mesh.nodes.len() as u32;
            match self.nodes.entry(number) {
                Entry::Vacant(free) => free.insert(node),
                Entry::Occupied(_) => {
                    let found = format!("a second node with the number {number}");
                    return Err(Fault::new(data.line, found, "a number not used before"));
                }
            };
            self.mesh.nodes.push(x);
            added.push(node);
        }
        if let Some(name) = card.get("NSET") {
            self.node_sets.of(name, card.line).extend(added);
        }
        Ok(())
    }

    /// `*ELEMENT`: number and nodes, which may go on in further lines.
    pub fn elements(&mut self, card: &Card) -> Result<(), Fault> {
        let name = card.required("TYPE")?;
        let Some(kind) = kinds::kind(name) else {
            let found = format!("the element type {name}");
            return Err(Fault::unsupported(card.line, found, kinds::TYPES));
        };
        let count = kind.table().nodes;
        let (mut added, mut lines) = (Vec::new(), card.data.iter());
        while let Some(first) = lines.next() {
            let mut words: Vec<&str> = first.words().collect();
            let mut last = first;
            while words.len() <= count && last.goes_on() {
                let Some(next) = lines.next() else { break };
                words.extend(next.words());
                last = next;
            }
            if words.len() != count + 1 {
                let found = format!("{} numbers", words.len());
                let expected =
                    format!("a number and the {count} nodes of an element of type {name}");
                return Err(Fault::new(first.line, found, expected));
            }
            let number = first.number(Some(words[0]), "the number of an element")?;
            let given = words[1..].iter().map(|word| self.node(first, word));
            let given = given.collect::<Result<Vec<u32>, Fault>>()?;
            let nodes: Vec<u32> = kinds::order(kind).iter().map(|&k| given[k]).collect();
            let id = self.mesh.push(kind, &nodes);
            if self.elements.insert(number, id).is_some() {
                let found = format!("a second element with the number {number}");
                return Err(Fault::new(first.line, found, "a number not used before"));
            }
            added.push(id);
        }
        if let Some(name) = card.get("ELSET") {
            self.element_sets.of(name, card.line).extend(added);
        }
        Ok(())
    }

    fn node(&self, data: &Data, word: &str) -> Result<u32, Fault> {
        let number: u64 = data.number(Some(word), "the number of a node")?;
        let node = self.nodes.get(&number).copied();
        node.ok_or_else(|| data.fault(word, "the number of a node given before"))
    }

    fn element(&self, data: &Data, word: &str) -> Result<ElementId, Fault> {
        let number: u64 = data.number(Some(word), "the number of an element")?;
        let element = self.elements.get(&number).copied();
        element.ok_or_else(|| data.fault(word, "the number of an element given before"))
    }

    /// `*NSET`: numbers, names of other sets, or with `GENERATE` ranges.
    pub fn node_set(&mut self, card: &Card) -> Result<(), Fault> {
        let name = card.required("NSET")?;
        if let Some(elements) = card.get("ELSET") {
            let found = format!("a node set of the element set {elements}");
            return Err(Fault::unsupported(
                card.line,
                found,
                "numbers, names of node sets",
            ));
        }
        let mut all = Vec::new();
        for data in &card.data {
            if card.has("GENERATE") {
                all.extend(within(&self.nodes, range(data)?).copied());
                continue;
            }
            for word in data.words() {
                match self.node_sets.get(word) {
                    Some(set) if !is_number(word) => all.extend_from_slice(set),
                    _ => all.push(self.node(data, word)?),
                }
            }
        }
        self.node_sets.of(name, card.line).extend(all);
        Ok(())
    }

    /// `*ELSET`, as [`Builder::node_set`].
    pub fn element_set(&mut self, card: &Card) -> Result<(), Fault> {
        let name = card.required("ELSET")?;
        let mut all = Vec::new();
        for data in &card.data {
            if card.has("GENERATE") {
                all.extend(within(&self.elements, range(data)?).copied());
                continue;
            }
            for word in data.words() {
                match self.element_sets.get(word) {
                    Some(set) if !is_number(word) => all.extend_from_slice(set),
                    _ => all.push(self.element(data, word)?),
                }
            }
        }
        self.element_sets.of(name, card.line).extend(all);
        Ok(())
    }

    /// `*SURFACE`: elements or sets of them with the label of a face; with `TYPE=NODE` nodes or sets of them.
    pub fn surface(&mut self, card: &Card) -> Result<(), Fault> {
        let name = card.required("NAME")?;
        let sort = card.get("TYPE").unwrap_or("ELEMENT").to_uppercase();
        let accepted = "TYPE=ELEMENT with faces, TYPE=NODE";
        if card.has("COMBINE") || !["ELEMENT", "NODE"].contains(&sort.as_str()) {
            let found = "a surface that is combined, cut or analytical";
            return Err(Fault::unsupported(card.line, found, accepted));
        }
        for data in &card.data {
            let mut words = data.words();
            let Some(first) = words.next() else { continue };
            if sort == "NODE" {
                let nodes = match self.node_sets.get(first) {
                    Some(set) if !is_number(first) => set.to_vec(),
                    _ => vec![self.node(data, first)?],
                };
                self.node_surfaces.of(name, card.line).extend(nodes);
                continue;
            }
            let elements = match self.element_sets.get(first) {
                Some(set) if !is_number(first) => set.to_vec(),
                _ => vec![self.element(data, first)?],
            };
            let label = words.next().map(str::to_uppercase);
            let facets = elements.iter().map(|id| self.facet(data, *id, &label));
            let facets = facets.collect::<Result<Vec<ElementId>, Fault>>()?;
            self.surfaces.of(name, card.line).extend(facets);
        }
        Ok(())
    }

    /// The facet that a label names on an element.
    fn facet(
        &mut self,
        data: &Data,
        id: ElementId,
        label: &Option<String>,
    ) -> Result<ElementId, Fault> {
        let kind = self.mesh.kind(id);
        let (table, faces) = (kind.table(), kinds::faces(kind));
        let label = label.as_deref().unwrap_or_default();
        if matches!(label, "SPOS" | "SNEG") && table.dim == 2 {
            return Ok(id);
        }
        let letter = if label.starts_with('E') && table.dim == 2 {
            'E'
        } else {
            'S'
        };
        let number = label.strip_prefix(letter).and_then(|n| n.parse().ok());
        let face = number.and_then(|n: usize| faces.get(n.checked_sub(1)?));
        let Some(face) = face else {
            let shell = if table.dim == 2 {
                ", SPOS, SNEG, E1, ..."
            } else {
                ""
            };
            let expected = format!(
                "the label of a face of {}: S1 to S{}{shell}",
                table.name,
                faces.len()
            );
            return Err(data.fault(label, &expected));
        };
        let same = |own: &&carom_elements::Face| {
            let corners = &own.nodes[..own.kind.table().linear.table().nodes];
            corners.len() == face.len() && face.iter().all(|node| corners.contains(node))
        };
        let Some(own) = table.faces.iter().find(same) else {
            return Err(data.fault(label, "the label of a face"));
        };
        let nodes = self.mesh.element_nodes(id);
        let nodes: Vec<u32> = own.nodes.iter().map(|&k| nodes[k]).collect();
        let mut key = nodes.clone();
        key.sort_unstable();
        let mesh = &mut self.mesh;
        Ok(*self
            .facets
            .entry(key)
            .or_insert_with(|| mesh.push(own.kind, &nodes)))
    }

    /// The mesh; `end` is the last line. Fails without nodes or elements, and for sets of several dimensions.
    pub fn finish(mut self, end: usize) -> Result<Mesh, Fault> {
        if self.mesh.nodes.is_empty() {
            return Err(Fault::new(end, "no node", "at least one behind *NODE"));
        }
        if self.elements.is_empty() {
            return Err(Fault::new(
                end,
                "no element",
                "at least one behind *ELEMENT",
            ));
        }
        let mut taken: BTreeMap<String, ()> = BTreeMap::new();
        let sets = [(self.element_sets, ""), (self.surfaces, ".surface")];
        for (sets, ending) in sets {
            for (key, (name, line, elements)) in sets.0 {
                let dims = elements.iter().map(|id| self.mesh.kind(*id).table().dim);
                let (least, most) = (dims.clone().min(), dims.max());
                if least != most {
                    let found = format!("elements of several dimensions in {name}");
                    return Err(Fault::unsupported(
                        line,
                        found,
                        "sets of elements of one dimension",
                    ));
                }
                let ending = if taken.insert(key, ()).is_some() {
                    ending
                } else {
                    ""
                };
                let group = Group::new(most.unwrap_or(0), elements);
                self.mesh.groups.insert(name + ending, group);
            }
        }
        let mut points: BTreeMap<u32, ElementId> = BTreeMap::new();
        let sets = [(self.node_surfaces, ".surface"), (self.node_sets, ".nodes")];
        for (sets, ending) in sets {
            for (key, (name, _, nodes)) in sets.0 {
                let mesh = &mut self.mesh;
                let mut point = |node: u32| {
                    *points
                        .entry(node)
                        .or_insert_with(|| mesh.push(Kind::Point1, &[node]))
                };
                let elements = nodes.into_iter().map(&mut point).collect();
                let ending = if taken.insert(key, ()).is_some() {
                    ending
                } else {
                    ""
                };
                self.mesh
                    .groups
                    .insert(name + ending, Group::new(0, elements));
            }
        }
        let kinds = self.mesh.blocks.iter().map(|block| block.kind.table().dim);
        let least = kinds.max().unwrap_or(1);
        self.mesh.dim = flatten(&mut self.mesh.nodes, least);
        Ok(self.mesh)
    }
}

fn is_number(word: &str) -> bool {
    word.bytes().all(|byte| byte.is_ascii_digit())
}

/// First, last and step of a generated line.
fn range(data: &Data) -> Result<[u64; 3], Fault> {
    let mut words = data.words();
    let first = data.number(words.next(), "the first number")?;
    let last = match words.next() {
        Some(word) => data.number(Some(word), "the last number")?,
        None => first,
    };
    let step = match words.next() {
        Some(word) => data.number(Some(word), "the step")?,
        None => 1,
    };
    let within = step > 0 && first <= last && (last - first) / step < MOST_GENERATED;
    match within {
        true => Ok([first, last, step]),
        false => {
            let found = format!("{first} to {last} by {step}");
            Err(Fault::new(
                data.line,
                found,
                "a first number, a last one that is not below it, a step above zero",
            ))
        }
    }
}

/// What has the numbers of a range; numbers that nothing has are left out, as the format has it.
fn within<T>(all: &BTreeMap<u64, T>, [first, last, step]: [u64; 3]) -> impl Iterator<Item = &T> {
    let numbers = all.range(first..=last);
    numbers
        .filter(move |(number, _)| (*number - first) % step == 0)
        .map(|(_, value)| value)
}
