//! Runs that are not linear: what they leave behind beside the rest.

use std::fs;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use carom_bodies::{BodySpec, Kinematics};
use carom_contact::law::Displacement;
use carom_contact::{Law, Plane, Sliding};
use carom_dynamics::scheme::{EnergyMomentum, Newmark};
use carom_dynamics::{Driver, Model, ModelBody, ModelContact, ModelTarget, Scheme, System, march};
use carom_materials::{Elastic, J2Plasticity, Law as Material, NeoHooke};
use carom_mesh::{Surface, generate};
use carom_output::{Ending, Grade, Results, Settings, Summary};

use crate::grids;
use crate::models;
use crate::runs::{Reports, collection, columns};

const RUBBER: Elastic = Elastic {
    density: 1000.0,
    young: 1e6,
    poisson: 0.3,
};

/// A block of 3 cells a side over a rigid floor at y = 0, 1 m high.
fn block(dim: usize, material: Material, velocity: [f64; 3], floor: bool) -> Arc<System> {
    // plasticity has no stress between two states with a discrete gradient
    let scheme = match material {
        Material::J2Plasticity(_) => Scheme::Newmark(Newmark {
            beta: 0.25,
            gamma: 0.5,
        }),
        _ => Scheme::EnergyMomentum(EnergyMomentum {}),
    };
    let mesh = match dim {
        2 => generate::rectangle("a", [0.0, 0.02], [1.0, 1.0], [3; 2], false),
        _ => generate::box_("a", [0.0, 0.02, 0.0], [1.0; 3], [3; 3], false),
    };
    let cells = mesh.groups["a"].elements.clone();
    let kinematics = match dim {
        2 => Kinematics::PlaneStrain { thickness: 1.0 },
        _ => Kinematics::Solid,
    };
    let bottom = if dim == 2 { "a.bottom" } else { "a.front" };
    let ground = ModelContact {
        sliding: Sliding::Finite,
        ..ModelContact::new(
            "ground",
            Surface::new(&mesh, &mesh.groups[bottom], &cells).unwrap(),
            ModelTarget::rigid(Plane {
                point: [0.0; 3],
                normal: [0.0, 1.0, 0.0],
            }),
            Law::Displacement(Displacement::default()),
        )
    };
    let body = ModelBody {
        velocity,
        ..ModelBody::new(BodySpec::new("a", cells, kinematics, material))
    };
    System::new(Model {
        contacts: if floor { vec![ground] } else { Vec::new() },
        ..Model::new(vec![body], mesh, scheme, 1e-3)
    })
    .unwrap()
}

/// Gives a system that turns about the origin with `rate` in rad/s, and moves besides.
fn turning(system: Arc<System>, rate: f64) -> Arc<System> {
    let mut system = Arc::into_inner(system).unwrap();
    let dim = system.dim;
    for (x, v) in system
        .x
        .iter()
        .zip(system.initial.velocity.chunks_exact_mut(dim))
    {
        v[0] -= rate * x[1];
        v[1] += rate * x[0];
    }
    Arc::new(system)
}

fn run(system: &Arc<System>, settings: Settings, end: f64) -> (Reports, Driver, Summary) {
    let mut newton = Driver::new(Arc::clone(system)).unwrap();
    let settings = Settings { end, ..settings };
    let mut results = Results::create(settings, Arc::clone(system)).unwrap();
    let mut reports = Reports::default();
    march(&mut newton, end, &mut [&mut reports, &mut results], &|| {
        false
    })
    .unwrap();
    let ending = Ending {
        unfinished: None,
        costs: &newton.costs(),
        zones: None,
        wall: Duration::ZERO,
    };
    let summary = results.conclude(&ending).unwrap();
    (reports, newton, summary)
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap()
}

