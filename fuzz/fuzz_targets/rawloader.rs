#![no_main]

//! The decoder rawloader, behind the screen.

use darkroot_fuzz::LIMITS;
use darkroot_raw::Decoder;
use libfuzzer_sys::{fuzz_mutator, fuzz_target};

fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    darkroot_fuzz::mutate_tiff(data, size, max_size, seed)
});

fuzz_target!(init: darkroot_fuzz::expect_panics_of_decoders(), |bytes: &[u8]| {
    if let Ok(capture) = darkroot_raw::decode(bytes, Decoder::Rawloader, &LIMITS) {
        assert!(capture.active_area.right() <= capture.counts.size().width);
    }
});
