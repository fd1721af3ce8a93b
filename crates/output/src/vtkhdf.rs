//! Fields of all instants in one VTKHDF file, which ParaView and VTK read.
//!
//! An unstructured grid of version 2.0 with the group `Steps`: arrays of all instants one after the other, and where each begins. What
//! does not change from one instant to the next stands there once. The file is made of the `.vtu` files of the instants, which stay
//! beside it: it has the same numbers, and a run that is killed has lost nothing that the `.vtu` files do not have. All arrays are in
//! memory while it is written: hdf5-pure 0.47 appends in place to datasets of rank one, and vectors have rank two.
//!
//! Source: VTKHDF file format, specification, UnstructuredGrid and temporal data (docs.vtk.org).

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};

use carom_mesh::read::vtu::{Numbers, Stored, stored};
use hdf5_pure::{AttrValue, FileBuilder, GroupBuilder};

use crate::{Error, atomic};

/// Numbers of a chunk that is compressed by itself.
const CHUNK: usize = 1 << 16;

/// Level of compression.
const DEFLATE: u32 = 4;

/// An array of all instants.
struct Grown {
    components: usize,
    values: Numbers,
    /// Number of the first value of each instant.
    begins: Vec<i64>,
    /// Where the last instant that brought new values has them.
    last: std::ops::Range<usize>,
}

/// Writes one file of the instants, each with its time (s) and its `.vtu` file; whole or not at all.
///
/// # Errors
/// [`Error::File`]: a file cannot be read, has another number of cells than the first one, or the system refuses.
pub(crate) fn write(path: &Path, instants: &[(f64, PathBuf)]) -> Result<(), Error> {
    let mut grid: Option<Stored> = None;
    let mut points: Option<Grown> = None;
    let mut fields: BTreeMap<(bool, String), Grown> = BTreeMap::new();
    for (number, (_, file)) in instants.iter().enumerate() {
        let bytes = std::fs::read(file).map_err(Error::file("read", file))?;
        let found = stored(file, &bytes).map_err(|cause| broken(file, cause))?;
        let first = grid.get_or_insert_with(|| found.clone());
        if (&first.connectivity, &first.types) != (&found.connectivity, &found.types) {
            return Err(broken(file, "other cells than those of the first instant"));
        }
        let coordinates = Numbers::Reals(found.points.as_flattened().to_vec());
        let grown = points.get_or_insert_with(|| Grown::new(3, &coordinates, number));
        grown
            .take(coordinates, number)
            .ok_or_else(|| broken(file, "another number of points"))?;
        for field in found.arrays {
            let key = (field.of_points, field.name);
            let (components, values) = (field.components, field.values);
            let grown = fields
                .entry(key)
                .or_insert_with(|| Grown::new(components, &values, number));
            let taken = grown.take(values, number);
            taken.ok_or_else(|| broken(file, "a field of another size"))?;
        }
        // fields that never change stand in the first file alone
        for grown in fields.values_mut() {
            grown.repeat(number);
        }
    }
    let (Some(grid), Some(points)) = (grid, points) else {
        return Ok(());
    };
    let times: Vec<f64> = instants.iter().map(|(time, _)| *time).collect();
    let file = document(&grid, &points, &fields, &times);
    atomic::write(path, |to| file.finish_to(to).map_err(io::Error::other))
}

fn broken(path: &Path, cause: impl ToString) -> Error {
    Error::file("read", path)(io::Error::new(
        io::ErrorKind::InvalidData,
        cause.to_string(),
    ))
}

impl Grown {
    /// Before the first values, which are those of the instant of this number.
    fn new(components: usize, like: &Numbers, number: usize) -> Grown {
        Grown {
            components: components.max(1),
            values: match like {
                Numbers::Integers(_) => Numbers::Integers(Vec::new()),
                Numbers::Reals(_) => Numbers::Reals(Vec::new()),
            },
            begins: vec![0; number],
            last: 0..0,
        }
    }

    /// Adds the values of an instant, or tells that they are those of the one before; `None` where they are of another sort.
    fn take(&mut self, new: Numbers, number: usize) -> Option<()> {
        let known = !self.last.is_empty();
        let begin = self.values.len();
        match (&mut self.values, new) {
            (Numbers::Integers(all), Numbers::Integers(new)) => {
                if !known || all[self.last.clone()] != new {
                    all.extend(new);
                }
            }
            (Numbers::Reals(all), Numbers::Reals(new)) => {
                let bits =
                    |values: &[f64]| -> Vec<u64> { values.iter().map(|v| v.to_bits()).collect() };
                if !known || bits(&all[self.last.clone()]) != bits(&new) {
                    all.extend(new);
                }
            }
            _ => return None,
        }
        let end = self.values.len();
        if known && end > begin && end - begin != self.last.len() {
            return None;
        }
        if end > begin {
            self.last = begin..end;
        }
        self.repeat(number);
        Some(())
    }

    /// Tells that the instant of this number has the last values, unless it has its own.
    fn repeat(&mut self, number: usize) {
        if self.begins.len() == number {
            self.begins.push((self.last.start / self.components) as i64);
        }
    }

    fn put(&self, group: &mut GroupBuilder, name: &str) {
        let data = group.create_dataset(name);
        match &self.values {
            Numbers::Reals(values) => data.with_f64_data(values),
            Numbers::Integers(values) => data.with_i64_data(values),
        };
        let rows = (self.values.len() / self.components) as u64;
        let components = self.components as u64;
        let chunk = ((CHUNK / self.components) as u64).clamp(1, rows.max(1));
        let (shape, chunks) = match components {
            1 => (vec![rows], vec![chunk]),
            _ => (vec![rows, components], vec![chunk, components]),
        };
        data.with_shape(&shape);
        if rows > 0 {
            data.with_chunks(&chunks)
                .with_shuffle()
                .with_deflate(DEFLATE);
        }
    }
}

