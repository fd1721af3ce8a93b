//! The rows of links in the matrices of a step: what their multipliers change.
//!
//! A link gives rows `Σ_z C_z v_z = 0` at the end of the step. Their multipliers enter the balance of zone z as `w_z C_zᵀ L`, and
//! the velocity there is `ν_z x`. With `x = A⁻¹ (r + c Nᵀ P + w Cᵀ L)` the rows say
//!
//! `H L = -C ν A⁻¹ (r + c Nᵀ P)`, `H = C ν A⁻¹ w Cᵀ`, and `N x = N A⁻¹ r' + c (N A⁻¹ Nᵀ - (w/ν) bᵀ H⁻¹ b) P`, `b = C ν A⁻¹ Nᵀ`,
//!
//! with r' the forces and the multipliers without contact. So contact and links are one problem, exact with its signs, and a row may
//! end on the surface in contact.

use std::sync::Arc;

use carom_algebra::csr::Csr;
use carom_algebra::dense::DenseCholesky;
use carom_contact::Rows;

use crate::compliance::Compliance;
use crate::condensed::{Answer, Condensed, DENSE, Joined, Matrix};
use crate::driver::parts::part_matrix::part_matrix;
use crate::error::Error;
use crate::operator::Operators;
use crate::system::{LinkRow, Maps, System};

/// What the rows of links make of the matrices of one size of the step.
pub(crate) struct Linking {
    /// The rows, as they are where it was made.
    rows: Arc<Vec<LinkRow>>,
    /// H.
    condensed: Condensed,
    /// w of each part, and ν.
    factors: Vec<[f64; 2]>,
    /// By stacked row of the contact points, those met so far.
    points: Vec<Option<Point>>,
    /// The compliance over the candidates with the links, and the version of that without.
    matrix: Vec<f64>,
    of: Option<u64>,
    versions: u64,
    /// Scratch.
    half: Vec<f64>,
    x: Vec<f64>,
    force: Vec<f64>,
    moved: Vec<f64>,
}

/// What a unit force of a contact point leaves in the rows.
struct Point {
    dofs: Vec<u32>,
    coefficients: Vec<f64>,
    /// b; nothing of a point that moves no row.
    left: Vec<f64>,
    /// H⁻¹ b.
    held: Vec<f64>,
}

/// w and ν of the parts.
fn factors(system: &System, maps: &Maps) -> Vec<[f64; 2]> {
    let of_part = |part: &std::ops::Range<usize>| {
        let zone = system.zone_at(part.start);
        let [_, weight] = maps.link_weights(zone);
        [weight, maps.link_row(&maps.all()[zone]).x]
    };
    system.parts.iter().map(of_part).collect()
}

/// The parts of a row's terms, and the terms of each.
fn by_part((system, rows): (&System, &[LinkRow])) -> Vec<Vec<(u32, LinkRow)>> {
    let mut by_part: Vec<Vec<(u32, LinkRow)>> = vec![Vec::new(); system.parts.len()];
    for (number, row) in rows.iter().enumerate() {
        for &(dof, c) in row {
            let of_part = &mut by_part[system.part_of(dof as usize)];
            match of_part.last_mut() {
                Some((last, terms)) if *last == number as u32 => terms.push((dof, c)),
                _ => of_part.push((number as u32, vec![(dof, c)])),
            }
        }
    }
    by_part
}

/// The matrices that the iterations have made.
pub(crate) struct Made<'a> {
    /// Those of all iterated parts together; none without such parts.
    pub(crate) matrix: Option<&'a Csr>,
    /// Configuration parts these are.
    pub(crate) iterated: &'a [bool],
    /// Whether contact forces that turn couple parts in it.
    pub(crate) coupled: bool,
    /// A number above which no matrices of others have versions.
    pub(crate) version: u64,
}

