//! Stresses in a section at the places where they are largest: `σ = N/A + z M_y/I_y - y M_z/I_z`, with the shear stresses of the shear
//! forces and of the torque.
//!
//! Shear stresses are those of the elementary theory, V Q/(I b) of a shear force, and those of Saint-Venant of a torque: in a rectangle
//! `T b/J [1 - 8/π² Σ cosh(nπs/b)/(n² cosh(nπa/2b))]` along the longer side a, `T b/J (8/π²) Σ (-1)^((n-1)/2) tanh(nπa/2b) cos(nπs/b)/n²` along the
//! shorter one b, n odd; in a round section T r/J; in each wall of an I of thickness t T t/J. Timoshenko and Goodier, Theory of Elasticity,
//! §109.
//!
//! A section of metal that has flowed has the stresses of its fibres: each place has that of the nearest one.

use std::f64::consts::PI;

use super::forces::SectionForces;
use super::section::{BeamSection, Extremes, SectionProperties, SectionShape};

/// Places along each side of a rectangle, and around a round section: between them the largest equivalent stress is missed by less than
/// 1 %, and not at all under bending in one plane.
const PLACES: u32 = 24;

/// The largest stresses in the sections of an element, at its ends.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SectionStress {
    /// The largest and the smallest normal stress along the axis, Pa.
    pub normal: [f64; 2],
    /// The largest magnitude of the shear stress across the axis, Pa.
    pub shear: f64,
    /// The largest and the smallest principal stress, Pa.
    pub principal: [f64; 2],
    /// The largest equivalent stress of von Mises, Pa.
    pub von_mises: f64,
}

impl SectionStress {
    fn add(&mut self, normal: f64, [along_y, along_z]: [f64; 2]) {
        let shear = along_y.hypot(along_z);
        let radius = (0.5 * normal).hypot(shear);
        let wider = |[largest, smallest]: [f64; 2], [one, other]: [f64; 2]| {
            [largest.max(one), smallest.min(other)]
        };
        self.normal = wider(self.normal, [normal; 2]);
        self.principal = wider(
            self.principal,
            [0.5 * normal + radius, 0.5 * normal - radius],
        );
        self.shear = self.shear.max(shear);
        self.von_mises = self.von_mises.max(normal.hypot(3.0_f64.sqrt() * shear));
    }

    /// Where neither the shape nor the extreme fibres of the section are known: no numbers.
    pub(super) fn unknown() -> SectionStress {
        SectionStress {
            normal: [f64::NAN; 2],
            shear: f64::NAN,
            principal: [f64::NAN; 2],
            von_mises: f64::NAN,
        }
    }

    /// Of no place yet.
    fn none() -> SectionStress {
        SectionStress {
            normal: [f64::NEG_INFINITY, f64::INFINITY],
            principal: [f64::NEG_INFINITY, f64::INFINITY],
            ..SectionStress::default()
        }
    }
}

/// A place of a section, and the shear stresses along y and z there of a unit of V_y, V_z and T.
#[derive(Clone, Copy, Debug)]
struct Place {
    at: [f64; 2],
    shear: [[f64; 2]; 3],
}

/// The places of a section at which its stresses may be the largest.
#[derive(Clone, Debug)]
pub(crate) struct Places {
    properties: SectionProperties,
    /// Whether all directions of the section are alike: the first place is then in the direction in which it bends.
    is_round: bool,
    all: Vec<Place>,
    most: Most,
}

/// The largest magnitudes over the places.
#[derive(Clone, Copy, Debug, Default)]
struct Most {
    /// Of normal stresses of a unit of M_y and M_z.
    normal: [f64; 2],
    /// Of shear stresses of a unit of V_y, V_z and T.
    shear: [f64; 3],
}

impl Places {
    /// `None` where the section is given by its properties, without its extreme fibres.
    pub(super) fn new(section: &BeamSection) -> Option<Places> {
        let properties = section.properties;
        let all = match (section.shape, section.extremes) {
            (Some(shape), _) => of_shape(&shape, &properties),
            (None, Some(extremes)) => of_extremes(&extremes, &properties),
            (None, None) => return None,
        };
        Some(Places {
            most: Most::of(&all, &properties),
            properties,
            is_round: matches!(
                section.shape,
                Some(SectionShape::Circle { .. } | SectionShape::Tube { .. })
            ),
            all,
        })
    }

    /// The largest stresses under the forces of both ends.
    pub(crate) fn stress(&self, forces: &SectionForces) -> SectionStress {
        let mut found = SectionStress::none();
        for moment in [&forces.moment_first, &forces.moment_second] {
            let (force, moment) = self.turned(&forces.force, moment);
            for place in &self.all {
                let shear = place.shear(&force, &moment);
                found.add(self.normal(place, &force, &moment), shear);
            }
        }
        found
    }

