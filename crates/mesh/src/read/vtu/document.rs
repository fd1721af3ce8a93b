//! The elements of the document, as far as a mesh needs them.

use std::collections::BTreeMap;

/// What the root says of all arrays.
pub(super) struct Header {
    /// Bytes of a word of the head of an array.
    pub(super) word: usize,
    pub(super) compressed: bool,
    /// Whether appended data are bytes, not base64.
    pub(super) raw: bool,
}

/// Where the numbers of an array stand.
pub(super) enum Format {
    Ascii,
    Binary,
    Appended(usize),
}

/// An array as the document declares it.
pub(super) struct Array {
    /// The element that it stands in: `Points`, `Cells`, `CellData`.
    pub(super) section: String,
    pub(super) name: String,
    pub(super) number: String,
    pub(super) components: usize,
    pub(super) format: Format,
    pub(super) text: String,
    /// Line of its beginning, from 1.
    pub(super) line: usize,
}

/// The document up to the appended data.
pub(super) struct Document {
    pub(super) header: Header,
    pub(super) points: usize,
    pub(super) cells: usize,
    pub(super) arrays: Vec<Array>,
}

/// Where something is wrong: line, what was found, what was expected, and whether it is sound but not read.
pub(super) type Fault = (usize, String, &'static str, bool);

struct Tag<'a> {
    name: &'a str,
    attributes: BTreeMap<&'a str, String>,
    is_end: bool,
    is_empty: bool,
    /// Text up to the next tag.
    text: &'a str,
    line: usize,
}

/// The document in a text that ends before the appended data.
pub(super) fn document(text: &str) -> Result<Document, Fault> {
    let mut header = None;
    let mut piece = None;
    let (mut section, mut arrays) = (String::new(), Vec::new());
    for tag in tags(text)? {
        let get = |key: &str| tag.attributes.get(key).map_or("", String::as_str);
        match (tag.name, tag.is_end) {
            ("VTKFile", false) => header = Some(of_root(&tag)?),
            ("AppendedData", false) => {
                if let Some(header) = &mut header {
                    header.raw = get("encoding") != "base64";
                }
            }
            ("Piece", false) if piece.is_some() => {
                return Err((
                    tag.line,
                    "a second Piece".to_owned(),
                    "a file of one piece",
                    true,
                ));
            }
            ("Piece", false) => {
                piece = Some([
                    count(&tag, "NumberOfPoints")?,
                    count(&tag, "NumberOfCells")?,
                ]);
            }
            ("Points" | "Cells" | "CellData" | "PointData" | "FieldData", is_end) => {
                section = if is_end || tag.is_empty {
                    String::new()
                } else {
                    tag.name.to_owned()
                };
            }
            ("DataArray", false) => arrays.push(of_array(&tag, &section)?),
            _ => {}
        }
    }
    let missing = |what: &str, expected| (1, format!("no {what}"), expected, false);
    let [points, cells] = piece.ok_or_else(|| missing("Piece", "an unstructured grid"))?;
    Ok(Document {
        header: header
            .ok_or_else(|| missing("VTKFile", "`<VTKFile type=\"UnstructuredGrid\" ...>`"))?,
        points,
        cells,
        arrays,
    })
}

fn of_root(tag: &Tag) -> Result<Header, Fault> {
    let get = |key: &str, usual: &str| {
        let value = tag.attributes.get(key);
        value.cloned().unwrap_or_else(|| usual.to_owned())
    };
    let unread = |key: &str, found: String, expected| {
        Err((tag.line, format!("{key} \"{found}\""), expected, true))
    };
    match get("type", "") {
        grid if grid == "UnstructuredGrid" => {}
        other => return unread("type", other, "UnstructuredGrid"),
    }
    match get("byte_order", "LittleEndian") {
        order if order == "LittleEndian" => {}
        other => return unread("byte_order", other, "LittleEndian"),
    }
    let compressed = match get("compressor", "").as_str() {
        "" => false,
        "vtkZLibDataCompressor" => true,
        other => {
            return unread(
                "compressor",
                other.to_owned(),
                "vtkZLibDataCompressor, or none",
            );
        }
    };
    let word = match get("header_type", "UInt32").as_str() {
        "UInt32" => 4,
        "UInt64" => 8,
        other => return unread("header_type", other.to_owned(), "UInt32 or UInt64"),
    };
    Ok(Header {
        word,
        compressed,
        raw: true,
    })
}

