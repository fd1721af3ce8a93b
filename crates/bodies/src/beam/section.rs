//! Sections of beams: their properties, and the shapes from which these follow.

use std::f64::consts::PI;

/// Where a section with given properties has its largest stresses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extremes {
    /// Largest distances of its fibres from the centroid along y and z, m.
    pub fibres: [f64; 2],
    /// The largest shear stress of a torque T is `T r/J` with this r, m.
    pub torsion: f64,
}

/// Layers of fibres where nothing else is said.
pub const LAYERS: u32 = 8;

/// What bends: how a section stands to its axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BeamTheory {
    /// Sections stay normal to the axis; the inertia of their rotation by bending is neglected.
    EulerBernoulli,
    /// Sections shear, and have rotary inertia. Timoshenko (1921).
    Timoshenko,
}

/// Integrals over a section, about the principal axes y and z through its centroid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SectionProperties {
    /// A in m².
    pub area: f64,
    /// I_y = ∫ z² dA and I_z = ∫ y² dA in m⁴.
    pub second_moments: [f64; 2],
    /// Torsion constant of Saint-Venant, m⁴: torque over shear modulus and twist.
    pub torsion: f64,
    /// κ A in m² for shear forces along y and z.
    pub shear_areas: [f64; 2],
}

/// A shape of a section, its sizes in m; y is up, z is across.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SectionShape {
    /// A solid circle.
    Circle {
        /// Outer diameter.
        diameter: f64,
    },
    /// A hollow circle.
    Tube {
        /// Outer diameter.
        diameter: f64,
        /// Thickness of the wall, at most half the diameter.
        thickness: f64,
    },
    /// A solid rectangle.
    Rectangle {
        /// Size along y.
        height: f64,
        /// Size along z.
        width: f64,
    },
    /// An I with two equal flanges and the web along y.
    I {
        /// Size along y, flanges included.
        height: f64,
        /// Size of the flanges along z.
        width: f64,
        /// Thickness of the web.
        web: f64,
        /// Thickness of each flange.
        flange: f64,
    },
}

impl SectionShape {
    /// Distance of the surface from the axis, m: of a round section, and in the plane along y.
    pub fn radius(&self, dim: usize) -> Option<f64> {
        match *self {
            SectionShape::Circle { diameter } | SectionShape::Tube { diameter, .. } => {
                Some(0.5 * diameter)
            }
            SectionShape::Rectangle { height, .. } | SectionShape::I { height, .. } => {
                (dim == 2).then_some(0.5 * height)
            }
        }
    }

    /// The properties of the shape for a material with this Poisson ratio.
    ///
    /// Shear coefficients of circle, tube and rectangle: Cowper (1966), J. Appl. Mech. 33. Torsion of the rectangle: the series
    /// of Saint-Venant. An I takes shear along y in its web, and along z in its flanges with 5/6 of their area; its torsion
    /// constant is that of its thin walls, Σ b t³/3.
    pub fn properties(&self, poisson: f64) -> SectionProperties {
        match *self {
            SectionShape::Circle { diameter } => round(diameter, 0.0, poisson),
            SectionShape::Tube {
                diameter,
                thickness,
            } => round(diameter, diameter - 2.0 * thickness, poisson),
            SectionShape::Rectangle { height, width } => {
                let area = height * width;
                let shear = 10.0 * (1.0 + poisson) / (12.0 + 11.0 * poisson) * area;
                SectionProperties {
                    area,
                    second_moments: [height * width.powi(3) / 12.0, width * height.powi(3) / 12.0],
                    torsion: torsion_of_rectangle(height, width),
                    shear_areas: [shear; 2],
                }
            }
            SectionShape::I {
                height,
                width,
                web,
                flange,
            } => {
                let clear = height - 2.0 * flange;
                let flanges = 2.0 * width * flange;
                let across = 2.0 * flange * width.powi(3) + clear * web.powi(3);
                let up = width * height.powi(3) - (width - web) * clear.powi(3);
                let walls = 2.0 * width * flange.powi(3) + (height - flange) * web.powi(3);
                SectionProperties {
                    area: flanges + clear * web,
                    second_moments: [across / 12.0, up / 12.0],
                    torsion: walls / 3.0,
                    shear_areas: [height * web, flanges * 5.0 / 6.0],
                }
            }
        }
    }
}

/// A circle with a hole in its middle.
fn round(outer: f64, inner: f64, poisson: f64) -> SectionProperties {
    let area = 0.25 * PI * (outer * outer - inner * inner);
    let second = PI / 64.0 * (outer.powi(4) - inner.powi(4));
    let square = (inner / outer).powi(2);
    let sum = (1.0 + square).powi(2);
    let coefficient = 6.0 * (1.0 + poisson) * sum
        / ((7.0 + 6.0 * poisson) * sum + (20.0 + 12.0 * poisson) * square);
    SectionProperties {
        area,
        second_moments: [second; 2],
        torsion: 2.0 * second,
        shear_areas: [coefficient * area; 2],
    }
}

/// `a b³ (1/3 - 64/π⁵ (b/a) Σ tanh(n π a/(2b))/n⁵)` over odd n, a the longer side.
fn torsion_of_rectangle(height: f64, width: f64) -> f64 {
    let (a, b) = (height.max(width), height.min(width));
    let term = |n: f64| (0.5 * n * PI * a / b).tanh() / n.powi(5);
    // the terms left out are below 1e-13 of the sum
    let sum: f64 = (0..500).rev().map(|k| term(2.0 * f64::from(k) + 1.0)).sum();
    a * b.powi(3) * (1.0 / 3.0 - 64.0 / PI.powi(5) * b / a * sum)
}

