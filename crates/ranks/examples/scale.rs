//! The communication of a large partition, counted and not run: a cube of hexahedra whose elements `partition` shares out to ranks.
//!
//! The parts of a grid for a power of two of ranks are boxes, up to a plane of elements, and their cuts are found without a list of the elements. Printed are the elements, the neighbours and
//! the numbers of the busiest rank, and the predicted efficiency of explicit steps. `docs/src/ranks.md` says where the costs come from.
//!
//!     cargo run --release -p carom-ranks --example scale

#![allow(clippy::print_stdout)]

use carom_ranks::partition;

/// Seconds of one processor for an element in a step, all in all, and for a contact point that is far or closed.
const ELEMENT: f64 = 0.5e-6;
const POINT: f64 = 0.05e-6;
/// Seconds for a message, and bytes a second to and from a rank: of the networks of present clusters.
const LATENCY: f64 = 2e-6;
const BANDWIDTH: f64 = 2e9;

/// Elements of a part, from and to, by axis.
type Part = [[u64; 2]; 3];

/// Cuts a box for the ranks from `ranks[0]` to `ranks[1]` as [`partition`] does.
fn cut(own: Part, ranks: [usize; 2], parts: &mut Vec<Part>) {
    if ranks[1] - ranks[0] == 1 {
        parts.push(own);
        return;
    }
    let middle = ranks[0] + (ranks[1] - ranks[0]) / 2;
    let side = |i: usize| own[i][1] - own[i][0];
    let mut axis = 0;
    for i in 1..3 {
        if side(i) > side(axis) {
            axis = i;
        }
    }
    let wanted = side(axis) as f64 * (middle - ranks[0]) as f64 / (ranks[1] - ranks[0]) as f64;
    let plane = own[axis][0] + wanted.round() as u64;
    let (mut one, mut other) = (own, own);
    (one[axis][1], other[axis][0]) = (plane, plane);
    cut(one, [ranks[0], middle], parts);
    cut(other, [middle, ranks[1]], parts);
}

/// Nodes that two boxes share.
fn shared(a: &Part, b: &Part) -> u64 {
    let along = |i: usize| {
        let [from, to] = [a[i][0].max(b[i][0]), a[i][1].min(b[i][1])];
        (to + 1).saturating_sub(from)
    };
    along(0) * along(1) * along(2)
}

/// Neighbours and shared nodes, once for each neighbour, of some of the parts: the largest of each.
fn busiest(parts: &[Part], every: usize) -> [u64; 2] {
    let mut most = [0, 0];
    for own in parts.iter().step_by(every) {
        let (mut neighbours, mut nodes) = (0, 0);
        for other in parts {
            let count = shared(own, other);
            if count > 0 && own != other {
                (neighbours, nodes) = (neighbours + 1, nodes + count);
            }
        }
        most = [most[0].max(neighbours), most[1].max(nodes)];
    }
    most
}

/// That boxes are the parts that [`partition`] makes, where these are boxes too.
fn agrees(n: u64, ranks: usize) -> bool {
    let of = |k: u64| [k % n, k / n % n, k / n / n];
    let points: Vec<[f64; 3]> = (0..n * n * n)
        .map(|k| of(k).map(|i| i as f64 + 0.5))
        .collect();
    let found = partition(&points, &vec![1.0; points.len()], ranks);
    let mut parts = Vec::new();
    cut([[0, n]; 3], [0, ranks], &mut parts);
    (0..n * n * n).zip(&found).all(|(k, &part)| {
        let own = &parts[part as usize];
        of(k)
            .iter()
            .zip(own)
            .all(|(i, [from, to])| (from..to).contains(&i))
    })
}

fn main() {
    assert!(
        agrees(8, 8) && agrees(16, 32) && agrees(16, 64),
        "boxes are not the parts"
    );
    println!(
        "unknowns ranks elements neighbours bytes communication without_contacts on_obstacle on_surface"
    );
    for (n, ranks) in [(149, 1024), (693, 1024), (693, 8192), (693, 131_072)] {
        let mut parts = Vec::new();
        cut([[0, n]; 3], [0, ranks], &mut parts);
        let elements = |part: &Part| part.iter().map(|[from, to]| to - from).product::<u64>();
        let most = parts.iter().map(elements).max().unwrap_or(0);
        let [neighbours, nodes] = busiest(&parts, (ranks / 1000).max(1));
        let bytes = 24 * nodes;
        let halo = neighbours as f64 * LATENCY + bytes as f64 / BANDWIDTH;
        // sums to all and two words of the first rank, each up and down a tree
        let tree = (ranks as f64).log2().ceil() * LATENCY;
        let sums = 5.0 * tree;
        let work = most as f64 * ELEMENT;
        let ideal = (n * n * n) as f64 * ELEMENT / ranks as f64;
        // a side of the cube on an obstacle: each rank has the points of its nodes, and gives their forces to the neighbours that share them;
        // what the contacts did is summed
        let side = |part: &Part| (0..2).map(|i| part[i][1] - part[i][0] + 1).product::<u64>();
        let points = parts.iter().filter(|part| part[2][0] == 0).map(side).max();
        let points = points.unwrap_or(0) as f64;
        let shared = 8.0 * LATENCY + 24.0 * 4.0 * points.sqrt() / BANDWIDTH;
        let spread = points * POINT + shared + 2.0 * tree;
        // a side against another surface: one rank has all points
        let all = ((n + 1) * (n + 1)) as f64;
        let gathered = all * (POINT + 24.0 / BANDWIDTH) + 2.0 * tree;
        let efficiency = |contact: f64| ideal / (work + halo + sums + contact);
        println!(
            "{:.2e} {ranks} {most} {neighbours} {bytes} {:.1e} {:.2} {:.2} {:.3}",
            3.0 * ((n + 1) as f64).powi(3),
            halo + sums,
            efficiency(0.0),
            efficiency(spread),
            efficiency(gathered),
        );
    }
}
