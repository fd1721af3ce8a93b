//! Neighbouring quadrilaterals with one point: their nodes, and what is constant of each.

use carom_algebra::number::Number;
use carom_algebra::tensor::Vec3;

use super::element::Element;
use super::one_point::Centre;
use super::products::{DIRECTOR, MOST};
use super::section::STRAINS;

/// Elements whose constants lie side by side, a multiple of the lanes of any register.
const SIDE: usize = 8;

/// Numbers of an element.
const FIELDS: usize = 66;

/// What is constant of several elements.
pub(super) struct Constants<T> {
    /// D and t₁ of each node at the start.
    pub director: [[T; 3]; MOST],
    pub first: [[T; 3]; MOST],
    /// Of [`Centre`]; the inverse of its lengths.
    pub to: [[T; 2]; 2],
    pub twist: [T; 2],
    pub inverse: [T; 2],
    pub area: T,
    /// m.
    pub thickness: T,
    /// Strains at the start: membrane, curvature and shear at the centre, what it does not see, and about the normal.
    pub start: [T; STRAINS - 1],
    pub unseen: [[T; 2]; 3],
    pub drilled: [T; MOST],
    /// Stiffness times area.
    pub membrane: [T; 3],
    pub coupling: [T; 3],
    pub bending: [T; 3],
    pub shear: T,
    pub drilling: T,
    pub hourglass: [T; 3],
}

/// Neighbouring elements.
#[derive(Debug)]
pub(super) struct Chunk {
    /// First unknowns, frames and places of the nodes.
    pub first: Vec<usize>,
    pub frames: Vec<usize>,
    pub x: Vec<Vec3>,
    /// Nodes of each element, as places in these lists.
    pub connectivity: Vec<[u32; MOST]>,
    /// [`FIELDS`] numbers of [`SIDE`] elements after the other, number by number.
    constants: Vec<f64>,
    /// From the nodes to the middle surface along the directors, m.
    pub offset: f64,
}

impl Chunk {
    pub(super) fn new(elements: &[Element], centres: &[Centre]) -> Chunk {
        let mut nodes: Vec<u32> = elements.iter().flat_map(|element| element.nodes).collect();
        nodes.sort_unstable();
        nodes.dedup();
        let mut chunk = Chunk {
            first: vec![0; nodes.len()],
            frames: vec![0; nodes.len()],
            x: vec![Vec3::zeros(); nodes.len()],
            connectivity: Vec::with_capacity(elements.len()),
            offset: elements.first().map_or(0.0, |element| element.offset),
            constants: vec![0.0; elements.len().div_ceil(SIDE) * SIDE * FIELDS],
        };
        for (place, (element, centre)) in elements.iter().zip(centres).enumerate() {
            let mut own = [0; MOST];
            for (a, own) in own.iter_mut().enumerate() {
                let node = nodes.partition_point(|&node| node < element.nodes[a]);
                *own = node as u32;
                chunk.first[node] = element.first[a];
                chunk.frames[node] = element.frames[a];
                chunk.x[node] = element.reference.x[a];
            }
            chunk.connectivity.push(own);
            let to = &mut chunk.constants[place / SIDE * SIDE * FIELDS..];
            for (field, value) in constants(element, centre).into_iter().enumerate() {
                to[field * SIDE + place % SIDE] = value;
            }
        }
        chunk
    }

    /// What is constant of the elements from one of them on.
    #[inline(always)]
    pub(super) fn constants<T: Number>(&self, first: usize, zero: T) -> Constants<T> {
        let from = first / SIDE * SIDE * FIELDS + first % SIDE;
        let of = &self.constants[from..];
        let mut place = 0;
        let mut next = || {
            let mut value = zero;
            let lanes = value.lanes_mut();
            let count = lanes.len();
            lanes.copy_from_slice(&of[place..place + count]);
            place += SIDE;
            value
        };
        macro_rules! list {
            ($($inner:tt)*) => { [$(list_item!($inner next)),*] };
        }
        macro_rules! list_item {
            (1 $next:ident) => {
                $next()
            };
            (2 $next:ident) => {
                [$next(), $next()]
            };
            (3 $next:ident) => {
                [$next(), $next(), $next()]
            };
        }
        Constants {
            director: list!(3 3 3 3),
            first: list!(3 3 3 3),
            to: list!(2 2),
            twist: list!(1 1),
            inverse: list!(1 1),
            area: next(),
            thickness: next(),
            start: list!(1 1 1 1 1 1 1 1),
            unseen: list!(2 2 2),
            drilled: list!(1 1 1 1),
            membrane: list!(1 1 1),
            coupling: list!(1 1 1),
            bending: list!(1 1 1),
            shear: next(),
            drilling: next(),
            hourglass: list!(1 1 1),
        }
    }
}

/// The numbers of an element, in the order of [`Constants`].
fn constants(element: &Element, centre: &Centre) -> Vec<f64> {
    let mut all = Vec::with_capacity(FIELDS);
    for axis in [DIRECTOR, 0] {
        for axes in &element.reference.axes {
            all.extend_from_slice(axes[axis].as_slice());
        }
    }
    all.extend(centre.to.as_flattened());
    all.extend(centre.twist);
    all.extend(centre.lengths.map(f64::recip));
    all.extend([centre.area, element.thickness[0]]);
    let start = &element.form.start;
    all.extend(&start[0][..STRAINS - 1]);
    all.extend([0, 1, 3, 4, 6, 7].map(|k| start[1][k]));
    all.extend(start.iter().map(|list| list[STRAINS - 1]));
    let elastic = &element.sections[0];
    let lists = [elastic.membrane, elastic.coupling, elastic.bending];
    let of_area = lists.into_iter().flatten();
    let of_area = of_area.chain([elastic.shear, elastic.drilling]);
    all.extend(of_area.map(|stiffness| stiffness * centre.area));
    all.extend(element.hourglass.map_or([0.0; 3], |own| own.stiffness));
    all
}
