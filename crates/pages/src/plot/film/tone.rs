//! Colours, polygons in the plane of the picture, and where they are drawn.

pub(super) const SQUARES: f64 = 220.0;

/// Steps of colour.
pub(super) const LEVELS: usize = 24;

/// From nothing to the largest value; ever darker, so that it can be read without colours.
pub(super) const COLOURS: [[f64; 3]; 5] = [
    [238.0, 242.0, 246.0],
    [169.0, 207.0, 229.0],
    [79.0, 156.0, 201.0],
    [43.0, 95.0, 165.0],
    [27.0, 42.0, 99.0],
];

/// Steps of shade of solids, the part of the colour that the darkest of them keeps, and where the light comes from: to the
/// right, upward, towards the viewer.
pub(super) const SHADES: usize = 8;

pub(super) const DARK: f64 = 0.84;

/// A polygon in the plane of the picture.
pub(super) struct Flat {
    pub(super) points: Vec<[f64; 2]>,
    pub(super) tone: Tone,
    pub(super) depth: f64,
}

/// A colour: the step of its value, and how much light falls on it, the most being `SHADES - 1`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Tone {
    pub(super) level: usize,
    pub(super) shade: usize,
}

impl Tone {
    /// Of a value in full light.
    pub(super) fn bright(level: usize) -> Tone {
        Tone {
            level,
            shade: SHADES - 1,
        }
    }
}

/// Where a frame is drawn: pixels per metre, the corner of the model's box (m), the corner of the frame and its size (px).
pub(super) struct Window {
    pub(super) scale: f64,
    pub(super) low: [f64; 2],
    pub(super) corner: [f64; 2],
    pub(super) size: [f64; 2],
}

impl Window {
    /// Pixels of a place, downward.
    pub(super) fn at(&self, x: [f64; 2]) -> [f64; 2] {
        [
            self.corner[0] + self.scale * (x[0] - self.low[0]),
            self.corner[1] + self.size[1] - self.scale * (x[1] - self.low[1]),
        ]
    }
}

/// A colour of the scale, `#rrggbb`.
pub(super) fn colour(tone: Tone) -> String {
    let place = tone.level as f64 / (LEVELS - 1) as f64 * (COLOURS.len() - 1) as f64;
    let below = (place as usize).min(COLOURS.len() - 2);
    let part = place - below as f64;
    let light = DARK + (1.0 - DARK) * tone.shade as f64 / (SHADES - 1) as f64;
    let [r, g, b] = [0, 1, 2].map(|i| {
        let [from, to] = [COLOURS[below][i], COLOURS[below + 1][i]];
        (light * (from + part * (to - from))).round() as u8
    });
    format!("#{r:02x}{g:02x}{b:02x}")
}
