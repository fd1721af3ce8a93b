//! The table of combinations.

#[test]
fn the_manual_has_the_table_of_the_program() {
    let file = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../docs/tables/combinations.md"
    );
    let page = std::fs::read_to_string(file).unwrap();
    let message = "the table is stale: run `cargo xtask chapter`, then `cargo xtask pages`";
    assert!(
        carom_verification::combinations::table().unwrap() == page,
        "{message}"
    );
}
