//! Prints the table of the bouncing bar for the manual: `cargo run --release -p carom-verification --example long_run`.
#![allow(clippy::print_stdout)]

fn main() -> Result<(), carom_verification::Error> {
    print!("{}", carom_verification::long_run::table(100, 200)?);
    Ok(())
}
