//! Banding: rows or columns of a picture that are lighter or darker than those beside them, as the streaks of line scanners and
//! the readout of sensors make them.
//!
//! A band is told from noise by the two halves of each line: noise is another in each half, a band is the same. So the covariance
//! of the halves is the variance of the bands, without any part of the noise. Slow changes from line to line are those of the
//! light and are taken off.

use darkroot_colour::{Xyz, white};
use darkroot_photo::{Layout, Mosaic};
use rayon::prelude::*;

/// Lines on each side over which slow changes are followed.
const REACH: usize = 24;
/// Fewest lines that tell, and fewest pixels in one.
const FEWEST: usize = 4 * REACH;
/// Standard errors from which bands are certain.
const CERTAIN: f64 = 3.0;
/// Share of the picture's width and height at each edge that is not looked at.
const MARGIN: f64 = 0.05;

/// Bands along one direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bands {
    /// Standard deviation of L\* from line to line, without noise; 0 where none is certain.
    pub deviation: f64,
    /// The line that is most off, in L\*, and which it is; `None` where bands are not certain.
    pub worst: Option<(f64, usize)>,
    /// What could not have been told from noise, L\*: a deviation of three standard errors.
    pub noise: f64,
}

/// Bands of a picture of an even surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Banding {
    /// Rows.
    pub rows: Bands,
    /// Columns.
    pub columns: Bands,
}

impl Banding {
    /// The larger deviation of both directions, L\*.
    pub fn deviation(&self) -> f64 {
        self.rows.deviation.max(self.columns.deviation)
    }
}

/// Bands of a picture of an even surface in linear light; `luminance` is how much red, green and blue count in Y. `None` for a
/// picture that is too small to tell.
pub fn banding(light: &Mosaic<f32>, luminance: [f64; 3]) -> Option<Banding> {
    if !matches!(light.layout, Layout::Rgb) {
        return None;
    }
    let cut = |length: usize| {
        let margin = (MARGIN * length as f64) as usize;
        margin..length.saturating_sub(margin)
    };
    let (columns, rows) = (cut(light.size.width), cut(light.size.height));
    if columns.len() < FEWEST || rows.len() < FEWEST {
        return None;
    }
    let y = |x: usize, y: usize| {
        let first = 3 * (y * light.size.width + x);
        (0..3).map(|c| luminance[c] * f64::from(light.samples[first + c])).sum::<f64>()
    };
    let halves = |range: &std::ops::Range<usize>| {
        let middle = range.start + range.len() / 2;
        [range.start..middle, middle..range.end]
    };
    let lightness = |sum: f64, count: usize| {
        let y = sum / count as f64;
        Xyz::new(y, y, y).lab(white::D50).l
    };
    let by_rows: Vec<[f64; 2]> = rows
        .clone()
        .into_par_iter()
        .map(|row| halves(&columns).map(|half| lightness(half.clone().map(|x| y(x, row)).sum(), half.len())))
        .collect();
    let by_columns: Vec<[f64; 2]> = columns
        .clone()
        .into_par_iter()
        .map(|column| {
            halves(&rows).map(|half| lightness(half.clone().map(|r| y(column, r)).sum(), half.len()))
        })
        .collect();
    Some(Banding { rows: bands(&by_rows, rows.start), columns: bands(&by_columns, columns.start) })
}

/// Bands of lines, each by the L\* of its two halves; `first` is the number of the first line.
fn bands(lines: &[[f64; 2]], first: usize) -> Bands {
    let halves = [0, 1].map(|half| quick(&lines.iter().map(|line| line[half]).collect::<Vec<_>>()));
    let count = lines.len() as f64;
    let mean = |of: &dyn Fn(usize) -> f64| (0..lines.len()).map(of).sum::<f64>() / count;
    let shared = mean(&|i| halves[0][i] * halves[1][i]);
    let [one, other] = [0, 1].map(|half| mean(&|i| halves[half][i].powi(2)));
    // Standard error of a covariance of independent values; bands in both would only make it larger.
    let error = (one * other / count).sqrt();
    let certain = shared > CERTAIN * error;
    let off = |i: usize| (halves[0][i] + halves[1][i]) / 2.0;
    let worst = (0..lines.len()).max_by(|a, b| off(*a).abs().total_cmp(&off(*b).abs()));
    Bands {
        deviation: if certain { shared.sqrt() } else { 0.0 },
        worst: worst.filter(|_| certain).map(|i| (off(i), first + i)),
        noise: (CERTAIN * error).sqrt(),
    }
}

