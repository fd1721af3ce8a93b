//! Rigid obstacles: a shape each, and a given motion that all share.
//!
//! A shape knows itself at rest: gap, normal and curvature at a place, [`Distance`]. A place is brought back by the
//! motion to where the shape is at rest, and what is found there is turned forward. Friction and rates take the
//! velocity of the obstacle's particle.

mod cylinder;
mod distance;
mod motion;
mod plane;
mod profile;
mod sphere;
mod surface;

pub use cylinder::Cylinder;
pub use distance::{Distance, Side};
pub use motion::{Motion, Translation, Turn};
pub use plane::Plane;
pub use profile::Profile;
pub use sphere::Sphere;
pub use surface::RigidSurface;

use motion::Pose;

use crate::search::{Own, Stand};
use crate::{Places, Point};

/// Shape of an obstacle at time 0.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A plane.
    Plane(Plane),
    /// A sphere; a circle in the plane.
    Sphere(Sphere),
    /// A cylinder.
    Cylinder(Cylinder),
    /// A closed curve across an axis.
    Profile(Box<Profile>),
    /// Faces of a mesh.
    Surface(Box<RigidSurface>),
}

/// A rigid obstacle: unilateral, and as heavy as its motion asks for.
#[derive(Clone, Debug, PartialEq)]
pub struct Obstacle {
    /// Shape and place at time 0.
    pub shape: Shape,
    /// Its motion from there.
    pub motion: Motion,
}

/// An obstacle at one time.
#[derive(Clone, Copy, Debug)]
pub struct Placed<'a> {
    shape: &'a Shape,
    pose: Option<Pose>,
}

impl Obstacle {
    /// The obstacle at a time in s.
    pub fn at(&self, t: f64) -> Placed<'_> {
        Placed {
            shape: &self.shape,
            pose: self.motion.at(t),
        }
    }

    /// Displacement of its translation at a time in s, m.
    pub fn displacement(&self, t: f64) -> [f64; 3] {
        let translation = self.motion.translation.as_ref();
        translation.map_or([0.0; 3], |translation| translation.at(t).0)
    }

    /// Place (m) at a time in s of the particle that is at `x` (m) at time 0.
    pub fn moved(&self, x: &[f64; 3], t: f64) -> [f64; 3] {
        self.motion.at(t).map_or(*x, |pose| pose.forth(x))
    }

    /// Mean velocity in m/s, from one time to another, of the particle that is at x (m) at time `t`; its velocity then
    /// where both are the same. Times in s.
    pub fn mean_velocity(&self, x: &[f64; 3], t: f64, [from, to]: [f64; 2]) -> [f64; 3] {
        let poses = [t, from, to].map(|t| self.motion.at(t));
        let [Some(now), Some(first), Some(last)] = poses else {
            return [0.0; 3];
        };
        let particle = now.back(x);
        let (first, end) = (first.forth(&particle), last.forth(&particle));
        match to == from {
            true => last.velocity(&end),
            false => [0, 1, 2].map(|i| (end[i] - first[i]) / (to - from)),
        }
    }
}

impl From<Shape> for Obstacle {
    fn from(shape: Shape) -> Obstacle {
        Obstacle {
            shape,
            motion: Motion::default(),
        }
    }
}

impl From<Plane> for Obstacle {
    fn from(plane: Plane) -> Obstacle {
        Shape::Plane(plane).into()
    }
}

impl From<Sphere> for Obstacle {
    fn from(sphere: Sphere) -> Obstacle {
        Shape::Sphere(sphere).into()
    }
}

impl From<Cylinder> for Obstacle {
    fn from(cylinder: Cylinder) -> Obstacle {
        Shape::Cylinder(cylinder).into()
    }
}

impl From<Profile> for Obstacle {
    fn from(profile: Profile) -> Obstacle {
        Shape::Profile(Box::new(profile)).into()
    }
}

impl From<RigidSurface> for Obstacle {
    fn from(surface: RigidSurface) -> Obstacle {
        Shape::Surface(Box::new(surface)).into()
    }
}

