//! Mortar integration: weak gaps at the nodes of the secondary surface.
//!
//! ```text
//! g_A = Σ_q c_Aq g_q,      c_Aq = w_q φ_A(ξ_q) / ∫ φ_A,      ∫ φ_A = Σ_q w_q φ_A(ξ_q)
//! ```
//!
//! over quadrature points on the pieces that a secondary face and the shadow of a primary one have in common
//! ([`super::overlap`]): what has nothing opposite is left out, also of ∫ φ_A. In each point the gap is that to the
//! closest point of the primary face that casts the shadow, so a multiplier's forces have neither resultant nor moment;
//! where surfaces are flat their pieces and feet agree, shape functions of both sides are integrated exactly, and a
//! uniform pressure gives the consistent nodal forces of both (the patch test of non-matching meshes). On quadrilaterals
//! that are no parallelograms shape functions are not polynomials in the plane, and the rules leave some 1e-5 of a force.
//!
//! Weights w_q are those of the reference secondary surface: `P_A / ∫ φ_A` is a pressure per reference area. Pieces and
//! weights are found anew at each configuration and held in derivatives, so Newton's method with sliding converges fast
//! but not quadratically; its residual is exact.
//!
//! Round a middle of a shell, or the axis of a beam in the plane, the surface is at its radius on both sides. A cell of such a face faces what is
//! on the side of the closest point: one side at a time.
//!
//! Segment-to-segment mortar: Puso and Laursen (2004), Popp, Gee and Wall (2009); dual bases: Wohlmuth (2000). Known from
//! these, derived here; the gap of a point along the primary normal, rather than an averaged secondary one, is a choice
//! of this project.

use carom_algebra::tensor::Vec3;
use carom_elements::{Element, MAX_FACE_NODES, map};
use carom_mesh::{Bounds, Face, Projection, project};

use super::Pairing;
use super::overlap::{Cell, Sample, cells};
use super::share::{Quadrature, Share};
use super::stencil::Stencil;
use crate::mortar::{Basis, CORNERS, Mortar, linear};
use crate::search::{Stand, is_beside_rim};
use crate::{Contact, Obstacle, Places, Point, Search, Target};

/// Part of its area that a multiplier must have opposite it to face anything.
const LEAST: f64 = 1e-6;

/// Distance of the closest point of the other side from the middle of a face, in radii of the face, beyond which the face
/// counts as facing nothing. In a step parts must come closer by less.
const FAR: f64 = 4.0;

impl Mortar {
    /// Pairs the multipliers of the contact as points; the first of them is that of the number `first` in the pairing.
    pub(super) fn pair(
        &self,
        (contact, basis): (&Contact, Basis),
        places: &Places,
        search: &mut Search,
        (first, pairing): (usize, &mut Pairing),
    ) {
        self.pair_some(
            (contact, basis),
            places,
            search,
            (&|_| true, first),
            pairing,
        );
    }

    /// The same of the multipliers, by their numbers in the contact, that are wanted; others stay as they are.
    pub(super) fn pair_some(
        &self,
        (contact, basis): (&Contact, Basis),
        places: &Places,
        search: &mut Search,
        (wants, first): (&dyn Fn(u32) -> bool, usize),
        pairing: &mut Pairing,
    ) {
        let mut work = std::mem::take(&mut pairing.work);
        work.shares.clear();
        for index in 0..self.faces.len() {
            let corners = self.multipliers[index].iter();
            if !corners
                .filter(|&&point| point != u32::MAX)
                .any(|&point| wants(point))
            {
                continue;
            }
            work.quadrature.clear();
            let mut sweep = Sweep {
                mortar: self,
                index,
                places,
                x: places.of_face(&self.faces[index]),
                stretch: self.constant_stretch(index, places.x),
                span: pairing.span,
                stencils: &mut pairing.stencils,
                quadrature: &mut work.quadrature,
            };
            match &contact.target {
                Target::Surface(faces) => {
                    sweep.over_faces((contact, faces), search, &mut work.found)
                }
                Target::Rigid(obstacle) => sweep.over_obstacle(obstacle),
            }
            self.share(index, basis, &work.quadrature, &mut work.shares);
        }
        work.shares
            .sort_unstable_by_key(|share| (share.point, share.stencil));
        let mut shares = work.shares.as_slice();
        for (number, point) in contact.points.iter().enumerate() {
            let own = shares.partition_point(|share| share.point as usize <= number);
            let (these, rest) = shares.split_at(own);
            if !wants(number as u32) {
                shares = rest;
                continue;
            }
            let least = LEAST * point.area;
            let point = (first + number, point.area, least);
            pairing.place_sum(places, point, these, &mut work.merge);
            shares = rest;
        }
        pairing.work = work;
    }

