//! Pixels to blocks of lightness and of two colour differences, and these to the bits of a scan. A unit is what shares its
//! colours: one block of each, or two or four of lightness.

use darkroot_colour::simd::vectorised;

use super::entropy::{Bits, Coder};
use super::tables::Kind;
use super::transform::{BLOCKS, Blocks, Quantiser, Samples, WIDTH};
use crate::ChromaSubsampling;

/// Pixels that share a colour.
#[derive(Clone, Copy)]
pub(super) struct Subsampling {
    pub(super) across: usize,
    pub(super) down: usize,
}

impl Subsampling {
    pub(super) fn of(chosen: ChromaSubsampling) -> Self {
        match chosen {
            ChromaSubsampling::S444 => Self { across: 1, down: 1 },
            ChromaSubsampling::S422 => Self { across: 2, down: 1 },
            ChromaSubsampling::S420 => Self { across: 2, down: 2 },
        }
    }

    /// Of a unit in pixels.
    pub(super) fn width(self) -> usize {
        8 * self.across
    }

    /// Of a unit in pixels.
    pub(super) fn height(self) -> usize {
        8 * self.down
    }
}

const EMPTY: Samples = [[0.0; WIDTH]; 8];

/// What codes rows of units.
pub(super) struct Scan {
    subsampling: Subsampling,
    luminance: (Quantiser, Coder),
    chrominance: (Quantiser, Coder),
}

/// Samples and blocks of eight units; of those of lightness and of whole colours there are up to four, left to right and
/// down.
struct Strip {
    components: [[Samples; 4]; 3],
    luminance: [Blocks; 4],
    chrominance: [Blocks; 2],
}

impl Scan {
    /// For a quality of 1 to 100.
    pub(super) fn new(subsampling: Subsampling, quality: u8) -> Self {
        let of = |kind| (Quantiser::new(kind, quality), Coder::new(kind));
        Self { subsampling, luminance: of(Kind::Luminance), chrominance: of(Kind::Chrominance) }
    }

    /// The bits of some rows of R, G, B, filled up to whole bytes. Pixels beyond the edge are as those at it.
    pub(super) fn encode(&self, samples: &[u8], width: usize) -> Vec<u8> {
        let rows: Vec<&[u8]> = samples.chunks_exact(3 * width).collect();
        let mut strip = Box::new(Strip {
            components: [[EMPTY; 4]; 3],
            luminance: [Blocks::EMPTY; 4],
            chrominance: [Blocks::EMPTY; 2],
        });
        // A photograph at quality 92 takes a fifth of its samples.
        let mut bits = Bits::with_room_for(samples.len() / 4);
        vectorised(
            #[inline(always)]
            || self.rows(&rows, width, &mut strip, &mut bits),
        );
        bits.end()
    }

    #[inline(always)]
    fn rows(&self, rows: &[&[u8]], width: usize, strip: &mut Strip, bits: &mut Bits) {
        let mut means = [0; 3];
        for rows in rows.chunks(self.subsampling.height()) {
            for left in (0..width).step_by(BLOCKS * self.subsampling.width()) {
                let units = (width - left).div_ceil(self.subsampling.width()).min(BLOCKS);
                self.strip(rows, left, strip);
                self.bits(strip, units, &mut means, bits);
            }
        }
    }

