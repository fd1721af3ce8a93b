//! The model of a page: the surface of the mesh, and its motion and fields at the kept instants.

use std::collections::{BTreeMap, BTreeSet};

use carom_contact::Target;
use carom_dynamics::{ContactPair, System};
use carom_pages::page::block::{Array, Block, COARSE, FINE};
use carom_pages::page::schema::{Field, Frame, Model, Obstacle, Peak};

use crate::results::Results;
use crate::results::cells::middle;
use crate::results::outlines::size;
use crate::results::page::chosen::Chosen;
use crate::results::page::obstacles::{self, Near};
use crate::results::page::surface::Surface;
use crate::results::page::{marks, sides};
use crate::results::stills::{Seen, Still};

/// Numbers of all fields at all instants together, two bytes each before compression. A page of 100 000 nodes stays below 5 MB.
const NUMBERS: usize = 2_000_000;

/// Fewest nodes that a large surface is drawn with.
const FEWEST: usize = 3000;

/// Most obstacles that are drawn.
const OBSTACLES: usize = 160;

/// Names of the reasons for which instants are kept.
pub(crate) const CLOSING: &str = "first closing";

pub(crate) const LARGEST: &str = "largest force";

pub(crate) const RELEASE: &str = "last release";

const STRESS: &str = "largest stress";

const EQUAL: &str = "equal times";

