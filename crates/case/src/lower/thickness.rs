//! Thickness of shells of one material: of the whole body, along an axis, or at its nodes from a text file.

use carom_mesh::{ElementId, Mesh};

use super::columns::{self, FileColumn};
use super::context::Context;
use super::lookup;
use super::problems::{Problems, place};
use crate::error::Problem;
use crate::schema::{self, ThicknessColumns};

/// Largest distance of a place of the file from its node, in diagonals of the box around the nodes: files are rounded to seven digits or more.
const APART: f64 = 1e-6;

/// Refuses sections that have their thickness from none or from several of the keys. `path`: of the section.
pub(super) fn one_thickness(
    path: &str,
    given: &schema::ShellSection,
    problems: &mut Problems,
) -> Option<()> {
    let all = [
        ("thickness", given.thickness.is_some()),
        ("nodal-thickness", given.nodal_thickness.is_some()),
        ("plies", given.plies.is_some()),
    ];
    let mut there = all.iter().filter(|(_, there)| *there).map(|(key, _)| *key);
    let problem = match (there.next(), there.next()) {
        (None, _) => Problem::new(path, "a shell without thickness")
            .accepted(["`thickness`, `nodal-thickness` or `plies`"]),
        (Some(first), Some(second)) => {
            let message = format!("the thickness is that of `{second}` already");
            Problem::new(format!("{path}.{first}"), message)
                .accepted(["one of `thickness`, `nodal-thickness` and `plies`"])
        }
        (Some("plies"), None) if given.taper.is_some() => {
            let message = "the thickness of plies does not change along the shell";
            Problem::new(format!("{path}.taper"), message)
                .accepted(["no `taper`", "one material, and no `plies`"])
        }
        (Some("nodal-thickness"), None) if given.taper.is_some() => {
            let message = "the thickness is given at the nodes already";
            Problem::new(format!("{path}.taper"), message)
                .accepted(["no `taper`", "`thickness` with `taper`"])
        }
        (Some(_), None) => return Some(()),
    };
    problems.refuse(problem)
}

/// The largest thickness of a section of one material, m, and that at each node of the mesh, if it changes. `path`: of the body.
pub(super) fn thickness(
    context: &Context,
    (mesh, cells): (&Mesh, &[ElementId]),
    path: &str,
    given: &schema::ShellSection,
    problems: &mut Problems,
) -> Option<(f64, Option<Vec<f64>>)> {
    let path = format!("{path}.section.shell");
    let constant = given.thickness.map_or(0.0, |thickness| thickness.0);
    let nodal = match (&given.taper, &given.nodal_thickness) {
        (None, None) => return Some((constant, None)),
        (Some(given), _) => taper(mesh, &format!("{path}.taper"), (given, constant), problems)?,
        (None, Some(columns)) => thickness_file(
            context,
            (mesh, cells),
            &format!("{path}.nodal-thickness"),
            columns,
            problems,
        )?,
    };
    let nodes = cells.iter().flat_map(|&cell| mesh.element_nodes(cell));
    let largest = nodes.map(|&node| nodal[node as usize]).fold(0.0, f64::max);
    Some((largest, Some(nodal)))
}

/// Thickness at each node of the mesh, linear along an axis, from `thickness` at its start.
fn taper(
    mesh: &Mesh,
    path: &str,
    (given, thickness): (&schema::ShellTaper, f64),
    problems: &mut Problems,
) -> Option<Vec<f64>> {
    let along = lookup::normal(mesh, &format!("{path}.along"), &given.along, problems)?;
    let [from, to] = [given.from.0, given.to.0];
    if to <= from {
        let problem = Problem::new(format!("{path}.to"), "a taper that ends before it begins");
        let problem = problem.found(format!("{to} m"));
        return problems.refuse(problem.accepted([format!("above {from} m")]));
    }
    let at = |x: &[f64; 3]| {
        let place: f64 = x.iter().zip(&along).map(|(x, a)| x * a).sum();
        let part = ((place - from) / (to - from)).clamp(0.0, 1.0);
        (1.0 - part) * thickness + part * given.thickness.0
    };
    Some(mesh.nodes.iter().map(at).collect())
}

/// Thickness at each node of the mesh from the lines of a file at their places; not a number at nodes of other bodies.
fn thickness_file(
    context: &Context,
    (mesh, cells): (&Mesh, &[ElementId]),
    path: &str,
    given: &ThicknessColumns,
    problems: &mut Problems,
) -> Option<Vec<f64>> {
    let place_of = |i: usize| FileColumn {
        key: ["place[0]", "place[1]", "place[2]"][i],
        name: &given.place[i],
        unit_key: "place-unit",
        unit: given.place_unit.as_ref(),
        dimension: "length",
    };
    let thickness = FileColumn {
        key: "thickness",
        name: &given.thickness,
        unit_key: "unit",
        unit: given.unit.as_ref(),
        dimension: "length",
    };
    let keys = [place_of(0), place_of(1), place_of(2), thickness];
    let (rows, lines) = columns::file_columns(context.folder, path, &given.file, keys, problems)?;
    if let Some(k) = rows
        .iter()
        .position(|row| !(row[3] > 0.0 && row[3].is_finite()))
    {
        let message = format!(
            "line {} of the file: a thickness must be positive",
            lines[k]
        );
        let problem = Problem::new(format!("{path}.thickness"), message);
        let problem = problem.found(format!("{} m", rows[k][3]));
        return problems.refuse(problem.accepted(["> 0 m"]));
    }
    let mut nodes: Vec<u32> = cells
        .iter()
        .flat_map(|&cell| mesh.element_nodes(cell))
        .copied()
        .collect();
    nodes.sort_unstable();
    nodes.dedup();
    let places = Places::new(&rows, APART * lookup::diagonal(mesh, &nodes));
    let mut nodal = vec![f64::NAN; mesh.nodes.len()];
    let mut without = Vec::new();
    for node in nodes {
        match places.at(&mesh.nodes[node as usize]) {
            Some(thickness) => nodal[node as usize] = thickness,
            None => without.push(node),
        }
    }
    let Some(&first) = without.first() else {
        return Some(nodal);
    };
    let at = place(mesh.nodes[first as usize]);
    let count = without.len();
    let message = format!("nodes without a line in the file: {count}, the first at {at}");
    let problem = Problem::new(format!("{path}.file"), message);
    problems.refuse(problem.accepted(["a line at the place of each node of the body"]))
}

/// Lines of the file, sorted by x.
struct Places {
    rows: Vec<[f64; 4]>,
    apart: f64,
}

impl Places {
    fn new(rows: &[[f64; 4]], apart: f64) -> Places {
        let mut rows = rows.to_vec();
        rows.sort_by(|one, other| one[0].total_cmp(&other[0]));
        Places { rows, apart }
    }

    /// The thickness of the nearest line within reach of a place.
    fn at(&self, x: &[f64; 3]) -> Option<f64> {
        let from = self.rows.partition_point(|row| row[0] < x[0] - self.apart);
        let near = self.rows[from..]
            .iter()
            .take_while(|row| row[0] <= x[0] + self.apart);
        let distance = |row: &[f64; 4]| {
            let squares = (0..3).map(|i| (row[i] - x[i]).powi(2));
            squares.sum::<f64>().sqrt()
        };
        near.filter(|row| distance(row) <= self.apart)
            .min_by(|one, other| distance(one).total_cmp(&distance(other)))
            .map(|row| row[3])
    }
}
