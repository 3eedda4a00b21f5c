#![no_main]

//! Sidecars and packets of XMP: what is understood is written so that it is understood again.

use darkroot::metadata::Xmp;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    if let Ok(xmp) = Xmp::parse(text) {
        let packet = xmp.packet();
        assert!(packet.is_empty() || Xmp::parse(&packet).is_ok(), "{packet}");
    }
});