/// The kept instants in their order, each with the reasons for it.
pub(crate) fn instants(results: &Results) -> Vec<(&Still, Vec<&'static str>)> {
    let kept = &results.stills.kept;
    let [largest, release] = kept.extremes();
    let equal = kept.equal.iter().map(|still| (still, EQUAL));
    let further = [
        (kept.closing.as_ref(), CLOSING),
        (largest, LARGEST),
        (release, RELEASE),
    ];
    let further = further
        .into_iter()
        .filter_map(|(still, kind)| Some((still?, kind)));
    let mut of_step: BTreeMap<u64, (&Still, Vec<&'static str>)> = BTreeMap::new();
    for (still, kind) in equal.chain(further) {
        of_step
            .entry(still.step)
            .or_insert((still, Vec::new()))
            .1
            .push(kind);
    }
    let stress = |still: &Still| still.largest[0].map_or(0.0, |largest| largest.value);
    let stressed = of_step
        .values()
        .map(|(still, _)| (still.step, stress(still)));
    let most = stressed.reduce(|best, other| if other.1 > best.1 { other } else { best });
    if let Some((step, _)) = most.filter(|(_, stress)| *stress > 0.0) {
        of_step
            .entry(step)
            .and_modify(|(_, kinds)| kinds.push(STRESS));
    }
    of_step.into_values().collect()
}

/// The model with its arrays in the block; none where nothing can be drawn. `qualities`: of the cells of all bodies.
pub(crate) fn model(results: &Results, qualities: &[f64], block: &mut Block) -> Option<Model> {
    let (system, seen) = (&*results.system, &results.stills.seen);
    let mut instants = instants(results);
    let has_plastic = instants.iter().any(|(still, _)| still.plastic.is_some());
    // displacement, speed, contact; cells have twice as many values, as many triangles as there are
    let of_node = 5 + 2 * (2 + usize::from(has_plastic));
    let drawn = |instants: usize| (NUMBERS / instants.max(1) / of_node).max(FEWEST);
    if seen.nodes.len() > drawn(instants.len()) {
        thin(&mut instants);
    }
    let most = drawn(instants.len());
    let stills: Vec<&Still> = instants.iter().map(|(still, _)| *still).collect();
    let mut surface = Surface::new(system, seen, &stills);
    if surface.is_blank() || instants.is_empty() {
        return None;
    }
    let x: Vec<[f64; 3]> = seen
        .nodes
        .iter()
        .map(|node| system.x[*node as usize])
        .collect();
    let body = bodies_of_nodes(system, seen);
    let became = surface.decimate(&x, &body, (most, &extremes(system, seen, &stills)));
    let chosen = Chosen::new(&surface, seen, became.as_deref());
    let zoning = results.settings.zoning.as_ref();
    let mut constants = BTreeMap::new();
    let of_cells = |values: &[f64]| -> Vec<f64> {
        let cells = chosen.cells.iter();
        cells
            .map(|cell| values[seen.cells[*cell as usize] as usize])
            .collect()
    };
    constants.insert("quality", block.reals(of_cells(qualities)));
    if let Some(zoning) = zoning {
        let weights: Vec<f64> = zoning.weights.iter().flat_map(|w| &w[1]).copied().collect();
        constants.insert("weight", block.reals(of_cells(&weights)));
    }
    let node = |node: &u32| chosen.node(*node);
    let (near, contacts) = (box_of(system, results), &system.contacts);
    let frames = instants.iter().enumerate().map(|(k, (still, kinds))| {
        let mut frame = frame(system, still, (&chosen, &body), block);
        frame.kinds.clone_from(kinds);
        frame.visible = surface.visible(k).map(|visible| block.bytes(visible));
        frame
    });
    let frames = frames.collect();
    let bodies_of_cells = chosen.cells.iter();
    let bodies_of_cells =
        bodies_of_cells.map(|c| seen.body_of_cell[seen.cells[*c as usize] as usize]);
    Some(Model {
        dimension: system.dim,
        axisymmetric: system.axisymmetric,
        nodes: chosen.nodes.len(),
        decimated_from: became.is_some().then_some(x.len()),
        x: block.reals(chosen.nodes.iter().flat_map(|n| x[*n as usize])),
        numbers: block.indices(chosen.nodes.iter().map(|n| {
            let number = seen.nodes[*n as usize];
            system.mesh_node[number as usize]
        })),
        body_of_node: block.indices(chosen.nodes.iter().map(|n| body[*n as usize])),
        body_of_cell: block.indices(bodies_of_cells),
        bodies: system.bodies.iter().map(|b| b.name().to_owned()).collect(),
        triangles: block.indices(surface.triangles.iter().flatten().map(node)),
        triangle_cells: block.indices(surface.cells.iter().map(|c| chosen.cell(*c))),
        edges: block.indices(surface.edges.iter().flatten().map(node)),
        lines: block.indices(surface.lines.iter().flatten().map(node)),
        line_cells: block.indices(surface.line_cells.iter().map(|c| chosen.cell(*c))),
        points: block.indices(surface.points.iter().map(node)),
        zones: zoning.map_or(Vec::new(), |zoning| zoning.zones.clone()),
        zone_of_body: zoning.map_or(Vec::new(), |zoning| zoning.of_body.clone()),
        constants,
        contacts: sides::contacts(system, (seen, &chosen), block),
        groups: sides::groups((system, &surface), (seen, &chosen), block),
        obstacles: drawn_obstacles(contacts, (system, &near), block),
        signs: marks::marks(system, (seen, &chosen), block),
        fields: fields(system, has_plastic),
        frames,
    })
}

/// Leaves out every second of the instants at equal times, but for the last: a large surface needs nodes more than instants.
fn thin(instants: &mut Vec<(&Still, Vec<&'static str>)>) {
    let (last, mut place) = (instants.len() - 1, 0);
    let mut equal = 0;
    instants.retain(|(_, kinds)| {
        let is_plain = kinds[..] == [EQUAL];
        equal += usize::from(kinds.contains(&EQUAL));
        let stays = !is_plain || equal % 2 == 1 || place == last;
        place += 1;
        stays
    });
}

/// The fields that the page can colour by beside the displacement.
fn fields(system: &System, has_plastic: bool) -> Vec<Field> {
    let field = |id, name, unit, on, signed| Field {
        id,
        name,
        unit,
        on,
        signed,
    };
    let mut fields = vec![
        field(
            "von_mises",
            "von Mises stress of cells",
            "Pa",
            "cell",
            false,
        ),
        field("principal", "principal stress of cells", "Pa", "cell", true),
        field("pressure", "pressure of cells", "Pa", "cell", true),
    ];
    if has_plastic {
        fields.push(field(
            "plastic",
            "plastic strain of cells",
            "",
            "cell",
            false,
        ));
    }
    fields.push(field("speed", "speed", "m/s", "node", false));
    if !system.contacts.is_empty() {
        fields.push(field("contact", "contact pressure", "Pa", "node", false));
    }
    let has_area = |body: &carom_bodies::Body| {
        let mut cells = body.cells().iter();
        cells.any(|cell| system.mesh.kind(*cell).table().dim > 1)
    };
    if system.bodies.iter().any(has_area) {
        fields.push(field(
            "quality",
            "scaled Jacobian of the cells",
            "",
            "cell",
            false,
        ));
    }
    fields
}

/// Nodes of the cells with the largest stress and plastic strain of each instant, by their places in [`Seen`].
fn extremes(system: &System, seen: &Seen, stills: &[&Still]) -> BTreeSet<u32> {
    let elements = system.bodies.iter().flat_map(|body| body.cells());
    let elements: Vec<_> = elements.collect();
    let cells = stills
        .iter()
        .flat_map(|still| still.largest.iter().flatten());
    let nodes =
        cells.flat_map(|largest| system.mesh.element_nodes(*elements[largest.cell as usize]));
    let places = nodes.filter_map(|node| seen.node(system.number[*node as usize]));
    places.map(|place| place as u32).collect()
}

/// The body of each node that is seen; of a node of several the first.
fn bodies_of_nodes(system: &System, seen: &Seen) -> Vec<u32> {
    let mut of = vec![u32::MAX; seen.nodes.len()];
    for (number, body) in system.bodies.iter().enumerate() {
        for cell in body.cells() {
            for node in system.mesh.element_nodes(*cell) {
                let place = seen.node(system.number[*node as usize]);
                if let Some(of) = place
                    .map(|place| &mut of[place])
                    .filter(|of| **of == u32::MAX)
                {
                    *of = number as u32;
                }
            }
        }
    }
    of.iter()
        .map(|body| if *body == u32::MAX { 0 } else { *body })
        .collect()
}

fn frame(
    system: &System,
    still: &Still,
    (chosen, body): (&Chosen, &[u32]),
    block: &mut Block,
) -> Frame {
    // rigid motion of a body would take the levels that its deformation needs
    let (mut sums, mut counts) = (
        vec![[0.0; 3]; system.bodies.len()],
        vec![0; system.bodies.len()],
    );
    for n in &chosen.nodes {
        let (moved, of) = (still.moved[*n as usize], body[*n as usize] as usize);
        sums[of] = [0, 1, 2].map(|i| sums[of][i] + f64::from(moved[i]));
        counts[of] += 1;
    }
    let mean = |(sum, count): (&[f64; 3], &i32)| sum.map(|s| s / f64::from((*count).max(1)));
    let offsets: Vec<[f64; 3]> = sums.iter().zip(&counts).map(mean).collect();
    let along = |i: usize| {
        let nodes = chosen.nodes.iter();
        let offsets = &offsets;
        nodes.map(move |n| {
            f64::from(still.moved[*n as usize][i]) - offsets[body[*n as usize] as usize][i]
        })
    };
    let moved = [0, 1, 2].map(|i| block.levels(along(i), FINE));
    let mut values: BTreeMap<&'static str, Array> = BTreeMap::new();
    let of_nodes = |values: &'_ [f32]| -> Vec<f64> {
        chosen
            .nodes
            .iter()
            .map(|n| f64::from(values[*n as usize]))
            .collect()
    };
    let of_cells = |values: &'_ [f32]| -> Vec<f64> {
        chosen
            .cells
            .iter()
            .map(|c| f64::from(values[*c as usize]))
            .collect()
    };
    values.insert(
        "speed",
        block.levels(of_nodes(&still.speed).into_iter(), COARSE),
    );
    values.insert(
        "von_mises",
        block.levels(of_cells(&still.von_mises).into_iter(), COARSE),
    );
    values.insert(
        "principal",
        block.levels(of_cells(&still.principal).into_iter(), COARSE),
    );
    values.insert(
        "pressure",
        block.levels(of_cells(&still.pressure).into_iter(), COARSE),
    );
    if let Some(plastic) = &still.plastic {
        values.insert(
            "plastic",
            block.levels(of_cells(plastic).into_iter(), COARSE),
        );
    }
    if !still.contact.is_empty() {
        let pressure = chosen
            .nodes
            .iter()
            .map(|n| f64::from(still.contact[*n as usize].0));
        values.insert("contact", block.levels(pressure, COARSE));
        let status = chosen.nodes.iter().map(|n| still.contact[*n as usize].1);
        values.insert("status", block.bytes(status));
    }
    Frame {
        time: still.time,
        kinds: Vec::new(),
        offsets,
        moved,
        values,
        largest: peaks(system, still),
        poses: poses(system, still.time),
        visible: None,
    }
}

