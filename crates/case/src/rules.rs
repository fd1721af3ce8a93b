//! Rules between several values of a case, which the schema cannot say; still without a look at any mesh.

use carom_laws::{Capture, Friction, GivenLaw, Reading};
use carom_quantities::units::with_article;

use crate::error::Problem;
use crate::schema::{
    Adaptive, Case, Contact, Count, Integration, IntegrationWith, LargestStep, Line, Motion,
    Obstacle, Part, Step, StepRule,
};

/// Most nodes of a generated part or a refined mesh: beyond it a case is a slip of the pen.
pub(crate) const MOST_NODES: f64 = 1e8;

/// Every rule that `case` breaks.
pub(crate) fn check(case: &Case) -> Vec<Problem> {
    let mut problems = Vec::new();
    for (name, part) in case.mesh.generate.iter() {
        check_part(&format!("mesh.generate.{name}"), part, &mut problems);
    }
    for (name, contact) in case.contact.iter() {
        check_contact(&format!("contact.{name}"), contact, &mut problems);
    }
    for (name, stop) in case.stop.iter() {
        if let Some(obstacle) = &stop.obstacle {
            check_vectors(&format!("stop.{name}"), obstacle, &mut problems);
        }
    }
    check_frictions(case, &mut problems);
    for (name, load) in case.load.iter() {
        let everywhere = load.acceleration.is_some() || load.base_acceleration.is_some();
        if let Some(on) = load.on.as_ref().filter(|_| everywhere) {
            let message = "gravity and base accelerations act on every body";
            let problem = Problem::new(format!("load.{name}.on"), message).found(on);
            problems.push(problem.accepted(["no `on`"]));
        }
        if load.random.is_some() && load.amplitude.is_some() {
            let message = "a random force is a function of time by itself";
            let problem = Problem::new(format!("load.{name}.amplitude"), message);
            problems.push(problem.accepted(["no `amplitude`"]));
        }
    }
    for (name, probe) in case.probe.iter() {
        let accelerates =
            |motion: &Motion| matches!(motion, Motion::Acceleration | Motion::AbsoluteAcceleration);
        if !probe.filter.is_empty() && !probe.record.iter().any(accelerates) {
            let message = "the probe records no acceleration that could be filtered";
            let problem = Problem::new(format!("probe.{name}.filter"), message);
            problems.push(problem.accepted(["record = [\"acceleration\"]", "no `filter`"]));
        }
    }
    check_time(case, &mut problems);
    problems
}

fn check_time(case: &Case, problems: &mut Vec<Problem>) {
    let time = &case.time;
    let begin = time.stage.map_or(0.0, |stage| stage.end.0);
    if begin > time.end.0 {
        let message = "the static stage ends after the time to simulate";
        let problem = Problem::new("time.static.end", message).found(format!("{begin} s"));
        problems.push(problem.accepted([format!("at most `end`, {} s", time.end.0)]));
        return;
    }
    if !time.is_static() {
        let of_zones =
            !case.zone.is_empty() && case.zone.iter().all(|(_, zone)| zone.scheme.is_some());
        let everywhere = (!case.zone.is_empty()).then_some("a scheme for each zone");
        let keys = [
            (
                "step",
                time.step.is_none(),
                "step = { courant = 0.5 }",
                None,
            ),
            (
                "scheme",
                time.scheme.is_none() && !of_zones,
                "scheme.theta = {}",
                everywhere,
            ),
        ];
        for (key, _, example, other) in keys.into_iter().filter(|(_, missing, ..)| *missing) {
            let message = format!("`{key}` is missing in `time`");
            let problem = Problem::new("time", message);
            let accepted = [example].into_iter().chain(other);
            problems.push(problem.accepted(accepted.chain(["a static stage up to `end`"])));
        }
    }
    let given = match time.step {
        Some(Step::Fixed(step)) => Some(("time.step", step)),
        Some(Step::Rule(StepRule::Adaptive(Adaptive {
            largest: LargestStep::Fixed(step),
            ..
        }))) => Some(("time.step.adaptive.largest", step)),
        Some(Step::Rule(_)) | None => None,
    };
    if let Some((path, step)) = given
        && step.0 > time.end.0 - begin
        && !time.is_static()
    {
        let problem = Problem::new(path, "the step is longer than the time to simulate");
        problems.push(
            problem
                .found(format!("{} s", step.0))
                .accepted([format!("at most `end`, {} s", time.end.0 - begin)]),
        );
    }
}

/// Nodes of a generated part.
pub(crate) fn nodes_of(elements: &[Count]) -> f64 {
    elements.iter().map(|count| count.0 as f64 + 1.0).product()
}

fn check_part(path: &str, part: &Part, problems: &mut Vec<Problem>) {
    let (shape, elements): (&str, &[Count]) = match part {
        Part::Line(line) => {
            check_line(&format!("{path}.line"), line, problems);
            ("line", &[line.elements])
        }
        Part::Rectangle(rectangle) => ("rectangle", &rectangle.elements),
        Part::Box(part) => ("box", &part.elements),
    };
    let nodes = nodes_of(elements);
    if nodes > MOST_NODES {
        let problem = Problem::new(format!("{path}.{shape}.elements"), "too many elements");
        problems.push(
            problem
                .found(format!("{nodes:e} nodes"))
                .accepted([format!("at most {MOST_NODES:e} nodes")]),
        );
    }
}