    /// A bound of the largest equivalent stress under the forces of both ends, Pa, in a fraction of the time: the sum of what each force makes at
    /// most.
    pub(crate) fn bound(&self, forces: &SectionForces) -> f64 {
        let Most { normal, shear } = &self.most;
        let ends = [&forces.moment_first, &forces.moment_second];
        let moment = |axis: usize| ends[0][axis].abs().max(ends[1][axis].abs());
        let [along, along_y, along_z] = forces.force.map(f64::abs);
        let normal = along / self.properties.area + normal[0] * moment(1) + normal[1] * moment(2);
        let shear = shear[0] * along_y + shear[1] * along_z + shear[2] * moment(0);
        normal.hypot(3.0_f64.sqrt() * shear)
    }

    /// The largest stresses where fibres have flowed, at this many sections: `fibre` is the normal stress at a place of one of them.
    pub(super) fn flowed(
        &self,
        forces: &SectionForces,
        (sections, fibre): (usize, &dyn Fn(usize, [f64; 2]) -> f64),
    ) -> SectionStress {
        let mut found = SectionStress::none();
        for place in &self.all {
            let shear = place.shear(&forces.force, &forces.moment_first);
            for section in 0..sections {
                found.add(fibre(section, place.at), shear);
            }
        }
        found
    }

    fn normal(&self, place: &Place, force: &[f64; 3], moment: &[f64; 3]) -> f64 {
        let ([y, z], [about_y, about_z]) = (place.at, self.properties.second_moments);
        force[0] / self.properties.area + z * moment[1] / about_y - y * moment[2] / about_z
    }

    /// Force and moment about axes that have the moment along -z, of a round section.
    fn turned(&self, force: &[f64; 3], moment: &[f64; 3]) -> ([f64; 3], [f64; 3]) {
        let size = moment[1].hypot(moment[2]);
        if !self.is_round || size == 0.0 {
            return (*force, *moment);
        }
        let (cosine, sine) = (-moment[2] / size, moment[1] / size);
        let turn = |v: &[f64; 3]| {
            [
                v[0],
                cosine * v[1] + sine * v[2],
                cosine * v[2] - sine * v[1],
            ]
        };
        (turn(force), turn(moment))
    }
}

impl Most {
    fn of(all: &[Place], properties: &SectionProperties) -> Most {
        let [about_y, about_z] = properties.second_moments;
        let mut most = Most::default();
        for Place { at: [y, z], shear } in all {
            let normal = [z.abs() / about_y, y.abs() / about_z];
            most.normal = [0, 1].map(|i| most.normal[i].max(normal[i]));
            most.shear = [0, 1, 2].map(|i| most.shear[i].max(shear[i][0].hypot(shear[i][1])));
        }
        most
    }
}

impl Place {
    fn shear(&self, force: &[f64; 3], moment: &[f64; 3]) -> [f64; 2] {
        let of = |i: usize| {
            let [along_y, along_z, torque] = &self.shear;
            force[1] * along_y[i] + force[2] * along_z[i] + moment[0] * torque[i]
        };
        [of(0), of(1)]
    }
}

fn of_shape(shape: &SectionShape, properties: &SectionProperties) -> Vec<Place> {
    match *shape {
        SectionShape::Circle { diameter } => round([diameter, 0.0], properties),
        SectionShape::Tube {
            diameter,
            thickness,
        } => round([diameter, diameter - 2.0 * thickness], properties),
        SectionShape::Rectangle { height, width } => rectangle([height, width], properties),
        SectionShape::I {
            height,
            width,
            web,
            flange,
        } => i_section([height, width], [web, flange], properties),
    }
}

/// Around the outer surface of a circle with a hole in its middle. On it a shear force has the stress
/// `4/3 V/A (R² + R r + r²)/(R² + r²) cos α`, α from its direction across, along the surface.
fn round([outer, inner]: [f64; 2], properties: &SectionProperties) -> Vec<Place> {
    let (big, small) = (0.5 * outer, 0.5 * inner);
    let part = (big * big + big * small + small * small) / (big * big + small * small);
    let across = 4.0 / 3.0 * part / properties.area;
    let torque = big / properties.torsion;
    let of = |k: u32| {
        let (sine, cosine) = (2.0 * PI * f64::from(k) / f64::from(PLACES)).sin_cos();
        let along = [-sine, cosine];
        let flow = |size: f64| along.map(|part| size * part);
        Place {
            at: [big * cosine, big * sine],
            shear: [flow(-across * sine), flow(across * cosine), flow(torque)],
        }
    };
    (0..PLACES).map(of).collect()
}