/// What is left of values without their slow changes: each less the parabola through those around it (Savitzky and Golay, 1964).
fn quick(values: &[f64]) -> Vec<f64> {
    let without = |i: usize| {
        // At the ends the window stays whole, so that light that falls off leaves nothing there either.
        let last = values.len().saturating_sub(2 * REACH + 1);
        let start = i.saturating_sub(REACH).min(last);
        let window = &values[start..(start + 2 * REACH + 1).min(values.len())];
        let count = window.len() as f64;
        let place = |k: usize| k as f64 - (count - 1.0) / 2.0;
        let spread = (0..window.len()).map(|k| place(k).powi(2)).sum::<f64>() / count;
        // Three polynomials that are orthogonal over the window.
        let basis: [&dyn Fn(usize) -> f64; 3] = [&|_| 1.0, &place, &|k| place(k).powi(2) - spread];
        let through: f64 = basis
            .iter()
            .map(|of| {
                let product: f64 = window.iter().enumerate().map(|(k, v)| of(k) * v).sum();
                let squares: f64 = (0..window.len()).map(|k| of(k).powi(2)).sum();
                of(i - start) * product / squares
            })
            .sum();
        values[i] - through
    };
    (0..values.len()).map(without).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use darkroot_colour::Spectrum;
    use darkroot_photo::{Counts, Size};
    use darkroot_simulate::{Camera, Exposure, Scene, expose::expose};

    const SIZE: Size = Size { width: 600, height: 400 };

    /// A shot of an even surface with noise, by a camera with a pixel for each colour, and light that falls off; `gain` is what
    /// is done to a place.
    fn shot(gain: impl Fn(usize, usize) -> f64) -> Mosaic<f32> {
        let camera = Camera { layout: Layout::Rgb, crop: 0, ..Camera::simulated_one() };
        let exposure = Exposure { noise: Some(3), falloff: 0.1, ..Exposure::default() };
        let capture = expose(&Scene::flat(SIZE, Spectrum::constant(0.4)), &camera, &exposure);
        let Counts::U16(counts) = capture.counts else { panic!("whole numbers") };
        let of = |(i, count): (usize, &u16)| {
            let place = i / 3;
            let light = (f64::from(*count) - 512.0) / (15_892.0 - 512.0);
            (light * gain(place % SIZE.width, place / SIZE.width)) as f32
        };
        let samples = counts.samples.iter().enumerate().map(of).collect();
        Mosaic { size: SIZE, layout: Layout::Rgb, samples }
    }

    #[test]
    fn an_even_shot_has_no_bands_whatever_its_noise_and_its_falloff() {
        let found = banding(&shot(|_, _| 1.0), [0.2, 0.7, 0.1]).unwrap();
        assert!(found.deviation() < 1e-9 && found.rows.worst.is_none(), "{found:?}");
        assert!(found.rows.noise < 0.01 && found.columns.noise < 0.01, "{found:?}");
    }

    #[test]
    fn streaks_of_a_line_scanner_are_told_by_how_much_and_which_is_the_worst() {
        // Each column has a gain of its own, by 0.5 % as a standard deviation; one has 2 % less.
        let gain = |x: usize| {
            let spread = ((x * 7919) % 101) as f64 / 101.0 - 0.5;
            if x == 333 { 0.98 } else { 1.0 + 0.005 * 12f64.sqrt() * spread }
        };
        let picture = shot(|x, _| gain(x));
        let found = banding(&picture, [0.2, 0.7, 0.1]).unwrap();
        let y: f64 = picture.samples.chunks(3).map(|p| f64::from(0.2 * p[0] + 0.7 * p[1] + 0.1 * p[2])).sum();
        let y = y / SIZE.area() as f64;
        // dL* = 116 / 3 Y^(1/3) dY / Y.
        let slope = 116.0 / 3.0 * y.cbrt();
        let truth = 0.005 * slope;
        assert!((found.columns.deviation / truth - 1.0).abs() < 0.1, "{found:?} {truth}");
        let (off, which) = found.columns.worst.unwrap();
        assert!(which == 333 && (off / (-0.02 * slope) - 1.0).abs() < 0.1, "{found:?} {slope}");
        assert!(found.rows.deviation < 1e-9, "{found:?}");
    }

    #[test]
    fn weak_bands_of_rows_are_found_below_the_noise_of_a_pixel() {
        let found = banding(&shot(|_, y| if y % 8 < 4 { 1.001 } else { 0.999 }), [0.2, 0.7, 0.1]).unwrap();
        assert!(found.rows.deviation > 0.01 && found.columns.deviation < 1e-9, "{found:?}");
    }

    #[test]
    fn a_small_picture_tells_nothing() {
        let size = Size { width: 80, height: 80 };
        let light = Mosaic { size, layout: Layout::Rgb, samples: vec![0.5; 3 * size.area()] };
        assert_eq!(banding(&light, [0.2, 0.7, 0.1]), None);
    }
}
