//! Damaged copies of the samples: every one is a capture or a sentence, never a panic that leaves `decode`, never a
//! hang. More mutants: `DARKROOT_MUTANTS=20000 cargo test -p darkroot-raw --release --test mutations`.

#![allow(clippy::unwrap_used)] // A test may stop.

use darkroot_raw::{Decoder, Limits, decode};

/// xorshift64* (Marsaglia 2003; Vigna 2016): damage that is the same on every machine.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_f491_4f6c_dd1d)
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }
}

fn damage(bytes: &mut Vec<u8>, random: &mut Random) {
    // Headers lie at the start and at the end; samples in between are less interesting.
    let place = |random: &mut Random, length: usize| match random.below(4) {
        0 => random.below(length),
        1 => length - 1 - random.below(length.min(4096)),
        _ => random.below(length.min(4096)),
    };
    for _ in 0..=random.below(6) {
        let at = place(random, bytes.len());
        match random.below(5) {
            0 => bytes[at] = random.next() as u8,
            1 => bytes[at] ^= 1 << random.below(8),
            2 => {
                let word = [0, 0xff, 0x7f, 0x80][random.below(4)];
                let end = (at + 4).min(bytes.len());
                bytes[at..end].fill(word);
            }
            3 => {
                let from = place(random, bytes.len());
                let count = (1 + random.below(16)).min(bytes.len() - at.max(from));
                bytes.copy_within(from..from + count, at);
            }
            _ => {
                if random.below(8) == 0 {
                    bytes.truncate(at.max(1));
                }
            }
        }
    }
}

fn survive(path: &str) {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../samples/");
    let whole = std::fs::read(format!("{folder}{path}")).unwrap();
    let mutants: u64 = std::env::var("DARKROOT_MUTANTS").ok().and_then(|n| n.parse().ok()).unwrap_or(150);
    // A mutant that asks for more than the sample needs many times over is refused, not tried.
    let limits = Limits { max_samples: 20_000_000, ..Limits::default() };
    let (mut decoded, mut refused) = (0, 0);
    for seed in 1..=mutants {
        let mut random = Random(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15));
        let mut bytes = whole.clone();
        damage(&mut bytes, &mut random);
        for decoder in [Decoder::Flashraw, Decoder::Rawloader] {
            match decode(&bytes, decoder, &limits) {
                Ok(capture) => {
                    let size = capture.counts.size();
                    assert!(size.area() > 0 && capture.active_area.right() <= size.width);
                    assert!(capture.default_crop.bottom() <= size.height);
                    decoded += 1;
                }
                Err(error) => {
                    assert!(!error.to_string().is_empty());
                    refused += 1;
                }
            }
        }
    }
    // Both must happen, or the damage is too weak or too strong to test anything.
    assert!(decoded > 0 && refused > 0, "{decoded} decoded, {refused} refused");
}

#[test]
fn a_damaged_nef_is_a_capture_or_a_sentence() {
    survive("still-life.nef");
}

#[test]
fn a_damaged_dng_is_a_capture_or_a_sentence() {
    survive("still-life.dng");
}

#[test]
fn every_truncation_of_a_header_is_a_sentence() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../samples/");
    for name in ["still-life.nef", "still-life.dng"] {
        let whole = std::fs::read(format!("{folder}{name}")).unwrap();
        for length in (0..4096).step_by(37).chain([whole.len() / 2, whole.len() - 1]) {
            let result = decode(&whole[..length.min(whole.len())], Decoder::Flashraw, &Limits::default());
            assert!(result.is_err(), "{name} cut to {length} bytes decodes");
        }
    }
}
