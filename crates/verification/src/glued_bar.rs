//! One bar of which a part is a finer zone of its own, glued to the rest over a volume: E = ρ = A = 1, so that c = Z = 1.

use carom_arlequin::{Coupling, Model as Side, Models, Overlap, Region, Weighting};
use carom_bodies::{CellWeights, Kinematics};
use carom_dynamics::{Driver, Model, ModelLink, Scheme, Support};
use carom_materials::Elastic;
use carom_mesh::{Mesh, generate};
use carom_zones::{LinkKind, ModelZone, Zoned, Zones};

use crate::Error;
use crate::build::{CENTRAL, body, group, support, theta};

/// A bar from 0 on: the fine zone, an overlap, the coarse rest. Lengths in sizes of the coarse elements, which is 1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GluedBar {
    /// Coarse elements along the fine zone, the overlap included.
    pub(crate) zone: usize,
    /// Coarse elements in the overlap.
    pub(crate) overlap: usize,
    /// Coarse elements along the bar.
    pub(crate) length: usize,
    /// Fine elements to a coarse one.
    pub(crate) ratio: usize,
    /// Schemes of the fine zone and of the rest.
    pub(crate) schemes: [Scheme; 2],
    /// Outer step times c over the size of the coarse elements.
    pub(crate) courant: f64,
    /// Inner steps to an outer one.
    pub(crate) substeps: u32,
    /// How multipliers run.
    pub(crate) kind: LinkKind,
    /// Weights.
    pub(crate) weighting: Weighting,
    /// Mediator and bracket.
    pub(crate) coupling: Coupling,
    /// Whether the far ends are held.
    pub(crate) held: bool,
}

impl GluedBar {
    /// A fine zone of 40 with an overlap of 4, four fine elements to a coarse one, theta ½ inside, central differences
    /// outside, one step of 0.5, linear weights, coarse L2 mediator, free ends.
    pub(crate) fn usual(length: usize) -> GluedBar {
        GluedBar {
            zone: 40,
            overlap: 4,
            length,
            ratio: 4,
            schemes: [theta(0.5), CENTRAL],
            courant: 0.5,
            substeps: 1,
            kind: LinkKind::GravouilCombescure,
            weighting: Weighting::default(),
            coupling: Coupling::default(),
            held: false,
        }
    }

    fn mesh(&self) -> Result<Mesh, Error> {
        let part = |name: &str, from: usize, to: usize, ratio: usize| {
            let [from, to, n] = [from, to, ratio * (to - from)].map(|x| x as f64);
            generate::line(name, [from, 0.0, 0.0], [to, 0.0, 0.0], n as usize, 1)
        };
        let mut mesh = part("fine", 0, self.zone, self.ratio);
        let rest = part("coarse", self.zone - self.overlap, self.length, 1);
        mesh.merge("bar", rest)?;
        Ok(mesh)
    }

    /// The model in zones: the fine one, then the rest.
    pub(crate) fn zoned(&self) -> Result<Zoned, Error> {
        let mesh = self.mesh()?;
        let material = Elastic {
            density: 1.0,
            young: 1.0,
            poisson: 0.0,
        };
        let [inner, outer] = ["fine", "coarse"].map(|name| group(&mesh, name));
        let models = Models {
            mesh: &mesh,
            inner: &inner?.elements,
            outer: &outer?.elements,
        };
        let overlap = Overlap::new(models, &Region::Intersection)?;
        let weights = overlap.weights(&self.weighting)?;
        let mut bodies = Vec::new();
        for (name, side, weights) in [
            ("fine", Side::Inner, weights.inner),
            ("coarse", Side::Outer, weights.outer),
        ] {
            let mut part = body(&mesh, name, Kinematics::Bar { area: 1.0 }, material)?;
            part.spec.cells = overlap.cells(side).to_vec();
            part.spec.weights = Some(CellWeights {
                inertia: weights.inertia,
                stiffness: weights.stiffness,
            });
            bodies.push(part);
        }
        let rows = overlap.rows(&self.coupling)?.rows;
        let supports = match self.held {
            true => ["fine.left", "coarse.right"]
                .into_iter()
                .map(|end| support(&mesh, end, [true; 3]))
                .collect::<Result<Vec<Support>, Error>>()?,
            false => Vec::new(),
        };
        let zone = |name: &str, body, scheme, substeps| {
            ModelZone::new(name, vec![body], (scheme, substeps))
        };
        Ok(Zoned {
            zones: vec![
                zone("fine", 0, self.schemes[0], self.substeps),
                zone("coarse", 1, self.schemes[1], 1),
            ],
            links: vec![ModelLink {
                name: "bar".to_string(),
                zones: [0, 1],
                rows,
            }],
            kind: self.kind,
            model: Model {
                supports,
                ..Model::new(bodies, mesh, theta(0.5), self.courant)
            },
        })
    }
}

/// Displacement and velocity of each zone from those at a place.
pub(crate) fn motion(zones: &Zones, field: impl Fn(f64) -> [f64; 2]) -> Vec<[Vec<f64>; 2]> {
    let of = |driver: &Driver| {
        [0, 1].map(|k| driver.system().x.iter().map(|x| field(x[0])[k]).collect())
    };
    zones.drivers().iter().map(of).collect()
}

/// Displacement and velocity of the pulse v = exp(-((x - x0)/w)²) that runs to the right: u' = -v.
pub(crate) fn pulse(x0: f64, width: f64) -> impl Fn(f64) -> [f64; 2] {
    move |x| {
        let s = (x - x0) / width;
        [-width * gauss(s), (-s * s).exp()]
    }
}

/// ∫ exp(-t²) dt from 0 to s, by Simpson's rule with intervals of 0.02 at most: to 1e-9.
fn gauss(s: f64) -> f64 {
    const HALVES: usize = 320;
    let h = s.clamp(-6.0, 6.0) / HALVES as f64;
    let term = |i: usize| {
        let factor = match i {
            0 | HALVES => 1.0,
            i => 2.0 + 2.0 * (i % 2) as f64,
        };
        factor * (-(i as f64 * h).powi(2)).exp()
    };
    (0..=HALVES).map(term).sum::<f64>() * h / 3.0
}

/// Energy of the characteristics (v + u')/2, which runs to the left, and (v - u')/2, in the elements of a zone whose
/// middle lies from `from` to `to`: ∫ ((v ± u')/2)² dx, twice of which is their part of ½∫(v² + u'²) dx.
pub(crate) fn characteristics(driver: &Driver, from: f64, to: f64) -> [f64; 2] {
    let (x, motion) = (&driver.system().x, &driver.state().motion);
    let mut energies = [0.0; 2];
    driver.system().bodies[0].each_element(&mut |nodes| {
        let [a, b] = [nodes[0] as usize, nodes[1] as usize];
        let (size, middle) = (x[b][0] - x[a][0], 0.5 * (x[a][0] + x[b][0]));
        if middle > from && middle < to {
            let strain = (motion.u[b] - motion.u[a]) / size;
            let v = 0.5 * (motion.v[a] + motion.v[b]);
            for (energy, sign) in energies.iter_mut().zip([1.0, -1.0]) {
                *energy += size * (0.5 * (v + sign * strain)).powi(2);
            }
        }
    });
    energies
}