/// H from the matrices of the parts where there are many rows, from their answers where there are few or `matrix` is none.
fn condensed(
    (system, rows): (&System, &[LinkRow]),
    factors: &[[f64; 2]],
    operators: &mut Operators,
    matrix: Option<&dyn Fn(usize) -> Matrix>,
) -> Result<Condensed, Error> {
    let count = rows.len();
    if let (true, Some(matrix)) = (count > DENSE, matrix) {
        let linked = by_part((system, rows)).into_iter().enumerate();
        let linked = linked.filter(|(_, rows)| !rows.is_empty());
        let answers = linked.map(|(part, rows)| Answer {
            system,
            span: system.parts[part].clone(),
            rows,
            matrix: matrix(part),
            scale: factors[part][0] * factors[part][1],
        });
        let answers: Vec<Answer> = answers.collect();
        return Ok(Condensed::Joined(Box::new(Joined::new(&answers, count)?)));
    }
    let n = system.unknowns();
    let (mut half, mut x, mut force) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
    let mut h = vec![0.0; count * count];
    let mut unit = vec![0.0; count];
    for column in 0..count {
        unit[column] = 1.0;
        force.fill(0.0);
        add_forces((system, rows), factors, &unit, &mut force);
        unit[column] = 0.0;
        operators.begin(&force, &mut half);
        operators.end(&mut half, &mut x);
        for (row, terms) in rows.iter().enumerate() {
            h[row * count + column] = velocity(system, factors, terms, &x);
        }
    }
    for i in 0..count {
        for j in 0..i {
            let mean = 0.5 * (h[i * count + j] + h[j * count + i]);
            (h[i * count + j], h[j * count + i]) = (mean, mean);
        }
    }
    let factor = DenseCholesky::new(count, &h);
    let factor = factor.map_err(|cause| Error::Redundant { rows: count, cause })?;
    Ok(Condensed::Dense(factor))
}

/// H of the mass alone, and M⁻¹ in `operators`.
pub(crate) fn of_mass(
    (system, rows): (&System, &[LinkRow]),
    operators: &mut Operators,
) -> Result<Condensed, Error> {
    let factors = vec![[1.0; 2]; system.parts.len()];
    let matrix = |part: usize| {
        let span = &system.parts[part];
        match system.mass.couples(span) {
            false => Matrix::Diagonal(system.mass.lumped[span.clone()].to_vec()),
            true => Matrix::Sparse(crate::operator::assembled(
                system,
                span,
                [1.0, 0.0],
                &|_| 0.0,
            )),
        }
    };
    condensed((system, rows), &factors, operators, Some(&matrix))
}

/// Adds Cᵀ L to a system vector, held unknowns included.
pub(crate) fn add_all_forces(system: &System, l: &[f64], force: &mut [f64]) {
    for (row, l) in system.links.rows.iter().zip(l).filter(|(_, l)| **l != 0.0) {
        for &(dof, c) in row {
            force[dof as usize] += c * l;
        }
    }
}

/// Adds w Cᵀ L to a system vector; nothing on held unknowns.
pub(super) fn add_forces(
    (system, rows): (&System, &[LinkRow]),
    factors: &[[f64; 2]],
    l: &[f64],
    force: &mut [f64],
) {
    for (row, l) in rows.iter().zip(l).filter(|(_, l)| **l != 0.0) {
        for &(dof, c) in row.iter().filter(|(dof, _)| !system.fixed[*dof as usize]) {
            let [weight, _] = factors[system.part_of(dof as usize)];
            force[dof as usize] += c * weight * l;
        }
    }
}

/// ν C x of one row, x of unknowns that move.
fn velocity(system: &System, factors: &[[f64; 2]], row: &LinkRow, x: &[f64]) -> f64 {
    let moved = row.iter().filter(|(dof, _)| !system.fixed[*dof as usize]);
    let term =
        |&(dof, c): &(u32, f64)| c * factors[system.part_of(dof as usize)][1] * x[dof as usize];
    moved.map(term).sum()
}

impl Linking {
    /// With the mass alone, whose factors are in `operators`: impulses, and multipliers that keep C M⁻¹ (Nᵀ P + Cᵀ J) = 0.
    ///
    /// # Errors
    /// Rows that say the same twice.
    pub(crate) fn of_mass(system: &System, operators: &mut Operators) -> Result<Linking, Error> {
        let factors = vec![[1.0; 2]; system.parts.len()];
        let rows = Arc::clone(&system.links.rows);
        let condensed = of_mass((system, &rows), operators)?;
        Ok(Linking::with(condensed, factors, (system, rows), 0))
    }

