//! The summary of a run: what a script reads first, and what the report shows first.
//!
//! Signs: gap positive when open, contact force positive in compression, energy lost positive when lost. A value
//! that does not exist (the release of a contact that never opened) is `null`, never a made-up number.

mod contact;

use std::collections::BTreeMap;
use std::path::Path;

use carom_algebra::fingerprint::Fingerprint;
use carom_pages::form::near;
use serde::{Deserialize, Serialize};

use crate::expectations::Expectations;
use crate::maxima::Maxima;
use crate::statistics::{Check, Level};
use crate::verdict::Verdict;
use crate::{Error, atomic};
pub use contact::{Contact, Discrete, Friction, Load, PeakMoment, PeakResultant, Pretension};

/// Everything that `summary.json` says.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Version of the program.
    pub version: String,
    /// Title of the case.
    pub title: String,
    /// [`hash`] of the text of the case file.
    pub case_hash: String,
    /// Whether the result can be relied on, line by line.
    pub verdict: Verdict,
    /// The mesh and its unknowns.
    pub model: Model,
    /// Time scheme with its parameters, as text: `theta, theta = 0.5`.
    pub scheme: String,
    /// Steps in time.
    pub time: Time,
    /// Zones and links of a run in zones.
    #[serde(default)]
    pub zones: Option<Zones>,
    /// One entry per contact, by name.
    pub contacts: BTreeMap<String, Contact>,
    /// One entry per level of the case, by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub levels: BTreeMap<String, Level>,
    /// One entry per spring and dashpot, by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub discrete: BTreeMap<String, Discrete>,
    /// One entry per bolt that the static stage tightens, by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub pretensions: BTreeMap<String, Pretension>,
    /// One entry per load on a surface or at nodes, by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub loads: BTreeMap<String, Load>,
    /// Largest values of the fields.
    #[serde(default)]
    pub maxima: Maxima,
    /// What bodies, supports, springs and bolts had to bear, where the case says what they may.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub allowables: Vec<Check>,
    /// What the case must give, with what the run gave; absent where the case says nothing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub expectations: Option<Expectations>,
    /// Balance of energy.
    pub energy: Energy,
    /// Balance of linear momentum.
    pub momentum: Momentum,
    /// Distance from the exact solution, where the case names one.
    pub exact: Option<Exact>,
    /// Work done, in counts that do not depend on the machine.
    pub counts: Counts,
    /// The iterations of a run that is not linear.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub newton: Option<Newton>,
    /// Seconds spent, by the name of the part.
    pub timings: BTreeMap<String, f64>,
    /// Warnings of the check.
    pub warnings: Vec<String>,
    /// What steps of the run went on after.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub notices: Vec<String>,
    /// Files of the results folder, relative to it, but those that `fields.pvd` names.
    pub outputs: Vec<String>,
}

/// The mesh and its unknowns.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Model {
    /// Dimension of the space in which the bodies move.
    pub dimension: usize,
    /// Names of the bodies.
    pub bodies: Vec<String>,
    /// Nodes of the mesh.
    pub nodes: usize,
    /// Elements of the bodies, by kind.
    pub elements: BTreeMap<String, usize>,
    /// Degrees of freedom, supports excluded.
    pub unknowns: usize,
    /// Points at which contact is watched.
    pub contact_points: usize,
    /// Mass matrix: `lumped` or `consistent`, by body.
    pub mass: BTreeMap<String, String>,
    /// Mass that mass scaling has added, kg, by body, where there is some.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub added_mass: BTreeMap<String, f64>,
    /// What reduced bodies have of their full ones, by body.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub reduced: BTreeMap<String, ReducedBody>,
    /// Frequency (Hz) and damping ratio of each damped mode, by body.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub damped_modes: BTreeMap<String, Vec<[f64; 2]>>,
}

