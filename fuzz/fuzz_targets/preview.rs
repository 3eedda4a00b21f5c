#![no_main]

//! The embedded preview.

use libfuzzer_sys::{fuzz_mutator, fuzz_target};

fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    darkroot_fuzz::mutate_tiff(data, size, max_size, seed)
});

fuzz_target!(init: darkroot_fuzz::expect_panics_of_decoders(), |bytes: &[u8]| {
    let _ = darkroot_raw::preview(bytes);
});
