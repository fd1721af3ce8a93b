//! Fields on a mesh, as a VTK unstructured grid (`.vtu`) that ParaView and VTK read.
//!
//! Arrays are appended raw and compressed by zlib in blocks: nine times smaller and three times faster to write than
//! the inline form. Layout of one array in the appended data, all integers unsigned 64-bit little-endian: number of
//! blocks, length of a block before compression, length of the last block if it is shorter (else 0), compressed
//! length of each block, then the compressed blocks. Source: VTK file formats, XML, "appended", "compressor".

use std::fmt::Write as _;
use std::io::{self, Write};
use std::path::Path;

use carom_elements::{Kind, MAX_NODES};
use carom_pages::escape;
use flate2::Compression;
use flate2::write::ZlibEncoder;

use crate::{Error, atomic};

/// Bytes of one block before compression.
const BLOCK: usize = 1 << 18;

/// A grid with its fields at one instant, borrowed from whoever has them.
#[derive(Clone, Copy, Debug)]
pub struct Grid<'a> {
    /// Instant, s: stored in the file as `TimeValue`.
    pub time: f64,
    /// Coordinates, m; three components in any dimension.
    pub points: &'a [[f64; 3]],
    /// Cells, in blocks of one kind.
    pub cells: &'a [Cells<'a>],
    /// Fields with one value per point.
    pub point_fields: &'a [Field<'a>],
    /// Fields with one value per cell, in the order of the blocks.
    pub cell_fields: &'a [Field<'a>],
}

/// Cells of one kind.
#[derive(Clone, Copy, Debug)]
pub struct Cells<'a> {
    /// Their kind.
    pub kind: Kind,
    /// Point numbers counted from zero, one cell after the other.
    pub nodes: &'a [u32],
}

/// A named field.
#[derive(Clone, Copy, Debug)]
pub struct Field<'a> {
    /// Name as the viewer shows it: `displacement`, `stress`.
    pub name: &'a str,
    /// Its values, SI.
    pub values: Values<'a>,
}

/// The values of a field, one entry per point or per cell. There is no two-component vector on purpose: viewers
/// take three as a vector and anything else as unrelated columns.
#[derive(Clone, Copy, Debug)]
pub enum Values<'a> {
    /// A number.
    Scalar(&'a [f64]),
    /// A vector; its third component is zero in two dimensions.
    Vector(&'a [[f64; 3]]),
    /// A symmetric tensor in VTK's order xx, yy, zz, xy, yz, xz.
    SymmetricTensor(&'a [[f64; 6]]),
    /// An integer: a sign field, a body number.
    Integer(&'a [i32]),
}

impl Values<'_> {
    fn len(&self) -> usize {
        match self {
            Values::Scalar(values) => values.len(),
            Values::Vector(values) => values.len(),
            Values::SymmetricTensor(values) => values.len(),
            Values::Integer(values) => values.len(),
        }
    }

    fn components(&self) -> usize {
        match self {
            Values::Scalar(_) | Values::Integer(_) => 1,
            Values::Vector(_) => 3,
            Values::SymmetricTensor(_) => 6,
        }
    }

    fn vtk_type(&self) -> &'static str {
        match self {
            Values::Integer(_) => "Int32",
            Values::Scalar(_) | Values::Vector(_) | Values::SymmetricTensor(_) => "Float64",
        }
    }

    fn bytes(&self) -> Vec<u8> {
        match self {
            Values::Scalar(values) => float_bytes(values),
            Values::Vector(values) => float_bytes(values.as_flattened()),
            Values::SymmetricTensor(values) => float_bytes(values.as_flattened()),
            Values::Integer(values) => values
                .iter()
                .flat_map(|value| value.to_le_bytes())
                .collect(),
        }
    }
}

/// Writes the grid as one `.vtu` file, whole or not at all.
///
/// # Errors
/// [`Error::FieldLength`], [`Error::Connectivity`], [`Error::MissingPoint`] if the parts of the grid do not fit each
/// other; [`Error::File`] if the system refuses.
pub fn write(path: &Path, grid: &Grid) -> Result<(), Error> {
    check(grid)?;
    let document = Document::new(grid).map_err(Error::file("write", path))?;
    atomic::write(path, |to| document.write(to))
}

/// The text of a file (`.pvtu`) that lists the pieces of a grid by their names, with the fields of one of them.
pub(crate) fn list(grid: &Grid, pieces: &[String]) -> String {
    let mut text = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" \
         header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n<PUnstructuredGrid GhostLevel=\"0\">\n",
    );
    let mut arrays = |of: &str, fields: &[Field]| {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "<P{of}>");
        for field in fields {
            let _ = writeln!(
                text,
                "<PDataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\"/>",
                field.values.vtk_type(),
                escape(field.name),
                field.values.components()
            );
        }
        let _ = writeln!(text, "</P{of}>");
    };
    arrays("PointData", grid.point_fields);
    arrays("CellData", grid.cell_fields);
    let points = Field {
        name: "Points",
        values: Values::Vector(grid.points),
    };
    arrays("Points", &[points]);
    for piece in pieces {
        let _ = writeln!(text, "<Piece Source=\"{}\"/>", escape(piece));
    }
    text.push_str("</PUnstructuredGrid>\n</VTKFile>\n");
    text
}

