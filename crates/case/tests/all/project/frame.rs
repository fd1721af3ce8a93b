//! The frame of a case: where its origin lies, and how its axes stand.

use carom_case::parse;
use toml::{Table, Value};

use super::{Project, mesh};

/// Another frame.
#[derive(Clone, Copy, Debug)]
pub enum Frame {
    /// The origin at this distance, m.
    Far(f64),
    /// The axes in the next order: x and y change places in a plane, (x, y, z) become (y, z, x) in space.
    Turned,
    /// One axis reversed.
    Mirrored,
}

/// Keys of points.
const POINTS: [&str; 4] = ["point", "centre", "at", "moment-about"];

/// Keys of vectors that turn and mirror as the bodies do.
const VECTORS: [&str; 10] = [
    "velocity",
    "displacement",
    "acceleration",
    "traction",
    "force",
    "direction",
    "along",
    "normal",
    "axis",
    "orientation",
];

/// Keys of vectors that a mirror reverses besides.
const AXIAL: [&str; 2] = ["spin", "moment"];

/// Axes and their rotations by name.
const AXES: [&str; 3] = ["x", "y", "z"];

/// The map of a frame.
pub struct Map {
    dim: usize,
    /// Component of the old frame that each of the new one is.
    from: [usize; 3],
    sign: [f64; 3],
    shift: [f64; 3],
}

impl Map {
    /// That of a frame for a case; none where it has no meaning there: a radius has neither another axis nor another origin, and what is given as
    /// a motion along the one axis there is has a sign.
    pub fn new(case: &Project, frame: Frame) -> Option<Map> {
        let mesh = case.mesh();
        let dim = mesh.as_ref().map_or(1, |mesh| mesh.dim);
        let axisymmetric = case.is_axisymmetric();
        let mut map = Map {
            dim,
            from: [0, 1, 2],
            sign: [1.0; 3],
            shift: [0.0; 3],
        };
        match frame {
            Frame::Far(distance) => {
                map.shift = [distance, -0.3 * distance, 0.5 * distance];
                map.shift[dim..].fill(0.0);
                if axisymmetric {
                    map.shift[0] = 0.0;
                }
            }
            Frame::Turned if dim == 1 || axisymmetric => return None,
            Frame::Turned if dim == 2 => map.from = [1, 0, 2],
            Frame::Turned => map.from = [1, 2, 0],
            Frame::Mirrored => {
                let free =
                    |&axis: &usize| !(axis == 0 && axisymmetric || moved(&case.table, AXES[axis]));
                map.sign[(0..dim).find(free)?] = -1.0;
            }
        }
        Some(map)
    }

