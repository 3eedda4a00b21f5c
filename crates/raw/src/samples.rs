//! A fingerprint of decoded samples.

use darkroot_photo::Counts;

/// FNV-1a over the samples as 64-bit words, one xor and multiply a sample, row by row over the whole frame
/// before any crop. Floating-point samples enter by their bits.
pub fn samples_hash(counts: &Counts) -> u64 {
    const OFFSET_BASIS: u64 = 0xcbf2_9ce4_8422_2325;
    const PRIME: u64 = 0x100_0000_01b3;
    let step = |hash: u64, word: u64| (hash ^ word).wrapping_mul(PRIME);
    match counts {
        Counts::U16(m) => m.samples.iter().fold(OFFSET_BASIS, |h, &s| step(h, u64::from(s))),
        Counts::F32(m) => m.samples.iter().fold(OFFSET_BASIS, |h, &s| step(h, u64::from(s.to_bits()))),
    }
}
