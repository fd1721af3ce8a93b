//! Profiles: prismatic obstacles whose section is a curve given by points.

use std::f64::consts::{PI, TAU};

use carom_contact::{Profile, Side};
use carom_mesh::Mesh;

use super::columns::{self, FileColumn};
use super::context::Context;
use super::lookup;
use super::problems::Problems;
use crate::error::Problem;
use crate::schema::{self, PolarColumns, PolarCurve};

/// The profile at `path`.
pub(super) fn profile(
    context: &Context,
    mesh: &Mesh,
    path: &str,
    given: &schema::PolarProfile,
    problems: &mut Problems,
) -> Option<Profile> {
    let point = problems.vector(mesh, &format!("{path}.point"), &given.point);
    let axis = lookup::axis(mesh, &format!("{path}.axis"), &given.axis, problems)?;
    let zero = match &given.zero {
        Some(zero) => lookup::normal(mesh, &format!("{path}.zero"), zero, problems)?,
        None if axis[1] == 0.0 && axis[2] == 0.0 => [0.0, 1.0, 0.0],
        None => [1.0, 0.0, 0.0],
    };
    let along: f64 = (0..3).map(|i| zero[i] * axis[i]).sum();
    let across = [0, 1, 2].map(|i| zero[i] - along * axis[i]);
    let length = across.iter().map(|a| a * a).sum::<f64>().sqrt();
    if length < 1e-6 {
        let problem = Problem::new(format!("{path}.zero"), "it lies along the axis");
        return problems.refuse(problem.accepted(["a direction across the axis"]));
    }
    let first = across.map(|a| a / length);
    let second = [0, 1, 2].map(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        axis[j] * first[k] - axis[k] * first[j]
    });
    let (points, at) = match (&given.points, &given.csv) {
        (Some(points), _) => {
            let points = points.iter().map(|p| [p.angle.0, p.radius.0]);
            (points.collect(), At::Points(format!("{path}.points")))
        }
        (None, Some(csv)) => profile_file(context, &format!("{path}.csv"), csv, problems)?,
        (None, None) => return None,
    };
    is_curve(&points, &at, problems).then(|| {
        let side = match given.side {
            schema::Side::Outside => Side::Outside,
            schema::Side::Inside => Side::Inside,
        };
        let smooth = given.curve == PolarCurve::Smooth;
        Profile::new(point, [first, second], points, (smooth, side))
    })
}

fn profile_file(
    context: &Context,
    path: &str,
    csv: &PolarColumns,
    problems: &mut Problems,
) -> Option<(Vec<[f64; 2]>, At)> {
    let keys = [
        FileColumn {
            key: "angle",
            name: &csv.angle,
            unit_key: "angle-unit",
            unit: csv.angle_unit.as_ref(),
            dimension: "angle",
        },
        FileColumn {
            key: "radius",
            name: &csv.radius,
            unit_key: "unit",
            unit: csv.unit.as_ref(),
            dimension: "length",
        },
    ];
    let (points, lines) = columns::file_columns(context.folder, path, &csv.file, keys, problems)?;
    Some((points, At::Lines(path.to_owned(), lines)))
}

/// Whether points are a function of the angle that goes once around the axis.
fn is_curve(points: &[[f64; 2]], at: &At, problems: &mut Problems) -> bool {
    let degrees = |angle: f64| format!("{:.6} deg", angle.to_degrees());
    let mut refuse = |k: usize, key: &str, message: &str, found: String, accepted: String| {
        let problem = match at {
            At::Points(path) => Problem::new(format!("{path}[{k}].{key}"), message),
            At::Lines(path, lines) => Problem::new(
                format!("{path}.{key}"),
                format!("line {} of the file: {message}", lines[k]),
            ),
        };
        problems.push(problem.found(found).accepted([accepted]));
        false
    };
    if points.len() < 3 {
        let k = points.len().saturating_sub(1);
        let (found, accepted) = (points.len().to_string(), "three points or more".to_owned());
        return refuse(k, "radius", "too few points", found, accepted);
    }
    for (k, [angle, radius]) in points.iter().enumerate() {
        if *radius <= 0.0 {
            let message = "the radius must be positive";
            return refuse(
                k,
                "radius",
                message,
                format!("{radius} m"),
                "> 0 m".to_owned(),
            );
        }
        let next = points.get(k + 1).map_or(points[0][0] + TAU, |p| p[0]);
        let last = k + 1 == points.len();
        let (k, named) = if last { (k, *angle) } else { (k + 1, next) };
        if next <= *angle {
            let message =
                "the points are no function of the angle: angles must ascend within one turn";
            let accepted = match last {
                true => format!("less than {}", degrees(points[0][0] + TAU)),
                false => format!("more than {}", degrees(*angle)),
            };
            return refuse(k, "angle", message, degrees(named), accepted);
        }
        if next - angle >= PI {
            let message =
                "the curve does not go around the axis: the next point is half a turn away or more";
            let accepted = "points less than half a turn apart".to_owned();
            return refuse(k, "angle", message, degrees(next - angle), accepted);
        }
    }
    true
}

/// Where the points are.
enum At {
    /// In the case file, at this path.
    Points(String),
    /// In these lines of the file of the table at this path.
    Lines(String, Vec<usize>),
}
