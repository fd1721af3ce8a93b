//! The mesh of a case: its file, and generated parts.

use std::path::Path;

use carom_mesh::{Mesh, generate, read};

use super::{Builder, dimensions};
use crate::error::Problem;
use crate::input::Input;
use crate::schema::{Count, Part};
use crate::units;

impl Builder<'_> {
    /// The mesh in metres.
    pub(super) fn mesh(&mut self, input: &Input) -> Option<Mesh> {
        let mesh = &self.case.mesh;
        let mut parts: Vec<(String, String, Mesh)> = Vec::new();
        if let Some(file) = &mesh.file {
            let scale = units::length_of_unit(&mesh.unit.0).unwrap_or(1.0);
            parts.push((
                "mesh.file".to_string(),
                file.clone(),
                self.read(&input.folder, file, scale)?,
            ));
        }
        for (name, part) in mesh.generate.iter() {
            parts.push((
                format!("mesh.generate.{name}"),
                name.to_string(),
                generated(name, part),
            ));
        }
        let mut parts = parts.into_iter();
        let Some((_, first_name, mut whole)) = parts.next() else {
            let problem = Problem::new("mesh", "no mesh");
            self.problems
                .push(problem.accepted(["`file`", "`generate`"]));
            return None;
        };
        for (path, name, part) in parts {
            if part.dim != whole.dim {
                let message = format!(
                    "`{first_name}` has {}, this part another number",
                    dimensions(whole.dim)
                );
                let problem = Problem::new(path, message).found(dimensions(part.dim));
                self.problems
                    .push(problem.accepted([format!("{}, as before", dimensions(whole.dim))]));
            } else if let Err(error) = whole.merge(&name, part) {
                self.problems.push(
                    Problem::new(path, error.to_string())
                        .accepted(["a name that no other group has"]),
                );
            }
        }
        self.problems.is_empty().then_some(whole)
    }

    fn read(&mut self, folder: &Path, file: &str, scale: f64) -> Option<Mesh> {
        let path = folder.join(file);
        match read::read(&path) {
            Ok(mut mesh) => {
                mesh.scale(scale);
                Some(mesh)
            }
            Err(error) => {
                self.problems
                    .push(Problem::new("mesh.file", error.to_string()));
                None
            }
        }
    }
}

fn generated(name: &str, part: &Part) -> Mesh {
    let counts = |elements: &[Count]| elements.iter().map(|count| count.0).collect::<Vec<_>>();
    match part {
        Part::Line(line) => generate::line(
            name,
            line.from.si(),
            line.to.si(),
            line.elements.0,
            line.from.given(),
        ),
        Part::Rectangle(part) => {
            let n = counts(&part.elements);
            let (origin, size) = (part.origin.map(|x| x.0), part.size.map(|x| x.0));
            generate::rectangle(name, origin, size, [n[0], n[1]], part.triangles)
        }
        Part::Box(part) => {
            let n = counts(&part.elements);
            let (origin, size) = (part.origin.map(|x| x.0), part.size.map(|x| x.0));
            generate::box_(name, origin, size, [n[0], n[1], n[2]], part.tetrahedra)
        }
    }
}
