//! On which side of the middle of a shell a point belongs, where two surfaces look at each other.
//!
//! A shell has no outward side: what is nearest to its middle is pushed away from it to the side on which it is. A point that a step carries
//! over the middle would be pushed on. But its own body tells where it came from:
//!
//! - of a solid the shell is outside: it is on the side of the normals of the faces around the point. Where it is on the other side, the point has
//!   gone over the middle, and the gap is -d - h/2, d being the distance of the middle and h the thickness. As far behind as half the depth of the view: a
//!   shell that is on the other side of a thin solid is further away;
//! - of a shell that stands on its rim the rest is on the side from which it came: that of the mean place of the other nodes around the point. The point has
//!   gone over the middle where these are on the other side and further away.
//!
//! Beyond the rim of a shell there is no other side of it.

use carom_mesh::{Face, Projection};

use super::View;
use crate::Places;
use crate::search::Stand;

/// Part of the depth of the view up to which a point of a solid may be over the middle of a shell.
const OVER: f64 = 0.5;

impl View<'_> {
    /// Whether the viewer is of a solid, as the face is.
    pub(super) fn are_solids(&self, face: &Face) -> bool {
        let sight = self.sight;
        !sight.round && !(sight.has_middles && (face.is_round() || self.is_of_shell()))
    }

    /// The foot on a face that is turned to the viewer; none of one that is turned away, or that the viewer is too deep behind. Normals as in
    /// [`View::seen`].
    pub(super) fn faced(
        &self,
        (places, stand): (&Places, Stand),
        (face, foot): (&Face, Projection),
        normals: &[[f64; 3]],
    ) -> Option<Projection> {
        let is_deep = || foot.gap < -self.sight.depth[self.point];
        if self.are_solids(face) {
            let n = &foot.normal;
            let faced = !is_deep() && (self.opposes(n, normals) || self.points_at(places, n));
            return faced.then_some(foot);
        }
        if !self.sight.has_middles {
            return Some(foot);
        }
        match (face.is_round(), self.is_of_shell()) {
            (false, _) => (!is_deep()).then_some(foot),
            (true, true) => Some(self.beyond_rim(face, foot, stand)),
            (true, false) => self.before_solid(places, (face, foot), normals),
        }
    }

    fn is_of_shell(&self) -> bool {
        let first = self.sight.faces_around(self.point).next();
        first.is_some_and(Face::is_round)
    }

    /// Of a point of a solid and the middle of a shell.
    fn before_solid(
        &self,
        places: &Places,
        (face, foot): (&Face, Projection),
        normals: &[[f64; 3]],
    ) -> Option<Projection> {
        let faces = |n: &[f64; 3]| self.opposes(n, normals) || self.points_at(places, n);
        let away = foot.normal.map(|n| -n);
        let may_be_over = foot.distance <= OVER * self.sight.depth[self.point]
            && !face.rim.holds(face.kind, &foot.xi);
        let is_over = may_be_over && faces(&away);
        match (faces(&foot.normal), is_over) {
            (true, true) => {
                // both sides of a thin rim or of a tip: what it is turned to in the mean
                let around = self.sight.around.of(self.point).iter();
                let along = around.map(|&k| dot(&normals[k as usize], &foot.normal));
                Some(if along.sum::<f64>() > 0.0 {
                    over(face, foot)
                } else {
                    foot
                })
            }
            (true, false) => Some(foot),
            (false, true) => Some(over(face, foot)),
            (false, false) => None,
        }
    }

    /// Of a point of a shell and the middle of another one.
    fn beyond_rim(&self, face: &Face, foot: Projection, stand: Stand) -> Projection {
        let Some(rest) = stand.of.and_then(|behind| behind()) else {
            return foot;
        };
        let way = [0, 1, 2].map(|i| rest[i] - foot.point[i]);
        let is_over = dot(&way, &foot.normal) < -foot.distance
            && face.kind.table().dim == 2
            && !face.rim.holds(face.kind, &foot.xi);
        if is_over { over(face, foot) } else { foot }
    }
}

/// The foot of a point that has gone over the middle.
fn over(face: &Face, foot: Projection) -> Projection {
    Projection {
        normal: foot.normal.map(|n| -n),
        gap: -foot.distance - face.radius.unwrap_or(0.0),
        ..foot
    }
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}
