//! Levels of contacts, what is allowed, and statistics of impacts.

use carom_pages::html::{cells, each, heads, line, percent, quantity, text, when, wide};

use crate::report::contacts::joules;
use crate::statistics::{Histogram, Level, Margin, Statistics};
use crate::summary::Summary;

/// Levels against what they may bear.
pub(super) fn levels(summary: &Summary) -> String {
    let levels = &summary.levels;
    let has = |margin: fn(&Level) -> &Option<Margin>| levels.values().any(|l| margin(l).is_some());
    let strokes = has(|level| &level.stroke_margin);
    let crushes = has(|level| &level.crush_margin);
    let mut names = vec!["Level"];
    names.extend(["Force of an impact, allowed", "Margin", "Governing"]);
    names.extend(["Energy of an impact, allowed", "Margin", "Governing"]);
    if strokes {
        names.extend(["Stroke, allowed", "Margin", "Governing"]);
    }
    if crushes {
        names.extend(["Crush that stays, allowed", "Margin", "Governing"]);
    }
    let row = |(name, level): (&String, &Level)| {
        let cells = [
            margin(level.force_margin.as_ref(), "N"),
            margin(level.energy_margin.as_ref(), "J"),
            when(strokes, || margin(level.stroke_margin.as_ref(), "m")),
            when(crushes, || margin(level.crush_margin.as_ref(), "m")),
        ];
        line(name, &cells.concat())
    };
    when(!levels.is_empty(), || {
        let table = wide(true, &names, &each(levels, row));
        format!(
            "\n<h2 id=\"levels\">Levels</h2>\n{table}<p class=\"faint\">Margin: allowable over found, less one; negative where the allowable is exceeded. Found: the largest value of any impact of any contact of the level.</p>\n"
        )
    })
}

/// Bodies, supports, springs and bolts against what they may bear.
pub(super) fn allowables(summary: &Summary) -> String {
    let rows = each(&summary.allowables, |check| {
        let name = format!("{} of {} {}", check.quantity, check.kind, check.name);
        line(&name, &margin(Some(&check.margin), &check.unit))
    });
    let every = match summary.maxima.stress_every {
        every if every > 1 => {
            format!("one step in {every}, of each static step and of the kept instants")
        }
        _ => "all steps".to_owned(),
    };
    when(!summary.allowables.is_empty(), || {
        let names = ["", "Largest, allowed", "Margin", "Governing"];
        let table = wide(false, &names, &rows);
        format!(
            "\n<h2 id=\"allowables\">Allowables</h2>\n{table}<p class=\"faint\">Margin: allowable over found, less one; negative where the allowable is exceeded. Stresses are those of {every}, plastic strains those of the kept instants: between them they may have been larger.</p>\n"
        )
    })
}

/// Three cells: found of allowed, the margin, and what governs.
fn margin(margin: Option<&Margin>, unit: &str) -> String {
    let Some(margin) = margin else {
        return "<td></td><td></td><td></td>".to_owned();
    };
    let part = match margin.margin {
        Some(part) if part < 0.0 => format!("<b class=\"bad\">{}</b>", percent(part)),
        part => percent(part),
    };
    let governing = margin.governing.as_ref();
    let governing =
        governing.map(|(name, time)| format!("{} at {}", text(name), quantity(*time, "s")));
    cells(&[
        format!(
            "{} of {}",
            quantity(margin.found, unit),
            quantity(margin.allowable, unit)
        ),
        part,
        governing.unwrap_or_default(),
    ])
}

