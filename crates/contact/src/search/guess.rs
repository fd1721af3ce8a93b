//! Faces that points are likely closest to, projected on side by side: a projection alone waits for itself most of the time.
//!
//! A guess is the face found last, or the face as many numbers further as the point before has gone, if that is nearer. It bounds the
//! distance of the closest face, whichever that is; and it is the closest where no other box is within that bound, for which one look at
//! the tree tells it of all.

use carom_elements::Kind;
use carom_mesh::{Face, QUADS, project_quads};

use super::faces::{FaceTree, Scratch, middle_distance};
use super::foot::corners;
use super::kept::{Guess, Kept};
use crate::Places;

/// The guesses of queries that follow each other.
#[derive(Debug, Default)]
pub(crate) struct Guesses {
    /// Number of the first query.
    first: usize,
    found: [Option<Guess>; QUADS],
}

impl Guesses {
    /// Forgets all.
    pub fn clear(&mut self) {
        self.found = [None; QUADS];
    }

    /// The guess of a query, once.
    pub fn take(&mut self, query: usize) -> Option<Guess> {
        let at = query.checked_sub(self.first)?;
        self.found.get_mut(at)?.take()
    }

    /// Makes the guesses of the queries from the number `first` on, from these places; `kept`: their memory.
    pub fn make(
        &mut self,
        (tree, places, faces): (&FaceTree, &Places, &[Face]),
        (first, kept): (usize, &[Kept]),
        xs: impl Iterator<Item = [f64; 3]>,
        scratch: &mut Scratch,
    ) {
        self.first = first;
        self.clear();
        let mut items = [None; QUADS];
        let (mut points, mut quads) = ([[0.0; 3]; QUADS], [[[0.0; 3]; 4]; QUADS]);
        let mut some = None;
        for (k, (x, kept)) in xs.zip(kept).enumerate().take(QUADS) {
            let Some(last) = kept.face.and_then(|last| quad(faces, i64::from(last))) else {
                continue;
            };
            (items[k], some, points[k]) = (Some(last.0), Some(k), x);
            quads[k] = corners(places, last.1);
            let step = scratch.step;
            if step != 0
                && let Some((item, face)) = quad(faces, i64::from(last.0) + step)
            {
                let stepped = corners(places, face);
                if middle_distance(&stepped, &x) < middle_distance(&quads[k], &x) {
                    (items[k], quads[k]) = (Some(item), stepped);
                }
            }
        }
        let Some(some) = some else {
            return;
        };
        // lanes without a guess repeat one that has
        let mut own = [0; QUADS];
        for k in 0..QUADS {
            let from = if items[k].is_some() { k } else { some };
            (points[k], quads[k]) = (points[from], quads[from]);
            own[k] = items[from].unwrap_or(0);
        }
        let feet = project_quads(&own.map(|item| &faces[item as usize]), &quads, &points);
        // points that keep lists of faces ask these
        let others = match kept.iter().take(QUADS).all(Kept::is_open) {
            true => tree.others(&points, &feet, &own),
            false => [true; QUADS],
        };
        for (k, foot) in feet.into_iter().enumerate() {
            self.found[k] = items[k].map(|item| Guess {
                item,
                foot,
                sure: !others[k],
            });
            scratch.projections += usize::from(items[k].is_some());
        }
    }
}

/// A face of a number, if there is one and it is a quadrilateral of four nodes.
#[inline]
fn quad(faces: &[Face], number: i64) -> Option<(u32, &Face)> {
    let item = u32::try_from(number).ok()?;
    let face = faces.get(item as usize)?;
    (face.kind == Kind::Quad4).then_some((item, face))
}
