#![no_main]

//! ICC profiles as Darkroot reads back what it writes.

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Ok(profile) = darkroot_profile::export::icc::Icc::read(bytes) {
        let _ = profile.xyz([0.2, 0.4, 0.1]);
    }
});
