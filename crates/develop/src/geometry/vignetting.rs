//! Light that the lens lost towards the edges, as the lensfun database knows it or the maker's note says.

use darkroot_colour::simd::vectorised;
use darkroot_lens::Corrections;
use darkroot_photo::{CameraSpace, Radial, Rgb};

/// What is known of it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Vignetting {
    /// By the database.
    Measured(Corrections),
    /// By the maker's note.
    Told {
        /// By what light is multiplied.
        gain: Radial,
        /// Half the diagonal of what the maker shows, pixels.
        reach: f64,
    },
}

impl Vignetting {
    /// By what light is multiplied at a place, in pixels from the optical centre.
    fn gain(&self, x: f64, y: f64) -> f64 {
        match self {
            Self::Measured(corrections) => corrections.gain(x, y),
            Self::Told { gain, reach } => gain.at(x.hypot(y) / reach),
        }
    }
}

/// Columns from one gain that is computed to the next; between them gains are interpolated.
const STEP: usize = 8;

/// Makes good what is missing in a part of the picture as taken. Its first pixel's middle lies at `first`, in columns and
/// rows of the frame from the optical centre, and each next one `bin` columns or rows on.
pub(crate) fn brighten(picture: &mut Rgb<CameraSpace>, lens: &Vignetting, first: [f64; 2], bin: usize) {
    let size = picture.size();
    let mut gains = vec![0f32; size.width.next_multiple_of(STEP)];
    for y in 0..size.height {
        let row = first[1] + (y * bin) as f64;
        let at = |x: usize| lens.gain(first[0] + (x * bin) as f64, row) as f32;
        let mut left = at(0);
        for (run, gains) in gains.chunks_exact_mut(STEP).enumerate() {
            let right = at((run + 1) * STEP);
            for (i, gain) in gains.iter_mut().enumerate() {
                *gain = left + (right - left) * (i as f32 / STEP as f32);
            }
            left = right;
        }
        for plane in picture.planes_mut() {
            let row = &mut plane[y * size.width..][..size.width];
            vectorised(
                #[inline(always)]
                || row.iter_mut().zip(&gains).for_each(|(v, gain)| *v *= gain),
            );
        }
    }
}
