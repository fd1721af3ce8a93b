//! From a model to a system: numbers, bodies, masses, contacts, initial values.

use std::ops::Range;
use std::sync::Arc;

use carom_algebra::rotation::Rotation;
use carom_algebra::unknowns::Unknowns;
use carom_bodies::{Body, Kinematics, Reduced, Rigid};
use carom_contact::{Contact, Frames, Places};
use carom_schemes::Scheme;

use crate::assemblies::Assemblies;
use crate::both_ways;
use crate::contact_pair::ContactPair;
use crate::contacts::{numbered, owners};
use crate::error::Error;
use crate::extents::{NodeMasses, diagonals};
use crate::initial::{settle, slack};
use crate::links::Links;
use crate::made::Made;
use crate::mass::Mass;
use crate::massless::redistribute;
use crate::mid_surfaces::{Carried, add_middles};
use crate::modal::NumberedModal;
use crate::model::{Model, ModelBody, ModelContact, ModelDiscrete};
use crate::moment_arms::MomentArms;
use crate::numbered::NumberedNonlinear;
use crate::numbering::{Numbering, numbering};
use crate::reported::ReportedSupport;
use crate::rigid::{add_centres, hold_axisymmetric, spin, unknowns};
use crate::system::{InitialMotion, System, part_of};
use crate::tolerances::tolerance;

impl System {
    /// Numbers the nodes by connected part and builds bodies, masses and contacts.
    ///
    /// # Errors
    /// A step that is not positive; a body that cannot be built; a scheme that cannot take the mass, the step or the
    /// contact law.
    pub fn new(mut model: Model) -> Result<Arc<System>, Error> {
        if !(model.dt > 0.0 && model.dt.is_finite()) {
            return Err(Error::Step { dt: model.dt });
        }
        if let Some(rules) = &model.adaptive
            && !(rules.smallest > 0.0 && rules.smallest <= model.dt)
        {
            return Err(Error::Adaptive {
                smallest: rules.smallest,
                largest: model.dt,
            });
        }
        let waiting = std::mem::take(&mut model.nonlinear.waiting);
        let staged = model.staged(waiting);
        let (mut system, bodies, contacts) = System::assemble(model)?;
        if let Some(staged) = staged {
            let (mut staged, ..) = System::assemble(staged)?;
            staged.mesh = Arc::clone(&system.mesh);
            system.staged = Some(Arc::new(staged));
        }
        system.check_overlaps(&contacts)?;
        system.check_massless(&contacts)?;
        for zone in 0..system.schemes.len() {
            system.check_scheme(zone, &bodies)?;
        }
        system.check_zones()?;
        system.check_nonlinear()?;
        system.check_integration()?;
        system.check_solver()?;
        Ok(Arc::new(system))
    }

    /// All bodies and contacts of a model in one numbering, to look at and not to be driven: whether the scheme takes the
    /// laws, the masses and the step is not asked. A model in zones has no scheme as a whole. Its links tell which bodies act on each other; their rows are
    /// known to the zones.
    ///
    /// # Errors
    /// A body that cannot be built.
    pub fn whole(mut model: Model) -> Result<Arc<System>, Error> {
        // their forces are known to the drivers of the zones
        model.named_supports.clear();
        let links = std::mem::take(&mut model.links);
        let (mut system, ..) = System::assemble(model)?;
        system.assemblies = Assemblies::linked(&system, &links);
        Ok(Arc::new(system))
    }

    fn assemble(mut model: Model) -> Result<(System, Vec<ModelBody>, Vec<ModelContact>), Error> {
        let nodes = Nodes::of(&mut model)?;
        System::assemble_on(model, nodes)
    }