    /// Measure of a face per unit of the reference cell, if it is the same in all of it.
    fn constant_stretch(&self, index: usize, x: &[[f64; 3]]) -> Option<f64> {
        let flat = is_linear(self.faces[index].kind.table());
        flat.then(|| self.stretch(index, &[0.0; 3], x))
    }

    /// Appends w_q φ_A of the quadrature points of a face.
    fn share(
        &self,
        index: usize,
        basis: Basis,
        quadrature: &[Quadrature],
        shares: &mut Vec<Share>,
    ) {
        let n = linear(self.faces[index].kind.table()).nodes;
        let functions = match basis {
            Basis::Standard => None,
            Basis::Dual => biorthogonal(quadrature, n),
        };
        for point in quadrature {
            for a in 0..n {
                let phi = match &functions {
                    Some(functions) => (0..n).map(|b| functions[a][b] * point.phi[b]).sum(),
                    None => point.phi[a],
                };
                shares.push(Share {
                    point: self.multipliers[index][a],
                    stencil: point.stencil,
                    weight: point.weight * phi,
                });
            }
        }
    }
}

/// The quadrature points of one face on their way into the pools.
struct Sweep<'a> {
    mortar: &'a Mortar,
    index: usize,
    places: &'a Places<'a>,
    /// Where the nodes of the face are, m.
    x: [[f64; 3]; MAX_FACE_NODES],
    /// [`Mortar::constant_stretch`].
    stretch: Option<f64>,
    span: [f64; 2],
    stencils: &'a mut Vec<Stencil>,
    quadrature: &'a mut Vec<Quadrature>,
}

impl<'a> Sweep<'a> {
    fn face(&self) -> &'a Face {
        &self.mortar.faces[self.index]
    }

    /// All of the face, by its own rule.
    fn over_obstacle(&mut self, obstacle: &Obstacle) {
        let rule = self.face().kind.table().mass_rule;
        for (xi, &weight) in rule.points.iter().zip(rule.weights) {
            let point = self.point(xi);
            if let Some(stencil) = Stencil::on_obstacle(self.places, &point, obstacle, self.span) {
                self.push(&Sample { xi: *xi, weight }, &point, stencil);
            }
        }
    }

    /// What the shadows of other faces cover.
    fn over_faces(
        &mut self,
        (contact, faces): (&Contact, &[Face]),
        search: &mut Search,
        found: &mut Vec<u32>,
    ) {
        let (x, element) = (self.x, self.face().kind.table());
        // a face sees what its first corner sees
        let view = contact.view(self.mortar.multipliers[self.index][0] as usize);
        for cell in cells(element, &x[..element.nodes]) {
            let target = (self.places, faces);
            let within = FAR * radius(&cell) + self.radius() + contact.widest();
            let middle = cell.middle();
            let stand = Stand {
                x: &middle,
                of: None,
            };
            let Some((closest, _)) = search.closest(target, view, stand, within) else {
                continue;
            };
            let side = self.side(&cell, &closest);
            search
                .faces
                .overlapping(target, &shade(&cell, &closest), found);
            for &item in found.iter() {
                let face = &faces[item as usize];
                self.over_face((&cell, side), face, |foot| {
                    search.faces.shows(self.places, view, (item, face), foot)
                });
            }
        }
    }

    fn over_face(
        &mut self,
        (cell, side): (&Cell, f64),
        face: &Face,
        sees: impl Fn(&Projection) -> bool,
    ) {
        let (x, element) = (self.places.of_face(face), face.kind.table());
        let x = &x[..element.nodes];
        let low = is_linear(self.face().kind.table()) && is_linear(element);
        let round = face.is_round();
        // a surface on both sides of its middle is in sight from behind as well
        let both = round || self.face().is_round();
        let outward = cell.normal() * side;
        // the points of both faces have the same nodes
        let mut first: Option<Stencil> = None;
        for other in cells(element, x) {
            cell.shared(&other, (side, round, low), |sample| {
                let point = self.point(&sample.xi);
                let place = map::point(&self.x, point.shape());
                let foot = project(face, x, &place);
                let way = Vec3::from(foot.point) - Vec3::from(place);
                let ahead = !both || outward.dot(&way) > 0.0;
                let stand = Stand {
                    x: &place,
                    of: None,
                };
                let beside = is_beside_rim((stand, &foot), face, || self.places.of_face(face));
                if ahead && !beside && sees(&foot) {
                    let stencil = match &mut first {
                        Some(stencil) => {
                            stencil.shift(&point, &place, &foot);
                            stencil.clone()
                        }
                        None => {
                            let stencil =
                                Stencil::on_face(self.places, &point, &place, &foot, face);
                            first.insert(stencil).clone()
                        }
                    };
                    self.push(&sample, &point, stencil);
                }
            });
        }
    }

    fn point(&self, xi: &[f64; 3]) -> Point {
        Point::on_face(self.face(), xi).around(self.radius())
    }

    /// Distance of the surface from the places of the face, m.
    fn radius(&self) -> f64 {
        self.face().radius.unwrap_or(0.0)
    }

    /// On which side of its normal a cell faces the closest point: 1 or -1.
    fn side(&self, cell: &Cell, closest: &Projection) -> f64 {
        let way = Vec3::from(closest.point) - Vec3::from(cell.middle());
        match self.face().is_round() && cell.normal().dot(&way) < 0.0 {
            true => -1.0,
            false => 1.0,
        }
    }

    fn push(&mut self, sample: &Sample, point: &Point, stencil: Stencil) {
        let (mortar, xi) = (self.mortar, &sample.xi);
        let stretch = match self.stretch {
            Some(stretch) => stretch,
            None => mortar.stretch(self.index, xi, self.places.x),
        };
        let measure = stretch * mortar.factor(self.index, point.shape());
        let kind = self.face().kind;
        self.quadrature.push(Quadrature {
            stencil: self.stencils.len() as u32,
            weight: sample.weight * measure,
            // a face of corners alone has the functions of the multipliers
            phi: match (kind == kind.table().linear, point.shape()) {
                (true, &[a, b, c, d, ..]) => [a, b, c, d],
                _ => mortar.phi(self.index, xi),
            },
        });
        self.stencils.push(stencil);
    }
}

