//! `[probe]`, `[output]` and `[reference]`: what is written and what it is compared with.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use carom_quantities::{Coordinate, Duration, Energy, Force, Frequency, Length, Modulus, Vector};

use super::named::Named;

/// A history at every step: of the mean motion of a group, or of the motion and the stress at a place.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(extend("oneOf" = [{ "required": ["on"] }, { "required": ["at"] }]))]
pub struct Probe {
    /// Group of the nodes: the mean of the motion over its length, area or volume, or over the mass of its nodes.
    pub on: Option<String>,
    /// What the mean over `on` is weighted by.
    #[serde(default)]
    pub mean: Mean,
    /// A place in the reference configuration: the motion of the node of a body that is nearest to it, and the stress of the cell whose
    /// middle is nearest to it.
    pub at: Option<Vector<Coordinate>>,
    /// Quantities to write.
    #[schemars(extend("minItems" = 1, "uniqueItems" = true))]
    pub record: Vec<Motion>,
    /// Response spectrum of the absolute acceleration, for floor spectra. Default: none.
    pub response_spectrum: Option<ProbeSpectrum>,
    /// Filters of SAE J211-1 behind which `acceleration` and `absolute-acceleration` are written too, in `filtered.csv`. Default:
    /// none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(extend("uniqueItems" = true))]
    pub filter: Vec<ChannelClass>,
}

/// What the mean of a probe is weighted by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Mean {
    /// The length, area or volume of the group; points count alike.
    #[default]
    Measure,
    /// The masses of the nodes of the group: on a whole body the motion of its centre of mass.
    Mass,
}

/// A channel frequency class of SAE J211-1: a low-pass filter without shift of phase. It needs ten steps in the period of its class.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema,
)]
pub enum ChannelClass {
    /// Corner at 100 Hz: whole structures.
    #[serde(rename = "cfc-60")]
    Cfc60,
    /// Corner at 300 Hz: velocities and displacements by integration.
    #[serde(rename = "cfc-180")]
    Cfc180,
    /// Corner at 1000 Hz: parts of structures.
    #[serde(rename = "cfc-600")]
    Cfc600,
    /// Corner at 1650 Hz: accelerations at the point of an impact.
    #[serde(rename = "cfc-1000")]
    Cfc1000,
}

impl ChannelClass {
    /// The class, Hz.
    pub fn frequency(self) -> u32 {
        match self {
            ChannelClass::Cfc60 => 60,
            ChannelClass::Cfc180 => 180,
            ChannelClass::Cfc600 => 600,
            ChannelClass::Cfc1000 => 1000,
        }
    }

    /// Its name in the case file.
    pub fn name(self) -> String {
        format!("cfc-{}", self.frequency())
    }
}

/// A response spectrum: largest absolute acceleration of oscillators on the probe, by their frequency.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct ProbeSpectrum {
    /// Damping ratio of the oscillators.
    #[serde(default = "five_per_cent")]
    #[schemars(range(min = 0.001, max = 0.5))]
    pub damping: f64,
    /// Lowest frequency.
    pub from: Frequency,
    /// Highest frequency, above the lowest one.
    pub to: Frequency,
    /// Number of frequencies, in a constant ratio.
    #[serde(default = "fifty")]
    #[schemars(range(min = 2, max = 1000))]
    pub points: u32,
}

fn five_per_cent() -> f64 {
    0.05
}

fn fifty() -> u32 {
    50
}

/// Contacts and stops that are judged together, as those of one grid or one storey.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Level {
    /// Names of contacts and stops. A name that ends with `*` stands for all that begin so.
    #[schemars(extend("minItems" = 1))]
    pub contacts: Vec<String>,
    /// What each of them may bear in one impact: the results have the margins. Default: nothing is judged.
    pub allowable: Option<Allowable>,
}

