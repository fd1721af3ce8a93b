//! A position in the content of an MSH file: words, numbers of either encoding, section marks.
//!
//! Knows how numbers are written and how large a count can be, not what they mean. Every fault carries the byte at
//! which the offending item starts; its line is counted only when a message is made.

use std::path::Path;
use std::str::FromStr;

use crate::read::{Place, ReadError};

/// How the numbers of the file are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Encoding {
    Text,
    LittleEndian,
    BigEndian,
}

/// Something in the file that cannot be accepted.
#[derive(Debug)]
pub(super) struct Fault {
    at: usize,
    found: String,
    expected: String,
    unsupported: bool,
}

impl Fault {
    /// A breach of the format at a byte of the file.
    pub(super) fn new(at: usize, found: impl ToString, expected: impl ToString) -> Fault {
        Fault {
            at,
            found: found.to_string(),
            expected: expected.to_string(),
            unsupported: false,
        }
    }

    /// Adds which of several like things was being read; `index` counts from 0.
    pub(super) fn within(mut self, thing: &str, index: usize, count: usize) -> Fault {
        if !self.unsupported {
            self.expected += &format!(" ({thing} {} of {count})", index + 1);
        }
        self
    }
}

/// The place of the next byte to read; see the module.
pub(super) struct Cursor<'a> {
    content: &'a [u8],
    at: usize,
    /// Where the item read last starts.
    last: usize,
    encoding: Encoding,
}

impl<'a> Cursor<'a> {
    /// At the first line that is not blank, taking numbers as text.
    pub(super) fn new(content: &'a [u8]) -> Cursor<'a> {
        let mut cursor = Cursor {
            content,
            at: 0,
            last: 0,
            encoding: Encoding::Text,
        };
        cursor.skip(u8::is_ascii_whitespace);
        cursor
    }

    /// Where the item read last starts.
    pub(super) fn last(&self) -> usize {
        self.last
    }

    /// The length of the file.
    pub(super) fn end(&self) -> usize {
        self.content.len()
    }

    /// Whether numbers are text.
    pub(super) fn is_text(&self) -> bool {
        self.encoding == Encoding::Text
    }

    /// A breach of the format by the item read last.
    pub(super) fn fault(&self, found: impl ToString, expected: impl ToString) -> Fault {
        Fault::new(self.last, found, expected)
    }

    /// The item read last is sound, but of a sort that is not read.
    pub(super) fn unsupported(&self, found: impl ToString, accepted: impl ToString) -> Fault {
        Fault {
            unsupported: true,
            ..self.fault(found, accepted)
        }
    }

    /// The message for a fault: lines for text, bytes for binary.
    pub(super) fn error(&self, path: &Path, fault: Fault) -> ReadError {
        // The end of the file is on its last line, also when that ends in a newline.
        let before = &self.content[..fault.at.min(self.content.len().saturating_sub(1))];
        let place = match self.is_text() {
            true => Place::Line(1 + before.iter().filter(|&&byte| byte == b'\n').count()),
            false => Place::Byte(fault.at),
        };
        ReadError::of_content(
            path,
            place,
            (fault.found, fault.expected),
            fault.unsupported,
        )
    }

    /// Takes numbers as text from here on; or as binary, in the byte order that the integer 1 tells, which it reads.
    pub(super) fn set_encoding(&mut self, binary: bool) -> Result<(), Fault> {
        if !binary {
            self.encoding = Encoding::Text;
            return Ok(());
        }
        self.encoding = Encoding::LittleEndian;
        let expected = "the integer 1 in 4 bytes, which tells the byte order";
        self.encoding = match self.take(expected)? {
            [1, 0, 0, 0] => Encoding::LittleEndian,
            [0, 0, 0, 1] => Encoding::BigEndian,
            other => return Err(self.fault(format!("the bytes {other:?}"), expected)),
        };
        Ok(())
    }

    /// The name of the next section, without its `$`; none at the end of the file.
    pub(super) fn section(&mut self) -> Result<Option<String>, Fault> {
        self.skip(u8::is_ascii_whitespace);
        if self.at == self.content.len() {
            return Ok(None);
        }
        let expected = "the mark of a section, such as $Nodes";
        let word = self.word(expected)?;
        let name = std::str::from_utf8(word).ok();
        let name = name.and_then(|word| word.strip_prefix('$'));
        match name.filter(|name| !name.is_empty() && !name.starts_with("End")) {
            Some(name) => {
                self.end_line()?;
                Ok(Some(name.to_owned()))
            }
            None => Err(self.fault(show(word), expected)),
        }
    }

    /// Reads the given mark on a line of its own.
    pub(super) fn marker(&mut self, marker: &str) -> Result<(), Fault> {
        self.skip(u8::is_ascii_whitespace);
        let word = self.word(marker)?;
        if word != marker.as_bytes() {
            return Err(self.fault(show(word), marker));
        }
        self.end_line()
    }

    /// Skips to the given mark, whatever stands before it.
    pub(super) fn skip_to(&mut self, marker: &str) -> Result<(), Fault> {
        let marker = marker.as_bytes();
        let rest = &self.content[self.at..];
        let here = |&start: &usize| {
            let after = rest[start..].strip_prefix(marker);
            after.is_some_and(|after| after.first().is_none_or(u8::is_ascii_whitespace))
        };
        match (0..rest.len()).find(here) {
            Some(start) => {
                self.at += start;
                Ok(())
            }
            None => {
                let expected = String::from_utf8_lossy(marker);
                Err(Fault::new(self.content.len(), END_OF_FILE, expected))
            }
        }
    }

    /// The next word of this line; `expected` says what it is.
    pub(super) fn word(&mut self, expected: &str) -> Result<&'a [u8], Fault> {
        self.skip(is_blank);
        self.last = self.at;
        match self.content.get(self.at) {
            None => return Err(self.fault(END_OF_FILE, expected)),
            Some(b'\n') => return Err(self.fault("the end of the line", expected)),
            Some(_) => self.skip(|byte| !byte.is_ascii_whitespace()),
        }
        Ok(&self.content[self.last..self.at])
    }

