//! Why a system could not be built.

use thiserror::Error as ThisError;

use crate::refused::Refused;

/// Errors of this crate.
#[derive(Debug, ThisError)]
pub enum Error {
    /// A body could not be built.
    #[error(transparent)]
    Body(#[from] carom_bodies::Error),
    /// Rules of an adaptive step that cannot be.
    #[error(
        "adaptive step: the smallest must be positive and at most the largest, {largest:e} s, not {smallest:e} s"
    )]
    Adaptive {
        /// Smallest step given, s.
        smallest: f64,
        /// Largest step, s.
        largest: f64,
    },
    /// A fixed step that cannot be: not positive or not finite.
    #[error("the step must be positive and finite, not {dt:.4e} s")]
    Step {
        /// The step given, s.
        dt: f64,
    },
    /// An explicit step beyond the stability limit.
    #[error("the step {dt:.4e} s is above the critical step {critical:e} s of the scheme")]
    Unstable {
        /// The step given, s.
        dt: f64,
        /// The critical step 2/ω, s.
        critical: f64,
    },
    /// A surface that faces itself has nodes inside its own body.
    #[error(
        "contact '{contact}': {points} nodes of the surface lie inside the body at the start, the first is node {node} of the mesh"
    )]
    Overlap {
        /// Name of the contact.
        contact: String,
        /// Number of such nodes.
        points: usize,
        /// One of them.
        node: u32,
    },
    /// A scheme that needs a diagonal mass meets a consistent one.
    #[error("the scheme {scheme} needs lumped mass, but body '{body}' has consistent mass")]
    ConsistentMass {
        /// Name of the scheme.
        scheme: &'static str,
        /// Name of the body.
        body: String,
    },
    /// Rows between finite rotations and a solid of which some are missing.
    #[error(
        "link '{link}': the rows of node {node} of the mesh are not complete: with finite rotations the rows of places and moments of a node hold together"
    )]
    TurningRows {
        /// Name of the link.
        link: String,
        /// The node of the mediator.
        node: u32,
    },
    /// A constraint of an unknown that a node does not have.
    #[error(
        "constraint '{constraint}': node {node} of the mesh does not have this unknown: only nodes of bodies move, and only those of beams and of rigid bodies turn"
    )]
    NoSuchUnknown {
        /// Name of the constraint.
        constraint: String,
        /// The node.
        node: u32,
    },
    /// A displacement law on a scheme whose end displacement does not depend on the forces of the step.
    #[error(
        "contact '{contact}': with an explicit scheme the displacement at the end of the step does not depend on the contact force: the displacement law is impossible"
    )]
    DisplacementLaw {
        /// Name of the contact.
        contact: String,
    },
    /// A projection at closure with a scheme that does not hold the balance at the end of the step.
    #[error(
        "contact '{contact}': the projection at closure needs velocity, acceleration and force in balance at the end of the step: only Newmark's scheme has this balance"
    )]
    Projection {
        /// Name of the contact.
        contact: String,
    },
    /// A spring or a dashpot at a node that has no mass.
    #[error(
        "`{element}` ends at node {node} of the mesh, which has no mass; give it a point mass, or end it at a node of a body"
    )]
    NoMass {
        /// Name of the spring or dashpot.
        element: String,
        /// Node of the mesh, from 0.
        node: u32,
    },
    /// A lumped mass of beams that is not diagonal.
    #[error(
        "body '{body}': the lumped mass of beams in space is diagonal only without offset, where their axes and those of their sections are parallel to the axes of coordinates; take a consistent mass"
    )]
    LumpedBeam {
        /// Name of the body.
        body: String,
    },
    /// Contact nodes that cannot be without mass.
    #[error("body '{body}' cannot have contact nodes without mass: {cause}")]
    Massless {
        /// Name of the body.
        body: String,
        /// Why.
        cause: &'static str,
    },
    /// A contact that cannot have nodes without mass.
    #[error("contact '{contact}' cannot have nodes without mass: {cause}")]
    MasslessContact {
        /// Name of the contact.
        contact: String,
        /// Why.
        cause: &'static str,
    },
    /// A contact whose law cannot hold at the Gauss points in the way asked for.
    #[error("contact '{contact}': {cause}")]
    Integration {
        /// Name of the contact.
        contact: String,
        /// Why.
        cause: &'static str,
    },
    /// A contact that has no moment about a point.
    #[error("contact '{contact}': {cause}")]
    MomentAbout {
        /// Name of the contact.
        contact: String,
        /// Why.
        cause: &'static str,
    },
    /// Surfaces that overlap at the start.
    #[error(
        "contact '{contact}': {points} points penetrate at the start, the deepest, at node {node}, by {depth:e} m"
    )]
    Penetration {
        /// Name of the contact.
        contact: String,
        /// Number of points.
        points: usize,
        /// Mesh node of the deepest.
        node: u32,
        /// Its depth, m.
        depth: f64,
    },
    /// A law in the rate on a scheme whose contact forces are those that keep the displacement.
    #[error(
        "contact '{contact}': the contact forces of the scheme {scheme} act on the displacement at the end of the step: the scheme needs the displacement law"
    )]
    RateLaw {
        /// Name of the contact.
        contact: String,
        /// Name of the scheme.
        scheme: &'static str,
    },
    /// A law in the gap on a scheme whose contact impulses are those that change the velocity.
    #[error(
        "contact '{contact}': the contact impulses of the scheme {scheme} act on the velocity at the end of the step: the scheme needs a law in the rate"
    )]
    GapLaw {
        /// Name of the contact.
        contact: String,
        /// Name of the scheme.
        scheme: &'static str,
    },
    /// Bodies that share nodes, with different schemes.
    #[error(
        "body '{body}' shares nodes with a body of the scheme {}, and has the scheme {}: bodies that share nodes have one scheme",
        schemes[0],
        schemes[1]
    )]
    SchemesOfPart {
        /// Name of the body.
        body: String,
        /// Names of both schemes.
        schemes: [&'static str; 2],
    },
    /// A scheme that stands by itself.
    #[error("the scheme {scheme} goes in no model with another one: {cause}")]
    SchemeAlone {
        /// Name of the scheme.
        scheme: &'static str,
        /// Why.
        cause: &'static str,
    },
    /// A contact that bodies of different schemes cannot have.
    #[error("contact '{contact}' in a model of the schemes {}: {cause}", schemes.join(" and "))]
    BetweenSchemes {
        /// Name of the contact.
        contact: String,
        /// Names of the schemes.
        schemes: Vec<&'static str>,
        /// Why.
        cause: &'static str,
    },
    /// Something that a model with loads in time, friction, finite strain or a static stage does not accept.
    #[error("{what}: {why}")]
    Nonlinear {
        /// What is refused.
        what: Refused,
        /// Why, and what would do.
        why: &'static str,
    },
}
