//! Where the page shows what a line of the verdict is about.

/// The section of the page to which a line of the verdict leads, by its name: the plot of its quantity, else the table that has it.
pub fn section(line: &str) -> &'static str {
    match line {
        "energy-residual" | "momentum-residual" | "contact-impulse" | "resizing" => "plot-residual",
        "energy-gain" | "scheme-made" | "contact-work" | "contact-loss" | "scheme-energy"
        | "hourglass" => "plot-energy",
        "chatter" => "plot-status",
        "penetration" => "plot-gap",
        "step-in-contact" | "force-error" | "not-finite" => "plot-force",
        "angular-momentum-residual" => "balances",
        "deleted-cells" | "loose-nodes" | "rotation" | "strain" | "slide" | "turn" => "model",
        _ => "work",
    }
}
