//! Plates and shells: triangles of three nodes and quadrilaterals of four, with shear and membrane strains that do not lock.
//!
//! A node has a place and three rotations. A director at each node of an element is the mean normal there; it turns with the node. Strains are
//! those of Reissner and Mindlin, with finite rotations of Green and Lagrange, from [`strain`]; forces and moments per length are linear in
//! them, of metals those of points through the thickness. Rotations about the normal are held by a weak form of the condition that they
//! are those of the middle surface (Hughes and Brezzi 1989, Comput. Methods Appl. Mech. Eng. 72, 105).
//!
//! Triangles resist shear by κ G h L̄²: with h² / (h² + 0.1 L²), L the longest edge, after Lyly, Stenberg and Vihinen (1993, Comput.
//! Methods Appl. Mech. Eng. 110, 343); the error of this factor is of the order of that of the element.

mod build;
mod chunk;
mod defects;
mod element;
mod finite;
mod kernel;
mod layers;
mod mass;
mod one_point;
mod pass;
mod products;
mod results;
mod section;
mod shares;
mod small;
mod strain;
mod surface;
mod through;
mod tying;

use std::ops::Range;

use carom_algebra::csr::Csr;
use carom_materials::Elastic;
use carom_mesh::ElementId;

pub use self::defects::{ShellDefect, shell_defects};
pub use self::results::Resultants;
pub use self::section::{LAYERS, Ply, ShellSection};
pub use self::surface::{ShellPlate, plates};

use self::element::{Element, PER_NODE};
use self::layers::Layers;
use self::pass::Pass;
use self::products::MOST;
use crate::scratch::Scratch;
use crate::{Error, Placement, Rotations, Stored};

/// A body of shell elements on a system.
#[derive(Debug)]
pub struct Shell {
    name: String,
    section: ShellSection,
    /// Undeformed materials at its faces, that to which the normal points first.
    faces: [Elastic; 2],
    /// Undeformed materials on both sides of where plies meet, and the height above the middle over the thickness.
    borders: Vec<(Elastic, f64)>,
    /// Speed of membrane waves, m/s.
    wave_speed: f64,
    cells: Vec<ElementId>,
    elements: Vec<Element>,
    /// K of each element over its unknowns, row-major, with small rotations; and where each begins.
    stiffness: Vec<f64>,
    starts: Vec<usize>,
    smallest: f64,
    /// Of metal that flows.
    layers: Option<Layers>,
    /// Of quadrilaterals with one point: elements side by side.
    pass: Option<Pass>,
    /// Whether what one point does not see has the stiffness of the material: its energy is strain energy then and that of no hourglass modes.
    sees_all: bool,
}

impl Shell {
    /// Name as in the case file.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its section.
    pub fn section(&self) -> &ShellSection {
        &self.section
    }

    /// Least and largest mean thickness of an element, m.
    pub fn thickness_range(&self) -> [f64; 2] {
        let all = self.elements.iter().map(Element::mean_thickness);
        all.fold([f64::INFINITY, 0.0], |[least, most], own| {
            [least.min(own), most.max(own)]
        })
    }

    /// Cells of the mesh.
    pub fn cells(&self) -> &[ElementId] {
        &self.cells
    }

    /// Speed of waves that stretch a plate, m/s.
    pub fn wave_speed(&self) -> f64 {
        self.wave_speed
    }

    /// Smallest size of an element, m: its area over its longest edge or diagonal.
    pub fn smallest_size(&self) -> f64 {
        self.smallest
    }

    /// System numbers of the nodes of each element.
    pub(crate) fn each_element(&self, visit: &mut dyn FnMut(&[u32])) {
        for element in &self.elements {
            visit(&element.nodes[..element.count]);
        }
    }

    /// Whether forces are linear in the displacement.
    pub(crate) fn is_linear(&self) -> bool {
        self.section.rotations == Rotations::Small && self.layers.is_none()
    }

