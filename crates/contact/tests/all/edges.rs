//! Sharp edges of solids that cross between their nodes.

use carom_algebra::unknowns::Unknowns;
use carom_contact::{Contact, Edges, Frames, Pairing, Places, Point, Search, Sight, Target};
use carom_mesh::{Mesh, SharpEdge, Surface, generate};
use carom_testing::Random;

use crate::fixture::{assert_balanced, assert_derivatives, contact, paired};

/// Half the diagonal of the section of a bar, m.
const HALF: f64 = 0.2;
/// Penetration beyond which edges do not touch, m: less than the height of a bar.
const DEPTH: f64 = 0.1;

/// Two bars of one element each that stand on edges: the lower one along x with its upper edge at z = 0, the other one above it along y, with
/// its lower edge at a height.
struct Bars {
    mesh: Mesh,
    surfaces: [Surface; 2],
}

impl Bars {
    fn new(height: f64) -> Bars {
        Bars::shifted(height, 1, [0.1, -0.2])
    }

    /// Of so many elements along, shifted along themselves, m.
    fn shifted(height: f64, cells: usize, shifts: [f64; 2]) -> Bars {
        let side = HALF * 2.0_f64.sqrt();
        let of = |name: &str| {
            let corner = [-1.0, -0.5 * side, -0.5 * side];
            generate::box_(name, corner, [2.0, side, side], [cells, 1, 1], false)
        };
        let (mut mesh, mut upper) = (of("a"), of("b"));
        let diagonal = |[x, y, z]: [f64; 3]| [x, (y - z) / side * HALF, (y + z) / side * HALF];
        for x in &mut mesh.nodes {
            let [along, across, up] = diagonal(*x);
            *x = [along + shifts[0], across, up - HALF];
        }
        for x in &mut upper.nodes {
            let [along, across, up] = diagonal(*x);
            // a quarter turn about z keeps the faces turned outwards
            *x = [-across, along + shifts[1], up + HALF + height];
        }
        mesh.merge("b", upper).unwrap();
        let surface = |name: &str| Surface::outer(&mesh, &mesh.groups[name].elements);
        Bars {
            surfaces: ["a", "b"].map(surface),
            mesh,
        }
    }

    fn edges(&self, body: usize) -> Vec<SharpEdge> {
        self.surfaces[body].sharp_edges_of_solids(&self.mesh)
    }

    /// All edges of the lower bar against those of the upper one.
    fn contact(&self) -> Contact {
        let points: Vec<Point> = self
            .edges(0)
            .iter()
            .map(|edge| Point::at_edge(edge, 1.0))
            .collect();
        let edges = Edges::new(&self.edges(1), &points, &self.mesh.nodes, DEPTH);
        Contact {
            edges,
            ..contact(points, Target::Surface(self.surfaces[1].faces.clone()))
        }
    }

    /// The edges of both bars as those of one surface that faces itself.
    fn contact_of_all(&self) -> Contact {
        let faces = self.surfaces.iter().flat_map(|surface| &surface.faces);
        let all = Surface::of_faces(faces.copied().collect());
        let edges = all.sharp_edges_of_solids(&self.mesh);
        let points: Vec<Point> = edges.iter().map(|edge| Point::at_edge(edge, 1.0)).collect();
        let x = &self.mesh.nodes;
        let sight = Sight::new((&points, &all.faces), &all.faces, x, None);
        Contact {
            edges: Edges::new(&edges, &points, x, DEPTH),
            sight: Some(sight),
            ..contact(points, Target::Surface(all.faces))
        }
    }

    fn places<'a>(&'a self, unknowns: &'a Unknowns, u: &'a [f64]) -> Places<'a> {
        Places {
            unknowns,
            time: 0.0,
            x: &self.mesh.nodes,
            u,
            frames: Frames::default(),
        }
    }

    fn unknowns(&self) -> Unknowns {
        Unknowns::translations(3, self.mesh.nodes.len())
    }

    /// The pairing where the upper bar has come down, m.
    fn paired_after(&self, contact: &Contact, down: f64) -> Pairing {
        let (unknowns, u) = (self.unknowns(), self.down(down));
        paired(contact, &self.places(&unknowns, &u))
    }

    /// The displacement in which the upper bar has come down, m.
    fn down(&self, down: f64) -> Vec<f64> {
        let nodes = self.mesh.nodes.len();
        let mut u = vec![0.0; 3 * nodes];
        for node in nodes / 2..nodes {
            u[3 * node + 2] = -down;
        }
        u
    }
}

/// Points that face something.
fn facing(pairing: &Pairing) -> Vec<usize> {
    let points = 0..pairing.len();
    points
        .filter(|&point| pairing.rows.gap(point).is_finite())
        .collect()
}

