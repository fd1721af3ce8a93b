//! Prints the table of pairs of features for the manual: `cargo run --release -p carom-verification --example pairs`.
#![allow(clippy::print_stdout)]

fn main() -> Result<(), carom_verification::Error> {
    print!("{}", carom_verification::pairs::table()?);
    Ok(())
}