/// What a reduced body has of the full one.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ReducedBody {
    /// Unknowns of the full body, supports included.
    pub full_unknowns: usize,
    /// Retained nodes.
    pub retained_nodes: usize,
    /// Whether the retained nodes have no mass.
    pub massless: bool,
    /// Frequencies of the modes kept, Hz.
    pub frequencies: Vec<f64>,
    /// Effective mass of each mode kept along the axes, (Tᵀ M r)²/m of its amplitude, kg.
    pub effective_masses: Vec<Vec<f64>>,
    /// Highest frequency up to which those of the reduced body are those of the full one to 0.1 % by estimate, Hz.
    pub band: Option<f64>,
    /// Part of the mass that no mode moves along the axes, of what supports leave free.
    pub residual_mass: Option<Vec<f64>>,
}

/// Steps in time.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Time {
    /// Time reached, s.
    pub end: f64,
    /// Accepted steps.
    pub steps: u64,
    /// Attempts that were dropped.
    pub rejected: Rejected,
    /// Smallest accepted step, s; after a static stage that of the dynamics.
    pub smallest_step: f64,
    /// Largest accepted step, s; after a static stage that of the dynamics.
    pub largest_step: f64,
    /// Largest step times wave speed over element size (Courant number); each body with the step of its zone.
    pub courant: Option<f64>,
}

/// Attempts at a step that were dropped, by cause.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Rejected {
    /// A contact closed within the step.
    pub closing: u64,
    /// Bodies with a contact between them went through each other.
    pub passage: u64,
    /// Energy grew.
    pub energy_growth: u64,
    /// There was no solution.
    pub failure: u64,
}

/// What the zones of a run did, and the links between them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Zones {
    /// In the order of the case.
    pub zones: Vec<Zone>,
    /// In the order of the case.
    pub links: Vec<Link>,
    /// Energy that the links gave to the zones in sum, J: negative when they took some.
    #[serde(with = "float")]
    pub work_of_links: f64,
    /// The same over the kinetic and strain energy at the start; `null` without any.
    pub relative_work_of_links: Option<f64>,
    /// Mean number of passes over an outer step until the links held; `null` where contacts and links are one problem.
    pub passes_per_step: Option<f64>,
}

/// One zone.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Zone {
    /// Name as in the case file.
    pub name: String,
    /// Time scheme.
    pub scheme: String,
    /// Whether an energy identity of the scheme is known.
    pub has_identity: bool,
    /// Step, s.
    pub step: f64,
    /// Steps to one outer step.
    pub substeps: u32,
    /// Names of its bodies.
    pub bodies: Vec<String>,
    /// Elements of its bodies.
    pub elements: usize,
    /// Degrees of freedom, supports excluded.
    pub unknowns: usize,
    /// Largest step times wave speed over element size.
    pub courant: Option<f64>,
    /// Energy that the links gave to the zone, J.
    #[serde(with = "float")]
    pub work_of_links: f64,
    /// What it cost by itself; `null` of zones that are one system.
    pub costs: Option<ZoneCosts>,
}

/// What a zone that steps by itself cost, and how well its energy balances.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ZoneCosts {
    /// Largest magnitude of the zone's energy residual over the run, J.
    #[serde(with = "float")]
    pub largest_residual: f64,
    /// Numeric factorisations.
    pub factorisations: u64,
    /// Elements whose internal forces were computed.
    pub element_updates: u64,
    /// Solutions with a factor.
    pub solves: u64,
}

/// One link.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Link {
    /// Name as in the case file.
    pub name: String,
    /// Names of the inner and the outer zone.
    pub zones: [String; 2],
    /// Rows of its coupling, one multiplier each.
    pub rows: usize,
    /// Energy that it gave to both its sides in sum, J: negative when it took some.
    #[serde(with = "float")]
    pub work: f64,
}