/// Around a rectangle, and its middle.
fn rectangle([height, width]: [f64; 2], properties: &SectionProperties) -> Vec<Place> {
    let most = 1.5 / properties.area;
    let (sides, mut all) = ([height, width], Vec::new());
    for along in 0..2 {
        let (length, across) = (sides[along], sides[1 - along]);
        for k in 0..=PLACES {
            let part = f64::from(k) / f64::from(PLACES) - 0.5;
            let torque = torsion_along([length, across], part * length) / properties.torsion;
            for side in [-1.0, 1.0] {
                let mut place = Place {
                    at: [0.0; 2],
                    shear: [[0.0; 2]; 3],
                };
                place.at[along] = part * length;
                place.at[1 - along] = 0.5 * side * across;
                // of the force along this side alone: the other one has none at its surface
                place.shear[along][along] = most * (1.0 - 4.0 * part * part);
                // counter-clockwise from y to z: at z > 0 against y
                let turn = if along == 0 { -side } else { side };
                place.shear[2][along] = turn * torque;
                all.push(place);
            }
        }
    }
    all.push(Place {
        at: [0.0; 2],
        shear: [[most, 0.0], [0.0, most], [0.0; 2]],
    });
    all
}

/// Shear stress over `T/J` (m) at the distance `s` from the middle of a side of this length.
fn torsion_along([length, across]: [f64; 2], s: f64) -> f64 {
    let thin = length.min(across);
    let ratio = 0.5 * PI * length.max(across) / thin;
    let at = PI * s.abs() / thin;
    if 2.0 * s.abs() >= length {
        return 0.0;
    }
    let odd = (0..200).rev().map(|k| 2.0 * f64::from(k) + 1.0);
    let sum = 8.0 / (PI * PI);
    match length >= across {
        true => {
            // cosh(n at)/cosh(n ratio) without large numbers
            let of = |n: f64| {
                let decay = (n * (at - ratio)).exp();
                decay * (1.0 + (-2.0 * n * at).exp()) / (1.0 + (-2.0 * n * ratio).exp()) / (n * n)
            };
            thin * (1.0 - sum * odd.map(of).sum::<f64>())
        }
        false => {
            let of = |n: f64| {
                let sign = if n % 4.0 == 1.0 { 1.0 } else { -1.0 };
                sign * (n * ratio).tanh() * (n * at).cos() / (n * n)
            };
            thin * sum * odd.map(of).sum::<f64>()
        }
    }
}

/// Corners, middles and roots of the flanges, ends and middle of the web.
fn i_section(
    [height, width]: [f64; 2],
    [web, flange]: [f64; 2],
    properties: &SectionProperties,
) -> Vec<Place> {
    let [about_y, about_z] = properties.second_moments;
    let lever = 0.5 * (height - flange);
    let clear = 0.5 * height - flange;
    let torque = |wall: f64| wall / properties.torsion;
    let mut all = Vec::new();
    for up in [-1.0, 1.0] {
        for side in [-1.0, 1.0] {
            all.push(Place {
                at: [0.5 * up * height, 0.5 * side * width],
                shear: [[0.0; 2]; 3],
            });
            // V Q/(I b) in the flange beside the web, where its part outside has its whole first moment
            let outside = 0.5 * (width - web);
            let along_y = outside * lever / about_z;
            let along_z = 0.125 * (width * width - web * web) / about_y;
            all.push(Place {
                at: [0.5 * up * height, 0.5 * side * web],
                shear: [
                    [0.0, up * side * along_y],
                    [0.0, along_z],
                    [0.0, up * torque(flange)],
                ],
            });
        }
        all.push(Place {
            at: [0.5 * up * height, 0.0],
            shear: [
                [0.0; 2],
                [0.0, 0.125 * width * width / about_y],
                [0.0, up * torque(flange)],
            ],
        });
        for side in [-1.0, 1.0] {
            all.push(Place {
                at: [up * clear, 0.5 * side * web],
                shear: [
                    [width * flange * lever / (about_z * web), 0.0],
                    [0.0; 2],
                    [-side * torque(web), 0.0],
                ],
            });
        }
    }
    let first = width * flange * lever + 0.5 * web * clear * clear;
    for side in [-1.0, 1.0] {
        all.push(Place {
            at: [0.0, 0.5 * side * web],
            shear: [
                [first / (about_z * web), 0.0],
                [0.0; 2],
                [-side * torque(web), 0.0],
            ],
        });
    }
    all
}

/// The corners of the smallest rectangle about the section, and its middle: shear forces over their areas.
fn of_extremes(extremes: &Extremes, properties: &SectionProperties) -> Vec<Place> {
    let ([c, b], [along_y, along_z]) = (extremes.fibres, properties.shear_areas);
    let torque = extremes.torsion / properties.torsion;
    let mut all = Vec::new();
    for [y, z] in [[c, b], [c, -b], [-c, b], [-c, -b]] {
        all.push(Place {
            at: [y, z],
            shear: [[0.0; 2], [0.0; 2], [torque, 0.0]],
        });
    }
    for sign in [-1.0, 1.0] {
        all.push(Place {
            at: [0.0; 2],
            shear: [
                [1.0 / along_y, 0.0],
                [0.0, 1.0 / along_z],
                [sign * torque, 0.0],
            ],
        });
    }
    all
}
