//! What is wrong in a file.

/// What is wrong in a line.
#[derive(Debug)]
pub(super) struct Fault {
    pub line: usize,
    pub found: String,
    pub expected: String,
    /// Whether it is sound, but not read.
    pub unsupported: bool,
}

impl Fault {
    pub fn new(line: usize, found: impl ToString, expected: impl Into<String>) -> Fault {
        Fault {
            line,
            found: found.to_string(),
            expected: expected.into(),
            unsupported: false,
        }
    }

    pub fn unsupported(line: usize, found: impl ToString, accepted: impl Into<String>) -> Fault {
        Fault {
            unsupported: true,
            ..Fault::new(line, found, accepted)
        }
    }
}
