//! Modes of the parts of a model: a table, shapes as a VTU file, pictures, and a page.

use std::path::PathBuf;

use carom_dynamics::{Motion, Order, System};
use carom_elements::Kind;
use carom_output::results::outlines::{Outlines, size};
use carom_output::rows::Cell;
use carom_output::table::{Table, write_csv};
use carom_output::vtu::{Cells, Field, Grid, Values, write};
use carom_output::{Error, Folder, atomic};
use carom_pages::form::{NOTHING, percent};
use carom_pages::html::{each, head, text, texts};
use carom_pages::plot::{Frame, Scene, film_figure, quantity};
use carom_reduction::Modes;

/// Largest displacement of a shape in a picture, over the size of the model.
const AMPLITUDE: f64 = 0.12;

/// Shapes in the picture of a part.
const SHAPES: usize = 6;

/// The modes of a model.
pub struct ModeSet<'a> {
    /// Title of the case.
    pub title: &'a str,
    /// The model.
    pub system: &'a System,
    /// Its parts.
    pub parts: &'a [Modes],
    /// What was left out or linearised, one sentence each.
    pub notes: &'a [String],
}

/// Effective mass over the mass below which a factor is shown as zero: its rounding.
const NOTICED: f64 = 1e-16;

const AXES: [&str; 3] = ["x", "y", "z"];

