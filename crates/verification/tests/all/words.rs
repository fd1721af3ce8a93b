//! Words of programs in texts of rows.

use carom_verification::inside::words;

#[test]
fn text_of_programs_becomes_that_of_case_files_and_other_text_stays() {
    for (text, expected) in [
        (
            "NonsmoothAlpha(NonsmoothAlpha { rho_inf: 1.0 }): forces / F0",
            "nonsmooth-alpha, rho_inf = 1.0: forces / F0",
        ),
        (
            "Newmark(Newmark { beta: 0.25, gamma: 0.5 }), displacement",
            "newmark, beta = 0.25, gamma = 0.5, displacement",
        ),
        ("CentralDifference(CentralDifference)", "central-difference"),
        (
            "theta in theta, GravouilCombescure, 4",
            "theta in theta, gravouil-combescure, 4",
        ),
        (
            "largest force of Hertz, MPa, CFL 0.5 (NaN)",
            "largest force of Hertz, MPa, CFL 0.5 (NaN)",
        ),
    ] {
        assert_eq!(words(text), expected);
    }
}
