//! Fields of all instants in one VTKHDF file, which ParaView and VTK read.
//!
//! An unstructured grid of version 2.0 with the group `Steps`: arrays of all instants one after the other, and where each begins. What
//! does not change from one instant to the next stands there once. The file is made of the `.vtu` files of the instants, which stay
//! beside it: it has the same numbers, and a run that is killed has lost nothing that the `.vtu` files do not have. One instant after
//! the other is read and written ([`crate::hdf5`]): the memory is that of some instants, however many there are.
//!
//! Source: VTKHDF file format, specification, UnstructuredGrid and temporal data (docs.vtk.org).

use std::collections::BTreeMap;
use std::io::{self, Seek, Write};
use std::path::{Path, PathBuf};

use carom_mesh::read::vtu::{Numbers, Stored, stored};

use crate::hdf5::{Attribute, Element, Rows, Writer};
use crate::{Error, atomic};

/// An array of all instants.
struct Grown {
    components: usize,
    rows: Rows,
    /// First row of each instant.
    begins: Vec<i64>,
    /// The values of the last instant that brought new ones.
    last: Option<Numbers>,
}

/// What has gone into the file.
#[derive(Default)]
struct Content {
    /// The first instant, without its fields.
    grid: Option<Stored>,
    points: Option<Grown>,
    /// By whether they are of points, and their name.
    fields: BTreeMap<(bool, String), Grown>,
}

/// Why the file cannot be written.
enum Stop {
    Input(Error),
    Output(io::Error),
}

impl From<Error> for Stop {
    fn from(error: Error) -> Stop {
        Stop::Input(error)
    }
}

impl From<io::Error> for Stop {
    fn from(error: io::Error) -> Stop {
        Stop::Output(error)
    }
}

/// Writes one file of the instants, each with its time (s) and its `.vtu` file; whole or not at all.
///
/// # Errors
/// [`Error::File`]: a file cannot be read, has another number of cells than the first one, or the system refuses.
pub(crate) fn write(path: &Path, instants: &[(f64, PathBuf)]) -> Result<(), Error> {
    if instants.is_empty() {
        return Ok(());
    }
    let mut refused = None;
    let outcome = atomic::write_seeking(path, |to| {
        fill(to, instants).map_err(|stop| match stop {
            Stop::Output(cause) => cause,
            Stop::Input(error) => {
                refused = Some(error);
                io::Error::from(io::ErrorKind::InvalidData)
            }
        })
    });
    refused.map_or(outcome, Err)
}

fn fill<W: Write + Seek>(to: W, instants: &[(f64, PathBuf)]) -> Result<(), Stop> {
    let mut writer = Writer::new(to)?;
    let mut content = Content::default();
    for (number, (_, file)) in instants.iter().enumerate() {
        content.take(&mut writer, number, file)?;
    }
    let times: Vec<f64> = instants.iter().map(|(time, _)| *time).collect();
    let root = content.close(&mut writer, &times)?;
    Ok(writer.finish(root)?)
}

fn broken(path: &Path, cause: impl ToString) -> Error {
    Error::file("read", path)(io::Error::new(
        io::ErrorKind::InvalidData,
        cause.to_string(),
    ))
}

impl Content {
    /// Adds the instant of this number.
    fn take<W: Write + Seek>(
        &mut self,
        writer: &mut Writer<W>,
        number: usize,
        file: &Path,
    ) -> Result<(), Stop> {
        let bytes = std::fs::read(file).map_err(Error::file("read", file))?;
        let mut found = stored(file, &bytes).map_err(|cause| broken(file, cause))?;
        drop(bytes);
        let arrays = std::mem::take(&mut found.arrays);
        let coordinates = Numbers::Reals(found.points.as_flattened().to_vec());
        let first = self.grid.get_or_insert_with(|| found.clone());
        if (&first.connectivity, &first.types) != (&found.connectivity, &found.types) {
            return Err(broken(file, "other cells than those of the first instant").into());
        }
        drop(found);
        let points = &mut self.points;
        let grown = points.get_or_insert_with(|| Grown::new(3, &coordinates, number));
        grown.take(writer, coordinates, number, || {
            broken(file, "another number of points")
        })?;
        for field in arrays {
            let key = (field.of_points, field.name);
            let (components, values) = (field.components, field.values);
            let new = || Grown::new(components, &values, number);
            let grown = self.fields.entry(key).or_insert_with(new);
            grown.take(writer, values, number, || {
                broken(file, "a field of another size")
            })?;
        }
        // fields that never change stand in the first file alone
        for grown in self.fields.values_mut() {
            grown.repeat(number);
        }
        Ok(())
    }