impl ModeSet<'_> {
    /// The bodies of a part, for people.
    pub fn name(&self, part: &Modes) -> String {
        let names = part
            .bodies
            .iter()
            .map(|&body| self.system.bodies[body].name());
        names.collect::<Vec<_>>().join(", ")
    }

    /// Frequencies, periods, and effective masses over the mass of a part, for people.
    pub fn table(&self, part: &Modes) -> Table {
        let axes = &AXES[..self.system.dim];
        let heads = ["mode", "frequency", "period"].map(str::to_owned);
        let of_axis = |axis: &&str| [format!("factor {axis}"), format!("mass {axis}")];
        let row = |mode: usize| {
            let mut row = vec![(mode + 1).to_string()];
            match part.is_rigid(mode) {
                true => row.extend(["rigid motion".to_owned(), NOTHING.to_owned()]),
                false => {
                    let frequency = part.frequency(mode);
                    row.extend([quantity(frequency, "Hz"), quantity(1.0 / frequency, "s")]);
                }
            }
            let own = part.participation[mode];
            for axis in 0..axes.len() {
                let share = own.effective_mass()[axis] / part.mass[axis];
                let factor = match share < NOTICED {
                    true => "0".to_owned(),
                    false => quantity(own.factor[axis], "√kg"),
                };
                row.extend([factor, percent(share)]);
            }
            row
        };
        Table {
            heads: heads
                .into_iter()
                .chain(axes.iter().flat_map(of_axis))
                .collect(),
            rows: (0..part.len()).map(row).collect(),
        }
    }

    /// Sums and counts of a part, for people.
    pub fn facts(&self, part: &Modes) -> Vec<String> {
        let axes = AXES[..self.system.dim].iter().enumerate();
        let effective = |axis: usize| {
            let masses = part.participation.iter().map(|p| p.effective_mass()[axis]);
            masses.sum::<f64>() / part.mass[axis]
        };
        let sums = axes.clone().map(|(axis, name)| {
            let mass = quantity(part.mass[axis], "kg");
            format!("{} of {mass} along {name}", percent(effective(axis)))
        });
        let sums: Vec<String> = sums.collect();
        let rest = axes.map(|(axis, name)| {
            let rest = (1.0 - effective(axis)).max(0.0);
            format!("{} along {name}", percent(rest))
        });
        let rest: Vec<String> = rest.collect();
        let mut facts = vec![
            format!("{} of {} modes", part.len(), part.existing()),
            format!("effective masses: {}", sums.join(", ")),
            format!(
                "residual masses, of modes left out and of held nodes: {}",
                rest.join(", ")
            ),
        ];
        let count = part.count();
        facts.push(match (count.below.is_finite(), count.exist == count.found) {
            (false, true) => "all modes were computed together".to_owned(),
            (true, true) => "no mode is missing: the inertia of K - ω² M counts as many".to_owned(),
            (_, false) => format!(
                "the inertia of K - ω² M counts {} modes up to one near the last, of which {} were found",
                count.exist, count.found
            ),
        });
        let errors = (0..part.len()).filter_map(|mode| part.error(mode));
        let largest = errors.fold(0.0, f64::max);
        facts.push(format!(
            "frequencies satisfy K φ = ω² M φ within {largest:.0e}"
        ));
        facts
    }

    /// Writes `modes.csv`, `shapes.vtu`, a picture of each part, and `report.html` into the folder; returns the path of the page.
    ///
    /// # Errors
    /// The first file that could not be written.
    pub fn write(&self, folder: &mut Folder) -> Result<PathBuf, Error> {
        self.write_table(folder)?;
        let shapes = self.shapes();
        self.write_shapes(folder, &shapes)?;
        let mut figures = Vec::new();
        for (number, part) in self.parts.iter().enumerate() {
            let Some(figure) = self.figure(part) else {
                continue;
            };
            let figure = figure?;
            let name = format!("plots/modes-{}.svg", number + 1);
            atomic::write_text(&folder.file(&name)?, &figure)?;
            figures.push((number, figure));
        }
        let page = folder.file("report.html")?;
        atomic::write_text(&page, &self.html(&figures))?;
        Ok(page)
    }

    fn write_table(&self, folder: &mut Folder) -> Result<(), Error> {
        let axes = &AXES[..self.system.dim];
        let names = [
            "bodies",
            "mode",
            "frequency_Hz",
            "angular_frequency_rad_s",
            "period_s",
            "relative_error",
        ];
        let names = names.map(str::to_owned).into_iter();
        let factors = axes
            .iter()
            .map(|axis| format!("participation_{axis}_sqrt_kg"));
        let masses = axes.iter().map(|axis| format!("effective_mass_{axis}_kg"));
        let names: Vec<String> = names.chain(factors).chain(masses).collect();
        let bodies: Vec<String> = self.parts.iter().map(|part| self.name(part)).collect();
        let mut rows = Vec::new();
        for (part, bodies) in self.parts.iter().zip(&bodies) {
            for mode in 0..part.len() {
                let frequency = part.frequency(mode);
                let deforms = !part.is_rigid(mode);
                let mut row = vec![
                    Cell::Text(bodies),
                    Cell::Number((mode + 1) as f64),
                    Cell::Number(frequency),
                    Cell::Number(std::f64::consts::TAU * frequency),
                    deforms.then(|| 1.0 / frequency).into(),
                    part.error(mode).into(),
                ];
                let own = part.participation[mode];
                row.extend(own.factor[..axes.len()].iter().map(|x| Cell::Number(*x)));
                let masses = own.effective_mass();
                row.extend(masses[..axes.len()].iter().map(|x| Cell::Number(*x)));
                rows.push(row);
            }
        }
        write_csv(&folder.file("modes.csv")?, &names, &rows)
    }

    /// Displacements of all nodes in each mode, of each part its own, the largest of a part 1 m.
    fn shapes(&self) -> Vec<Vec<[f64; 3]>> {
        let count = self.parts.iter().map(Modes::len).max().unwrap_or(0);
        let mut shapes = vec![vec![[0.0; 3]; self.system.x.len()]; count];
        for part in self.parts {
            for (mode, shape) in shapes.iter_mut().enumerate().take(part.len()) {
                let own = self.displacements(part, mode);
                let largest = largest(&own);
                for (x, own) in shape.iter_mut().zip(own) {
                    for i in 0..3 {
                        x[i] += own[i] / largest;
                    }
                }
            }
        }
        shapes
    }

    fn displacements(&self, part: &Modes, mode: usize) -> Vec<[f64; 3]> {
        let motion = Motion {
            u: part.shape(mode, self.system.unknowns()),
            frames: self.system.initial.frames.clone(),
            ..Motion::default()
        };
        let nodes = 0..self.system.x.len() as u32;
        let of_node = |node| self.system.of_node(node, &motion, Order::Displacement);
        nodes.map(of_node).collect()
    }

    fn write_shapes(&self, folder: &mut Folder, shapes: &[Vec<[f64; 3]>]) -> Result<(), Error> {
        let system = self.system;
        let mut blocks: Vec<(Kind, Vec<u32>)> = Vec::new();
        let mut body = Vec::new();
        for (number, one) in system.bodies.iter().enumerate() {
            for &cell in one.cells() {
                let kind = system.mesh.kind(cell);
                if blocks.last().is_none_or(|(last, _)| *last != kind) {
                    blocks.push((kind, Vec::new()));
                }
                let nodes = system.mesh.element_nodes(cell).iter();
                if let Some((_, block)) = blocks.last_mut() {
                    block.extend(nodes.map(|node| system.number[*node as usize]));
                }
                body.push(number as i32);
            }
        }
        let names: Vec<String> = (1..=shapes.len())
            .map(|mode| format!("mode_{mode:03}"))
            .collect();
        let fields = names.iter().zip(shapes).map(|(name, values)| Field {
            name,
            values: Values::Vector(values),
        });
        let cells = blocks
            .iter()
            .map(|(kind, nodes)| Cells { kind: *kind, nodes });
        write(
            &folder.file("shapes.vtu")?,
            &Grid {
                time: 0.0,
                points: &system.x,
                cells: &cells.collect::<Vec<_>>(),
                point_fields: &fields.collect::<Vec<_>>(),
                cell_fields: &[Field {
                    name: "body",
                    values: Values::Integer(&body),
                }],
            },
        )
    }

    /// The first shapes of a part that deform it; none on a line, and none of points and springs alone.
    fn figure(&self, part: &Modes) -> Option<Result<String, carom_pages::Error>> {
        let system = self.system;
        let outlines = Outlines::new(system, |body, _| part.bodies.contains(&body));
        if system.dim < 2 || outlines.is_blank() {
            return None;
        }
        let deforming = (0..part.len()).filter(|mode| !part.is_rigid(*mode));
        let mut shown: Vec<usize> = deforming.take(SHAPES).collect();
        if shown.is_empty() {
            shown = (0..part.len().min(SHAPES)).collect();
        }
        let frame = |mode: &usize| {
            let values = self.displacements(part, *mode);
            let largest = largest(&values);
            let mut u = part.shape(*mode, system.unknowns());
            let scale = AMPLITUDE * size(system) / largest;
            u.iter_mut().for_each(|u| *u *= scale);
            let places = system.places(0.0, &u, &system.initial.frames);
            let value = |nodes: &[u32], _| {
                let of_node = |node: &u32| norm(&values[*node as usize]) / largest;
                nodes.iter().map(of_node).sum::<f64>() / nodes.len() as f64
            };
            let caption = match part.is_rigid(*mode) {
                true => format!("mode {}: rigid motion", mode + 1),
                false => format!(
                    "mode {}: {}",
                    mode + 1,
                    quantity(part.frequency(*mode), "Hz")
                ),
            };
            let frame = Frame {
                caption,
                ..Frame::default()
            };
            outlines.frame(system, &|node| places.of(*node), &value, frame)
        };
        let frames: Vec<Frame> = shown.iter().map(frame).collect();
        let scene = Scene {
            title: "Modes",
            dim: system.dim,
            field: ("displacement over the largest", ""),
            gap: &|_, _| f64::INFINITY,
        };
        Some(film_figure(&scene, &frames))
    }

    fn html(&self, figures: &[(usize, String)]) -> String {
        let part = |(number, part): (usize, &Modes)| {
            let table = self.table(part);
            let figure = figures.iter().filter(|(figure, _)| *figure == number);
            let figure = each(figure, |(_, svg)| format!("<figure>{svg}</figure>\n"));
            let facts = each(self.facts(part), |fact| {
                format!("<li>{}</li>\n", text(&fact))
            });
            let name = text(&self.name(part));
            let unknowns = part.unknowns;
            let table = texts(true, &table.heads, &table.rows);
            format!(
                "
<h2>{name}</h2>
<ul class=\"plain\">
<li>{unknowns} unknowns</li>
{facts}</ul>
{figure}{table}"
            )
        };
        let title = format!("{}: modes", self.title);
        let count = match self.parts.len() {
            1 => "1 part".to_owned(),
            count => format!("{count} parts"),
        };
        let parts = each(self.parts.iter().enumerate(), part);
        let notes = each(self.notes, |note| format!("{} ", text(note)));
        format!("{}<header>
<h1>{}</h1>
<p class=\"faint\">{count} · carom {}</p>
</header>
{parts}
<p class=\"faint\">Factor: participation Γ = φᵀ M r with φᵀ M φ = 1, and r a motion of the base by 1 m. Mass: effective modal mass Γ² over the mass of the bodies. Contacts are open. {notes}</p>
</body>
</html>",
            head(&title, "", " class=\"broad\""),
            text(&title),
            env!("CARGO_PKG_VERSION"),
        )
    }
}

fn norm(x: &[f64; 3]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// Largest displacement, 1 where nothing is displaced.
fn largest(displacements: &[[f64; 3]]) -> f64 {
    match displacements.iter().map(norm).fold(0.0, f64::max) {
        0.0 => 1.0,
        largest => largest,
    }
}
