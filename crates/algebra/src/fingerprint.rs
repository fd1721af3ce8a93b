//! Fingerprints of bytes and numbers: whether two things are the same, without protection against intent.

/// FNV-1a of 64 bits (Fowler, Noll and Vo).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fingerprint(u64);

impl Default for Fingerprint {
    fn default() -> Fingerprint {
        Fingerprint(0xcbf2_9ce4_8422_2325)
    }
}

impl Fingerprint {
    /// Adds bytes.
    #[must_use]
    pub fn bytes(self, bytes: &[u8]) -> Fingerprint {
        let add =
            |digest: u64, byte: &u8| (digest ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
        Fingerprint(bytes.iter().fold(self.0, add))
    }

    /// Adds whole numbers, and how many they are.
    #[must_use]
    pub fn counts(self, counts: impl ExactSizeIterator<Item = usize>) -> Fingerprint {
        let begun = self.bytes(&(counts.len() as u64).to_le_bytes());
        counts.fold(begun, |print, count| {
            print.bytes(&(count as u64).to_le_bytes())
        })
    }

    /// Adds numbers by their bits, and how many they are.
    #[must_use]
    pub fn numbers(self, numbers: &[f64]) -> Fingerprint {
        let begun = self.bytes(&(numbers.len() as u64).to_le_bytes());
        numbers
            .iter()
            .fold(begun, |print, number| print.bytes(&number.to_le_bytes()))
    }

    /// The upper and the lower 32 bits.
    pub fn halves(self) -> [u32; 2] {
        [(self.0 >> 32) as u32, self.0 as u32]
    }

    /// 16 hexadecimal digits.
    pub fn digits(self) -> String {
        format!("{:016x}", self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fingerprints_are_the_published_ones() {
        // test vectors of the authors
        assert_eq!(Fingerprint::default().digits(), "cbf29ce484222325");
        assert_eq!(
            Fingerprint::default().bytes(b"foobar").digits(),
            "85944171f73967e8"
        );
    }
}
