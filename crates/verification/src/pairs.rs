//! Every pair of features with every scheme and law.
//!
//! Problem: the two blocks of `features`, with two features at once: each pair is built with each registered scheme and a law of each
//! kind, or refused with a reason. Closed solution: the balances of energy and momentum. Tolerance: as in `combinations`. The table of the
//! manual counts what is refused. Sizes: quick runs one scheme and law with each pair, full a law with each scheme and pair.

use std::collections::BTreeMap;

use carom_contact::{Basis, Integration, Law, Sliding};
use carom_dynamics::{Model, Scheme, System};

use crate::Error;
use crate::check::{Check, Row, Size};
use crate::combinations::Balances;
use crate::features::{
    Built, Feature, damped, fly, in_contact, label, preloaded, reduced, schemes, zones,
};
use crate::reasons::reason;

/// Features that go on top of each other.
const PARTS: [Feature; 13] = [
    Feature::Friction,
    Feature::FiniteStrain,
    Feature::Plasticity,
    Feature::Viscosity,
    Feature::Mortar,
    Feature::FiniteSliding,
    Feature::StaticStage,
    Feature::Massless,
    Feature::Reduced,
    Feature::DampedModes,
    Feature::Adaptive,
    Feature::UnequalZones,
    Feature::BetweenZones,
];

/// Two features at once.
#[derive(Clone, Copy, Debug)]
struct Pair([Feature; 2]);

impl Pair {
    /// All that are no contradiction.
    fn all() -> impl Iterator<Item = Pair> {
        let all = PARTS.iter().enumerate();
        let all = all.flat_map(|(k, one)| PARTS[k + 1..].iter().map(|other| Pair([*one, *other])));
        all.filter(|pair| !pair.is_contradiction())
    }

    fn has(self, feature: Feature) -> bool {
        self.0.contains(&feature)
    }

    /// Two materials of one body; modes, which are those of a linear body, with another material or of a reduced body; the division of a body that has modes.
    fn is_contradiction(self) -> bool {
        let materials = [
            Feature::FiniteStrain,
            Feature::Plasticity,
            Feature::Viscosity,
        ];
        let both = self.0.iter().all(|feature| materials.contains(feature));
        let modes = [Feature::Reduced, Feature::DampedModes];
        let modal = self.0.iter().any(|feature| modes.contains(feature));
        let twice = self.0 == modes;
        let cut = materials.iter().any(|own| self.has(*own)) || self.has(Feature::UnequalZones);
        both || twice || modal && cut
    }

    fn name(self) -> String {
        let [one, other] = self.0.map(Feature::name);
        format!("{one} + {other}")
    }

    /// The blocks with both features.
    ///
    /// # Errors
    /// A combination that is refused.
    fn built(self, scheme: Scheme, law: Law) -> Result<Built, Error> {
        let mut model = self.model(scheme, law)?;
        for feature in self.0 {
            self.add(feature, &mut model)?;
        }
        if !self.has(Feature::UnequalZones) && !self.has(Feature::BetweenZones) {
            return Ok(Built::One(System::new(model)?, None));
        }
        if !self.has(Feature::UnequalZones) {
            return Built::zoned(in_contact(model, 4));
        }
        let mut zoned = zones(model, 4)?;
        if self.has(Feature::BetweenZones) {
            // the lower block takes two steps where the tip of the upper one takes four
            let mut lower = zoned.zones[0].clone();
            zoned.zones[0].bodies.retain(|body| *body != 1);
            (lower.name, lower.bodies, lower.substeps) = ("lower".to_owned(), vec![1], 2);
            zoned.zones.push(lower);
        }
        Built::zoned(zoned)
    }

    fn model(self, scheme: Scheme, law: Law) -> Result<Model, Error> {
        let meshes = match self.has(Feature::Massless) {
            true => Feature::Massless,
            false => Feature::Friction,
        };
        let sliding = match self.has(Feature::FiniteSliding) || self.has(Feature::FiniteStrain) {
            true => Sliding::Finite,
            false => Sliding::Small,
        };
        let mut model = meshes.blocks(1).model(scheme, law, sliding)?;
        let plain = Feature::Friction.material();
        let own = self.0.map(Feature::material);
        if let Some(material) = own.into_iter().find(|material| *material != plain) {
            for body in &mut model.bodies {
                body.spec.material = material;
            }
        }
        Ok(model)
    }

    fn add(self, feature: Feature, model: &mut Model) -> Result<(), Error> {
        match feature {
            Feature::Friction => model.contacts[0].friction = 0.3.into(),
            Feature::Mortar => {
                model.contacts[0].integration = Integration::Mortar {
                    basis: Basis::Standard,
                }
            }
            Feature::StaticStage => preloaded(model)?,
            Feature::Massless => model.contacts[0].massless = true,
            Feature::Reduced => reduced(model)?,
            Feature::DampedModes => damped(model)?,
            Feature::Adaptive => {
                let place = model.bodies[0].displacement;
                fly(model);
                if self.has(Feature::StaticStage) {
                    // what flies has no static stage
                    model.bodies[0].displacement = place;
                }
            }
            _ => {}
        }
        Ok(())
    }
}