/// What a contact may bear: force and energy in one impact, stroke and crush over the run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(extend("anyOf" = [
    { "required": ["force"] },
    { "required": ["energy"] },
    { "required": ["stroke"] },
    { "required": ["crush"] },
]))]
pub struct Allowable {
    /// Largest force.
    pub force: Option<Force>,
    /// Largest energy that it takes up, of contacts whose law takes up any.
    pub energy: Option<Energy>,
    /// Largest penetration, of a stop its stroke.
    pub stroke: Option<Length>,
    /// Largest crush of a stop that stays.
    pub crush: Option<Length>,
}

/// What parts of the model may bear over the run. The results have the margins, and the report the least of them; nothing else changes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Allowables {
    /// Bodies by their names.
    #[serde(default, skip_serializing_if = "Named::is_empty")]
    pub body: Named<BodyAllowable>,
    /// Supports by their names.
    #[serde(default, skip_serializing_if = "Named::is_empty")]
    pub support: Named<SupportAllowable>,
    /// Springs by their names.
    #[serde(default, skip_serializing_if = "Named::is_empty")]
    pub spring: Named<SpringAllowable>,
    /// Bolts by their names in `pretension`.
    #[serde(default, skip_serializing_if = "Named::is_empty")]
    pub pretension: Named<PretensionAllowable>,
}

/// What a body may bear.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(extend("anyOf" = [{ "required": ["stress"] }, { "required": ["plastic-strain"] }]))]
pub struct BodyAllowable {
    /// Largest von Mises stress: of a cell, of a shell through its thickness, of a beam in its sections. Of all steps, or of those that
    /// `maxima.stress_every` of the summary tells.
    pub stress: Option<Modulus>,
    /// Largest equivalent plastic strain of a cell at the instants that are kept for pictures: between them it may have been larger.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub plastic_strain: Option<f64>,
}

/// What a support may bear at the end of a step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct SupportAllowable {
    /// Largest force of all its nodes together.
    pub force: Force,
}

/// What the springs of a name may bear at the end of a step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(extend("anyOf" = [{ "required": ["force"] }, { "required": ["stroke"] }]))]
pub struct SpringAllowable {
    /// Largest sum of their forces.
    pub force: Option<Force>,
    /// Largest mean of their elongations.
    pub stroke: Option<Length>,
}

/// What each bolt of a name may bear at the end of a step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct PretensionAllowable {
    /// Largest force of a bolt, over the static stage and the dynamics.
    pub force: Force,
}

/// What a probe writes.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema,
)]
#[serde(rename_all = "kebab-case")]
pub enum Motion {
    /// Displacement, m.
    Displacement,
    /// Velocity, m/s.
    Velocity,
    /// Acceleration, m/s².
    Acceleration,
    /// Acceleration with that of the ground, m/s²: in a run with base acceleration the other quantities are relative to the
    /// ground.
    AbsoluteAcceleration,
    /// Mean stress of the cell nearest to `at`, Pa, and its von Mises equivalent; at finite strain of Cauchy. Of beams and shells the stress is the
    /// mean over the section, and the von Mises equivalent the largest in it. It takes about as long as the internal forces of the body.
    Stress,
    /// Forces (N) and moments (N m) in the section of the beam or the shell nearest to `at`: of a beam normal force, shear forces, torque and bending moments at the end of the cell
    /// nearest to the place, in the axes of the section; of a shell membrane forces (N/m), bending moments (N) and shear forces (N/m) over the axes of
    /// coordinates. It takes about as long as the internal forces of the body.
    SectionForces,
    /// What the contact points at the nodes do, of the secondary side of a contact: sum of their normal forces, N, that over the area that they stand for, Pa, and the least of
    /// their gaps, m.
    Contact,
}

/// Output of a run beside its histories, which are always written at every step.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Output {
    /// Fields for ParaView. Default: none.
    pub fields: Option<Fields>,
    /// Rows of `histories.csv`. Default: one for every step.
    pub histories: Option<Histories>,
    /// Whether the histories are compressed, as `histories.csv.gz` and `contact.csv.gz`: some 30 % of the size. A run that goes
    /// on keeps the format.
    #[serde(default)]
    pub compress_histories: bool,
    /// Checkpoints, from which `carom resume` goes on. One is always written at the end of a run. Default: one every 60 s of wall
    /// time, two kept.
    pub checkpoint: Option<Checkpoint>,
    /// What bodies, supports, springs and bolts may bear; for contacts see `level`. Default: nothing is judged.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub allowable: Option<Allowables>,
}

