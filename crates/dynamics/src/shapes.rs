//! What is known of the shapes of elements since their frequencies were last looked at.

use carom_bodies::{Body, Looks, Solid};
use serde::{Deserialize, Serialize};

use crate::system::System;

/// The shapes of the last looks at the elements of an explicit run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Shapes {
    /// What is known of the frequencies of each body; empty before the first look.
    pub(crate) looks: Vec<Looks>,
    /// Of each body whose elements change; none of others.
    pub(crate) bodies: Vec<Option<Shape>>,
    /// What a compression of rate 1/s adds at most to 2 over the critical step, by bulk viscosity.
    pub(crate) by_compression: f64,
    /// Bound of the change of any length in an element since its frequency was found, relative.
    pub(crate) changed: f64,
}

impl Shapes {
    /// Whether no frequency was found anew from one to the other.
    pub fn have_frequencies_of(&self, other: &Shapes) -> bool {
        self.looks == other.looks
    }

    /// Whether they are of this system, or of none before the first look.
    pub(crate) fn are_of(&self, system: &System) -> bool {
        let fits = |count: usize| [0, system.bodies.len()].contains(&count);
        let of_body = |(looks, body): (&Looks, &Body)| {
            let numbers = body.as_solid().and_then(Solid::numbers_of_look);
            looks.are_of(body.cells().len(), numbers)
        };
        let mut looks = self.looks.iter().zip(&system.bodies);
        fits(self.looks.len()) && fits(self.bodies.len()) && looks.all(of_body)
    }
}

/// What bounds the change of the lengths in the elements of a body.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Shape {
    /// Mean velocity when lengths were last compared, m/s.
    pub(crate) velocity: [f64; 3],
    /// Shortest distance of two nodes of an element at the looks, m.
    pub(crate) shortest: f64,
}

/// How fast the nodes of each part move against a velocity w of its own.
#[derive(Clone, Debug)]
pub(crate) struct Rates {
    /// w, m/s.
    pub(crate) reference: Vec<[f64; 3]>,
    /// Largest |v - w|² of a node, m²/s²; negative where it is not known.
    squares: Vec<f64>,
}

impl Rates {
    /// Of so many parts.
    pub(crate) fn new(parts: usize) -> Rates {
        Rates {
            reference: vec![[0.0; 3]; parts],
            squares: vec![-1.0; parts],
        }
    }

    /// Takes for w the velocity of the first body of a part whose elements change; zero in others.
    pub(crate) fn refer(&mut self, parts: &[usize], bodies: &[Option<Shape>]) {
        self.reference.fill([0.0; 3]);
        // the first of a part last
        let changing = bodies.iter().zip(parts).rev();
        for (shape, &part) in changing.filter_map(|(shape, part)| Some((shape.as_ref()?, part))) {
            self.reference[part] = shape.velocity;
        }
    }

    /// Bound of the rate at which the distance of two nodes of an element changes, relative to the shortest, 1/s: twice the largest
    /// |v - w_b| <= |v - w| + |w - w_b| of a body over its shortest length, since one w serves all bodies of a part. `fastest`: the largest
    /// |v - w|² of a part, m²/s².
    pub(crate) fn largest(
        &mut self,
        parts: &[usize],
        bodies: &[Option<Shape>],
        fastest: impl Fn(usize, &[f64; 3]) -> f64,
    ) -> f64 {
        self.refer(parts, bodies);
        self.squares.fill(-1.0);
        let mut most = 0.0f64;
        let changing = bodies.iter().zip(parts);
        for (shape, &part) in changing.filter_map(|(shape, part)| Some((shape.as_ref()?, part))) {
            let (w, square) = (&self.reference[part], &mut self.squares[part]);
            if *square < 0.0 {
                *square = fastest(part, w);
            }
            let apart: f64 = (0..3).map(|i| (w[i] - shape.velocity[i]).powi(2)).sum();
            most = most.max(2.0 * (square.sqrt() + apart.sqrt()) / shape.shortest);
        }
        most
    }
}
