//! Fields of all instants in one VTKHDF file, which ParaView and VTK read.
//!
//! An unstructured grid of version 2.0 with the group `Steps`: arrays of all instants one after the other, and where each begins. What
//! does not change from one instant to the next stands there once. The file is made of the `.vtu` files of the instants, which stay
//! beside it: it has the same numbers, and a run that is killed has lost nothing that the `.vtu` files do not have.
//!
//! Memory: a first pass over the files finds where each array begins with two instants at a time. The arrays are then added to the file
//! in batches of at most [`BATCH`] bytes, or one by one where they are larger: hdf5-pure 0.47 appends to datasets of rank one, and vectors
//! have rank two, so that an array must be whole when it is written. Its bytes, shuffled and compressed, are then some 2.7 times the array.
//!
//! Source: VTKHDF file format, specification, UnstructuredGrid and temporal data (docs.vtk.org).

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};

use carom_mesh::read::vtu::{Numbers, Stored, stored};
use hdf5_pure::{AttrValue, DatasetBuilder, File, FileBuilder, GroupBuilder};

use crate::{Error, atomic};

/// Numbers of a chunk that is compressed by itself.
const CHUNK: usize = 1 << 16;

/// Level of compression.
const DEFLATE: u32 = 4;

/// Bytes of arrays that are gathered at a time, 64 MiB.
const BATCH: usize = 1 << 26;

/// Where an array stands.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Key {
    Points,
    Field { of_points: bool, name: String },
}

/// An array of all instants.
struct Array {
    components: usize,
    /// Values of an instant.
    length: usize,
    /// The instants that bring values of their own, ascending.
    own: Vec<usize>,
    /// Number of the first row of each instant.
    begins: Vec<i64>,
}

/// Writes one file of the instants, each with its time (s) and its `.vtu` file; whole or not at all.
///
/// # Errors
/// [`Error::File`]: a file cannot be read, has another number of cells than the first one, or the system refuses.
pub(crate) fn write(path: &Path, instants: &[(f64, PathBuf)]) -> Result<(), Error> {
    let Some((grid, arrays)) = survey(instants)? else {
        return Ok(());
    };
    let times: Vec<f64> = instants.iter().map(|(time, _)| *time).collect();
    let frame = frame(&grid, &arrays, &times);
    drop(grid);
    atomic::write_at(path, |place| {
        let mut file = std::fs::File::create(place).map_err(Error::file("write", place))?;
        frame.finish_to(&mut file).map_err(refused(place))?;
        drop(file);
        let mut batch: Vec<(&Key, &Array)> = Vec::new();
        let mut bytes = 0;
        for (key, array) in &arrays {
            let own = array.bytes();
            if bytes + own > BATCH && !batch.is_empty() {
                add(place, instants, &std::mem::take(&mut batch))?;
                bytes = 0;
            }
            batch.push((key, array));
            bytes += own;
        }
        add(place, instants, &batch)
    })
}

/// The grid of the first instant, and what arrays there are; nothing without instants.
fn survey(instants: &[(f64, PathBuf)]) -> Result<Option<(Stored, BTreeMap<Key, Array>)>, Error> {
    let mut grid: Option<Stored> = None;
    let mut arrays: BTreeMap<Key, (Array, Numbers)> = BTreeMap::new();
    for (number, (_, file)) in instants.iter().enumerate() {
        let found = read(file)?;
        let first = grid.get_or_insert_with(|| found.clone());
        if (&first.connectivity, &first.types) != (&found.connectivity, &found.types) {
            return Err(broken(file, "other cells than those of the first instant"));
        }
        for (key, components, values) in parts(found) {
            match arrays.get_mut(&key) {
                None => {
                    arrays.insert(key, (Array::new(components, &values, number), values));
                }
                Some((array, last)) => {
                    let taken = array.take(number, (last, values));
                    taken.ok_or_else(|| broken(file, "an array of another size"))?;
                }
            }
        }
        // fields that never change stand in the first file alone
        for (array, _) in arrays.values_mut() {
            array.fill(number + 1);
        }
    }
    let arrays = arrays.into_iter().map(|(key, (array, _))| (key, array));
    Ok(grid.map(|grid| (grid, arrays.collect())))
}

fn read(file: &Path) -> Result<Stored, Error> {
    let bytes = std::fs::read(file).map_err(Error::file("read", file))?;
    stored(file, &bytes).map_err(|cause| broken(file, cause))
}

/// The arrays of an instant.
fn parts(found: Stored) -> impl Iterator<Item = (Key, usize, Numbers)> {
    let points = Numbers::Reals(found.points.into_flattened());
    let fields = found.arrays.into_iter().map(|field| {
        let (of_points, name) = (field.of_points, field.name);
        (
            Key::Field { of_points, name },
            field.components.max(1),
            field.values,
        )
    });
    std::iter::once((Key::Points, 3, points)).chain(fields)
}

fn broken(path: &Path, cause: impl ToString) -> Error {
    Error::file("read", path)(io::Error::new(
        io::ErrorKind::InvalidData,
        cause.to_string(),
    ))
}

fn refused(path: &Path) -> impl Fn(hdf5_pure::Error) -> Error {
    move |cause| Error::file("write", path)(io::Error::other(cause))
}

