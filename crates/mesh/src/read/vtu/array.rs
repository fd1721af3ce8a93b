//! The numbers of an array: as text, in base64, or raw; plain or compressed by zlib in blocks.

use std::io::Read;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::read::ZlibDecoder;

use super::document::{Array, Format, Header};

/// Most bytes of one array.
const LARGEST: usize = 16 << 30;

/// What is wrong, in words.
pub(super) type Fault = String;

/// Numbers of an array.
#[derive(Clone, Debug, PartialEq)]
pub enum Numbers {
    /// Whole numbers of any size.
    Integers(Vec<i64>),
    /// Real numbers of any precision.
    Reals(Vec<f64>),
}

impl Numbers {
    /// How many there are.
    #[allow(clippy::len_without_is_empty)]
    pub fn len(&self) -> usize {
        match self {
            Numbers::Integers(values) => values.len(),
            Numbers::Reals(values) => values.len(),
        }
    }

    /// As reals, those of integers exact up to 2^53.
    pub(super) fn reals(self) -> Vec<f64> {
        match self {
            Numbers::Integers(values) => values.into_iter().map(|value| value as f64).collect(),
            Numbers::Reals(values) => values,
        }
    }

    pub(super) fn integers(self) -> Option<Vec<i64>> {
        match self {
            Numbers::Integers(values) => Some(values),
            Numbers::Reals(_) => None,
        }
    }
}

/// Bytes of one number, whether it is real, whether it has a sign.
fn number_type(name: &str) -> Option<(usize, bool, bool)> {
    Some(match name {
        "Int8" => (1, false, true),
        "UInt8" => (1, false, false),
        "Int16" => (2, false, true),
        "UInt16" => (2, false, false),
        "Int32" => (4, false, true),
        "UInt32" => (4, false, false),
        "Int64" => (8, false, true),
        "UInt64" => (8, false, false),
        "Float32" => (4, true, true),
        "Float64" => (8, true, true),
        _ => return None,
    })
}

/// The numbers of an array, `most` at most; `appended`: the bytes after the underscore of the appended data.
///
/// What is compressed may become a thousand times as long: it is expanded only where its head says that it has no more bytes than so many
/// numbers.
pub(super) fn numbers(
    header: &Header,
    (array, most): (&Array, Option<usize>),
    appended: &[u8],
) -> Result<Numbers, Fault> {
    let Some((size, is_real, has_sign)) = number_type(&array.number) else {
        return Err(format!("numbers of type \"{}\"", array.number));
    };
    let most = most.and_then(|most| most.checked_mul(size));
    let header = (header, most.unwrap_or(LARGEST).min(LARGEST));
    let bytes = match array.format {
        Format::Ascii => return of_text(&array.text, is_real),
        Format::Binary => of_base64(header, array.text.trim())?,
        Format::Appended(offset) => {
            let from = appended.get(offset..);
            let from = from.ok_or_else(|| format!("an offset of {offset} beyond the data"))?;
            match header.0.raw {
                true => of_raw(header, from)?,
                false => {
                    let text = from.split(|byte| *byte == b'<').next().unwrap_or_default();
                    of_base64(header, &String::from_utf8_lossy(text))?
                }
            }
        }
    };
    if bytes.len() % size != 0 {
        return Err(format!("{} bytes of numbers of {size}", bytes.len()));
    }
    let numbers = bytes.chunks_exact(size);
    let wide = |bytes: &[u8]| {
        let mut all = [0; 8];
        all[..size].copy_from_slice(bytes);
        u64::from_le_bytes(all)
    };
    Ok(match (is_real, size) {
        (true, 4) => Numbers::Reals(
            numbers
                .map(|b| f64::from(f32::from_bits(wide(b) as u32)))
                .collect(),
        ),
        (true, _) => Numbers::Reals(numbers.map(|b| f64::from_bits(wide(b))).collect()),
        (false, _) => {
            let shift = 64 - 8 * size as u32;
            let signed = |bytes| ((wide(bytes) << shift) as i64) >> shift;
            let integer = |bytes| {
                if has_sign {
                    signed(bytes)
                } else {
                    wide(bytes) as i64
                }
            };
            Numbers::Integers(numbers.map(integer).collect())
        }
    })
}

fn of_text(text: &str, is_real: bool) -> Result<Numbers, Fault> {
    let words = text.split_whitespace();
    let wrong = |word: &str| {
        format!(
            "\"{}\" among numbers",
            word.chars().take(40).collect::<String>()
        )
    };
    match is_real {
        true => {
            let all = words.map(|word| word.parse::<f64>().map_err(|_| wrong(word)));
            Ok(Numbers::Reals(all.collect::<Result<_, _>>()?))
        }
        false => {
            let all = words.map(|word| word.parse::<i64>().map_err(|_| wrong(word)));
            Ok(Numbers::Integers(all.collect::<Result<_, _>>()?))
        }
    }
}

