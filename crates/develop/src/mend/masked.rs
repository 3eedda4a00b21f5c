//! Banding as the columns show it that no light reaches, left of the picture.

use darkroot_photo::Capture;
use rayon::prelude::*;

use super::banding::{CERTAIN, ROWS, TALL, less_line, tops};
use crate::light::LinearLight;

/// Columns at both ends of the masked ones that are not looked at: light leaks in, and readout settles.
const EDGE: usize = 8;
/// Fewest others.
const FEWEST: usize = 16;
/// By how much offsets in the picture may differ from those beside it, and in standard errors how certain that is.
const SHARED: std::ops::Range<f64> = 0.6..1.4;
const SHARED_BY: f64 = 5.0;

/// Offsets of rows and their variance, where masked columns show them for certain and the picture has them too. `shown` is what
/// the picture shows of each row, and how uncertain that is: a scene mixes with it, but knows nothing of masked columns.
pub(super) fn offsets(
    capture: &Capture,
    light: &LinearLight,
    shown: &[Option<(f64, f64)>],
) -> Option<(Vec<f32>, f64)> {
    let area = capture.active_area;
    let columns = area.x.saturating_sub(2 * EDGE) / 4 * 4;
    if columns < FEWEST || shown.len() < ROWS {
        return None;
    }
    // Two means of each row, of columns that lie among each other; pairs of columns have both of its colours.
    let of_band = |top: &usize| {
        let (mut one, mut other) = ([0f32; ROWS], [0f32; ROWS]);
        let mut row = vec![0f32; columns];
        for (y, (one, other)) in one.iter_mut().zip(&mut other).enumerate() {
            light.levelled(&capture.counts, EDGE, area.y + top + y, &mut row);
            for four in row.chunks_exact(4) {
                *one += four[0] + four[1];
                *other += four[2] + four[3];
            }
        }
        let less = |sums: [f32; ROWS]| {
            let of =
                |first: usize| less_line(std::array::from_fn(|i| 2.0 * sums[2 * i + first] / columns as f32));
            let parts: [[f32; TALL]; 2] = [of(0), of(1)];
            std::array::from_fn::<f64, ROWS, _>(|y| f64::from(parts[y % 2][y / 2]))
        };
        let [one, other] = [one, other].map(less);
        std::array::from_fn::<_, ROWS, _>(|y| (one[y], other[y]))
    };
    let tops = tops(shown.len());
    let mut halves = vec![(0.0, 0.0); shown.len()];
    for (top, band) in tops.iter().zip(tops.par_iter().map(of_band).collect::<Vec<_>>()) {
        halves[*top..top + ROWS].copy_from_slice(&band);
    }
    let count = halves.len() as f64;
    let product = halves.iter().map(|(a, b)| a * b).sum::<f64>() / count;
    // Of each half.
    let noise = halves.iter().map(|(a, b)| 0.5 * (a - b).powi(2)).sum::<f64>() / count;
    if product <= CERTAIN * noise / count.sqrt() {
        return None;
    }
    let means: Vec<f64> = halves.iter().map(|(a, b)| 0.5 * (a + b)).collect();
    // What the picture shows, against what it should.
    let pairs =
        || means.iter().zip(shown).filter_map(|(mean, shown)| Some(mean * shown.as_ref()?.0 / product));
    let rows = pairs().count().max(1) as f64;
    let share = pairs().sum::<f64>() / rows;
    let error = (pairs().map(|v| (v - share).powi(2)).sum::<f64>() / rows / rows).sqrt();
    if !SHARED.contains(&share) || share < SHARED_BY * error {
        return None;
    }
    let certain = product / (product + 0.5 * noise);
    Some((means.iter().map(|mean| (certain * mean) as f32).collect(), product))
}
