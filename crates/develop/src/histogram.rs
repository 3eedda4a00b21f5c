//! How the light of a frame is spread, and how much of it is clipped: for people who look at a file.

use darkroot_photo::{Capture, Layout, Rect};
use rayon::prelude::*;

use crate::highlights::CLIPPED;
use crate::light::{LinearLight, channels};
use crate::saturation::NO_CHANNEL;

/// Bins of a histogram; bin i holds light from (i / BINS)^2 to ((i + 1) / BINS)^2 of saturation.
pub const BINS: usize = 64;

/// Rows that one task looks at.
const ROWS: usize = 64;

/// The light of a frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Histogram {
    /// Number of samples by square root of light, for red, green and blue.
    pub bins: [[u64; BINS]; 3],
    /// Share of clipped samples of each channel, 0..=1.
    pub clipped: [f64; 3],
}

/// Counts the samples of the active area. `saturation` is the light at which each channel clips, before the file's
/// corrections.
pub fn histogram(capture: &Capture, linear: &LinearLight, saturation: [f32; 3]) -> Histogram {
    let area = capture.active_area;
    let layout = capture.counts.layout();
    let limits = saturation.map(|s| CLIPPED * s);
    let count = |rows: Rect| {
        let (mut bins, mut clipped) = ([[0u64; BINS]; 3], [0u64; 3]);
        let mut light = vec![0f32; area.width * layout.planes()];
        for y in rows.y..rows.bottom() {
            linear.levelled(&capture.counts, area.x, y, &mut light);
            let channels = channels(layout, area.x, y, NO_CHANNEL);
            for (&v, &c) in light.iter().zip(channels.iter().cycle()) {
                if c != NO_CHANNEL {
                    clipped[c] += u64::from(v >= limits[c]);
                }
            }
            linear.correct(area.x, y, &mut light);
            for (&v, &c) in light.iter().zip(channels.iter().cycle()) {
                if let Some(bins) = bins.get_mut(c) {
                    let bin = (v.clamp(0.0, 1.0).sqrt() * BINS as f32) as usize;
                    bins[bin.min(BINS - 1)] += 1;
                }
            }
        }
        (bins, clipped)
    };
    let parts: Vec<_> = (area.y..area.bottom())
        .into_par_iter()
        .step_by(ROWS)
        .map(|y| count(Rect { y, height: ROWS.min(area.bottom() - y), ..area }))
        .collect();
    let (mut bins, mut clipped) = ([[0u64; BINS]; 3], [0u64; 3]);
    for (part, of_part) in parts {
        for (sum, n) in bins.iter_mut().flatten().zip(part.iter().flatten()) {
            *sum += n;
        }
        clipped = [0, 1, 2].map(|c| clipped[c] + of_part[c]);
    }
    if *layout == Layout::Monochrome {
        (bins, clipped) = ([bins[0]; 3], [clipped[0]; 3]);
    }
    let total = |c: usize| bins[c].iter().sum::<u64>().max(1) as f64;
    Histogram { bins, clipped: [0, 1, 2].map(|c| clipped[c] as f64 / total(c)) }
}
