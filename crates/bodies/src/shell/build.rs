//! Building shells: what cells they take, their normals and directors.

use carom_algebra::tensor::Vec3;
use carom_algebra::unknowns::Unknowns;
use carom_elements::Kind;
use carom_mesh::{ElementId, Mesh};

use super::layers::Layers;
use super::one_point::{Centre, Hourglass};
use super::pass::Pass;
use super::products::{Configuration, MOST};
use super::section::ElasticSection;
use super::shares::{self, PointWeights};
use super::strain::Form;
use super::{Element, Shell, ShellSection};
use crate::solid::BodySpec;
use crate::{Error, Formulation, Kinematics, Rotations};

/// Cosine of the angle between the normals of two elements from which on the edge between them is a fold: 40°. Directors are means of
/// the normals on one side of a fold.
const FOLD: f64 = 0.766;

/// Resistance of triangles to shear: h² over h² and this part of the square of the longest edge.
const TRIANGLE: f64 = 0.1;

/// Part of the largest edge by which a node may lie beside the plane of the others.
const WARPED: f64 = 0.3;

/// A corner of an element: its normal.
struct Corner {
    element: usize,
    normal: Vec3,
}

impl Shell {
    /// Builds the elements on the cells of a mesh. `number`: system number of each mesh node; `unknowns`: of the nodes of the system, with
    /// rotations.
    ///
    /// # Errors
    /// No cell, cells that are neither tri3 nor quad4, a mesh that is not one of space; a cell without area or that is not convex, or too warped;
    /// neighbours whose normals disagree; a material at finite strain that is no metal, a formulation; an offset with finite rotations; weights with finite
    /// rotations or of a metal, too few of them, or negative ones.
    pub(crate) fn new(
        mesh: &Mesh,
        spec: BodySpec,
        section: ShellSection,
        number: &[u32],
        unknowns: &Unknowns,
    ) -> Result<Shell, Error> {
        check(mesh, &spec, &section)?;
        let material = spec.material.initial();
        let weights = shares::nodal(mesh, &spec)?;
        let geometry = geometry(mesh, &spec)?;
        let mut shell = Shell {
            name: spec.name,
            section,
            material,
            cells: spec.cells,
            elements: Vec::new(),
            stiffness: Vec::new(),
            starts: vec![0],
            smallest: f64::INFINITY,
            layers: None,
            pass: None,
        };
        let mut centres = Vec::new();
        let elastic = ElasticSection::new(&material, section.thickness);
        let law = spec.material.plane_stress();
        shell.layers = law.map(|law| Layers::new(law, section.thickness, section.layers));
        for (place, &cell) in shell.cells.iter().enumerate() {
            let nodes = mesh.element_nodes(cell);
            let reference = geometry[place];
            let [alpha, delta] = &weights[place];
            let along = reference.axes[0][0];
            let mut element = Element {
                count: nodes.len(),
                nodes: [0; MOST],
                first: [0; MOST],
                frames: [usize::MAX; MOST],
                form: Form::new(
                    nodes.len(),
                    &reference.beside(section.offset),
                    &along,
                    delta,
                ),
                reference,
                elastic,
                weights: PointWeights::default(),
                hourglass: None,
            };
            if let Formulation::Reduced { hourglass } = spec.formulation {
                let centre = Centre::new(&reference, &along);
                element.form = element.form.with_one_point(&reference, &centre);
                element.hourglass = Some(Hourglass::new(&elastic, centre.area, hourglass));
                centres.push(centre);
            }
            let at_points = PointWeights::new(&element.form.shapes, [alpha, delta]);
            element.weights = at_points.checked(&shell.name, cell)?;
            shell.refuse_negative_mass(&element, (cell, nodes))?;
            for (a, &node) in nodes.iter().enumerate() {
                let own = number[node as usize];
                element.nodes[a] = own;
                element.first[a] = unknowns.first(own);
                element.frames[a] = unknowns.frame(own).unwrap_or(usize::MAX);
            }
            let longest = longest(&element.reference.x[..element.count]);
            if element.count == 3 {
                let square = section.thickness.powi(2);
                let factor = square / (square + TRIANGLE * longest * longest);
                element.elastic = elastic.with_shear(factor);
            }
            shell.smallest = shell.smallest.min(element.area() / longest);
            if section.rotations == Rotations::Small {
                shell.stiffness.extend(element.stiffness(section.offset));
                shell.starts.push(shell.stiffness.len());
            }
            shell.elements.push(element);
        }
        if !centres.is_empty() {
            shell.pass = Some(Pass::new(&shell.elements, &centres));
        }
        Ok(shell)
    }
}

