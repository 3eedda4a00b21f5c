#![no_main]

//! Layouts of charts in TOML.

use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let _ = darkroot_chart::ChartLayout::from_toml(text);
});
