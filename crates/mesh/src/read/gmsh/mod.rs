//! Gmsh's MSH format, versions 2.2 and 4.1, text and binary of either byte order.
//!
//! **Groups.** A physical group becomes a [`Group`](crate::Group) under its name. A group without a name that has
//! elements is called by its dimension and tag, such as `2:17`. A group with a name and without elements is kept,
//! empty. Names must be distinct over all dimensions. Signs of physical tags (reversed orientation) are dropped.
//!
//! **Elements.** Those of [`carom_elements::Kind::ALL`]; any other type is refused by name. All elements of the file are kept, in
//! a group or not, in file order within their kind. MSH 2.2 writes an element once for each physical group that it
//! is in: two elements of one kind on the same nodes are one, in the groups of both.
//!
//! **Nodes.** All are kept, in file order, whatever their tags; tags may have holes and come in any order. The
//! parameters that MSH 4.1 may write behind the coordinates are read and dropped. Elements list their nodes in our order
//! ([`Element::gmsh_order`](carom_elements::Element::gmsh_order)).
//!
//! **Dimension.** [`Mesh::dim`] is the last direction in which some node has a coordinate that is not zero, so a mesh
//! flat in z = 0 is plane and one flat in z = 1 is in space; and at least the dimension of the elements.
//! Beyond it coordinates below 1e-12 of the largest one become zero.
//!
//! **Sections.** They may come several times, `$MeshFormat` too (Gmsh writes another when it appends a view);
//! `$Nodes` and `$Entities` come before the `$Elements` that use them. Sections with other names (`$Periodic`,
//! `$NodeData`, ...) are skipped. Partitioned meshes of version 4.1 are refused; the partition numbers of version 2.2
//! are dropped, since there every element is listed once whatever its partitions.
//!
//! Numbers of one record of a text file stand on one line, as the manual has it and Gmsh writes it: a missing number
//! is then found in its own line. Reference: Gmsh 4.15 reference manual, chapter *Gmsh file formats*.

mod builder;
mod cursor;
mod kind;
mod msh2;
mod msh4;

use std::path::Path;

use super::ReadError;
use crate::Mesh;
use builder::Builder;
use cursor::{Cursor, Fault};

#[derive(Clone, Copy, PartialEq, Eq)]
enum Version {
    V22,
    V41,
}

/// Reads the mesh in the content of an MSH file; `path` is only for messages.
///
/// Fails at the first thing that is malformed or of a sort that is not read, with its line in a text file and its
/// byte in a binary one. A count is believed only as far as the rest of the content can hold what it counts.
pub fn parse(path: &Path, content: &[u8]) -> Result<Mesh, ReadError> {
    let mut cursor = Cursor::new(content);
    sections(&mut cursor).map_err(|fault| cursor.error(path, fault))
}

/// Nodes and elements have numbers of 32 bits, and the shortest takes 4 bytes of the file.
const MOST_BYTES: usize = 4 * u32::MAX as usize;

fn sections(cursor: &mut Cursor) -> Result<Mesh, Fault> {
    if cursor.end() > MOST_BYTES {
        let found = format!("a file of {} bytes", cursor.end());
        return Err(cursor.unsupported(found, format!("at most {MOST_BYTES} bytes")));
    }
    cursor.marker("$MeshFormat")?;
    let mut version = format(cursor)?;
    cursor.marker("$EndMeshFormat")?;
    let mut builder = Builder::default();
    let mut entities = None;
    while let Some(name) = cursor.section()? {
        match (name.as_str(), version) {
            ("PhysicalNames", _) => physical_names(cursor, &mut builder)?,
            ("Nodes", Version::V22) => msh2::nodes(cursor, &mut builder)?,
            ("Nodes", Version::V41) => msh4::nodes(cursor, &mut builder)?,
            ("Elements", Version::V22) => msh2::elements(cursor, &mut builder)?,
            ("Elements", Version::V41) => msh4::elements(cursor, &mut builder, entities.as_ref())?,
            ("Entities", Version::V41) => msh4::entities(cursor, entities.get_or_insert_default())?,
            ("MeshFormat", _) => version = format(cursor)?,
            ("ParametricNodes", _) => {
                let accepted = "$Nodes (write the file with Mesh.SaveParametric = 0)";
                return Err(cursor.unsupported("the section $ParametricNodes", accepted));
            }
            ("PartitionedEntities" | "GhostElements", _) => {
                let accepted =
                    "a whole mesh (write the file before partitioning, or unpartition it)";
                return Err(cursor.unsupported(
                    format!("the section ${name} of a partitioned mesh"),
                    accepted,
                ));
            }
            _ => cursor.skip_to(&format!("$End{name}"))?,
        }
        cursor.marker(&format!("$End{name}"))?;
    }
    builder.finish(cursor.end())
}

/// Reads the section `$MeshFormat` behind its mark and sets the encoding of what follows.
fn format(cursor: &mut Cursor) -> Result<Version, Fault> {
    let number = cursor.word("the version of the format")?;
    let version = match number {
        b"2.2" => Version::V22,
        b"4.1" => Version::V41,
        _ => {
            let found = format!("MSH version {}", String::from_utf8_lossy(number));
            let accepted = "2.2, 4.1 (gmsh -format msh41 writes the latter)";
            return Err(cursor.unsupported(found, accepted));
        }
    };
    let binary = match cursor.written::<u8>("0 for text or 1 for binary")? {
        0 => false,
        1 => true,
        other => return Err(cursor.fault(other, "0 for text or 1 for binary")),
    };
    let size = cursor.written::<u8>("the size of a real number, 8")?;
    if size != 8 {
        return Err(cursor.unsupported(format!("real numbers of {size} bytes"), "8 bytes"));
    }
    cursor.end_line()?;
    cursor.set_encoding(binary)?;
    Ok(version)
}

/// Reads `$PhysicalNames`, text in binary files too: the count, then lines `dimension tag "name"`.
fn physical_names(cursor: &mut Cursor, builder: &mut Builder) -> Result<(), Fault> {
    let count = cursor.written("the number of physical names")?;
    let count = cursor.bounded(count, 3)?;
    cursor.end_line()?;
    for i in 0..count {
        physical_name(cursor, builder).map_err(|fault| fault.within("physical name", i, count))?;
    }
    Ok(())
}

fn physical_name(cursor: &mut Cursor, builder: &mut Builder) -> Result<(), Fault> {
    let expected = "the dimension of a physical group, 0 to 3";
    let dim: usize = cursor.written(expected)?;
    if dim > 3 {
        return Err(cursor.fault(dim, expected));
    }
    let tag: i64 = cursor.written("the tag of a physical group")?;
    let name = cursor.quoted()?;
    builder.name((dim, tag.unsigned_abs()), name, cursor.last())?;
    cursor.end_line()
}
