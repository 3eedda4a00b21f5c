//! Transfer curve and sample type: from linear light to what files hold.

use darkroot_colour::TransferCurve;
use darkroot_photo::{Display, Encoded, Rgb};
use rayon::prelude::*;

/// Smallest exponent of the table: below 2^-40 the curve is a straight line to 0.
const EXPONENTS: i32 = 40;
/// Segments per octave.
const SEGMENTS: usize = 256;

/// A transfer curve as a table: 256 straight pieces an octave over 40 octaves, within 3e-6 of the curve.
#[derive(Debug, Clone)]
pub struct Encoder {
    curve: TransferCurve,
    /// Value at the start of each piece; one more for the end.
    knots: Vec<f32>,
}

impl Encoder {
    /// Prepares a curve.
    pub fn new(curve: TransferCurve) -> Self {
        let count = EXPONENTS as usize * SEGMENTS;
        let knots = (0..count + 1)
            .into_par_iter()
            .with_min_len(1024)
            .map(|i| {
                let (octave, part) = (i / SEGMENTS, i % SEGMENTS);
                let base = 2f64.powi(octave as i32 - EXPONENTS);
                curve.encode(base * (1.0 + part as f64 / SEGMENTS as f64)) as f32
            })
            .collect();
        Self { curve, knots }
    }

    /// Encoded value of linear light of 0..=1; values outside are cut.
    #[inline(always)]
    fn at(&self, linear: f32) -> f32 {
        const FIRST: u32 = (127 - EXPONENTS as u32) << 23;
        const PIECE_BITS: u32 = 23 - SEGMENTS.trailing_zeros();
        // `max` makes 0 of a NaN, which `clamp` would keep.
        let v = f32::min(linear.max(0.0), 1.0);
        let bits = v.to_bits();
        if bits < FIRST {
            return v * (self.knots[0] / f32::from_bits(FIRST));
        }
        let place = bits - FIRST;
        let i = (place >> PIECE_BITS) as usize;
        let part = (place & ((1 << PIECE_BITS) - 1)) as f32 / (1u32 << PIECE_BITS) as f32;
        let low = self.knots[i];
        match self.knots.get(i + 1) {
            Some(high) => low + (high - low) * part,
            None => low,
        }
    }
}

/// Encodes for 8- or 16-bit files; what lies outside 0..=1 is cut.
pub fn encode(mut picture: Rgb<Display>, encoder: &Encoder) -> Rgb<Encoded> {
    for plane in picture.planes_mut() {
        for v in plane {
            *v = encoder.at(*v);
        }
    }
    picture.into_space()
}

/// Encodes for floating-point files: exact, nothing is cut.
pub fn encode_unbounded(mut picture: Rgb<Display>, encoder: &Encoder) -> Rgb<Encoded> {
    if encoder.curve != TransferCurve::Linear {
        for plane in picture.planes_mut() {
            for v in plane {
                *v = encoder.curve.encode(f64::from(*v)) as f32;
            }
        }
    }
    picture.into_space()
}

#[cfg(test)]
mod tests {
    use super::*;
    use darkroot_colour::RgbSpace;

    #[test]
    fn the_table_is_the_curve_to_a_quarter_step_of_16_bits() {
        for space in
            [RgbSpace::SRGB, RgbSpace::ADOBE_RGB, RgbSpace::PROPHOTO, RgbSpace::REC2020, RgbSpace::ECIRGB_V2]
        {
            let encoder = Encoder::new(space.curve);
            for i in 0..=100_000u32 {
                let v = (f64::from(i) / 100_000.0).powi(3) as f32;
                let exact = space.curve.encode(f64::from(v));
                assert!((f64::from(encoder.at(v)) - exact).abs() < 0.25 / 65535.0, "{} at {v}", space.name);
            }
        }
    }

    #[test]
    fn what_is_no_light_is_black_and_too_much_is_white() {
        let encoder = Encoder::new(TransferCurve::Srgb);
        for (v, expected) in
            [(f32::NAN, 0.0), (-1.0, 0.0), (0.0, 0.0), (1.0, 1.0), (7.0, 1.0), (f32::INFINITY, 1.0)]
        {
            assert!((encoder.at(v) - expected).abs() < 1e-6, "{v}");
        }
    }
}
