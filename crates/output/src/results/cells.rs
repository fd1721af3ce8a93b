//! Fields with one value per cell, over the cells of all bodies in their order.

use carom_dynamics::System;

/// Mean stress of each cell in VTK's order xx, yy, zz, xy, yz, xz, Pa: of Cauchy at finite strain. `histories`: of all
/// materials at `u`.
pub(crate) fn cell_stresses(system: &System, u: &[f64], histories: &[f64]) -> Vec<[f64; 6]> {
    let bodies = system.bodies.iter().enumerate();
    let of_bodies = bodies.flat_map(|(k, body)| body.stresses(u, system.history(k, histories)));
    of_bodies
        .map(|(_, s)| {
            [
                s[(0, 0)],
                s[(1, 1)],
                s[(2, 2)],
                s[(0, 1)],
                s[(1, 2)],
                s[(0, 2)],
            ]
        })
        .collect()
}

/// Equivalent plastic strain of each cell, zero in bodies without; `None` if no body has any.
pub(crate) fn plastic_strains(system: &System, histories: &[f64]) -> Option<Vec<f64>> {
    let bodies = system.bodies.iter().enumerate();
    let strains = bodies.map(|(k, body)| body.plastic_strains(system.history(k, histories)));
    let strains: Vec<Option<Vec<f64>>> = strains.collect();
    if strains.iter().all(Option::is_none) {
        return None;
    }
    let bodies = system.bodies.iter().zip(strains);
    let filled = bodies.flat_map(|(body, own)| own.unwrap_or(vec![0.0; body.cells().len()]));
    Some(filled.collect())
}

/// Equivalent stress of von Mises, sqrt(3/2 s : s) with s the deviator, Pa.
pub(crate) fn von_mises(stress: &[f64; 6]) -> f64 {
    let [xx, yy, zz, xy, yz, xz] = *stress;
    let normal = (xx - yy).powi(2) + (yy - zz).powi(2) + (zz - xx).powi(2);
    let shear = xy * xy + yz * yz + xz * xz;
    (0.5 * normal + 3.0 * shear).sqrt()
}

/// Whether each cell is deleted; `None` if no body has deletion.
pub(crate) fn deleted(system: &System, histories: &[f64]) -> Option<Vec<bool>> {
    let has_deletion = system.bodies.iter().any(|body| body.has_deletion());
    let bodies = system.bodies.iter().enumerate();
    let of_bodies = bodies.flat_map(|(k, body)| {
        let own = body.deleted(system.history(k, histories));
        own.unwrap_or(vec![false; body.cells().len()])
    });
    has_deletion.then(|| of_bodies.collect())
}