impl Placed<'_> {
    /// Gap, normal and curvature at a place x in m, all at this time: the derivatives are those by x.
    pub fn distance(&self, x: &[f64; 3]) -> Distance {
        self.distance_from(x, None)
    }

    /// The same of a point, which may be beyond the rim of a surface over which its own reaches back.
    pub(crate) fn distance_of(&self, point: &Point, places: &Places) -> Distance {
        let behind = || point.behind(places).map(|x| self.back(&x));
        self.distance_from(&point.place(places), Some(&behind))
    }

    fn distance_from(&self, x: &[f64; 3], of: Own) -> Distance {
        let of_shape = |x: &[f64; 3]| match self.shape {
            Shape::Surface(surface) => surface.distance_of(&Stand { x, of }),
            shape => shape.distance(x),
        };
        let Some(pose) = &self.pose else {
            return of_shape(x);
        };
        let Distance {
            gap,
            normal,
            hessian,
        } = of_shape(&pose.back(x));
        Distance {
            gap,
            normal: pose.turned(&normal),
            hessian: pose.turned_tensor(&hessian),
        }
    }

    /// Place at time 0 of the particle that is at a place x in m.
    pub(crate) fn back(&self, x: &[f64; 3]) -> [f64; 3] {
        self.pose.as_ref().map_or(*x, |pose| pose.back(x))
    }

    /// Velocity in m/s of the obstacle's particle at a place x in m; the obstacle is taken as filling all space, so x may
    /// lie off its surface.
    pub fn velocity(&self, x: &[f64; 3]) -> [f64; 3] {
        self.pose.as_ref().map_or([0.0; 3], |pose| pose.velocity(x))
    }

    /// Rate ∂g/∂t of the gap at a fixed place by the motion of the obstacle, -n · v, m/s. `normal`: that at `x`.
    ///
    /// Exact at the foot and, because a rigid motion keeps the distance of particles along n, at x too.
    pub fn gap_rate(&self, x: &[f64; 3], normal: &[f64; 3]) -> f64 {
        let v = self.velocity(x);
        -(0..3).map(|i| normal[i] * v[i]).sum::<f64>()
    }
}

