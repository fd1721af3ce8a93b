//! Forces of quadrilaterals with one point, as many at a time as a register has lanes.
//!
//! The formulas are those of [`one_point`](super::one_point), whose strains are sums of products of nine vectors: g_r, g_s, x_h and the directors d_m, d_r, d_s, d_h; and
//! of both other axes of each node for the rotation about the normal. Forces go the same way back.

use carom_algebra::number::Number;
use carom_algebra::packed::Packed;
use carom_materials::{PlaneStressPoints, SIDE};
use pulp::{Simd, WithSimd};

use super::chunk::{Chunk, Constants};
use super::layers::Layers;

use super::products::MOST;
use crate::Stored;

/// A vector of several elements.
type Vector<T> = [T; 3];

#[inline(always)]
fn dot<T: Number>(a: &Vector<T>, b: &Vector<T>) -> T {
    a[0].mul_add(b[0], a[1].mul_add(b[1], a[2] * b[2]))
}

#[inline(always)]
fn cross<T: Number>(a: &Vector<T>, b: &Vector<T>) -> Vector<T> {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// `to` += factor · `of`.
#[inline(always)]
fn add<T: Number>(to: &mut Vector<T>, factor: T, of: &Vector<T>) {
    for i in 0..3 {
        to[i] = factor.mul_add(of[i], to[i]);
    }
}

/// Sums over the nodes: all, along r, along s, crossed; times ¼.
#[inline(always)]
fn patterns<T: Number>(of: &[Vector<T>; MOST]) -> [Vector<T>; MOST] {
    let zero = of[0][0].like(0.0);
    let mut sums = [[zero; 3]; MOST];
    for i in 0..3 {
        let [a, b, c, d] = [of[0][i], of[1][i], of[2][i], of[3][i]];
        let (first, second) = (b - a, c - d);
        let (low, high) = (a + b, c + d);
        sums[0][i] = (low + high).scale(0.25);
        sums[1][i] = (first + second).scale(0.25);
        sums[2][i] = (high - low).scale(0.25);
        sums[3][i] = (second - first).scale(0.25);
    }
    sums
}

/// The share of each node of what acts on the sums.
#[inline(always)]
fn shares<T: Number>(on: &[Vector<T>; MOST]) -> [Vector<T>; MOST] {
    let zero = on[0][0].like(0.0);
    let mut shares = [[zero; 3]; MOST];
    for i in 0..3 {
        let [m, r, s, h] = [on[0][i], on[1][i], on[2][i], on[3][i]];
        let (even, odd) = (m + h, m - h);
        let (plus, minus) = (r + s, r - s);
        shares[0][i] = (even - plus).scale(0.25);
        shares[1][i] = (odd + minus).scale(0.25);
        shares[2][i] = (even + plus).scale(0.25);
        shares[3][i] = (odd - minus).scale(0.25);
    }
    shares
}

/// Strains 11, 22, 12 in the axes of the centre from those along r and s; twice the last one.
#[inline(always)]
fn local<T: Number>(to: &[[T; 2]; 2], [rr, ss, rs]: [T; 3]) -> [T; 3] {
    let [[a, b], [c, d]] = *to;
    let twice = rs + rs;
    [
        a * a * rr + b * b * ss + a * b * twice,
        c * c * rr + d * d * ss + c * d * twice,
        (a * c * rr + b * d * ss).scale(2.0) + (a * d + b * c) * twice,
    ]
}

/// What acts on the strains along r and s.
#[inline(always)]
fn covariant<T: Number>(to: &[[T; 2]; 2], [x, y, xy]: [T; 3]) -> [T; 3] {
    let [[a, b], [c, d]] = *to;
    [
        a * a * x + c * c * y + (a * c * xy).scale(2.0),
        b * b * x + d * d * y + (b * d * xy).scale(2.0),
        (a * b * x + c * d * y + (a * d + b * c) * xy).scale(2.0),
    ]
}

/// What an element is in its configuration, and its strains.
struct Now<T> {
    /// x_m, which nothing depends on, g_r, g_s, x_h.
    x: [Vector<T>; MOST],
    /// d_m, d_r, d_s, d_h.
    d: [Vector<T>; MOST],
    /// Axes t₁, t₂ and director of each node.
    axes: [[Vector<T>; 3]; MOST],
    /// x,₁ and x,₂.
    tangents: [Vector<T>; 2],
    membrane: [T; 3],
    curvature: [T; 3],
    shear: [T; 2],
    /// m, b and η, over the lengths.
    unseen: [[T; 2]; 3],
    drilling: [T; MOST],
}

impl<T: Number> Now<T> {
    #[inline(always)]
    fn new(
        c: &Constants<T>,
        (x, offset): (&[Vector<T>; MOST], f64),
        turned: &[[Vector<T>; 3]; MOST],
    ) -> Now<T> {
        let zero = c.area.like(0.0);
        let none = [zero; 3];
        let mut axes = [[none; 3]; MOST];
        let mut directors = [none; MOST];
        // of the middle surface
        let mut middle = *x;
        for a in 0..MOST {
            for i in 0..3 {
                axes[a][0][i] = dot(&turned[a][i], &c.first[a]);
                axes[a][2][i] = dot(&turned[a][i], &c.director[a]);
            }
            axes[a][1] = cross(&axes[a][2], &axes[a][0]);
            directors[a] = axes[a][2];
            add(&mut middle[a], zero.like(offset), &directors[a]);
        }
        let (x, d) = (patterns(&middle), patterns(&directors));
        let [[a, b], [e, f]] = c.to;
        let mut tangents = [none; 2];
        for i in 0..3 {
            tangents[0][i] = a * x[1][i] + b * x[2][i];
            tangents[1][i] = e * x[1][i] + f * x[2][i];
        }
        let mut drilling = [zero; MOST];
        for a in 0..MOST {
            let skew = dot(&tangents[0], &axes[a][1]) - dot(&tangents[1], &axes[a][0]);
            drilling[a] = skew.scale(0.25) - c.drilled[a];
        }
        let mut now = Now {
            x,
            d,
            axes,
            tangents,
            membrane: none,
            curvature: none,
            shear: [zero; 2],
            unseen: [[zero; 2]; 3],
            drilling,
        };
        now.strain(c);
        now
    }

    #[inline(always)]
    fn strain(&mut self, c: &Constants<T>) {
        let ([_, r, s, h], [dm, dr, ds, dh]) = (&self.x, &self.d);
        let (rr, ss, rs) = (dot(r, r), dot(s, s), dot(r, s));
        let (brr, bss, brs, bsr) = (dot(r, dr), dot(s, ds), dot(r, ds), dot(s, dr));
        let half = |x: T| x.scale(0.5);
        self.membrane = local(&c.to, [half(rr), half(ss), half(rs)]);
        self.curvature = local(&c.to, [brr, bss, half(brs + bsr)]);
        let across = [dot(r, dm) + dot(h, ds), dot(s, dm) + dot(h, dr)];
        let [[a, b], [e, f]] = c.to;
        self.shear = [a * across[0] + b * across[1], e * across[0] + f * across[1]];
        for i in 0..3 {
            self.membrane[i] -= c.start[i];
            self.curvature[i] -= c.start[3 + i];
        }
        self.shear[0] -= c.start[6];
        self.shear[1] -= c.start[7];
        let ([cr, cs], [lr, ls]) = (c.twist, c.inverse);
        let crossed = dot(h, dm);
        self.unseen = [
            [
                (dot(r, h) - cr * rr - cs * rs) * lr * lr,
                (dot(s, h) - cr * rs - cs * ss) * ls * ls,
            ],
            [
                (dot(r, dh) - cr * brr - cs * brs) * lr * lr,
                (dot(s, dh) - cr * bsr - cs * bss) * ls * ls,
            ],
            [(brs + crossed) * lr, (bsr + crossed) * ls],
        ];
        for (unseen, start) in self.unseen.iter_mut().zip(&c.unseen) {
            unseen[0] -= start[0];
            unseen[1] -= start[1];
        }
    }
}

/// What acts on the strains, times the area.
struct Acting<T> {
    membrane: [T; 3],
    bending: [T; 3],
    shear: [T; 2],
    unseen: [[T; 2]; 3],
    drilling: [T; MOST],
}

impl<T: Number> Acting<T> {
    /// Of an elastic section, with the energies: all, and that of what one point does not see.
    #[inline(always)]
    fn elastic(c: &Constants<T>, now: &Now<T>) -> (Acting<T>, [T; 2]) {
        let plane = |[own, across, shear]: [T; 3], [x, y, xy]: [T; 3]| {
            [own * x + across * y, own * y + across * x, shear * xy]
        };
        let (mut acting, mut energies) = Acting::beside(c, now);
        acting.membrane = plane(c.membrane, now.membrane);
        acting.bending = plane(c.bending, now.curvature);
        let one = c.area.like(1.0);
        add(&mut acting.membrane, one, &plane(c.coupling, now.curvature));
        add(&mut acting.bending, one, &plane(c.coupling, now.membrane));
        let seen = dot(&acting.membrane, &now.membrane) + dot(&acting.bending, &now.curvature);
        energies[0] += seen.scale(0.5);
        (acting, energies)
    }

    /// Of shear and all that is not in the section.
    #[inline(always)]
    fn beside(c: &Constants<T>, now: &Now<T>) -> (Acting<T>, [T; 2]) {
        let zero = c.area.like(0.0);
        let mut acting = Acting {
            membrane: [zero; 3],
            bending: [zero; 3],
            shear: [c.shear * now.shear[0], c.shear * now.shear[1]],
            unseen: [[zero; 2]; 3],
            drilling: [zero; MOST],
        };
        let mut twice = acting.shear[0] * now.shear[0] + acting.shear[1] * now.shear[1];
        for a in 0..MOST {
            acting.drilling[a] = c.drilling * now.drilling[a];
            twice += acting.drilling[a] * now.drilling[a];
        }
        let mut unseen = zero;
        for kind in 0..3 {
            for i in 0..2 {
                let strain = now.unseen[kind][i];
                acting.unseen[kind][i] = c.hourglass[kind] * strain;
                unseen += acting.unseen[kind][i] * strain;
            }
        }
        (acting, [(twice + unseen).scale(0.5), unseen.scale(0.5)])
    }

    /// Forces and moments on the nodes.
    #[inline(always)]
    fn forces(&self, c: &Constants<T>, (now, offset): (&Now<T>, f64)) -> [[Vector<T>; 2]; MOST] {
        let zero = c.area.like(0.0);
        let ([_, r, s, h], [dm, dr, ds, dh]) = (&now.x, &now.d);
        let ([cr, cs], [lr, ls]) = (c.twist, c.inverse);
        let [[m_r, m_s], [b_r, b_s], [n_r, n_s]] = self.unseen;
        let (m_r, m_s) = (m_r * lr * lr, m_s * ls * ls);
        let (b_r, b_s) = (b_r * lr * lr, b_s * ls * ls);
        let (n_r, n_s) = (n_r * lr, n_s * ls);
        let [rr, ss, rs] = covariant(&c.to, self.membrane);
        // on g·g: rr and ss are halves of squares, rs half a product
        let rr = rr - (cr * m_r).scale(2.0);
        let ss = ss - (cs * m_s).scale(2.0);
        let rs = rs.scale(0.5) - cs * m_r - cr * m_s;
        let [brr, bss, bent] = covariant(&c.to, self.bending);
        let half = bent.scale(0.5);
        let (brr, bss) = (brr - cr * b_r, bss - cs * b_s);
        let (brs, bsr) = (half - cs * b_r + n_r, half - cr * b_s + n_s);
        let crossed = n_r + n_s;
        let [[a, b], [e, f]] = c.to;
        let q_r = a * self.shear[0] + e * self.shear[1];
        let q_s = b * self.shear[0] + f * self.shear[1];
        let mut on_x = [[zero; 3]; MOST];
        let mut on_d = [[zero; 3]; MOST];
        for i in 0..3 {
            let (r, s, h) = (r[i], s[i], h[i]);
            let (dm, dr, ds, dh) = (dm[i], dr[i], ds[i], dh[i]);
            on_x[1][i] = rr * r + rs * s + m_r * h + brr * dr + brs * ds + q_r * dm + b_r * dh;
            on_x[2][i] = ss * s + rs * r + m_s * h + bss * ds + bsr * dr + q_s * dm + b_s * dh;
            on_x[3][i] = m_r * r + m_s * s + crossed * dm + q_r * ds + q_s * dr;
            on_d[0][i] = crossed * h + q_r * r + q_s * s;
            on_d[1][i] = brr * r + bsr * s + q_s * h;
            on_d[2][i] = bss * s + brs * r + q_r * h;
            on_d[3][i] = b_r * r + b_s * s;
        }
        let mut on_tangents = [[zero; 3]; 2];
        for (axes, drilling) in now.axes.iter().zip(&self.drilling) {
            let quarter = drilling.scale(0.25);
            add(&mut on_tangents[0], quarter, &axes[1]);
            add(&mut on_tangents[1], -quarter, &axes[0]);
        }
        let [first, second] = &on_tangents;
        add(&mut on_x[1], a, first);
        add(&mut on_x[1], e, second);
        add(&mut on_x[2], b, first);
        add(&mut on_x[2], f, second);
        let (forces, on_directors) = (shares(&on_x), shares(&on_d));
        let mut found = [[[zero; 3]; 2]; MOST];
        for node in 0..MOST {
            let axes = &now.axes[node];
            let quarter = self.drilling[node].scale(0.25);
            // an axis changes by ω × a
            let mut on_director = on_directors[node];
            add(&mut on_director, zero.like(offset), &forces[node]);
            let mut moment = cross(&axes[2], &on_director);
            add(&mut moment, quarter, &cross(&axes[1], &now.tangents[0]));
            add(&mut moment, -quarter, &cross(&axes[0], &now.tangents[1]));
            found[node] = [forces[node], moment];
        }
        found
    }
}

/// The forces of one chunk.
pub(super) struct Sweep<'a> {
    pub chunk: &'a Chunk,
    pub layers: Option<&'a Layers>,
    pub dt: f64,
    /// Histories of the elements of the chunk.
    pub old: &'a [f64],
    pub new: &'a mut [f64],
    /// Place of each node, and the rows of its rotation.
    pub states: &'a [[f64; 12]],
    /// Force and moment on each node, in space.
    pub f: &'a mut [[f64; 6]],
}

