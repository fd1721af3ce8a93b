//! Blocks on meshes that do not match strike like bars.
//!
//! Problem: two blocks of side 1 m meet squarely with ν = 0, elements of the same length along the way but other numbers
//! across; all sides free, in plane strain and in space. At small strain bar waves of 2 m/s and speeds of ±1 m/s; St
//! Venant-Kirchhoff with ±0.1 m/s. Lumped mass, Courant number ½, Newmark (0.49, 0.9) with the displacement law or theta ½
//! with the velocity law, for the whole contact and the time after it. The trapezoid is not in the list: with the
//! displacement law it feeds differences between the columns, and rounding grows to 1e-8 of the pressure in 100 steps.
//!
//! Closed solution: every column moves as the one-dimensional bar with the same elements, since nothing moves across; the
//! pressure is uniform. The bar at small strain is of bar2 elements; that of St Venant-Kirchhoff is one
//! column of the same elements on matching meshes, with one contact point per node. Mortar integration transfers uniform
//! pressure exactly: the contact forces agree step by step to 1e-9 of the largest, rounding with the steps in which it may
//! grow. The bar is a run of Carom too, a second formulation. Collocation at nodes does not transfer it; its error is shown.

use carom_bodies::Kinematics;
use carom_contact::{Basis, Integration, Law};
use carom_dynamics::{Driver, Model, ModelTarget, Nonlinear, Scheme};
use carom_materials::{Elastic, Law as Material, StVenantKirchhoff};
use carom_mesh::{Mesh, generate};

use crate::Error;
use crate::build::{DISPLACEMENT, NOW, body, contact, newmark, surface, theta};
use crate::check::{Check, Row, Size};

const SOFT: Elastic = Elastic {
    density: 2.0,
    young: 8.0,
    poisson: 0.0,
};
const FINITE: Material = Material::StVenantKirchhoff(StVenantKirchhoff { initial: SOFT });
const THICKNESS: f64 = 0.5;
const MORTARS: [Integration; 2] = [
    Integration::Mortar {
        basis: Basis::Standard,
    },
    Integration::Mortar { basis: Basis::Dual },
];

/// Two blocks, or bars in one dimension.
#[derive(Clone, Copy)]
struct Blocks {
    dim: usize,
    /// Elements along the way and across each of the blocks.
    along: usize,
    across: [usize; 2],
    material: Material,
    integration: Integration,
    scheme: Scheme,
    law: Law,
}

impl Blocks {
    fn mesh(&self) -> Result<Mesh, Error> {
        let m = self.along;
        let block = |name: &str, low: f64, n: usize| match self.dim {
            1 => generate::line(name, [low, 0.0, 0.0], [low + 1.0, 0.0, 0.0], m, 1),
            2 => generate::rectangle(name, [low, 0.0], [1.0; 2], [m, n], false),
            _ => generate::box_(name, [low, 0.0, 0.0], [1.0; 3], [m, n, n + 1], false),
        };
        let mut mesh = block("striker", 0.0, self.across[0]);
        mesh.merge("target", block("target", 1.0, self.across[1]))?;
        Ok(mesh)
    }

    fn speed(&self) -> f64 {
        match self.material {
            FINITE => 0.1,
            _ => 1.0,
        }
    }

    fn model(&self) -> Result<Model, Error> {
        let mesh = self.mesh()?;
        let kinematics = match self.dim {
            1 => Kinematics::Bar { area: THICKNESS },
            2 => Kinematics::PlaneStrain {
                thickness: THICKNESS,
            },
            _ => Kinematics::Solid,
        };
        let mut bodies = Vec::new();
        for (name, sign) in [("striker", 1.0), ("target", -1.0)] {
            let mut body = body(&mesh, name, kinematics, SOFT)?;
            body.spec.material = self.material;
            body.velocity[0] = sign * self.speed();
            bodies.push(body);
        }
        let right = surface(&mesh, "striker.right", &bodies[0])?;
        let left = ModelTarget::Surface(surface(&mesh, "target.left", &bodies[1])?);
        let mut joint = contact(right, left, self.law);
        joint.integration = self.integration;
        let mut nonlinear = Nonlinear::default();
        nonlinear.iteration.tolerance = 1e-13;
        Ok(Model {
            contacts: vec![joint],
            nonlinear,
            ..Model::new(bodies, mesh, self.scheme, 0.25 / self.along as f64)
        })
    }

