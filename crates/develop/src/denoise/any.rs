//! Noise under filter arrays other than Bayer's, such as X-Trans: each colour by itself, at one scale.
//!
//! A stabilised sample is parted into the mean of the samples of its colour around it and its departure from that. The
//! departure is shrunk by the power of those of all colours around it: structure shows in all of them.

use darkroot_photo::{Cfa, Rect};

use super::bayer::Scratch;
use super::rows::{Source, hat, hat_along};
use super::shrink::{removed, threshold};
use super::stabilise::Stabiliser;

/// Rows and columns around a sample that its mean is taken of.
const REACH: isize = 3;
/// Of these, the weights; the same along columns.
const WEIGHTS: [f32; 4] = [20.0, 15.0, 6.0, 1.0];
/// Rows and columns around a departure whose power counts.
const AROUND: isize = 2;
/// Pixels around the result that are looked at.
const BORDER: isize = REACH + AROUND;
/// Largest period of an array.
const LARGEST: usize = 8;

/// A place of the array.
#[derive(Debug, Clone)]
pub(super) struct Place {
    pub(super) channel: usize,
    /// Samples of its colour around it, itself among them, with weights whose sum is 1.
    taps: Vec<(isize, isize, f32)>,
    /// Variance of the mean, and of the departure from it, in white noise of variance 1.
    mean: f32,
    departure: f32,
}

/// An array, from the active area's corner on.
#[derive(Debug, Clone)]
pub(super) struct Array {
    pub(super) period: (usize, usize),
    pub(super) places: Vec<Place>,
}

impl Array {
    /// `None` for arrays of Bayer, with other colours than red, green and blue, or that hardly repeat.
    pub(super) fn of(cfa: &Cfa) -> Option<Self> {
        let (width, height) = (cfa.width(), cfa.height());
        if cfa.is_bayer() || !cfa.is_rgb() || width.max(height) > LARGEST {
            return None;
        }
        let place = |i: usize| {
            let (x, y) = ((i % width) as isize, (i / width) as isize);
            let at = |dx: isize, dy: isize| {
                let inside = |at: isize, period: usize| at.rem_euclid(period as isize) as usize;
                cfa.at(inside(x + dx, width), inside(y + dy, height))
            };
            let all = (-REACH..=REACH).flat_map(|dy| (-REACH..=REACH).map(move |dx| (dx, dy)));
            let weight = |d: isize| WEIGHTS[d.unsigned_abs()];
            let mut taps: Vec<(isize, isize, f32)> = all
                .filter(|(dx, dy)| at(*dx, *dy) == at(0, 0))
                .map(|(dx, dy)| (dx, dy, weight(dx) * weight(dy)))
                .collect();
            let sum: f32 = taps.iter().map(|tap| tap.2).sum();
            taps.iter_mut().for_each(|tap| tap.2 /= sum);
            let mean: f32 = taps.iter().map(|tap| tap.2 * tap.2).sum();
            let own = WEIGHTS[0] * WEIGHTS[0] / sum;
            Place { channel: at(0, 0).plane().unwrap_or(1), taps, mean, departure: 1.0 - 2.0 * own + mean }
        };
        Some(Self { period: (width, height), places: (0..width * height).map(place).collect() })
    }

    /// Departures of samples from the mean around them, each divided by its standard deviation in noise of variance 1; the
    /// outermost three rows and columns are left as they are. The first sample lies in this column and row of the array.
    pub(super) fn departures(&self, samples: &[f32], width: usize, corner: (isize, isize), out: &mut [f32]) {
        let reach = REACH as usize;
        let rows = samples.len() / width;
        for y in reach..rows - reach {
            for first in 0..self.period.0.min(width - 2 * reach) {
                let x = reach + first;
                let place = self.place(x as isize + corner.0, y as isize + corner.1);
                let scale = 1.0 / place.departure.sqrt();
                for x in (x..width - reach).step_by(self.period.0) {
                    let centre = y * width + x;
                    let tap = |&(dx, dy, weight): &(isize, isize, f32)| {
                        weight * samples[centre.wrapping_add_signed(dy * width as isize + dx)]
                    };
                    out[centre] = scale * (samples[centre] - place.taps.iter().map(tap).sum::<f32>());
                }
            }
        }
    }

