//! The method of `lmmse` written down pixel by pixel in double precision: what the fast one is tested against.

use darkroot_photo::{CameraSpace, Cfa, Filter, Mosaic, Rgb, Size};

use super::lmmse;

const HALF: isize = 4;
const LOW_PASS: [f64; 9] = [4.0, 9.0, 15.0, 23.0, 26.0, 23.0, 15.0, 9.0, 4.0];

/// A step along the row or along the column.
type Step = (isize, isize);
const ALONG: Step = (1, 0);
const DOWN: Step = (0, 1);

struct Slow<'a> {
    mosaic: &'a Mosaic<f32>,
    cfa: &'a Cfa,
}

impl Slow<'_> {
    fn filter(&self, (x, y): (isize, isize)) -> Filter {
        self.cfa.at(x as usize, y as usize)
    }

    fn root(&self, (x, y): (isize, isize)) -> f64 {
        let v = f64::from(self.mosaic.samples[y as usize * self.mosaic.size.width + x as usize]);
        v.abs().sqrt().copysign(v)
    }

    /// Green less the other colour of the line.
    fn difference(&self, at: (isize, isize), step: Step) -> f64 {
        let s = |k: isize| self.root(far(at, step, k));
        let estimate = 0.5 * (s(-1) + s(1)) + 0.1875 * (2.0 * s(0) - s(-2) - s(2)) - s(0);
        if self.filter(at) == Filter::Green { -estimate } else { estimate }
    }

    fn low(&self, at: (isize, isize), step: Step) -> f64 {
        let tap = |k: usize| LOW_PASS[k] / 128.0 * self.difference(far(at, step, k as isize - HALF), step);
        (0..9).map(tap).sum()
    }

    /// Equations 8 to 12 of the paper: estimate and its error.
    fn estimate(&self, at: (isize, isize), step: Step) -> (f64, f64) {
        let places: Vec<(isize, isize)> = (-HALF..=HALF).map(|k| far(at, step, k)).collect();
        let low: Vec<f64> = places.iter().map(|at| self.low(*at, step)).collect();
        let signal: Vec<f64> = places.iter().map(|at| self.difference(*at, step)).collect();
        let mean = low.iter().sum::<f64>() / 9.0;
        let own: f64 = low.iter().map(|low| (low - mean).powi(2)).sum();
        let noise: f64 = low.iter().zip(&signal).map(|(low, signal)| (low - signal).powi(2)).sum();
        let gain = own / (own + noise + 1e-30);
        (mean + gain * (signal[4] - mean), gain * noise)
    }

    /// Green less the colour of a red or blue site.
    fn joined(&self, at: (isize, isize)) -> f64 {
        let ((x_h, e_h), (x_v, e_v)) = (self.estimate(at, ALONG), self.estimate(at, DOWN));
        let joined = ((e_v + 1e-30) * x_h + (e_h + 1e-30) * x_v) / (e_h + e_v + 2e-30);
        let greens = [(-1, 0), (1, 0), (0, -1), (0, 1)].map(|step| self.root(far(at, step, 1)));
        let (low, high) =
            (greens.into_iter().fold(f64::MAX, f64::min), greens.into_iter().fold(f64::MIN, f64::max));
        let own = self.root(at);
        (own + joined).clamp(low - (high - low), high + (high - low)) - own
    }

    /// Roots of red, green and blue.
    fn colours(&self, at: (isize, isize)) -> [f64; 3] {
        let own = self.root(at);
        let mean = |steps: &[Step]| {
            steps.iter().map(|step| self.joined(far(at, *step, 1))).sum::<f64>() / steps.len() as f64
        };
        match self.filter(at) {
            Filter::Green => {
                let (row, column) = (mean(&[(-1, 0), (1, 0)]), mean(&[(0, -1), (0, 1)]));
                let red_row = self.filter(far(at, ALONG, 1)) == Filter::Red;
                let (red, blue) = if red_row { (row, column) } else { (column, row) };
                [own - red, own, own - blue]
            }
            filter => {
                let green = own + self.joined(at);
                let other = green - mean(&[(-1, -1), (1, -1), (-1, 1), (1, 1)]);
                if filter == Filter::Red { [own, green, other] } else { [other, green, own] }
            }
        }
    }
}

fn far((x, y): (isize, isize), (dx, dy): Step, k: isize) -> (isize, isize) {
    (x + k * dx, y + k * dy)
}

#[test]
fn the_fast_method_is_the_slow_one() {
    let mut state = 7u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f32 / (1u64 << 24) as f32
    };
    for (letters, width, height, more) in
        [("RGGB", 17, 9, 0), ("GRBG", 16, 8, 3), ("GBRG", 9, 12, 2), ("BGGR", 12, 7, 5), ("RGGB", 1, 1, 1)]
    {
        let cfa = Cfa::parse(letters).unwrap();
        let border = lmmse::BORDER + more;
        let size = Size { width: width + 2 * border, height: height + 2 * border };
        // Edges, colours and noise, some of it below black.
        let sample = |i: usize| {
            let (x, y) = (i % size.width, i / size.width);
            let edge = if (x + 2 * y) / 9 % 2 == 0 { 0.8 } else { 0.05 };
            edge * [1.0, 0.7, 0.4][cfa.at(x, y).plane().unwrap()] + 0.1 * (random() - 0.5)
        };
        let samples = (0..size.area()).map(sample).collect();
        let mosaic = Mosaic { size, layout: darkroot_photo::Layout::Cfa(cfa.clone()), samples };
        let mut fast = Rgb::<CameraSpace>::black(Size { width, height });
        lmmse::demosaic(&mosaic, &cfa, border, &mut fast);
        let slow = Slow { mosaic: &mosaic, cfa: &cfa };
        for y in 0..height {
            for x in 0..width {
                let wanted = slow.colours(((x + border) as isize, (y + border) as isize));
                for (found, root) in fast.at(x, y).into_iter().zip(wanted) {
                    let wanted = root * root.abs();
                    assert!((f64::from(found) - wanted).abs() < 1e-5, "{letters} {x} {y}: {found} {wanted}");
                }
            }
        }
    }
}