/// When checkpoints are written while a run goes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Checkpoint {
    /// Simulated time between two of them. Default: by wall time alone.
    pub every: Option<Duration>,
    /// Wall time between two of them. It grows where writing one takes more than a hundredth of it. Default: 60 s, with `every`
    /// none.
    pub wall: Option<Duration>,
    /// Number of checkpoints that are kept.
    #[serde(default = "two")]
    #[schemars(range(min = 1, max = 100))]
    pub keep: u32,
}

impl Default for Checkpoint {
    fn default() -> Checkpoint {
        Checkpoint {
            every: None,
            wall: None,
            keep: two(),
        }
    }
}

impl Checkpoint {
    /// Least wall time between two checkpoints, s.
    pub fn least_wall(&self) -> Option<f64> {
        match (self.wall, self.every) {
            (Some(wall), _) => Some(wall.0),
            (None, None) => Some(60.0),
            (None, Some(_)) => None,
        }
    }
}

fn two() -> u32 {
    2
}

/// Rows of the histories.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Histories {
    /// Time between two rows. Forces of contacts are means over it; impacts, peaks and impulses follow every step nevertheless.
    pub every: Duration,
}

/// Fields on the whole mesh. The gap, pressure and sign fields of contact surfaces are always included.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Fields {
    /// Time between two outputs.
    pub every: Duration,
    /// Quantities to write.
    #[schemars(extend("minItems" = 1, "uniqueItems" = true))]
    pub record: Vec<Field>,
    /// Whether they are written as VTKHDF too at the end of the run, in one file of all instants for the bodies and for each contact. It needs
    /// a Carom that is built with `--features hdf5`.
    #[serde(default)]
    pub vtkhdf: bool,
}

/// A field.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema,
)]
#[serde(rename_all = "kebab-case")]
pub enum Field {
    /// Displacement of the nodes, m.
    Displacement,
    /// Velocity of the nodes, m/s.
    Velocity,
    /// Acceleration of the nodes, m/s².
    Acceleration,
    /// Stress of the cells, Pa, and its von Mises equivalent; of beams and shells the mean over the section with the largest equivalent in it, of shells also the stress at both
    /// faces, of beams `section_stress`: largest and smallest normal stress and largest shear stress of the section.
    Stress,
    /// Strain of the cells of solids and bars, with `principal_strain`: at small strain that of the displacement, at finite strain the logarithmic one. Zero of
    /// beams and shells, and across a plate under plane stress.
    Strain,
    /// Principal values of the stress of the cells, the largest first, Pa; of beams and shells where bending makes it largest.
    PrincipalStress,
    /// Stress at the nodes, Pa: the mean of the cells around a node, weighted by their volumes, with `nodal_von_mises`.
    NodalStress,
    /// Rotation of the nodes of beams, rad; zero elsewhere.
    Rotation,
    /// Forces (N) and moments (N m) in the sections of beams, in the axes of the section; zero elsewhere. `section_force`: normal
    /// force, shear forces along y and z; `section_moment_first`, `section_moment_second`: torque, bending moments about y and z,
    /// at the first and at the second node. Of shells `membrane_force` (N/m), `bending_moment` (N) and `shear_force` (N/m), over the axes of coordinates.
    SectionForces,
}

/// An exact solution, drawn under the result; its distance from the result is in the verdict. Bodies, sizes and speeds are those of the
/// case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Reference {
    /// Longitudinal impact of two bars.
    TwoBars(BarReference),
    /// A bar against a rigid wall.
    BarOnWall(BarReference),
}

/// A solution for bars.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct BarReference {
    /// Lateral motion of the bars.
    #[serde(default)]
    pub sides: Sides,
}

/// Whether the sides of a bar may move.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Sides {
    /// Free sides: the wave speed is sqrt(E / rho).
    #[default]
    Free,
    /// Blocked sides: the wave speed is that of confined compression.
    Blocked,
}