impl Shell {
    fn refuse_negative_mass(
        &self,
        element: &Element,
        (cell, nodes): (ElementId, &[u32]),
    ) -> Result<(), Error> {
        let shares = element.shares(self.density());
        let bad = |(_, mass): &(&u32, &f64)| mass.is_nan() || **mass < 0.0;
        match nodes.iter().zip(&shares).find(bad) {
            Some((&node, &mass)) => Err(Error::NegativeMass {
                body: self.name.clone(),
                cell,
                node,
                mass,
            }),
            None => Ok(()),
        }
    }
}

/// Places of the nodes of each element, and their axes.
///
/// # Errors
/// A cell without area or that is not convex, or too warped; neighbours whose normals disagree.
pub(super) fn geometry(mesh: &Mesh, spec: &BodySpec) -> Result<Vec<Configuration>, Error> {
    let corners = corners(mesh, spec)?;
    agree(mesh, spec)?;
    let of = |(place, &cell): (usize, &ElementId)| {
        let nodes = mesh.element_nodes(cell).iter();
        let own = nodes.map(|&node| {
            let x = Vec3::from(mesh.nodes[node as usize]);
            (x, director(&corners[node as usize], place))
        });
        let (x, directors): (Vec<Vec3>, Vec<Vec3>) = own.unzip();
        configuration(&x, &directors)
    };
    Ok(spec.cells.iter().enumerate().map(of).collect())
}

/// Places and axes of the nodes: the first axis is the part of the first edge normal to the director.
fn configuration(x: &[Vec3], directors: &[Vec3]) -> Configuration {
    let mut configuration = Configuration {
        x: [Vec3::zeros(); MOST],
        axes: [[Vec3::x(), Vec3::y(), Vec3::z()]; MOST],
    };
    let along = x[1] - x[0];
    for (a, (x, d)) in x.iter().zip(directors).enumerate() {
        let first = (along - d * d.dot(&along)).normalize();
        configuration.x[a] = *x;
        configuration.axes[a] = [first, d.cross(&first), *d];
    }
    configuration
}

/// The mean of the normals at a node that lie on the same side of folds as that of an element.
fn director(corners: &[Corner], element: usize) -> Vec3 {
    let own = corners.iter().find(|corner| corner.element == element);
    let own = own.map_or(Vec3::zeros(), |corner| corner.normal);
    let same = corners
        .iter()
        .filter(|corner| corner.normal.dot(&own) > FOLD);
    same.map(|corner| corner.normal).sum::<Vec3>().normalize()
}

/// Length of the longest edge or diagonal.
fn longest(x: &[Vec3]) -> f64 {
    let pairs = (0..x.len()).flat_map(|a| (0..a).map(move |b| (a, b)));
    pairs.map(|(a, b)| (x[a] - x[b]).norm()).fold(0.0, f64::max)
}

/// The corners at each node of the mesh.
fn corners(mesh: &Mesh, spec: &BodySpec) -> Result<Vec<Vec<Corner>>, Error> {
    let mut corners: Vec<Vec<Corner>> = Vec::new();
    corners.resize_with(mesh.nodes.len(), Vec::new);
    for (element, &cell) in spec.cells.iter().enumerate() {
        let nodes = mesh.element_nodes(cell);
        let refused = |why| refused(mesh, spec, cell, why);
        let x = |a: usize| Vec3::from(mesh.nodes[nodes[a % nodes.len()] as usize]);
        let (count, mut whole) = (nodes.len(), Vec3::zeros());
        let size = longest(&(0..count).map(x).collect::<Vec<_>>());
        let normal = |a: usize| (x(a + 1) - x(a)).cross(&(x(a + count - 1) - x(a)));
        (0..count).for_each(|a| whole += normal(a));
        let whole = whole / count as f64;
        if whole.norm() <= 1e-9 * size * size {
            return Err(refused("has no area, or crosses itself"));
        }
        let (flat, across) = (whole.norm(), whole.normalize());
        if (0..count).any(|a| normal(a).dot(&across) <= 1e-3 * flat) {
            return Err(refused("is not convex: an angle of it is 180° or more"));
        }
        let beside = (x(0) - x(1) + x(2) - x(count - 1)).dot(&across).abs();
        if count == 4 && beside > WARPED * size {
            return Err(refused(
                "is warped: its nodes lie too far beside a plane; divide it into triangles",
            ));
        }
        for (a, &node) in nodes.iter().enumerate() {
            corners[node as usize].push(Corner {
                element,
                normal: normal(a).normalize(),
            });
        }
    }
    Ok(corners)
}