/// Says the first thing in which the parts of the grid do not fit each other.
fn check(grid: &Grid) -> Result<(), Error> {
    let mut cell_count = 0;
    for cells in grid.cells {
        let kind = cells.kind;
        let per_cell = kind.table().nodes;
        if !cells.nodes.len().is_multiple_of(per_cell) {
            return Err(Error::Connectivity {
                kind,
                found: cells.nodes.len(),
            });
        }
        cell_count += cells.nodes.len() / per_cell;
        let points = grid.points.len();
        if let Some(&node) = cells.nodes.iter().find(|node| **node as usize >= points) {
            return Err(Error::MissingPoint { kind, node, points });
        }
    }
    check_lengths(grid.point_fields, "points", grid.points.len())?;
    check_lengths(grid.cell_fields, "cells", cell_count)
}

fn check_lengths(fields: &[Field], of: &'static str, expected: usize) -> Result<(), Error> {
    match fields.iter().find(|field| field.values.len() != expected) {
        Some(field) => Err(Error::FieldLength {
            name: field.name.to_owned(),
            of,
            expected,
            found: field.values.len(),
        }),
        None => Ok(()),
    }
}

/// The XML header, grown together with the compressed arrays that it points into.
struct Document {
    header: String,
    appended: Vec<u8>,
}

impl Document {
    fn new(grid: &Grid) -> io::Result<Document> {
        let mut document = Document {
            header: String::new(),
            appended: Vec::new(),
        };
        let cell_count: usize = grid
            .cells
            .iter()
            .map(|cells| cells.nodes.len() / cells.kind.table().nodes)
            .sum();
        document.text(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" \
             header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n<UnstructuredGrid>\n<FieldData>\n",
        );
        document.array(
            "TimeValue",
            "Float64",
            " NumberOfTuples=\"1\"",
            &grid.time.to_le_bytes(),
        )?;
        let points = grid.points.len();
        document.text(&format!(
            "</FieldData>\n<Piece NumberOfPoints=\"{points}\" NumberOfCells=\"{cell_count}\">\n<PointData>\n"
        ));
        document.fields(grid.point_fields)?;
        document.text("</PointData>\n<CellData>\n");
        document.fields(grid.cell_fields)?;
        document.text("</CellData>\n<Points>\n");
        let coordinates = Field {
            name: "Points",
            values: Values::Vector(grid.points),
        };
        document.fields(&[coordinates])?;
        document.text("</Points>\n<Cells>\n");
        document.cells(grid.cells)?;
        document.text("</Cells>\n</Piece>\n</UnstructuredGrid>\n");
        Ok(document)
    }

    fn write(&self, to: &mut dyn Write) -> io::Result<()> {
        to.write_all(self.header.as_bytes())?;
        to.write_all(b"<AppendedData encoding=\"raw\">\n_")?;
        to.write_all(&self.appended)?;
        to.write_all(b"\n</AppendedData>\n</VTKFile>\n")
    }

    fn text(&mut self, text: &str) {
        self.header.push_str(text);
    }

    fn fields(&mut self, fields: &[Field]) -> io::Result<()> {
        for field in fields {
            let components = format!(" NumberOfComponents=\"{}\"", field.values.components());
            self.array(
                field.name,
                field.values.vtk_type(),
                &components,
                &field.values.bytes(),
            )?;
        }
        Ok(())
    }

    /// Connectivity, end of each cell in it, and type of each cell.
    fn cells(&mut self, blocks: &[Cells]) -> io::Result<()> {
        let mut connectivity = Vec::new();
        let mut offsets = Vec::new();
        let mut types = Vec::new();
        let mut end = 0_i64;
        for block in blocks {
            let table = block.kind.table();
            for nodes in block.nodes.chunks_exact(table.nodes) {
                let mut listed = [0_i64; MAX_NODES];
                for (&node, &place) in nodes.iter().zip(table.vtk_order) {
                    listed[place] = i64::from(node);
                }
                let listed = listed[..table.nodes].iter();
                connectivity.extend(listed.flat_map(|node| node.to_le_bytes()));
                end += table.nodes as i64;
                offsets.extend_from_slice(&end.to_le_bytes());
                types.push(table.vtk);
            }
        }
        self.array("connectivity", "Int64", "", &connectivity)?;
        self.array("offsets", "Int64", "", &offsets)?;
        self.array("types", "UInt8", "", &types)
    }

    fn array(
        &mut self,
        name: &str,
        vtk_type: &str,
        attributes: &str,
        bytes: &[u8],
    ) -> io::Result<()> {
        let name = escape(name);
        let offset = self.appended.len();
        // Writing to a String cannot fail.
        let _ = writeln!(
            self.header,
            "<DataArray type=\"{vtk_type}\" Name=\"{name}\"{attributes} format=\"appended\" offset=\"{offset}\"/>"
        );
        compress(bytes, &mut self.appended)
    }
}

/// Appends an array in VTK's compressed layout (head of this file).
fn compress(bytes: &[u8], to: &mut Vec<u8>) -> io::Result<()> {
    let blocks = bytes.len().div_ceil(BLOCK);
    let mut head = |value: usize| to.extend_from_slice(&(value as u64).to_le_bytes());
    head(blocks);
    head(BLOCK);
    head(bytes.len() % BLOCK);
    let mut slot = to.len();
    to.resize(slot + 8 * blocks, 0);
    for block in bytes.chunks(BLOCK) {
        let start = to.len();
        let mut zlib = ZlibEncoder::new(&mut *to, Compression::fast());
        zlib.write_all(block)?;
        zlib.finish()?;
        let length = (to.len() - start) as u64;
        to[slot..slot + 8].copy_from_slice(&length.to_le_bytes());
        slot += 8;
    }
    Ok(())
}

fn float_bytes(values: &[f64]) -> Vec<u8> {
    values
        .iter()
        .flat_map(|value| value.to_le_bytes())
        .collect()
}
