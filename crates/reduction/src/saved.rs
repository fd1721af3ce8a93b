//! Reductions as bytes, with a fingerprint of all that they follow from.
//!
//! One line of text, `carom-reduction <fingerprint> <checksum>`, then the bytes. The fingerprint is that of the matrices of the full body, which
//! hold its mesh, material, section and formulation, of what is held and retained, and of the modes asked for. Damping is not part of it: it is added
//! to the reduced matrices.

use carom_algebra::csr::Csr;
use carom_algebra::fingerprint::Fingerprint;

use crate::condense::Condensed;
use crate::error::Error;
use crate::full::{Full, Keep};

/// First word.
const HEAD: &str = "carom-reduction";

/// Changes with the bases and with the bytes.
const VERSION: usize = 2;

impl Full {
    /// Fingerprint of all that the reduced matrices follow from.
    pub(crate) fn fingerprint(&self, keep: &Keep) -> Fingerprint {
        let flags = [VERSION, keep.modes, usize::from(keep.massless)];
        let places = self.system.x.iter().flatten().copied();
        let print = Fingerprint::default()
            .counts(flags.into_iter())
            .numbers(&places.collect::<Vec<_>>())
            .counts(self.border.iter().copied())
            .counts(self.fixed.iter().map(|fixed| usize::from(*fixed)));
        let of = |print: Fingerprint, matrix: &Csr| {
            let rows = 0..matrix.n;
            rows.fold(print, |print, i| {
                let (columns, values) = matrix.row(i);
                print
                    .counts(columns.iter().map(|j| *j as usize))
                    .numbers(values)
            })
        };
        of(of(print, &self.matrices.stiffness), &self.matrices.mass)
    }

    /// The saved matrices, if they follow from the same.
    pub(crate) fn decoded(&self, keep: &Keep, saved: &[u8]) -> Result<Option<Condensed>, Error> {
        let damaged = |why: &'static str| Error::Saved {
            body: self.name.clone(),
            why,
        };
        let end = saved
            .iter()
            .position(|byte| *byte == b'\n')
            .unwrap_or(saved.len());
        let head = String::from_utf8_lossy(&saved[..end]);
        let words: Vec<&str> = head.split(' ').collect();
        let [HEAD, fingerprint, checksum] = words[..] else {
            return Err(damaged("it is no reduction that carom saved"));
        };
        let bytes = saved.get(end + 1..).unwrap_or(&[]);
        if Fingerprint::default().bytes(bytes).digits() != checksum {
            return Err(damaged("it was damaged: its checksum differs"));
        }
        if fingerprint != self.fingerprint(keep).digits() {
            return Ok(None);
        }
        let condensed: Condensed =
            postcard::from_bytes(bytes).map_err(|_| damaged("its bytes are no reduction"))?;
        match condensed.has_sizes(self.matrices.mass.n, self.border.len(), keep.modes) {
            true => Ok(Some(condensed)),
            false => Err(damaged("its sizes are not those of the body")),
        }
    }

    /// The bytes to save.
    pub(crate) fn encoded(&self, keep: &Keep, condensed: &Condensed) -> Result<Vec<u8>, Error> {
        let bytes = postcard::to_stdvec(condensed).map_err(|_| Error::Saved {
            body: self.name.clone(),
            why: "its bytes cannot be encoded",
        })?;
        let (fingerprint, checksum) =
            (self.fingerprint(keep), Fingerprint::default().bytes(&bytes));
        let head = format!("{HEAD} {} {}\n", fingerprint.digits(), checksum.digits());
        Ok([head.into_bytes(), bytes].concat())
    }
}