    /// The next text of this line in double quotes, without them.
    pub(super) fn quoted(&mut self) -> Result<String, Fault> {
        let expected = "a name in double quotes";
        let start = self.word(expected)?;
        if start[0] != b'"' {
            return Err(self.fault(show(start), expected));
        }
        let rest = &self.content[self.last + 1..];
        let line = rest.split(|&byte| byte == b'\n').next().unwrap_or(rest);
        let Some(length) = line.iter().position(|&byte| byte == b'"') else {
            return Err(self.fault("a name without the closing quote", expected));
        };
        self.at = self.last + 1 + length + 1;
        match std::str::from_utf8(&line[..length]) {
            Ok("") => Err(self.fault("an empty name", expected)),
            Ok(name) => Ok(name.to_owned()),
            Err(_) => {
                let found = format!("{}, which is not UTF-8", show(&line[..length]));
                Err(self.fault(found, expected))
            }
        }
    }

    /// Ends the line: nothing but blanks may be left on it. In a text file, skips the blank lines after it.
    pub(super) fn end_line(&mut self) -> Result<(), Fault> {
        self.skip(is_blank);
        if self.at < self.content.len() && self.content[self.at] != b'\n' {
            let word = self.word("the end of the line")?;
            return Err(self.fault(show(word), "the end of the line"));
        }
        self.at = (self.at + 1).min(self.content.len());
        if self.is_text() {
            self.skip(u8::is_ascii_whitespace);
        }
        Ok(())
    }

    /// Ends a record of numbers: a line of a text file, nothing in a binary one.
    pub(super) fn end_record(&mut self) -> Result<(), Fault> {
        match self.is_text() {
            true => self.end_line(),
            false => Ok(()),
        }
    }