    /// Contact force per area by step, Pa.
    fn pressures(&self) -> Result<Vec<f64>, Error> {
        let system = crate::witness::system(self.model()?)?;
        let area = if self.dim == 3 { 1.0 } else { THICKNESS };
        let mut run = Driver::new(system)?;
        // 2 L / c = 1 s
        let steps = 5 * self.along;
        let mut pressures = Vec::with_capacity(steps);
        for _ in 0..steps {
            run.step()?;
            pressures.push(run.report().contacts[0].force / area);
        }
        Ok(pressures)
    }

    /// Largest difference of the pressures from those of the bar, relative to the largest.
    fn error(&self, bar: &[f64]) -> Result<f64, Error> {
        let found = self.pressures()?;
        let largest = bar.iter().fold(0.0_f64, |m, p| m.max(*p));
        let differences = bar.iter().zip(&found).map(|(a, b)| (a - b).abs());
        Ok(differences.fold(0.0, f64::max) / largest)
    }
}

/// Rows of one scheme and law.
fn rows(size: Size, (name, scheme, law): (&str, Scheme, Law)) -> Result<Vec<Row>, Error> {
    let mut rows = Vec::new();
    let bar = Blocks {
        dim: 1,
        along: match size {
            Size::Quick => 6,
            Size::Full => 14,
        },
        across: [1, 1],
        material: SOFT.into(),
        integration: Integration::Node,
        scheme,
        law,
    };
    let column = Blocks {
        dim: 2,
        material: FINITE,
        ..bar
    };
    let [small, finite] = [bar.pressures()?, column.pressures()?];
    // p = ρ c v of equal bars
    let plateau = SOFT.density * 2.0 * bar.speed();
    let mean = small[..small.len() * 4 / 5].iter().sum::<f64>() / (0.8 * small.len() as f64);
    // so that it is an impact: on six elements fronts are spread over more than one
    rows.push(Row::near(
        format!("{name}: mean pressure of the bar / ρ c v"),
        mean / plateau,
        1.0,
        0.15,
    ));
    for dim in [2, 3] {
        let across = match size {
            Size::Quick => [3, 2],
            Size::Full => [5, 3],
        };
        let blocks = Blocks { dim, across, ..bar };
        let cases = [
            ("small strain", SOFT.into(), &small),
            ("St Venant-Kirchhoff", FINITE, &finite),
        ];
        for (which, material, reference) in cases {
            let name = format!("{name}, {dim}D, {which}");
            let of = |integration| Blocks {
                material,
                integration,
                ..blocks
            };
            let mut worst = 0.0_f64;
            for integration in MORTARS {
                worst = worst.max(of(integration).error(reference)?);
            }
            rows.push(
                Row::at_most(format!("{name}, mortar: pressure, error"), worst, 1e-9)
                    .second_formulation(),
            );
            // collocated points of flush rims face something or nothing with the last digit of iterations
            if law == DISPLACEMENT && material == FINITE {
                continue;
            }
            let nodes = of(Integration::Node).error(reference)?;
            let name = format!("{name}, nodes: pressure, error");
            rows.push(Row::shown(name, nodes));
        }
    }
    Ok(rows)
}

pub(crate) const CHECK: Check = Check {
    name: "blocks-as-bars",
    fact: "blocks on meshes that do not match strike like the one-dimensional bar: mortar to 1e-9, nodes with their error",
    run: |size| {
        let mut all = Vec::new();
        for of in [
            (
                "Newmark (0.49, 0.9), displacement law",
                newmark(0.49, 0.9),
                DISPLACEMENT,
            ),
            ("theta 0.5, velocity law", theta(0.5), NOW),
        ] {
            all.extend(rows(size, of)?);
        }
        Ok(all)
    },
};
