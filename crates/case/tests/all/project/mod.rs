//! Cases of the project as tables, which tests change, and what is compared of them.

mod compared;
mod frame;
mod mesh;
mod order;

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::rc::Rc;

use carom_case::{Built, Input, build, build_to_look, parse, run};
use carom_dynamics::{Error, Observer, Stepper};
use carom_mesh::Mesh;
use carom_output::Grade;
use carom_testing::Random;
use toml::{Table, Value};

pub use self::compared::{BOUND, Compared, differences};
pub use self::frame::{Frame, Map};
use crate::resume::{after, cases};
use crate::resume_cases::Small;

/// Steps of each run.
pub const STEPS: u64 = 20;

/// A case of the project, at its smallest.
#[derive(Clone, Debug)]
pub struct Project {
    /// Its file, below the folder of cases.
    pub name: &'static str,
    /// Its keys, those of an exact reference left out: that is of the bodies and the frame of the file alone.
    pub table: Table,
    /// Where its mesh is, if a test wrote it.
    folder: Option<Rc<tempfile::TempDir>>,
}

/// What a run amounts to.
pub struct Answer {
    /// Largest force (N) and impulse (N s) of each contact.
    pub forces: BTreeMap<String, [f64; 2]>,
    /// Grade by name of the line of the verdict.
    pub grades: BTreeMap<String, Grade>,
    /// Displacement of each node of the mesh at the end, m; not a number where other nodes move it.
    pub motion: Vec<[f64; 3]>,
}

impl Project {
    /// Reads one of a list.
    pub fn read(&(name, overrides): &Small) -> Project {
        let text = std::fs::read_to_string(cases().join(name)).unwrap();
        let mut case = Project {
            name,
            table: text.parse().unwrap(),
            folder: None,
        };
        case.table.remove("reference");
        // so are the rows of what it must give
        case.table.remove("expect");
        for key in overrides {
            case.set(key);
        }
        case
    }

    /// Sets keys, given as lines of a case file.
    pub fn set(&mut self, keys: &str) {
        let keys: Table = keys.parse().unwrap_or_else(|_| panic!("{keys}"));
        join(&mut self.table, keys);
    }

    /// Whether it has a section.
    pub fn has(&self, section: &str) -> bool {
        self.table.contains_key(section)
    }

    /// The things of a section by name.
    pub fn named(&self, section: &str) -> impl Iterator<Item = (&String, &Table)> {
        let section = self.table.get(section).and_then(Value::as_table);
        let things = section.into_iter().flatten();
        things.filter_map(|(name, thing)| Some((name, thing.as_table()?)))
    }

    fn input(&self) -> Input {
        let text = toml::to_string(&self.table).unwrap();
        let folder = cases().join(self.name).parent().map(PathBuf::from);
        Input {
            folder: folder.unwrap(),
            ..Input::from_text(self.name, &text, &[])
        }
    }

    /// Its mesh alone, as files and generated parts make it: without the nodes of masses and the cells of springs, with no bolt cut. None of a
    /// case without a mesh.
    pub fn mesh(&self) -> Option<Mesh> {
        if !self.has("mesh") {
            return None;
        }
        let mut bare = self.clone();
        let kept = ["carom", "repeat", "mesh", "material", "body"];
        bare.table.retain(|section, _| kept.contains(&section));
        let bodies = bare.table.get_mut("body").and_then(Value::as_table_mut);
        for (_, body) in bodies.unwrap().iter_mut() {
            let kept = ["region", "material", "section"];
            let body = body.as_table_mut().unwrap();
            body.retain(|key, _| kept.contains(&key));
        }
        bare.set("time={end=1.0,step=1e-3,scheme.newmark={}}");
        let input = bare.input();
        let (case, locator) = parse(&input).unwrap_or_else(|all| panic!("{}: {all:?}", self.name));
        let built = build_to_look(&case, &locator, &input);
        let built = built.unwrap_or_else(|all| panic!("{}: {all:?}", self.name));
        Some(Mesh::clone(&built.system.mesh))
    }

