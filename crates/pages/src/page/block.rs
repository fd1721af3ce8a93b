//! The arrays of a page in one compressed block.
//!
//! Bytes of an array stand in planes: the lowest byte of every number, then the next ones. Integers are differences to the number
//! before, modulo their size. Neighbours in an array are neighbours in the mesh or in time, so most planes are nearly
//! constant, and the block is compressed well (DEFLATE without a header, then base 64).

use std::io::Write;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::DeflateEncoder;
use serde::Serialize;

use crate::Error;

/// Levels of displacements, and of fields, which colours show: 16 and 12 bits.
pub const FINE: u16 = u16::MAX;

/// See [`FINE`].
pub const COARSE: u16 = (1 << 12) - 1;

/// An array in the block.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Array {
    /// Place of its first byte.
    pub at: usize,
    /// Numbers in it.
    pub count: usize,
    /// `f32`, `u32`, `u16` or `u8`.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// Value of 0 in an array of `u16` that stands for real numbers; that of `most` is `high`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub low: Option<f64>,
    /// See `low`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub high: Option<f64>,
    /// See `low`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub most: Option<u16>,
}

/// The arrays so far.
#[derive(Clone, Debug, Default)]
pub struct Block {
    bytes: Vec<u8>,
}

impl Block {
    /// Bytes before compression.
    pub fn len(&self) -> usize {
        self.bytes.len()
    }

    /// Whether there is no array.
    pub fn is_empty(&self) -> bool {
        self.bytes.is_empty()
    }

    /// Adds real numbers in single precision.
    pub fn reals(&mut self, values: impl IntoIterator<Item = f64>) -> Array {
        let values = values.into_iter().map(|value| (value as f32).to_le_bytes());
        self.planes("f32", values.collect())
    }

    /// Adds indices.
    pub fn indices(&mut self, values: impl IntoIterator<Item = u32>) -> Array {
        let mut last = 0_u32;
        let values = values.into_iter().map(|value| {
            let difference = value.wrapping_sub(last);
            last = value;
            difference.to_le_bytes()
        });
        self.planes("u32", values.collect())
    }

    /// Adds small numbers: statuses, switches.
    pub fn bytes(&mut self, values: impl IntoIterator<Item = u8>) -> Array {
        self.planes("u8", values.into_iter().map(|value| [value]).collect())
    }

    /// Adds real numbers in `most` + 1 equal levels from the least to the largest. What is not finite becomes the least.
    /// Error: half a level, (high - low) / (2 `most`).
    pub fn levels(&mut self, values: impl Iterator<Item = f64> + Clone, most: u16) -> Array {
        let finite = values.clone().filter(|value| value.is_finite());
        let [low, high] = finite.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
            [low.min(value), high.max(value)]
        });
        let (low, high) = match low <= high {
            true => (low, high),
            false => (0.0, 0.0),
        };
        let scale = match high > low {
            true => f64::from(most) / (high - low),
            false => 0.0,
        };
        let mut last = 0_u16;
        let values = values.map(|value| {
            // a NaN becomes 0
            let level = ((value - low) * scale).round() as u16;
            let difference = level.wrapping_sub(last);
            last = level;
            difference.to_le_bytes()
        });
        Array {
            low: Some(low),
            high: Some(high),
            most: Some(most),
            ..self.planes("u16", values.collect())
        }
    }

    fn planes<const N: usize>(&mut self, kind: &'static str, values: Vec<[u8; N]>) -> Array {
        let at = self.bytes.len();
        for plane in 0..N {
            self.bytes.extend(values.iter().map(|value| value[plane]));
        }
        Array {
            at,
            count: values.len(),
            kind,
            ..Array::default()
        }
    }

    /// The block as text.
    ///
    /// # Errors
    /// [`Error::Compression`].
    pub fn text(&self) -> Result<String, Error> {
        let refused = |cause: std::io::Error| Error::Compression {
            cause: cause.to_string(),
        };
        let mut encoder = DeflateEncoder::new(Vec::new(), Compression::new(7));
        encoder.write_all(&self.bytes).map_err(refused)?;
        Ok(STANDARD.encode(encoder.finish().map_err(refused)?))
    }
}

#[cfg(test)]
#[allow(
    clippy::unwrap_used,
    reason = "clippy sees only #[test] functions as tests"
)]
mod tests {
    use std::io::Read;

    use super::*;

    /// The numbers of an array as the page reads them.
    fn read(block: &Block, array: &Array) -> Vec<u32> {
        let compressed = STANDARD.decode(block.text().unwrap()).unwrap();
        let mut bytes = Vec::new();
        flate2::read::DeflateDecoder::new(&compressed[..])
            .read_to_end(&mut bytes)
            .unwrap();
        let size = match array.kind {
            "u8" => 1,
            "u16" => 2,
            _ => 4,
        };
        let number = |k: usize| {
            let byte =
                |plane: usize| u32::from(bytes[array.at + plane * array.count + k]) << (8 * plane);
            (0..size).map(byte).sum()
        };
        (0..array.count).map(number).collect()
    }

    /// Sums of differences modulo a size.
    fn sums(values: &[u32], modulus: u64) -> Vec<u32> {
        let mut sum = 0;
        let mut add = |value: &u32| {
            sum = (sum + u64::from(*value)) % modulus;
            sum as u32
        };
        values.iter().map(&mut add).collect()
    }

    #[test]
    fn what_is_read_is_what_was_added() {
        let mut block = Block::default();
        let wanted = [7, 3, u32::MAX, 0, 100_000];
        let indices = block.indices(wanted);
        let reals = block.reals([0.1, -2.5e-7, 3e30]);
        let bytes = block.bytes([3, 0, 255]);
        assert_eq!(sums(&read(&block, &indices), 1 << 32), wanted);
        let found: Vec<f32> = read(&block, &reals)
            .iter()
            .map(|b| f32::from_bits(*b))
            .collect();
        assert_eq!(found, [0.1, -2.5e-7, 3e30]);
        assert_eq!(read(&block, &bytes), [3, 0, 255]);
        assert_eq!(block.len(), 5 * 4 + 3 * 4 + 3);
    }

    #[test]
    fn levels_are_off_by_half_a_level_at_most_and_keep_both_ends() {
        let mut block = Block::default();
        let values = (0..1000).map(|k| (0.37 * f64::from(k)).sin() * 250e6);
        let array = block.levels(values.clone(), FINE);
        let (low, high) = (array.low.unwrap(), array.high.unwrap());
        let found = sums(&read(&block, &array), 1 << 16);
        let value = |level: &u32| low + f64::from(*level) * (high - low) / 65535.0;
        for (level, exact) in found.iter().zip(values) {
            // half a level, and the rounding of the sum
            assert!((value(level) - exact).abs() <= (high - low) / 131_070.0 * (1.0 + 1e-9));
        }
        assert!(found.contains(&0) && found.contains(&65535));
    }

    #[test]
    fn a_constant_and_what_is_not_finite_have_a_level() {
        let mut block = Block::default();
        let constant = block.levels([5.0, 5.0].into_iter(), COARSE);
        assert_eq!((constant.low, constant.high), (Some(5.0), Some(5.0)));
        let none = block.levels([f64::NAN, f64::INFINITY].into_iter(), COARSE);
        assert_eq!((none.low, none.high), (Some(0.0), Some(0.0)));
    }
}