    /// Writes what is left over; the address of the root.
    fn close<W: Write + Seek>(self, writer: &mut Writer<W>, times: &[f64]) -> io::Result<u64> {
        let (Some(grid), Some(points)) = (self.grid, self.points) else {
            return Err(io::ErrorKind::InvalidData.into());
        };
        let count = |n: usize| [n as i64];
        let mut root = vec![
            (
                "NumberOfPoints",
                writer.integers(&count(grid.points.len()))?,
            ),
            ("NumberOfCells", writer.integers(&count(grid.types.len()))?),
        ];
        let ids = writer.integers(&count(grid.connectivity.len()))?;
        root.push(("NumberOfConnectivityIds", ids));
        for (name, element, values) in [
            (
                "Offsets",
                Element::Integer,
                &[&[0][..], &grid.ends].concat(),
            ),
            ("Connectivity", Element::Integer, &grid.connectivity),
            ("Types", Element::Byte, &grid.types),
        ] {
            let mut rows = Rows::new(element, 1);
            let values = values.iter();
            match element {
                Element::Byte => rows.add(writer, values.map(|value| [*value as u8]))?,
                _ => rows.add(writer, values.map(|value| value.to_le_bytes()))?,
            }
            root.push((name, rows.finish(writer)?));
        }
        let begins = writer.integers(&points.begins)?;
        root.push(("Points", points.rows.finish(writer)?));
        let mut steps = steps(writer, times)?;
        steps.push(("PointOffsets", begins));
        let mut groups = [true, false].map(|_| (Vec::new(), Vec::new()));
        for ((of_points, name), grown) in self.fields {
            let begins = writer.integers(&grown.begins)?;
            let (own, offsets) = &mut groups[usize::from(!of_points)];
            own.push((name.clone(), grown.rows.finish(writer)?));
            offsets.push((name, begins));
        }
        let mut group = |members: &[(String, u64)]| {
            let members = members.iter().map(|(name, at)| (name.as_str(), *at));
            writer.group(&members.collect::<Vec<_>>(), &[])
        };
        for ((own, offsets), [data, begins]) in groups.iter().zip([
            ["PointData", "PointDataOffsets"],
            ["CellData", "CellDataOffsets"],
        ]) {
            root.push((data, group(own)?));
            steps.push((begins, group(offsets)?));
        }
        let number = [("NSteps", Attribute::Integer(times.len() as i64))];
        root.push(("Steps", writer.group(&steps, &number)?));
        let attributes = [
            ("Version", Attribute::Integers(&[2, 0])),
            ("Type", Attribute::Text("UnstructuredGrid")),
        ];
        let grid = writer.group(&root, &attributes)?;
        writer.group(&[("VTKHDF", grid)], &[])
    }
}

/// What the group `Steps` has of the instants and of the mesh, which is that of all of them.
fn steps<W: Write + Seek>(
    writer: &mut Writer<W>,
    times: &[f64],
) -> io::Result<Vec<(&'static str, u64)>> {
    let bytes: Vec<u8> = times.iter().flat_map(|time| time.to_le_bytes()).collect();
    let count = times.len() as u64;
    let zeros = vec![0; times.len()];
    let flat: Vec<u8> = vec![0; 8 * times.len()];
    let mut column = || writer.dataset(Element::Integer, &[count, 1], &flat);
    let (cells, ids) = (column()?, column()?);
    Ok(vec![
        ("Values", writer.dataset(Element::Real, &[count], &bytes)?),
        ("PartOffsets", writer.integers(&zeros)?),
        ("NumberOfParts", writer.integers(&vec![1; times.len()])?),
        ("CellOffsets", cells),
        ("ConnectivityIdOffsets", ids),
    ])
}

impl Grown {
    /// Before the first values, which are those of the instant of this number.
    fn new(components: usize, like: &Numbers, number: usize) -> Grown {
        let components = components.max(1);
        let element = match like {
            Numbers::Integers(_) => Element::Integer,
            Numbers::Reals(_) => Element::Real,
        };
        Grown {
            components,
            rows: Rows::new(element, components),
            begins: vec![0; number],
            last: None,
        }
    }

    /// Adds the values of an instant, unless they are those of the one before; an error where they are of another sort.
    fn take<W: Write + Seek>(
        &mut self,
        writer: &mut Writer<W>,
        new: Numbers,
        number: usize,
        other: impl FnOnce() -> Error,
    ) -> Result<(), Stop> {
        let is_known = match (&self.last, &new) {
            (None, _) => false,
            (Some(last), new) if last.len() != new.len() => return Err(other().into()),
            (Some(Numbers::Integers(last)), Numbers::Integers(new)) => last == new,
            (Some(Numbers::Reals(last)), Numbers::Reals(new)) => last
                .iter()
                .zip(new)
                .all(|(a, b)| a.to_bits() == b.to_bits()),
            _ => return Err(other().into()),
        };
        if !is_known {
            self.begins.push(self.rows.count() as i64);
            match &new {
                Numbers::Integers(new) => {
                    self.rows
                        .add(writer, new.iter().map(|value| value.to_le_bytes()))?;
                }
                Numbers::Reals(new) => {
                    self.rows
                        .add(writer, new.iter().map(|value| value.to_le_bytes()))?;
                }
            }
            self.last = Some(new);
        }
        self.repeat(number);
        Ok(())
    }

    /// Tells that the instant of this number has the last values, unless it has its own.
    fn repeat(&mut self, number: usize) {
        if self.begins.len() == number {
            let last = self.last.as_ref().map_or(0, Numbers::len);
            let rows = (last / self.components) as u64;
            self.begins.push((self.rows.count() - rows) as i64);
        }
    }
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
