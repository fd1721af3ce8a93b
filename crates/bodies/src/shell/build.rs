//! Building shells: what cells they take, their normals and directors.

use carom_algebra::tensor::Vec3;
use carom_algebra::unknowns::Unknowns;
use carom_elements::Kind;
use carom_mesh::{ElementId, Mesh};

use super::defects::{self, longest};
use super::element::Element;
use super::one_point::{Centre, Hourglass};
use super::pass::Pass;
use super::products::{Configuration, MOST};
use super::shares::{self, PointWeights};
use super::strain::Form;
use super::through::Through;
use super::{Shell, ShellSection};
use crate::spec::BodySpec;
use crate::{Error, Formulation, Kinematics, Rotations};

/// Cosine of the angle between the normals of two elements from which on the edge between them is a fold: 40°. Directors are means of
/// the normals on one side of a fold.
const FOLD: f64 = 0.766;

/// A corner of an element: its normal.
struct Corner {
    element: usize,
    normal: Vec3,
}

/// Whether the stiffness against hourglass modes is that of full integration, of a material that does not flow.
fn sees_all(formulation: Formulation, flows: bool) -> bool {
    matches!(formulation, Formulation::Reduced { hourglass } if hourglass >= 1.0) && !flows
}

impl Shell {
    /// Builds the elements on the cells of a mesh. `number`: system number of each mesh node; `unknowns`: of the nodes of the system, with
    /// rotations.
    ///
    /// # Errors
    /// No cell, cells that are neither tri3 nor quad4, a mesh that is not one of space; a cell without area or that is not convex, or too warped;
    /// neighbours whose normals disagree; a material at finite strain that is no metal, a formulation; plies whose thickness changes; nodes without one; weights of one
    /// point or of a metal, too few of them, or negative ones.
    pub(crate) fn new(
        mesh: &Mesh,
        spec: BodySpec,
        section: ShellSection,
        number: &[u32],
        unknowns: &Unknowns,
    ) -> Result<Shell, Error> {
        check(mesh, &spec, &section)?;
        let weights = shares::nodal(mesh, &spec)?;
        let geometry = geometry(mesh, &spec)?;
        let through = Through::new(&spec, section);
        let mut shell = Shell {
            name: spec.name.clone(),
            section,
            faces: through.faces(),
            borders: through.borders(),
            wave_speed: through.wave_speed(),
            cells: spec.cells.clone(),
            elements: Vec::new(),
            stiffness: Vec::new(),
            starts: vec![0],
            smallest: f64::INFINITY,
            layers: through.layers(),
            pass: None,
            sees_all: sees_all(spec.formulation, through.layers().is_some()),
        };
        let mut centres = Vec::new();
        for (place, &cell) in spec.cells.iter().enumerate() {
            let nodes = mesh.element_nodes(cell);
            let reference = geometry[place];
            let [alpha, delta] = &weights[place];
            let along = reference.axes[0][0];
            let middle = reference.beside(section.offset);
            let mut form = Form::new(nodes.len(), &middle, &along, delta);
            if let Formulation::Reduced { .. } = spec.formulation {
                let centre = Centre::new(&middle, &along);
                form = form.with_one_point(&middle, &centre);
                centres.push(centre);
            }
            let mut element = through.element((reference, form), nodes);
            if let (Formulation::Reduced { hourglass }, Some(centre)) =
                (spec.formulation, centres.last())
            {
                let section = &element.sections[0];
                element.hourglass = Some(Hourglass::new(section, centre.area, hourglass));
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
            shell.smallest = shell.smallest.min(element.area() / longest);
            if section.rotations == Rotations::Small {
                shell.stiffness.extend(element.stiffness());
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
        let shares = element.shares();
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
    if let Some(&cell) = defects::against(mesh, &spec.cells).first() {
        return Err(refused(mesh, spec, cell, defects::AGAINST));
    }
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

/// The corners at each node of the mesh.
fn corners(mesh: &Mesh, spec: &BodySpec) -> Result<Vec<Vec<Corner>>, Error> {
    let mut corners: Vec<Vec<Corner>> = Vec::new();
    corners.resize_with(mesh.nodes.len(), Vec::new);
    for (element, &cell) in spec.cells.iter().enumerate() {
        if let Some(why) = defects::of_shape(mesh, cell) {
            return Err(refused(mesh, spec, cell, why));
        }
        let nodes = mesh.element_nodes(cell);
        for (a, &node) in nodes.iter().enumerate() {
            corners[node as usize].push(Corner {
                element,
                normal: defects::corner(mesh, nodes, a).normalize(),
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

pub(super) fn check(mesh: &Mesh, spec: &BodySpec, section: &ShellSection) -> Result<(), Error> {
    let body = || spec.name.clone();
    if spec.cells.is_empty() {
        return Err(Error::Empty { body: body() });
    }
    let plies = spec.plies.iter().map(|ply| &ply.material);
    let materials = || std::iter::once(&spec.material).chain(plies.clone());
    let flows = materials().any(|law| law.plane_stress().is_some());
    if spec.weights.is_some() && (flows || spec.formulation != Formulation::Full) {
        return Err(Error::ShellRefused {
            body: body(),
            what: "a share of their volume with another model if they flow or have one point",
        });
    }
    if materials().any(|law| law.finite().is_some() && law.plane_stress().is_none()) {
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
    let varies = spec.nodal_thickness.is_some();
    if spec.weights.is_some() && (varies || !spec.plies.is_empty()) {
        return Err(Error::ShellRefused {
            body: body(),
            what: "a share of their volume with another model if they have plies or a thickness that changes",
        });
    }
    if varies && !spec.plies.is_empty() {
        return Err(Error::ShellRefused {
            body: body(),
            what: "plies whose thickness changes",
        });
    }
    let nodal = spec.nodal_thickness.iter();
    let mut unfit = nodal.flat_map(|nodal| {
        let nodes = spec.cells.iter().flat_map(|&cell| mesh.element_nodes(cell));
        nodes.filter(|&&node| !nodal.get(node as usize).is_some_and(|h| *h > 0.0))
    });
    if unfit.next().is_some() {
        return Err(Error::ShellRefused {
            body: body(),
            what: "a node without a thickness above zero",
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
