//! Transfer curve and sample type: from linear light to what files hold.

use darkroot_colour::TransferCurve;
use rayon::prelude::*;

use crate::render::{Render, TakeBand};
use crate::view::Cancelled;

/// Smallest exponent of the table: below 2^-40 the curve is a straight line to 0.
const EXPONENTS: i32 = 40;
/// Segments per octave.
const SEGMENTS: usize = 256;

/// A rising curve over 0..=1 that begins at 0, as a table: 256 straight pieces an octave over 40 octaves, within 3e-6 of it
/// where it is a transfer curve or the inverse of one.
#[derive(Debug, Clone)]
pub(crate) struct Octaves {
    /// Value at the start of each piece; one more for the end.
    knots: Vec<f32>,
}

impl Octaves {
    pub(crate) fn of(curve: impl Fn(f64) -> f64 + Sync) -> Self {
        let count = EXPONENTS as usize * SEGMENTS;
        let knot = |i: usize| {
            let (octave, part) = (i / SEGMENTS, i % SEGMENTS);
            let base = 2f64.powi(octave as i32 - EXPONENTS);
            curve(base * (1.0 + part as f64 / SEGMENTS as f64)) as f32
        };
        Self { knots: (0..count + 1).into_par_iter().with_min_len(1024).map(knot).collect() }
    }

