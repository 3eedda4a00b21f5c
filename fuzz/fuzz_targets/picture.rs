#![no_main]

//! Looking for charts in pictures.

use std::sync::LazyLock;

use darkroot::{Settings, charts, find_charts};
use darkroot_chart::ChartLayout;
use darkroot_fuzz::as_file;
use libfuzzer_sys::fuzz_target;

static LAYOUTS: LazyLock<Vec<ChartLayout>> = LazyLock::new(charts::layouts);

fuzz_target!(|bytes: &[u8]| {
    as_file("picture.png", bytes, |path| {
        let _ = find_charts(path, &LAYOUTS, &Settings::default());
    });
});