/// Whether all shape functions are linear, and so are their products with the measure quadratic at most.
fn is_linear(element: &Element) -> bool {
    element.nodes == element.dim + 1
}

/// The box that a cell sweeps along its normal, both ways, as far as a face at the distance of the closest point and
/// turned by 60 degrees could be.
fn shade(cell: &Cell, closest: &Projection) -> Bounds {
    let reach = cell.normal() * (2.0 * (closest.distance + radius(cell)));
    let moved = |x: &[f64; 3], sign: f64| [0, 1, 2].map(|i| x[i] + sign * reach[i]);
    cell.corners().iter().fold(Bounds::EMPTY, |bounds, x| {
        bounds.union(&Bounds::of(&[moved(x, 1.0), moved(x, -1.0)]))
    })
}

/// Largest distance of a corner from the middle of a cell, m.
fn radius(cell: &Cell) -> f64 {
    let middle = cell.middle();
    let square = |x: &[f64; 3]| (0..3).map(|i| (x[i] - middle[i]).powi(2)).sum::<f64>();
    cell.corners().iter().map(square).fold(0.0, f64::max).sqrt()
}

/// D M⁻¹ with `M_ab = Σ w φ_a φ_b` and `D_a = Σ w φ_a`; none where M is singular to 1e-10.
fn biorthogonal(quadrature: &[Quadrature], n: usize) -> Option<[[f64; CORNERS]; CORNERS]> {
    let (mut mass, mut areas) = ([[0.0; CORNERS]; CORNERS], [0.0; CORNERS]);
    for point in quadrature {
        for a in 0..n {
            areas[a] += point.weight * point.phi[a];
            for b in 0..n {
                mass[a][b] += point.weight * point.phi[a] * point.phi[b];
            }
        }
    }
    // Gauss and Jordan: M is symmetric and positive definite, or a pivot shows that it is not.
    let diagonal: [f64; CORNERS] = std::array::from_fn(|a| mass[a][a]);
    let mut inverse = [[0.0; CORNERS]; CORNERS];
    for (a, row) in inverse.iter_mut().enumerate() {
        row[a] = 1.0;
    }
    for k in 0..n {
        let pivot = mass[k][k];
        if pivot <= 1e-10 * diagonal[k] || diagonal[k] == 0.0 {
            return None;
        }
        for b in 0..n {
            mass[k][b] /= pivot;
            inverse[k][b] /= pivot;
        }
        for a in (0..n).filter(|&a| a != k) {
            let factor = mass[a][k];
            for b in 0..n {
                mass[a][b] -= factor * mass[k][b];
                inverse[a][b] -= factor * inverse[k][b];
            }
        }
    }
    for (row, area) in inverse.iter_mut().zip(areas) {
        row.iter_mut().for_each(|entry| *entry *= area);
    }
    Some(inverse)
}
