//! Marks and names of what acts on the model.

use std::collections::BTreeSet;

use carom_dynamics::System;
use carom_pages::page::block::Block;
use carom_pages::page::schema::Sign;
use carom_pages::plot::What;

use crate::results::page::chosen::Chosen;
use crate::results::signs::signs;
use crate::results::stills::Seen;

/// Most marks of one sign; of more only every second, third, … is there.
const MARKS: usize = 60;

/// Most signs, those with something to see before the names of bodies.
const SIGNS: usize = 200;

/// The signs of a system at nodes of the page.
pub(super) fn marks(system: &System, of: (&Seen, &Chosen), block: &mut Block) -> Vec<Sign> {
    let (seen, chosen) = of;
    let find = |node: u32| chosen.find(seen.node(node)? as u32);
    let mut marks = Vec::new();
    for sign in signs(system) {
        let what = match sign.what {
            What::Body => "body",
            What::Support => "support",
            What::Load => "load",
            What::Mass => "mass",
            What::Link => "link",
            What::Contact => "contact",
            // its surface is in the page
            What::Primary => continue,
        };
        let (mut nodes, mut ways): (Vec<Vec<u32>>, Vec<[f64; 3]>) = Default::default();
        let mut once = BTreeSet::new();
        let group = if sign.what == What::Link { 2 } else { 1 };
        for (k, ends) in sign.nodes.chunks(group).enumerate() {
            let found: Option<Vec<u32>> = ends.iter().map(|&node| find(node)).collect();
            let Some(found) = found.filter(|found| once.insert(found.clone())) else {
                continue;
            };
            nodes.push(found);
            ways.extend(sign.ways.get(k));
        }
        if nodes.is_empty() {
            continue;
        }
        let each = nodes.len().div_ceil(MARKS);
        marks.push(Sign {
            what,
            label: sign.label,
            nodes: block.indices(nodes.iter().step_by(each).flatten().copied()),
            ways: block.reals(ways.iter().step_by(each).flatten().copied()),
        });
    }
    marks.sort_by_key(|sign| sign.what == "body");
    marks.truncate(SIGNS);
    marks
}
