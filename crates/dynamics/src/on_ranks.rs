//! What several ranks do not take.

use std::fmt;

use carom_bodies::NotShared;

/// What several ranks do not take.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum OnRanks {
    /// Another scheme than central differences with lumped mass and equal steps, or several.
    Scheme,
    /// A static stage.
    StaticStage,
    /// Links, ties and constraints.
    Links,
    /// Forces of damping.
    Damping,
    /// A body other than a solid or a bar, by its name.
    Body(String),
    /// A solid that is not shared out, by its name.
    Share(String, NotShared),
    /// A load that follows its surface.
    Follower,
    /// The weak form of a law, or a law with impulses beside its forces, by the name of the contact.
    Contact(String),
}

impl fmt::Display for OnRanks {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            OnRanks::Scheme => f.write_str(
                "other schemes than central differences with lumped mass and steps of one size",
            ),
            OnRanks::StaticStage => f.write_str("a static stage"),
            OnRanks::Links => f.write_str("links, ties and constraints"),
            OnRanks::Damping => f.write_str("damping"),
            OnRanks::Body(name) => write!(f, "body '{name}', which is neither a solid nor a bar"),
            OnRanks::Share(name, why) => write!(f, "{} of body '{name}'", why.text()),
            OnRanks::Follower => f.write_str("a pressure that follows its surface"),
            OnRanks::Contact(name) => {
                write!(f, "the weak form or the impulses of contact '{name}'")
            }
        }
    }
}
