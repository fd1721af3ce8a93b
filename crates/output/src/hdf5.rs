//! Writes HDF5 files whose datasets grow by rows, with the memory of a chunk of each.
//!
//! Datasets of numbers in one or two dimensions, groups, and attributes of a few numbers or a text; nothing else of HDF5. A dataset that
//! grows ([`Rows`]) is stored in chunks, each shuffled and deflated when it is full. Nothing that is written changes afterwards, but for
//! the superblock, which is written last: until then the file is no HDF5 file.
//!
//! The layout is the oldest that has compact groups, which every library since HDF5 1.8 reads: superblock 0, object headers 1, chunks in a
//! B-tree 1. None of it needs a checksum.
//!
//! Source: HDF5 File Format Specification, version 3.0 (The HDF Group), of which the comments give the sections.

use std::io::{self, Seek, SeekFrom, Write};

use flate2::Compression;
use flate2::write::ZlibEncoder;

/// Bytes of a chunk before compression, about.
const CHUNK: usize = 1 << 19;
/// Level of compression.
const DEFLATE: u32 = 4;
/// Bytes of the superblock.
const SUPERBLOCK: u64 = 96;
/// Address of what is not there.
const NOWHERE: u64 = u64::MAX;
/// Children of a node of the B-tree of chunks at most: 2 K with the K = 32 that a file of superblock 0 has.
const CHILDREN: usize = 64;

/// Kinds of messages in an object header (IV.A.2).
mod message {
    pub(super) const DATASPACE: u16 = 0x01;
    pub(super) const LINK_INFO: u16 = 0x02;
    pub(super) const DATATYPE: u16 = 0x03;
    pub(super) const FILL_VALUE: u16 = 0x05;
    pub(super) const LINK: u16 = 0x06;
    pub(super) const LAYOUT: u16 = 0x08;
    pub(super) const GROUP_INFO: u16 = 0x0a;
    pub(super) const FILTERS: u16 = 0x0b;
    pub(super) const ATTRIBUTE: u16 = 0x0c;
}

/// What the elements of a dataset are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Element {
    /// `u8`.
    Byte,
    /// `i64`.
    Integer,
    /// `f64`.
    Real,
}

impl Element {
    fn size(self) -> usize {
        match self {
            Element::Byte => 1,
            Element::Integer | Element::Real => 8,
        }
    }

    /// Datatype message (IV.A.2.d): numbers with the least significant byte first.
    fn datatype(self) -> Vec<u8> {
        let size = self.size() as u32;
        let bits = 8 * self.size() as u16;
        let mut out = match self {
            Element::Byte => vec![0x10, 0, 0, 0],
            // with a sign
            Element::Integer => vec![0x10, 0x08, 0, 0],
            // the leading bit of the mantissa is implied; the sign is bit 63
            Element::Real => vec![0x11, 0x20, 63, 0],
        };
        out.extend(size.to_le_bytes());
        out.extend(0_u16.to_le_bytes());
        out.extend(bits.to_le_bytes());
        if self == Element::Real {
            // exponent and mantissa: first bit and size of each
            out.extend([52, 11, 0, 52]);
            out.extend(1023_u32.to_le_bytes());
        }
        out
    }
}

