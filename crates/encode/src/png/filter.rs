//! The filters of PNG (PNG 1.2, 6): bytes as differences to bytes that a reader has already.

use darkroot_colour::simd::vectorised;

use crate::Sample;

/// Bytes of the rows of a band, each behind its filter: the one whose differences are smallest. The first row has only those
/// that look to the left, as the row above is another band's.
pub(super) fn band<T: Sample>(samples: &[T], width: usize) -> Vec<u8> {
    let length = 3 * width * usize::from(T::BITS / 8);
    let pixel = 3 * usize::from(T::BITS / 8);
    let mut out = Vec::with_capacity(samples.len() / (3 * width) * (length + 1));
    let (mut above, mut row) = (Vec::new(), Vec::new());
    let mut tried = vec![0; length];
    let mut best = vec![0; length];
    for samples in samples.chunks_exact(3 * width) {
        row.clear();
        T::put_big_endian(samples, &mut row);
        let filters: &[Filter] = if above.is_empty() { &[Filter::None, Filter::Sub] } else { &Filter::ALL };
        let mut least = u64::MAX;
        let mut chosen = Filter::None;
        for &filter in filters {
            let sum = filter.apply(&row, &above, pixel, &mut tried);
            if sum < least {
                (least, chosen) = (sum, filter);
                std::mem::swap(&mut best, &mut tried);
            }
        }
        out.push(chosen as u8);
        out.extend_from_slice(&best);
        std::mem::swap(&mut above, &mut row);
    }
    out
}

/// What a byte is stored less.
#[derive(Clone, Copy)]
enum Filter {
    None = 0,
    /// The byte of the pixel to the left.
    Sub = 1,
    /// The byte above.
    Up = 2,
    /// The mean of both.
    Average = 3,
    /// That of left, above and above left that is nearest to left + above - above left.
    Paeth = 4,
}

impl Filter {
    const ALL: [Self; 5] = [Self::None, Self::Sub, Self::Up, Self::Average, Self::Paeth];

    /// Filters a row of which a pixel has so many bytes; the sum of the differences' sizes.
    fn apply(self, row: &[u8], above: &[u8], pixel: usize, out: &mut [u8]) -> u64 {
        // Left of the first pixel all is 0.
        let (first, rest) = out.split_at_mut(pixel);
        let (up_first, up) = above.split_at(pixel.min(above.len()));
        let (now, left) = (&row[pixel..], &row[..row.len() - pixel]);
        let corner = &above[..above.len().saturating_sub(pixel)];
        for (i, out) in first.iter_mut().enumerate() {
            let up = up_first.get(i).copied().unwrap_or(0);
            *out = row[i].wrapping_sub(self.predicted(0, up, 0));
        }
        vectorised(
            #[inline(always)]
            || match self {
                Self::None => rest.copy_from_slice(now),
                Self::Sub => {
                    for ((out, now), left) in rest.iter_mut().zip(now).zip(left) {
                        *out = now.wrapping_sub(*left);
                    }
                }
                Self::Up => {
                    for ((out, now), up) in rest.iter_mut().zip(now).zip(up) {
                        *out = now.wrapping_sub(*up);
                    }
                }
                Self::Average | Self::Paeth => {
                    for ((((out, now), left), up), corner) in
                        rest.iter_mut().zip(now).zip(left).zip(up).zip(corner)
                    {
                        *out = now.wrapping_sub(self.predicted(*left, *up, *corner));
                    }
                }
            },
        );
        out.iter().map(|&byte| u64::from((byte as i8).unsigned_abs())).sum()
    }

    #[inline(always)]
    fn predicted(self, left: u8, up: u8, corner: u8) -> u8 {
        match self {
            Self::None => 0,
            Self::Sub => left,
            Self::Up => up,
            Self::Average => ((u16::from(left) + u16::from(up)) / 2) as u8,
            Self::Paeth => {
                let [a, b, c] = [left, up, corner].map(i16::from);
                // Distances of a + b - c to each.
                let (to_left, to_up, to_corner) = ((b - c).abs(), (a - c).abs(), (a + b - 2 * c).abs());
                if to_left <= to_up && to_left <= to_corner {
                    left
                } else if to_up <= to_corner {
                    up
                } else {
                    corner
                }
            }
        }
    }
}
