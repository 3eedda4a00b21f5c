#![no_main]

//! Tables of spectra, as reflectances, lights and sensitivities.

use darkroot_fuzz::as_file;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    as_file("spectra.csv", bytes, |path| {
        if let Ok((_, file)) = darkroot::spectra::read_sensitivities(path) {
            let _ = (file.reflectances(), file.lights());
        }
        if let Ok(file) = darkroot::spectra::read(path) {
            let _ = (file.reflectances(), file.lights());
        }
    });
});
