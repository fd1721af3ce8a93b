//! Quadrilaterals with one point and a stiffness against the motions that it does not see, for explicit steps.
//!
//! With x = x_m + r g_r + s g_s + r s x_h, the directors alike, strains are those at the centre: membrane ½ g_α·g_β, curvature g_α·d_β and shear, the mean of the
//! edges, g_r·d_m + x_h·d_s and g_s·d_m + x_h·d_r, each less its value at the start. What one point does not see is linear in the parent cell:
//!
//! * in the plane m_α = g_α·(x_h - c_r g_r - c_s g_s), the stretch along α that grows across;
//! * of bending b_α = g_α·(d_h - c_r d_r - c_s d_s);
//! * of shear, edges against each other, η_r = g_r·d_s + x_h·d_m and η_s = g_s·d_r + x_h·d_m,
//!
//! with X_h = c_r G_r + c_s G_s and its part across both. All vanish in rigid motions and, in a flat element, for constant strains and constant moments. They are held
//! by κ times the energy that they have in a parallelogram: over the area A, with the length L_α = |G_α|,
//!
//! ½ κ A/3 Σ_α (E h (m_α/L_α²)² + E h³/12 (b_α/L_α²)² + 5/6 G h (η_α/L_α)²),
//!
//! so that κ = 1 bends a parallelogram in its plane exactly. The patterns are those of Belytschko, Lin and Tsay (1984), Comput. Methods Appl. Mech. Eng. 42, 225, the stiffness that of an assumed strain
//! (Belytschko and Leviathan 1994, Comput. Methods Appl. Mech. Eng. 113, 321); there rates in axes that turn with the element, here total strains with directors. With directors that
//! turn with the nodes a warped element needs no correction. Each node is held against the rotation of the centre about the normal.

use carom_algebra::tensor::Vec3;

use super::products::{ALONG_R, ALONG_S, CROSSED, Configuration, DIRECTOR, MOST, Row, Rows};
use super::section::{AtPoint, ElasticSection, STRAINS};
use super::tying::{self, Covariant, Point};

/// What the strains at the centre are made with.
#[derive(Clone, Copy, Debug)]
pub(super) struct Centre {
    /// m².
    pub area: f64,
    /// Derivatives along both axes from those by r and s, 1/m.
    pub to: [[f64; 2]; 2],
    /// c_r and c_s.
    pub twist: [f64; 2],
    /// L_r and L_s, m.
    pub lengths: [f64; 2],
}

impl Centre {
    pub(super) fn new(reference: &Configuration, along: &Vec3) -> Centre {
        let (area, to) = tying::axes(reference, MOST, &tying::shapes(MOST, [0.0; 2]), along);
        let length = |by: &[f64; MOST]| {
            let sum: Vec3 = reference.x.iter().zip(by).map(|(x, by)| x * *by).sum();
            sum.norm()
        };
        Centre {
            area: 4.0 * area,
            to,
            twist: tying::twist(reference),
            lengths: [length(&ALONG_R), length(&ALONG_S)],
        }
    }

    /// The strains at the centre, with the rotation of the first node about the normal; what else has energy follows in three more lists.
    pub(super) fn rows(&self) -> (Point, [Rows; MOST - 1]) {
        let at = tying::shapes(MOST, [0.0; 2]);
        let half = |a: &[f64; MOST], b: &[f64; MOST]| Row::half_metric(MOST, a, b);
        let edges = |along: usize, sign: f64| {
            let places = match along {
                0 => [[0.0, 1.0], [0.0, -1.0]],
                _ => [[1.0, 0.0], [-1.0, 0.0]],
            };
            let [plus, minus] = places.map(|place| tying::shear_at(MOST, place, along));
            Row::sum(&[(0.5, &plus), (0.5 * sign, &minus)])
        };
        let covariant = Covariant {
            membrane: [
                half(&ALONG_R, &ALONG_R),
                half(&ALONG_S, &ALONG_S),
                half(&ALONG_R, &ALONG_S),
            ],
            shear: [edges(0, 1.0), edges(1, 1.0)],
        };
        let by = self
            .to
            .map(|to| std::array::from_fn(|a| to[0] * ALONG_R[a] + to[1] * ALONG_S[a]));
        let mut rows = tying::local(MOST, (&at.n, &by), &covariant, &self.to);
        rows[STRAINS - 1] = drilling(&by, 0);
        let [c_r, c_s] = self.twist;
        let unseen: [f64; MOST] =
            std::array::from_fn(|a| CROSSED[a] - c_r * ALONG_R[a] - c_s * ALONG_S[a]);
        let rest = [1, 2, 3].map(|node| {
            let mut rows: [Row; STRAINS] = std::array::from_fn(|_| Row::default());
            rows[STRAINS - 1] = drilling(&by, node);
            if node == 1 {
                for (i, along) in [ALONG_R, ALONG_S].iter().enumerate() {
                    let (length, square) = (self.lengths[i], self.lengths[i].powi(2));
                    rows[i].add(2.0 / square, &half(along, &unseen));
                    let bent = Row::with_axis(MOST, along, (DIRECTOR, &unseen));
                    rows[3 + i].add(1.0 / square, &bent);
                    rows[6 + i].add(1.0 / length, &edges(i, -1.0));
                }
            }
            Rows::new(&rows)
        });
        let point = Point {
            rows,
            area: self.area,
            shapes: at.n,
            by,
        };
        (point, rest)
    }
}

/// ¼ (x,₁·t₂ - x,₂·t₁) with the axes of a node: a quarter of the area is its own, so that its square over the whole area is that of ½ over a quarter.
fn drilling(by: &[[f64; MOST]; 2], node: usize) -> Row {
    let mut own = [0.0; MOST];
    own[node] = 1.0;
    Row::sum(&[
        (0.25, &Row::with_axis(MOST, &by[0], (1, &own))),
        (-0.25, &Row::with_axis(MOST, &by[1], (0, &own))),
    ])
}

/// Stiffness against what one point does not see.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hourglass {
    /// Of membrane, bending and shear, J.
    pub stiffness: [f64; 3],
    /// Of rotations about the normal, J.
    pub drilling: f64,
}

impl Hourglass {
    /// `factor`: κ.
    pub(super) fn new(section: &ElasticSection, area: f64, factor: f64) -> Hourglass {
        let [stretch, bending, shear] = section.uniaxial();
        let part = factor * area / 3.0;
        Hourglass {
            stiffness: [part * stretch, part * bending, part * shear],
            drilling: area * section.drilling,
        }
    }

    /// The stiffness of each number of the lists after that of the centre; diagonal.
    pub(super) fn diagonals(&self) -> [AtPoint; MOST - 1] {
        let [m, b, s] = self.stiffness;
        let alone = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, self.drilling];
        [[m, m, 0.0, b, b, 0.0, s, s, self.drilling], alone, alone]
    }

    /// Adds the forces on the lists after that of the centre, and returns their energy and that without rotations about the normal, J.
    pub(super) fn force(
        &self,
        strains: &[AtPoint; MOST],
        forces: &mut [AtPoint; MOST],
    ) -> [f64; 2] {
        let (mut all, mut turning) = (0.0, 0.0);
        let lists = self.diagonals();
        for ((stiffness, strain), force) in lists.iter().zip(&strains[1..]).zip(&mut forces[1..]) {
            for k in 0..STRAINS {
                force[k] = stiffness[k] * strain[k];
                all += 0.5 * force[k] * strain[k];
            }
            turning += 0.5 * force[STRAINS - 1] * strain[STRAINS - 1];
        }
        [all, all - turning]
    }
}