/// Balance of energy, J. The residual says how accurately the equations are solved, the dissipation of the scheme what the
/// scheme makes or takes: by its exact identity in a linear run, in a nonlinear one by the works of inertia and internal
/// forces minus the changes of the energies.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Energy {
    /// Kinetic energy at the start.
    pub kinetic_initial: f64,
    /// Strain energy at the start.
    pub strain_initial: f64,
    /// Kinetic energy at the end.
    pub kinetic_final: f64,
    /// Strain energy at the end.
    pub strain_final: f64,
    /// Works over the run, positive when the bodies gain: of `loads` and `contact`, in zones of `links`, and where there is
    /// some of `supports` and `obstacles` that move.
    pub works: BTreeMap<String, f64>,
    /// Energy lost over the run, positive when lost: by the `scheme`, and where there is some in `materials`, by `damping`, by
    /// `friction`, by bulk `viscosity` and by the `deletion` of elements.
    pub dissipations: BTreeMap<String, f64>,
    /// Energy stored over the run beside strain energy, positive when stored, where there is some: in `hardening`, and by the
    /// `scheme` in a term of its own.
    pub stored: BTreeMap<String, f64>,
    /// Final - initial - Σ works + Σ dissipations + Σ stored.
    #[serde(with = "float")]
    pub residual: f64,
    /// Largest magnitude of the residual over the run.
    #[serde(with = "float")]
    pub largest_residual: f64,
    /// Largest kinetic and strain energy of the run, in a static stage the largest work of the loads if that is more.
    #[serde(default)]
    pub largest: f64,
    /// Largest energy of hourglass modes, a part of the strain energy, where there is some.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub largest_hourglass: Option<f64>,
    /// `largest_residual` over `largest`; what the check bounds: how far the equations are solved.
    #[serde(with = "float")]
    pub relative_residual: f64,
    /// Whether an energy identity of the scheme is known; without one what the scheme dissipates is in the residual.
    pub identity: bool,
}

impl Energy {
    /// A work or a loss of the run as it is shown to people, J: zero where it is what rounding leaves beside the largest energy.
    pub fn shown(&self, energy: f64) -> f64 {
        near(energy, self.largest)
    }

    /// Energy put in, J: that at the start, and the positive ones of the works of loads, supports and obstacles over the run.
    pub(crate) fn supplied(&self) -> f64 {
        let outside = ["loads", "supports", "obstacles"];
        let works = outside.iter().filter_map(|name| self.works.get(*name));
        let given = works.filter(|work| **work > 0.0).sum::<f64>();
        self.kinetic_initial + self.strain_initial + given
    }
}

/// Balance of linear momentum, N s.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Momentum {
    /// At the start.
    pub initial: [f64; 3],
    /// At the end.
    pub r#final: [f64; 3],
    /// Impulses from outside over the run, by name: `loads`, `supports`, `obstacles`; in zones `links`.
    pub impulses: BTreeMap<String, [f64; 3]>,
    /// Final - initial - Σ impulses.
    pub residual: [f64; 3],
    /// What the residual is relative to: the largest momentum or impulse, or sqrt(2 m E), the momentum that the largest energy
    /// could hold, if that is larger.
    pub size: f64,
    /// Largest component of the residual over the run over `size`; what the verdict bounds.
    #[serde(with = "float")]
    pub relative_residual: f64,
    /// Angular momentum, in the moving configuration, of a run that is not linear.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub angular: Option<Angular>,
}

/// Balance of angular momentum about a point, N m s.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Angular {
    /// The point, m: of the box around the mesh the one that is nearest to the origin of coordinates.
    #[serde(default)]
    pub about: [f64; 3],
    /// At the start.
    pub initial: [f64; 3],
    /// At the end.
    pub r#final: [f64; 3],
    /// Impulses of the moments from outside over the run, by name, as those of linear momentum.
    pub impulses: BTreeMap<String, [f64; 3]>,
    /// Final - initial - Σ impulses. Not checked: few schemes keep it in large rotations.
    pub residual: [f64; 3],
    /// Largest component of the residual over the run, relative to the largest angular momentum or impulse of a moment, or to
    /// the size of the linear momentum times the largest distance of a node from the point if that is larger.
    #[serde(with = "float")]
    pub relative_residual: f64,
}

