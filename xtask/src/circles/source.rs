//! What a Rust file names: the modules that it declares, its imports, and the paths in its code. Tests are left out.

use std::collections::{BTreeMap, BTreeSet};

/// A path in the source, segment by segment.
pub type Path = Vec<String>;

/// One file, as far as paths go.
#[derive(Debug, Default)]
pub struct Source {
    /// Modules declared as `mod name;`.
    pub children: Vec<String>,
    /// Modules declared so for tests alone.
    pub of_tests: Vec<String>,
    /// Name in this file of each import, and its path.
    pub imports: BTreeMap<String, Path>,
    /// Names of imports that the file gives on, `pub use`.
    pub exports: BTreeSet<String>,
    /// Paths of imports of everything, `use a::*`.
    pub globs: Vec<Path>,
    /// Paths in the code that have two segments or more.
    pub paths: Vec<Path>,
    /// All names in the code.
    pub names: BTreeSet<String>,
    /// Whether the file declares and imports only.
    pub lists: bool,
}

impl Source {
    /// Reads the text of a file.
    pub fn new(text: &str) -> Source {
        let mut reader = Reader {
            tokens: tokens(text),
            at: 0,
            source: Source {
                lists: true,
                ..Source::default()
            },
        };
        reader.read();
        reader.source
    }
}

struct Reader {
    tokens: Vec<String>,
    at: usize,
    source: Source,
}

impl Reader {
    fn peek(&self, ahead: usize) -> &str {
        self.tokens.get(self.at + ahead).map_or("", String::as_str)
    }

    fn read(&mut self) {
        let (mut for_tests, mut public) = (false, false);
        while self.at < self.tokens.len() {
            match self.peek(0) {
                "#" if matches!((self.peek(1), self.peek(2)), ("[", _) | ("!", "[")) => {
                    let attribute = self.attribute();
                    for_tests |= attribute == ["cfg", "(", "test", ")"];
                    continue;
                }
                "pub" => {
                    self.at += 1;
                    if self.peek(0) == "(" {
                        self.skip_balanced();
                    }
                    public = true;
                    continue;
                }
                "mod" if self.peek(2) == ";" => self.child(for_tests),
                _ if for_tests => self.skip_item(),
                "use" => self.import(public),
                _ => {
                    self.source.lists = false;
                    self.code();
                }
            }
            (for_tests, public) = (false, false);
        }
    }

    /// The tokens within the brackets of an attribute.
    fn attribute(&mut self) -> Vec<String> {
        self.at += if self.peek(1) == "!" { 2 } else { 1 };
        let begin = self.at + 1;
        self.skip_balanced();
        self.tokens[begin..self.at - 1].to_vec()
    }

    fn child(&mut self, for_tests: bool) {
        let name = self.peek(1).to_owned();
        match for_tests {
            true => self.source.of_tests.push(name),
            false => self.source.children.push(name),
        }
        self.at += 3;
    }

    /// Goes behind the bracket that closes the one here.
    fn skip_balanced(&mut self) {
        let mut depth = 0;
        while self.at < self.tokens.len() {
            match self.peek(0) {
                "(" | "[" | "{" => depth += 1,
                ")" | "]" | "}" => depth -= 1,
                _ => {}
            }
            self.at += 1;
            if depth == 0 {
                break;
            }
        }
    }

    /// Goes behind an item: its semicolon, or its braces.
    fn skip_item(&mut self) {
        while self.at < self.tokens.len() {
            match self.peek(0) {
                ";" => {
                    self.at += 1;
                    return;
                }
                "{" => return self.skip_balanced(),
                "(" | "[" => self.skip_balanced(),
                _ => self.at += 1,
            }
        }
    }

    fn import(&mut self, public: bool) {
        self.at += 1;
        let before: BTreeSet<String> = self.source.imports.keys().cloned().collect();
        self.tree(&mut Vec::new());
        if public {
            let new = self
                .source
                .imports
                .keys()
                .filter(|name| !before.contains(*name));
            self.source.exports.extend(new.cloned());
        }
    }

    /// One tree of an import behind `prefix`, up to the token that ends it.
    fn tree(&mut self, prefix: &mut Path) {
        let length = prefix.len();
        loop {
            let token = self.peek(0).to_owned();
            self.at += 1;
            match token.as_str() {
                "::" => {}
                "{" => loop {
                    self.tree(prefix);
                    match self.peek(0) {
                        "," => self.at += 1,
                        _ => break self.at += 1,
                    }
                    if self.peek(0) == "}" {
                        break self.at += 1;
                    }
                },
                "*" => self.source.globs.push(prefix.clone()),
                "" => break,
                _ => {
                    if token != "self" || prefix.is_empty() {
                        prefix.push(token);
                    }
                    let last = self.peek(0) != "::";
                    let name = match self.peek(0) {
                        "as" => {
                            self.at += 2;
                            self.tokens[self.at - 1].clone()
                        }
                        _ => prefix.last().cloned().unwrap_or_default(),
                    };
                    if last {
                        self.source.imports.insert(name, prefix.clone());
                    }
                }
            }
            if matches!(self.peek(0), ";" | "," | "}" | "") {
                break;
            }
        }
        prefix.truncate(length);
        if length == 0 && self.peek(0) == ";" {
            self.at += 1;
        }
    }

