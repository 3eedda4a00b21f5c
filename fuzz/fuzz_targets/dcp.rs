#![no_main]

//! DNG camera profiles. One in 64 is made into a profile of our own, which is a fit of fixed size.

use darkroot_profile::export::dcp::{Dcp, camera, import};
use libfuzzer_sys::{fuzz_mutator, fuzz_target};

fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    darkroot_fuzz::mutate_tiff(data, size, max_size, seed)
});

fuzz_target!(|bytes: &[u8]| {
    let _ = camera(bytes);
    if darkroot_fuzz::is_one_of(64, bytes) {
        let _ = import(bytes);
    }
    if let Ok(dcp) = Dcp::read(bytes) {
        for light in &dcp.lights {
            let _ = light.xyz([0.2, 0.4, 0.1]);
        }
        if let Some(table) = &dcp.rendering.table {
            let _ = table.apply([0.2, 0.4, 0.1], |v| v, |v| v);
        }
        if let Some(curve) = &dcp.rendering.curve {
            let _ = curve.at(0.3);
        }
    }
});
