#![no_main]

//! Look-up tables, .cube and CLF: a table that is read gives finite colours for colours of every kind, or what infinity makes of
//! them, and never panics.

use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    if let Ok(lut) = darkroot::lut::parse(text) {
        for v in [
            [0.0, 0.5, 1.0],
            [-1.0, 0.25, 4.0],
            [f32::NAN, f32::INFINITY, f32::NEG_INFINITY],
            [1e-40, 65504.0, -0.0],
        ] {
            let _ = lut.at(v);
        }
        let _ = lut.is_one_curve();
    }
});