/// The largest stress and plastic strain of all cells, those inside included.
fn peaks(system: &System, still: &Still) -> BTreeMap<&'static str, Peak> {
    let fields = ["von_mises", "plastic"].into_iter().zip(&still.largest);
    let found = fields.filter_map(|(id, largest)| {
        let largest = largest.filter(|largest| largest.value > 0.0)?;
        let peak = Peak {
            value: largest.value,
            place: middle(system, largest.cell)?,
            moved: largest.moved,
        };
        Some((id, peak))
    });
    found.collect()
}

/// The obstacles in the order of their contacts, as many as are drawn.
fn rigid(system: &System) -> impl Iterator<Item = (usize, &carom_contact::Obstacle)> {
    let contacts = system.contacts.iter().enumerate();
    let rigid = contacts.filter_map(|(number, contact)| match &contact.target {
        Target::Rigid(obstacle) => Some((number, obstacle)),
        Target::Surface(_) => None,
    });
    rigid.take(OBSTACLES)
}

fn poses(system: &System, time: f64) -> Vec<[f64; 12]> {
    match rigid(system).any(|(_, obstacle)| obstacle.motion.moves()) {
        true => rigid(system)
            .map(|(_, obstacle)| obstacles::pose(obstacle, time))
            .collect(),
        false => Vec::new(),
    }
}

