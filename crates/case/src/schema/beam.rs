//! Sections of beams.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use carom_quantities::{Area, Clearance, Coordinate, Length, SecondMoment};

use super::joint::{AddedMass, Foundation};
use super::obstacle::NormalVector;

/// Section of beams: bars of two nodes, in the plane or in space, that resist extension, shear, bending and torsion. Their nodes
/// have rotations, small ones unless the section says otherwise. x is along the element from its first node to its second one; y and z are the principal
/// axes of the section. In the plane y is x turned by 90 degrees counter-clockwise.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct BeamSection {
    /// Shape of the section, or its properties.
    pub shape: BeamShape,
    /// Theory of bending.
    #[serde(default)]
    pub theory: BeamTheory,
    /// Layers of fibres over the height of the section, and in space over its width, of a metal that flows; an even number. Default: 8.
    #[schemars(extend("minimum" = 2, "maximum" = 100))]
    pub layers: Option<u32>,
    /// Direction of y, in space: a vector whose part normal to the axis is y. Required unless the section is round and without
    /// offset.
    pub orientation: Option<NormalVector>,
    /// Centroid from the node, along y and z. Default: in the node.
    pub offset: Option<[Coordinate; 2]>,
    /// Distance of the surface from the axis in contacts, the same all around; 0 where a beam strikes with the flat face of its end.
    /// Default: half the diameter of a round section; in the plane half the height of a rectangle or an I.
    pub radius: Option<Clearance>,
    /// How far the nodes turn.
    #[serde(default)]
    pub rotations: Rotations,
    /// Elastic foundation. Default: none.
    pub foundation: Option<Foundation>,
    /// Fluid that moves with the beam. Default: none.
    pub added_mass: Option<AddedMass>,
}

/// How far nodes of beams and shells turn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Rotations {
    /// Little: rotations add up like displacements.
    #[default]
    Small,
    /// By any angle: geometrically exact beams, shells with the strains of Green and Lagrange. Best with `energy-momentum`; beams need a scheme with
    /// iterations.
    Finite,
}

/// Theory of bending.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum BeamTheory {
    /// With shear deformation and rotary inertia.
    #[default]
    Timoshenko,
    /// Without both.
    EulerBernoulli,
}

/// Shape of the section of a beam, or its properties.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum BeamShape {
    /// A solid circle.
    Circle(CircleShape),
    /// A hollow circle.
    Tube(TubeShape),
    /// A solid rectangle.
    Rectangle(RectangleShape),
    /// An I with equal flanges.
    I(IShape),
    /// Properties of any section.
    Properties(SectionProperties),
}

/// A solid circle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct CircleShape {
    /// Diameter.
    pub diameter: Length,
}

/// A hollow circle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct TubeShape {
    /// Outer diameter.
    pub diameter: Length,
    /// Thickness of the wall, less than half the diameter.
    pub thickness: Length,
}

/// A solid rectangle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct RectangleShape {
    /// Size along y.
    pub height: Length,
    /// Size along z.
    pub width: Length,
}

/// An I with equal flanges and the web along y.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct IShape {
    /// Size along y, flanges included.
    pub height: Length,
    /// Size of the flanges along z.
    pub width: Length,
    /// Thickness of the web, at most `width`.
    pub web: Length,
    /// Thickness of each flange, less than half of `height`.
    pub flange: Length,
}

/// Properties of a section. In the plane only `area`, `inertia-z` and, with shear, `shear-area-y` are needed; in space all are.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct SectionProperties {
    /// Area.
    pub area: Area,
    /// Second moment about y: the integral of z².
    pub inertia_y: Option<SecondMoment>,
    /// Second moment about z: the integral of y².
    pub inertia_z: Option<SecondMoment>,
    /// Torsion constant: torque over shear modulus and twist.
    pub torsion: Option<SecondMoment>,
    /// Area that carries a shear force along y; for the theory of Timoshenko.
    pub shear_area_y: Option<Area>,
    /// Area that carries a shear force along z; for the theory of Timoshenko.
    pub shear_area_z: Option<Area>,
    /// Largest distance of the section from its centroid along y, for stresses. Default: not known, and so is the largest stress.
    pub extreme_y: Option<Length>,
    /// The same along z; needed in space for stresses of bending.
    pub extreme_z: Option<Length>,
    /// Distance r in the largest shear stress of a torque T, T r over the torsion constant: in thin open walls the largest thickness. Default: the larger of
    /// `extreme-y` and `extreme-z`.
    pub torsion_distance: Option<Length>,
}