impl WithSimd for Sweep<'_> {
    type Output = Stored;

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) -> Stored {
        let zero = Packed::all(simd, 0.0);
        let mut stored = Stored::default();
        let mut points = PlaneStressPoints::default();
        for (place, batch) in self.chunk.connectivity.chunks(S::F64_LANES).enumerate() {
            let first = place * S::F64_LANES;
            let (x, turned) = self.gathered(batch, zero);
            let c = self.chunk.constants(first, zero);
            let now = Now::new(&c, (&x, self.chunk.offset), &turned);
            let (acting, [strain, hourglass]) = match self.layers {
                None => Acting::elastic(&c, &now),
                Some(layers) => {
                    let (mut acting, energies) = Acting::beside(&c, &now);
                    let of = (first, batch.len());
                    self.flow(
                        layers,
                        of,
                        (&c, &now),
                        (&mut acting, &mut points),
                        &mut stored,
                    );
                    (acting, energies)
                }
            };
            let forces = acting.forces(&c, (&now, self.chunk.offset));
            for k in 0..batch.len() {
                stored.strain += strain.lanes()[k];
                stored.hourglass += hourglass.lanes()[k];
            }
            for (k, nodes) in batch.iter().enumerate() {
                for (&node, [force, moment]) in nodes.iter().zip(&forces) {
                    let sum = &mut self.f[node as usize];
                    for i in 0..3 {
                        sum[i] += force[i].lanes()[k];
                        sum[3 + i] += moment[i].lanes()[k];
                    }
                }
            }
        }
        stored
    }
}