/// The upper edge of one and the lower edge of the other meet, and no other two of 144: edges at the sides have the other bar not before
/// them, those on the far sides are deeper than the depth.
#[test]
fn the_gap_of_two_edges_is_signed_and_linear_through_zero() {
    let bars = Bars::new(0.05);
    let contact = bars.contact();
    for down in [0.0, 0.02, 0.05 - 1e-12, 0.05, 0.05 + 1e-12, 0.08, 0.149] {
        let pairing = bars.paired_after(&contact, down);
        let facing = facing(&pairing);
        assert_eq!(facing.len(), 1, "{down}");
        // rounding of coordinates below 2 m
        assert!((pairing.rows.gap(facing[0]) - (0.05 - down)).abs() < 1e-15);
        // out of the upper bar
        let normal = pairing.rows.normal(facing[0]);
        assert!((normal[2] + 1.0).abs() < 1e-15, "{normal:?}");
    }
    assert_eq!(facing(&bars.paired_after(&contact, 0.151)), [0; 0]);
}

/// Where the edges cross at a node in the middle of one or both, or just beside it, one of the two edges there tells, and no other.
#[test]
fn edges_that_cross_at_a_node_are_told_once() {
    for shifts in [
        [0.0, 0.0],
        [0.0, 0.3],
        [0.3, 0.0],
        [2e-4, 0.0],
        [0.0, -2e-4],
        [-2e-4, 2e-4],
    ] {
        let bars = Bars::shifted(0.05, 2, shifts);
        for contact in [bars.contact(), bars.contact_of_all()] {
            for down in [0.0, 0.05, 0.08] {
                let pairing = bars.paired_after(&contact, down);
                let facing = facing(&pairing);
                assert_eq!(facing.len(), 1, "{shifts:?} {down}");
                assert!((pairing.rows.gap(facing[0]) - (0.05 - down)).abs() < 1e-15);
            }
        }
    }
}

/// On its way out below the lower bar the upper one has edges before those of the lower one, of which none may touch: their cones are those of
/// the other side.
#[test]
fn cones_let_out_what_is_behind() {
    let bars = Bars::new(0.05);
    let contact = bars.contact();
    // the upper edge of the lower bar and the upper edge of the other one, at one height
    let far = 0.05 + 2.0 * HALF;
    for down in [far - 0.05, far, far + 0.05] {
        assert_eq!(facing(&bars.paired_after(&contact, down)), [0; 0], "{down}");
    }
    // below: the lower edge of the lower bar over the upper edge of the other one is a contact from the other side
    let below = bars.paired_after(&contact, far + 2.0 * HALF + 0.03);
    let facing = facing(&below);
    assert_eq!(facing.len(), 1);
    assert!((below.rows.gap(facing[0]) - 0.03).abs() < 1e-15);
    assert!((below.rows.normal(facing[0])[2] - 1.0).abs() < 1e-15);
}

/// Where the sides of a bar have gone above its edge, another bar in it is before none of its faces. It is seen where it is remembered, with the gap along the same
/// normal, and no farther than the ends of the edges.
#[test]
fn an_edge_that_is_closed_stays_with_the_other_while_faces_turn() {
    let bars = Bars::new(0.05);
    let contact = bars.contact();
    let closed = bars.paired_after(&contact, 0.08);
    let faced: Vec<_> = (0..closed.len() as u32)
        .filter_map(|point| Some((point, closed.faced(point as usize)?)))
        .collect();
    assert_eq!(faced.len(), 1);
    let after = |down: f64, along: f64, remembers: bool| {
        let mut u = bars.down(down);
        for (node, x) in bars.mesh.nodes.iter().enumerate() {
            let is_side = x[2] < -0.5 * HALF && x[2] > -1.5 * HALF;
            if node < bars.mesh.nodes.len() / 2 {
                u[3 * node] = along;
                u[3 * node + 2] = if is_side { 1.5 * HALF } else { 0.0 };
            }
        }
        let (unknowns, mut search) = (bars.unknowns(), Search::default());
        if remembers {
            search.remember(faced.iter().copied());
        }
        let mut pairing = Pairing::default();
        pairing.clear();
        contact.pair_fully(&bars.places(&unknowns, &u), &mut search, &mut pairing);
        // the edges at the sides may touch too
        let point = faced[0].0 as usize;
        let gap = pairing.rows.gap(point);
        gap.is_finite()
            .then(|| (gap, pairing.rows.normal(point)[2]))
    };
    assert_eq!(after(0.08, 0.0, false), None);
    for down in [0.03, 0.08, 0.12] {
        let (gap, up) = after(down, 0.0, true).unwrap();
        // rounding of coordinates below 2 m
        assert!((gap - (0.05 - down)).abs() < 1e-15, "{gap}");
        assert!((up + 1.0).abs() < 1e-15, "{up}");
    }
    assert_eq!(after(0.08, 2.0, true), None);
}

