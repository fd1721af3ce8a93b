//! Internal-force sweeps: elements per second, for every element kind.
//!
//! `cargo bench -p carom-benches --bench bodies`; `CAROM_BENCH_THREADS=2` sets the threads (1 unless given). About 32 000
//! elements, gather and scatter included. The last lines print the best rates, since other processes may be running; hexahedra in full
//! integration are compared with the peak of the machine too, which is measured: multiplications with additions in registers.

use std::hint::black_box;
use std::time::{Duration, Instant};

use carom_algebra::unknowns::Unknowns;
use carom_bodies::{Body, BodySpec, Formulation, Kinematics, Placement, Scratch};
use carom_elements::Kind;
use carom_materials::{Elastic, J2Plasticity, Law, NeoHooke, StVenantKirchhoff};
use carom_mesh::{Mesh, generate, raise};
use criterion::{Criterion, Throughput};
use pulp::{Arch, Simd, WithSimd};

/// Floating-point operations of a hexahedron with a hyperelastic law in full integration, counted by hand in the page on performance.
const OPERATIONS: f64 = 3600.0;

const MATERIAL: Elastic = Elastic {
    density: 1000.0,
    young: 1e9,
    poisson: 0.3,
};

fn main() {
    let mut criterion = Criterion::default().sample_size(20).configure_from_args();
    let plane = Kinematics::PlaneStrain { thickness: 1.0 };
    let bar = Kinematics::Bar { area: 1.0 };
    let square = |triangles| generate::rectangle("b", [1.0, 0.0], [1.0; 2], [180; 2], triangles);
    let cube = |n, tets| generate::box_("b", [0.0; 3], [1.0; 3], [n; 3], tets);
    let line = |dim| {
        let to = [[1.0, 0.0, 0.0], [1.0, 2.0, 0.0], [1.0, 2.0, 3.0]][dim - 1];
        generate::line("b", [0.0; 3], to, 32_000, dim)
    };
    let threads = std::env::var("CAROM_BENCH_THREADS").ok();
    let threads = threads.and_then(|n| n.parse().ok()).unwrap_or(1);
    if let Err(error) = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build_global()
    {
        println!("rates are not those of {threads} threads: {error}");
    }
    let mut rates = Vec::new();
    for (name, mesh, kinematics) in [
        ("bar2 1D", line(1), bar),
        ("bar2 2D", line(2), bar),
        ("bar2 3D", line(3), bar),
        ("tri3 plane strain", square(true), plane),
        ("quad4 plane strain", square(false), plane),
        (
            "quad4 axisymmetric",
            square(false),
            Kinematics::Axisymmetric,
        ),
        ("tet4", cube(18, true), Kinematics::Solid),
        ("tet10", quadratic(&cube(18, true)), Kinematics::Solid),
        ("wedge6", wedges(&cube(25, false)), Kinematics::Solid),
        ("hex8", cube(32, false), Kinematics::Solid),
    ] {
        let cells = mesh.groups["b"].elements.clone();
        let spec = BodySpec::new(name, cells.clone(), kinematics, MATERIAL);
        let rate = sweep(&mut criterion, &mesh, spec, false);
        rates.push((name.to_owned(), rate));
        if let Kinematics::Bar { .. } = kinematics {
            continue;
        }
        for between in [false, true] {
            let way = if between {
                ", between two displacements"
            } else {
                ""
            };
            let name = format!("{name} neo-Hooke{way}");
            let law = Law::NeoHooke(NeoHooke { initial: MATERIAL });
            let spec = BodySpec::new(&name, cells.clone(), kinematics, law);
            let rate = sweep(&mut criterion, &mesh, spec, between);
            rates.push((name, rate));
        }
    }
    let plastic = J2Plasticity {
        initial: MATERIAL,
        yield_stress: 1e6,
        hardening: 1e8,
    };
    let one_point = Formulation::Reduced { hourglass: 0.1 };
    for (law, material) in [
        (
            "St Venant-Kirchhoff",
            Law::StVenantKirchhoff(StVenantKirchhoff { initial: MATERIAL }),
        ),
        ("neo-Hooke", Law::NeoHooke(NeoHooke { initial: MATERIAL })),
        ("J2", Law::J2Plasticity(plastic)),
    ] {
        for (kind, formulation) in [
            ("full", Formulation::Full),
            ("mean dilatation", Formulation::BBar),
            ("one point", one_point),
        ] {
            let name = format!("hex8 {law}, {kind}");
            let mesh = cube(32, false);
            let mut spec = BodySpec::new(
                &name,
                mesh.groups["b"].elements.clone(),
                Kinematics::Solid,
                material,
            );
            spec.formulation = formulation;
            let rate = sweep(&mut criterion, &mesh, spec.clone(), false);
            rates.push((name.clone(), rate));
            if law != "J2" {
                spec.name = format!("{name}, between two displacements");
                let rate = sweep(&mut criterion, &mesh, spec.clone(), true);
                rates.push((spec.name, rate));
            }
        }
    }
    let peak = Arch::new().dispatch(Peak) * threads as f64;
    println!("peak: {:.1} GFlop/s on {threads} threads", peak / 1e9);
    // a filter of the command line leaves out the others
    for (name, rate) in rates.into_iter().filter(|(_, rate)| *rate > 0.0) {
        println!("{name}: {:.1} million elements/s", rate / 1e6);
        if name.ends_with(", full") && !name.contains("J2") {
            println!("{name}: {:.2} of the peak", OPERATIONS * rate / peak);
        }
    }
    criterion.final_summary();
}

