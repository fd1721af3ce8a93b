//! One contact: secondary points that carry the forces, what they face, and the law between them.

use carom_mesh::{Face, Projection, QUADS, Rim};

use crate::crossing::Opposite;
use crate::sight::View;
use crate::{Basis, Edges, Held, Law, Mortar, Obstacle, Places, Point, Search, Shape, Sight};

/// What the secondary points face.
#[derive(Clone, Debug, PartialEq)]
pub enum Target {
    /// Faces of deformable bodies, their nodes by system number; normals point out of the bodies. Their rims are marked.
    Surface(Vec<Face>),
    /// A rigid obstacle.
    Rigid(Obstacle),
}

/// How far bodies slide along each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sliding {
    /// Much less than an element: points are paired once, where all nodes are at their reference places, and their rows and
    /// responses kept. Of an obstacle that moves, with the obstacle where it is now.
    Small,
    /// Any distance: points are paired anew at every step.
    Finite,
}

/// Where the law holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Integration {
    /// At the nodes of the secondary surface: collocation.
    Node,
    /// At the Gauss points of its faces, in each by itself: for laws that give the pressure as a function.
    Points,
    /// In the weak form with a multiplier at the nodes and a sign at each Gauss point: for exact laws.
    Weak {
        /// r of the augmented pressure p - r q, in Pa/m for a law in the gap, in Pa s/m for one in the rate.
        r: f64,
    },
    /// At the corners of the faces in the mean: the weak gap of each multiplier, segment to segment.
    Mortar {
        /// Shape functions of the multipliers.
        basis: Basis,
    },
}

/// A frictionless contact.
#[derive(Clone, Debug)]
pub struct Contact {
    /// Name as in the case file.
    pub name: String,
    /// The law.
    pub law: Law,
    /// Extent of the sliding.
    pub sliding: Sliding,
    /// Where the law holds.
    pub integration: Integration,
    /// Secondary points: nodes, or Gauss points.
    pub points: Vec<Point>,
    /// Faces of the secondary surface, where integration is by mortar; the points are then its own.
    pub mortar: Option<Mortar>,
    /// What they face.
    pub target: Target,
    /// Sharp edges of the target that points of edges of the secondary surface face ([`Point::at_edge`](crate::Point::at_edge)); none where edges
    /// do not count.
    pub edges: Option<Edges>,
    /// What they see of it; `None` for everything: each point then faces the closest face.
    pub sight: Option<Sight>,
    /// What is added to the gap of each point, m: initial penetrations that are to count as contact without any
    /// ([`Initial::Offset`](crate::Initial)). Empty for none.
    pub offsets: Vec<f64>,
    /// Whether points that are far from what they face have no gap in implicit steps too ([`Contact::append_near`]).
    pub near_only: bool,
}

impl Contact {
    /// The points that the iterations of a step have made stay with a face ([`Search::begin_step`]). `search` is that of
    /// these places.
    pub fn held(&self, places: &Places, search: &Search) -> Vec<Held> {
        match &self.target {
            Target::Rigid(_) => Vec::new(),
            Target::Surface(faces) => {
                let of = (places, self.sight.is_some());
                search.held(of, faces, |point| self.points[point].place(places))
            }
        }
    }

    /// The closest point of the target to each point that faces one, into `feet`, which is cleared first; none on an obstacle. `search` is
    /// that of these places ([`Contact::renew`]).
    pub fn feet(&self, places: &Places, search: &mut Search, feet: &mut Vec<Option<Projection>>) {
        feet.clear();
        let Target::Surface(faces) = &self.target else {
            return;
        };
        search.begin();
        self.each_opposite((places, faces), search, |_, found| {
            feet.push(found.map(|found| found.foot));
        });
    }

