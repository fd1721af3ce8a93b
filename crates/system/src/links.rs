//! Links and constraints in the numbers of a system.

use std::ops::Range;
use std::sync::Arc;

use carom_algebra::unknowns::Unknowns;

use crate::error::Error;
use crate::link_row::LinkRow;
use crate::model::{Model, ModelLink};
use crate::turning::TurningRows;

/// The rows of the links and constraints of a system.
#[derive(Debug, Default)]
pub struct Links {
    /// Name and range of the rows of each.
    pub named: Vec<(String, Range<usize>)>,
    /// The rows of all, of both sides, those of the inner side first.
    pub rows: Arc<Vec<LinkRow>>,
    /// Number of terms on the inner side of each row.
    pub inner_terms: Vec<usize>,
    /// Rows that turn with their nodes; their coefficients in `rows` are those of the reference position.
    pub turning: TurningRows,
}

impl Links {
    /// Numbers the rows of each link and of each constraint of a model.
    ///
    /// # Errors
    /// A constraint of an unknown that a node does not have; rows that turn without those of the same node.
    pub(crate) fn of(
        model: &Model,
        number: &[u32],
        (unknowns, x): (&Unknowns, &[[f64; 3]]),
    ) -> Result<Links, Error> {
        let (mut links, mut rows) = (Links::default(), Vec::new());
        for link in &model.links {
            let first = rows.len();
            let turning = &mut links.turning;
            match turning.add(link, (number, unknowns, x), &mut rows)? {
                Some(inner) => links.inner_terms.extend(inner),
                None => links.add_fixed(link, (number, unknowns), &mut rows),
            }
            let range = first..rows.len();
            links.named.push((link.name.clone(), range));
        }
        for constraint in &model.constraints {
            let first = rows.len();
            for given in &constraint.rows {
                let mut row: LinkRow = Vec::new();
                for &(node, kind, c) in given {
                    let own = number[node as usize];
                    let found = (own != u32::MAX).then(|| unknowns.find(own, kind));
                    let unknown = found.flatten().ok_or_else(|| Error::NoSuchUnknown {
                        constraint: constraint.name.clone(),
                        node,
                    })?;
                    row.push((unknown as u32, c));
                }
                // what a constraint holds is on one side
                links.inner_terms.push(row.len());
                rows.push(row);
            }
            let range = first..rows.len();
            links.named.push((constraint.name.clone(), range));
        }
        links.rows = Arc::new(rows);
        Ok(links)
    }

    /// Adds the rows of a link as they are.
    fn add_fixed(
        &mut self,
        link: &ModelLink,
        (number, unknowns): (&[u32], &Unknowns),
        rows: &mut Vec<LinkRow>,
    ) {
        for row in &link.rows {
            let term = |sign: f64| {
                move |term: &carom_arlequin::Term| {
                    let first = unknowns.first(number[term.node as usize]) as u32;
                    (first + term.component, sign * term.coefficient)
                }
            };
            let inner = row.inner.iter().map(term(1.0));
            let all = inner.chain(row.outer.iter().map(term(-1.0))).collect();
            rows.push(all);
            self.inner_terms.push(row.inner.len());
        }
    }
}