/// The section of a beam, and how it stands to the line of its nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeamSection {
    /// Its theory.
    pub theory: BeamTheory,
    /// Its properties.
    pub properties: SectionProperties,
    /// Its shape, where it is known: what flows is divided into fibres.
    pub shape: Option<SectionShape>,
    /// Where it has its largest stresses, of a section without a shape.
    pub extremes: Option<Extremes>,
    /// Layers of fibres over the height and over the width, an even number.
    pub layers: u32,
    /// A vector whose part normal to the axis is the local y, in space; none where it does not matter. In the plane y is z × x.
    pub orientation: Option<[f64; 3]>,
    /// From the node to the centroid along y and z, m.
    pub offset: [f64; 2],
    /// Distance of the surface from the axis in contacts, m, the same all around; none where no contact knows it.
    pub radius: Option<f64>,
    /// Stiffness of an elastic foundation along x, y and z, N/m²: force per length over displacement.
    pub foundation: [f64; 3],
    /// Mass of a fluid that moves with the section across its axis, kg/m.
    pub added_mass: f64,
    /// Mass of that fluid that the section displaces, kg/m: the buoyancy under an acceleration of the fluid as a whole.
    pub displaced_mass: f64,
    /// How far its nodes turn.
    pub rotations: Rotations,
}

/// How far nodes of beams turn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Rotations {
    /// Little: rotations add up like displacements.
    #[default]
    Small,
    /// By any angle.
    Finite,
}

impl BeamSection {
    /// A section in its nodes, without a shape, a surface, a foundation or a fluid around it.
    pub fn new(theory: BeamTheory, properties: SectionProperties) -> BeamSection {
        BeamSection {
            theory,
            properties,
            shape: None,
            extremes: None,
            layers: LAYERS,
            orientation: None,
            offset: [0.0; 2],
            radius: None,
            foundation: [0.0; 3],
            added_mass: 0.0,
            displaced_mass: 0.0,
            rotations: Rotations::Small,
        }
    }

    /// Width of the surface around the axis that a contact law per area counts, m: the diameter, or that of a square of the same
    /// area where there is no radius.
    pub fn width(&self) -> f64 {
        let diameter = self.radius.map(|radius| 2.0 * radius);
        let diameter = diameter.filter(|diameter| *diameter > 0.0);
        diameter.unwrap_or(self.properties.area.sqrt())
    }

    /// Whether all directions normal to the axis are alike.
    pub fn is_round(&self) -> bool {
        let same = |[y, z]: [f64; 2]| (y - z).abs() <= 1e-12 * y.abs();
        let SectionProperties {
            second_moments,
            shear_areas,
            ..
        } = self.properties;
        let [_, y, z] = self.foundation;
        let alike = same(second_moments) && same(shear_areas) && (y - z).abs() <= 1e-12 * y.abs();
        alike && self.offset == [0.0; 2]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_that_are_nearly_each_other_have_nearly_the_same_properties() {
        let near = |a: f64, b: f64, part: f64| assert!((a / b - 1.0).abs() < part, "{a} {b}");
        let circle = SectionShape::Circle { diameter: 2.0 }.properties(0.3);
        let tube = SectionShape::Tube {
            diameter: 2.0,
            thickness: 1.0 - 1e-6,
        };
        let full = tube.properties(0.3);
        near(full.shear_areas[0], circle.shear_areas[0], 1e-9);
        near(full.torsion, circle.torsion, 1e-12);
        // a thin tube: A = 2πrt, I = πr³t, κ = 1/2 at ν = 0 (2(1 + ν)/(4 + 3ν))
        let thin = SectionShape::Tube {
            diameter: 2.0,
            thickness: 1e-4,
        };
        let thin = thin.properties(0.0);
        near(thin.area, 2.0 * PI * 1e-4, 1e-3);
        near(thin.second_moments[1], PI * 1e-4, 1e-3);
        near(thin.shear_areas[0], 0.5 * thin.area, 1e-3);
        // an I whose web is as wide as its flanges
        let solid = SectionShape::I {
            height: 3.0,
            width: 2.0,
            web: 2.0,
            flange: 0.4,
        };
        let (solid, rectangle) = (
            solid.properties(0.0),
            SectionShape::Rectangle {
                height: 3.0,
                width: 2.0,
            }
            .properties(0.0),
        );
        near(solid.area, rectangle.area, 1e-14);
        near(solid.second_moments[0], rectangle.second_moments[0], 1e-14);
        near(solid.second_moments[1], rectangle.second_moments[1], 1e-14);
    }

    #[test]
    fn the_torsion_of_a_square_and_of_a_strip_are_those_of_the_handbook() {
        // Timoshenko and Goodier: 0.1406 a⁴; a strip a b³/3 (1 - 0.63 b/a)
        assert!((torsion_of_rectangle(1.0, 1.0) - 0.14058).abs() < 1e-5);
        let strip = torsion_of_rectangle(0.01, 1.0);
        assert!((strip / (1e-6 / 3.0) - (1.0 - 0.6302e-2)).abs() < 1e-5);
    }
}
