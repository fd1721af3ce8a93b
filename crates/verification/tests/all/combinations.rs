//! The tables of combinations.

fn compare(file: &str, table: String) {
    let tables = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/tables");
    let page = std::fs::read_to_string(format!("{tables}/{file}")).unwrap();
    let message = "the table is stale: run `cargo xtask chapter`, then `cargo xtask pages`";
    assert!(table == page, "{message}");
}

#[test]
fn the_manual_has_the_table_of_the_program() {
    let table = carom_verification::combinations::table();
    compare("combinations.md", table.unwrap());
}

#[test]
fn the_manual_has_the_table_of_pairs() {
    compare("pairs.md", carom_verification::pairs::table().unwrap());
}
