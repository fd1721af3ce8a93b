//! When a point that is far from what it faces has to be looked at again.
//!
//! What was found at a look holds until the motion since then can have brought something within reach. That motion is
//! bounded for all points at once: by the largest motion of a node in each pairing, added up. A translation that all
//! nodes share (the *drift*) is no such motion. None of this changes results: a point that rests would have been found far.

use crate::Places;

/// Points whose instants are looked at together.
pub(crate) const BLOCK: usize = 64;

/// Reach over the largest motion of a node in a step.
const MOTIONS: f64 = 8.0;

/// The least that a reach must be, over that motion.
pub(crate) const AHEAD: f64 = 4.0;

/// Least reach over the largest.
const LEAST: f64 = 1.0 / 64.0;

/// Part of a distance that counts as rounding.
const ROUNDING: f64 = 1e-9;

/// When the points of a contact are to be looked at.
#[derive(Debug, Default)]
pub(crate) struct Rest {
    /// Nodes of both sides, each once, ascending.
    nodes: Vec<u32>,
    /// Their places at the last pairing, m.
    places: Vec<[f64; 3]>,
    /// Motion that all nodes are thought to share from one pairing to the next, m.
    drift: [f64; 3],
    /// Displacement of the translating target at the last pairing, m.
    target: [f64; 3],
    /// Sum of the drifts, m.
    shift: [f64; 3],
    /// Sum of the bounds, m.
    travelled: f64,
    /// Most that Σ |N_a| is on a face.
    spread: f64,
    /// Largest motion of a node in the last pairing, what all share included, m.
    motion: f64,
    /// Gap that points at rest are known to be beyond, m.
    watched: f64,
    /// `travelled` from which on a point is to be looked at.
    wakes: Vec<f64>,
    /// The least of each block.
    least: Vec<f64>,
    /// The points that are looked at, ascending; none for all.
    own: Option<Vec<u32>>,
}

impl Rest {
    /// Whether this is for so many points.
    pub(crate) fn is_for(&self, points: usize) -> bool {
        self.wakes.len() == points && !self.nodes.is_empty()
    }

    /// Begins with the nodes of both sides, each once. `own`: the points that are looked at, ascending, none for all; `spread`: the most
    /// that Σ |N_a| is on their faces; `target`: displacement of an obstacle, m.
    pub(crate) fn begin(
        (points, own): (usize, Option<&[u32]>),
        (nodes, spread): (Vec<u32>, f64),
        places: &Places,
        target: Option<[f64; 3]>,
    ) -> Rest {
        let mut rest = Rest {
            places: nodes.iter().map(|&node| places.of(node)).collect(),
            nodes,
            spread,
            // nothing is known of the step before
            motion: f64::INFINITY,
            target: target.unwrap_or_default(),
            wakes: vec![f64::INFINITY; points],
            least: vec![f64::INFINITY; points.div_ceil(BLOCK)],
            own: own.map(<[u32]>::to_vec),
            ..Rest::default()
        };
        rest.wake_all();
        rest
    }

    /// Takes the places of a pairing: bounds the motion since the last one. `target`: displacement of an obstacle now, m.
    pub(crate) fn travel(&mut self, places: &Places, target: Option<[f64; 3]>) {
        if let Some(now) = target {
            self.drift = [0, 1, 2].map(|i| now[i] - self.target[i]);
            self.target = now;
        }
        let (drift, mut largest, mut sum) = (self.drift, 0.0_f64, [0.0; 3]);
        let mut longest = 0.0_f64;
        for (&node, before) in self.nodes.iter().zip(&mut self.places) {
            let x = places.of(node);
            let (mut square, mut whole) = (0.0, 0.0);
            for i in 0..3 {
                let way = x[i] - before[i];
                sum[i] += way;
                square += (way - drift[i]).powi(2);
                whole += way.powi(2);
            }
            largest = largest.max(square);
            longest = longest.max(whole);
            *before = x;
        }
        if sum.iter().any(|sum| !sum.is_finite()) {
            // places of an iteration that leads nowhere: nothing is known of the way from them or to them
            (self.drift, self.motion) = ([0.0; 3], f64::INFINITY);
            return self.wake_all();
        }
        self.travelled += self.spread * largest.sqrt();
        self.motion = self.spread * longest.sqrt();
        for i in 0..3 {
            self.shift[i] += drift[i];
        }
        if target.is_none() {
            self.drift = sum.map(|sum| sum / self.nodes.len() as f64);
        }
        if !self.travelled.is_finite() {
            self.travelled = 0.0;
            self.wake_all();
        }
    }