/// Floating-point operations a second of one thread that only multiplies and adds.
struct Peak;

/// Sums that do not wait for each other: as many as two vector units have operations under way, and more.
const SUMS: usize = 12;

impl WithSimd for Peak {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        const ROUNDS: usize = 1_000_000;
        let width = size_of::<S::f64s>() / size_of::<f64>();
        let [a, b] = [1.0 - 1e-9, 1e-9].map(|value| simd.splat_f64s(black_box(value)));
        let mut best = Duration::MAX;
        for _ in 0..20 {
            let mut sums = [simd.splat_f64s(1.0); SUMS];
            let begin = Instant::now();
            for _ in 0..ROUNDS {
                for sum in &mut sums {
                    *sum = simd.mul_add_f64s(*sum, a, b);
                }
            }
            best = best.min(begin.elapsed());
            black_box(sums);
        }
        (2 * SUMS * ROUNDS * width) as f64 / best.as_secs_f64()
    }
}

/// The mesh with quadratic elements.
fn quadratic(mesh: &Mesh) -> Mesh {
    raise(mesh, false).unwrap_or_else(|error| {
        println!("{error}");
        mesh.clone()
    })
}

/// The hexahedra of a mesh, each cut into two wedges.
fn wedges(mesh: &Mesh) -> Mesh {
    let mut out = Mesh::new(3);
    out.nodes.clone_from(&mesh.nodes);
    let mut cells = Vec::new();
    for &cell in &mesh.groups["b"].elements {
        let n = mesh.element_nodes(cell);
        for corners in [[0, 1, 2, 4, 5, 6], [0, 2, 3, 4, 6, 7]] {
            cells.push(out.push(Kind::Wedge6, &corners.map(|a: usize| n[a])));
        }
    }
    let mut group = mesh.groups["b"].clone();
    group.elements = cells;
    out.groups.insert("b".to_owned(), group);
    out
}

/// Times one kind; returns its best rate in elements per second. `between`: of the forces between two displacements.
fn sweep(criterion: &mut Criterion, mesh: &Mesh, spec: BodySpec, between: bool) -> f64 {
    let (name, count) = (spec.name.clone(), spec.cells.len() as u64);
    let number: Vec<u32> = (0..mesh.nodes.len() as u32).collect();
    let unknowns = Unknowns::translations(mesh.dim, mesh.nodes.len());
    let body = match Body::new(mesh, spec, &number, &unknowns) {
        Ok(body) => body,
        Err(error) => {
            println!("{error}");
            return 0.0;
        }
    };
    let n = mesh.dim * mesh.nodes.len();
    let [u, from] = [0.0, 1.0].map(|phase| {
        let wave = |i: usize| 1e-3 * (i as f64 + phase).sin();
        (0..n).map(wave).collect::<Vec<f64>>()
    });
    let (mut scratch, mut f) = (Scratch::default(), vec![0.0; n]);
    let mut old = vec![0.0; body.history_len()];
    body.start_history(&mut old);
    let mut new = old.clone();
    let mut best = Duration::MAX;
    let mut group = criterion.benchmark_group("internal_force");
    group.throughput(Throughput::Elements(count));
    group.bench_function(&name, |bench| {
        bench.iter(|| {
            let begin = Instant::now();
            let at = Placement {
                u: &u,
                v: &[],
                frames: &[],
                from: between.then_some(&from[..]),
                dt: 1e-6,
                old: &old,
            };
            let energy = body.force(&at, &mut new, &mut scratch, &mut f);
            best = best.min(begin.elapsed());
            energy
        });
    });
    group.finish();
    count as f64 / best.as_secs_f64()
}