    /// The system of a model on these nodes.
    pub(crate) fn assemble_on(
        model: Model,
        nodes: Nodes,
    ) -> Result<(System, Vec<ModelBody>, Vec<ModelContact>), Error> {
        let dim = model.mesh.dim;
        let Nodes {
            centres,
            carried,
            numbering,
        } = nodes;
        let Numbering {
            number,
            mesh_node,
            parts,
        } = numbering;
        let x: Vec<[f64; 3]> = mesh_node
            .iter()
            .map(|&node| model.mesh.nodes[node as usize])
            .collect();
        let (mut unknowns, initial_frames) =
            unknowns(&model, (&centres, &carried), &number, &mesh_node)?;
        let bodies = bodies(&model, (&centres, &number), &unknowns)?;
        for body in bodies.iter().filter_map(Body::as_reduced) {
            unknowns.recover(body.basis(&number));
        }
        let mut fixed = held(&model, &number, &unknowns);
        hold_axisymmetric(&model, (&bodies, &unknowns), &mut fixed);
        let mut mass = Mass::of(&bodies, &model.bodies, &unknowns);
        let mut room = vec![0.0; unknowns.len()];
        let mut body_masses: Vec<_> = bodies
            .iter()
            .map(|body| node_masses(body, (&number, &unknowns), &mut room))
            .collect();
        check_masses(&bodies, &body_masses, &mesh_node)?;
        let masses = (&mut mass, &mut body_masses[..]);
        let massless = redistribute(&model, &bodies, &number, (&x, &unknowns), masses)?;
        let damping = |k: usize| model.nonlinear.damping.get(k).map_or(0.0, |d| d.mass);
        let both = (&bodies[..], &model.bodies[..]);
        let damping_mass = Mass::of_damping(both, &damping, &body_masses, &unknowns);
        let modal = model.bodies.iter().enumerate().filter_map(|(k, body)| {
            let given = body.modal.as_ref()?;
            Some(NumberedModal::new(k, given, (&number, &unknowns)))
        });
        let modal = modal.collect();
        let load = mass.weight((&bodies, &unknowns), model.gravity);
        let nonlinear =
            NumberedNonlinear::new(&model, (&number, &unknowns), (&bodies, &mass), &fixed)?;
        let (mut initial_displacement, initial_velocity) = initial(
            &model,
            (&bodies, &body_masses),
            &fixed,
            (&unknowns, &initial_frames, &x),
        );
        for follows in &nonlinear.follows {
            fixed[follows.unknown as usize] = true;
            initial_displacement[follows.unknown as usize] = 0.0;
        }
        let places = Places {
            unknowns: &unknowns,
            time: 0.0,
            x: &x,
            u: &initial_displacement,
            frames: Frames {
                start: &initial_frames,
                ..Frames::default()
            },
        };
        let contacts = contacts(&model, (&number, &mesh_node), &places)?;
        let about = nearest_corner(&x);
        let origin = match model.contacts.is_empty() {
            true => about,
            false => [0.0; 3],
        };
        let parts: Vec<Range<usize>> = parts
            .into_iter()
            .map(|part| unknowns.of_range(part))
            .collect();
        let part_of_body = parts_of_bodies((&bodies, &unknowns), &parts);
        let (schemes, zone_of_body, spans) = schemes(&model, &bodies, &part_of_body, &parts)?;
        let links = Links::of(&model, &number, (&unknowns, &x))?;
        let undeformed = undeformed(&bodies, &part_of_body, parts.len());
        let of_parts: Vec<(Range<usize>, bool)> = parts
            .iter()
            .cloned()
            .zip(undeformed.iter().copied())
            .collect();
        let supports = ReportedSupport::all(
            &model.named_supports,
            (&number, &x),
            (&unknowns, &fixed),
            &of_parts,
        );
        let is_axisymmetric = |body: &ModelBody| body.spec.kinematics == Kinematics::Axisymmetric;
        let axisymmetric = model.bodies.iter().any(is_axisymmetric);
        let arms = MomentArms::new(&unknowns, parts.iter().zip(&undeformed));
        let made = Made {
            model: &model,
            owners: &owners(&model),
            bodies: &bodies,
            part_of_body: &part_of_body,
            number: &number,
            axisymmetric,
            unknowns: &unknowns,
            arms: &arms,
        };
        let contacts = ContactPair::all(contacts, &made)?;
        let mut system = System {
            assemblies: Assemblies::default(),
            supports,
            arms,
            undeformed,
            part_of_body,
            origin,
            about,
            tolerance: tolerance(model.length(), model.mesh.rounding()),
            axisymmetric,
            dim,
            mesh_node,
            number,
            parts,
            unknowns,
            has_springs: bodies.iter().any(|body| !body.balances_itself()),
            has_bolts: bodies.iter().any(|body| !body.bolts().is_empty()),
            has_dashpots: bodies.iter().any(Body::has_damping),
            nodes_of_whole: x.len(),
            sharp: crate::sharp::points(&contacts, &x),
            diagonals: diagonals((&bodies, &body_masses), &x),
            bodies,
            body_masses,
            mass,
            damping_mass,
            modal,
            massless,
            fixed,
            load,
            contacts,
            scheme: schemes[0],
            schemes,
            zone_of_body,
            links,
            spans,
            dt: model.dt,
            adaptive: model.adaptive,
            critical_fraction: model.critical_fraction,
            nonlinear,
            x,
            initial: InitialMotion {
                displacement: initial_displacement,
                velocity: initial_velocity,
                frames: initial_frames,
            },
            staged: None,
            mesh: Arc::new(model.mesh),
        };
        system.assemblies = Assemblies::of(&system);
        Ok((system, model.bodies, model.contacts))
    }
}

