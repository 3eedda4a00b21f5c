#![no_main]

//! Blocks of IPTC-IIM: what is read can be written and read.

use darkroot_encode::iptc;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let datasets = iptc::read(bytes);
    assert_eq!(iptc::read(&iptc::write(&datasets)).len(), datasets.len());
});