/// A word of the head of an array.
fn word(header: &Header, bytes: &[u8], place: usize) -> Result<usize, Fault> {
    let size = header.word;
    let from = bytes.get(place * size..(place + 1) * size);
    let from = from.ok_or("an array that ends within its head")?;
    let mut all = [0; 8];
    all[..size].copy_from_slice(from);
    usize::try_from(u64::from_le_bytes(all)).map_err(|_| "an array without end".to_owned())
}

/// Lengths of the compressed blocks, and the length of all when they are not, which is `most` at most.
fn blocks((header, most): (&Header, usize), head: &[u8]) -> Result<(Vec<usize>, usize), Fault> {
    let [count, block, last] = [0, 1, 2].map(|place| word(header, head, place));
    let (count, block, last) = (count?, block?, last?);
    let there = head.len() / header.word;
    if count > there.saturating_sub(3) {
        return Err(format!("{count} blocks in {there} words"));
    }
    let lengths = (0..count).map(|k| word(header, head, 3 + k));
    let lengths = lengths.collect::<Result<Vec<usize>, _>>()?;
    let whole = if last == 0 {
        count
    } else {
        count.saturating_sub(1)
    };
    let all = whole
        .checked_mul(block)
        .and_then(|all| all.checked_add(last));
    match all.filter(|all| *all <= most) {
        Some(all) => Ok((lengths, all)),
        None => {
            let found = all.map_or("without end".to_owned(), |all| format!("of {all} bytes"));
            Err(format!(
                "a compressed array {found} in place of {most} at most"
            ))
        }
    }
}

fn inflated(lengths: &[usize], all: usize, mut from: &[u8]) -> Result<Vec<u8>, Fault> {
    let mut bytes = Vec::new();
    for length in lengths {
        let (block, rest) = from
            .split_at_checked(*length)
            .ok_or("a compressed block that is cut off")?;
        from = rest;
        let left = (all - bytes.len()) as u64;
        let read = ZlibDecoder::new(block)
            .take(left + 1)
            .read_to_end(&mut bytes);
        read.map_err(|error| format!("a compressed block that is damaged ({error})"))?;
        if bytes.len() > all {
            break;
        }
    }
    match bytes.len() == all {
        true => Ok(bytes),
        false => Err(format!("{} bytes in place of {all}", bytes.len())),
    }
}

/// `most`: bytes that a compressed array may have.
fn of_raw((header, most): (&Header, usize), from: &[u8]) -> Result<Vec<u8>, Fault> {
    if header.compressed {
        let (lengths, all) = blocks((header, most), from)?;
        let head = (3 + lengths.len()) * header.word;
        return inflated(&lengths, all, &from[head..]);
    }
    let length = word(header, from, 0)?;
    let end = header.word.checked_add(length);
    let bytes = end.and_then(|end| from.get(header.word..end));
    Ok(bytes.ok_or("an array that is cut off")?.to_vec())
}

/// Head and data of an array are encoded apart where it is compressed, together otherwise. `most`: as in [`of_raw`].
fn of_base64((header, most): (&Header, usize), text: &str) -> Result<Vec<u8>, Fault> {
    let decoded = |text: &str| {
        let bytes = STANDARD.decode(text);
        bytes.map_err(|error| format!("base64 that is damaged ({error})"))
    };
    if !header.compressed {
        // what follows in the appended data belongs to other arrays
        let letters = |bytes: usize| bytes.div_ceil(3) * 4;
        let start = text
            .get(..letters(header.word))
            .ok_or("an array without a head")?;
        let length = word(header, &decoded(start)?, 0)?;
        let end = header
            .word
            .checked_add(length)
            .filter(|end| *end <= LARGEST);
        let end = letters(end.ok_or("an array of more than 16 GiB")?);
        let whole = text.get(..end).ok_or("an array that is cut off")?;
        return Ok(decoded(whole)?.split_off(header.word));
    }
    let letters = |bytes: usize| bytes.div_ceil(3) * 4;
    let first = text.get(..letters(3 * header.word));
    let first = decoded(first.ok_or("an array without a head")?)?;
    let count = word(header, &first, 0)?;
    let words = count
        .checked_add(3)
        .and_then(|words| words.checked_mul(header.word));
    let head = words.filter(|bytes| *bytes <= text.len());
    let head = letters(head.ok_or_else(|| format!("{count} blocks"))?);
    let text_of_head = text
        .get(..head)
        .ok_or("an array that ends within its head")?;
    let (lengths, all) = blocks((header, most), &decoded(text_of_head)?)?;
    let data: usize = lengths
        .iter()
        .fold(0, |sum: usize, length| sum.saturating_add(*length));
    let end = letters(data).saturating_add(head);
    let rest = text.get(head..end).ok_or("an array that is cut off")?;
    inflated(&lengths, all, &decoded(rest)?)
}
