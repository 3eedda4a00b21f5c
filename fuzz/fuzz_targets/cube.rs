#![no_main]

//! Cube tables.

use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    if let Ok(grid) = darkroot_profile::export::cube::read(text) {
        let _ = grid.at([0.2, 0.4, 0.1]);
    }
});
