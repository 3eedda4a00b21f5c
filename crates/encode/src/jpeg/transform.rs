//! From pixels to quantised coefficients, eight blocks of 8 x 8 at once: every loop is over 64 floats, for the vectors of the
//! processor.

use super::tables::{Kind, ZIGZAG};

/// Blocks of 8 x 8 that lie side by side and are transformed together.
pub(super) const BLOCKS: usize = 8;
/// Their width in pixels.
pub(super) const WIDTH: usize = 8 * BLOCKS;

/// The samples of eight blocks, row by row, or their coefficients.
pub(super) type Samples = [[f32; WIDTH]; 8];

/// The quantised coefficients of eight blocks.
pub(super) struct Blocks {
    /// Rows of rising horizontal frequency, in which each block has eight of rising vertical frequency.
    coefficients: [[i16; WIDTH]; 8],
    /// Of each block: bit k tells whether coefficient k of the scan is not 0.
    occupied: [u64; BLOCKS],
}

/// Where coefficient k of the scan stands: its row, and its place among the eight of its block there.
const PLACES: [(u8, u8); 64] = {
    let mut places = [(0, 0); 64];
    let mut k = 0;
    while k < 64 {
        places[k] = (ZIGZAG[k] % 8, ZIGZAG[k] / 8);
        k += 1;
    }
    places
};

/// Eight bits that say which of a row's coefficients are not 0, to their bits in the order of the scan.
static SCAN_BITS: [[u64; 256]; 8] = {
    let mut table = [[0; 256]; 8];
    let mut k = 0;
    while k < 64 {
        let (row, place) = PLACES[k];
        let mut bits = 0;
        while bits < 256 {
            table[row as usize][bits] |= ((bits >> place & 1) as u64) << k;
            bits += 1;
        }
        k += 1;
    }
    table
};

impl Blocks {
    pub(super) const EMPTY: Self = Self { coefficients: [[0; WIDTH]; 8], occupied: [0; BLOCKS] };

    /// Which coefficients of a block are not 0: bit k is for the k-th of the scan.
    #[inline(always)]
    pub(super) fn occupied(&self, block: usize) -> u64 {
        self.occupied[block]
    }

    /// Coefficient k of the scan of a block, `k` less than 64.
    #[inline(always)]
    pub(super) fn coefficient(&self, block: usize, k: usize) -> i16 {
        let (row, place) = PLACES[k % 64];
        self.coefficients[usize::from(row % 8)][(8 * block + usize::from(place)) % WIDTH]
    }

    /// Looks which are not 0.
    #[inline(always)]
    fn look(&mut self) {
        self.occupied = [0; BLOCKS];
        for (row, scan_bits) in self.coefficients.iter().zip(&SCAN_BITS) {
            let mut bytes = [0u8; WIDTH];
            for x in 0..WIDTH {
                bytes[x] = u8::from(row[x] != 0);
            }
            for (occupied, eight) in self.occupied.iter_mut().zip(bytes.as_chunks::<8>().0) {
                // Moves bit 8 k to bit 56 + k.
                let bits = u64::from_le_bytes(*eight).wrapping_mul(0x0102_0408_1020_4080) >> 56;
                *occupied |= scan_bits[bits as usize];
            }
        }
    }
}

/// What coefficients are multiplied by, in the places that they have in [`Blocks`].
pub(super) struct Quantiser {
    factors: Samples,
}

impl Quantiser {
    /// For a quality of 1 to 100.
    pub(super) fn new(kind: Kind, quality: u8) -> Self {
        let steps = kind.steps(quality);
        // What `butterflies` leaves in coefficient k (Arai, Agui and Nakajima 1988).
        let scale = |k: usize| {
            if k == 0 { 1.0 } else { (k as f64 * std::f64::consts::PI / 16.0).cos() * 2f64.sqrt() }
        };
        let mut factors = [[0.0; WIDTH]; 8];
        for (x, row) in factors.iter_mut().enumerate() {
            for (lane, factor) in row.iter_mut().enumerate() {
                let y = lane % 8;
                *factor = (1.0 / (f64::from(steps[8 * y + x]) * 8.0 * scale(x) * scale(y))) as f32;
            }
        }
        Self { factors }
    }

    /// Transforms and quantises eight blocks of samples from -128 to 127, which it needs no longer.
    #[inline(always)]
    pub(super) fn quantise(&self, samples: &mut Samples, blocks: &mut Blocks) {
        butterflies(samples);
        let mut turned = [[0.0; WIDTH]; 8];
        for block in (0..WIDTH).step_by(8) {
            for y in 0..8 {
                for x in 0..8 {
                    turned[x][block + y] = samples[y][block + x];
                }
            }
        }
        butterflies(&mut turned);
        for ((out, values), factors) in blocks.coefficients.iter_mut().zip(&turned).zip(&self.factors) {
            for x in 0..WIDTH {
                // The limits change nothing, and let the compiler pack.
                out[x] = rounded(values[x] * factors[x]).clamp(i16::MIN.into(), i16::MAX.into()) as i16;
            }
        }
        blocks.look();
    }
}

