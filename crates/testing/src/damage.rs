//! Contents of files with something wrong.

/// Numbers that a reader meets where it expects a count, a tag or a coordinate.
const NUMBERS: [&str; 12] = [
    "0",
    "-1",
    "1",
    "7",
    "65536",
    "99999999",
    "2147483648",
    "4294967295",
    "18446744073709551615",
    "1e308",
    "-1e-320",
    "nan",
];

/// A pseudo-random number below `n`, or zero where `n` is (xorshift, Marsaglia 2003). `state` is not zero.
pub fn draw(state: &mut u64, n: usize) -> usize {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    (*state % n.max(1) as u64) as usize
}

/// A content with one to three bytes overwritten.
pub fn overwritten(content: &[u8], state: &mut u64) -> Vec<u8> {
    let mut content = content.to_vec();
    for _ in 0..=draw(state, 3) {
        let place = draw(state, content.len());
        let Some(byte) = content.get_mut(place) else {
            break;
        };
        *byte = match draw(state, 3) {
            0 => *byte ^ (1 << draw(state, 8)),
            1 => draw(state, 256) as u8,
            _ => b"0123456789-.e \n$"[draw(state, 16)],
        };
    }
    content
}

/// A content with bytes overwritten, cut off, lost, doubled, or put elsewhere, or with another number in place of one.
pub fn damaged(content: &[u8], state: &mut u64) -> Vec<u8> {
    let mut content = overwritten(content, state);
    for _ in 0..draw(state, 3) {
        content = match draw(state, 6) {
            0 => overwritten(&content, state),
            1 => content[..draw(state, content.len() + 1)].to_vec(),
            2 => another_number(&content, state),
            3 => another_count(content, state),
            4 => another_line(&content, state),
            _ => elsewhere(&content, state),
        };
    }
    content
}

/// A checkpoint with one of its parts damaged, and the lengths and the checksum of what it then has. `digits`: the checksum of what follows
/// the first line. Of a content that is no checkpoint, the content.
pub fn forged(content: &[u8], state: &mut u64, digits: impl Fn(&[u8]) -> String) -> Vec<u8> {
    forge(content, state, digits).unwrap_or_else(|| content.to_vec())
}

fn forge(content: &[u8], state: &mut u64, digits: impl Fn(&[u8]) -> String) -> Option<Vec<u8>> {
    const PARTS: &str = "\"parts\":[";
    let mut lines = content.splitn(3, |byte| *byte == b'\n');
    let mut line = || lines.next();
    let first = std::str::from_utf8(line()?).ok()?;
    let head = std::str::from_utf8(line()?).ok()?;
    let mut rest = line()?;
    let (format, _) = first.rsplit_once(' ')?;
    let (before, lengths) = head.split_once(PARTS)?;
    let (lengths, after) = lengths.split_once(']')?;
    let mut parts = Vec::new();
    for length in lengths.split(',') {
        let (part, others) = rest.split_at_checked(length.parse().ok()?)?;
        parts.push(part.to_vec());
        rest = others;
    }
    let chosen = draw(state, parts.len());
    parts[chosen] = damaged(&parts[chosen], state);
    let lengths: Vec<String> = parts.iter().map(|part| part.len().to_string()).collect();
    let head = format!("{before}{PARTS}{}]{after}\n", lengths.join(","));
    let rest = [head.into_bytes(), parts.concat()].concat();
    let first = format!("{format} {}\n", digits(&rest));
    Some([first.into_bytes(), rest].concat())
}

/// Another number in place of one that is written in digits.
fn another_number(content: &[u8], state: &mut u64) -> Vec<u8> {
    let from = draw(state, content.len());
    let is_digit = |byte: &u8| byte.is_ascii_digit();
    let Some(begin) = content[from..].iter().position(is_digit) else {
        return content.to_vec();
    };
    let begin = from + begin;
    let length = content[begin..].iter().position(|byte| !is_digit(byte));
    let end = length.map_or(content.len(), |length| begin + length);
    let number = NUMBERS[draw(state, NUMBERS.len())].as_bytes();
    [&content[..begin], number, &content[end..]].concat()
}

/// Another number in place of four or eight bytes.
fn another_count(mut content: Vec<u8>, state: &mut u64) -> Vec<u8> {
    let width = [4, 8][draw(state, 2)];
    let place = draw(state, content.len().saturating_sub(width) + 1);
    let number: u64 = match draw(state, 4) {
        0 => u64::MAX,
        1 => 1 << draw(state, 64),
        2 => draw(state, 1000) as u64,
        _ => f64::INFINITY.to_bits(),
    };
    for (byte, new) in content[place..]
        .iter_mut()
        .zip(&number.to_le_bytes()[..width])
    {
        *byte = *new;
    }
    content
}

/// A line lost, doubled, or put before another one.
fn another_line(content: &[u8], state: &mut u64) -> Vec<u8> {
    let mut lines: Vec<&[u8]> = content.split_inclusive(|byte| *byte == b'\n').collect();
    if lines.is_empty() {
        return Vec::new();
    }
    let line = lines[draw(state, lines.len())];
    let place = draw(state, lines.len());
    match draw(state, 2) {
        0 => drop(lines.remove(place)),
        _ => lines.insert(place, line),
    }
    lines.concat()
}

/// Up to 64 bytes lost, or put elsewhere too.
fn elsewhere(content: &[u8], state: &mut u64) -> Vec<u8> {
    let begin = draw(state, content.len());
    let end = content.len().min(begin + 1 + draw(state, 64));
    match draw(state, 2) {
        0 => [&content[..begin], &content[end..]].concat(),
        _ => {
            let place = draw(state, content.len() + 1);
            [&content[..place], &content[begin..end], &content[place..]].concat()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_content_can_be_damaged_and_hardly_any_stays_as_it_is() {
        let mut state = 1;
        let whole = b"7 nodes\n1 0.5 0.25\n\xff\x00\x01\x02 and the end\n";
        let same = (0..1000).filter(|_| damaged(whole, &mut state) == whole);
        assert!(same.count() < 100);
        for content in [&b""[..], b"1", b"\n"] {
            for _ in 0..1000 {
                damaged(content, &mut state);
            }
        }
    }
}
