//! The input format of Abaqus and CalculiX (`.inp`): its mesh, sets and surfaces. All else in the file (materials, steps, ...) is skipped.
//!
//! **Elements.** By the family and the number of nodes of their type (`C3D8R` is a hexahedron with eight nodes; what the type says
//! of integration or of hourglass modes is for the case to say): solids, plane and axisymmetric cells, shells, membranes,
//! rigid facets, beams, trusses of two nodes, masses. Other types are refused by name.
//!
//! **Groups.** An element set becomes the group of its name; one that has elements of several dimensions is refused. A surface of element faces
//! becomes a group of facets, of the faces of cells or of shells themselves (`SPOS`, `SNEG`: [`Surface`](crate::Surface) orients facets by their cells).
//! A node set, and a surface of nodes, becomes a group of points. Names are told apart without regard to case, as the format has it.
//! Where names of several sorts are the same, the element set has it, or else the surface; the surface is then called `name.surface`,
//! the node set `name.nodes`.
//!
//! **Nodes.** All are kept, in file order, whatever their numbers. The dimension is found as for [Gmsh's files](super::gmsh).
//!
//! **Parts.** A file may have one `*PART` and one `*INSTANCE` that stands where its part does; with more of them numbers would not be
//! unique, and places would be those of parts. Generation of nodes and elements (`*NGEN`, ...) and `*INCLUDE` are refused.
//!
//! References: Abaqus Keywords Reference Guide (`*NODE`, `*ELEMENT`, `*NSET`, `*ELSET`, `*SURFACE`) and Elements Guide (node order and numbers of
//! faces); CalculiX CrunchiX user's manual, chapter *Element types*.

mod builder;
mod card;
mod fault;
mod kinds;

use std::path::Path;

use super::{Place, ReadError};
use crate::Mesh;
use builder::Builder;
use card::{Card, cards};
use fault::Fault;

/// Reads the mesh in the content of a file; `path` is only for messages.
///
/// Fails at the first thing that is malformed or of a sort that is not read, with its line.
pub fn parse(path: &Path, content: &[u8]) -> Result<Mesh, ReadError> {
    let text = String::from_utf8_lossy(content);
    read(&text).map_err(|fault| {
        let told = (fault.found, fault.expected);
        ReadError::of_content(path, Place::Line(fault.line), told, fault.unsupported)
    })
}

fn read(text: &str) -> Result<Mesh, Fault> {
    let (mut builder, mut parts) = (Builder::new(), [0; 2]);
    let cards = cards(text)?;
    for card in &cards {
        match card.name.as_str() {
            "NODE" => builder.nodes(card)?,
            "ELEMENT" => builder.elements(card)?,
            "NSET" => builder.node_set(card)?,
            "ELSET" => builder.element_set(card)?,
            "SURFACE" => builder.surface(card)?,
            "PART" | "INSTANCE" => {
                let count = &mut parts[usize::from(card.name == "INSTANCE")];
                *count += 1;
                placed(card, *count)?;
            }
            "INCLUDE" | "NGEN" | "NFILL" | "NCOPY" | "NMAP" | "ELGEN" | "ELCOPY" => {
                let accepted = "a file with all nodes and elements";
                let found = format!("*{}", card.name);
                return Err(Fault::unsupported(card.line, found, accepted));
            }
            _ => {}
        }
    }
    builder.finish(text.lines().count())
}

/// Refuses a second part or instance, and an instance that is moved.
fn placed(card: &Card, count: usize) -> Result<(), Fault> {
    let name = card.name.to_lowercase();
    if count > 1 {
        let accepted = "one part (write each part to a file of its own)";
        return Err(Fault::unsupported(
            card.line,
            format!("a second {name}"),
            accepted,
        ));
    }
    match card.data.first() {
        Some(data) if name == "instance" => {
            let accepted = "an instance where its part stands";
            Err(Fault::unsupported(
                data.line,
                "an instance that is moved",
                accepted,
            ))
        }
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests;
