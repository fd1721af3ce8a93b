//! Taylor's bar: a copper cylinder thrown against a rigid wall.
//!
//! Problem: length 32.4 mm, radius 3.2 mm, 227 m/s, no friction; E = 117 GPa, ν = 0.35, ρ = 8930 kg/m³, J2 plasticity with
//! yield stress 400 MPa and linear hardening of 100 MPa; mean dilatation in 4-node quadrilaterals (axisymmetric) and in
//! 8-node hexahedra (a quarter of the bar between planes of symmetry), the velocity law at the nodes of the foot, theta's
//! scheme and central differences, 80 µs.
//! Closed solution: none. Published: the spread of results (length 21.2 to 21.6 mm, radius of the foot 6.8 to
//! 7.3 mm, largest plastic strain 2.5 to 3.3), as the issue states it. The strain, taken as the mean over the element at the
//! centre of the foot, depends on the mesh: it is 2.9 with elements of 0.8 mm there, 3.2 with the 0.64 mm of this check, 3.4
//! with 0.53 mm and 3.9 with 0.27 mm, where the radius is 7.33 mm; the length is the same to 0.05 mm.
//! Tolerance: the spread itself. Facts beside it, all but the last to round-off:
//! - The ledger closes: where the step is explicit to round-off, where it is iterated to 1e-9, as the issue states.
//! - The plastic work in it is ∫ σ_y ε_p dV of the strains at the end, and what hardening stores not below ½ H ε_p² of the
//!   mean strains of the elements.
//! - At the axis the principal axes do not turn, so that the plastic strain, the length of a path, is not below the change of
//!   shape 2/3 (ln λ_r - ln λ_z) of the element there, its chord, but for the elastic strain of 0.005 and for what the mean
//!   over the element leaves: 1 %. Under theta, which damps the waves of the impact, it is no longer either; under central
//!   differences the foot yields to and fro in the first 10 µs, which makes it 2 % longer.
//!
//! What the scheme and the impact of the lumped masses of the foot (1 % of the bar) take, 1 to 2 % of the energy each, are
//! regressions, to 1 % of the figure.
//! Sizes: quick, axisymmetric: theta to the end, central differences for the first 20 µs; full, all four to the end.

use carom_bodies::{BodySpec, Formulation, Kinematics};
use carom_dynamics::{Driver, Model, ModelBody, Scheme, Support};
use carom_materials::{Elastic, J2Plasticity, Law};
use carom_mesh::{Mesh, generate};

use crate::Error;
use crate::build::{CENTRAL, HALF, contact, group, plane, support, surface, theta};
use crate::check::{Check, Row, Size};
use crate::meshes;

const COPPER: J2Plasticity = J2Plasticity {
    initial: Elastic {
        density: 8930.0,
        young: 117e9,
        poisson: 0.35,
    },
    yield_stress: 400e6,
    hardening: 100e6,
};
const LENGTH: f64 = 32.4e-3;
const RADIUS: f64 = 3.2e-3;
const SPEED: f64 = 227.0;
pub(crate) const END: f64 = 80e-6;

/// A bar that has hit the wall.
pub(crate) struct Bar {
    pub(crate) newton: Driver,
    /// Axis of the bar.
    axis: usize,
    top: Vec<u32>,
    foot: Vec<u32>,
}

impl Bar {
    /// Axisymmetric, 5 by 50 equal quadrilaterals, of copper.
    fn plane(scheme: Scheme, dt: f64) -> Result<Bar, Error> {
        Bar::axisymmetric((Law::J2Plasticity(COPPER), SPEED), scheme, dt)
    }

    /// The same of a law at a speed, m/s.
    pub(crate) fn axisymmetric(thrown: (Law, f64), scheme: Scheme, dt: f64) -> Result<Bar, Error> {
        let mesh = generate::rectangle("bar", [0.0; 2], [RADIUS, LENGTH], [5, 50], false);
        let supports = vec![support(&mesh, "bar.left", [true, false, false])?];
        let sides = ["bar.bottom", "bar.top"];
        Bar::new((mesh, sides, supports), thrown, scheme, dt)
    }

