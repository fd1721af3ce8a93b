//! Surfaces that are tied to each other within one system.

use carom_arlequin::{Row, Rows, Term};
use carom_dynamics::{ModelBody, ModelConstraint};
use carom_mesh::{ElementId, Face, Mesh, Surface};
use carom_zones::mortar_rows;

use super::lookup;
use super::problems::Problems;
use crate::error::Problem;

/// The rows between two surfaces whose nodes need not match, ([`mortar_rows`]). `sides`: cells that may have such surfaces.
pub(super) fn lower(
    (mesh, bodies): (&Mesh, &[ModelBody]),
    (name, path): (&str, &str),
    names: &[String; 2],
    sides: &[ElementId],
    problems: &mut Problems,
) -> Option<ModelConstraint> {
    let path = format!("{path}.surfaces");
    let mut surface = |k: usize| {
        let place = format!("{path}[{k}]");
        lookup::surface(mesh, sides, &place, &names[k], problems)
    };
    let (one, other) = (surface(0), surface(1));
    let (one, other) = (one?, other?);
    let refuse = |message: &str, accepted: &str| {
        let problem = Problem::new(path.clone(), message).found(names.join(" and "));
        problem.accepted([accepted])
    };
    if one
        .nodes
        .iter()
        .any(|node| other.nodes.binary_search(node).is_ok())
    {
        let accepted = "surfaces of two bodies with nodes of their own";
        return problems.refuse(refuse("these surfaces have common nodes", accepted));
    }
    let body = lookup::body_behind(bodies, &one)?;
    let rows = mortar_rows(mesh, &one, &other, |x| {
        body.spec.kinematics.surface_factor(x)
    });
    if rows.rows.is_empty() {
        let accepted = "two surfaces that lie on each other";
        return problems.refuse(refuse(
            "these surfaces are nowhere opposite to each other",
            accepted,
        ));
    }
    let (gap, most) = (
        gap(mesh, &rows),
        APART * mean_diagonal(mesh, &one).min(mean_diagonal(mesh, &other)),
    );
    if gap > most {
        let message = format!("these surfaces are {gap:.4e} m apart");
        let accepted =
            format!("surfaces that lie on each other, within {most:.4e} m (a quarter of a face)");
        return problems.refuse(refuse(&message, &accepted));
    }
    Some(ModelConstraint::of_rows(name, &rows.rows, mesh.dim))
}

/// Distance of tied surfaces over the mean diagonal of their faces, above which they are not the same surface meshed twice: that of faceted round ones is
/// below an eighth where a face spans less than a radius.
const APART: f64 = 0.25;

/// The largest component of the mean distance of two surfaces around a multiplier, m: |Σ c x - Σ c' x'|/Σ c of its row.
fn gap(mesh: &Mesh, rows: &Rows) -> f64 {
    let sum = |terms: &[Term], of: &dyn Fn(&Term) -> f64| {
        terms
            .iter()
            .map(|term| term.coefficient * of(term))
            .sum::<f64>()
    };
    let place = |term: &Term| mesh.nodes[term.node as usize][term.component as usize];
    let of_row = |row: &Row| {
        let weight = sum(&row.inner, &|_| 1.0);
        ((sum(&row.inner, &place) - sum(&row.outer, &place)) / weight).abs()
    };
    rows.rows.iter().map(of_row).fold(0.0, f64::max)
}

/// The mean diagonal of the faces of a surface, m.
fn mean_diagonal(mesh: &Mesh, surface: &Surface) -> f64 {
    let of_face = |face: &Face| lookup::diagonal(mesh, face.corners());
    surface.faces.iter().map(of_face).sum::<f64>() / surface.faces.len() as f64
}
