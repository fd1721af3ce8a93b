//! Prints the table of combinations for the manual: `cargo run --release -p carom-verification --example combinations`.
#![allow(clippy::print_stdout)]

fn main() -> Result<(), carom_verification::Error> {
    print!("{}", carom_verification::combinations::table()?);
    Ok(())
}
