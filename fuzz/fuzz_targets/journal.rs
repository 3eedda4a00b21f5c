#![no_main]

//! The journal of a batch.

use darkroot_fuzz::as_file;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    as_file(".darkroot/journal.jsonl", bytes, |path| {
        if let Some(out) = path.parent().and_then(std::path::Path::parent) {
            let _ = darkroot_batch::journal::read_merged(out);
        }
    });
});
