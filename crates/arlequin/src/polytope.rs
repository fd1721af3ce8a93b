//! Convex bodies cut by planes: segments, polygons, polyhedra.
//!
//! A vertex closer to the cutting plane than the tolerance counts as lying on it, so faces that coincide in two
//! meshes leave no slivers.

/// The half-space n·x <= offset, n a unit vector pointing out of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plane {
    pub normal: [f64; 3],
    pub offset: f64,
}

impl Plane {
    /// The plane through a point with a normal of any length.
    pub fn new(point: &[f64; 3], normal: &[f64; 3]) -> Plane {
        let length = dot(normal, normal).sqrt().max(f64::MIN_POSITIVE);
        let normal = normal.map(|n| n / length);
        Plane {
            normal,
            offset: dot(&normal, point),
        }
    }

    /// The plane of a face whose vertices turn counter-clockwise seen from outside.
    pub fn of_face(vertices: &[[f64; 3]]) -> Plane {
        Plane::new(&Polytope::mean(vertices), &area_vector(vertices))
    }

    /// Signed distance, positive outside.
    pub fn distance(&self, x: &[f64; 3]) -> f64 {
        dot(&self.normal, x) - self.offset
    }
}

/// A convex body of dimension 1, 2 or 3.
#[derive(Clone, Debug)]
pub(crate) enum Polytope {
    /// On the first axis, from the first number to the second.
    Segment([f64; 2]),
    /// In the plane of the first two axes, counter-clockwise.
    Polygon(Vec<[f64; 3]>),
    /// Its faces, each counter-clockwise seen from outside.
    Polyhedron(Vec<Vec<[f64; 3]>>),
}

/// A face of a convex body: a point, an edge or a polygon.
#[derive(Clone, Debug)]
pub(crate) struct Facet {
    pub vertices: Vec<[f64; 3]>,
    /// Unit normal, outward.
    pub normal: [f64; 3],
    /// Length or area; 1 for a point.
    pub measure: f64,
}

impl Polytope {
    /// Mean of some points.
    pub fn mean(points: &[[f64; 3]]) -> [f64; 3] {
        [0, 1, 2].map(|i| points.iter().map(|x| x[i]).sum::<f64>() / points.len() as f64)
    }

    /// The part in a half-space, `None` if nothing is left.
    pub fn clip(self, plane: &Plane, tolerance: f64) -> Option<Polytope> {
        match self {
            Polytope::Segment([a, b]) => {
                let cut = plane.offset * plane.normal[0];
                let [a, b] = match plane.normal[0] > 0.0 {
                    true => [a, b.min(cut)],
                    false => [a.max(cut), b],
                };
                (b - a > tolerance).then_some(Polytope::Segment([a, b]))
            }
            Polytope::Polygon(vertices) => {
                let vertices = clip_polygon(&vertices, plane, tolerance);
                (vertices.len() > 2).then_some(Polytope::Polygon(vertices))
            }
            Polytope::Polyhedron(faces) => clip_polyhedron(faces, plane, tolerance),
        }
    }

    /// Length, area or volume.
    pub fn measure(&self) -> f64 {
        let mut sum = 0.0;
        self.simplices(|_, measure| sum += measure);
        sum
    }

    /// The simplices of a partition, each with its measure; the first dim + 1 of the vertices count.
    pub fn simplices(&self, mut each: impl FnMut(&[[f64; 3]; 4], f64)) {
        let zero = [0.0; 3];
        match self {
            Polytope::Segment([a, b]) => each(&[[*a, 0.0, 0.0], [*b, 0.0, 0.0], zero, zero], b - a),
            Polytope::Polygon(x) => {
                for i in 1..x.len() - 1 {
                    let area = 0.5 * cross(&sub(&x[i], &x[0]), &sub(&x[i + 1], &x[0]))[2];
                    each(&[x[0], x[i], x[i + 1], zero], area);
                }
            }
            Polytope::Polyhedron(faces) => {
                let top = faces[0][0];
                for face in &faces[1..] {
                    // A face through the top spans nothing with it.
                    if face.contains(&top) {
                        continue;
                    }
                    for i in 1..face.len() - 1 {
                        let x = [top, face[0], face[i], face[i + 1]];
                        let [a, b, c] = [1, 2, 3].map(|k| sub(&x[k], &top));
                        each(&x, dot(&a, &cross(&b, &c)) / 6.0);
                    }
                }
            }
        }
    }

    /// Its faces.
    pub fn facets(&self) -> Vec<Facet> {
        match self {
            Polytope::Segment([a, b]) => [(*a, -1.0), (*b, 1.0)]
                .map(|(x, sign)| Facet {
                    vertices: vec![[x, 0.0, 0.0]],
                    normal: [sign, 0.0, 0.0],
                    measure: 1.0,
                })
                .to_vec(),
            Polytope::Polygon(x) => (0..x.len())
                .map(|i| {
                    let (a, b) = (x[i], x[(i + 1) % x.len()]);
                    let normal = [b[1] - a[1], a[0] - b[0], 0.0];
                    Facet::new(vec![a, b], normal)
                })
                .collect(),
            Polytope::Polyhedron(faces) => faces
                .iter()
                .map(|face| Facet::new(face.clone(), area_vector(face)))
                .collect(),
        }
    }

