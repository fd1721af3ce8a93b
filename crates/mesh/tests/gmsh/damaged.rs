//! Files cut and overwritten anywhere: an error or a sound mesh, never a panic.

use super::{FORMATS, MESHES, bytes_of, parse};
use carom_testing::damage::damaged;

use crate::damage::is_consistent;

#[test]
fn a_file_cut_at_any_byte_is_refused() {
    for (mesh, format) in MESHES[..4]
        .iter()
        .flat_map(|mesh| FORMATS.map(|format| (mesh, format)))
    {
        let content = bytes_of(mesh, format);
        let end = content.trim_ascii_end().len();
        for length in 0..end {
            let error = parse(&content[..length]);
            assert!(error.is_err(), "{mesh}{format} cut at {length}");
        }
        parse(&content[..end]).unwrap();
    }
}

#[test]
fn damaged_files_give_an_error_or_a_consistent_mesh() {
    let mut state = 0x2545_f491_4f6c_dd1d;
    for (mesh, format) in MESHES[..4]
        .iter()
        .flat_map(|mesh| FORMATS.map(|format| (mesh, format)))
    {
        let content = bytes_of(mesh, format);
        for _ in 0..5000 {
            let content = damaged(&content, &mut state);
            if let Ok(mesh) = parse(&content) {
                assert!(is_consistent(&mesh), "{mesh:?}");
            }
        }
    }
}

#[test]
fn lines_lost_or_doubled_give_an_error_or_a_consistent_mesh() {
    for (mesh, format) in MESHES[..4]
        .iter()
        .flat_map(|mesh| ["-22", "-41"].map(|format| (mesh, format)))
    {
        let content = bytes_of(mesh, format);
        let lines: Vec<&[u8]> = content.split_inclusive(|&byte| byte == b'\n').collect();
        for i in 0..lines.len() {
            let lost = [&lines[..i], &lines[i + 1..]].concat().concat();
            let doubled = [&lines[..=i], &lines[i..]].concat().concat();
            for content in [lost, doubled] {
                if let Ok(mesh) = parse(&content) {
                    assert!(is_consistent(&mesh), "{mesh:?}");
                }
            }
        }
    }
}