    /// A vector.
    pub fn vector(&self, x: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|i| self.sign[i] * x[self.from[i]])
    }

    /// A place.
    pub fn place(&self, x: [f64; 3]) -> [f64; 3] {
        let x = self.vector(x);
        [0, 1, 2].map(|i| x[i] + self.shift[i])
    }

    /// Whether right becomes left.
    pub fn mirrors(&self) -> bool {
        (self.from == [1, 0, 2]) != (self.sign.iter().product::<f64>() < 0.0)
    }

    /// Components of a list in a case file.
    fn list(&self, list: &[f64], map: impl Fn([f64; 3]) -> [f64; 3]) -> Value {
        let mut x = [0.0; 3];
        x[..list.len()].copy_from_slice(list);
        let x = map(x).map(Value::Float);
        Value::Array(x[..self.dim].to_vec())
    }

    /// The new name of an axis or of a rotation about one.
    fn axis(&self, name: &str) -> Option<String> {
        let (about, axis) = match name.strip_prefix('r') {
            Some(axis) => ("r", axis),
            None => ("", name),
        };
        let old = AXES.iter().position(|name| *name == axis)?;
        // rotations in a plane are about z
        let new = self.from.iter().position(|from| *from == old)?;
        Some(format!("{about}{}", AXES[new]))
    }

    fn value(&self, key: &str, value: &mut Value) {
        match value {
            Value::Table(table) => {
                self.table(table);
                if key == "taper" {
                    self.taper(table);
                }
            }
            Value::Array(list) => {
                let numbers: Option<Vec<f64>> = list.iter().map(number).collect();
                let axial = if self.mirrors() { -1.0 } else { 1.0 };
                match numbers {
                    Some(numbers) if POINTS.contains(&key) => {
                        *value = self.list(&numbers, |x| self.place(x));
                    }
                    Some(numbers) if VECTORS.contains(&key) => {
                        *value = self.list(&numbers, |x| self.vector(x));
                    }
                    Some(numbers) if AXIAL.contains(&key) && numbers.len() == 1 => {
                        *value = Value::Array(vec![Value::Float(axial * numbers[0])]);
                    }
                    Some(numbers) if AXIAL.contains(&key) => {
                        *value = self.list(&numbers, |x| self.vector(x).map(|x| axial * x));
                    }
                    _ => list.iter_mut().for_each(|value| self.value(key, value)),
                }
            }
            Value::String(name) if ["fix", "free", "direction"].contains(&key) => {
                if let Some(new) = self.axis(name) {
                    *name = new;
                }
            }
            _ => {}
        }
    }

    /// Turns what is in a table of a case.
    fn table(&self, table: &mut Table) {
        for (key, value) in table.iter_mut() {
            if !["move", "base-acceleration"].contains(&key.as_str()) {
                self.value(key, value);
            } else if let Value::Table(axes) = value {
                let old = std::mem::take(axes);
                let new = |name: String| self.axis(&name).unwrap_or(name);
                axes.extend(old.into_iter().map(|(name, value)| (new(name), value)));
            }
        }
    }

    /// The places of a taper, which are along a direction: they move with the origin.
    fn taper(&self, taper: &mut Table) {
        let along: Vec<f64> = taper["along"]
            .as_array()
            .unwrap()
            .iter()
            .filter_map(number)
            .collect();
        let shift: f64 = along.iter().zip(self.shift).map(|(a, b)| a * b).sum();
        for key in ["from", "to"] {
            let place = number(&taper[key]).unwrap();
            taper.insert(key.to_owned(), Value::Float(place + shift));
        }
    }
}

fn number(value: &Value) -> Option<f64> {
    match value {
        Value::Float(value) => Some(*value),
        Value::Integer(value) => Some(*value as f64),
        _ => None,
    }
}

/// Whether a support or the ground moves along an axis.
fn moved(table: &Table, axis: &str) -> bool {
    table.iter().any(|(key, value)| match value {
        Value::Table(inner) if ["move", "base-acceleration"].contains(&key.as_str()) => {
            inner.contains_key(axis)
        }
        Value::Table(inner) => moved(inner, axis),
        _ => false,
    })
}

impl Project {
    /// Whether its bodies are axisymmetric.
    pub fn is_axisymmetric(&self) -> bool {
        self.named("body").any(|(_, body)| {
            let section = body.get("section").and_then(Value::as_table);
            section.is_some_and(|section| section.contains_key("axisymmetric"))
        })
    }

    /// The same in another frame.
    pub fn in_frame(&self, map: &Map) -> Project {
        let mut other = self.in_si();
        for section in other.table.iter_mut() {
            if section.0 != "mesh" {
                map.value(section.0, section.1);
            }
        }
        if let Some(mesh) = self.mesh() {
            let order: Vec<u32> = (0..mesh.nodes.len() as u32).collect();
            let place = |x: [f64; 3]| map.place(x);
            let text = mesh::msh(&mesh, &order, None, (&place, map.mirrors()));
            other.remeshed(&text, mesh.dim);
        }
        other
    }

    /// The same with all numbers in SI units, its repeated parts written out; but for the mesh, which has a unit of its own.
    pub(super) fn in_si(&self) -> Project {
        let input = self.input();
        let (case, _) = parse(&input).unwrap_or_else(|all| panic!("{}: {all:?}", self.name));
        let mut table = without_empty(Table::try_from(&case).unwrap());
        table.remove("mesh");
        table.extend(
            self.table
                .get("mesh")
                .map(|mesh| ("mesh".to_owned(), mesh.clone())),
        );
        Project {
            table,
            ..self.clone()
        }
    }
}

/// A table without lists that are empty, which files do not have.
fn without_empty(table: Table) -> Table {
    let kept = |(key, value)| match value {
        Value::Array(list) if list.is_empty() => None,
        Value::Table(inner) => Some((key, Value::Table(without_empty(inner)))),
        value => Some((key, value)),
    };
    table.into_iter().filter_map(kept).collect()
}
