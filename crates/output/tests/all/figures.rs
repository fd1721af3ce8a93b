//! Figures: what must be in the drawing, and what cannot be drawn.

use carom_pages::Error;
use carom_pages::plot::{
    ContactCurves, Curve, EnergyCurves, Figure, Role, contact_figure, energy_figure,
};

fn curve<'a>(name: &'a str, x: &'a [f64], y: &'a [f64], role: Role) -> Curve<'a> {
    Curve { name, x, y, role }
}

fn force<'a>(curves: Vec<Curve<'a>>) -> Figure<'a> {
    contact_figure(
        "Force",
        ContactCurves {
            force: curves,
            ..ContactCurves::default()
        },
    )
}

/// The vertices of the polylines of a colour, legend left out.
fn vertices(svg: &str, colour: &str) -> Vec<(f64, f64)> {
    let lines = svg
        .lines()
        .filter(|line| line.starts_with("<polyline") && line.contains(colour));
    let points = lines
        .skip(1)
        .filter_map(|line| line.split("points=\"").nth(1));
    let pair = |text: &str| {
        let (x, y) = text.split_once(',').unwrap();
        (x.parse().unwrap(), y.parse().unwrap())
    };
    points
        .flat_map(|text| {
            text.trim_end_matches("\"/>")
                .split_whitespace()
                .map(pair)
                .collect::<Vec<_>>()
        })
        .collect()
}

const FIRST: &str = "#1F6FC0";
const EXACT: &str = "#F4C15D";

#[test]
fn the_contact_figure_has_four_panels_with_prefixed_units_and_the_exact_curve_below() {
    let time = [0.0, 1e-4, 2e-4];
    let (u, v, f, a) = (
        [0.0, 1e-4, 2e-4],
        [5.0, 2.5, 2.5],
        [0.0, 6.6e4, 6.7e4],
        [0.0, 2e6, -1e6],
    );
    let both = |y| {
        vec![
            curve("striker <1>", &time, y, Role::Computed),
            curve("exact", &time, y, Role::Exact),
        ]
    };
    let curves = ContactCurves {
        displacement: both(&u),
        velocity: both(&v),
        force: both(&f),
        acceleration: both(&a),
    };
    let svg = contact_figure("Bars & walls", curves).svg().unwrap();
    for text in [
        "Bars &amp; walls",
        "striker &lt;1&gt;",
        "Displacement (µm)",
        "Velocity (m/s)",
        "Force (kN)",
        "Acceleration (10⁶ m/s²)",
        "Time (µs)",
    ] {
        assert!(svg.contains(text), "{text}");
    }
    assert_eq!(svg.matches("Time (µs)").count(), 4);
    // Drawn later is drawn above: in every panel the last line is a computed one.
    assert!(svg.rfind(FIRST) > svg.rfind(EXACT));
    assert_eq!(svg.matches("<svg").count(), 1);
    assert!(svg.trim_end().ends_with("</svg>"));
}

#[test]
fn a_figure_needs_no_font_no_network_and_no_script() {
    let time = [0.0, 1.0];
    let names = ["kinetic", "strain", "total", "dissipated"];
    let energy = EnergyCurves {
        energies: names
            .map(|name| curve(name, &time, &time, Role::Computed))
            .to_vec(),
        residual: vec![curve("residual", &time, &time, Role::Computed)],
    };
    let svg = energy_figure("Energy", energy).svg().unwrap();
    assert_eq!(
        svg.matches("http").count(),
        1,
        "the name of the SVG language only"
    );
    assert!(!svg.contains("<script") && !svg.contains("@font-face") && !svg.contains("href"));
    for name in names.into_iter().chain(["residual"]) {
        assert!(svg.contains(name));
    }
}

#[test]
fn the_vertices_of_a_short_curve_are_where_its_samples_are() {
    let (x, y) = ([0.0, 1.0, 3.0], [0.0, 2.0, 4.0]);
    let svg = force(vec![curve("F", &x, &y, Role::Computed)])
        .svg()
        .unwrap();
    let drawn = vertices(&svg, FIRST);
    assert_eq!(drawn.len(), 3);
    let along = (drawn[1].0 - drawn[0].0) / (drawn[2].0 - drawn[0].0);
    let up = (drawn[1].1 - drawn[0].1) / (drawn[2].1 - drawn[0].1);
    // To a quarter of a pixel in some hundreds.
    assert!(
        (along - 1.0 / 3.0).abs() < 1e-3 && (up - 0.5).abs() < 2e-3,
        "{along} {up}"
    );
    assert!(drawn[2].1 < drawn[0].1, "up is up");
}

