//! What is written and where, and what the results are told of the run.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::time::Duration;

use carom_dynamics::Costs;
use carom_exact::Solution;
use carom_mesh::ElementId;

use crate::expectations::Expected;
use crate::results::Zoning;
use crate::results::pieces::Piece;
use crate::statistics::Allowable;
use crate::summary::Zones;

/// What is written and where.
#[derive(Clone, Debug)]
pub struct Settings {
    /// The results folder; an earlier one is replaced, any other folder refused.
    pub folder: PathBuf,
    /// Title of the case.
    pub title: String,
    /// Text of the case file: copied to `case.toml` and shown in the report.
    pub case_text: String,
    /// Version of the program.
    pub version: String,
    /// Time scheme with its parameters, as text: `theta, theta = 0.5`.
    pub scheme: String,
    /// The command that varies mesh and step of this case, which one run cannot judge; `None` where nothing can be varied.
    pub study: Option<String>,
    /// Time at which the run is to end, s.
    pub end: f64,
    /// Histories of groups of nodes.
    pub probes: Vec<Probe>,
    /// Classes (Hz) of the filters behind which the forces of contacts are written too, by the name of the contact.
    pub contact_filters: BTreeMap<String, Vec<u32>>,
    /// Contacts that are judged together.
    pub levels: Vec<LevelSettings>,
    /// What bodies, supports, springs and bolts may bear.
    pub allowables: Vec<AllowableSettings>,
    /// What the case must give.
    pub expected: Expected,
    /// Time between two rows of `histories.csv`, s; `None`: a row for every step.
    pub history_every: Option<f64>,
    /// Whether `histories.csv` and `contact.csv` are compressed, with `.gz` after their names.
    pub compress_histories: bool,
    /// Fields for ParaView; `None`: none.
    pub fields: Option<Fields>,
    /// Elements of which this rank writes the fields, where each of several writes its own; `None`: the first writes all.
    pub piece: Option<Piece>,
    /// Exact solution to compare with.
    pub reference: Option<Reference>,
    /// Zones and weights of a model in zones.
    pub zoning: Option<Zoning>,
    /// Warnings of the check.
    pub warnings: Vec<String>,
    /// Those of them that concern the result: each is a line of the verdict.
    pub doubts: Vec<String>,
    /// When checkpoints are written.
    pub checkpoints: Checkpoints,
}

/// When checkpoints are written, and what they say of the case. One is always written at the end, also of a step that fails.
#[derive(Clone, Debug, PartialEq)]
pub struct Checkpoints {
    /// Simulated time between two of them, s; `None`: by wall time alone.
    pub every: Option<f64>,
    /// Least wall time between two of them; `None`: by simulated time alone. They come less often where writing one takes more than
    /// a hundredth of it.
    pub wall: Option<Duration>,
    /// How many are kept.
    pub keep: usize,
    /// Which case they are of: given back when a run goes on.
    pub origin: String,
}

/// Contacts that are judged together.
#[derive(Clone, Debug, PartialEq)]
pub struct LevelSettings {
    /// Name as in the case file.
    pub name: String,
    /// Indices of its contacts.
    pub contacts: Vec<usize>,
    /// What each of them may bear.
    pub allowable: Allowable,
}

/// What something may bear over the run.
#[derive(Clone, Debug, PartialEq)]
pub struct AllowableSettings {
    /// What bears it.
    pub of: Bearer,
    /// In SI units.
    pub allowable: f64,
}

/// What bears something.
#[derive(Clone, Debug, PartialEq)]
pub enum Bearer {
    /// Von Mises stress of a body, by its index.
    Stress(usize),
    /// Plastic strain of a body.
    PlasticStrain(usize),
    /// Force of a named support, by its index.
    Support(usize),
    /// Force of the springs of a name.
    SpringForce(String),
    /// Elongation of the springs of a name.
    SpringStroke(String),
    /// Force of each bolt whose name is one of these.
    Bolts(String, Vec<String>),
}

