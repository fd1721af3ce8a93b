//! VTU and PVD, decoded by hand from the description of the format.

use std::collections::BTreeMap;
use std::io::Read;
use std::path::Path;

use carom_elements::Kind;
use carom_output::vtu::{Cells, Field, Grid, Values, write};
use carom_output::{Collection, Error};

/// One array as the file has it: the attributes of its element and its bytes.
pub struct Array {
    pub attributes: BTreeMap<String, String>,
    bytes: Vec<u8>,
}

impl Array {
    pub fn floats(&self) -> Vec<f64> {
        assert_eq!(self.attributes["type"], "Float64");
        self.bytes
            .as_chunks()
            .0
            .iter()
            .map(|b| f64::from_le_bytes(*b))
            .collect()
    }

    pub fn integers(&self) -> Vec<i64> {
        match self.attributes["type"].as_str() {
            "Int64" => self
                .bytes
                .as_chunks()
                .0
                .iter()
                .map(|b| i64::from_le_bytes(*b))
                .collect(),
            "Int32" => self
                .bytes
                .as_chunks()
                .0
                .iter()
                .map(|b| i32::from_le_bytes(*b).into())
                .collect(),
            "UInt8" => self.bytes.iter().map(|b| i64::from(*b)).collect(),
            other => panic!("type {other}"),
        }
    }
}

fn attributes(element: &str) -> BTreeMap<String, String> {
    let mut rest = element;
    let mut found = BTreeMap::new();
    while let Some((name, tail)) = rest.split_once("=\"") {
        let (value, tail) = tail.split_once('"').unwrap();
        found.insert(
            name.split_whitespace().last().unwrap().to_owned(),
            value.to_owned(),
        );
        rest = tail;
    }
    found
}

fn number(bytes: &[u8], place: usize) -> usize {
    u64::from_le_bytes(bytes[8 * place..8 * place + 8].try_into().unwrap()) as usize
}

/// The array which begins at the head of `data`: blocks, their length, length of the last, compressed lengths, data.
fn decode(data: &[u8]) -> Vec<u8> {
    let (blocks, length, last) = (number(data, 0), number(data, 1), number(data, 2));
    let mut start = 8 * (3 + blocks);
    let mut bytes = Vec::new();
    for block in 0..blocks {
        let compressed = number(data, 3 + block);
        let before = bytes.len();
        flate2::read::ZlibDecoder::new(&data[start..start + compressed])
            .read_to_end(&mut bytes)
            .unwrap();
        let expected = if block + 1 == blocks && last > 0 {
            last
        } else {
            length
        };
        assert_eq!(bytes.len() - before, expected);
        start += compressed;
    }
    bytes
}

pub fn read(path: &Path) -> (String, BTreeMap<String, Array>) {
    let file = std::fs::read(path).unwrap();
    let mark = b"<AppendedData encoding=\"raw\">\n_";
    let head = file
        .windows(mark.len())
        .position(|window| window == mark)
        .unwrap();
    let header = String::from_utf8(file[..head].to_vec()).unwrap();
    assert!(header.contains("header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\""));
    assert!(header.contains("byte_order=\"LittleEndian\""));
    assert!(file.ends_with(b"\n</AppendedData>\n</VTKFile>\n"));
    let data = &file[head + mark.len()..];
    let arrays = header.split("<DataArray").skip(1).map(|element| {
        let attributes = attributes(element.split("/>").next().unwrap());
        let bytes = decode(&data[attributes["offset"].parse::<usize>().unwrap()..]);
        (attributes["Name"].clone(), Array { attributes, bytes })
    });
    (header.clone(), arrays.collect())
}