impl Angular {
    /// The largest component at the start, at the end and of an impulse.
    pub(crate) fn largest(&self) -> f64 {
        let rows = [&self.initial, &self.r#final]
            .into_iter()
            .chain(self.impulses.values());
        rows.flatten()
            .fold(0.0, |most, part| f64::max(most, part.abs()))
    }
}

/// Distance of one contact from its exact solution. Relative errors are `null` where there is nothing to be relative to.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Exact {
    /// Name of the exact solution: `two-bars`.
    pub name: String,
    /// Name of the contact.
    pub contact: String,
    /// Relative L² error of the contact force, step by step against the mean of the exact force over the step, on all
    /// steps that meet the exact contact.
    pub force_error: Option<f64>,
    /// Relative L² error of the displacements of the contact points, counted from the start, over the run.
    pub displacement_error: Option<f64>,
    /// Largest exact force, N.
    pub peak_force: f64,
    /// Largest force of a single step / largest exact force - 1.
    pub overshoot: Option<f64>,
    /// Largest mean of the force over the window / largest exact force - 1.
    pub mean_overshoot: Option<f64>,
    /// Exact impulse up to the end of the run, N s.
    pub impulse: f64,
    /// Impulse / exact impulse - 1.
    #[serde(with = "float")]
    pub impulse_error: f64,
    /// Speed at which the mean motions part at the end of the run over that at which they approach at its start; `None`
    /// while the exact contact is closed, and where a clamp or gravity changes the momenta too.
    pub restitution: Option<f64>,
    /// The same of the exact solution.
    pub exact_restitution: Option<f64>,
}

/// Work done, in counts that do not depend on the machine.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Counts {
    /// Numeric factorisations of the effective matrix, over all sizes of the step.
    pub factorisations: u64,
    /// Triangular sweeps (a forward or a backward pass each).
    pub sweeps: u64,
    /// Entries of the factor.
    pub factor_entries: u64,
    /// Bytes of the factor.
    pub factor_bytes: u64,
    /// Columns A⁻¹ Nᵀ computed for contact points.
    pub contact_columns: u64,
    /// Products with matrices that are solved with by iterations.
    #[serde(default)]
    pub matrix_products: u64,
    /// Bytes of these columns and of the compliance of the contact.
    pub compliance_bytes: u64,
    /// Evaluations of the internal forces.
    pub force_sweeps: u64,
    /// Elements whose internal forces were computed, over all evaluations.
    #[serde(default)]
    pub element_updates: u64,
    /// Solutions with a factor: pairs of a forward and a backward sweep.
    #[serde(default)]
    pub solves: u64,
    /// Iterations of the contact status over the run; in zones passes over the steps until the links held.
    pub status_iterations: u64,
}

/// Iterations of Newton's method.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Newton {
    /// Over the run.
    pub iterations: u64,
    /// Mean of the steps.
    pub iterations_per_step: f64,
    /// Most in one step.
    pub most_iterations: u64,
    /// Numeric factorisations over the steps; below one where factors were kept.
    pub factorisations_per_step: f64,
    /// Times that a step or a part of one found no equilibrium, and was taken in halves.
    pub halvings: u64,
}

impl Summary {
    /// The summary as JSON.
    ///
    /// # Errors
    /// [`Error::Json`].
    pub fn to_json(&self) -> Result<String, Error> {
        Ok(serde_json::to_string_pretty(self)? + "\n")
    }

    /// Reads a summary back.
    ///
    /// # Errors
    /// [`Error::Json`].
    pub fn from_json(text: &str) -> Result<Summary, Error> {
        Ok(serde_json::from_str(text)?)
    }

    /// Writes the summary as one JSON file, whole or not at all.
    ///
    /// # Errors
    /// [`Error::Json`], [`Error::File`].
    pub fn write(&self, path: &Path) -> Result<(), Error> {
        atomic::write_text(path, &self.to_json()?)
    }
}

/// Fingerprint of a text as 16 hexadecimal digits (FNV-1a, 64 bits): tells whether two runs had the same case file;
/// no protection against intent.
pub fn hash(text: &str) -> String {
    Fingerprint::default().bytes(text.as_bytes()).digits()
}

/// Numbers that may be NaN or infinite exactly when something went wrong: JSON has no word for them but `null`, so
/// they are read back as NaN.
pub(crate) mod float {
    use serde::{Deserialize, Deserializer, Serializer};

    pub fn serialize<S: Serializer>(value: &f64, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_f64(*value)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
        Ok(Option::deserialize(deserializer)?.unwrap_or(f64::NAN))
    }
}