impl Array {
    /// With the values of the instant of this number, the first that has any.
    fn new(components: usize, values: &Numbers, number: usize) -> Array {
        Array {
            components,
            length: values.len(),
            own: vec![number],
            begins: vec![0; number + 1],
        }
    }

    /// Takes the values of an instant, or tells that they are those of the one before; `None` where they are of another sort.
    fn take(&mut self, number: usize, (last, new): (&mut Numbers, Numbers)) -> Option<()> {
        if new.len() != self.length {
            return None;
        }
        let same = match (&*last, &new) {
            (Numbers::Integers(last), Numbers::Integers(new)) => last == new,
            (Numbers::Reals(last), Numbers::Reals(new)) => last
                .iter()
                .zip(new)
                .all(|(a, b)| a.to_bits() == b.to_bits()),
            _ => return None,
        };
        if !same {
            self.begins.push(self.rows());
            self.own.push(number);
            *last = new;
        }
        self.fill(number + 1);
        Some(())
    }

    /// Lets instants without values of their own have the last ones.
    fn fill(&mut self, count: usize) {
        let last = self.begins.last().copied().unwrap_or(0);
        self.begins.resize(count.max(self.begins.len()), last);
    }

    /// Rows so far.
    fn rows(&self) -> i64 {
        (self.own.len() * self.length / self.components) as i64
    }

    fn bytes(&self) -> usize {
        8 * self.own.len() * self.length
    }

    fn shape(&self, data: &mut DatasetBuilder) {
        let (rows, components) = (self.rows() as u64, self.components as u64);
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

/// Adds arrays to a file, with their values of all instants.
fn add(place: &Path, instants: &[(f64, PathBuf)], batch: &[(&Key, &Array)]) -> Result<(), Error> {
    let mut gathered: BTreeMap<&Key, (&Array, Option<Numbers>)> = batch
        .iter()
        .map(|(key, array)| (*key, (*array, None)))
        .collect();
    for (number, (_, file)) in instants.iter().enumerate() {
        let wanted =
            |(array, _): &(&Array, Option<Numbers>)| array.own.binary_search(&number).is_ok();
        if !gathered.values().any(wanted) {
            continue;
        }
        for (key, _, values) in parts(read(file)?) {
            if let Some(entry) = gathered.get_mut(&key).filter(|entry| wanted(entry)) {
                append(&mut entry.1, (entry.0, values));
            }
        }
    }
    let refused = refused(place);
    let file = File::open_rw(place).map_err(&refused)?;
    let root = file.group("VTKHDF").map_err(&refused)?;
    for (key, (array, values)) in gathered {
        let name = match key {
            Key::Points => "Points".to_owned(),
            Key::Field {
                of_points: true,
                name,
            } => format!("PointData/{name}"),
            Key::Field {
                of_points: false,
                name,
            } => format!("CellData/{name}"),
        };
        let put = |data: &mut DatasetBuilder| {
            match &values {
                Some(Numbers::Integers(values)) => data.with_i64_data(values),
                Some(Numbers::Reals(values)) => data.with_f64_data(values),
                None => data.with_f64_data(&[]),
            };
            array.shape(data);
        };
        root.create_dataset(&name, put).map_err(&refused)?;
    }
    file.commit().map_err(&refused)
}

fn append(all: &mut Option<Numbers>, (array, new): (&Array, Numbers)) {
    match (all, new) {
        (Some(Numbers::Integers(all)), Numbers::Integers(new)) => all.extend(new),
        (Some(Numbers::Reals(all)), Numbers::Reals(new)) => all.extend(new),
        (all, new) => {
            let room = array.own.len() * array.length;
            *all = Some(match new {
                Numbers::Integers(mut new) => {
                    new.reserve_exact(room - new.len());
                    Numbers::Integers(new)
                }
                Numbers::Reals(mut new) => {
                    new.reserve_exact(room - new.len());
                    Numbers::Reals(new)
                }
            });
        }
    }
}

/// All of the file but the arrays.
fn frame(grid: &Stored, arrays: &BTreeMap<Key, Array>, times: &[f64]) -> FileBuilder {
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
    let mut steps = root.create_group("Steps");
    steps.set_attr("NSteps", AttrValue::I64(times.len() as i64));
    steps.create_dataset("Values").with_f64_data(times);
    let zeros = vec![0; times.len()];
    integers(&mut steps, "PartOffsets", &zeros);
    integers(&mut steps, "NumberOfParts", &vec![1; times.len()]);
    for name in ["CellOffsets", "ConnectivityIdOffsets"] {
        let data = steps.create_dataset(name);
        data.with_i64_data(&zeros)
            .with_shape(&[times.len() as u64, 1]);
    }
    for (wanted, data, offsets) in [
        (true, "PointData", "PointDataOffsets"),
        (false, "CellData", "CellDataOffsets"),
    ] {
        let (own, mut begins) = (root.create_group(data), steps.create_group(offsets));
        for (key, array) in arrays {
            if let Key::Field { of_points, name } = key
                && *of_points == wanted
            {
                integers(&mut begins, name, &array.begins);
            }
        }
        root.add_group(own.finish());
        steps.add_group(begins.finish());
    }
    if let Some(points) = arrays.get(&Key::Points) {
        integers(&mut steps, "PointOffsets", &points.begins);
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