/// A hexahedron and a tetrahedron that share a face corner, and the boundary triangle of the second.
const POINTS: [[f64; 3]; 9] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [1.0, 1.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [1.0, 0.0, 1.0],
    [1.0, 1.0, 1.0],
    [0.0, 1.0, 1.0],
    [2.0, 0.5, 0.1],
];
const CELLS: [Cells; 3] = [
    Cells {
        kind: Kind::Hex8,
        nodes: &[0, 1, 2, 3, 4, 5, 6, 7],
    },
    Cells {
        kind: Kind::Tet4,
        nodes: &[1, 8, 2, 6],
    },
    Cells {
        kind: Kind::Tri3,
        nodes: &[1, 8, 2],
    },
];

fn bare<'a>() -> Grid<'a> {
    Grid {
        time: 0.0,
        points: &POINTS,
        cells: &CELLS,
        point_fields: &[],
        cell_fields: &[],
    }
}

#[test]
fn every_array_of_a_grid_is_read_back_bit_for_bit() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("grid.vtu");
    let velocity: Vec<[f64; 3]> = (0..9)
        .map(|i| [f64::from(i) / 3.0, -0.0, f64::NAN])
        .collect();
    let gap: Vec<f64> = (0..9).map(|i| f64::from(i) * 1e-300).collect();
    let stress = [[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]; 3];
    let grid = Grid {
        time: 1.0e-7 / 3.0,
        point_fields: &[
            Field {
                name: "velocity",
                values: Values::Vector(&velocity),
            },
            Field {
                name: "gap <\"&\">",
                values: Values::Scalar(&gap),
            },
        ],
        cell_fields: &[
            Field {
                name: "stress",
                values: Values::SymmetricTensor(&stress),
            },
            Field {
                name: "body",
                values: Values::Integer(&[1, -2, 3]),
            },
        ],
        ..bare()
    };
    write(&path, &grid).unwrap();
    let (header, arrays) = read(&path);
    assert!(header.contains("NumberOfPoints=\"9\" NumberOfCells=\"3\""));
    assert_eq!(arrays["TimeValue"].floats(), [1.0e-7 / 3.0]);
    assert_eq!(arrays["Points"].floats(), POINTS.as_flattened());
    let bits = |values: &[f64]| {
        values
            .iter()
            .map(|value| value.to_bits())
            .collect::<Vec<_>>()
    };
    assert_eq!(
        bits(&arrays["velocity"].floats()),
        bits(velocity.as_flattened())
    );
    assert_eq!(arrays["velocity"].attributes["NumberOfComponents"], "3");
    assert_eq!(arrays["gap &lt;&quot;&amp;&quot;&gt;"].floats(), gap);
    assert_eq!(arrays["stress"].floats(), stress.as_flattened());
    assert_eq!(arrays["stress"].attributes["NumberOfComponents"], "6");
    assert_eq!(arrays["body"].integers(), [1, -2, 3]);
    assert_eq!(
        arrays["connectivity"].integers(),
        [0, 1, 2, 3, 4, 5, 6, 7, 1, 8, 2, 6, 1, 8, 2]
    );
    assert_eq!(arrays["offsets"].integers(), [8, 12, 15]);
    assert_eq!(arrays["types"].integers(), [12, 10, 5]);
}

/// Points of cells whose nodes VTK lists in another order: each point of the file lies where VTK has it.
#[test]
fn nodes_are_listed_in_the_order_of_vtk() {
    let folder = tempfile::tempdir().unwrap();
    for kind in Kind::ALL {
        let table = kind.table();
        let nodes: Vec<u32> = (0..2 * table.nodes as u32).collect();
        let twice = [table.reference, table.reference].concat();
        let path = folder.path().join(format!("{}.vtu", table.name));
        let grid = Grid {
            points: &twice,
            cells: &[Cells {
                kind,
                nodes: &nodes,
            }],
            ..bare()
        };
        write(&path, &grid).unwrap();
        let (_, arrays) = read(&path);
        let listed = arrays["connectivity"].integers();
        for (cell, listed) in listed.chunks_exact(table.nodes).enumerate() {
            for (a, &place) in table.vtk_order.iter().enumerate() {
                assert_eq!(
                    listed[place],
                    (cell * table.nodes + a) as i64,
                    "{}",
                    table.name
                );
            }
        }
        assert_eq!(arrays["types"].integers(), [i64::from(table.vtk); 2]);
    }
    // The first triangle of VTK's wedge turns outward, that of ours inward.
    let (_, arrays) = read(&folder.path().join("wedge6.vtu"));
    assert_eq!(arrays["connectivity"].integers()[..6], [0, 2, 1, 3, 5, 4]);
}