impl Shape {
    pub(crate) fn distance(&self, x: &[f64; 3]) -> Distance {
        match self {
            Shape::Plane(plane) => plane.distance(x),
            Shape::Sphere(sphere) => sphere.distance(x),
            Shape::Cylinder(cylinder) => cylinder.distance(x),
            Shape::Profile(profile) => profile.distance(x),
            Shape::Surface(surface) => surface.distance(x),
        }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// The normal is the gradient of the gap, the Hessian that of the normal.
    pub(crate) fn assert_derivatives(distance: impl Fn(&[f64; 3]) -> Distance, x: &[f64; 3]) {
        let here = distance(x);
        for j in 0..3 {
            let at = |step: f64| {
                let mut x = *x;
                x[j] += step;
                distance(&x)
            };
            // central differences err by the square of the step over that of the distance from the centre of curvature
            let (before, after) = (at(-1e-4), at(1e-4));
            assert!(((after.gap - before.gap) / 2e-4 - here.normal[j]).abs() < 1e-7);
            for i in 0..3 {
                let difference = (after.normal[i] - before.normal[i]) / 2e-4;
                assert!(
                    (difference - here.hessian[i][j]).abs() < 1e-6,
                    "{i} {j} {difference} {:?}",
                    here.hessian
                );
            }
        }
    }

    fn moving(shape: Shape) -> Obstacle {
        Obstacle {
            shape,
            motion: Motion {
                translation: Some(Translation::Velocity([0.4, -0.7, 1.1])),
                turn: Some(Turn {
                    point: [0.2, 0.1, -0.3],
                    axis: [0.6, 0.0, 0.8],
                    rate: 2.0,
                }),
            },
        }
    }

    #[test]
    fn derivatives_of_moved_obstacles_and_rates_of_their_gaps_are_right() {
        let x = [1.1, 0.4, 0.2];
        let plane = Plane {
            point: [0.0, 0.1, 0.0],
            normal: [0.36, 0.48, 0.8],
        };
        let cylinder = Cylinder {
            point: [0.0, 0.3, 0.1],
            axis: [0.0, 0.6, 0.8],
            radius: 0.2,
            side: Side::Outside,
        };
        let mut fastest = 0.0_f64;
        for shape in [Shape::Plane(plane), Shape::Cylinder(cylinder)] {
            let obstacle = moving(shape);
            assert_derivatives(|x| obstacle.at(0.3).distance(x), &x);
            let gap = |t: f64| obstacle.at(t).distance(&x).gap;
            let placed = obstacle.at(0.3);
            let rate = placed.gap_rate(&x, &placed.distance(&x).normal);
            // central difference: third derivative of order ω³ times h²/6
            assert!(((gap(0.3 + 1e-4) - gap(0.3 - 1e-4)) / 2e-4 - rate).abs() < 1e-6);
            fastest = fastest.max(rate.abs());
        }
        assert!(fastest > 0.1);
    }

    #[test]
    fn the_mean_velocity_of_a_particle_is_its_way_over_the_time() {
        let plane = Plane {
            point: [0.0; 3],
            normal: [0.0, 0.0, 1.0],
        };
        let obstacle = moving(Shape::Plane(plane));
        let x = [1.1, 0.4, 0.2];
        let now = obstacle.mean_velocity(&x, 0.3, [0.3, 0.3]);
        let straight = obstacle.at(0.3).velocity(&x);
        let (before, after) = (
            obstacle.mean_velocity(&x, 0.3, [0.0, 0.3]),
            obstacle.mean_velocity(&x, 0.3, [0.3, 0.5]),
        );
        let whole = obstacle.mean_velocity(&x, 0.3, [0.0, 0.5]);
        for i in 0..3 {
            assert!((now[i] - straight[i]).abs() < 1e-14);
            // ways add up
            assert!((0.3 * before[i] + 0.2 * after[i] - 0.5 * whole[i]).abs() < 1e-14);
        }
        // a quarter turn and more in half a second: far from the velocity
        assert!((0..3).any(|i| (before[i] - now[i]).abs() > 0.1));
    }

    #[test]
    fn a_plane_that_comes_closer_takes_its_way_from_the_gap() {
        let plane = Plane {
            point: [0.0; 3],
            normal: [0.0, 0.0, 1.0],
        };
        let obstacle = Obstacle {
            motion: Motion {
                translation: Some(Translation::Velocity([5.0, 0.0, 2.0])),
                turn: None,
            },
            ..plane.into()
        };
        let placed = obstacle.at(0.25);
        let found = placed.distance(&[1.0, 2.0, 3.0]);
        assert!((found.gap - 2.5).abs() < 1e-15);
        assert_eq!(placed.gap_rate(&[1.0, 2.0, 3.0], &found.normal), -2.0);
    }

    #[test]
    fn a_ball_that_spins_about_its_centre_does_not_change_gaps() {
        let centre = [1.0, -2.0, 0.5];
        let ball = Sphere {
            centre,
            radius: 0.5,
            side: Side::Outside,
        };
        let turn = Turn {
            point: centre,
            axis: [0.0, 0.6, 0.8],
            rate: 30.0,
        };
        let spinning = Obstacle {
            motion: Motion {
                translation: None,
                turn: Some(turn),
            },
            ..ball.into()
        };
        let x = [1.7, -1.6, 0.9];
        let (still, placed) = (ball.distance(&x), spinning.at(0.77));
        let found = placed.distance(&x);
        assert!((found.gap - still.gap).abs() < 1e-14);
        assert!(placed.gap_rate(&x, &found.normal).abs() < 1e-13);
        // and yet it drags: its surface moves at ω times the distance from the axis
        let v = placed.velocity(&x);
        assert!(v.iter().map(|v| v * v).sum::<f64>().sqrt() > 10.0);
    }
}