    fn place(&self, x: isize, y: isize) -> &Place {
        let inside = |at: isize, period: usize| at.rem_euclid(period as isize) as usize;
        &self.places[inside(y, self.period.1) * self.period.0 + inside(x, self.period.0)]
    }

    /// Share of the variance of a sample that is left when this share of its departure is taken away.
    fn left(place: &Place, removed: f32) -> f32 {
        // The mean and the departure depend on each other: together they have variance 1.
        let both = 1.0 - place.mean - place.departure;
        let kept = 1.0 - removed;
        place.mean + kept * both + kept * kept * place.departure
    }
}

/// The filter for one capture.
#[derive(Debug)]
pub(super) struct Filter {
    pub(super) array: Array,
    pub(super) stabilisers: [Stabiliser; 3],
    pub(super) limits: [f32; 3],
    pub(super) strength: f32,
}

impl Filter {
    /// The light of a rectangle of the frame without noise, into `scratch`.
    pub(super) fn denoise(&self, source: Source<'_>, rect: Rect, scratch: &mut Scratch) {
        let area = source.capture.active_area;
        let border = BORDER as usize;
        let (width, height) = (rect.width + 2 * border, rect.height + 2 * border);
        let corner = ((rect.x - area.x) as isize - BORDER, (rect.y - area.y) as isize - BORDER);
        let begin = (rect.x as isize - BORDER, rect.y as isize - BORDER);
        let mosaic = scratch.begin_at(begin, width, height);
        let mut roots = vec![0f32; width * height];
        for (y, (row, roots)) in mosaic.chunks_exact_mut(width).zip(roots.chunks_exact_mut(width)).enumerate()
        {
            source.row(corner.0, corner.1 + y as isize, row);
            for (x, (root, v)) in roots.iter_mut().zip(row).enumerate() {
                let place = self.array.place(corner.0 + x as isize, corner.1 + y as isize);
                *root = self.stabilisers[place.channel].root(*v);
            }
        }
        let mut departures = vec![0f32; width * height];
        self.array.departures(&roots, width, corner, &mut departures);
        let power: Vec<f32> = departures.iter().map(|d| d * d).collect();
        let row = |y: usize| &power[y * width..][..width];
        let (mut down, mut line) = (vec![0f32; width], vec![0f32; width]);
        let mut narrow = vec![0f32; width * height];
        for (y, out) in narrow.chunks_exact_mut(width).enumerate().take(height - 1).skip(1) {
            hat(row(y - 1), row(y), row(y + 1), &mut down);
            hat_along(&down, 1, out);
        }
        let narrow_row = |y: usize| &narrow[y * width..][..width];
        let threshold = threshold(1.0, self.strength);
        for y in border..height - border {
            hat(narrow_row(y - 1), narrow_row(y), narrow_row(y + 1), &mut down);
            hat_along(&down, 1, &mut line);
            for (x, power) in line.iter().enumerate().take(width - border).skip(border) {
                let at = y * width + x;
                let place = self.array.place(corner.0 + x as isize, corner.1 + y as isize);
                if mosaic[at] < self.limits[place.channel] {
                    let share = removed(threshold, *power);
                    let root = roots[at] - share * place.departure.sqrt() * departures[at];
                    let gone = 1.0 - Array::left(place, share);
                    mosaic[at] = self.stabilisers[place.channel].light(root, gone);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_of_the_variance_go_from_all_to_that_of_the_mean() {
        let array = Array::of(&Cfa::parse("GBGGRG RGRBGB GBGGRG GRGGBG BGBRGR GRGGBG").unwrap()).unwrap();
        for place in &array.places {
            assert!((Array::left(place, 0.0) - 1.0).abs() < 1e-6);
            assert!((Array::left(place, 1.0) - place.mean).abs() < 1e-6);
            assert!(place.mean < if place.channel == 1 { 0.13 } else { 0.3 }, "{place:?}");
            assert!((place.taps.iter().map(|tap| tap.2).sum::<f32>() - 1.0).abs() < 1e-6);
        }
        assert!(Array::of(&Cfa::parse("RGGB").unwrap()).is_none());
    }
}