#[test]
fn a_turning_body_shows_its_angular_momentum_and_the_iterations() {
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("turn.carom");
    let material = Material::NeoHooke(NeoHooke { initial: RUBBER });
    let system = turning(block(2, material, [3.0, 0.0, 0.0], false), 4.0);
    let (Reports(reports), newton, summary) = run(&system, models::settings(&folder), 0.05);
    assert!(
        summary.verdict.grade == Grade::Good,
        "{:?}",
        summary.verdict
    );
    // Σ m (x v_y - (y - 0.02) v_x) of the lumped masses about the lower left corner: with v = (3 - 4 y, 4 x)
    let angular = |&(node, m): &(u32, f64)| {
        let [x, y, _] = system.x[node as usize];
        m * (4.0 * x * x - (y - 0.02) * (3.0 - 4.0 * y))
    };
    let exact: f64 = system.body_masses[0].iter().map(angular).sum();
    let table = columns(&folder.join("histories.csv"));
    let shown = summary.momentum.angular.as_ref().unwrap();
    for z in &table["angular_momentum.z_n_m_s"] {
        // the scheme conserves it to the tolerance of the iterations, 1e-10 of the forces
        assert!((z / exact - 1.0).abs() < 1e-9, "{z} {exact}");
    }
    assert!((shown.initial[2] / exact - 1.0).abs() < 1e-14);
    assert_eq!(
        shown.r#final[2],
        *table["angular_momentum.z_n_m_s"].last().unwrap()
    );
    assert_eq!(
        shown.residual[2],
        *table["angular_momentum.residual_z_n_m_s"].last().unwrap()
    );
    assert!(shown.relative_residual < 1e-9);
    let counted = summary.newton.unwrap();
    let passes: usize = reports.iter().map(|report| report.passes).sum();
    let most = reports.iter().map(|report| report.passes).max().unwrap();
    assert_eq!(
        (counted.iterations, counted.most_iterations),
        (passes as u64, most as u64)
    );
    assert_eq!(counted.iterations_per_step, passes as f64 / 50.0);
    let factorisations = newton.costs().work.factorisations as f64;
    assert_eq!(counted.factorisations_per_step, factorisations / 50.0);
    assert_eq!(counted.halvings, 0);
    let report = read(&folder.join("report.html"));
    assert!(report.contains("Angular momentum about (") && report.contains("Newton iterations"));
    assert!(!report.contains("Status iterations"));
}

#[test]
fn plastic_work_has_a_row_a_column_a_curve_and_a_field() {
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("crush.carom");
    let material = Material::J2Plasticity(J2Plasticity {
        initial: RUBBER,
        yield_stress: 2e4,
        hardening: 1e5,
    });
    let system = block(2, material, [0.0, -4.0, 0.0], true);
    let mut settings = models::settings(&folder);
    settings.fields = models::all_fields(0.02);
    let (Reports(reports), newton, summary) = run(&system, settings, 0.06);
    let balance = reports.last().unwrap().balance;
    assert!(balance.dissipation_material > 0.0 && balance.hardening > 0.0);
    let energy = &summary.energy;
    // lost is positive
    assert_eq!(
        energy.dissipations["materials"],
        balance.dissipation_material
    );
    assert_eq!(energy.stored["hardening"], balance.hardening);
    assert!(
        !energy.dissipations.contains_key("friction"),
        "there is none"
    );
    // what the summary names is the whole balance
    let change = energy.kinetic_final + energy.strain_final - energy.kinetic_initial;
    let taken = energy.dissipations.values().chain(energy.stored.values());
    let left = change - energy.works.values().sum::<f64>() + taken.sum::<f64>() - energy.residual;
    assert!(left.abs() < 1e-12 * energy.kinetic_initial, "{left}");
    let table = columns(&folder.join("histories.csv"));
    let of = |name: &str| *table[name].last().unwrap();
    assert_eq!(of("dissipation.material_j"), balance.dissipation_material);
    assert_eq!(of("energy.hardening_j"), balance.hardening);
    assert!(table.contains_key("work.supports_j") && table.contains_key("dissipation.damping_j"));
    let figure = read(&folder.join("plots/energy.svg"));
    assert!(figure.contains("hardening") && figure.contains("material"));
    assert!(!figure.contains("friction") && !figure.contains("damping"));

    // the fields at the end: deformed places, stress and plastic strain of the history
    let (_, _, file) = collection(&folder)
        .into_iter()
        .rfind(|entry| entry.1 == 0)
        .unwrap();
    let (_, arrays) = grids::read(&folder.join(file));
    let (x, u) = (arrays["Points"].floats(), arrays["displacement"].floats());
    for (k, place) in x.chunks_exact(3).enumerate() {
        for i in 0..3 {
            assert_eq!(place[i], system.x[k][i] + u[3 * k + i]);
        }
    }
    let history = &newton.state().motion.history;
    let plastic = system.bodies[0].plastic_strains(history).unwrap();
    assert_eq!(arrays["plastic_strain"].floats(), plastic);
    assert!(plastic.iter().all(|e| *e >= 0.0) && plastic.iter().any(|e| *e > 0.01));
    let stress = system.bodies[0].stresses(&newton.state().motion.u, history);
    let written = arrays["stress"].floats();
    for ((_, stress), written) in stress.iter().zip(written.chunks_exact(6)) {
        assert_eq!(
            [stress[(0, 0)], stress[(1, 1)], stress[(0, 1)]],
            [written[0], written[1], written[3]]
        );
    }
}

