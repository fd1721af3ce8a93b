//! Stage one: exactly what a case file may say, with no look at meshes and no name resolved.
//!
//! These types are the one description of the format. Their doc comments, ranges and defaults become the JSON schema
//! ([`json_schema`]); every file is checked against that schema, with all its errors, before serde fills the types; and the reference
//! page of the manual is written from it ([`crate::reference_page`]). A choice is an enum with one key for each variant.

mod axis;
mod beam;
mod body;
mod contact;
mod discrete;
mod expect;
mod explicit;
mod joint;
mod load;
mod material;
mod mesh;
mod named;
mod obstacle;
mod output;
mod pretension;
mod signal;
mod time;
mod zone;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

pub use axis::Axis;
pub use beam::{
    BeamSection, BeamShape, BeamTheory, CircleShape, IShape, RectangleShape, Rotations,
    SectionProperties, TubeShape,
};
pub use body::{
    AxisymmetricSection, BarSection, Body, Damping as BodyDamping, Formulation, FormulationName,
    FormulationWith, Initial, Mass, ModalDamping, Movement, MovementCourse, MovementPoint,
    PlaneSection, Reduced, Rigid, Section, ShellPly, ShellSection, ShellTaper, Support,
    ThicknessColumns,
};
pub use carom_laws::{Friction, GivenLaw};
pub use carom_quantities::{
    Acceleration, AngularVelocity, Area, Clearance, Coordinate, Damping, Delay, Density, Duration,
    Force, Frequency, Length, Modulus, Rate, SignedForce, SignedMoment, SignedStress, Stiffness,
    Stress, SurfaceDamping, SurfaceStiffness, Vector, Velocity, Weight,
};
pub use carom_schemes::Scheme;
pub use contact::{
    Basis, Contact, GeneralBy, GeneralContact, Integration, IntegrationName, IntegrationWith,
    MaterialPair, Mortar, Nodes, Penetration, Sliding,
};
pub use discrete::{Dashpot, DashpotPoint, Ends, PointMass, Spring, SpringPoint, Stop};
pub use expect::{Amount, Expect, ExpectKind, Take};
pub use explicit::{BulkViscosity, Deletion, MassScaling};
pub use joint::{
    AddedMass, Channel, Constraint, ConstraintTerm, FluidGap, Foundation, Hinge, RigidLink,
    Transition, TransitionMotion,
};
pub use load::{
    AmplitudeCourse, AmplitudePoint, BaseAcceleration, DensityPoint, Load, RandomForce,
};
pub use material::Material;
pub use mesh::{BoxPart, Count, LengthUnit, Line, Mesh, Part, PartTurn, Placed, Rectangle};
pub use named::Named;
pub use obstacle::{
    Cylinder, NormalVector, Obstacle, ObstacleMotion, ObstaclePoint, Plane, PolarColumns,
    PolarCurve, PolarPoint, PolarProfile, Side, Sphere, Surface, Turn,
};
pub use output::{
    Allowable, Allowables, BarReference, BodyAllowable, Checkpoint, Field, Fields, Histories,
    Level, Mean, Motion, Output, PretensionAllowable, Probe, ProbeSpectrum, Reference, Sides,
    SpringAllowable, SupportAllowable,
};
pub use pretension::Pretension;
pub use signal::{
    AccelerationPoint, AccelerationSource, Baseline, Columns, DisplacementSource, FactorSource,
    Signal, SpectrumPoint, Synthetic,
};
pub use time::{
    Adaptive, Closing, LargestStep, MeshStep, Newton, Solver, StaticStage, Step, StepRule, Time,
};
pub use zone::{
    Arlequin, Bracket, BracketLength, BracketName, BracketWith, H1Bracket, InnerSteps, Interface,
    LengthName, Link, Mediator, OverlapBox, OverlapName, OverlapRegion, OverlapShape, Profile,
    ProfileName, ProfileWith, StepChoice, StepCount, Substeps, WeightTable, Weights, Zone,
};

