//! Parts of the surfaces of one contact that do not touch each other.

use std::collections::BTreeSet;

/// A part that a face belongs to, as a body of a general contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part {
    /// Its number.
    pub number: u32,
    /// Whether the face is of the first side of a contact that looks both ways; none where the sides are those of the contact.
    pub is_first: Option<bool>,
}

/// The parts that the faces of a contact belong to, and which of them do not touch: pairs of numbers, and faces of one side of a contact that looks
/// both ways.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Parts {
    /// Of each face of the secondary surface.
    pub secondary: Vec<Part>,
    /// Of each face of the target.
    pub primary: Vec<Part>,
    /// Pairs of parts that do not touch, each with the lower number first; twice the same for a part that does not touch itself.
    pub apart: BTreeSet<[u32; 2]>,
}

impl Part {
    /// The part of a face whose side is that of the contact.
    pub fn of(number: u32) -> Part {
        Part {
            number,
            is_first: None,
        }
    }
}

impl Parts {
    /// The parts of two sides with this many faces, of one part each where none are given, both together as secondary surface and as target:
    /// faces of one side do not touch. `lines`: how many lines of the second side are behind the faces in the target.
    pub fn both_ways(given: Option<&Parts>, [first, second]: [usize; 2], lines: usize) -> Parts {
        let number =
            |of: fn(&Parts) -> &Vec<Part>, k: usize| given.map_or(0, |parts| of(parts)[k].number);
        let one = (0..first).map(|k| Part {
            number: number(|parts| &parts.secondary, k),
            is_first: Some(true),
        });
        let other = (0..second).map(|k| Part {
            number: number(|parts| &parts.primary, k),
            is_first: Some(false),
        });
        let both: Vec<Part> = one.chain(other).collect();
        let line = Part {
            // bodies that do not touch are told by their faces alone
            number: u32::MAX,
            is_first: Some(false),
        };
        let primary = both.iter().copied();
        Parts {
            primary: primary.chain(std::iter::repeat_n(line, lines)).collect(),
            secondary: both,
            apart: given.map(|parts| parts.apart.clone()).unwrap_or_default(),
        }
    }

    /// Whether any two faces do not touch.
    pub(super) fn keep_any_apart(&self) -> bool {
        !self.apart.is_empty() || self.primary.iter().any(|part| part.is_first.is_some())
    }

    /// Whether a point with these secondary faces around it never touches a face of the target.
    pub(super) fn keep_apart(&self, around: &[u32], item: u32) -> bool {
        // lines that were added to the target are of no part
        let Some(&other) = self.primary.get(item as usize) else {
            return false;
        };
        let mut own = around.iter().map(|&face| self.secondary[face as usize]);
        own.all(|own| {
            let pair = [own.number, other.number];
            let sides = own.is_first.is_some() && own.is_first == other.is_first;
            let pair = [pair[0].min(pair[1]), pair[0].max(pair[1])];
            sides || self.apart.contains(&pair)
        })
    }
}