fn of_array(tag: &Tag, section: &str) -> Result<Array, Fault> {
    let get = |key: &str| tag.attributes.get(key).map_or("", String::as_str);
    let format = match get("format") {
        "ascii" => Format::Ascii,
        "binary" => Format::Binary,
        "appended" => Format::Appended(count(tag, "offset")?),
        other => {
            let found = format!("format \"{other}\"");
            return Err((tag.line, found, "ascii, binary or appended", true));
        }
    };
    let components = match tag.attributes.contains_key("NumberOfComponents") {
        true => count(tag, "NumberOfComponents")?,
        false => 1,
    };
    Ok(Array {
        section: section.to_owned(),
        name: get("Name").to_owned(),
        number: get("type").to_owned(),
        components,
        format,
        text: tag.text.to_owned(),
        line: tag.line,
    })
}

/// An attribute that is a count.
fn count(tag: &Tag, key: &str) -> Result<usize, Fault> {
    let found = tag.attributes.get(key).map_or("", String::as_str);
    let number = found.trim().parse::<u32>();
    number.map(|number| number as usize).map_err(|_| {
        (
            tag.line,
            format!("{key} \"{found}\""),
            "a number below 2^32",
            false,
        )
    })
}

/// The tags in their order; comments and declarations are left out.
fn tags(text: &str) -> Result<Vec<Tag<'_>>, Fault> {
    let (mut all, mut rest, mut line) = (Vec::new(), text, 1);
    while let Some(start) = rest.find('<') {
        line += lines(&rest[..start]);
        rest = &rest[start..];
        let close = if rest.starts_with("<!--") { "-->" } else { ">" };
        let end = rest.find(close).map(|end| end + close.len());
        let end = end.ok_or_else(|| (line, "a tag without an end".to_owned(), "`>`", false))?;
        let (tag, after) = rest.split_at(end);
        if !tag.starts_with("<!") && !tag.starts_with("<?") {
            let text = after.split('<').next().unwrap_or_default();
            all.push(of_tag(&tag[1..tag.len() - 1], text, line));
        }
        line += lines(tag);
        rest = after;
    }
    Ok(all)
}

fn lines(text: &str) -> usize {
    text.bytes().filter(|byte| *byte == b'\n').count()
}

/// A tag from what stands between its brackets.
fn of_tag<'a>(inside: &'a str, text: &'a str, line: usize) -> Tag<'a> {
    let is_end = inside.starts_with('/');
    let is_empty = inside.ends_with('/');
    let inside = inside.trim_matches('/').trim();
    let (name, mut rest) = inside
        .split_once(char::is_whitespace)
        .unwrap_or((inside, ""));
    let mut attributes = BTreeMap::new();
    while let Some((key, after)) = rest.split_once('=') {
        let after = after.trim_start();
        let Some(quote) = after.chars().next().filter(|c| matches!(c, '"' | '\'')) else {
            break;
        };
        let Some((value, after)) = after[1..].split_once(quote) else {
            break;
        };
        attributes.insert(key.trim(), unescaped(value));
        rest = after;
    }
    Tag {
        name,
        attributes,
        is_end,
        is_empty,
        text,
        line,
    }
}

fn unescaped(text: &str) -> String {
    text.replace("&lt;", "<")
        .replace("&gt;", ">")
        .replace("&quot;", "\"")
        .replace("&apos;", "'")
        .replace("&amp;", "&")
}
