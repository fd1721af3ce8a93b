//! K and M of the linear parts of a system, and which parts belong together.

use std::ops::Range;

use carom_algebra::csr::Csr;
use carom_algebra::eigen::Problem;
use carom_algebra::pattern::Cliques;
use carom_algebra::solver::SparseRow;
use carom_bodies::Placement;
use carom_system::{System, push_cliques};

use crate::error::Error;

/// Stiffness and mass of all bodies over all unknowns of a system: the stiffness about the undeformed state, of beams and shells with finite rotations
/// the tangent there.
#[derive(Debug)]
pub struct Matrices {
    /// K, N/m.
    pub stiffness: Csr,
    /// M, kg, in the pattern of K.
    pub mass: Csr,
}

impl Matrices {
    /// Assembles both.
    ///
    /// # Errors
    /// A body without a tangent.
    pub fn new(system: &System) -> Result<Matrices, Error> {
        let all = 0..system.unknowns();
        let mut cliques = Cliques::new();
        for body in &system.bodies {
            push_cliques(body, &system.unknowns, &all, &mut cliques);
        }
        let mut stiffness = Csr::from_cliques(all.len(), &cliques);
        let mut mass = stiffness.clone();
        let (rest, histories) = (vec![0.0; all.len()], system.start_histories());
        for (number, body) in system.bodies.iter().enumerate() {
            match body.bends_finitely() {
                false => body.assemble([1.0, 0.0, 0.0], &all, &mut stiffness),
                true => {
                    let at = Placement {
                        u: &rest,
                        v: &rest,
                        from: None,
                        frames: &system.initial.frames,
                        dt: system.dt,
                        old: system.history(number, &histories),
                    };
                    body.add_tangent(&at, [1.0, 0.0], &mut stiffness)?;
                }
            }
        }
        system.mass.add_to(1.0, &all, 0, &mut mass);
        Ok(Matrices { stiffness, mass })
    }
}

/// Connected parts that rows of links join, and what of the system they are.
pub(crate) struct Group {
    /// Their unknowns, ascending.
    pub(crate) ranges: Vec<Range<usize>>,
    /// Their bodies.
    pub(crate) bodies: Vec<usize>,
    rows: Vec<usize>,
}

/// The groups of all parts, in the order of their first parts.
pub(crate) fn groups(system: &System) -> Vec<Group> {
    let mut leader: Vec<usize> = (0..system.parts.len()).collect();
    fn root(leader: &mut [usize], mut part: usize) -> usize {
        while leader[part] != part {
            leader[part] = leader[leader[part]];
            part = leader[part];
        }
        part
    }
    let part_of_row = |row: &[(u32, f64)]| -> Vec<usize> {
        row.iter()
            .map(|(dof, _)| system.part_of(*dof as usize))
            .collect()
    };
    for row in system.links.rows.iter() {
        let parts = part_of_row(row);
        for pair in parts.windows(2) {
            let [a, b] = [pair[0], pair[1]].map(|part| root(&mut leader, part));
            leader[a.max(b)] = a.min(b);
        }
    }
    let roots: Vec<usize> = (0..leader.len())
        .map(|part| root(&mut leader, part))
        .collect();
    let mut groups: Vec<Group> = Vec::new();
    let mut place = vec![usize::MAX; roots.len()];
    for (part, root) in roots.iter().enumerate() {
        if *root == part {
            place[part] = groups.len();
            groups.push(Group {
                ranges: Vec::new(),
                bodies: Vec::new(),
                rows: Vec::new(),
            });
        }
        let group = &mut groups[place[*root]];
        group.ranges.push(system.parts[part].clone());
    }
    for (body, part) in system.part_of_body.iter().enumerate() {
        groups[place[roots[*part]]].bodies.push(body);
    }
    for (number, row) in system.links.rows.iter().enumerate() {
        if let Some(part) = part_of_row(row).first() {
            groups[place[roots[*part]]].rows.push(number);
        }
    }
    groups
}

impl Group {
    /// Calls `solve` with the eigenvalue problem of the group, over its unknowns one after the other.
    pub(crate) fn problem<T>(
        &self,
        system: &System,
        matrices: &Matrices,
        solve: impl FnOnce(&Problem) -> T,
    ) -> T {
        let unknowns = || self.ranges.iter().cloned().flatten();
        let mut place = vec![0; system.unknowns()];
        for (own, unknown) in unknowns().enumerate() {
            place[unknown] = own as u32;
        }
        let row = |number: &usize| {
            let terms = system.links.rows[*number].iter();
            let (dofs, coefficients) = terms.map(|(dof, c)| (place[*dof as usize], *c)).unzip();
            SparseRow { dofs, coefficients }
        };
        let rows: Vec<SparseRow> = self.rows.iter().map(row).collect();
        let fixed: Vec<bool> = unknowns().map(|unknown| system.fixed[unknown]).collect();
        let groups: Vec<u32> = unknowns()
            .map(|unknown| system.unknowns.node(unknown))
            .collect();
        solve(&Problem {
            stiffness: &matrices.stiffness.restricted(&self.ranges),
            mass: &matrices.mass.restricted(&self.ranges),
            fixed: &fixed,
            groups: &groups,
            constraints: &rows,
        })
    }
}