#[test]
fn a_film_shows_six_instants_of_what_moves() {
    for dim in [2, 3] {
        let parent = tempfile::tempdir().unwrap();
        let folder = parent.path().join("film.carom");
        let material = Material::NeoHooke(NeoHooke { initial: RUBBER });
        let system = block(dim, material, [0.0, -4.0, 0.0], true);
        let (_, _, summary) = run(&system, models::settings(&folder), 0.05);
        assert!(summary.outputs.iter().any(|name| name == "plots/film.svg"));
        let film = read(&folder.join("plots/film.svg"));
        let frames: Vec<&str> = film.split("<g>").skip(1).collect();
        assert_eq!(frames.len(), 6);
        assert!(frames[0].contains("t = 0 s") && frames[5].contains("t = 50.0 ms"));
        // nine cells; of a cube the nine faces of each of the three sides in view
        let faces = if dim == 2 { 9 } else { 27 };
        for frame in &frames {
            assert_eq!(frame.matches("Z\" fill=").count(), faces);
        }
        // it falls 4 m/s through 20 mm: no contact at first, then at the four nodes of the bottom
        if dim == 2 {
            assert_eq!(frames[0].matches("<circle").count(), 0);
            assert!(
                frames
                    .iter()
                    .any(|frame| frame.matches("<circle").count() == 4)
            );
        }
        assert!(read(&folder.join("report.html")).contains("aria-label=\"Motion\""));
    }
}

#[test]
fn a_linear_run_that_hardly_moves_has_no_film_and_no_further_columns() {
    let parent = tempfile::tempdir().unwrap();
    let (still, falling) = (
        parent.path().join("still.carom"),
        parent.path().join("fall.carom"),
    );
    let system = models::block(2, false);
    let (_, _, summary) = run(&system, models::settings(&still), 1e-3);
    assert!(!still.join("plots/film.svg").exists());
    assert!(summary.newton.is_none() && summary.momentum.angular.is_none());
    let text = read(&still.join("summary.json"));
    let energy = &summary.energy;
    assert!(!energy.works.contains_key("supports") && !energy.works.contains_key("obstacles"));
    for key in ["newton", "angular", "hardening"] {
        assert!(!text.contains(&format!("\"{key}\"")), "{key}");
    }
    assert!(summary.contacts.values().all(|c| c.friction.is_none()));
    let table = columns(&still.join("histories.csv"));
    assert!(
        table
            .keys()
            .all(|name| !name.contains("hardening") && !name.contains("angular"))
    );
    // 5 m/s over 5 ms: 2.5 % of its side
    run(&system, models::settings(&falling), 5e-3);
    assert!(falling.join("plots/film.svg").exists());
}