    /// Fills a strip from the pixels at `left`.
    #[inline(always)]
    fn strip(&self, rows: &[&[u8]], left: usize, strip: &mut Strip) {
        let Subsampling { across, down } = self.subsampling;
        let [luminance, blue, red] = &mut strip.components;
        for y in 0..8 * down {
            let row = &rows[y.min(rows.len() - 1)][3 * left..];
            for part in 0..across {
                let at = y / 8 * across + part;
                let (y, from) = (y % 8, 3 * WIDTH * part);
                let out = [&mut luminance[at][y], &mut blue[at][y], &mut red[at][y]];
                match row.get(from..).and_then(|row| row.first_chunk()) {
                    Some(pixels) => separate(pixels, out),
                    None => separate(&at_the_edge(row, from), out),
                }
            }
        }
        self.subsampling.average(blue);
        self.subsampling.average(red);
        let luminance = luminance.iter_mut().take(across * down).zip(&mut strip.luminance);
        let chrominance = [&mut blue[0], &mut red[0]].into_iter().zip(&mut strip.chrominance);
        let luminance = luminance.map(|(samples, blocks)| (&self.luminance.0, samples, blocks));
        let chrominance = chrominance.map(|(samples, blocks)| (&self.chrominance.0, samples, blocks));
        for (quantiser, samples, blocks) in luminance.chain(chrominance) {
            quantiser.quantise(samples, blocks);
        }
    }

    /// Adds the first units of a strip.
    #[inline(always)]
    fn bits(&self, strip: &Strip, units: usize, means: &mut [i16; 3], bits: &mut Bits) {
        let Subsampling { across, down } = self.subsampling;
        let [luminance, blue, red] = means;
        for unit in 0..units {
            for y in 0..down {
                for x in across * unit..across * (unit + 1) {
                    let blocks = &strip.luminance[across * y + x / BLOCKS];
                    self.luminance.1.put(blocks, x % BLOCKS, luminance, bits);
                }
            }
            self.chrominance.1.put(&strip.chrominance[0], unit, blue, bits);
            self.chrominance.1.put(&strip.chrominance[1], unit, red, bits);
        }
    }
}

impl Subsampling {
    /// Makes the colours of a strip one for two or four pixels, their mean, in the first samples.
    #[inline(always)]
    fn average(self, samples: &mut [Samples; 4]) {
        let Self { across, down } = self;
        if across == 1 {
            return;
        }
        let mut means = EMPTY;
        for (y, means) in means.iter_mut().enumerate() {
            let (upper, lower) = (down * y, down * y + down - 1);
            for part in 0..across {
                let upper = &samples[upper / 8 * across + part][upper % 8];
                let lower = &samples[lower / 8 * across + part][lower % 8];
                let means = &mut means[WIDTH / 2 * part..][..WIDTH / 2];
                for x in 0..WIDTH / 2 {
                    means[x] = 0.25 * (upper[2 * x] + upper[2 * x + 1] + lower[2 * x] + lower[2 * x + 1]);
                }
            }
        }
        samples[0] = means;
    }
}

/// The pixels of a row from a byte on, the last one again where there are no more.
#[inline(always)]
fn at_the_edge(row: &[u8], from: usize) -> [u8; 3 * WIDTH] {
    let mut pixels = [0; 3 * WIDTH];
    let there = row.get(from..).unwrap_or_default();
    let (inside, outside) = pixels.split_at_mut(there.len().min(3 * WIDTH));
    inside.copy_from_slice(there);
    for (out, last) in outside.iter_mut().zip(row[row.len() - 3..].iter().cycle()) {
        *out = *last;
    }
    pixels
}

/// R, G, B to lightness less 128 and the differences of blue and red to it (JFIF 1.02, after ITU-R BT.601).
#[inline(always)]
fn separate(pixels: &[u8; 3 * WIDTH], [luminance, blue, red]: [&mut [f32; WIDTH]; 3]) {
    let mut channels = [[0; WIDTH]; 3];
    for x in 0..WIDTH {
        channels[0][x] = pixels[3 * x];
        channels[1][x] = pixels[3 * x + 1];
        channels[2][x] = pixels[3 * x + 2];
    }
    for x in 0..WIDTH {
        let (r, g, b) = (f32::from(channels[0][x]), f32::from(channels[1][x]), f32::from(channels[2][x]));
        luminance[x] = 0.299 * r + 0.587 * g + 0.114 * b - 128.0;
        blue[x] = 0.5 * b - 0.168_735_89 * r - 0.331_264_1 * g;
        red[x] = 0.5 * r - 0.418_687_6 * g - 0.081_312_41 * b;
    }
}
