//! Element types, and the numbers of their faces.

use carom_elements::Kind;

/// What is read, for messages.
pub(super) const TYPES: &str = "C3D4, C3D5, C3D6, C3D8, C3D10, C3D15, C3D20, CPS, CPE, CAX, S, M3D and R3D of 3, 4, 6, 8 or 9 nodes, STRI3, STRI65, B21, B22, B31, B32, B33, \
                                  T2D2, T3D2, MASS";

/// A family of types, and its kinds by the number behind its name.
type Family = (&'static str, fn(u32) -> Option<Kind>);

/// The kind of an element type; none of types that are not read.
pub(super) fn kind(name: &str) -> Option<Kind> {
    let name = name.to_uppercase();
    match name.as_str() {
        "STRI3" => return Some(Kind::Tri3),
        "STRI65" => return Some(Kind::Tri6),
        "MASS" => return Some(Kind::Point1),
        "T2D2" | "T3D2" => return Some(Kind::Bar2),
        _ => {}
    }
    let families: [Family; 10] = [
        ("C3D", solid),
        ("CPS", plane),
        ("CPE", plane),
        ("CAX", plane),
        ("M3D", plane),
        ("R3D", plane),
        ("SFM3D", plane),
        ("S", plane),
        ("B2", beam),
        ("B3", beam),
    ];
    let (family, of) = families.iter().find(|(family, _)| {
        let rest = name.strip_prefix(family);
        rest.is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()))
    })?;
    let digits = name[family.len()..].chars();
    let digits: String = digits.take_while(char::is_ascii_digit).collect();
    of(digits.parse().ok()?)
}

fn solid(nodes: u32) -> Option<Kind> {
    Some(match nodes {
        4 => Kind::Tet4,
        5 => Kind::Pyramid5,
        6 => Kind::Wedge6,
        8 => Kind::Hex8,
        10 => Kind::Tet10,
        15 => Kind::Wedge15,
        20 => Kind::Hex20,
        _ => return None,
    })
}

fn plane(nodes: u32) -> Option<Kind> {
    Some(match nodes {
        3 => Kind::Tri3,
        4 => Kind::Quad4,
        6 => Kind::Tri6,
        8 => Kind::Quad8,
        9 => Kind::Quad9,
        _ => return None,
    })
}

/// Of the order of its interpolation; the cubic beam has two nodes.
fn beam(order: u32) -> Option<Kind> {
    Some(match order {
        1 | 3 => Kind::Bar2,
        2 => Kind::Bar3,
        _ => return None,
    })
}

/// The nodes in our order: where each stands in the file. Beams have their middle node between the others, all else has corners first, in our order.
pub(super) fn order(kind: Kind) -> &'static [usize] {
    match kind {
        Kind::Bar3 => &[0, 2, 1],
        _ => &NATURAL[..kind.table().nodes],
    }
}

const NATURAL: [usize; 27] = [
    0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25,
    26,
];

/// Corners of the faces of a kind, in the order of their numbers, from 1.
pub(super) fn faces(kind: Kind) -> &'static [&'static [usize]] {
    match kind.table().linear {
        Kind::Tet4 => &[&[0, 1, 2], &[0, 3, 1], &[1, 3, 2], &[2, 3, 0]],
        Kind::Hex8 => &[
            &[0, 1, 2, 3],
            &[4, 7, 6, 5],
            &[0, 4, 5, 1],
            &[1, 5, 6, 2],
            &[2, 6, 7, 3],
            &[3, 7, 4, 0],
        ],
        Kind::Wedge6 => &[
            &[0, 1, 2],
            &[3, 5, 4],
            &[0, 3, 4, 1],
            &[1, 4, 5, 2],
            &[2, 5, 3, 0],
        ],
        Kind::Pyramid5 => &[
            &[0, 1, 2, 3],
            &[0, 4, 1],
            &[1, 4, 2],
            &[2, 4, 3],
            &[3, 4, 0],
        ],
        Kind::Tri3 => &[&[0, 1], &[1, 2], &[2, 0]],
        Kind::Quad4 => &[&[0, 1], &[1, 2], &[2, 3], &[3, 0]],
        _ => &[],
    }
}