    /// A quarter in space, of 12 by 20 hexahedra.
    fn solid(scheme: Scheme, dt: f64) -> Result<Bar, Error> {
        let mut mesh = meshes::mesh("taylor-bar/bar-solid-coarse.msh")?;
        mesh.scale(1e-3);
        let supports = vec![
            support(&mesh, "bar.mirror-x", [true, false, false])?,
            support(&mesh, "bar.mirror-y", [false, true, false])?,
        ];
        let sides = ["bar.foot", "bar.top"];
        let thrown = (Law::J2Plasticity(COPPER), SPEED);
        Bar::new((mesh, sides, supports), thrown, scheme, dt)
    }

    fn new(
        (mesh, [foot, top], supports): (Mesh, [&str; 2], Vec<Support>),
        (law, speed): (Law, f64),
        scheme: Scheme,
        dt: f64,
    ) -> Result<Bar, Error> {
        let axis = mesh.dim - 1;
        let mut velocity = [0.0; 3];
        velocity[axis] = -speed;
        let body = ModelBody {
            velocity,
            ..ModelBody::new(BodySpec {
                formulation: Formulation::BBar,
                ..BodySpec::new(
                    "bar",
                    group(&mesh, "bar")?.elements.clone(),
                    match mesh.dim {
                        2 => Kinematics::Axisymmetric,
                        _ => Kinematics::Solid,
                    },
                    law,
                )
            })
        };
        let wall = contact(surface(&mesh, foot, &body)?, plane(axis, 1.0), HALF);
        let nodes = |name: &str| Ok::<_, Error>(mesh.group_nodes(group(&mesh, name)?));
        let (foot, top) = (nodes(foot)?, nodes(top)?);
        let system = crate::witness::system(Model {
            supports,
            contacts: vec![wall],
            ..Model::new(vec![body], mesh, scheme, dt)
        })?;
        Ok(Bar {
            newton: Driver::new(system)?,
            axis,
            top,
            foot,
        })
    }

    pub(crate) fn run(mut self, end: f64) -> Result<Bar, Error> {
        while self.newton.state().time < end * (1.0 - 1e-9) {
            self.newton.step()?;
        }
        Ok(self)
    }

    /// Where a node of the mesh is, m.
    fn place(&self, node: u32) -> [f64; 3] {
        let (system, u) = (self.newton.system(), &self.newton.state().motion.u);
        let node = system.number[node as usize] as usize;
        let mut place = system.x[node];
        for (x, u) in place
            .iter_mut()
            .zip(&u[system.unknowns.translations_of(node as u32)])
        {
            *x += u;
        }
        place
    }

    fn length(&self) -> f64 {
        let places = self.top.iter().map(|&node| self.place(node)[self.axis]);
        places.fold(0.0, f64::max)
    }

    /// From the lowest node of the foot to the highest of the top, m: of a bar that may have left the wall.
    pub(crate) fn height(&self) -> f64 {
        let places = self.foot.iter().map(|&node| self.place(node)[self.axis]);
        self.length() - places.fold(f64::INFINITY, f64::min)
    }

    pub(crate) fn radius(&self) -> f64 {
        let places = self.foot.iter().map(|&node| self.place(node));
        let radius = |x: [f64; 3]| x[0].hypot(if self.axis == 1 { 0.0 } else { x[1] });
        places.map(radius).fold(0.0, f64::max)
    }

    /// Plastic strain of the elements, and the volumes that they had at the start, m³.
    pub(crate) fn strains(&self) -> Vec<(f64, f64)> {
        let (system, state) = (self.newton.system(), self.newton.state());
        let body = &system.bodies[0];
        let mut start = vec![0.0; body.history_len()];
        body.start_history(&mut start);
        let volumes = body.stresses(&vec![0.0; system.unknowns()], &start);
        let strains = body
            .plastic_strains(&state.motion.history)
            .unwrap_or_default();
        let pairs = strains.into_iter().zip(volumes);
        pairs
            .map(|(strain, (volume, _))| (strain, volume))
            .collect()
    }

    /// Plastic strain of the element at the centre of the foot over its change of shape 2/3 (ln λ_r - ln λ_z), axisymmetric.
    fn path(&self) -> f64 {
        let cell = self.newton.system().bodies[0].cells()[0];
        let nodes = self.newton.system().mesh.element_nodes(cell);
        let [one, two, three, four] = [0, 1, 2, 3].map(|k| self.place(nodes[k]));
        let radial = 0.5 * (two[0] + three[0]) / (RADIUS / 5.0);
        let axial = 0.5 * (four[1] - one[1] + three[1] - two[1]) / (LENGTH / 50.0);
        self.strains()[0].0 / (2.0 / 3.0 * (radial / axial).ln())
    }
}