impl Sweep<'_> {
    /// Places of the nodes and rows of their rotations; a short batch repeats its last element.
    #[inline(always)]
    fn gathered<T: Number>(
        &self,
        batch: &[[u32; MOST]],
        zero: T,
    ) -> ([Vector<T>; MOST], [[Vector<T>; 3]; MOST]) {
        let mut x = [[zero; 3]; MOST];
        let mut turned = [[[zero; 3]; 3]; MOST];
        for k in 0..zero.lanes().len() {
            let nodes = &batch[k.min(batch.len() - 1)];
            for a in 0..MOST {
                let state = &self.states[nodes[a] as usize];
                for i in 0..3 {
                    x[a][i].lanes_mut()[k] = state[i];
                    for j in 0..3 {
                        turned[a][i][j].lanes_mut()[k] = state[3 + 3 * i + j];
                    }
                }
            }
        }
        (x, turned)
    }

    /// Membrane forces and moments of points through the thickness, several heights side by side where a register has fewer lanes.
    #[inline(always)]
    fn flow<T: Number>(
        &mut self,
        layers: &Layers,
        (first, count): (usize, usize),
        (c, now): (&Constants<T>, &Now<T>),
        (acting, points): (&mut Acting<T>, &mut PlaneStressPoints),
        stored: &mut Stored,
    ) {
        let (lanes, kept) = (c.area.lanes().len(), layers.kept());
        let of_element = layers.history_len();
        for (start, some) in layers.groups(SIDE / lanes) {
            let law = some.first().map_or(0, |station| station.law);
            let own = layers.kept_by(law);
            for (place, station) in some.iter().enumerate() {
                let point = start + place;
                let z = c.thickness.scale(station.height);
                for i in 0..3 {
                    let strain = now.curvature[i].mul_add(z, now.membrane[i]);
                    points.strain[i][place * lanes..][..lanes].copy_from_slice(strain.lanes());
                }
                for k in 0..lanes {
                    let from = (first + k.min(count - 1)) * of_element + point * kept;
                    for (row, old) in points.old.iter_mut().zip(&self.old[from..from + own]) {
                        row[place * lanes + k] = *old;
                    }
                }
            }
            layers.side_by_side(law, self.dt, points);
            for (place, station) in some.iter().enumerate() {
                let point = start + place;
                let z = c.thickness.scale(station.height);
                let volume = (c.thickness * c.area).scale(station.weight);
                for i in 0..3 {
                    let mut stress = c.area;
                    let found = &points.stress[i][place * lanes..][..lanes];
                    stress.lanes_mut().copy_from_slice(found);
                    let force = stress * volume;
                    acting.membrane[i] += force;
                    acting.bending[i] += force * z;
                }
                for k in 0..count {
                    let at = place * lanes + k;
                    let volume = volume.lanes()[k];
                    let [strain, hardening, dissipated] = points.energies.map(|row| row[at]);
                    stored.strain += volume * strain;
                    stored.hardening += volume * hardening;
                    stored.dissipated += volume * dissipated;
                    let from = (first + k) * of_element + point * kept;
                    for (row, new) in points.new.iter().zip(&mut self.new[from..from + own]) {
                        *new = row[at];
                    }
                }
            }
        }
    }
}