/// What became of the combinations of a pair.
#[derive(Default)]
struct Counts {
    run: usize,
    all: usize,
}

/// What became of all combinations.
#[derive(Default)]
struct Counted {
    pairs: Vec<(Pair, Counts)>,
    /// How often each reason refuses one.
    reasons: BTreeMap<String, usize>,
}

fn counted() -> Result<Counted, Error> {
    let Counted {
        mut pairs,
        mut reasons,
    } = Counted::default();
    for pair in Pair::all() {
        let mut counts = Counts::default();
        for scheme in schemes() {
            for (_, law) in Feature::Friction.laws()? {
                counts.all += 1;
                match pair.built(scheme, law) {
                    Ok(_) => counts.run += 1,
                    Err(error) => {
                        let why = reason(&error).ok_or(error)?;
                        *reasons.entry(why).or_insert(0) += 1;
                    }
                }
            }
        }
        pairs.push((pair, counts));
    }
    Ok(Counted { pairs, reasons })
}

/// The table of the manual.
///
/// # Errors
/// A model that cannot be built and is not refused.
pub fn table() -> Result<String, Error> {
    let Counted { pairs, reasons } = counted()?;
    let titles = PARTS.map(Feature::name);
    let mut text = format!(
        "| | {} |\n|---|{}\n",
        titles[1..].join(" | "),
        "---|".repeat(PARTS.len() - 1)
    );
    for (k, one) in PARTS.iter().enumerate().take(PARTS.len() - 1) {
        let cell = |(j, other): (usize, &Feature)| {
            let found = pairs.iter().find(|(pair, _)| pair.0 == [*one, *other]);
            match found {
                Some((_, counts)) => counts.run.to_string(),
                None if j <= k => String::new(),
                None => "–".to_owned(),
            }
        };
        let cells: Vec<String> = PARTS.iter().enumerate().skip(1).map(cell).collect();
        text += &format!("| {} | {} |\n", one.name(), cells.join(" | "));
    }
    let all: usize = pairs.iter().map(|(_, counts)| counts.all).sum();
    let run: usize = pairs.iter().map(|(_, counts)| counts.run).sum();
    let each = pairs.first().map_or(0, |(_, counts)| counts.all);
    text += &format!(
        "\n{run} of {all} combinations run, of {each} for each pair; {} are refused:\n\n",
        all - run
    );
    let mut sorted: Vec<(&String, &usize)> = reasons.iter().collect();
    sorted.sort_by_key(|(reason, count)| (std::cmp::Reverse(**count), reason.as_str()));
    for (reason, count) in sorted {
        text += &format!("* {reason} ({count} combinations)\n");
    }
    Ok(text)
}

/// Runs of a pair.
#[derive(Default)]
struct Runs {
    taken: usize,
    failed: usize,
    /// The first that failed, and why.
    first: String,
    worst: f64,
}

impl Runs {
    fn add(&mut self, built: &Built, [scheme, law]: [&str; 2]) {
        self.taken += 1;
        match run(built) {
            Ok(balances) => self.worst = self.worst.max(balances.worst()),
            Err(error) if reason(&error).is_some() => self.taken -= 1,
            Err(error) => {
                self.failed += 1;
                if self.first.is_empty() {
                    self.first = format!(" ({scheme}, {law}: {error})");
                }
            }
        }
    }
}

fn run(built: &Built) -> Result<Balances, Error> {
    let mut run = built.start()?;
    while run.state().step < Feature::Friction.steps() {
        run.step()?;
    }
    Ok(Balances::of(run.state()))
}

pub(crate) const CHECK: Check = Check {
    name: "pairs",
    fact: "two features at once keep the balances with every scheme that takes them",
    run: |size| {
        let mut rows = Vec::new();
        let laws = Feature::Friction.laws()?;
        for (k, pair) in Pair::all().enumerate() {
            let mut runs = Runs::default();
            for (j, scheme) in schemes().into_iter().enumerate() {
                // another law with each scheme and pair, of those that they take
                let found = (0..laws.len()).find_map(|i| {
                    let (name, law) = laws[(i + j + k) % laws.len()];
                    pair.built(scheme, law).ok().map(|built| (built, name))
                });
                let Some((built, law)) = found else { continue };
                runs.add(&built, [&label(scheme), law]);
                if size == Size::Quick {
                    break;
                }
            }
            let name = |what: &str| format!("{}: {what}", pair.name());
            rows.extend([
                Row::shown(name("runs"), runs.taken as f64),
                Row::count(name("runs that failed") + &runs.first, runs.failed, 0),
                Row::at_most(name("residuals of the balances / bound"), runs.worst, 1.0),
            ]);
        }
        Ok(rows)
    },
};