/// The box of the secondary points of each contact over all instants, larger by its own size, in the plane with what the obstacle moves.
fn box_of(system: &System, results: &Results) -> Vec<Near> {
    let seen = &results.stills.seen;
    let all = instants(results);
    let least = 0.02 * size(system);
    let of = |contact: &ContactPair| {
        let [mut low, mut high] = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for (still, _) in &all {
            let own = contact.points.iter().filter(|point| !point.is_on_primary());
            for node in own.map(carom_contact::Point::node) {
                let Some(place) = seen.node(node) else {
                    continue;
                };
                let x = system.x[node as usize];
                for i in 0..3 {
                    let now = x[i] + f64::from(still.moved[place][i]);
                    (low[i], high[i]) = (low[i].min(now), high[i].max(now));
                }
            }
        }
        let longest = (0..3).map(|i| high[i] - low[i]).fold(least, f64::max);
        if let Target::Rigid(obstacle) = &contact.target {
            let (first, last) = (low, high);
            for (still, _) in &all {
                // at time 0 it lies where it is before its motion
                let moved = obstacle.displacement(still.time);
                for i in 0..3 {
                    low[i] = low[i].min(first[i] - moved[i]);
                    high[i] = high[i].max(last[i] - moved[i]);
                }
            }
        }
        let margin = 0.35 * longest;
        [low.map(|x| x - margin), high.map(|x| x + margin)]
    };
    system.contacts.iter().map(of).collect()
}

fn drawn_obstacles(
    contacts: &[ContactPair],
    (system, near): (&System, &[Near]),
    block: &mut Block,
) -> Vec<Obstacle> {
    let one = |(number, obstacle): (usize, &carom_contact::Obstacle)| {
        let drawn = obstacles::drawn(obstacle, system.dim, &near[number]);
        Obstacle {
            name: contacts[number].name.clone(),
            triangles: block.reals(drawn.triangles.into_iter().flatten()),
            lines: block.reals(drawn.lines.into_iter().flatten()),
        }
    };
    rigid(system).map(one).collect()
}