/// The bodies of a model, then its discrete elements.
fn bodies(
    model: &Model,
    (centres, number): (&[Option<u32>], &[u32]),
    unknowns: &Unknowns,
) -> Result<Vec<Body>, Error> {
    let body = |(body, centre): (&ModelBody, &Option<u32>)| {
        let spec = body.spec.clone();
        let node = centre.map(|centre| (number[centre as usize], unknowns));
        if let (Some(reduced), Some(node)) = (&body.reduced, node) {
            let reduced = Reduced::new(Arc::clone(reduced), number, node);
            return Ok(Body::Reduced(reduced));
        }
        match (body.rigid, node) {
            (Some(rigid), Some(node)) => {
                let rigid = Rigid::new(spec.name, spec.cells, rigid.inertia, node);
                Ok(Body::Rigid(rigid))
            }
            _ => Body::new(&model.mesh, spec, number, unknowns),
        }
    };
    let discrete =
        |some: &ModelDiscrete| Body::discrete(&model.mesh, some.spec.clone(), number, unknowns);
    let of_cells = model.bodies.iter().zip(centres).map(body);
    let all = of_cells.chain(model.discrete.iter().map(discrete));
    Ok(all.collect::<Result<Vec<_>, _>>()?)
}

/// Which unknowns supports hold.
fn held(model: &Model, number: &[u32], unknowns: &Unknowns) -> Vec<bool> {
    let mut fixed = vec![false; unknowns.len()];
    for support in &model.supports {
        let numbers = support.nodes.iter().map(|&node| number[node as usize]);
        for node in numbers.filter(|&node| node != u32::MAX) {
            for unknown in unknowns.of(unknowns.moved_by(node)) {
                fixed[unknown] |= support.holds(unknowns.kind(unknown));
            }
        }
    }
    fixed
}

/// The contacts by number, where they are at the start.
///
/// # Errors
/// A contact that is not as its case says.
fn contacts(
    model: &Model,
    (number, mesh_node): (&[u32], &[u32]),
    places: &Places,
) -> Result<Vec<Contact>, Error> {
    let own = model.contacts.iter();
    let mut contacts: Vec<Contact> = own
        .map(|contact| {
            let both_ways = both_ways::numbered(contact, model, number, places.x);
            both_ways.unwrap_or_else(|| numbered(contact, model, number, places.x))
        })
        .collect();
    let ways = model.contacts.iter().map(|contact| contact.initial);
    settle(&mut contacts, ways, places, (mesh_node, slack(model)))?;
    Ok(contacts)
}

/// The part of each body: of its first unknown.
fn parts_of_bodies((bodies, unknowns): (&[Body], &Unknowns), parts: &[Range<usize>]) -> Vec<usize> {
    let part = |body: &Body| {
        let mut first = None;
        body.each_element(&mut |nodes| {
            first.get_or_insert(unknowns.first(nodes[0]));
        });
        part_of(parts, first.unwrap_or(0))
    };
    bodies.iter().map(part).collect()
}

/// The nodes of a system.
pub(crate) struct Nodes {
    /// Those of the rigid and reduced bodies.
    centres: Vec<Option<u32>>,
    carried: Vec<Carried>,
    pub(crate) numbering: Numbering,
}

impl Nodes {
    /// Those of a model, which is given the ones that its mesh does not have; initial penetrations are removed.
    ///
    /// # Errors
    /// Penetrations that are left, a body of cells that no shell can be built on.
    pub(crate) fn of(model: &mut Model) -> Result<Nodes, Error> {
        model.remove_penetrations()?;
        let centres = add_centres(model);
        let carried = add_middles(model)?;
        model.mesh.shrink_to_fit();
        Ok(Nodes {
            numbering: numbering(model, &centres, &carried),
            centres,
            carried,
        })
    }
}

/// See [`System::undeformed`].
fn undeformed(bodies: &[Body], part_of_body: &[usize], parts: usize) -> Vec<bool> {
    let of_part = |part: usize| {
        let own = || {
            bodies
                .iter()
                .zip(part_of_body)
                .filter(move |(_, of)| **of == part)
        };
        own().any(|(body, _)| body.has_small_displacements())
            && own().all(|(body, _)| body.has_small_displacements() || body.as_discrete().is_some())
    };
    (0..parts).map(of_part).collect()
}

/// The place nearest to zero in the box around some places, m.
fn nearest_corner(x: &[[f64; 3]]) -> [f64; 3] {
    [0, 1, 2].map(|i| {
        let along = x.iter().map(|x| x[i]);
        let (low, high) = along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        });
        0.0_f64.min(high).max(low)
    })
}

/// The schemes, each once, the number of each body's, and the unknowns by scheme.
type Schemes = (Vec<Scheme>, Vec<usize>, Vec<(Range<usize>, usize)>);