    /// Whether its nodes turn by any angle.
    pub fn turns(&self) -> bool {
        self.section.rotations == Rotations::Finite
    }

    /// Adds the internal forces; see [`Body::force`](crate::Body::force).
    ///
    /// # Errors
    /// A section that flows has no stress between two displacements.
    pub(crate) fn force(
        &self,
        at: &Placement,
        new: &mut [f64],
        scratch: &mut Scratch,
        f: &mut [f64],
    ) -> Result<Stored, Error> {
        if self.layers.is_some() && at.from.is_some() {
            return Err(Error::NoBetween {
                body: self.name.clone(),
            });
        }
        Ok(match (self.turns(), &self.layers) {
            (true, _) => {
                let stored = self.finite_force(at, new, scratch, f);
                let hourglass = if self.sees_all { 0.0 } else { stored.hourglass };
                Stored {
                    hourglass,
                    ..stored
                }
            }
            (false, Some(layers)) => self.small_flow(layers, at, new, (&mut scratch.shells, f)),
            (false, None) => Stored {
                strain: self.small_force(at, f),
                ..Stored::default()
            },
        })
    }

    /// Numbers that the layers of an element keep; of triangles some are not used.
    fn kept_of_element(&self) -> usize {
        let layers = self.layers.as_ref();
        let points = if self.pass.is_some() { 1 } else { MOST };
        points * layers.map_or(0, Layers::history_len)
    }

    /// Numbers that it keeps from one step to the next.
    pub(crate) fn history_len(&self) -> usize {
        self.elements.len() * self.kept_of_element()
    }

    /// Place of the history of an element in that of all.
    fn history_of(&self, element: usize) -> Range<usize> {
        let kept = self.kept_of_element();
        kept * element..kept * (element + 1)
    }

    /// Largest equivalent plastic strain in the layers of each element; none where nothing flows.
    pub(crate) fn plastic_strains(&self, history: &[f64]) -> Option<Vec<f64>> {
        let layers = self.layers.as_ref()?;
        let of = |element| {
            let points = history[self.history_of(element)].chunks_exact(layers.history_len());
            points
                .map(|own| layers.plastic_strain(own))
                .fold(0.0, f64::max)
        };
        Some((0..self.elements.len()).map(of).collect())
    }

    /// Adds `by_u` ∂f/∂u to a matrix over all unknowns; see [`Body::add_tangent`](crate::Body::add_tangent).
    pub(crate) fn add_tangent(&self, at: &Placement, by_u: f64, matrix: &mut Csr) {
        let share = if at.from.is_some() { 0.5 } else { 1.0 };
        match (self.turns(), &self.layers) {
            (true, _) => self.add_finite_tangent(at, share * by_u, matrix),
            (false, Some(layers)) => self.add_small_tangent(layers, at, share * by_u, matrix),
            (false, None) => self.add_stiffness(share * by_u, &(0..usize::MAX), matrix),
        }
    }

    /// Adds `stiffness` K + `mass` M (consistent); see [`Body::assemble`](crate::Body::assemble).
    pub(crate) fn assemble(
        &self,
        [stiffness, mass]: [f64; 2],
        part: &Range<usize>,
        matrix: &mut Csr,
    ) {
        if stiffness != 0.0 && !self.turns() {
            self.add_stiffness(stiffness, part, matrix);
        }
        if mass != 0.0 {
            self.add_mass(mass, part, matrix);
        }
    }

    /// Adds a matrix of an element over its unknowns, row-major.
    fn add(&self, element: usize, factor: f64, own: &[f64], part: &Range<usize>, to: &mut Csr) {
        let element = &self.elements[element];
        if !part.contains(&element.first[0]) {
            return;
        }
        let n = PER_NODE * element.count;
        for (i, row) in element.unknowns().zip(own.chunks_exact(n)) {
            for (j, value) in element.unknowns().zip(row) {
                to.add(i - part.start, j - part.start, factor * value);
            }
        }
    }
}