/// The nearest integer of a number below 2^22, even where two are as near: adding 1.5 * 2^23 leaves it in the last bits.
#[inline(always)]
fn rounded(value: f32) -> i32 {
    const LIFT: f32 = 12_582_912.0;
    (value + LIFT).to_bits() as i32 - LIFT.to_bits() as i32
}

/// Discrete cosine transform of the columns (T.81, A.3.3), each coefficient a known factor too large (Arai, Agui and
/// Nakajima, A fast DCT-SQ scheme for images, Trans. IEICE E-71, 1988): 5 multiplications and 29 additions for 8 numbers.
#[inline(always)]
fn butterflies([a, b, c, d, e, f, g, h]: &mut Samples) {
    use std::f32::consts::FRAC_1_SQRT_2;
    // Of cos(k pi / 16) with k = 6; 2 less 6; 2 and 6.
    const C6: f32 = 0.382_683_43;
    const C2_LESS_6: f32 = 0.541_196_1;
    const C2_AND_6: f32 = 1.306_563;
    for x in 0..WIDTH {
        let (sum_0, sum_1, sum_2, sum_3) = (a[x] + h[x], b[x] + g[x], c[x] + f[x], d[x] + e[x]);
        let (off_0, off_1, off_2, off_3) = (a[x] - h[x], b[x] - g[x], c[x] - f[x], d[x] - e[x]);

        let (outer, inner) = (sum_0 + sum_3, sum_1 + sum_2);
        let (outer_off, inner_off) = (sum_0 - sum_3, sum_1 - sum_2);
        let turned = (inner_off + outer_off) * FRAC_1_SQRT_2;
        a[x] = outer + inner;
        e[x] = outer - inner;
        c[x] = outer_off + turned;
        g[x] = outer_off - turned;

        let (low, middle, high) = (off_3 + off_2, off_2 + off_1, off_1 + off_0);
        let both = (low - high) * C6;
        let low = low * C2_LESS_6 + both;
        let high = high * C2_AND_6 + both;
        let middle = middle * FRAC_1_SQRT_2;
        let (near, far) = (off_0 + middle, off_0 - middle);
        f[x] = far + low;
        d[x] = far - low;
        b[x] = near + high;
        h[x] = near - high;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The transform as the standard writes it (T.81, A.3.3).
    fn slow(samples: &Samples, block: usize, x: usize, y: usize) -> f64 {
        use std::f64::consts::PI;
        let c = |k: usize| if k == 0 { 0.5f64.sqrt() } else { 1.0 };
        let cos = |at: usize, k: usize| ((2 * at + 1) as f64 * k as f64 * PI / 16.0).cos();
        let mut sum = 0.0;
        for (row, samples) in samples.iter().enumerate() {
            for column in 0..8 {
                sum += f64::from(samples[8 * block + column]) * cos(column, x) * cos(row, y);
            }
        }
        sum * c(x) * c(y) / 4.0
    }

    #[test]
    fn coefficients_are_those_of_the_standard() {
        let mut samples = [[0.0; WIDTH]; 8];
        for (y, row) in samples.iter_mut().enumerate() {
            for (x, sample) in row.iter_mut().enumerate() {
                *sample = ((x * 7919 + y * 104_729 + x * x * y) % 256) as f32 - 128.0;
            }
        }
        // One block of each extreme.
        for row in &mut samples {
            row[..8].fill(-128.0);
            row[8..16].fill(127.0);
        }
        for (kind, quality) in [(Kind::Luminance, 100), (Kind::Luminance, 92), (Kind::Chrominance, 30)] {
            let mut blocks = Blocks::EMPTY;
            Quantiser::new(kind, quality).quantise(&mut samples.clone(), &mut blocks);
            let steps = kind.steps(quality);
            for b in 0..BLOCKS {
                for (k, &at) in ZIGZAG.iter().enumerate() {
                    let at = usize::from(at);
                    let exact = slow(&samples, b, at % 8, at / 8) / f64::from(steps[at]);
                    let found = f64::from(blocks.coefficient(b, k));
                    assert!((found - exact).abs() < 0.5 + 1e-3, "{b} {k}: {found} for {exact}");
                    assert_eq!(blocks.occupied(b) >> k & 1 == 1, blocks.coefficient(b, k) != 0);
                }
            }
        }
    }
}