    /// The next word as a number in text, whatever the encoding.
    pub(super) fn written<T: FromStr>(&mut self, expected: &str) -> Result<T, Fault> {
        let word = self.word(expected)?;
        let number = std::str::from_utf8(word).ok();
        let number = number.and_then(|word| word.parse().ok());
        number.ok_or_else(|| self.fault(show(word), expected))
    }

    /// An integer; 4 bytes if binary.
    pub(super) fn integer(&mut self, expected: &str) -> Result<i64, Fault> {
        let from = |number: i32| number.into();
        Ok(match self.encoding {
            Encoding::Text => self.written(expected)?,
            Encoding::LittleEndian => from(i32::from_le_bytes(self.take(expected)?)),
            Encoding::BigEndian => from(i32::from_be_bytes(self.take(expected)?)),
        })
    }

    /// An integer that is not negative; 4 bytes if binary.
    pub(super) fn natural(&mut self, expected: &str) -> Result<u64, Fault> {
        let number = self.integer(expected)?;
        u64::try_from(number).map_err(|_| self.fault(number, expected))
    }

    /// An integer that is not negative; 8 bytes if binary.
    pub(super) fn size(&mut self, expected: &str) -> Result<u64, Fault> {
        match self.encoding {
            Encoding::Text => self.written(expected),
            Encoding::LittleEndian => Ok(u64::from_le_bytes(self.take(expected)?)),
            Encoding::BigEndian => Ok(u64::from_be_bytes(self.take(expected)?)),
        }
    }

    /// A real number, finite or not; 8 bytes if binary.
    pub(super) fn real(&mut self, expected: &str) -> Result<f64, Fault> {
        match self.encoding {
            Encoding::Text => self.written(expected),
            Encoding::LittleEndian => Ok(f64::from_le_bytes(self.take(expected)?)),
            Encoding::BigEndian => Ok(f64::from_be_bytes(self.take(expected)?)),
        }
    }

    /// The three coordinates of a point, finite.
    pub(super) fn point(&mut self) -> Result<[f64; 3], Fault> {
        let mut x = [0.0; 3];
        for component in &mut x {
            let expected = "a finite coordinate";
            *component = self.real(expected)?;
            if !component.is_finite() {
                return Err(self.fault(*component, expected));
            }
        }
        Ok(x)
    }

    /// Accepts the count read last if the rest of the file can hold so many things of at least `numbers` numbers:
    /// the bound of every allocation and loop.
    pub(super) fn bounded(&self, count: u64, numbers: usize) -> Result<usize, Fault> {
        let rest = self.content.len() - self.at;
        let bytes = numbers * if self.is_text() { 2 } else { 4 };
        let most = rest / bytes + 1;
        let bounded = usize::try_from(count).ok().filter(|&count| count <= most);
        bounded.ok_or_else(|| {
            let expected = format!("at most {most}, which is what the rest of the file can hold");
            self.fault(format!("the count {count}"), expected)
        })
    }

    /// The next bytes, as they stand.
    fn take<const N: usize>(&mut self, expected: &str) -> Result<[u8; N], Fault> {
        self.last = self.at;
        let Some(bytes) = self.content[self.at..].first_chunk::<N>() else {
            return Err(self.fault(END_OF_FILE, format!("{N} bytes: {expected}")));
        };
        self.at += N;
        Ok(*bytes)
    }

    fn skip(&mut self, what: impl Fn(&u8) -> bool) {
        let rest = &self.content[self.at..];
        self.at += rest
            .iter()
            .position(|byte| !what(byte))
            .unwrap_or(rest.len());
    }
}

const END_OF_FILE: &str = "the end of the file";

fn is_blank(byte: &u8) -> bool {
    byte.is_ascii_whitespace() && *byte != b'\n'
}

/// A word of the file as it can stand in a message: in quotes, escaped, cut when long.
fn show(word: &[u8]) -> String {
    const LONGEST: usize = 40;
    let text = String::from_utf8_lossy(&word[..word.len().min(LONGEST)]);
    let cut = if word.len() > LONGEST { "..." } else { "" };
    format!("\"{}{cut}\"", text.escape_debug())
}