    /// One token of code, or a whole path.
    fn code(&mut self) {
        let is_name = |token: &str| token.starts_with(|c: char| c.is_alphabetic() || c == '_');
        let mut path = Vec::new();
        if is_name(self.peek(0)) {
            path.push(self.peek(0).to_owned());
            self.source.names.insert(path[0].clone());
            while self.peek(1) == "::" && is_name(self.peek(2)) {
                self.at += 2;
                path.push(self.peek(0).to_owned());
            }
        }
        self.at += 1;
        if path.len() > 1 {
            self.source.paths.push(path);
        }
    }
}

/// Names, `::`, and single signs; comments, texts and lifetimes left out.
fn tokens(text: &str) -> Vec<String> {
    let mut tokens = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let length = if first.is_alphabetic() || first == '_' {
            let end = rest.find(|c: char| !c.is_alphanumeric() && c != '_');
            let end = end.unwrap_or(rest.len());
            match raw_text(&rest[end..], &rest[..end]) {
                Some(raw) => end + raw,
                None => {
                    tokens.push(rest[..end].to_owned());
                    end
                }
            }
        } else if let Some(length) = hidden(rest) {
            length
        } else if rest.starts_with("::") {
            tokens.push("::".to_owned());
            2
        } else {
            if !first.is_whitespace() {
                tokens.push(first.to_string());
            }
            first.len_utf8()
        };
        rest = &rest[length..];
    }
    tokens
}

/// Length of what follows the prefix of a raw text, `r"..."`, `br#"..."#`; `None` if it is none.
fn raw_text(rest: &str, prefix: &str) -> Option<usize> {
    if !matches!(prefix, "r" | "br") {
        return None;
    }
    let hashes = rest.len() - rest.trim_start_matches('#').len();
    let body = rest[hashes..].strip_prefix('"')?;
    let end = format!("\"{}", "#".repeat(hashes));
    Some(hashes + 1 + body.find(&end)? + end.len())
}

/// Length of a comment, a text, a character or a lifetime at the beginning.
fn hidden(rest: &str) -> Option<usize> {
    if rest.starts_with("//") {
        return Some(rest.find('\n').unwrap_or(rest.len()));
    }
    if rest.starts_with("/*") {
        return Some(rest.find("*/").map_or(rest.len(), |end| end + 2));
    }
    if rest.starts_with('"') {
        return Some(closing(rest, '"'));
    }
    let quoted = rest.strip_prefix('\'')?;
    let mut characters = quoted.chars();
    let (first, second) = (characters.next(), characters.next());
    match first == Some('\\') || second == Some('\'') {
        true => Some(closing(rest, '\'')),
        false => Some(1 + quoted.find(|c: char| !c.is_alphanumeric() && c != '_')?),
    }
}

/// Length up to behind the closing quote, escapes regarded.
fn closing(rest: &str, quote: char) -> usize {
    let mut escaped = false;
    for (at, c) in rest.char_indices().skip(1) {
        match c {
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            _ if c == quote => return at + c.len_utf8(),
            _ => {}
        }
    }
    rest.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn imports_paths_and_modules_are_read_and_tests_are_not() {
        let source = Source::new(
            "//! `crate::no`\nmod a;\n#[cfg(test)]\nmod tests;\npub use a::{self, B as C, d::{E, F}};\nuse super::*;\n\
             fn f<'a>(x: &'a str) -> char { let s = \"crate::x\"; crate::g::h(x, r#\"\"k::l\"#); '\"' }\n\
             #[cfg(test)]\nmod more { use crate::z; }\n",
        );
        assert_eq!(source.children, ["a"]);
        assert_eq!(source.of_tests, ["tests"]);
        assert_eq!(source.globs, [["super"]]);
        assert_eq!(source.paths, [["crate", "g", "h"]]);
        let path = |name: &str| source.imports[name].join("::");
        assert_eq!(
            [path("a"), path("C"), path("E"), path("F")],
            ["a", "a::B", "a::d::E", "a::d::F"]
        );
        assert_eq!(source.imports.len(), 4);
        assert_eq!(source.exports.len(), 4);
        assert!(
            !source.lists && Source::new("#![deny(x)]\npub mod a;\npub(crate) use a::B;").lists
        );
    }
}