/// The ledger. `closes`: largest residual over the energy at the start; `scheme`, `impact`: what the scheme dissipated and what the
/// impact of the nodes took when it was first run, over the same.
fn balance(name: &str, bar: &Bar, closes: f64, [scheme, impact]: [f64; 2]) -> Vec<Row> {
    let ledger = &bar.newton.state().ledger;
    let (start, now) = (ledger.initial.energy(), &ledger.balance);
    let row = |what: &str| format!("{name}: {what}");
    let strains = bar.strains();
    let sum = |f: &dyn Fn(f64) -> f64| strains.iter().map(|(e, v)| v * f(*e)).sum::<f64>();
    let plastic = sum(&|strain| COPPER.yield_stress * strain);
    let hardened = sum(&|strain| 0.5 * COPPER.hardening * strain * strain);
    vec![
        Row::at_most(
            row("energy residual / E0"),
            ledger.largest_energy_residual / start,
            closes,
        ),
        Row::near(
            row("plastic work / that of the strains"),
            now.dissipation_material / plastic,
            1.0,
            1e-10,
        ),
        Row::at_least(
            row("stored by hardening / that of the mean strains"),
            now.hardening / hardened,
            1.0,
        ),
        Row::relative(
            row("dissipation of the scheme / E0"),
            now.dissipation_scheme / start,
            scheme,
            0.01,
        )
        .regression(),
        Row::relative(
            row("loss at the impact of the nodes / E0"),
            -now.work_contact / start,
            impact,
            0.01,
        )
        .regression(),
    ]
}

/// The bar at the end.
fn shape(name: &str, bar: &Bar) -> Vec<Row> {
    let row = |what: &str| format!("{name}: {what}");
    let strain = bar
        .strains()
        .iter()
        .fold(0.0, |m: f64, (strain, _)| m.max(*strain));
    vec![
        Row::near(row("length, mm"), bar.length() * 1e3, 21.4, 0.2).published(),
        Row::near(
            row("radius of the foot, mm"),
            bar.radius() * 1e3,
            7.05,
            0.25,
        )
        .published(),
        Row::near(row("largest plastic strain"), strain, 2.9, 0.4).published(),
    ]
}

const IMPLICIT: f64 = 1e-9;
const EXPLICIT: f64 = 1e-13;

pub(crate) const CHECK: Check = Check {
    name: "taylor-bar",
    fact: "a copper bar that hits a wall takes the published shape, implicit and explicit, in the plane and in space, and its ledger closes",
    run: |size| {
        let step = 0.2e-6;
        let implicit = Bar::plane(theta(0.55), step)?.run(END)?;
        let mut rows = shape("quad4, theta", &implicit);
        rows.extend(balance(
            "quad4, theta",
            &implicit,
            IMPLICIT,
            [0.0141771, 0.0159246],
        ));
        rows.push(Row::near(
            "quad4, theta: plastic strain at the centre of the foot / change of shape",
            implicit.path(),
            1.0,
            0.01,
        ));
        let explicit = Bar::plane(CENTRAL, 0.05e-6)?.run(match size {
            Size::Quick => 0.25 * END,
            Size::Full => END,
        })?;
        let scheme = match size {
            Size::Quick => -5.81432e-4,
            Size::Full => -5.81758e-4,
        };
        let taken = [scheme, 0.0118089];
        rows.extend(balance(
            "quad4, central differences",
            &explicit,
            EXPLICIT,
            taken,
        ));
        if size == Size::Quick {
            return Ok(rows);
        }
        rows.extend(shape("quad4, central differences", &explicit));
        rows.push(Row::at_least(
            "quad4, central differences: plastic strain at the centre of the foot / change of shape",
            explicit.path(),
            0.99,
        ));
        let implicit = Bar::solid(theta(0.55), step)?.run(END)?;
        rows.extend(shape("hex8, theta", &implicit));
        rows.extend(balance(
            "hex8, theta",
            &implicit,
            IMPLICIT,
            [0.0141830, 0.0177359],
        ));
        let explicit = Bar::solid(CENTRAL, 0.05e-6)?.run(END)?;
        rows.extend(shape("hex8, central differences", &explicit));
        rows.extend(balance(
            "hex8, central differences",
            &explicit,
            EXPLICIT,
            [-4.85070e-4, 0.0145465],
        ));
        Ok(rows)
    },
};
