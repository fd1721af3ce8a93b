//! Entities, nodes and elements of MSH 4.1.

use std::collections::BTreeMap;

use carom_elements::{Kind, MAX_NODES};

use super::builder::Builder;
use super::cursor::{Cursor, Fault};
use super::kind::kind;

/// Tags of the physical groups of each geometric entity, by dimension and tag of the entity.
pub(super) type Entities = BTreeMap<(u64, i64), Vec<u64>>;

/// Reads `$Entities`: four counts, then points, curves, surfaces and volumes.
pub(super) fn entities(cursor: &mut Cursor, entities: &mut Entities) -> Result<(), Fault> {
    const THINGS: [&str; 4] = ["point", "curve", "surface", "volume"];
    let mut counts = [0; 4];
    for count in &mut counts {
        let size = cursor.size("the number of entities of a dimension")?;
        *count = cursor.bounded(size, 5)?;
    }
    cursor.end_record()?;
    for dim in 0..4 {
        let count = counts[dim];
        for i in 0..count {
            let entity = entity(cursor, dim as u64, entities);
            entity.map_err(|fault| fault.within(THINGS[dim], i, count))?;
        }
    }
    Ok(())
}

/// Reads an entity: tag, place (of a point) or bounding box, physical groups and, but for a point, what bounds it.
fn entity(cursor: &mut Cursor, dim: u64, entities: &mut Entities) -> Result<(), Fault> {
    let tag = cursor.integer("the tag of an entity")?;
    for _ in 0..if dim == 0 { 3 } else { 6 } {
        cursor.real("a coordinate of an entity")?;
    }
    let count = cursor.size("the number of physical groups of an entity")?;
    let groups = entities.entry((dim, tag)).or_default();
    for _ in 0..cursor.bounded(count, 1)? {
        groups.push(
            cursor
                .integer("the tag of a physical group")?
                .unsigned_abs(),
        );
    }
    if dim > 0 {
        let count = cursor.size("the number of bounding entities")?;
        for _ in 0..cursor.bounded(count, 1)? {
            cursor.integer("the tag of a bounding entity")?;
        }
    }
    cursor.end_record()
}

/// Reads `$Nodes`: number of blocks, number of nodes, least and greatest tag, then the blocks.
pub(super) fn nodes(cursor: &mut Cursor, builder: &mut Builder) -> Result<(), Fault> {
    let (blocks, total) = totals(cursor, "nodes")?;
    let mut left = total;
    for i in 0..blocks {
        let block = node_block(cursor, builder, left);
        left -= block.map_err(|fault| fault.within("node block", i, blocks))?;
    }
    all_read(cursor, "nodes", total, left)?;
    builder.sort_nodes()
}

/// Reads a block of at most `left` nodes, all tags first, and returns how many there were.
fn node_block(cursor: &mut Cursor, builder: &mut Builder, left: usize) -> Result<usize, Fault> {
    let dim = entity_dimension(cursor)?;
    cursor.integer("the tag of an entity")?;
    let expected = "0 or 1: whether the nodes have parameters";
    let parameters = match cursor.natural(expected)? {
        0 => 0,
        1 => dim,
        other => return Err(cursor.fault(other, expected)),
    };
    let size = block_size(cursor, left)?;
    let mut tags = Vec::with_capacity(size);
    for _ in 0..size {
        tags.push((cursor.size("a node tag")?, cursor.last()));
        cursor.end_record()?;
    }
    for (tag, at) in tags {
        let x = cursor.point()?;
        for _ in 0..parameters {
            cursor.real("a parameter of a node")?;
        }
        cursor.end_record()?;
        builder.add_node(tag, at, x);
    }
    Ok(size)
}

/// Reads `$Elements`: number of blocks, number of elements, least and greatest tag, then the blocks.
///
/// `entities` is none in a file without `$Entities`, where elements are in no group.
pub(super) fn elements(
    cursor: &mut Cursor,
    builder: &mut Builder,
    entities: Option<&Entities>,
) -> Result<(), Fault> {
    let (blocks, total) = totals(cursor, "elements")?;
    let mut left = total;
    for i in 0..blocks {
        let block = element_block(cursor, builder, entities, left);
        left -= block.map_err(|fault| fault.within("element block", i, blocks))?;
    }
    all_read(cursor, "elements", total, left)
}

/// Reads a block of at most `left` elements of one entity and returns how many there were.
fn element_block(
    cursor: &mut Cursor,
    builder: &mut Builder,
    entities: Option<&Entities>,
    left: usize,
) -> Result<usize, Fault> {
    let dim = entity_dimension(cursor)?;
    let tag = cursor.integer("the tag of an entity")?;
    let groups = match entities.map(|entities| entities.get(&(dim, tag))) {
        None => &[][..],
        Some(Some(groups)) => groups,
        Some(None) => {
            let found = format!("entity {tag} of dimension {dim}");
            return Err(cursor.fault(found, "an entity listed before, in $Entities"));
        }
    };
    let kind = kind(cursor)?;
    if kind.table().dim as u64 != dim {
        let expected = format!("a type of dimension {dim}, that of the entity");
        return Err(cursor.fault(format!("element type {}", kind.table().name), expected));
    }
    let size = block_size(cursor, left)?;
    for _ in 0..size {
        element(cursor, builder, kind, groups)?;
    }
    Ok(size)
}

fn element(
    cursor: &mut Cursor,
    builder: &mut Builder,
    kind: Kind,
    groups: &[u64],
) -> Result<(), Fault> {
    cursor.size("an element tag")?;
    let mut buffer = [0; MAX_NODES];
    let nodes = &mut buffer[..kind.table().nodes];
    for node in nodes.iter_mut() {
        let tag = cursor.size("a node tag")?;
        *node = builder.node(tag, cursor.last())?;
    }
    builder.add_element(kind, nodes, groups);
    cursor.end_record()
}

/// Reads the head of `$Nodes` or `$Elements`: the numbers of blocks and of things, both bounded.
fn totals(cursor: &mut Cursor, things: &str) -> Result<(usize, usize), Fault> {
    let blocks = cursor.size("the number of blocks")?;
    let blocks = cursor.bounded(blocks, 4)?;
    let total = cursor.size(&format!("the number of {things}"))?;
    let total = cursor.bounded(total, 2)?;
    cursor.size("the least tag")?;
    cursor.size("the greatest tag")?;
    cursor.end_record()?;
    Ok((blocks, total))
}

fn entity_dimension(cursor: &mut Cursor) -> Result<u64, Fault> {
    let expected = "the dimension of an entity, 0 to 3";
    match cursor.natural(expected)? {
        dim @ 0..=3 => Ok(dim),
        other => Err(cursor.fault(other, expected)),
    }
}

/// Reads the size of a block and ends its head.
fn block_size(cursor: &mut Cursor, left: usize) -> Result<usize, Fault> {
    let size = cursor.size("the size of a block")?;
    let bounded = usize::try_from(size).ok().filter(|&size| size <= left);
    let size = bounded.ok_or_else(|| {
        let expected = format!("at most {left}, which is what the head of the section leaves");
        cursor.fault(format!("a block of {size}"), expected)
    })?;
    cursor.end_record()?;
    Ok(size)
}

fn all_read(cursor: &Cursor, things: &str, total: usize, left: usize) -> Result<(), Fault> {
    if left == 0 {
        return Ok(());
    }
    let found = format!("a total of {} {things} in the blocks", total - left);
    Err(cursor.fault(found, format!("{total}, as the head of the section says")))
}