/// A case: bodies, their contacts and joints, and the time to simulate.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(title = "Carom case file", extend(
    "anyOf" = [{ "required": ["body"] }, { "required": ["mass"] }],
    "dependentRequired" = { "body": ["mesh", "material"] },
))]
pub struct Case {
    /// Version of the format: 1.
    #[schemars(extend("const" = 1))]
    pub carom: u32,
    /// Title of the report.
    pub title: Option<String>,
    /// Indices with their first and last values. A table with `{n}` in its name stands for one table for each value of the index `n`;
    /// texts in it may have `{n}`, `{n+1}` or `{n*0.25}` as well. Where two make the same table, the keys of the one that has fewer
    /// indices count, and those of a table that is written out before all.
    #[serde(default, skip_serializing_if = "Named::is_empty")]
    pub repeat: Named<[i64; 2]>,
    /// Source of the mesh.
    #[serde(default, skip_serializing_if = "Mesh::is_empty")]
    pub mesh: Mesh,
    /// Materials, by name.
    #[serde(default, skip_serializing_if = "Named::is_empty")]
    pub material: Named<Material>,
    /// Bodies, by name.
    #[serde(default, skip_serializing_if = "Named::is_empty")]
    pub body: Named<Body>,
    /// Point masses, by name.
    #[serde(default, skip_serializing_if = "Named::is_empty")]
    pub mass: Named<PointMass>,
    /// Springs, by name.
    #[serde(default, skip_serializing_if = "Named::is_empty")]
    pub spring: Named<Spring>,
    /// Bolts that the static stage tightens, by name.
    #[serde(default, skip_serializing_if = "Named::is_empty")]
    pub pretension: Named<Pretension>,
    /// Dashpots, by name.
    #[serde(default, skip_serializing_if = "Named::is_empty")]
    pub dashpot: Named<Dashpot>,
    /// Stops, by name.
    #[serde(default, skip_serializing_if = "Named::is_empty")]
    pub stop: Named<Stop>,
    /// Rigid links, by name.
    #[serde(default, skip_serializing_if = "Named::is_empty")]
    pub rigid_link: Named<RigidLink>,
    /// Ends of beams on faces of solids, by name.
    #[serde(default, skip_serializing_if = "Named::is_empty")]
    pub transition: Named<Transition>,
    /// Linear constraints, by name.
    #[serde(default, skip_serializing_if = "Named::is_empty")]
    pub constraint: Named<Constraint>,
    /// Fluids in gaps between two bodies, by name.
    #[serde(default, skip_serializing_if = "Named::is_empty")]
    pub fluid: Named<FluidGap>,
    /// Functions of time, by name.
    #[serde(default, skip_serializing_if = "Named::is_empty")]
    pub signal: Named<Signal>,
    /// Supports, by name.
    #[serde(default, skip_serializing_if = "Named::is_empty")]
    pub support: Named<Support>,
    /// Loads, by name.
    #[serde(default, skip_serializing_if = "Named::is_empty")]
    pub load: Named<Load>,
    /// Contacts, by name.
    #[serde(default, skip_serializing_if = "Named::is_empty")]
    pub contact: Named<Contact>,
    /// Contact of all outer sides, by pairs of bodies; a pair of the bodies `a` and `b` has the name `all-a-b`, a body with itself `all-a`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub general_contact: Option<GeneralContact>,
    /// Zones, by name: parts with their own scheme and step.
    #[serde(default, skip_serializing_if = "Named::is_empty")]
    pub zone: Named<Zone>,
    /// Overlaps of two bodies that are glued in volume, by name.
    #[serde(default, skip_serializing_if = "Named::is_empty")]
    pub arlequin: Named<Arlequin>,
    /// Borders where bodies of two zones are tied, by name.
    #[serde(default, skip_serializing_if = "Named::is_empty")]
    pub interface: Named<Interface>,
    /// Time and scheme.
    pub time: Time,
    /// Groups whose mean motion is written at every step, by name.
    #[serde(default, skip_serializing_if = "Named::is_empty")]
    pub probe: Named<Probe>,
    /// Contacts and stops that are judged together, by name.
    #[serde(default, skip_serializing_if = "Named::is_empty")]
    pub level: Named<Level>,
    /// Output of a run.
    #[serde(default)]
    pub output: Output,
    /// An exact solution to compare with.
    pub reference: Option<Reference>,
    /// What a run of this file must give, by name.
    #[serde(default, skip_serializing_if = "Named::is_empty")]
    pub expect: Named<Expect>,
}

/// Whether `name` matches the pattern of names.
pub(crate) fn is_name(name: &str) -> bool {
    !name.is_empty()
        && name
            .chars()
            .all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-')
}

/// The JSON schema of the case file, for editors and for `validate`.
pub fn json_schema() -> Value {
    let mut schema = schemars::schema_for!(Case).to_value();
    drop_null(&mut schema);
    schema
}

/// TOML has no null: an option is a key that may be left out, nothing more.
fn drop_null(schema: &mut Value) {
    match schema {
        Value::Object(entries) => {
            if let Some(Value::Array(types)) = entries.get_mut("type") {
                types.retain(|name| name != "null");
                if let [only] = types.as_slice() {
                    let only = only.clone();
                    entries.insert("type".to_owned(), only);
                }
            }
            if !entries.contains_key("properties")
                && let Some(Value::Array(branches)) = entries.get_mut("anyOf")
            {
                branches.retain(|branch| branch.get("type") != Some(&Value::from("null")));
                if let [Value::Object(only)] = branches.as_slice() {
                    let only = only.clone();
                    entries.remove("anyOf");
                    entries.extend(only);
                }
            }
            if entries.get("default") == Some(&Value::Null) {
                entries.remove("default");
            }
            entries.values_mut().for_each(drop_null);
        }
        Value::Array(items) => items.iter_mut().for_each(drop_null),
        _ => {}
    }
}