fn check_line(path: &str, line: &Line, problems: &mut Vec<Problem>) {
    if line.from.given() != line.to.given() {
        let problem = Problem::new(
            format!("{path}.to"),
            "`from` and `to` have different numbers of components",
        );
        problems.push(
            problem
                .found(line.to.given())
                .accepted([format!("{}, as in `from`", line.from.given())]),
        );
    } else if line.from == line.to {
        problems.push(Problem::new(
            format!("{path}.to"),
            "a line of no length: `from` and `to` are the same point",
        ));
    }
}

fn check_contact(path: &str, contact: &Contact, problems: &mut Vec<Problem>) {
    if contact.primary.as_ref() == Some(&contact.secondary) {
        let problem = Problem::new(
            format!("{path}.primary"),
            "a surface cannot be its own partner in contact",
        );
        problems.push(problem.found(&contact.secondary).accepted([
            "another group than `secondary`",
            "`self = true` in its place",
        ]));
    }
    if let Some(obstacle) = &contact.obstacle {
        check_vectors(path, obstacle, problems);
    }
    check_capture(path, &contact.law, problems);
    check_r(path, contact, problems);
}

/// Normals and axes of no length.
fn check_vectors(path: &str, obstacle: &Obstacle, problems: &mut Vec<Problem>) {
    let (shape, vector, motion) = match obstacle {
        Obstacle::Plane(plane) => ("plane", Some(("normal", &plane.normal)), &plane.motion),
        Obstacle::Sphere(sphere) => ("sphere", None, &sphere.motion),
        Obstacle::Cylinder(round) => ("cylinder", Some(("axis", &round.axis)), &round.motion),
        Obstacle::Surface(surface) => ("surface", None, &surface.motion),
        Obstacle::Profile(round) => ("profile", Some(("axis", &round.axis)), &round.motion),
    };
    let turn = motion.as_ref().and_then(|motion| motion.turn.as_ref());
    let turn = turn.map(|turn| ("motion.turn.axis", &turn.axis));
    for (key, vector) in vector.into_iter().chain(turn) {
        if vector.components() == [0.0; 3] {
            let noun = key.rsplit('.').next().unwrap_or(key);
            let path = format!("{path}.obstacle.{shape}.{key}");
            let problem = Problem::new(path, format!("{} of no length", with_article(noun)));
            problems.push(problem.accepted(["a vector that is not zero"]));
        }
    }
}

/// An r that is only given for another law.
fn check_r(path: &str, contact: &Contact, problems: &mut Vec<Problem>) {
    let Some(Integration::With(IntegrationWith::Quadrature(given))) = contact.integration else {
        return;
    };
    let used = match &contact.law {
        GivenLaw::Displacement(_) => Some("r"),
        GivenLaw::Velocity(_) => Some("r-v"),
        _ => None,
    };
    let named = [("r", given.r.is_some()), ("r-v", given.r_v.is_some())];
    let given: Vec<&str> = named
        .into_iter()
        .filter_map(|(name, given)| given.then_some(name))
        .collect();
    if let Some(first) = given.first()
        && !given.iter().any(|name| Some(*name) == used)
    {
        let message = match used {
            Some(_) => "this is the r of another law",
            None => "the law has no weak form, and so no r",
        };
        let path = format!("{path}.integration.quadrature.{first}");
        problems.push(Problem::new(path, message).accepted(used));
    }
}

/// Friction that is larger in motion than at rest.
fn check_frictions(case: &Case, problems: &mut Vec<Problem>) {
    let contacts = case.contact.iter();
    let contacts = contacts.map(|(name, given)| (format!("contact.{name}"), given.friction));
    let stops = case.stop.iter();
    let stops = stops.map(|(name, given)| (format!("stop.{name}"), given.friction));
    let general = case.general_contact.iter();
    let general = general.flat_map(|given| {
        let pairs = given.pairs.iter().enumerate();
        let pairs = pairs.map(|(k, pair)| (format!("general-contact.pairs[{k}]"), pair.friction));
        std::iter::once(("general-contact".to_owned(), given.friction)).chain(pairs)
    });
    let rises = |friction: &Friction| {
        let law = friction.get();
        law.slides(0.0).max(law.slides(f64::INFINITY)) > law.sticks()
    };
    for (path, friction) in contacts.chain(stops).chain(general) {
        if let Some(friction) = friction.filter(rises) {
            let path = format!("{path}.friction.{}", friction.get().name());
            let problem = Problem::new(
                path,
                "a point that slides has more friction than one that sticks",
            );
            problems
                .push(problem.accepted(["a coefficient of sliding of at most that of sticking"]));
        }
    }
}

/// Captures that a law cannot have.
fn check_capture(path: &str, law: &GivenLaw, problems: &mut Vec<Problem>) {
    let (path, capture, message, accepted) = match law {
        GivenLaw::Restitution(law) => (
            format!("{path}.law.restitution.capture"),
            law.capture.filter(|capture| *capture == Capture::GapTarget),
            "the gap as target takes the rebound away",
            &["now", "half", "full", "free"][..],
        ),
        GivenLaw::Velocity(law) if law.reading == Reading::AsPrinted => (
            format!("{path}.law.velocity.capture"),
            law.capture
                .filter(|capture| matches!(capture, Capture::Free | Capture::GapTarget)),
            "the sign as printed needs a gap that is known before the step",
            &["now", "half", "full"][..],
        ),
        _ => return,
    };
    if capture.is_some() {
        problems.push(Problem::new(path, message).accepted(accepted.iter().copied()));
    }
}