    fn with(
        condensed: Condensed,
        factors: Vec<[f64; 2]>,
        (system, rows): (&System, Arc<Vec<LinkRow>>),
        versions: u64,
    ) -> Linking {
        let n = system.unknowns();
        let points = system.points() * (1 + system.tangents());
        Linking {
            rows,
            condensed,
            factors,
            points: (0..points).map(|_| None).collect(),
            matrix: Vec::new(),
            of: None,
            versions,
            half: vec![0.0; n],
            x: vec![0.0; n],
            force: vec![0.0; n],
            moved: Vec::new(),
        }
    }

    /// With the matrices of linear parts, and those that the iterations have made of the others. `rows`: as they are now.
    ///
    /// # Errors
    /// Rows that say the same twice.
    pub(crate) fn new(
        (system, rows): (&System, &Arc<Vec<LinkRow>>),
        (maps, between): (&Maps, bool),
        (operators, made): (&mut Operators, &Made),
    ) -> Result<Linking, Error> {
        let factors = factors(system, maps);
        let matrix = |part: usize| {
            let span = &system.parts[part];
            let map = maps.of(span.start);
            if let (true, Some(all)) = (made.iterated[part], made.matrix) {
                return Matrix::Sparse(all.restricted(std::slice::from_ref(span)));
            }
            match part_matrix(system, span, map, between) {
                Some(matrix) => Matrix::Sparse(matrix),
                None => {
                    let lumped = system.mass.lumped[span.clone()].iter();
                    Matrix::Diagonal(lumped.map(|m| map.inertia.x * m).collect())
                }
            }
        };
        let matrix: Option<&dyn Fn(usize) -> Matrix> = (!made.coupled).then_some(&matrix);
        let condensed = condensed((system, rows), &factors, operators, matrix)?;
        let own = (system, Arc::clone(rows));
        Ok(Linking::with(condensed, factors, own, made.version))
    }

    /// The last version of its compliances.
    pub(crate) fn version(&self) -> u64 {
        self.versions
    }

    /// Moves the multipliers by `change` (added to it) so that rows hold which the forces `work`, begun in `half`, miss by themselves.
    /// `defect`: the rows without the motion of these forces. Adds the forces of the multipliers to `work`, and begins anew.
    pub(crate) fn hold(
        &mut self,
        system: &System,
        operators: &mut Operators,
        (work, half): (&mut [f64], &mut [f64]),
        (defect, change): (&mut [f64], &mut [f64]),
    ) {
        self.half.copy_from_slice(half);
        operators.end(&mut self.half, &mut self.x);
        for (defect, row) in defect.iter_mut().zip(self.rows.iter()) {
            *defect += velocity(system, &self.factors, row, &self.x);
        }
        self.condensed.solve(defect);
        for (change, l) in change.iter_mut().zip(defect.iter_mut()) {
            *l = -*l;
            *change += *l;
        }
        add_forces((system, &self.rows), &self.factors, defect, work);
        operators.begin(work, half);
    }

    /// The compliance over some points with the links: matrix and version.
    pub(crate) fn compliance(
        &mut self,
        system: &System,
        (operators, compliance): (&mut Operators, &Compliance),
        rows: &Rows,
    ) -> (&[f64], u64) {
        let points = compliance.rows();
        let mut fresh = self.of != Some(compliance.version);
        for &point in points {
            fresh |= self.meet(point, system, (&mut *operators, compliance), rows);
        }
        if fresh {
            self.of = Some(compliance.version);
            self.versions += 1;
            let n = points.len();
            self.matrix.clear();
            self.matrix.extend_from_slice(compliance.matrix());
            let moving = |&point: &u32| {
                let point = self.points[point as usize].as_ref();
                point.filter(|point| !point.left.is_empty())
            };
            for (i, one) in points.iter().enumerate() {
                let Some(one) = moving(one) else {
                    continue;
                };
                for (j, other) in points[..=i].iter().enumerate() {
                    let Some(other) = moving(other) else {
                        continue;
                    };
                    let taken = one.left.iter().zip(&other.held).map(|(b, g)| b * g);
                    let taken = taken.sum::<f64>() * self.ratio(system, one);
                    self.matrix[i * n + j] -= taken;
                    if i != j {
                        self.matrix[j * n + i] -= taken;
                    }
                }
            }
        }
        (&self.matrix, self.versions)
    }

