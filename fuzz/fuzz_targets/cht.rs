#![no_main]

//! Argyll's chart recognition files.

use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let _ = darkroot_chart::ChartLayout::from_cht("a chart", text);
});
