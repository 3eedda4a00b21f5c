//! Lossless JPEG (ITU-T T.81, process 14, SOF3), as DNG stores raw samples: one table for all components, first
//! predictor, 16-bit arithmetic.

use crate::bits::{Bits, category};

/// Categories of prediction errors of 16-bit samples: 0..=16.
const CATEGORIES: usize = 17;
/// Longest code that JPEG allows.
const MAX_LENGTH: usize = 16;

/// Encodes `rows` rows of `row_length` samples, each row of interleaved groups of `components` (1..=4, divides
/// `row_length`). Every sample must fit in `bits` (2..=16). Samples are predicted from the one on the left of
/// the same component.
pub fn encode(samples: &[u16], row_length: usize, components: usize, bits: u8) -> Vec<u8> {
    let row_length = row_length.max(1); // An empty picture has no rows.
    let rows = samples.len() / row_length;
    let errors = prediction_errors(samples, row_length, components, bits);
    let mut counts = [0u64; CATEGORIES];
    for &error in &errors {
        counts[usize::from(category(error).0)] += 1;
    }
    let lengths = code_lengths(&counts);
    let mut symbols: Vec<u8> = (0..CATEGORIES as u8).filter(|&s| lengths[usize::from(s)] > 0).collect();
    symbols.sort_by_key(|&s| lengths[usize::from(s)]);
    let codes = canonical_codes(&lengths, &symbols);

    let mut out = vec![0xff, 0xd8]; // SOI
    let mut frame = vec![bits];
    frame.extend_from_slice(&(rows as u16).to_be_bytes());
    frame.extend_from_slice(&((row_length / components) as u16).to_be_bytes());
    frame.push(components as u8);
    frame.extend((0..components as u8).flat_map(|c| [c, 0x11, 0]));
    segment(&mut out, 0xc3, &frame); // SOF3

    let mut table = vec![0];
    table.extend((1..=MAX_LENGTH).map(|n| lengths.iter().filter(|&&l| usize::from(l) == n).count() as u8));
    table.extend_from_slice(&symbols);
    segment(&mut out, 0xc4, &table); // DHT

    let mut scan = vec![components as u8];
    scan.extend((0..components as u8).flat_map(|c| [c, 0]));
    scan.extend_from_slice(&[1, 0, 0]); // Predictor 1, no point transform.
    segment(&mut out, 0xda, &scan); // SOS

    let mut stream = Bits::default();
    for &error in &errors {
        let (symbol, extra) = category(error);
        let (code, length) = codes[usize::from(symbol)];
        stream.push(code, u32::from(length));
        if symbol < 16 {
            stream.push(extra, u32::from(symbol));
        }
    }
    for byte in stream.finish(true) {
        out.push(byte);
        if byte == 0xff {
            out.push(0); // Byte stuffing, B.1.1.5.
        }
    }
    out.extend_from_slice(&[0xff, 0xd9]); // EOI
    out
}

/// Differences to the prediction, modulo 2^16 as -32767..=32768 (H.1.2.1).
fn prediction_errors(samples: &[u16], row_length: usize, components: usize, bits: u8) -> Vec<i32> {
    let mut errors = Vec::with_capacity(samples.len());
    for (y, row) in samples.chunks_exact(row_length).enumerate() {
        for (x, &sample) in row.iter().enumerate() {
            let prediction = match (x >= components, y > 0) {
                (true, _) => row[x - components],
                (false, true) => samples[(y - 1) * row_length + x],
                (false, false) => 1 << (bits - 1),
            };
            let error = i32::from(sample.wrapping_sub(prediction) as i16);
            errors.push(if error == -32768 { 32768 } else { error });
        }
    }
    errors
}

/// Lengths of the best prefix code for `counts`, none longer than 16 bits and the code of all ones left free
/// (Huffman 1952; T.81, K.2). 0 for symbols that do not occur.
fn code_lengths(counts: &[u64; CATEGORIES]) -> [u8; CATEGORIES] {
    let mut weights = *counts;
    loop {
        // Each group: weight and the symbols in it. The extra symbol takes the code of all ones.
        let mut lengths = [0u8; CATEGORIES + 1];
        let mut groups: Vec<(u64, Vec<usize>)> =
            (0..CATEGORIES).filter(|&s| weights[s] > 0).map(|s| (weights[s], vec![s])).collect();
        groups.push((0, vec![CATEGORIES]));
        while groups.len() > 1 {
            groups.sort_by_key(|group| std::cmp::Reverse(group.0));
            if let (Some(one), Some(two)) = (groups.pop(), groups.pop()) {
                let merged = [one.1, two.1].concat();
                merged.iter().for_each(|&s| lengths[s] += 1);
                groups.push((one.0 + two.0, merged));
            }
        }
        if usize::from(lengths.iter().copied().max().unwrap_or(0)) <= MAX_LENGTH {
            return std::array::from_fn(|s| lengths[s]);
        }
        // Flatter weights give shorter codes.
        weights.iter_mut().filter(|w| **w > 0).for_each(|w| *w = *w / 2 + 1);
    }
}

/// Codes in order of length (C.2), each with its length. The free code of all ones comes last of the longest.
fn canonical_codes(lengths: &[u8; CATEGORIES], symbols: &[u8]) -> [(u32, u8); CATEGORIES] {
    let mut codes = [(0, 0); CATEGORIES];
    let (mut next, mut previous) = (0u32, 0);
    for &symbol in symbols {
        let length = lengths[usize::from(symbol)];
        next <<= length - previous;
        codes[usize::from(symbol)] = (next, length);
        next += 1;
        previous = length;
    }
    codes
}

fn segment(out: &mut Vec<u8>, marker: u8, payload: &[u8]) {
    out.extend_from_slice(&[0xff, marker]);
    out.extend_from_slice(&(payload.len() as u16 + 2).to_be_bytes());
    out.extend_from_slice(payload);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_code_is_longer_than_16_bits_or_all_ones() {
        let steep: [u64; CATEGORIES] = std::array::from_fn(|i| 1 << (2 * i));
        for counts in [[1; CATEGORIES], steep, std::array::from_fn(|i| u64::from(i == 3))] {
            let lengths = code_lengths(&counts);
            let used = (0..CATEGORIES).filter(|&s| counts[s] > 0);
            assert!(used.clone().all(|s| (1..=16).contains(&lengths[s])), "{lengths:?}");
            let space: f64 = used.map(|s| 0.5f64.powi(i32::from(lengths[s]))).sum();
            assert!(space < 1.0, "{lengths:?} leaves no code free");
        }
    }

    #[test]
    fn flat_samples_take_one_bit_each() {
        let bytes = encode(&[8192; 64 * 64], 64, 2, 14);
        assert!(bytes.len() < 64 * 64 / 8 + 60);
    }
}