fn document(
    grid: &Stored,
    points: &Grown,
    fields: &BTreeMap<(bool, String), Grown>,
    times: &[f64],
) -> FileBuilder {
    let mut file = FileBuilder::new();
    let mut root = file.create_group("VTKHDF");
    root.set_attr("Version", AttrValue::I64Array(vec![2, 0]));
    root.set_attr("Type", AttrValue::AsciiString("UnstructuredGrid".into()));
    let count = |n: usize| [n as i64];
    let integers = |group: &mut GroupBuilder, name: &str, values: &[i64]| {
        group.create_dataset(name).with_i64_data(values);
    };
    integers(&mut root, "NumberOfPoints", &count(grid.points.len()));
    integers(&mut root, "NumberOfCells", &count(grid.types.len()));
    integers(
        &mut root,
        "NumberOfConnectivityIds",
        &count(grid.connectivity.len()),
    );
    let offsets: Vec<i64> = std::iter::once(0)
        .chain(grid.ends.iter().copied())
        .collect();
    integers(&mut root, "Offsets", &offsets);
    integers(&mut root, "Connectivity", &grid.connectivity);
    let types: Vec<u8> = grid.types.iter().map(|kind| *kind as u8).collect();
    root.create_dataset("Types").with_u8_data(&types);
    points.put(&mut root, "Points");
    let mut steps = root.create_group("Steps");
    steps.set_attr("NSteps", AttrValue::I64(times.len() as i64));
    steps.create_dataset("Values").with_f64_data(times);
    let zeros = vec![0; times.len()];
    integers(&mut steps, "PartOffsets", &zeros);
    integers(&mut steps, "NumberOfParts", &vec![1; times.len()]);
    integers(&mut steps, "PointOffsets", &points.begins);
    for name in ["CellOffsets", "ConnectivityIdOffsets"] {
        let data = steps.create_dataset(name);
        data.with_i64_data(&zeros)
            .with_shape(&[times.len() as u64, 1]);
    }
    for (of_points, data, offsets) in [
        (true, "PointData", "PointDataOffsets"),
        (false, "CellData", "CellDataOffsets"),
    ] {
        let (mut own, mut begins) = (root.create_group(data), steps.create_group(offsets));
        for ((_, name), grown) in fields.iter().filter(|((at, _), _)| *at == of_points) {
            grown.put(&mut own, name);
            integers(&mut begins, name, &grown.begins);
        }
        root.add_group(own.finish());
        steps.add_group(begins.finish());
    }
    root.add_group(steps.finish());
    file.add_group(root.finish());
    file
}

#[cfg(test)]
mod tests {
    use carom_elements::Kind;
    use hdf5_pure::File;

    use super::*;
    use crate::vtu::{self, Cells, Field, Grid, Values};

    #[test]
    fn instants_follow_each_other_and_what_stays_stands_once() {
        let folder = tempfile::tempdir().unwrap();
        let mut instants = Vec::new();
        for number in 0..3 {
            let far = [2.0, 2.0 + f64::from(number), 2.0 + f64::from(number)][number as usize];
            let points = [[0.0; 3], [1.0, 0.0, 0.0], [far, 0.0, 0.0]];
            let speed = points.map(|x| [x[0] - 1.0, 0.0, 0.5]);
            let path = folder.path().join(format!("{number}.vtu"));
            let zone = [7, 8];
            let cell_fields = [Field {
                name: "zone",
                values: Values::Integer(&zone),
            }];
            let grid = Grid {
                time: 0.1 * f64::from(number),
                points: &points,
                cells: &[Cells {
                    kind: Kind::Bar2,
                    nodes: &[0, 1, 1, 2],
                }],
                point_fields: &[Field {
                    name: "velocity",
                    values: Values::Vector(&speed),
                }],
                // the first file alone has it
                cell_fields: if number == 0 { &cell_fields } else { &[] },
            };
            vtu::write(&path, &grid).unwrap();
            instants.push((grid.time, path));
        }
        let path = folder.path().join("all.vtkhdf");
        write(&path, &instants).unwrap();
        let file = File::open(&path).unwrap();
        let reals = |name: &str| file.dataset(name).unwrap().read_f64().unwrap();
        let integers = |name: &str| file.dataset(name).unwrap().read_i64().unwrap();
        assert_eq!(reals("VTKHDF/Steps/Values"), [0.0, 0.1, 0.2]);
        let shape = |name: &str| file.dataset(name).unwrap().shape().unwrap();
        // three instants, each of its own
        assert_eq!(shape("VTKHDF/Points"), [9, 3]);
        assert_eq!(integers("VTKHDF/Steps/PointOffsets"), [0, 3, 6]);
        let x: Vec<f64> = reals("VTKHDF/Points").chunks(3).map(|x| x[0]).collect();
        assert_eq!(x, [0.0, 1.0, 2.0, 0.0, 1.0, 3.0, 0.0, 1.0, 4.0]);
        assert_eq!(shape("VTKHDF/PointData/velocity"), [9, 3]);
        // the mesh and the field stand once
        assert_eq!(integers("VTKHDF/Connectivity"), [0, 1, 1, 2]);
        assert_eq!(integers("VTKHDF/Offsets"), [0, 2, 4]);
        assert_eq!(integers("VTKHDF/CellData/zone"), [7, 8]);
        assert_eq!(integers("VTKHDF/Steps/CellDataOffsets/zone"), [0; 3]);
    }
}
