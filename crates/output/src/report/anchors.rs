//! Where the page shows what a line of the verdict is about.

/// The section of the page to which a line of the verdict leads, by its name: the plot of its quantity, else the table that has it.
pub fn section(line: &str) -> &'static str {
    match line {
        "energy-residual" | "momentum-residual" | "contact-impulse" | "resizing" => "plot-residual",
        "energy-gain" | "scheme-made" | "contact-work" | "contact-loss" | "scheme-loss"
        | "scheme-energy" | "hourglass" => "plot-energy",
        "chatter" | "closed" => "plot-status",
        "rebound" => "plot-energy",
        "sampling" => "plot-load",
        "penetration"
        | "passing"
        | "crossing"
        | "surfaces"
        | "surfaces-under-force"
        | "penetration-between" => "plot-gap",
        "step-in-contact" | "force-error" | "not-finite" | "clipped-tension" | "points-closed" => {
            "plot-force"
        }
        "angular-momentum-residual" => "balances",
        "small-strain-rotation"
        | "small-strain"
        | "met"
        | "warning"
        | "bending-locked"
        | "axis-rotation"
        | "fluid-gap"
        | "compressed-bolt" => "model",
        line if line.starts_with("small-sliding") => "model",
        "added-mass" => "work",
        "expectations" => "expectations",
        _ => "verdict",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_line_of_the_manual_leads_to_a_section_of_the_page() {
        let manual = include_str!("../../../../docs/src/results.md");
        let (_, table) = manual.split_once("| line | number |").unwrap();
        let (table, _) = table.split_once("\n\n").unwrap();
        let first = |row: &str| row.split('|').nth(1).unwrap_or_default().to_owned();
        let cells = table.lines().skip(2).map(first);
        let names: Vec<String> = cells
            .flat_map(|cell| {
                cell.split(',')
                    .map(|name| name.trim().trim_matches('`').to_owned())
                    .collect::<Vec<_>>()
            })
            .collect();
        // as many as there are lines today at least
        assert!(names.len() >= 22, "{names:?}");
        let page = concat!(
            include_str!("../report/mod.rs"),
            include_str!("../report/balances.rs"),
            include_str!("../report/tables.rs"),
            include_str!("../report/work.rs"),
        );
        for name in names {
            let section = section(&name);
            assert_ne!(section, "verdict", "{name}");
            let is_there = [format!("id=\\\"{section}\\\""), format!("(\"{section}\",")];
            assert!(
                is_there.iter().any(|id| page.contains(id)),
                "{name}: {section}"
            );
        }
    }
}
