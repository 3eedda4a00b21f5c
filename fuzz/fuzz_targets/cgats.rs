#![no_main]

//! References of charts: CGATS. The corpus says which kind the function meets.

use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let _ = darkroot_chart::Reference::parse(text);
});