/// An edge as the axis of a beam of a radius, m.
fn axis(edge: &SharpEdge, radius: f64) -> SharpEdge {
    let mut axis = SharpEdge {
        beside: None,
        ..*edge
    };
    axis.line.radius = Some(radius);
    axis
}

/// A round axis has the gap of its line less the radius, on both sides of zero, up to the depth.
#[test]
fn an_axis_touches_a_sharp_edge_at_its_radius() {
    let bars = Bars::new(0.05);
    let edges = bars.edges(0);
    let contact = bars.contact();
    let upper = facing(&bars.paired_after(&contact, 0.0))[0];
    let points = vec![Point::at_edge(&axis(&edges[upper], 0.03), 1.0)];
    let contact = Contact {
        edges: Edges::new(&bars.edges(1), &points, &bars.mesh.nodes, DEPTH),
        points,
        ..contact
    };
    for down in [0.0, 0.019, 0.021, 0.06, 0.119] {
        let pairing = bars.paired_after(&contact, down);
        assert!(
            (pairing.rows.gap(0) - (0.02 - down)).abs() < 1e-15,
            "{down}"
        );
        assert!((pairing.rows.normal(0)[2] + 1.0).abs() < 1e-15);
    }
    assert!(facing(&bars.paired_after(&contact, 0.121)).is_empty());
}

/// Outside, inside, and where the edges touch to rounding, between bars that are bent; every other time the own edge is a round axis.
#[test]
fn rows_and_curvature_of_edges_are_derivatives_on_both_sides_of_zero() {
    let bars = Bars::new(0.05);
    let unknowns = bars.unknowns();
    let mut random = Random(11);
    for case in 0..12 {
        let radius = [0.0, 0.03][case / 3 % 2];
        let bend = random.vector(unknowns.len());
        let u: Vec<f64> = bend.iter().map(|u| 0.02 * u).collect();
        let contact = bars.contact();
        let point = facing(&paired(&contact, &bars.places(&unknowns, &u)));
        assert_eq!(point.len(), 1);
        let points = match radius > 0.0 {
            true => vec![Point::at_edge(&axis(&bars.edges(0)[point[0]], radius), 1.0)],
            false => vec![contact.points[point[0]]],
        };
        let contact = Contact {
            edges: Edges::new(&bars.edges(1), &points, &bars.mesh.nodes, DEPTH),
            points,
            ..contact
        };
        let before = paired(&contact, &bars.places(&unknowns, &u));
        // along the normal the edges move without turning
        let (gap, normal) = (before.rows.gap(0), before.rows.normal(0));
        let wanted = [0.04, 0.0, -0.04][case % 3];
        let mut moved = u.clone();
        for node in bars.mesh.nodes.len() / 2..bars.mesh.nodes.len() {
            for i in 0..3 {
                moved[3 * node + i] += (gap - wanted) * normal[i];
            }
        }
        let places = bars.places(&unknowns, &moved);
        let pairing = paired(&contact, &places);
        assert!((pairing.rows.gap(0) - wanted).abs() < 1e-14);
        assert_balanced(&pairing, 0, &places, 1e-13);
        assert_derivatives(&places, |places| paired(&contact, places));
    }
}

/// Both edges have a point where the surface faces itself: the first one tells.
#[test]
fn two_edges_of_one_surface_tell_their_contact_once() {
    let bars = Bars::new(0.05);
    let contact = bars.contact_of_all();
    for down in [0.0, 0.03, 0.08] {
        let pairing = bars.paired_after(&contact, down);
        let facing = facing(&pairing);
        assert_eq!(facing.len(), 1, "{down}");
        assert!(facing[0] < contact.points.len() / 2);
        assert!((pairing.rows.gap(facing[0]) - (0.05 - down)).abs() < 1e-15);
    }
}