fn refused(mesh: &Mesh, spec: &BodySpec, cell: ElementId, why: &'static str) -> Error {
    let nodes = mesh.element_nodes(cell);
    let mean = |i: usize| {
        let places = nodes.iter().map(|&node| mesh.nodes[node as usize][i]);
        places.sum::<f64>() / nodes.len() as f64
    };
    Error::ShellCell {
        body: spec.name.clone(),
        cell,
        centre: [0, 1, 2].map(mean),
        why,
    }
}

/// Refuses neighbours that run along their common edge in the same direction: their normals are opposite. More than two elements at
/// an edge have no common side.
fn agree(mesh: &Mesh, spec: &BodySpec) -> Result<(), Error> {
    let mut edges: Vec<([u32; 2], bool, ElementId)> = Vec::new();
    for &cell in &spec.cells {
        let nodes = mesh.element_nodes(cell);
        for (a, &from) in nodes.iter().enumerate() {
            let to = nodes[(a + 1) % nodes.len()];
            edges.push(([from.min(to), from.max(to)], from < to, cell));
        }
    }
    edges.sort_unstable_by_key(|(edge, _, cell)| (*edge, cell.index));
    for same in edges.chunk_by(|a, b| a.0 == b.0) {
        if let [(_, first, _), (_, second, cell)] = same
            && first == second
        {
            let why =
                "has its normal against that of its neighbour; orient all cells of a shell alike";
            return Err(refused(mesh, spec, *cell, why));
        }
    }
    Ok(())
}

pub(super) fn check(mesh: &Mesh, spec: &BodySpec, section: &ShellSection) -> Result<(), Error> {
    let body = || spec.name.clone();
    if spec.cells.is_empty() {
        return Err(Error::Empty { body: body() });
    }
    let flows = spec.material.plane_stress().is_some();
    if spec.weights.is_some() && (flows || section.rotations == Rotations::Finite) {
        return Err(Error::ShellRefused {
            body: body(),
            what: "a share of their volume with another model if they turn by any angle or flow",
        });
    }
    if spec.material.finite().is_some() && spec.material.plane_stress().is_none() {
        return Err(Error::FiniteKinematics {
            body: body(),
            kinematics: spec.kinematics.name(),
        });
    }
    match spec.formulation {
        Formulation::Full => {}
        Formulation::Reduced { .. } if section.rotations == Rotations::Finite => {}
        Formulation::Reduced { .. } => {
            return Err(Error::ShellRefused {
                body: body(),
                what: "one point with small rotations",
            });
        }
        Formulation::BBar => return Err(Error::LinearFormulation { body: body() }),
    }
    if section.rotations == Rotations::Finite && section.offset != 0.0 {
        return Err(Error::ShellRefused {
            body: body(),
            what: "an offset with finite rotations",
        });
    }
    for &cell in &spec.cells {
        let kind = mesh.kind(cell);
        if mesh.dim != 3 || !matches!(kind, Kind::Tri3 | Kind::Quad4) {
            return Err(Error::WrongElement {
                body: body(),
                found: kind.table().name,
                kinematics: spec.kinematics.name(),
                dim: Kinematics::dim(spec.kinematics),
            });
        }
        if spec.formulation != Formulation::Full && kind != Kind::Quad4 {
            return Err(Error::NotReduced {
                body: body(),
                found: kind.table().name,
            });
        }
    }
    Ok(())
}
