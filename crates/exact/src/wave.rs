//! Piecewise-linear functions of time with their integrals: what velocity waves and contact forces are made of.

/// A linear function of time on one piece, anchored at the start of the piece.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Line {
    /// Value at the anchor.
    pub value: f64,
    /// Rate of change per second.
    pub slope: f64,
}

impl Line {
    pub const ZERO: Line = Line {
        value: 0.0,
        slope: 0.0,
    };

    /// Value a time `dt` after the anchor.
    pub fn at(self, dt: f64) -> f64 {
        self.value + self.slope * dt
    }

    /// Integral from the anchor to a time `dt` after it.
    fn integral(self, dt: f64) -> f64 {
        (self.value + 0.5 * self.slope * dt) * dt
    }

    /// The line multiplied by a number.
    pub fn scaled(self, factor: f64) -> Line {
        Line {
            value: factor * self.value,
            slope: factor * self.slope,
        }
    }

    /// The sum of two lines that have the same anchor.
    pub fn plus(self, other: Line) -> Line {
        Line {
            value: self.value + other.value,
            slope: self.slope + other.slope,
        }
    }
}

#[derive(Clone, Copy, Debug)]
struct Piece {
    start: f64,
    line: Line,
    /// Integral from the start of the wave to the start of the piece.
    before: f64,
}

/// A piecewise-linear function of time, with jumps allowed between its pieces.
///
/// At a jump the value is the one after it. Outside its range the function is continued by its first or last piece.
#[derive(Clone, Debug)]
pub struct Wave {
    pieces: Vec<Piece>,
    end: f64,
}

impl Wave {
    /// A wave of one piece from `start` to `end`.
    pub(crate) fn new(start: f64, end: f64, line: Line) -> Wave {
        Wave {
            pieces: vec![Piece {
                start,
                line,
                before: 0.0,
            }],
            end,
        }
    }

    /// Appends a piece up to `end`; a piece that continues the last one within `tolerance` only lengthens it.
    pub(crate) fn push(&mut self, end: f64, line: Line, tolerance: f64) {
        let (start, duration) = (self.end, end - self.end);
        let last = self.last();
        let deviation = |dt: f64| (last.line.at(start - last.start + dt) - line.at(dt)).abs();
        let continues = deviation(0.0) <= tolerance && deviation(duration) <= tolerance;
        if !continues {
            let before = self.integral(start);
            self.pieces.push(Piece {
                start,
                line,
                before,
            });
        }
        self.end = end;
    }

    fn last(&self) -> &Piece {
        &self.pieces[self.pieces.len() - 1]
    }

    fn piece(&self, t: f64) -> &Piece {
        let after = self.pieces.partition_point(|p| p.start <= t);
        &self.pieces[after.saturating_sub(1)]
    }

    /// The piece that holds time `inside`, anchored anew at time `anchor`.
    pub(crate) fn line(&self, inside: f64, anchor: f64) -> Line {
        let piece = self.piece(inside);
        Line {
            value: piece.line.at(anchor - piece.start),
            slope: piece.line.slope,
        }
    }

    /// First breakpoint after time `t`.
    pub(crate) fn next_break(&self, t: f64) -> Option<f64> {
        let after = self.pieces.partition_point(|p| p.start <= t);
        self.pieces.get(after).map(|p| p.start)
    }

    /// Whether the last piece is a constant that `line` continues within `tolerance`.
    pub(crate) fn is_continued(&self, line: Line, tolerance: f64) -> bool {
        let last = self.last().line;
        last.slope == 0.0 && line.slope == 0.0 && (last.value - line.value).abs() <= tolerance
    }

    /// Start of the range, s.
    pub fn start(&self) -> f64 {
        self.pieces[0].start
    }

    /// End of the range, s.
    pub fn end(&self) -> f64 {
        self.end
    }

    /// Value at time `t`, after the jump if there is one.
    pub fn value(&self, t: f64) -> f64 {
        self.line(t, t).value
    }

    /// Integral from the start of the range to time `t`.
    pub fn integral(&self, t: f64) -> f64 {
        let piece = self.piece(t);
        piece.before + piece.line.integral(t - piece.start)
    }

    /// Mean value over a step from `from` to `to`, `to` > `from`.
    pub fn mean(&self, from: f64, to: f64) -> f64 {
        (self.integral(to) - self.integral(from)) / (to - from)
    }

    /// Times where a piece begins, in order, s: the only times of jumps and kinks.
    pub fn breakpoints(&self) -> impl Iterator<Item = f64> + '_ {
        self.pieces.iter().map(|p| p.start)
    }

    /// The graph as a polyline (time, value) with a vertical segment at each jump: what a plot draws.
    pub fn polyline(&self) -> Vec<(f64, f64)> {
        let ends = self.breakpoints().skip(1).chain([self.end]);
        let segments = self.pieces.iter().zip(ends);
        segments
            .flat_map(|(p, end)| [(p.start, p.line.value), (end, p.line.at(end - p.start))])
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp_then_jump() -> Wave {
        let mut wave = Wave::new(
            0.0,
            1.0,
            Line {
                value: 1.0,
                slope: 2.0,
            },
        );
        wave.push(
            2.0,
            Line {
                value: 3.0,
                slope: 2.0,
            },
            1e-14,
        );
        wave.push(
            4.0,
            Line {
                value: -1.0,
                slope: 0.0,
            },
            1e-14,
        );
        wave
    }

    #[test]
    fn a_piece_that_continues_the_last_one_is_merged() {
        assert_eq!(
            ramp_then_jump().breakpoints().collect::<Vec<_>>(),
            [0.0, 2.0]
        );
    }

    #[test]
    fn the_integral_is_the_area_under_the_pieces() {
        let wave = ramp_then_jump();
        assert_eq!(wave.integral(2.0), 6.0);
        assert_eq!(wave.integral(3.0), 5.0);
        assert_eq!(wave.mean(1.0, 4.0), (4.0 - 2.0) / 3.0);
    }

    #[test]
    fn the_value_at_a_jump_is_the_one_after_it() {
        assert_eq!(ramp_then_jump().value(2.0), -1.0);
        assert_eq!(
            ramp_then_jump().polyline(),
            [(0.0, 1.0), (2.0, 5.0), (2.0, -1.0), (4.0, -1.0)]
        );
    }
}