    /// A point inside: the mean of the vertices.
    pub fn middle(&self) -> [f64; 3] {
        match self {
            Polytope::Segment([a, b]) => [0.5 * (a + b), 0.0, 0.0],
            Polytope::Polygon(x) => Polytope::mean(x),
            Polytope::Polyhedron(faces) => {
                let means: Vec<_> = faces.iter().map(|face| Polytope::mean(face)).collect();
                Polytope::mean(&means)
            }
        }
    }
}

impl Facet {
    /// A facet whose normal is given with the length of its measure.
    fn new(vertices: Vec<[f64; 3]>, normal: [f64; 3]) -> Facet {
        let measure = dot(&normal, &normal).sqrt();
        Facet {
            vertices,
            normal: normal.map(|n| n / measure.max(f64::MIN_POSITIVE)),
            measure,
        }
    }
}

/// The part of a convex polygon in a half-space; less than three vertices if nothing is left. Sutherland and
/// Hodgman (1974).
fn clip_polygon(vertices: &[[f64; 3]], plane: &Plane, tolerance: f64) -> Vec<[f64; 3]> {
    let mut kept = Vec::with_capacity(vertices.len() + 1);
    let mut inside = false;
    for (i, a) in vertices.iter().enumerate() {
        let b = &vertices[(i + 1) % vertices.len()];
        let (da, db) = (plane.distance(a), plane.distance(b));
        inside |= da < -tolerance;
        if da <= tolerance {
            kept.push(*a);
        }
        if (da > tolerance && db < -tolerance) || (da < -tolerance && db > tolerance) {
            kept.push(crossing(a, b, da, db));
        }
    }
    if !inside {
        kept.clear();
    }
    kept
}

/// Where the edge from `a` to `b` meets the plane.
fn crossing(a: &[f64; 3], b: &[f64; 3], da: f64, db: f64) -> [f64; 3] {
    let t = da / (da - db);
    [0, 1, 2].map(|i| (1.0 - t) * a[i] + t * b[i])
}

fn clip_polyhedron(faces: Vec<Vec<[f64; 3]>>, plane: &Plane, tolerance: f64) -> Option<Polytope> {
    let distances = faces.iter().flatten().map(|x| plane.distance(x));
    let (least, largest) = distances.fold((f64::MAX, f64::MIN), |(l, u), d| (l.min(d), u.max(d)));
    if least >= -tolerance {
        return None;
    }
    if largest <= tolerance {
        return Some(Polytope::Polyhedron(faces));
    }
    let (mut kept, mut rim) = (Vec::with_capacity(faces.len() + 1), Vec::new());
    for face in &faces {
        let face = clip_polygon(face, plane, tolerance);
        let on = |x: &&[f64; 3]| plane.distance(x).abs() <= tolerance;
        for x in face.iter().filter(on) {
            let same = |y: &[f64; 3]| dot(&sub(x, y), &sub(x, y)).sqrt() <= 4.0 * tolerance;
            if !rim.iter().any(same) {
                rim.push(*x);
            }
        }
        if face.len() > 2 {
            kept.push(face);
        }
    }
    if rim.len() > 2 {
        turn_around(&mut rim, &plane.normal);
        kept.push(rim);
    }
    (kept.len() > 3).then_some(Polytope::Polyhedron(kept))
}

/// Sorts the vertices of a convex polygon counter-clockwise about a normal.
fn turn_around(vertices: &mut [[f64; 3]], normal: &[f64; 3]) {
    let centre = Polytope::mean(vertices);
    // Any axis not along the normal spans the plane with it.
    let least = (1..3).fold(0, |best, i| {
        if normal[i].abs() < normal[best].abs() {
            i
        } else {
            best
        }
    });
    let mut axis = [0.0; 3];
    axis[least] = 1.0;
    let e = cross(normal, &axis);
    let f = cross(normal, &e);
    let angle = |x: &[f64; 3]| {
        let d = sub(x, &centre);
        dot(&d, &f).atan2(dot(&d, &e))
    };
    vertices.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
}

/// Area times normal of a polygon, plane or not.
fn area_vector(x: &[[f64; 3]]) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for i in 1..x.len() - 1 {
        let n = cross(&sub(&x[i], &x[0]), &sub(&x[i + 1], &x[0]));
        (0..3).for_each(|k| sum[k] += 0.5 * n[k]);
    }
    sum
}

pub(crate) fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

pub(crate) fn sub(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| a[i] - b[i])
}