    /// Value of the curve; what lies outside 0..=1 is cut.
    #[inline(always)]
    pub(crate) fn at(&self, v: f32) -> f32 {
        const FIRST: u32 = (127 - EXPONENTS as u32) << 23;
        const PIECE_BITS: u32 = 23 - SEGMENTS.trailing_zeros();
        // `max` makes 0 of a NaN, which `clamp` would keep.
        let v = f32::min(v.max(0.0), 1.0);
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

/// A transfer curve, made ready.
#[derive(Debug, Clone)]
pub struct Encoder {
    curve: TransferCurve,
    octaves: Octaves,
    steps: Steps,
}

impl Encoder {
    /// Prepares a curve.
    pub fn new(curve: TransferCurve) -> Self {
        let octaves = Octaves::of(|linear| curve.encode(linear));
        let steps = Steps::of(|linear| octaves.at(linear));
        Self { curve, octaves, steps }
    }
}

/// A sample as files hold it.
pub trait Sample: Copy + Default + Send + Sync + sealed::Sealed {
    /// The sample of linear light of 0..=1. Integers cut what lies outside; floating point is exact and cuts nothing.
    fn of(linear: f32, encoder: &Encoder) -> Self;

    /// Runs the stages for samples of this type. It stands here so that they are compiled with this crate, not again with each
    /// that uses it.
    #[doc(hidden)]
    fn render(render: &Render<'_>, rows: usize, take: &TakeBand<'_, Self>) -> Result<(), Cancelled>;

    /// Samples of a run of pixels; `out` gets R, G, B of each side by side.
    #[inline(always)]
    fn of_run([r, g, b]: [&[f32]; 3], encoder: &Encoder, out: &mut [Self]) {
        for (out, ((r, g), b)) in out.chunks_exact_mut(3).zip(r.iter().zip(g).zip(b)) {
            out[0] = Self::of(*r, encoder);
            out[1] = Self::of(*g, encoder);
            out[2] = Self::of(*b, encoder);
        }
    }
}

impl Sample for u8 {
    fn render(render: &Render<'_>, rows: usize, take: &TakeBand<'_, Self>) -> Result<(), Cancelled> {
        render.bands(rows, take)
    }

    #[inline(always)]
    fn of(linear: f32, encoder: &Encoder) -> Self {
        encoder.steps.at(encoder.steps.place(linear))
    }

    #[inline(always)]
    fn of_run(planes: [&[f32]; 3], encoder: &Encoder, out: &mut [Self]) {
        encoder.steps.of_run(planes, out);
    }
}

impl Sample for u16 {
    fn render(render: &Render<'_>, rows: usize, take: &TakeBand<'_, Self>) -> Result<(), Cancelled> {
        render.bands(rows, take)
    }

    #[inline(always)]
    fn of(linear: f32, encoder: &Encoder) -> Self {
        (encoder.octaves.at(linear) * 65535.0 + 0.5) as Self
    }
}

impl Sample for f32 {
    fn render(render: &Render<'_>, rows: usize, take: &TakeBand<'_, Self>) -> Result<(), Cancelled> {
        render.bands(rows, take)
    }

    #[inline(always)]
    fn of(linear: f32, encoder: &Encoder) -> Self {
        match encoder.curve {
            TransferCurve::Linear => linear,
            curve => curve.encode(f64::from(linear)) as Self,
        }
    }
}

mod sealed {
    pub trait Sealed {}
    impl Sealed for u8 {}
    impl Sealed for u16 {}
    impl Sealed for f32 {}
}

/// Encodes a run of pixels; `out` gets R, G, B of each side by side.
pub fn encode<T: Sample>(planes: [&[f32]; 3], encoder: &Encoder, out: &mut [T]) {
    T::of_run(planes, encoder, out);
}

/// The curve in steps of 8 bits, exactly: the first bits of a floating-point number tell the step but for one, and the other
/// bits decide.
#[derive(Debug, Clone)]
struct Steps {
    /// Bits of the light at which the table begins; below, all is step 0.
    first: i32,
    /// For each piece the step at its beginning, shifted, so far below the next step as the piece has light before that one
    /// begins: adding the bits of light within the piece carries over where it does. In no piece do two steps begin.
    pieces: Box<[u32; Self::PIECES]>,
}

impl Steps {
    /// Bits of a float within a piece: 256 pieces an octave, 68 steps in the uppermost one of sRGB.
    const WITHIN: u32 = 15;
    const PIECE: u32 = 1 << Self::WITHIN;
    /// 32 octaves: no curve's first step begins below 2^-24.
    const PIECES: usize = 8192;
    /// Pixels that are placed before they are looked up.
    const RUN: usize = 64;

    /// From a curve that is 0 at 0, 1 at 1 and rises.
    fn of(curve: impl Fn(f32) -> f32) -> Self {
        let step = |light: f32| (curve(light) * 255.0 + 0.5) as u32;
        // Floats from 0 to 1 are in the order of their bits.
        let begin = |k: u32| {
            let (mut below, mut at) = (0, 1f32.to_bits());
            while at - below > 1 {
                let middle = below + (at - below) / 2;
                if step(f32::from_bits(middle)) >= k { at = middle } else { below = middle }
            }
            at
        };
        let last = 1f32.to_bits() >> Self::WITHIN;
        let first = ((begin(1) >> Self::WITHIN) - 1).max(last + 1 - Self::PIECES as u32) << Self::WITHIN;
        let mut pieces = Box::new([255 << Self::WITHIN; Self::PIECES]);
        let mut next = begin(1);
        for (start, piece) in (first..=1f32.to_bits()).step_by(Self::PIECE as usize).zip(&mut *pieces) {
            let known = step(f32::from_bits(start));
            while known < 255 && next <= start {
                next = begin(known + 1);
            }
            let before = if known < 255 { (next - start).min(Self::PIECE) } else { Self::PIECE };
            *piece = (known << Self::WITHIN) + Self::PIECE - before;
        }
        Self { first: first as i32, pieces }
    }

    /// Where light lies in the table, in bits of a float; 0 for what lies before it, is negative or no number.
    #[inline(always)]
    fn place(&self, linear: f32) -> u32 {
        // `max` makes 0 of a NaN, which `clamp` would keep.
        let light = f32::min(linear.max(0.0), 1.0);
        (light.to_bits() as i32 - self.first).max(0) as u32
    }

    #[inline(always)]
    fn at(&self, place: u32) -> u8 {
        let piece = self.pieces[(place >> Self::WITHIN) as usize % Self::PIECES];
        ((piece + (place & (Self::PIECE - 1))) >> Self::WITHIN) as u8
    }

    #[inline(always)]
    fn of_run(&self, planes: [&[f32]; 3], out: &mut [u8]) {
        let mut places = [[0; Self::RUN]; 3];
        for (run, out) in out.chunks_mut(3 * Self::RUN).enumerate() {
            let pixels = out.len() / 3;
            for (places, plane) in places.iter_mut().zip(planes) {
                for (place, light) in places.iter_mut().zip(&plane[run * Self::RUN..][..pixels]) {
                    *place = self.place(*light);
                }
            }
            let [r, g, b] = &places;
            for (out, ((r, g), b)) in out.chunks_exact_mut(3).zip(r.iter().zip(g).zip(b)) {
                out[0] = self.at(*r);
                out[1] = self.at(*g);
                out[2] = self.at(*b);
            }
        }
    }
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
                assert!(
                    (f64::from(encoder.octaves.at(v)) - exact).abs() < 0.25 / 65535.0,
                    "{} at {v}",
                    space.name
                );
            }
        }
    }

    #[test]
    fn steps_of_8_bits_are_those_of_the_curve() {
        let curves = [
            RgbSpace::SRGB,
            RgbSpace::ADOBE_RGB,
            RgbSpace::PROPHOTO,
            RgbSpace::REC2020,
            RgbSpace::ECIRGB_V2,
            RgbSpace::SRGB.linear(),
        ];
        for space in curves {
            let encoder = Encoder::new(space.curve);
            for i in 0..=1_000_000u32 {
                let v = (f64::from(i) / 1_000_000.0).powi(3) as f32;
                assert_eq!(
                    u8::of(v, &encoder),
                    (encoder.octaves.at(v) * 255.0 + 0.5) as u8,
                    "{} at {v}",
                    space.name
                );
            }
        }
    }

    #[test]
    fn what_is_no_light_is_black_and_too_much_is_white() {
        let encoder = Encoder::new(TransferCurve::Srgb);
        for (v, expected) in
            [(f32::NAN, 0.0), (-1.0, 0.0), (0.0, 0.0), (1.0, 1.0), (7.0, 1.0), (f32::INFINITY, 1.0)]
        {
            assert!((encoder.octaves.at(v) - expected).abs() < 1e-6, "{v}");
            assert_eq!(f32::from(u8::of(v, &encoder)), 255.0 * expected, "{v}");
            assert_eq!(f32::from(u16::of(v, &encoder)), 65535.0 * expected, "{v}");
        }
    }
}