#[test]
fn a_long_series_is_short_in_the_file_and_keeps_its_spike() {
    let x: Vec<f64> = (0..1_000_000).map(|i| f64::from(i) * 1e-9).collect();
    let mut y: Vec<f64> = x.iter().map(|t| (t * 1e5).sin()).collect();
    y[654_321] = 3.0;
    let svg = force(vec![curve("F", &x, &y, Role::Computed)])
        .svg()
        .unwrap();
    assert!(svg.len() < 100_000, "{}", svg.len());
    let drawn = vertices(&svg, FIRST);
    let top = drawn.iter().min_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
    let (left, right) = (drawn[0].0, drawn[drawn.len() - 1].0);
    assert!(((top.0 - left) / (right - left) - 0.654_321).abs() < 1e-3);
    // -1 at the bottom, 3 at the top: the spike stands two ranges of the sine above its crests' middle.
    let bottom = drawn.iter().map(|p| p.1).fold(0.0, f64::max);
    let crest = drawn[..drawn.len() / 2]
        .iter()
        .map(|p| p.1)
        .fold(f64::MAX, f64::min);
    assert!(((bottom - top.1) / (bottom - crest) - 2.0).abs() < 0.01);
}

#[test]
fn rare_spikes_of_the_acceleration_are_clipped_and_it_is_said() {
    let x: Vec<f64> = (0..1000).map(f64::from).collect();
    let mut y: Vec<f64> = x.iter().map(|t| t.sin()).collect();
    (y[500], y[501]) = (1e6, -2e6);
    let acceleration = vec![curve("a", &x, &y, Role::Computed)];
    let svg = contact_figure(
        "A",
        ContactCurves {
            acceleration,
            ..ContactCurves::default()
        },
    )
    .svg()
    .unwrap();
    assert!(svg.contains("clipped: 2 samples, to −2.00·10⁶ m/s²"));
    assert!(svg.contains("Acceleration (m/s²)"));
    let force = force(vec![curve("a", &x, &y, Role::Computed)])
        .svg()
        .unwrap();
    assert!(!force.contains("clipped"), "a force is never clipped");
}

#[test]
fn constants_zeros_and_single_samples_are_drawn() {
    let x = [0.0, 1.0, 2.0];
    for value in [0.0, 7.0, -1e-12, 1e300] {
        let y = [value; 3];
        let svg = force(vec![curve("F", &x, &y, Role::Computed)])
            .svg()
            .unwrap();
        let drawn = vertices(&svg, FIRST);
        assert_eq!(drawn.len(), 3, "{value}");
        assert!(drawn.iter().all(|point| point.1 == drawn[0].1));
    }
    let svg = force(vec![curve("F", &[1.0], &[2.0], Role::Computed)])
        .svg()
        .unwrap();
    assert_eq!(svg.matches("<circle").count(), 1);
}

#[test]
fn what_cannot_be_drawn_is_refused_with_its_place() {
    let refused = |x: &[f64], y: &[f64]| {
        force(vec![curve("F", x, y, Role::Computed)])
            .svg()
            .unwrap_err()
    };
    let error = refused(&[0.0, 1.0, 2.0], &[0.0, f64::NAN, 1.0]);
    assert_eq!(
        error.to_string(),
        "curve 'F': the ordinate of sample 1 is NaN"
    );
    let error = refused(&[0.0, f64::INFINITY], &[0.0, 1.0]);
    assert_eq!(
        error.to_string(),
        "curve 'F': the abscissa of sample 1 is inf"
    );
    let error = refused(&[0.0, 1.0, 0.5], &[0.0, 1.0, 1.0]);
    assert_eq!(error.to_string(), "curve 'F': sample 2 goes back to 0.5");
    let error = refused(&[0.0, 1.0], &[0.0]);
    assert_eq!(
        error.to_string(),
        "curve 'F' has 2 abscissae and 1 ordinates"
    );
    let error = refused(&[], &[]);
    assert!(matches!(error, Error::EmptyPanel { .. }), "{error}");
}

#[test]
fn a_panel_without_data_is_left_out_beside_others() {
    let (x, y) = ([0.0, 1.0], [0.0, 2.0]);
    let curves = |velocity| ContactCurves {
        displacement: vec![curve("a", &x, &y, Role::Computed)],
        velocity,
        ..ContactCurves::default()
    };
    let alone = contact_figure("A", curves(Vec::new())).svg().unwrap();
    let beside = curves(vec![curve("b", &[], &[], Role::Computed)]);
    assert_eq!(contact_figure("A", beside).svg().unwrap(), alone);
}
