//! Wrong binary files, each with its message and the byte that it names.

use super::malformed::{V22, refused};
use super::writer::{Encoding, write_22, write_41};
use super::{bytes_of, parse};

#[test]
fn binary_files_are_refused_by_byte() {
    let mesh = parse(V22.as_bytes()).unwrap();
    let tag = |node: u32| u64::from(node) + 1;
    let content = write_22(&mesh, Encoding::LittleEndian, tag);
    let after = |content: &[u8], mark: &str| {
        let mark = mark.as_bytes();
        content
            .windows(mark.len())
            .position(|it| it == mark)
            .unwrap()
            + mark.len()
    };
    let with = |content: &[u8], at: usize, new: &[u8]| {
        let mut content = content.to_vec();
        content[at..at + new.len()].copy_from_slice(new);
        content
    };
    let order = after(&content, "2.2 1 8\n");
    let expected = "expected the integer 1 in 4 bytes, which tells the byte order";
    refused(
        &with(&content, order, &[2]),
        &format!("byte {order}: found the bytes [2, 0, 0, 0], {expected}"),
    );

    let nodes = after(&content, "$Nodes\n3\n");
    let x = nodes + 28 + 4;
    let nan = with(&content, x, &f64::NAN.to_le_bytes());
    refused(
        &nan,
        &format!("byte {x}: found NaN, expected a finite coordinate (node 2 of 3)"),
    );
    let cut = &content[..x + 5];
    refused(
        cut,
        &format!(
            "byte {x}: found the end of the file, expected 8 bytes: a finite coordinate (node 2 of 3)"
        ),
    );
    let more = with(&content, nodes - 2, b"4");
    let error = parse(&more).unwrap_err().to_string();
    assert!(error.ends_with("expected $EndNodes"), "{error}");

    let elements = after(&content, "$Elements\n3\n");
    let many = with(&content, elements + 4, &7_i32.to_le_bytes());
    refused(
        &many,
        &format!(
            "byte {}: found 7, expected 1 to 3 elements in a batch (element 1 of 3)",
            elements + 4
        ),
    );
    let none = with(&content, elements + 4, &0_i32.to_le_bytes());
    refused(
        &none,
        &format!(
            "byte {}: found 0, expected 1 to 3 elements in a batch (element 1 of 3)",
            elements + 4
        ),
    );

    let content = write_41(&mesh, Encoding::BigEndian, tag);
    let nodes = after(&content, "$Nodes\n");
    let huge = with(&content, nodes + 8, &u64::MAX.to_be_bytes());
    let rest = content.len() - (nodes + 16);
    let message = format!(
        "byte {}: found the count {}, expected at most {}, which is what the rest of the file can hold",
        nodes + 8,
        u64::MAX,
        rest / 8 + 1
    );
    refused(&huge, &message);
}

#[test]
fn a_binary_file_cut_in_its_elements_says_so() {
    let content = bytes_of("box", "-41-bin");
    let cut = &content[..content.len() - 100];
    let error = parse(cut).unwrap_err().to_string();
    let tail = "found the end of the file, expected 8 bytes: a node tag (element block 5 of 5)";
    assert!(error.ends_with(tail), "{error}");
}
