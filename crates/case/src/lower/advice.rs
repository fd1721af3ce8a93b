//! Pairs of time scheme and contact law that the chapter on schemes advises against.

use carom_contact::Law;
use carom_contact::law::Displacement;

use crate::schema::Scheme;

/// A pair with the reason against it; the chapter says it in the same words.
struct Advice {
    is: fn(&Scheme, &Law) -> bool,
    /// Whether it is for nodes that have mass.
    of_masses: bool,
    reason: &'static str,
}

/// All of them. The numbers behind them are in the tables of the chapter: two bars, and a bar that bounces 200 times.
const AGAINST: [Advice; 9] = [
    Advice {
        is: |scheme, law| {
            matches!(scheme, Scheme::Newmark(s) if s.gamma == 0.5 && s.beta == 0.25)
                && is_plain(law)
        },
        of_masses: true,
        reason: "the trapezoidal rule with the displacement law gains energy below a Courant number of about 4",
    },
    Advice {
        is: |scheme, law| {
            matches!(scheme, Scheme::Newmark(s) if s.gamma == 0.5) && is_velocity(law)
        },
        of_masses: false,
        reason: "Newmark's scheme without damping opens and closes the contact at every other step under the velocity law",
    },
    Advice {
        is: |scheme, law| matches!(scheme, Scheme::Theta(s) if s.theta == 0.5) && is_plain(law),
        of_masses: false,
        reason: "theta = 1/2 with the displacement law has a force that oscillates about the exact one without decay",
    },
    Advice {
        is: |scheme, law| {
            matches!(scheme, Scheme::LaursenChawla(_)) && (is_plain(law) || is_velocity(law))
        },
        of_masses: false,
        reason: "the scheme of Laursen and Chawla conserves the energy, but the contact chatters and its force is useless",
    },
    Advice {
        is: |scheme, _| matches!(scheme, Scheme::LaursenLove(_)),
        of_masses: false,
        reason: "the scheme of Laursen and Love conserves the energy, but the contact chatters and its force is useless",
    },
    Advice {
        is: |scheme, _| matches!(scheme, Scheme::Kane(s) if s.gamma == 0.5),
        of_masses: false,
        reason: "Kane's scheme without damping has a force that oscillates about the exact one without decay",
    },
    Advice {
        is: |scheme, law| matches!(scheme, Scheme::Hht(_)) && is_plain(law),
        of_masses: false,
        reason: "the scheme of Hilber, Hughes and Taylor with the displacement law chatters and gains energy over many impacts",
    },
    Advice {
        is: |scheme, law| matches!(scheme, Scheme::Bathe(_)) && is_plain(law),
        of_masses: true,
        reason: "Bathe's scheme with the displacement law chatters and gains energy below a Courant number of about 2",
    },
    Advice {
        is: |scheme, law| matches!(scheme, Scheme::Bathe(_)) && matches!(law, Law::Restitution(_)),
        of_masses: false,
        reason: "under Bathe's scheme a rigid body rebounds faster than its coefficient says: the force of an impact acts on in the next stage",
    },
];

/// The displacement law without projection.
fn is_plain(law: &Law) -> bool {
    matches!(law, Law::Displacement(Displacement { projection: false }))
}

fn is_velocity(law: &Law) -> bool {
    matches!(law, Law::Velocity(_))
}

/// Why a pair is advised against; `massless`: nodes without mass take no energy as they close.
pub(super) fn against(
    scheme: &Scheme,
    law: &Law,
    massless: bool,
) -> impl Iterator<Item = &'static str> {
    let is = move |advice: &&Advice| (advice.is)(scheme, law) && !(massless && advice.of_masses);
    AGAINST.iter().filter(is).map(|advice| advice.reason)
}

#[cfg(test)]
mod tests {
    use super::AGAINST;

    #[test]
    fn the_chapter_says_every_reason() {
        let chapter = include_str!("../../../../docs/src/which-scheme.md");
        let chapter = chapter.split_whitespace().collect::<Vec<_>>().join(" ");
        for advice in &AGAINST {
            assert!(chapter.contains(advice.reason), "{}", advice.reason);
        }
    }
}