    /// Calls `visit` with each point and what is opposite to it on a surface.
    pub(crate) fn each_opposite<'a>(
        &'a self,
        (places, faces): (&Places, &'a [Face]),
        search: &mut Search,
        mut visit: impl FnMut(usize, Option<Opposite<'a>>),
    ) {
        for (k, point) in self.points.iter().enumerate() {
            if k % QUADS == 0 && self.sight.is_none() {
                search.look_ahead(places, faces, &self.points[k..]);
            }
            let found = match point.edge() {
                Some(_) => self.opposite_edge((places, &search.lines), k, f64::INFINITY),
                None => search.opposite(places, faces, (point, self.view(k))),
            };
            visit(k, found);
        }
    }

    /// Brings the search to a configuration: takes the boxes of the faces unless they have hardly moved.
    pub fn renew(&self, places: &Places, search: &mut Search) {
        if let Target::Surface(faces) = &self.target {
            search.renew(places, faces, self.sight.as_ref());
        }
        if let Some(edges) = &self.edges {
            search.lines.tree.renew(places, edges.lines());
        }
    }

    /// The contact with other faces of the target, by system number; of a surface that faces itself points see what is around them of these
    /// faces too. Edges do not count there. `x`: reference coordinates by system number, m.
    pub fn with_faces(&self, mut faces: Vec<Face>, x: &[[f64; 3]]) -> Contact {
        Rim::mark(&mut faces, |node| x[node as usize], |node| node);
        let sight = match self.has_both_sides() {
            true => Some(Sight::new((&self.points, &faces), &faces, x, None)),
            false => self.sight.as_ref().map(|sight| sight.with_target(&faces)),
        };
        Contact {
            target: Target::Surface(faces),
            edges: None,
            sight,
            ..self.clone()
        }
    }

    /// The contact with its nodes in other numbers, in the same order.
    pub fn renumbered(&self, number: impl Fn(u32) -> u32) -> Contact {
        let of_all = |faces: &[Face]| -> Vec<Face> {
            let faces = faces.iter();
            faces.map(|face| face.renumbered(&number)).collect()
        };
        let points = self.points.iter();
        Contact {
            name: self.name.clone(),
            points: points.map(|point| point.renumbered(&number)).collect(),
            mortar: self
                .mortar
                .as_ref()
                .map(|mortar| mortar.with_faces(of_all(&mortar.faces))),
            target: match &self.target {
                Target::Surface(faces) => Target::Surface(of_all(faces)),
                Target::Rigid(obstacle) => Target::Rigid(obstacle.clone()),
            },
            edges: self.edges.as_ref().map(|edges| edges.renumbered(&number)),
            sight: self.sight.as_ref().map(|sight| sight.renumbered(&number)),
            offsets: self.offsets.clone(),
            ..*self
        }
    }

    /// Whether points are on both sides: the surface faces itself, or its sides face each other.
    pub fn has_both_sides(&self) -> bool {
        self.sight.as_ref().is_some_and(Sight::has_both_sides)
    }

    /// Whether it is looked for both ways: points of the primary side follow those of the secondary one, and the faces of both sides are the target.
    pub fn looks_both_ways(&self) -> bool {
        self.points.iter().any(Point::is_on_primary)
    }

    /// Faces of the primary side, by system number, of a contact with this many faces on the secondary one; none of an obstacle.
    pub fn faces_of_primary(&self, secondary: usize) -> &[Face] {
        match &self.target {
            Target::Surface(faces) if self.looks_both_ways() => &faces[secondary..],
            Target::Surface(faces) => faces,
            Target::Rigid(_) => &[],
        }
    }

    /// What a point sees; `None` for everything.
    pub(crate) fn view(&self, point: usize) -> Option<View<'_>> {
        self.sight.as_ref().map(|sight| sight.of(point))
    }

    /// What is added to the gap of a point, m.
    pub(crate) fn offset(&self, point: usize) -> f64 {
        self.offsets.get(point).copied().unwrap_or(0.0)
    }

    /// Whether rows depend on the places of the points: with finite sliding, and on anything but a rigid plane.
    pub fn turns(&self) -> bool {
        self.sliding == Sliding::Finite && !self.faces_plane()
    }

    /// Whether points keep the partner and the normal of their first pairing where another pairing would differ: with small
    /// sliding, on anything but a rigid plane.
    pub fn pairs_once(&self) -> bool {
        self.sliding == Sliding::Small && !self.faces_plane()
    }

    fn faces_plane(&self) -> bool {
        matches!(&self.target, Target::Rigid(rigid) if matches!(rigid.shape, Shape::Plane(_)))
    }

    /// Whether the target moves by itself: gaps then have a rate at bodies at rest ([`Rows::rate`](crate::Rows::rate)).
    pub fn moves(&self) -> bool {
        matches!(&self.target, Target::Rigid(obstacle) if obstacle.motion.moves())
    }
}