/// The value of an attribute.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Attribute<'a> {
    /// One integer.
    Integer(i64),
    /// A list of integers.
    Integers(&'a [i64]),
    /// A text of ASCII letters.
    Text(&'a str),
}

/// A file that is being written.
#[derive(Debug)]
pub(crate) struct Writer<W> {
    to: W,
    /// Where the next bytes go.
    end: u64,
}

impl<W: Write + Seek> Writer<W> {
    /// Begins a file at the start of `to`.
    ///
    /// # Errors
    /// The system refuses.
    pub(crate) fn new(mut to: W) -> io::Result<Writer<W>> {
        to.write_all(&[0; SUPERBLOCK as usize])?;
        Ok(Writer {
            to,
            end: SUPERBLOCK,
        })
    }

    /// Writes at the end of the file, on a multiple of 8 bytes; the address.
    fn put(&mut self, bytes: &[u8]) -> io::Result<u64> {
        let at = self.end.next_multiple_of(8);
        self.to.write_all(&vec![0; (at - self.end) as usize])?;
        self.to.write_all(bytes)?;
        self.end = at + bytes.len() as u64;
        Ok(at)
    }

    /// An object header of version 1 (IV.A.1.a); its address.
    fn object(&mut self, messages: &[(u16, Vec<u8>)]) -> io::Result<u64> {
        let mut body = Vec::new();
        for (kind, data) in messages {
            let size = data.len().next_multiple_of(8);
            let stated = u16::try_from(size).map_err(io::Error::other)?;
            body.extend(kind.to_le_bytes());
            body.extend(stated.to_le_bytes());
            body.extend([0; 4]);
            body.extend(data);
            body.resize(body.len() + size - data.len(), 0);
        }
        let count = u16::try_from(messages.len()).map_err(io::Error::other)?;
        let mut out = vec![1, 0];
        out.extend(count.to_le_bytes());
        out.extend(1_u32.to_le_bytes());
        out.extend((body.len() as u32).to_le_bytes());
        out.extend([0; 4]);
        out.extend(body);
        self.put(&out)
    }

    /// A dataset of these bytes in one piece; its address.
    ///
    /// # Errors
    /// The system refuses.
    pub(crate) fn dataset(
        &mut self,
        element: Element,
        shape: &[u64],
        bytes: &[u8],
    ) -> io::Result<u64> {
        let at = match bytes.is_empty() {
            true => NOWHERE,
            false => self.put(bytes)?,
        };
        // layout message, contiguous (IV.A.2.i)
        let mut layout = vec![3, 1];
        layout.extend(at.to_le_bytes());
        layout.extend((bytes.len() as u64).to_le_bytes());
        self.object(&[
            (message::DATASPACE, dataspace(shape)),
            (message::DATATYPE, element.datatype()),
            (message::FILL_VALUE, fill_value()),
            (message::LAYOUT, layout),
        ])
    }

    /// A dataset of integers in one dimension; its address.
    ///
    /// # Errors
    /// The system refuses.
    pub(crate) fn integers(&mut self, values: &[i64]) -> io::Result<u64> {
        let bytes: Vec<u8> = values
            .iter()
            .flat_map(|value| value.to_le_bytes())
            .collect();
        self.dataset(Element::Integer, &[values.len() as u64], &bytes)
    }

    /// A group of objects by name and address, with attributes; its address.
    ///
    /// # Errors
    /// The system refuses; a name of more than 255 bytes.
    pub(crate) fn group(
        &mut self,
        members: &[(&str, u64)],
        attributes: &[(&str, Attribute)],
    ) -> io::Result<u64> {
        // link info (IV.A.2.c): neither a heap nor an index, the links are messages of the header
        let mut info = vec![0, 0];
        info.extend([NOWHERE; 2].map(u64::to_le_bytes).concat());
        let mut messages = vec![
            (message::LINK_INFO, info),
            (message::GROUP_INFO, vec![0, 0]),
        ];
        for (name, at) in members {
            // link message (IV.A.2.g): a hard link, the length of its name in one byte
            let length = u8::try_from(name.len()).map_err(io::Error::other)?;
            let mut link = vec![1, 0, length];
            link.extend(name.as_bytes());
            link.extend(at.to_le_bytes());
            messages.push((message::LINK, link));
        }
        for (name, value) in attributes {
            messages.push((message::ATTRIBUTE, attribute(name, *value)));
        }
        self.object(&messages)
    }

    /// Writes the superblock of version 0 (II.A), with the address of the group that is the root.
    ///
    /// # Errors
    /// The system refuses.
    pub(crate) fn finish(mut self, root: u64) -> io::Result<()> {
        let mut out = b"\x89HDF\r\n\x1a\n".to_vec();
        // versions of superblock, free space, root group, shared headers; bytes of an address and of a length
        out.extend([0, 0, 0, 0, 0, 8, 8, 0]);
        // K of the leaves and of the nodes of old groups, of which there is none
        out.extend(4_u16.to_le_bytes());
        out.extend(16_u16.to_le_bytes());
        out.extend(0_u32.to_le_bytes());
        for address in [0, NOWHERE, self.end, NOWHERE] {
            out.extend(address.to_le_bytes());
        }
        // entry of the root: offset of its name, address, nothing cached
        out.extend(0_u64.to_le_bytes());
        out.extend(root.to_le_bytes());
        out.resize(SUPERBLOCK as usize, 0);
        self.to.seek(SeekFrom::Start(0))?;
        self.to.write_all(&out)?;
        self.to.seek(SeekFrom::End(0))?;
        Ok(())
    }
}

/// Dataspace message of version 1 (IV.A.2.b); of no dimension a scalar.
fn dataspace(shape: &[u64]) -> Vec<u8> {
    let mut out = vec![1, shape.len() as u8, 0, 0, 0, 0, 0, 0];
    out.extend(shape.iter().flat_map(|count| count.to_le_bytes()));
    out
}

/// Fill value message of version 2 (IV.A.2.f): the default, written where chunks are.
fn fill_value() -> Vec<u8> {
    vec![2, 3, 2, 1, 0, 0, 0, 0]
}

/// Attribute message of version 3 (IV.A.2.m).
fn attribute(name: &str, value: Attribute) -> Vec<u8> {
    let integers = |shape: &[u64], values: &[i64]| {
        let bytes = values.iter().flat_map(|value| value.to_le_bytes());
        (
            Element::Integer.datatype(),
            dataspace(shape),
            bytes.collect(),
        )
    };
    let (datatype, dataspace, data): (Vec<u8>, Vec<u8>, Vec<u8>) = match value {
        Attribute::Integer(value) => integers(&[], &[value]),
        Attribute::Integers(values) => integers(&[values.len() as u64], values),
        Attribute::Text(text) => {
            // a string of fixed length, filled with zeros
            let mut datatype = vec![0x13, 0x01, 0, 0];
            datatype.extend((text.len() as u32).to_le_bytes());
            (datatype, dataspace(&[]), text.as_bytes().to_vec())
        }
    };
    let mut out = vec![3, 0];
    for size in [name.len() + 1, datatype.len(), dataspace.len()] {
        out.extend((size as u16).to_le_bytes());
    }
    out.push(0);
    out.extend(name.as_bytes());
    out.push(0);
    out.extend([datatype, dataspace, data].concat());
    out
}

/// A dataset of numbers that grows by rows.
#[derive(Debug)]
pub(crate) struct Rows {
    element: Element,
    /// Numbers of a row.
    components: usize,
    /// Rows of a chunk.
    height: usize,
    /// Rows so far.
    count: u64,
    /// The chunk that is not full.
    open: Vec<u8>,
    /// Address and bytes of each full chunk.
    chunks: Vec<(u64, u32)>,
}

impl Rows {
    /// Before the first row; rows of one number have one dimension.
    pub(crate) fn new(element: Element, components: usize) -> Rows {
        Rows {
            element,
            components,
            height: (CHUNK / (components * element.size())).max(1),
            count: 0,
            open: Vec::new(),
            chunks: Vec::new(),
        }
    }

    /// Rows so far.
    pub(crate) fn count(&self) -> u64 {
        self.count
    }

    fn row(&self) -> usize {
        self.components * self.element.size()
    }

    /// Adds numbers, each of as many bytes as the element has: whole rows.
    ///
    /// # Errors
    /// The system refuses.
    pub(crate) fn add<W: Write + Seek, const N: usize>(
        &mut self,
        writer: &mut Writer<W>,
        numbers: impl ExactSizeIterator<Item = [u8; N]>,
    ) -> io::Result<()> {
        debug_assert_eq!(N, self.element.size());
        debug_assert_eq!(numbers.len() % self.components, 0);
        self.count += (numbers.len() / self.components) as u64;
        let full = self.height * self.row();
        for number in numbers {
            self.open.extend(number);
            if self.open.len() == full {
                self.close_chunk(writer)?;
            }
        }
        Ok(())
    }

    fn close_chunk<W: Write + Seek>(&mut self, writer: &mut Writer<W>) -> io::Result<()> {
        let mut deflated = ZlibEncoder::new(Vec::new(), Compression::new(DEFLATE));
        let size = self.element.size();
        // shuffled: the first bytes of all numbers, then the second ones
        let count = self.open.len() / size;
        for byte in 0..size {
            let all: Vec<u8> = (0..count).map(|k| self.open[k * size + byte]).collect();
            deflated.write_all(&all)?;
        }
        let bytes = deflated.finish()?;
        self.open.clear();
        let length = u32::try_from(bytes.len()).map_err(io::Error::other)?;
        self.chunks.push((writer.put(&bytes)?, length));
        Ok(())
    }

    /// Writes what is left and the index of the chunks; the address of the dataset.
    ///
    /// # Errors
    /// The system refuses.
    pub(crate) fn finish<W: Write + Seek>(mut self, writer: &mut Writer<W>) -> io::Result<u64> {
        if !self.open.is_empty() {
            // chunks have one size; the dataspace says where the rows end
            self.open.resize(self.height * self.row(), 0);
            self.close_chunk(writer)?;
        }
        let shape = match self.components {
            1 => vec![self.count],
            components => vec![self.count, components as u64],
        };
        let index = self.index(writer, shape.len())?;
        // layout message, chunked (IV.A.2.i): dimensions of a chunk, the last is the size of an element
        let mut layout = vec![3, 2, shape.len() as u8 + 1];
        layout.extend(index.to_le_bytes());
        layout.extend((self.height as u32).to_le_bytes());
        if self.components > 1 {
            layout.extend((self.components as u32).to_le_bytes());
        }
        layout.extend((self.element.size() as u32).to_le_bytes());
        // filters (IV.A.2.l): shuffle is 2, deflate 1; each with one value and its padding
        let mut filters = vec![1, 2, 0, 0, 0, 0, 0, 0];
        for (filter, value) in [(2_u16, self.element.size() as u32), (1, DEFLATE)] {
            filters.extend([filter, 0, 0, 1].map(u16::to_le_bytes).concat());
            filters.extend([value, 0].map(u32::to_le_bytes).concat());
        }
        writer.object(&[
            (message::DATASPACE, dataspace(&shape)),
            (message::DATATYPE, self.element.datatype()),
            (message::FILL_VALUE, fill_value()),
            (message::LAYOUT, layout),
            (message::FILTERS, filters),
        ])
    }

    /// The B-tree of the chunks, level by level from the leaves; the address of its root.
    fn index<W: Write + Seek>(&self, writer: &mut Writer<W>, rank: usize) -> io::Result<u64> {
        if self.chunks.is_empty() {
            return Ok(NOWHERE);
        }
        let chunks = self.chunks.iter().enumerate();
        // of each child: its first chunk, the bytes of that, its address
        let mut children: Vec<(usize, u32, u64)> = chunks
            .map(|(number, &(at, bytes))| (number, bytes, at))
            .collect();
        let mut level = 0;
        loop {
            let nodes = children.len().div_ceil(CHILDREN);
            let size = 24 + 8 * CHILDREN + (CHILDREN + 1) * (16 + 8 * rank);
            let begin = writer.end.next_multiple_of(8);
            let at = |node: usize| begin + (node * size.next_multiple_of(8)) as u64;
            let mut above = Vec::with_capacity(nodes);
            for (node, own) in children.chunks(CHILDREN).enumerate() {
                let next = children.get((node + 1) * CHILDREN);
                let next = next.map_or(self.chunks.len(), |child| child.0);
                let beside = [
                    node.checked_sub(1).map_or(NOWHERE, at),
                    if node + 1 < nodes {
                        at(node + 1)
                    } else {
                        NOWHERE
                    },
                ];
                let mut bytes = self.node((level, rank), own, beside, next);
                bytes.resize(size, 0);
                above.push((own[0].0, own[0].1, writer.put(&bytes)?));
            }
            if nodes == 1 {
                return Ok(above[0].2);
            }
            (children, level) = (above, level + 1);
        }
    }

    /// A node of the B-tree of chunks (III.A.1): keys and children take turns, with a key behind the last child.
    fn node(
        &self,
        (level, rank): (u8, usize),
        children: &[(usize, u32, u64)],
        beside: [u64; 2],
        next: usize,
    ) -> Vec<u8> {
        let mut out = b"TREE".to_vec();
        out.extend([1, level]);
        out.extend((children.len() as u16).to_le_bytes());
        out.extend(beside.map(u64::to_le_bytes).concat());
        let key = |out: &mut Vec<u8>, chunk: usize, bytes: u32| {
            out.extend(bytes.to_le_bytes());
            // no filter is left out
            out.extend(0_u32.to_le_bytes());
            out.extend(((chunk * self.height) as u64).to_le_bytes());
            // the chunk begins at the first component, and at the first byte of an element
            out.resize(out.len() + 8 * rank, 0);
        };
        for &(chunk, bytes, at) in children {
            key(&mut out, chunk, bytes);
            out.extend(at.to_le_bytes());
        }
        key(&mut out, next, 0);
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file with one dataset of `rows` rows of three reals, the numbers 0, 1, 2, and so on; and most bytes that were held.
    fn file(rows: usize) -> (Vec<u8>, usize) {
        let mut bytes = io::Cursor::new(Vec::new());
        let mut writer = Writer::new(&mut bytes).unwrap();
        let mut dataset = Rows::new(Element::Real, 3);
        let mut held = 0;
        for first in (0..rows).step_by(1000) {
            let numbers = 3 * first..3 * rows.min(first + 1000);
            let numbers = numbers.map(|k| (k as f64).to_le_bytes());
            dataset.add(&mut writer, numbers).unwrap();
            held = held.max(dataset.open.capacity());
        }
        let dataset = dataset.finish(&mut writer).unwrap();
        let empty = Rows::new(Element::Integer, 1).finish(&mut writer).unwrap();
        let inner = writer.group(&[("empty", empty)], &[]).unwrap();
        let attributes = [
            ("one", Attribute::Integer(-7)),
            ("two", Attribute::Integers(&[2, 0])),
            ("text", Attribute::Text("Grid")),
        ];
        let members = [("all", dataset), ("inner", inner)];
        let root = writer.group(&members, &attributes).unwrap();
        writer.finish(root).unwrap();
        (bytes.into_inner(), held)
    }

    #[test]
    fn rows_are_read_back_whether_the_index_has_one_level_or_two() {
        // 21 845 rows a chunk: none full, one and a part, more than the 64 children of a node
        for rows in [1, 30_000, 66 * 21_845 + 1] {
            let (bytes, _) = file(rows);
            let file = hdf5_pure::File::from_bytes(bytes).unwrap();
            let all = file.dataset("all").unwrap();
            assert_eq!(all.shape().unwrap(), [rows as u64, 3]);
            let found = all.read_f64().unwrap();
            assert_eq!(found.len(), 3 * rows);
            assert!(found.iter().enumerate().all(|(k, x)| *x == k as f64));
            assert_eq!(file.dataset("inner/empty").unwrap().shape().unwrap(), [0]);
        }
    }

    #[test]
    fn no_more_than_a_chunk_is_held_however_many_rows_there_are() {
        for rows in [30_000, 300_000] {
            assert!(file(rows).1 <= 2 * CHUNK);
        }
    }
}
