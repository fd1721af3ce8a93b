//! The two streams of the program: everything that it prints goes through this file.
//!
//! Texts of a case (titles, names, groups of a mesh, paths) may hold control characters, which a terminal would obey, and may be
//! of any length: here they become visible escapes, and [`line()`] cuts them.
//!
//! A reader that goes away (`carom schema | head`) ends the output and nothing else. Any other failure of standard output (a
//! full disk) is kept until the end of the program: [`close`] names it and gives the exit code. What standard error does not take
//! is lost, because there is no other place to report it.

use std::borrow::Cow;
use std::fmt;
use std::io::{self, ErrorKind, Write};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::exit::FAILED;

/// Letters of a text of the user, or of a message around it, that are shown.
pub const LONGEST: usize = 1000;

/// Why standard output takes nothing more.
static LOST: Mutex<Option<io::Error>> = Mutex::new(None);

/// Prints a line to standard output; arguments as those of `println!`.
macro_rules! out {
    ($($text:tt)*) => {
        $crate::terminal::write_out(format_args!("{}\n", format_args!($($text)*)))
    };
}

/// Prints a line to standard error; arguments as those of `eprintln!`.
macro_rules! err {
    ($($text:tt)*) => {
        $crate::terminal::write_err(format_args!("{}\n", format_args!($($text)*)))
    };
}

pub(crate) use {err, out};

/// Whether this process tells nothing: another one of the same run does.
static SILENT: AtomicBool = AtomicBool::new(false);

/// Tells nothing from here on.
pub fn be_silent() {
    SILENT.store(true, Ordering::Relaxed);
}

/// Writes text to standard output, with control characters made visible.
pub fn write_out(text: fmt::Arguments) {
    if SILENT.load(Ordering::Relaxed) {
        return;
    }
    let text = text.to_string();
    keep(io::stdout().write_all(visible(&text).as_bytes()));
}

/// Writes JSON to standard output. What a terminal would obey becomes an escape of JSON, which is the same letter to a program that reads it.
pub fn write_json(text: &str) {
    if !SILENT.load(Ordering::Relaxed) {
        keep(io::stdout().write_all(as_json(text).as_bytes()));
    }
}

/// Writes text to standard error, with control characters made visible.
pub fn write_err(text: fmt::Arguments) {
    let text = text.to_string();
    write_styled(&visible(&text));
}

/// Writes text to standard error as it is, with the colours of whoever made it and made the rest of it [`visible`].
pub fn write_styled(text: &str) {
    if !SILENT.load(Ordering::Relaxed) {
        let _ = io::stderr().write_all(text.as_bytes());
    }
}

/// Keeps the first failure of standard output.
pub fn keep(written: io::Result<()>) {
    if let Err(error) = written {
        // a thread that panicked while it held the lock left a whole value
        let mut lost = LOST.lock().unwrap_or_else(|held| held.into_inner());
        lost.get_or_insert(error);
    }
}

/// Hands the rest of standard output to the system. Returns `code`; where standard output failed and `code` is 0, that of a
/// failure, with the cause on standard error. A reader that went away is no failure.
pub fn close(code: u8) -> u8 {
    keep(io::stdout().flush());
    let lost = LOST.lock().unwrap_or_else(|held| held.into_inner());
    match &*lost {
        Some(error) if error.kind() != ErrorKind::BrokenPipe => {
            err!("error: cannot write to standard output: {error}");
            match code {
                0 => FAILED,
                other => other,
            }
        }
        _ => code,
    }
}

/// Standard output for what writes by itself, under the rules of this file: a write never fails.
pub struct StandardOutput;

impl Write for StandardOutput {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        write_out(format_args!("{}", String::from_utf8_lossy(bytes)));
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Standard error for what writes by itself; a write never fails.
pub struct StandardError;

impl Write for StandardError {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let _ = io::stderr().write_all(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// The text with an escape, `\u{1b}`, for each control character but the line feed, and for each letter that changes the
/// direction of writing.
pub fn visible(text: &str) -> Cow<'_, str> {
    escaped(text, |letter| obeyed(letter) && letter != '\n')
}

/// As [`visible`], in one line, and cut after [`LONGEST`] letters with the number of those left out.
pub fn line(text: &str) -> Cow<'_, str> {
    shortened(text, LONGEST)
}

/// As [`line()`], cut after so many letters.
pub fn shortened(text: &str, longest: usize) -> Cow<'_, str> {
    match text.char_indices().nth(longest) {
        None => escaped(text, obeyed),
        Some((end, _)) => {
            let left = text[end..].chars().count();
            let shown = escaped(&text[..end], obeyed);
            Cow::Owned(format!("{shown} ... ({left} more letters)"))
        }
    }
}

/// JSON with `\u202e` for each letter that a terminal obeys: those are in its strings alone, but for line feeds between its lines.
fn as_json(text: &str) -> String {
    let mut shown = String::with_capacity(text.len() + 8);
    for letter in text.chars() {
        match obeyed(letter) && letter != '\n' {
            true => {
                for unit in letter.encode_utf16(&mut [0; 2]) {
                    shown.push_str(&format!("\\u{unit:04x}"));
                }
            }
            false => shown.push(letter),
        }
    }
    shown
}

fn escaped(text: &str, hidden: impl Fn(char) -> bool) -> Cow<'_, str> {
    if !text.contains(&hidden) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len() + 8);
    for letter in text.chars() {
        match hidden(letter) {
            true => shown.extend(letter.escape_default()),
            false => shown.push(letter),
        }
    }
    Cow::Owned(shown)
}

/// Whether a terminal obeys the letter instead of showing it.
fn obeyed(letter: char) -> bool {
    letter.is_control()
        || matches!(letter, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_terminal_would_obey_is_written_as_an_escape() {
        let text = "a\u{1b}[31m\u{7}\u{9b}b\u{202e}\nc\té µ²";
        assert_eq!(
            visible(text),
            "a\\u{1b}[31m\\u{7}\\u{9b}b\\u{202e}\nc\\té µ²"
        );
        assert_eq!(line("a\nb"), "a\\nb");
        assert!(matches!(line("plain é"), Cow::Borrowed("plain é")));
    }

    #[test]
    fn json_stays_what_it_is_and_shows_what_a_terminal_would_obey() {
        let title = "a\u{202e}\u{9b}b\u{7f} é\n\u{1b}";
        let text = serde_json::to_string_pretty(&serde_json::json!({ "title": title })).unwrap();
        let shown = as_json(&text);
        assert!(!shown.contains(|c| obeyed(c) && c != '\n'), "{shown}");
        let back: serde_json::Value = serde_json::from_str(&shown).unwrap();
        assert_eq!(back["title"], title);
    }

    #[test]
    fn a_long_text_is_cut_with_the_number_of_letters_left_out() {
        let text = "é".repeat(LONGEST + 234);
        let shown = line(&text);
        assert!(shown.starts_with(&"é".repeat(LONGEST)));
        assert!(shown.ends_with("é ... (234 more letters)"), "{shown}");
        assert_eq!(line(&text[..2 * LONGEST]), text[..2 * LONGEST]);
    }
}
