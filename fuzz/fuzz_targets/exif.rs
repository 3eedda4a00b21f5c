#![no_main]

//! Exif as it stands in a small DNG: the input is what lies behind the first directory's header.

use std::sync::LazyLock;

use darkroot_fuzz::LIMITS;
use darkroot_tests::small_raws;
use darkroot_tests::tiff_mutator::with_entry;
use libfuzzer_sys::fuzz_target;

static DNG: LazyLock<Vec<u8>> = LazyLock::new(|| small_raws::named("bayer-uncompressed.dng"));
const EXIF: u16 = 34665;
const GPS: u16 = 34853;
const LONG: u16 = 4;

fuzz_target!(init: darkroot_fuzz::expect_panics_of_decoders(), |bytes: &[u8]| {
    let Some((&which, directory)) = bytes.split_first() else { return };
    let mut file = DNG.clone();
    let at = file.len() as u32;
    file.extend_from_slice(directory);
    let tag = if which % 2 == 0 { EXIF } else { GPS };
    let file = with_entry(&file, tag, LONG, 1, &at.to_le_bytes());
    let _ = darkroot_raw::header(&file, &LIMITS);
});