/// Statistics of levels and contacts, where a contact has more than one impact or there are levels.
pub(super) fn statistics(summary: &Summary) -> String {
    let names = |first| {
        heads(&[
            first,
            "Impacts",
            "Peak force",
            "Mean of the peaks",
            "Mean force",
            "Largest impulse",
            "Impulses",
            "Longest",
            "Durations",
            "Largest energy taken up",
            "Energies taken up",
            "Lost",
            "Lost in friction",
            "By peak force",
            "By energy taken up",
        ])
    };
    let joules = |energy: f64| joules(summary, energy);
    let row = |(name, s): (&String, &Statistics)| {
        let shown = [
            s.count.to_string(),
            quantity(s.peak_force, "N"),
            quantity(s.mean_peak_force, "N"),
            quantity(s.mean_force, "N"),
            quantity(s.largest_impulse, "N s"),
            quantity(s.impulse, "N s"),
            quantity(s.longest, "s"),
            quantity(s.duration, "s"),
            joules(s.energy_taken),
            joules(s.energy_taken_sum),
            joules(s.energy_lost),
            joules(s.friction_loss),
            bars(&s.force_classes, "N"),
            bars(&s.energy_classes, "J"),
        ];
        line(name, &cells(&shown))
    };
    let levels = summary
        .levels
        .iter()
        .map(|(name, level)| (name, &level.statistics));
    let contacts = summary.contacts.iter();
    let contacts =
        contacts.filter_map(|(name, contact)| Some((name, contact.statistics.as_ref()?)));
    let has_many = summary.contacts.values().any(|contact| contact.impacts > 1);
    let of_levels = when(!summary.levels.is_empty(), || {
        let rows = each(levels, row);
        format!("<thead>{}</thead>\n<tbody>{rows}\n</tbody>", names("Level"))
    });
    when(has_many || !summary.levels.is_empty(), || {
        let rows = each(contacts, row);
        let head = names("Contact");
        format!("\n<h2>Statistics of the impacts</h2>
<div class=\"wide\"><table class=\"dense\">
{of_levels}
<thead>{head}</thead>
<tbody>{rows}
</tbody></table></div>
<p class=\"faint\">Mean force: impulses over durations. Taken up: the largest energy that a contact has taken at one time in an impact; a stop stores it, and loses a part of it. Histograms: ten classes of equal width up to the largest value.</p>
")
    })
}

/// Height of the bars, and from one to the next.
const BARS: [usize; 2] = [24, 9];

/// A histogram as bars.
fn bars(classes: &Histogram, unit: &str) -> String {
    let [height, step] = BARS;
    let most = classes.counts.iter().copied().max().unwrap_or(0) as f64;
    let bar = |(k, count): (usize, &u64)| {
        let high = (height as u64 * count) as f64 / most;
        let low = height as f64 - high;
        let from = quantity(k as f64 * classes.width, unit);
        let to = quantity((k + 1) as f64 * classes.width, unit);
        format!(
            "<rect x=\"{}\" y=\"{low}\" width=\"8\" height=\"{high}\" fill=\"#2166ac\"><title>{count}: {from} to {to}</title></rect>",
            step * k
        )
    };
    let count = classes.counts.len();
    when(count > 0, || {
        let counts: Vec<String> = classes.counts.iter().map(u64::to_string).collect();
        format!(
            "<svg class=\"bars\" width=\"{}\" height=\"{height}\" role=\"img\" aria-label=\"{} impacts in {count} classes of {}\">{}</svg>",
            step * count,
            counts.join(", "),
            quantity(classes.width, unit),
            each(classes.counts.iter().enumerate(), bar)
        )
    })
}

/// The strongest impacts of each level.
pub(super) fn strongest(summary: &Summary) -> String {
    let joules = |energy: f64| joules(summary, energy);
    let of_level = |(name, level): (&String, &Level)| {
        each(&level.statistics.worst, |worst| {
            let shown = [
                text(&worst.contact),
                quantity(worst.time, "s"),
                quantity(worst.peak_force, "N"),
                worst.peak_steps.to_string(),
                quantity(worst.impulse, "N s"),
                quantity(worst.duration, "s"),
                joules(worst.energy_taken),
                joules(worst.friction_loss),
            ];
            line(name, &cells(&shown))
        })
    };
    when(!summary.levels.is_empty(), || {
        let names = [
            "Level",
            "Contact",
            "Time of the peak",
            "Peak force",
            "Its steps",
            "Impulse",
            "Duration",
            "Energy taken up",
            "Lost in friction",
        ];
        let table = wide(true, &names, &each(&summary.levels, of_level));
        format!("\n<h3>Strongest impacts</h3>\n{table}")
    })
}
