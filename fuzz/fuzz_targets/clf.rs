#![no_main]

//! CLF tables.

use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    if let Ok(table) = darkroot_profile::export::clf::Clf::read(text) {
        let _ = table.apply([0.2, 0.4, 0.1]);
    }
});