/// # Errors
/// Bodies of one connected part that have different schemes.
fn schemes(
    model: &Model,
    bodies: &[Body],
    part_of_body: &[usize],
    parts: &[Range<usize>],
) -> Result<Schemes, Error> {
    let mut of_part: Vec<Option<Scheme>> = vec![None; parts.len()];
    for (k, body) in model.bodies.iter().enumerate() {
        let own = model.scheme_of(k);
        let of_part = of_part[part_of_body[k]].get_or_insert(own);
        if *of_part != own {
            return Err(Error::SchemesOfPart {
                body: body.spec.name.clone(),
                schemes: [of_part.get().name(), own.get().name()],
            });
        }
    }
    let mut schemes: Vec<Scheme> = Vec::new();
    let mut spans: Vec<(Range<usize>, usize)> = Vec::new();
    let mut zone_of_part = Vec::new();
    for (part, scheme) in parts.iter().zip(of_part) {
        // point masses by themselves
        let scheme = scheme.unwrap_or(model.scheme);
        let known = schemes.iter().position(|one| *one == scheme);
        let zone = known.unwrap_or_else(|| {
            schemes.push(scheme);
            schemes.len() - 1
        });
        zone_of_part.push(zone);
        match spans.last_mut() {
            Some((span, of)) if *of == zone => span.end = part.end,
            _ => spans.push((part.clone(), zone)),
        }
    }
    if schemes.is_empty() {
        schemes.push(model.scheme);
    }
    let zones = (0..bodies.len()).map(|body| {
        let part = part_of_body[body];
        zone_of_part.get(part).copied().unwrap_or(0)
    });
    Ok((schemes, zones.collect(), spans))
}

/// `room`: a system vector of zeros, and one again afterwards.
fn node_masses(
    body: &Body,
    (number, unknowns): (&[u32], &Unknowns),
    room: &mut [f64],
) -> NodeMasses {
    if let Body::Reduced(reduced) = body {
        let masses = reduced.reduction().masses.iter();
        return masses
            .map(|(node, m)| (number[*node as usize], *m))
            .collect();
    }
    body.add_lumped_mass(room);
    let mut nodes = Vec::new();
    body.each_element(&mut |own| nodes.extend_from_slice(own));
    nodes.sort_unstable();
    nodes.dedup();
    let mass = |&node: &u32| (node, room[unknowns.first(node)]);
    let masses = nodes.iter().map(mass).filter(|(_, mass)| *mass > 0.0);
    let masses = masses.collect();
    for node in nodes {
        room[unknowns.of(node)].fill(0.0);
    }
    masses
}

fn initial(
    model: &Model,
    (system_bodies, masses): (&[Body], &[NodeMasses]),
    fixed: &[bool],
    (unknowns, frames, x): (&Unknowns, &[Rotation], &[[f64; 3]]),
) -> (Vec<f64>, Vec<f64>) {
    let (mut u, mut v) = (vec![0.0; fixed.len()], vec![0.0; fixed.len()]);
    let bodies = model.bodies.iter();
    let bodies = bodies.map(|body| (Some(body.displacement), Some(body.velocity)));
    let discrete = model.discrete.iter();
    let discrete = discrete.map(|some| (some.displacement, some.velocity));
    for ((displacement, velocity), masses) in bodies.chain(discrete).zip(masses) {
        for &(node, _) in masses {
            for (i, dof) in unknowns.translations_of(node).enumerate() {
                if !fixed[dof] {
                    u[dof] = displacement.map_or(u[dof], |given| given[i]);
                    v[dof] = velocity.map_or(v[dof], |given| given[i]);
                }
            }
        }
    }
    for (body, given) in system_bodies.iter().zip(&model.bodies) {
        if let Body::Reduced(reduced) = body {
            for (of, motion) in [(&mut u, given.displacement), (&mut v, given.velocity)] {
                reduced
                    .uniform(motion)
                    .for_each(|(unknown, q)| of[unknown] = q);
            }
        }
    }
    spin(model, masses, (unknowns, frames, x), &mut v);
    for (v, _) in v.iter_mut().zip(fixed).filter(|(_, fixed)| **fixed) {
        *v = 0.0;
    }
    (u, v)
}

/// Refuses springs and dashpots at nodes without mass: nothing says how they move.
fn check_masses(
    bodies: &[Body],
    masses: &[Vec<(u32, f64)>],
    mesh_node: &[u32],
) -> Result<(), Error> {
    let mut heavy = vec![false; mesh_node.len()];
    for &(node, _) in masses.iter().flatten() {
        heavy[node as usize] = true;
    }
    for body in bodies.iter().filter(|body| body.as_discrete().is_some()) {
        let mut light = None;
        body.each_element(&mut |nodes| {
            let mut without = nodes.iter().filter(|node| !heavy[**node as usize]);
            light = light.or(without.next().copied());
        });
        if let Some(node) = light {
            return Err(Error::NoMass {
                element: body.name().to_owned(),
                node: mesh_node[node as usize],
            });
        }
    }
    Ok(())
}
