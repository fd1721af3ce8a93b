//! Prints the table of the colliding rings for the manual: `cargo run --release -p carom-verification --example rings`.
#![allow(clippy::print_stdout)]

fn main() -> Result<(), carom_verification::Error> {
    print!("{}", carom_verification::rings::table()?);
    Ok(())
}