    /// w/ν of the part that a point acts on; the system refuses contacts that see several.
    fn ratio(&self, system: &System, point: &Point) -> f64 {
        let part = point.dofs.first().map(|&dof| system.part_of(dof as usize));
        let [weight, rate] = self.factors[part.unwrap_or(0)];
        weight / rate
    }

    /// Makes b of a point ready; whether it is new.
    fn meet(
        &mut self,
        point: u32,
        system: &System,
        (operators, compliance): (&mut Operators, &Compliance),
        rows: &Rows,
    ) -> bool {
        let (dofs, coefficients) = rows.row(point as usize);
        let slot = &mut self.points[point as usize];
        let same = |kept: &Point| kept.dofs == dofs && kept.coefficients == coefficients;
        if slot.as_ref().is_some_and(same) {
            return false;
        }
        self.half.fill(0.0);
        compliance.add(point, 1.0, operators, &mut self.half);
        operators.end(&mut self.half, &mut self.x);
        let left = self.rows.iter();
        let left = left.map(|row| velocity(system, &self.factors, row, &self.x));
        let mut left: Vec<f64> = left.collect();
        if left.iter().all(|b| *b == 0.0) {
            left.clear();
        }
        let mut held = left.clone();
        if !held.is_empty() {
            self.condensed.solve(&mut held);
        }
        *slot = Some(Point {
            dofs: dofs.to_vec(),
            coefficients: coefficients.to_vec(),
            left,
            held,
        });
        true
    }

    /// The multipliers that keep the rows where nodal forces act, N: into `l`.
    pub(crate) fn balance(
        &mut self,
        system: &System,
        operators: &mut Operators,
        (force, l): (&[f64], &mut [f64]),
    ) {
        operators.begin(force, &mut self.half);
        operators.end(&mut self.half, &mut self.x);
        for (l, row) in l.iter_mut().zip(self.rows.iter()) {
            *l = -velocity(system, &self.factors, row, &self.x);
        }
        self.condensed.solve(l);
    }

    /// Moves the multipliers by what the forces of points (N, times c) ask for, `change` (added to it), and adds the forces of that to the begun
    /// solve.
    pub(crate) fn answer(
        &mut self,
        system: &System,
        operators: &mut Operators,
        forces: impl Iterator<Item = (u32, f64)>,
        (half, change): (&mut [f64], &mut [f64]),
    ) {
        self.moved.clear();
        self.moved.resize(change.len(), 0.0);
        for (point, force) in forces.filter(|(_, force)| *force != 0.0) {
            if let Some(point) = &self.points[point as usize] {
                for (moved, held) in self.moved.iter_mut().zip(&point.held) {
                    *moved -= force * held;
                }
            }
        }
        for (change, moved) in change.iter_mut().zip(&self.moved) {
            *change += moved;
        }
        self.force.fill(0.0);
        add_forces(
            (system, &self.rows),
            &self.factors,
            &self.moved,
            &mut self.force,
        );
        operators.begin(&self.force, &mut self.half);
        for (half, more) in half.iter_mut().zip(&self.half) {
            *half += more;
        }
    }
}

/// Multipliers of the attempt under way.
#[derive(Default)]
pub(crate) struct Multipliers {
    /// L at the end of the step, N per unit of the rows.
    pub(crate) now: Vec<f64>,
    /// What the iteration changes in them: to hold the rows without contact, and with the contact forces.
    pub(crate) change: [Vec<f64>; 2],
    /// The multipliers before an iteration.
    pub(crate) before: Vec<f64>,
    pub(crate) defect: Vec<f64>,
}

impl Multipliers {
    pub(crate) fn new(system: &System) -> Multipliers {
        let zeros = || vec![0.0; system.links.rows.len()];
        Multipliers {
            now: zeros(),
            change: [zeros(), zeros()],
            before: zeros(),
            defect: zeros(),
        }
    }
}
