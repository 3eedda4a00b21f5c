//! How many pixels of a picture are how bright, and how many are at an end.

use darkroot_photo::{Picture, Samples};
use serde::Serialize;

/// Bins of a histogram.
const BINS: usize = 128;

/// Pixels of a view by value, for each channel.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Tally {
    /// Red, green and blue: heights of the bins, the highest of all inner ones is 255.
    bins: [Vec<u8>; 3],
    /// Share of pixels whose red, green, blue is black, 0 to 1.
    black: [f64; 3],
    /// Share of pixels whose red, green, blue is white, 0 to 1.
    white: [f64; 3],
}

/// Counts a picture of 8 bits; one of others has been made into it before.
pub(crate) fn tally(picture: &Picture) -> Option<Tally> {
    let Samples::U8(samples) = &picture.samples else { return None };
    let mut counts = [[0u64; 256]; 3];
    for rgb in samples.chunks_exact(3) {
        for c in 0..3 {
            counts[c][usize::from(rgb[c])] += 1;
        }
    }
    let width = 256 / BINS;
    let sums = counts.map(|of| of.chunks(width).map(|bin| bin.iter().sum::<u64>()).collect::<Vec<_>>());
    // What is at an end would else press everything flat.
    let highest = sums.iter().flat_map(|of| &of[1..BINS - 1]).copied().max().unwrap_or(0).max(1);
    let share = |count: u64| count as f64 / picture.size.area().max(1) as f64;
    Some(Tally {
        bins: sums.map(|of| of.iter().map(|&n| (n.min(highest) * 255 / highest) as u8).collect()),
        black: [0, 1, 2].map(|c| share(counts[c][0])),
        white: [0, 1, 2].map(|c| share(counts[c][255])),
    })
}

#[cfg(test)]
mod tests {
    use darkroot_colour::RgbSpace;
    use darkroot_photo::{PictureSpace, Size};

    use super::*;

    #[test]
    fn pixels_are_counted_by_value_and_at_the_ends() {
        let samples = [[0, 255, 100], [0, 255, 101], [50, 100, 100], [51, 0, 102]].concat();
        let size = Size { width: 2, height: 2 };
        let picture =
            Picture { size, samples: Samples::U8(samples), space: PictureSpace::Rgb(RgbSpace::SRGB) };
        let told = tally(&picture).unwrap();
        assert_eq!(told.bins[0][25], 170, "two of three at the highest");
        assert_eq!((told.bins[2][50], told.bins[2][51]), (255, 85));
        assert_eq!((told.black, told.white), ([0.5, 0.25, 0.0], [0.0, 0.5, 0.0]));
    }
}