    /// Lets all points be looked at.
    pub(crate) fn wake_all(&mut self) {
        let Some(own) = &self.own else {
            self.wakes.fill(f64::NEG_INFINITY);
            self.least.fill(f64::NEG_INFINITY);
            return;
        };
        for &point in own {
            self.wakes[point as usize] = f64::NEG_INFINITY;
            self.least[point as usize / BLOCK] = f64::NEG_INFINITY;
        }
    }

    /// Largest motion of a node in the last pairing, what all share included, m; infinite in the first.
    pub(crate) fn motion(&self) -> f64 {
        self.motion
    }

    /// Gap within which a point may touch now, where the last pairing was one step before, m; at most `most` (m), unless that is less than
    /// what touches.
    ///
    /// Nodes of both sides have moved by at most the motion m in the step, so that a gap has changed by 2 m. Laws look one step
    /// ahead or two, by 4 m; the motion of a step is less than twice that of the step before it but for bodies that begin to
    /// move, for which there is a least reach. A point that has come in the step may be behind what it faced by 2 m, however much that is.
    pub(crate) fn reach(motion: f64, most: f64) -> f64 {
        (MOTIONS * motion).clamp(LEAST * most, Rest::least_reach(motion, most))
    }

    /// `most` (m), or what touches after a motion (m) where that is more; of one that is not known `most`.
    pub(crate) fn least_reach(motion: f64, most: f64) -> f64 {
        match motion.is_finite() {
            true => most.max(AHEAD * motion),
            false => most,
        }
    }

    /// The gap that points at rest are to be beyond, m: at least a reach, and more by a factor of 2 to 8, so that it stays for many steps; at
    /// most `most`. Points are looked at again where it changes.
    pub(crate) fn watch(&mut self, reach: f64, most: f64) -> f64 {
        if !(reach..=8.0 * reach).contains(&self.watched) {
            self.watched = (2.0 * reach).min(most);
            self.wake_all();
        }
        self.watched
    }

    /// Bound of the motion so far, and the drift so far, m.
    pub(crate) fn travelled(&self) -> (f64, [f64; 3]) {
        (self.travelled, self.shift)
    }

    /// The points to be looked at, ascending, into `due`, which is cleared first.
    pub(crate) fn due(&self, due: &mut Vec<u32>) {
        due.clear();
        for (block, _) in self
            .least
            .iter()
            .enumerate()
            .filter(|(_, least)| **least <= self.travelled)
        {
            let first = block * BLOCK;
            let wakes = &self.wakes[first..self.wakes.len().min(first + BLOCK)];
            let awake = wakes.iter().zip(first as u32..);
            due.extend(
                awake
                    .filter(|(wake, _)| **wake <= self.travelled)
                    .map(|(_, point)| point),
            );
        }
    }

    /// Lets a point rest until the bound of the motion of both sides has grown by `clearance` (m).
    pub(crate) fn lay(&mut self, point: u32, clearance: f64) {
        let slack = ROUNDING * self.travelled;
        self.wakes[point as usize] = self.travelled + (1.0 - ROUNDING) * clearance.max(0.0) - slack;
    }

    /// Takes note of the instants of the points that were looked at.
    pub(crate) fn close(&mut self, due: &[u32]) {
        let mut last = usize::MAX;
        for &point in due {
            let block = point as usize / BLOCK;
            if block == last {
                continue;
            }
            last = block;
            let first = block * BLOCK;
            let wakes = &self.wakes[first..self.wakes.len().min(first + BLOCK)];
            self.least[block] = wakes
                .iter()
                .fold(f64::INFINITY, |least, wake| least.min(*wake));
        }
    }
}
