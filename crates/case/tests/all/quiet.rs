//! Runs in which nothing happens: they end as others do.

use crate::verdict::result_with;

#[test]
fn a_probe_at_rest_has_a_spectrum_of_zeros_and_ends_no_run() {
    let text = r#"
carom = 1
mass.a = { mass = 1.0, at = [0.0] }
spring.a = { ends = ["a", "ground"], axis = [1.0], stiffness = 1e4 }
probe.p = { on = "a", record = ["acceleration"], response-spectrum = { from = "10 Hz", to = "100 Hz" } }
time = { end = 0.2, step = "1 ms", scheme.newmark = {} }
"#;
    let (summary, spectra) = result_with(text, "spectra.csv");
    assert_eq!(summary.verdict.unfinished, None);
    let values = spectra.iter().filter(|(name, _)| name.contains("probe"));
    let values: Vec<f64> = values.flat_map(|(_, values)| values).copied().collect();
    assert!(!values.is_empty() && values.iter().all(|value| *value == 0.0));
}
