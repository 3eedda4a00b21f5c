#![no_main]

//! Profile files: what is read can be written and read again; one in 16 is judged.

use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let Ok(profile) = darkroot_profile::file::parse(text) else { return };
    let again = darkroot_profile::file::format(&profile);
    assert_eq!(darkroot_profile::file::parse(&again).as_ref(), Ok(&profile));
    if darkroot_fuzz::is_one_of(16, text.as_bytes()) {
        for calibration in profile.calibrations() {
            let _ = darkroot_profile::lint::check(calibration);
        }
    }
});
