//! What the interactive report shows of a run: gathered while it goes ([`series`], [`raster`]), put together when it has ended.

mod chosen;
mod decimate;
mod marks;
pub(crate) mod model;
mod obstacles;
mod plots;
pub(crate) mod quality;
pub(crate) mod raster;
pub(crate) mod series;
mod sides;
mod surface;
pub(crate) mod tiles;

use carom_pages::page::Data;
use carom_pages::page::block::Block;
use carom_pages::page::schema::{Event, Page, Quantity, Raster, RasterRows, SCHEMA};
use carom_pages::plot::PSEUDO_TIME;

use crate::results::Results;
use model::{CLOSING, LARGEST, RELEASE};
pub(crate) use plots::Sources;

/// The head of the page with its arrays. `qualities`: of the cells of all bodies.
pub(crate) fn data(sources: &Sources, qualities: &[f64]) -> Data {
    let results = sources.results;
    let mut block = Block::default();
    let model = model::model(results, qualities, &mut block);
    let plots = plots::plots(sources, &mut block);
    let (name, unit) = match results.is_static() {
        true => (PSEUDO_TIME.quantity, PSEUDO_TIME.unit),
        false => ("time", "s"),
    };
    let page = Page {
        schema: SCHEMA,
        abscissa: Quantity {
            name: name.to_owned(),
            unit,
        },
        begin: results.stills.begin(),
        end: results.last.time,
        events: events(results),
        plots,
        raster: raster(results, &mut block),
        model,
    };
    Data { page, block }
}

/// Instants that the plots mark: those that were kept for a reason of the contacts.
fn events(results: &Results) -> Vec<Event> {
    let instants = model::instants(results);
    let named = instants.iter().flat_map(|(still, kinds)| {
        let own = kinds
            .iter()
            .filter(|kind| [CLOSING, LARGEST, RELEASE].contains(kind));
        own.map(|kind| Event {
            time: still.time,
            name: (*kind).to_owned(),
        })
    });
    named.collect()
}

fn raster(results: &Results, block: &mut Block) -> Option<Raster> {
    let (system, own) = (&results.system, &results.raster);
    let ever = own.cells.iter().any(|cell| *cell > 1);
    if own.cells.is_empty() || !ever {
        return None;
    }
    let (mut rows, mut cells, mut first) = (Vec::new(), Vec::new(), 0);
    for (contact, count) in system.contacts.iter().zip(&own.rows) {
        let all = &own.cells[first * raster::COLUMNS..(first + count) * raster::COLUMNS];
        first += count;
        // most pairs of a general contact never meet
        if contact.near_only && all.iter().all(|cell| *cell <= 1) {
            continue;
        }
        cells.extend_from_slice(all);
        rows.push(RasterRows {
            name: contact.name.clone(),
            rows: *count,
            points: contact.points.len(),
        });
    }
    Some(Raster {
        id: "plot-status",
        columns: raster::COLUMNS,
        begin: own.begin(),
        end: own.end(),
        contacts: rows,
        cells: block.bytes(cells),
        note: "a row is a contact point, or neighbours in the order of the mesh of which one at least is closed".to_owned(),
    })
}