#[test]
fn arrays_of_no_block_one_whole_block_and_many_blocks_are_read_back() {
    let folder = tempfile::tempdir().unwrap();
    // 2^15 numbers fill one block exactly.
    for count in [0_usize, 1, 1 << 15, (1 << 15) + 1, 100_000] {
        let points: Vec<[f64; 3]> = (0..count)
            .map(|i| [(i as f64).sin(), (i as f64).cos(), 0.0])
            .collect();
        let numbers: Vec<f64> = points.iter().map(|point| point[0] * 1e-3).collect();
        let nodes: Vec<u32> = (0..count as u32).collect();
        let path = folder.path().join(format!("{count}.vtu"));
        let grid = Grid {
            time: 0.0,
            points: &points,
            cells: &[Cells {
                kind: Kind::Point1,
                nodes: &nodes,
            }],
            point_fields: &[Field {
                name: "x",
                values: Values::Scalar(&numbers),
            }],
            cell_fields: &[],
        };
        write(&path, &grid).unwrap();
        let (_, arrays) = read(&path);
        assert_eq!(arrays["x"].floats(), numbers);
        assert_eq!(arrays["Points"].floats(), points.as_flattened());
        assert_eq!(arrays["types"].integers(), vec![1; count]);
    }
}

#[test]
fn a_grid_whose_parts_do_not_fit_is_refused_and_leaves_no_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("grid.vtu");
    let short = [Field {
        name: "gap",
        values: Values::Scalar(&[1.0, 2.0]),
    }];
    let refused = |grid: Grid| write(&path, &grid).unwrap_err().to_string();
    assert_eq!(
        refused(Grid {
            point_fields: &short,
            ..bare()
        }),
        "field 'gap' has 2 values for 9 points"
    );
    assert_eq!(
        refused(Grid {
            cell_fields: &short,
            ..bare()
        }),
        "field 'gap' has 2 values for 3 cells"
    );
    let part = [Cells {
        kind: Kind::Tet4,
        nodes: &[0, 1, 2],
    }];
    assert_eq!(
        refused(Grid {
            cells: &part,
            ..bare()
        }),
        "3 node numbers do not make whole cells of kind Tet4"
    );
    let beyond = [Cells {
        kind: Kind::Bar2,
        nodes: &[0, 9],
    }];
    assert_eq!(
        refused(Grid {
            cells: &beyond,
            ..bare()
        }),
        "a cell of kind Bar2 names point 9 of 9"
    );
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn a_collection_is_complete_after_every_addition() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("fields.pvd");
    let mut collection = Collection::create(&path).unwrap();
    let mut expected: Vec<(f64, String)> = Vec::new();
    for step in 0..4 {
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(text.starts_with("<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\""));
        assert!(text.ends_with("</Collection>\n</VTKFile>\n"));
        let entries = text.split("<DataSet").skip(1).map(attributes);
        let found: Vec<(f64, String)> = entries
            .map(|entry| (entry["timestep"].parse().unwrap(), entry["file"].clone()))
            .collect();
        assert_eq!(found, expected);
        let (time, file) = (
            f64::from(step) * 1e-7 / 3.0,
            format!("fields/a&b_{step}.vtu"),
        );
        collection.add(time, &[&file]).unwrap();
        expected.push((time, file.replace('&', "&amp;")));
    }
    std::fs::remove_file(&path).unwrap();
    std::fs::create_dir(&path).unwrap();
    let error = collection.add(1.0, &["late.vtu"]).unwrap_err();
    assert!(
        matches!(error, Error::File { path: ref named, .. } if *named == path),
        "{error}"
    );
}