/// One edge of the upper bar, which comes down flat on a bar that lies on a face: it crosses both upper edges of that. With two points it has both, with
/// one it has the nearer one; from the other side each of both edges has it.
#[test]
fn an_edge_that_crosses_two_has_two_points() {
    let mut mesh = generate::box_("a", [-1.0, -0.2, -0.4], [2.0, 0.4, 0.4], [1, 1, 1], false);
    let mut upper = generate::box_("b", [-1.0, -0.2, -0.2], [2.0, 0.4, 0.4], [1, 1, 1], false);
    let half = 0.5_f64.sqrt();
    for x in &mut upper.nodes {
        let [along, across, up] = *x;
        let (across, up) = (half * (across - up), half * (across + up));
        *x = [-across, along, up + 0.2 * 2.0_f64.sqrt() + 0.05];
    }
    mesh.merge("b", upper).unwrap();
    let [lower, upper] = ["a", "b"].map(|name| Surface::outer(&mesh, &mesh.groups[name].elements));
    let x = &mesh.nodes;
    let unknowns = Unknowns::translations(3, x.len());
    let still = vec![0.0; unknowns.len()];
    let places = Places {
        unknowns: &unknowns,
        time: 0.0,
        x,
        u: &still,
        frames: Frames::default(),
    };
    let gaps = |of: &Surface, on: &Surface, twice: bool| {
        let edges = of.sharp_edges_of_solids(&mesh);
        let mut points: Vec<Point> = edges.iter().map(|edge| Point::at_edge(edge, 1.0)).collect();
        if twice {
            let second: Vec<Point> = points.iter().map(|point| point.second()).collect();
            points.extend(second);
        }
        let edges = Edges::new(&on.sharp_edges_of_solids(&mesh), &points, x, DEPTH);
        let contact = Contact {
            edges,
            ..contact(points, Target::Surface(on.faces.clone()))
        };
        let pairing = paired(&contact, &places);
        let facing = facing(&pairing).into_iter();
        let gaps: Vec<f64> = facing.map(|point| pairing.rows.gap(point)).collect();
        gaps
    };
    for (of, on, twice, count) in [
        (&upper, &lower, false, 1),
        (&upper, &lower, true, 2),
        (&lower, &upper, false, 2),
        (&lower, &upper, true, 2),
    ] {
        let found = gaps(of, on, twice);
        assert_eq!(found.len(), count);
        assert!(
            found.iter().all(|gap| (gap - 0.05).abs() < 1e-15),
            "{found:?}"
        );
    }
}

/// Points that rest are those that would have been found far.
#[test]
fn near_edges_are_those_of_all_that_are_within_reach() {
    let reach = 0.06;
    for of_all in [false, true] {
        let bars = Bars::new(0.9);
        let contact = match of_all {
            true => bars.contact_of_all(),
            false => bars.contact(),
        };
        let (unknowns, mut search) = (bars.unknowns(), Search::default());
        let (mut pairing, mut found) = (Pairing::default(), 0);
        for step in 0..100 {
            // faster than the search expects, at last through each other
            let u = bars.down(1e-4 * f64::from(step).powi(2));
            let places = bars.places(&unknowns, &u);
            pairing.clear();
            contact.append_near(
                &places,
                &mut search,
                (None, reach, &|_| false),
                &mut pairing,
            );
            let all = paired(&contact, &places);
            for point in 0..all.len() {
                let gap = all.rows.gap(point);
                match gap <= reach {
                    true => {
                        found += 1;
                        assert_eq!(pairing.rows.gap(point), gap);
                        assert_eq!(pairing.rows.row(point), all.rows.row(point));
                    }
                    false => assert_eq!(pairing.rows.gap(point), f64::INFINITY),
                }
            }
        }
        assert!(found > 5, "{found}");
    }
}

/// What a rank knows of a contact: the faces that some points may touch. The gap, and which of two points tells, are as with all faces.
#[test]
fn faces_in_reach_of_an_edge_are_all_that_decides_what_it_touches() {
    let (reach, motion) = (0.06, 0.01);
    for of_all in [false, true] {
        let bars = Bars::new(0.05);
        let contact = match of_all {
            true => bars.contact_of_all(),
            false => bars.contact(),
        };
        let (unknowns, mut touched) = (bars.unknowns(), 0);
        for down in [0.0, 0.03, 0.08] {
            let (start, end) = (bars.down(down), bars.down(down + 0.9 * motion));
            let start = bars.places(&unknowns, &start);
            let due: Vec<u32> = (0..contact.points.len() as u32).collect();
            let of = [reach, reach, motion];
            let found =
                contact.in_reach((&start, 0.0), &mut Search::default(), of, (&due, |_| false));
            let places = bars.places(&unknowns, &end);
            let all = paired(&contact, &places);
            for (point, found) in found.iter().enumerate() {
                let kept: Vec<u32> = found.faces.iter().map(|(face, _)| *face).collect();
                let some = paired(&contact.with_some_faces(&kept), &places);
                let gap = all.rows.gap(point);
                if gap <= reach {
                    touched += 1;
                    assert!(found.faces.iter().any(|(_, rest)| *rest == 0.0));
                    assert_eq!(some.rows.gap(point), gap);
                } else {
                    assert!(some.rows.gap(point) > reach);
                }
                assert_eq!(kept.is_empty(), found.clearance > 0.0);
            }
        }
        assert_eq!(touched, 3);
    }
}
