//! The program `darkroot`.
fn main() {}
