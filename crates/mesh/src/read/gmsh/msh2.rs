//! Nodes and elements of MSH 2.2.

use carom_elements::{Kind, MAX_NODES};

use super::builder::Builder;
use super::cursor::{Cursor, Fault};
use super::kind::kind;

/// Reads `$Nodes`: the count in text, then for each node its tag and coordinates.
pub(super) fn nodes(cursor: &mut Cursor, builder: &mut Builder) -> Result<(), Fault> {
    let count = cursor.written("the number of nodes")?;
    let count = cursor.bounded(count, 4)?;
    cursor.end_line()?;
    for i in 0..count {
        node(cursor, builder).map_err(|fault| fault.within("node", i, count))?;
    }
    builder.sort_nodes()
}

fn node(cursor: &mut Cursor, builder: &mut Builder) -> Result<(), Fault> {
    let tag = cursor.natural("a node tag")?;
    let at = cursor.last();
    let x = cursor.point()?;
    builder.add_node(tag, at, x);
    cursor.end_record()
}

/// Reads `$Elements`: the count in text, then in a text file `number type tags nodes` on a line for each element,
/// in a binary one batches of a type, a size and a number of tags, followed by their elements.
pub(super) fn elements(cursor: &mut Cursor, builder: &mut Builder) -> Result<(), Fault> {
    let count = cursor.written("the number of elements")?;
    let count = cursor.bounded(count, 2)?;
    cursor.end_line()?;
    let mut done = 0;
    while done < count {
        let batch = match cursor.is_text() {
            true => line(cursor, builder).map(|()| 1),
            false => batch(cursor, builder, count - done),
        };
        done += batch.map_err(|fault| fault.within("element", done, count))?;
    }
    Ok(())
}

fn line(cursor: &mut Cursor, builder: &mut Builder) -> Result<(), Fault> {
    cursor.natural("an element number")?;
    let kind = kind(cursor)?;
    let tags = number_of_tags(cursor)?;
    tags_and_nodes(cursor, builder, kind, tags)?;
    cursor.end_line()
}

/// Reads a batch of at most `most` elements and returns how many there were.
fn batch(cursor: &mut Cursor, builder: &mut Builder, most: usize) -> Result<usize, Fault> {
    let kind = kind(cursor)?;
    let size = cursor.natural("the number of elements of this type")?;
    let size = match usize::try_from(size) {
        Ok(size) if (1..=most).contains(&size) => size,
        _ => return Err(cursor.fault(size, format!("1 to {most} elements in a batch"))),
    };
    let tags = number_of_tags(cursor)?;
    for _ in 0..size {
        cursor.natural("an element number")?;
        tags_and_nodes(cursor, builder, kind, tags)?;
    }
    Ok(size)
}

fn number_of_tags(cursor: &mut Cursor) -> Result<usize, Fault> {
    let tags = cursor.natural("the number of tags of an element")?;
    cursor.bounded(tags, 1)
}

/// Reads the tags of an element, of which the first is that of its physical group or 0, and its nodes.
fn tags_and_nodes(
    cursor: &mut Cursor,
    builder: &mut Builder,
    kind: Kind,
    tags: usize,
) -> Result<(), Fault> {
    let mut physical = 0;
    for i in 0..tags {
        let tag = cursor.integer("a tag of an element")?;
        if i == 0 {
            physical = tag.unsigned_abs();
        }
    }
    let mut buffer = [0; MAX_NODES];
    let nodes = &mut buffer[..kind.table().nodes];
    for node in nodes.iter_mut() {
        let tag = cursor.natural("a node tag")?;
        *node = builder.node(tag, cursor.last())?;
    }
    let physicals = if physical == 0 { &[][..] } else { &[physical] };
    builder.add_element(kind, nodes, physicals);
    Ok(())
}
