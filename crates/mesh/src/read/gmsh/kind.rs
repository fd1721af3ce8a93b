//! Types of elements in Gmsh files.

use carom_elements::Kind;

use super::cursor::{Cursor, Fault};

/// Reads the type of an element.
pub(super) fn kind(cursor: &mut Cursor) -> Result<Kind, Fault> {
    let number = cursor.natural("an element type")?;
    let known = u32::try_from(number).ok().and_then(Kind::from_gmsh);
    known.ok_or_else(|| {
        let known = Kind::ALL.map(Kind::table);
        let accepted = known.map(|kind| format!("{} ({})", kind.gmsh, kind.name));
        let found = match TYPE_NAMES.iter().find(|(known, _)| *known == number) {
            Some((_, name)) => format!("element type {number} ({name})"),
            None => format!("element type {number}"),
        };
        cursor.unsupported(found, accepted.join(", "))
    })
}

/// Common Gmsh types that are not read, to be called by name.
const TYPE_NAMES: &[(u64, &str)] = &[
    (13, "18-node second order prism"),
    (14, "14-node second order pyramid"),
    (19, "13-node second order pyramid"),
    (21, "10-node third order triangle"),
    (26, "4-node third order line"),
    (29, "20-node third order tetrahedron"),
    (36, "16-node third order quadrangle"),
    (92, "64-node third order hexahedron"),
];
