//! Parts of models, in few words.

use carom_arlequin::{Coupling, Model as Side, Models, Overlap, Region, Rows, Weighting};
use carom_bodies::{BodySpec, CellWeights, Kinematics};
use carom_contact::law::{Adhesion, Capture, Compliance, Damped, Displacement, Reading, Velocity};
use carom_contact::{Law, Plane, Sliding};
use carom_dynamics::scheme::{CentralDifference, Newmark, Theta};
use carom_dynamics::{Driver, ModelBody, ModelContact, ModelTarget, Scheme, Support};
use carom_materials::{Elastic, Law as Material, NeoHooke};
use carom_mesh::{Group, Mesh, Surface};
use carom_zones::Zones;

use crate::Error;

/// The theta scheme.
pub(crate) fn theta(theta: f64) -> Scheme {
    Scheme::Theta(Theta { theta })
}

/// Newmark's scheme.
pub(crate) fn newmark(beta: f64, gamma: f64) -> Scheme {
    Scheme::Newmark(Newmark { beta, gamma })
}

/// Newmark's parameters (β, γ) in the paper's three runs.
pub(crate) const PAPER_SETS: [[f64; 2]; 3] = [[0.25, 0.5], [0.5, 0.5], [0.49, 0.9]];

/// Central differences.
pub(crate) const CENTRAL: Scheme = Scheme::CentralDifference(CentralDifference {});

/// The displacement law.
pub(crate) const DISPLACEMENT: Law = Law::Displacement(Displacement { projection: false });

/// The displacement law with projection of velocity and acceleration where points close.
pub(crate) const PROJECTION: Law = Law::Displacement(Displacement { projection: true });

/// The velocity law with closure taken as it stands.
pub(crate) const NOW: Law = velocity(Capture::Now);

/// The velocity law with closure taken half a step ahead.
pub(crate) const HALF: Law = velocity(Capture::Half);

/// The velocity law.
pub(crate) const fn velocity(capture: Capture) -> Law {
    Law::Velocity(Velocity {
        capture,
        reading: Reading::Closed,
    })
}

/// The compliance in velocity with C_n = `part` ρ c.
pub(crate) fn compliance(material: &Elastic, part: f64, capture: Capture) -> Law {
    let wave_speed = (material.young / material.density).sqrt();
    Law::Compliance(Compliance {
        damping: part * material.density * wave_speed,
        capture,
    })
}

/// The damped law with k_p = E / h and C_n = `part` ρ c. `size`: h in m.
pub(crate) fn damped(material: &Elastic, size: f64, part: f64, adhesion: Adhesion) -> Law {
    let wave_speed = (material.young / material.density).sqrt();
    Law::Damped(Damped {
        stiffness: material.young / size,
        damping: part * material.density * wave_speed,
        adhesion,
    })
}

/// A group of the mesh.
pub(crate) fn group<'a>(mesh: &'a Mesh, name: &str) -> Result<&'a Group, Error> {
    mesh.groups.get(name).ok_or_else(|| Error::Group {
        name: name.to_string(),
    })
}

/// The body made of the cells of a group, which gives its name; at rest, with lumped mass.
pub(crate) fn body(
    mesh: &Mesh,
    name: &str,
    kinematics: Kinematics,
    material: Elastic,
) -> Result<ModelBody, Error> {
    Ok(ModelBody::new(BodySpec::new(
        name,
        group(mesh, name)?.elements.clone(),
        kinematics,
        material,
    )))
}

/// A body at finite strain, neo-Hooke with these constants.
pub(crate) fn neo_hooke(
    mesh: &Mesh,
    name: &str,
    kinematics: Kinematics,
    initial: Elastic,
) -> Result<ModelBody, Error> {
    let mut made = body(mesh, name, kinematics, initial)?;
    made.spec.material = Material::NeoHooke(NeoHooke { initial });
    Ok(made)
}

/// Two bodies, inner and outer, glued where they overlap with linear weights and the coarse L2 mediator, and the rows.
pub(crate) fn glued(
    mesh: &Mesh,
    groups: [&str; 2],
    kinematics: Kinematics,
    material: Elastic,
) -> Result<([ModelBody; 2], Rows), Error> {
    let [inner, outer] = groups.map(|name| group(mesh, name));
    let models = Models {
        mesh,
        inner: &inner?.elements,
        outer: &outer?.elements,
    };
    let overlap = Overlap::new(models, &Region::Intersection)?;
    let weights = overlap.weights(&Weighting::default())?;
    let part = |name, side, inertia, stiffness| {
        let mut part = body(mesh, name, kinematics, material)?;
        part.spec.cells = overlap.cells(side).to_vec();
        part.spec.weights = Some(CellWeights { inertia, stiffness });
        Ok::<_, Error>(part)
    };
    let [inner, outer] = [weights.inner, weights.outer];
    let bodies = [
        part(groups[0], Side::Inner, inner.inertia, inner.stiffness)?,
        part(groups[1], Side::Outer, outer.inertia, outer.stiffness)?,
    ];
    let rows = overlap.rows(&Coupling::default())?;
    Ok((bodies, rows))
}

/// Displacement and velocity of each zone from those at a place in the plane.
pub(crate) fn plane_motion(
    zones: &Zones,
    of: impl Fn(&[f64; 3]) -> [[f64; 2]; 2],
) -> Vec<[Vec<f64>; 2]> {
    let vectors =
        |driver: &Driver| [0, 1].map(|k| driver.system().x.iter().flat_map(|x| of(x)[k]).collect());
    zones.drivers().iter().map(vectors).collect()
}

/// The surface of a body made of the facets of a group.
pub(crate) fn surface(mesh: &Mesh, name: &str, body: &ModelBody) -> Result<Surface, Error> {
    Ok(Surface::new(mesh, group(mesh, name)?, &body.spec.cells)?)
}

/// A contact, named "shock", with pairing anew at every step.
pub(crate) fn contact(secondary: Surface, primary: ModelTarget, law: Law) -> ModelContact {
    ModelContact {
        sliding: Sliding::Finite,
        ..ModelContact::new("shock", secondary, primary, law)
    }
}

/// The rigid plane through the origin with the axis `axis` as normal, turned by `sign`.
pub(crate) fn plane(axis: usize, sign: f64) -> ModelTarget {
    let mut normal = [0.0; 3];
    normal[axis] = sign;
    ModelTarget::rigid(Plane {
        point: [0.0; 3],
        normal,
    })
}

/// Holds the nodes of a group.
pub(crate) fn support(mesh: &Mesh, name: &str, fix: [bool; 3]) -> Result<Support, Error> {
    Ok(Support {
        nodes: mesh.group_nodes(group(mesh, name)?),
        fix,
        fix_rotations: [false; 3],
    })
}

/// The mesh with nodes at the same place as one.
pub(crate) fn welded(mut mesh: Mesh) -> Mesh {
    let mut first = Vec::new();
    for (node, x) in mesh.nodes.iter().enumerate() {
        let near = |y: &[f64; 3]| (0..2).all(|i| (x[i] - y[i]).abs() < 1e-9);
        first.push(mesh.nodes[..node].iter().position(near).unwrap_or(node) as u32);
    }
    for block in &mut mesh.blocks {
        for node in &mut block.nodes {
            *node = first[*node as usize];
        }
    }
    mesh
}
