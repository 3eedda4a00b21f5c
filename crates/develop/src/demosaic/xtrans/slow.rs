//! The method in the plainest words, a pixel at a time in double precision: what the fast code is compared with.

use darkroot_photo::{Cfa, Layout, Mosaic, Rgb, Size};

use super::super::{signed_sqrt, signed_square};
use super::sites::{Each, MODELS, Site, phase, reached, site};
use super::{BORDER, HALF, TINY, WINDOW};

struct Slow<'a> {
    mosaic: &'a Mosaic<f32>,
    phase: (usize, usize),
    sites: Vec<Site>,
}

impl Slow<'_> {
    fn root(&self, x: usize, y: usize) -> f64 {
        f64::from(signed_sqrt(self.mosaic.samples[y * self.mosaic.size.width + x]))
    }

    fn site(&self, x: usize, y: usize) -> &Site {
        &self.sites[(y + self.phase.1) % 6 * 6 + (x + self.phase.0) % 6]
    }

    fn predicted(&self, x: usize, y: usize, weights: &[Each], model: usize) -> f64 {
        let around = reached().into_iter().zip(weights);
        around
            .map(|((dx, dy), w)| {
                f64::from(w[model]) * self.root(x.wrapping_add_signed(dx), y.wrapping_add_signed(dy))
            })
            .sum()
    }

    fn mean_square_error(&self, x: usize, y: usize, model: usize) -> f64 {
        let reach = HALF as isize;
        let mut sum = 0.0;
        for dy in -reach..=reach {
            for dx in -reach..=reach {
                let (x, y) = (x.wrapping_add_signed(dx), y.wrapping_add_signed(dy));
                let error = self.predicted(x, y, &self.site(x, y).error, model);
                let weight = |d: isize| f64::from(WINDOW[HALF - d.unsigned_abs()]);
                sum += weight(dx) * weight(dy) * error * error;
            }
        }
        sum
    }

    fn colours(&self, x: usize, y: usize) -> [f32; 3] {
        let errors: [f64; MODELS] = std::array::from_fn(|model| self.mean_square_error(x, y, model));
        let least = errors.iter().copied().fold(f64::INFINITY, f64::min);
        let shares = errors.map(|e| ((least + f64::from(TINY)) / (e + f64::from(TINY))).powi(8));
        let total: f64 = shares.iter().sum();
        let site = self.site(x, y);
        let mut colours = [0.0; 3];
        colours[site.own] = signed_square(self.root(x, y) as f32);
        for (i, weights) in site.missing.iter().enumerate() {
            let joined: f64 =
                (0..MODELS).map(|model| shares[model] / total * self.predicted(x, y, weights, model)).sum();
            colours[(site.own + 1 + i) % 3] = signed_square(joined as f32);
        }
        colours
    }
}

#[test]
fn the_fast_way_gives_the_same() {
    // Stripes and dots with noise, so that every model has its share somewhere; wider than a few groups of lanes.
    let size = Size { width: 131, height: 2 * BORDER + 7 };
    let light = |x: usize, y: usize| {
        let wave =
            (0.4 + 0.25 * ((x as f64) * 0.9 + (y as f64) * 0.5).sin()) * (1.0 + 0.3 * (y as f64 * 1.3).cos());
        let noise = ((x * 7919 + y * 104_729) % 1000) as f64 / 1000.0 - 0.5;
        (wave + 0.05 * noise) as f32
    };
    for begin in [(0, 0), (1, 2), (5, 4)] {
        let cfa = Cfa::parse("GBGGRG RGRBGB GBGGRG GRGGBG BGBRGR GRGGBG").unwrap().shifted(begin.0, begin.1);
        let samples = (0..size.area()).map(|i| light(i % size.width, i / size.width)).collect();
        let mosaic = Mosaic { size, layout: Layout::Cfa(cfa.clone()), samples };
        let phase = phase(&cfa).unwrap();
        let mut fast = Rgb::black(Size { width: 0, height: 0 });
        super::super::demosaic(&mosaic, super::super::Method::XTrans, BORDER, &mut fast);
        let sites = (0..36).map(|i| site(i % 6, i / 6)).collect();
        let slow = Slow { mosaic: &mosaic, phase, sites };
        for y in 0..fast.size().height {
            for x in 0..fast.size().width {
                let (fast, slow) = (fast.at(x, y), slow.colours(x + BORDER, y + BORDER));
                let near = fast.iter().zip(slow).all(|(a, b)| (a - b).abs() < 2e-4);
                assert!(near, "{cfa} at {x},{y}: {fast:?}, slow {slow:?}");
            }
        }
    }
}
