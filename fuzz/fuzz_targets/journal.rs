#![no_main]

//! The journal of a batch. Sums that are right are hard to guess: where the first byte is odd, each line gets its own.

use darkroot_fuzz::as_file;
use libfuzzer_sys::fuzz_target;
use sha2::{Digest, Sha256};

fuzz_target!(|bytes: &[u8]| {
    let Some((&which, text)) = bytes.split_first() else { return };
    let text = if which % 2 == 1 { with_sums(text) } else { text.to_vec() };
    as_file(".darkroot/journal.jsonl", &text, |path| {
        if let Some(out) = path.parent().and_then(std::path::Path::parent) {
            let _ = darkroot_batch::journal::read_merged(out);
        }
    });
});

fn with_sums(text: &[u8]) -> Vec<u8> {
    let mut out = Vec::new();
    for body in text.split(|byte| *byte == b'\n') {
        let sum: String = Sha256::digest(body).iter().take(4).map(|byte| format!("{byte:02x}")).collect();
        out.extend_from_slice(body);
        out.extend_from_slice(format!(",\"sum\":\"{sum}\"}}\n").as_bytes());
    }
    out
}