    /// The same with nodes and elements of the mesh under other numbers; node `k` of it is node `order[k]` of the mesh.
    pub fn renumbered(&self, seed: u64) -> Option<(Project, Vec<u32>)> {
        let mesh = self.mesh()?;
        let order = mesh::order(mesh.nodes.len(), seed);
        let text = mesh::msh(&mesh, &order, Some(seed), (&|x| x, false));
        let mut other = self.clone();
        other.remeshed(&text, mesh.dim);
        Some((other, order))
    }

    /// The same with each node elsewhere by up to a distance along each axis, in m.
    pub fn nudged(&self, seed: u64, distance: f64) -> Option<Project> {
        let mesh = self.mesh()?;
        let mut nudged = mesh.clone();
        let mut random = Random(seed);
        for x in &mut nudged.nodes {
            for x in &mut x[..mesh.dim] {
                *x += distance * random.next();
            }
        }
        let order: Vec<u32> = (0..mesh.nodes.len() as u32).collect();
        let text = mesh::msh(&nudged, &order, None, (&|x| x, false));
        let mut other = self.clone();
        other.remeshed(&text, mesh.dim);
        Some(other)
    }

    /// Takes the mesh from the text of a file.
    fn remeshed(&mut self, text: &str, dim: usize) {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("mesh.msh");
        std::fs::write(&file, text).unwrap();
        self.table.remove("mesh");
        self.set(&format!("mesh={{file={file:?},dimension={dim}}}"));
        self.folder = Some(Rc::new(folder));
    }

    /// The case built.
    pub fn built(&self) -> (Input, carom_case::schema::Case, Built) {
        let input = self.input();
        let fail = |problems: Vec<carom_case::Problem>| -> ! {
            let problems: Vec<String> = problems.iter().map(ToString::to_string).collect();
            panic!("{}: {}", self.name, problems.join("\n"))
        };
        let (case, locator) = parse(&input).unwrap_or_else(|problems| fail(problems));
        let built = build(&case, &locator, &input).unwrap_or_else(|problems| fail(problems));
        (input, case, built)
    }

    /// What some steps of it amount to.
    pub fn answer(&self) -> Answer {
        let (input, case, built) = self.built();
        let folder = tempfile::tempdir().unwrap();
        let mut last = Last(Vec::new());
        let ended = run(
            (&input, &case, &built),
            folder.path().join("results"),
            &mut last,
            &after(STEPS),
        );
        let ended = ended.unwrap_or_else(|error| panic!("{}: {error:?}", self.name));
        let summary = ended.summary;
        let contacts = summary.contacts.iter().map(|(name, contact)| {
            let impulse = contact.impulse.unwrap_or(0.0);
            (name.clone(), [contact.peak_force, impulse])
        });
        let lines = summary.verdict.lines.iter();
        Answer {
            forces: contacts.collect(),
            grades: lines.map(|line| (line.name.clone(), line.grade)).collect(),
            motion: last.0,
        }
    }
}

impl Answer {
    /// The largest displacement, m.
    pub fn largest(&self) -> f64 {
        let moved = self.motion.iter().flatten().filter(|u| u.is_finite());
        moved.map(|u| u.abs()).fold(0.0, f64::max)
    }
}

/// Puts keys into a table, in tables of the same name too.
fn join(table: &mut Table, keys: Table) {
    for (key, value) in keys {
        match (table.get_mut(&key), value) {
            (Some(Value::Table(inner)), Value::Table(value)) => join(inner, value),
            (_, value) => {
                table.insert(key, value);
            }
        }
    }
}

/// The displacements of the last state.
struct Last(Vec<[f64; 3]>);

impl Observer for Last {
    fn accepted(&mut self, _: &dyn Stepper) -> Result<(), Error> {
        Ok(())
    }

    fn finish(&mut self, run: &dyn Stepper) -> Result<(), Error> {
        let (system, u) = (run.system(), &run.state().motion.u);
        self.0 = vec![[f64::NAN; 3]; system.number.len()];
        for (node, &mesh_node) in (0..).zip(&system.mesh_node) {
            if !system.unknowns.translations_of(node).is_empty() {
                self.0[mesh_node as usize] = [0.0; 3];
            }
            for (i, unknown) in system.unknowns.translations_of(node).enumerate() {
                self.0[mesh_node as usize][i] = u[unknown];
            }
        }
        Ok(())
    }
}