/// A history of the mean motion of a group of nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct Probe {
    /// Name as in the case file.
    pub name: String,
    /// Nodes of the mesh, each with its weight in the mean, relative to the others; nodes that no body uses are left out.
    pub nodes: Vec<(u32, f64)>,
    /// Cell of a body whose mean stress is written.
    pub cell: Option<ElementId>,
    /// Cell of a beam or a shell in whose section forces and moments are written, and the end (0 or 1) of a beam.
    pub section: Option<(ElementId, usize)>,
    /// Whether the displacement is written, m.
    pub displacement: bool,
    /// Whether the velocity is written, m/s.
    pub velocity: bool,
    /// Whether the acceleration is written, m/s².
    pub acceleration: bool,
    /// Whether the acceleration with that of the frame of coordinates is written, m/s².
    pub absolute_acceleration: bool,
    /// Whether force (N), pressure (Pa) and gap (m) of the contact points at the nodes are written.
    pub contact: bool,
    /// Response spectrum of the absolute acceleration; `None` for none.
    pub spectrum: Option<Spectrum>,
    /// Classes (Hz) of the filters ([`ChannelFilter`](carom_signals::ChannelFilter)) behind which the accelerations are written too.
    pub filters: Vec<u32>,
}

/// Frequencies and damping ratio of a response spectrum.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    /// Damping ratio.
    pub damping: f64,
    /// Frequencies, Hz, ascending.
    pub frequencies: Vec<f64>,
}

impl Spectrum {
    /// Frequencies in a constant ratio, Hz.
    pub fn between([first, last]: [f64; 2], count: usize, damping: f64) -> Spectrum {
        let ratio = (last / first).ln() / (count.max(2) - 1) as f64;
        Spectrum {
            damping,
            frequencies: (0..count)
                .map(|k| first * (ratio * k as f64).exp())
                .collect(),
        }
    }
}

impl Probe {
    /// The cells of which something is written.
    pub(crate) fn cells(&self) -> impl Iterator<Item = ElementId> {
        let section = self.section.map(|(cell, _)| cell);
        self.cell.into_iter().chain(section)
    }

    /// Displacement, velocity, acceleration.
    pub(crate) fn recorded(&self) -> [bool; 3] {
        [self.displacement, self.velocity, self.acceleration]
    }
}

/// Fields on the bodies, chosen here, and on the contact surfaces, always.
#[derive(Clone, Debug, PartialEq)]
pub struct Fields {
    /// Time between two of them, s. The first is at the start, the last at the end, whatever this is.
    pub every: f64,
    /// Displacement of the nodes, m.
    pub displacement: bool,
    /// Velocity of the nodes, m/s.
    pub velocity: bool,
    /// Acceleration of the nodes, m/s².
    pub acceleration: bool,
    /// Mean stress of the cells and its von Mises equivalent, Pa.
    pub stress: bool,
    /// Strain of the cells and its principal values.
    pub strain: bool,
    /// Principal values of the mean stress of the cells, Pa.
    pub principal_stress: bool,
    /// Stress at the nodes, the mean of the cells around them, and its von Mises equivalent, Pa.
    pub nodal_stress: bool,
    /// Rotation of the nodes of beams, rad.
    pub rotation: bool,
    /// Forces (N) and moments (N m) in the sections of beams.
    pub section_forces: bool,
    /// Whether a VTKHDF file of all instants is written too; needs the feature `hdf5`.
    pub vtkhdf: bool,
}

/// An exact solution of a contact, from time 0 of the run.
#[derive(Clone, Debug)]
pub struct Reference {
    /// Name as in the case file: `two-bars`.
    pub name: String,
    /// The solution; it is compared as far as it goes.
    pub solution: Solution,
    /// Index of the contact in the system.
    pub contact: usize,
    /// Unit vector from the secondary to the primary side.
    pub axis: [f64; 3],
}

/// How the run ended.
#[derive(Clone, Debug)]
pub struct Ending<'a> {
    /// Why it did not come to its end time, in a sentence; `None` if it did.
    pub unfinished: Option<String>,
    /// What the steps cost.
    pub costs: &'a Costs,
    /// What the zones of a run in zones did.
    pub zones: Option<Zones>,
    /// Wall time of the whole run, reading and factorisation included.
    pub wall: Duration,
}

impl Settings {
    /// What this rank writes of fields; none where the first one writes all: alone, for stresses at nodes, which are means over elements of
    /// several ranks, or for a file of all instants.
    pub(super) fn own_piece(&self) -> Option<&Piece> {
        let fields = self.fields.as_ref()?;
        let whole = fields.nodal_stress
            || fields.vtkhdf
            || fields.rotation
            || fields.section_forces
            || self.zoning.is_some();
        self.piece.as_ref().filter(|_| !whole)
    }
}
