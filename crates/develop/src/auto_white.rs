//! The white that a picture makes most probable.
//!
//! Surfaces have the colours that they have: under each light, the built-in reflectances give the density of balanced
//! camera chromaticities that is to be expected, of bright surfaces and of dark ones. How probable a picture is under a
//! light is the mean of the logarithm of that density over its blocks, once their chromaticities are divided by the light's
//! neutral; it counts as often as the picture has different colours. With how frequent lights are this gives a probability
//! for each white, and the neutral is its mean. After Brainard and Freeman, "Bayesian color constancy" (JOSA A 14(7),
//! 1997), and Finlayson, Hordley and Hubel, "Color by correlation" (IEEE PAMI 23(11), 2001).
//!
//! Where nothing tells which neutrals lights have, the densest place of the chromaticities is taken.

use std::collections::BTreeMap;

use darkroot_colour::statistics;
use darkroot_colour::temperature::Temperature;
use darkroot_profile::camera::light::natural;
use darkroot_profile::fit::virtual_set::builtin_surfaces;

use crate::survey::Survey;
use crate::whites::Whites;

/// Light below which a block says nothing, and the fewest blocks that say something.
const DARKEST: f32 = 0.002;
const FEWEST: usize = 16;
/// A block is bright from this share of the light of the 95th percentile on.
const BRIGHT: f64 = 0.35;

/// Width of a cell of log chromaticity, and how far from white the expected density is tabulated.
const CELL: f64 = 0.03;
const REACH: i32 = 60;
const SIDE: usize = 2 * REACH as usize + 1;
/// Standard deviation that each surface is spread by, and the share of colours that no surface explains.
const SPREAD: f64 = 0.08;
const UNEXPLAINED: f64 = 0.02;
/// Greys are more frequent in the world than in collections: their weight grows by this factor, falling with the distance
/// of the channels' logarithms.
const GREYS: f64 = 3.0;
const NEAR_GREY: f64 = 0.06;
/// Luminance between dark and bright surfaces, and the steepness of the transition in its logarithm.
const HALFWAY: f64 = 0.25;
const STEEP: f64 = 3.0;
/// How often the mean counts, times the square root of the number of different colours.
const INDEPENDENT: f64 = 0.6;

/// Lights for which densities are tabulated, K; others are mixed by mired.
const TABULATED: [f64; 3] = [2800.0, 4500.0, 6500.0];
/// Whites that are looked at: mired from `FIRST` in steps, and Duv.
const FIRST: f64 = 70.0;
const MIREDS: usize = 52;
const MIRED_STEP: f64 = 8.0;
const DUVS: i32 = 6;
const DUV_STEP: f64 = 0.003;
/// Neutrals are computed for every second mired and three Duv, and are smooth between.
const SPARSE: usize = 2;

/// How frequent lights are: share, centre and width in mired of daylight, of incandescent lamps and of all others.
const LIGHTS: [[f64; 3]; 3] = [[0.55, 170.0, 30.0], [0.25, 320.0, 60.0], [0.20, 230.0, 80.0]];
/// Duv of daylight, and the spread of Duv: of most lights, and of the rest.
const DAYLIGHT_DUV: f64 = 0.003;
const DUV_SPREAD: [[f64; 2]; 2] = [[0.85, 0.006], [0.15, 0.015]];

/// Colours of a picture, as far as they tell of the light.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Seen {
    /// For dark and bright blocks: cells of log chromaticity (red over green, blue over green) with their share of all.
    cells: [Vec<([i32; 2], f64)>; 2],
    /// Exponential of the entropy of the shares: how many different colours there are.
    different: f64,
    /// The densest place.
    mode: [f64; 2],
}

impl Seen {
    /// What a survey saw. `None` when too little of the picture is usable.
    pub(crate) fn of(survey: &Survey) -> Option<Self> {
        let usable =
            |b: &&crate::survey::Block| !b.clipped.contains(&true) && b.mean.iter().all(|&v| v > DARKEST);
        let blocks: Vec<([f64; 2], f64)> = survey
            .blocks
            .iter()
            .filter(usable)
            .map(|b| b.mean.map(f64::from))
            .map(|[r, g, b]| ([(r / g).ln(), (b / g).ln()], 0.3 * r + 0.6 * g + 0.1 * b))
            .collect();
        if blocks.len() < FEWEST {
            return None;
        }
        let mut light: Vec<f64> = blocks.iter().map(|(_, light)| *light).collect();
        let place = light.len() * 95 / 100;
        let (_, high, _) = light.select_nth_unstable_by(place, f64::total_cmp);
        let bright = BRIGHT * *high;
        let mut counts = [BTreeMap::new(), BTreeMap::new()];
        for (colour, light) in &blocks {
            let cell = colour.map(|u| (u / CELL).round() as i32);
            *counts[usize::from(*light > bright)].entry(cell).or_insert(0.0) += 1.0;
        }
        let share = 1.0 / blocks.len() as f64;
        let cells =
            counts.map(|c| c.into_iter().map(|(cell, n): (_, f64)| (cell, n * share)).collect::<Vec<_>>());
        let entropy: f64 = cells.iter().flatten().map(|(_, share)| -share * share.ln()).sum();
        Some(Self { mode: mode(&blocks), different: entropy.exp(), cells })
    }

    /// Camera RGB of the most probable white, green 1.
    pub(crate) fn neutral(&self, whites: &Whites<'_>) -> [f64; 3] {
        let [r, b] = self.expected(whites).unwrap_or(self.mode);
        [r.exp(), 1.0, b.exp()]
    }

    /// The mean over whites of the neutral's logarithms. `None` where nothing tells the neutrals.
    fn expected(&self, whites: &Whites<'_>) -> Option<[f64; 2]> {
        let densities = TABULATED.map(|kelvin| Densities::under(whites, kelvin));
        let [Some(warm), Some(middle), Some(cold)] = densities else { return None };
        let neutrals = neutrals(whites)?;
        let often = INDEPENDENT * self.different.sqrt();
        let mut probable = Vec::with_capacity(MIREDS * neutrals[0].len());
        for (m, row) in neutrals.iter().enumerate() {
            let mired = FIRST + m as f64 * MIRED_STEP;
            let density = Densities::mixed([&warm, &middle, &cold], mired);
            for (d, neutral) in row.iter().enumerate() {
                let frequent = frequency(mired, f64::from(d as i32 - DUVS) * DUV_STEP);
                probable.push((frequent.ln() + often * self.likelihood(&density, *neutral), *neutral));
            }
        }
        let most = probable.iter().map(|(p, _)| *p).fold(f64::NEG_INFINITY, f64::max);
        let (mut sum, mut total) = ([0.0; 2], 0.0);
        for (logarithm, neutral) in probable {
            let p = (logarithm - most).exp();
            sum = [sum[0] + p * neutral[0], sum[1] + p * neutral[1]];
            total += p;
        }
        (total.is_finite() && total > 0.0).then(|| sum.map(|s| s / total))
    }

    /// Mean logarithm of the density of the picture's colours.
    fn likelihood(&self, density: &Densities, neutral: [f64; 2]) -> f64 {
        let shift = neutral.map(|u| (u / CELL).round() as i32);
        let of = |(cells, table): (&Vec<([i32; 2], f64)>, &Vec<f64>)| -> f64 {
            cells.iter().map(|([r, b], share)| share * table[place(r - shift[0], b - shift[1])]).sum()
        };
        self.cells.iter().zip(&density.0).map(of).sum()
    }
}

/// The densest place of the blocks' colours in log chromaticity, found by shifting a mean (Cheng, "Mean shift, mode seeking,
/// and clustering", IEEE PAMI 17(8), 1995).
fn mode(blocks: &[([f64; 2], f64)]) -> [f64; 2] {
    let median = |k: usize| {
        let mut values: Vec<f64> = blocks.iter().map(|(c, _)| c[k]).collect();
        statistics::median(&mut values).unwrap_or_default()
    };
    let mut centre = [median(0), median(1)];
    for width in [0.5f64, 0.35, 0.25, 0.25, 0.25, 0.25] {
        let (mut sum, mut weights) = ([0.0; 2], 0.0);
        for (c, _) in blocks {
            let distance2 = (c[0] - centre[0]).powi(2) + (c[1] - centre[1]).powi(2);
            let weight = (-distance2 / (2.0 * width * width)).exp();
            sum = [sum[0] + weight * c[0], sum[1] + weight * c[1]];
            weights += weight;
        }
        if weights > 0.0 {
            centre = sum.map(|s| s / weights);
        }
    }
    centre
}

/// Logarithm of the density of balanced log chromaticities, of dark and of bright surfaces.
struct Densities([Vec<f64>; 2]);

impl Densities {
    /// What the built-in surfaces give under daylight or a black body.
    fn under(whites: &Whites<'_>, kelvin: f64) -> Option<Self> {
        let light = natural(kelvin);
        let surfaces = builtin_surfaces()?;
        let colours = whites.colours(&light, surfaces)?;
        let seen: Vec<([f64; 2], f64, f64)> = colours
            .iter()
            .zip(surfaces)
            .map(|(rgb, (surface, weight))| {
                let [r, g, b] = rgb.map(|v| v.max(1e-4).ln());
                let mean = (r + g + b) / 3.0;
                let off = [r, g, b].iter().map(|v| (v - mean).abs()).fold(0.0, f64::max) / NEAR_GREY;
                let dark = 1.0 / (1.0 + (surface.reflected_xyz(&light).y.max(1e-4) / HALFWAY).powf(STEEP));
                ([r - g, b - g], weight * (1.0 + GREYS * (-off * off).exp()), dark)
            })
            .collect();
        let dark = density(seen.iter().map(|(u, weight, dark)| (*u, weight * dark)));
        let bright = density(seen.iter().map(|(u, weight, dark)| (*u, weight * (1.0 - dark))));
        Some(Self([dark, bright]))
    }

    /// Between the tabulated lights.
    fn mixed([warm, middle, cold]: [&Self; 3], mired: f64) -> Self {
        let [w, m, c] = TABULATED.map(|kelvin| 1e6 / kelvin);
        let share = |from: f64, to: f64| ((mired - from) / (to - from)).clamp(0.0, 1.0);
        let (a, b, t) = if mired > m { (middle, warm, share(m, w)) } else { (middle, cold, share(m, c)) };
        let mix = |k: usize| a.0[k].iter().zip(&b.0[k]).map(|(a, b)| a + (b - a) * t).collect();
        Self([mix(0), mix(1)])
    }
}

/// Logarithms of the weighted sum of Gaussians, over the cells.
fn density(colours: impl Iterator<Item = ([f64; 2], f64)>) -> Vec<f64> {
    let axis = |at: f64| -> Vec<f64> {
        let off = |i: usize| ((i as f64 - f64::from(REACH)) * CELL - at) / SPREAD;
        (0..SIDE).map(|i| (-0.5 * off(i) * off(i)).exp()).collect()
    };
    let mut sum = vec![0.0; SIDE * SIDE];
    let mut total = 0.0;
    for ([r, b], weight) in colours {
        let (along, across) = (axis(r), axis(b));
        for (row, a) in sum.chunks_exact_mut(SIDE).zip(&along) {
            let a = a * weight;
            row.iter_mut().zip(&across).for_each(|(cell, b)| *cell += a * b);
        }
        total += weight;
    }
    let size = std::f64::consts::TAU * SPREAD * SPREAD * total;
    let floor = UNEXPLAINED / (2.0 * f64::from(REACH) * CELL).powi(2);
    sum.into_iter().map(|v| ((1.0 - UNEXPLAINED) * v / size + floor).ln()).collect()
}

/// Where a cell stands in a table; those beyond it at its edge, where only the unexplained is.
fn place(r: i32, b: i32) -> usize {
    let index = |v: i32| (v.clamp(-REACH, REACH) + REACH) as usize;
    index(r) * SIDE + index(b)
}

/// Logarithms of red and blue over green of the neutral, for each mired and Duv that is looked at.
fn neutrals(whites: &Whites<'_>) -> Option<Vec<Vec<[f64; 2]>>> {
    let far = f64::from(DUVS) * DUV_STEP;
    let of = |mired: f64, duv: f64| {
        let white = Temperature { kelvin: 1e6 / mired, duv }.xy();
        let [r, g, b] = whites.neutral_of(white)?;
        Some([(r / g).ln(), (b / g).ln()])
    };
    let across = |mired: f64| Some([of(mired, -far)?, of(mired, 0.0)?, of(mired, far)?]);
    let nodes = (0..=MIREDS / SPARSE).map(|i| across(FIRST + (i * SPARSE) as f64 * MIRED_STEP));
    let nodes = nodes.collect::<Option<Vec<_>>>()?;
    let row = |m: usize| {
        let (node, share) = (m / SPARSE, (m % SPARSE) as f64 / SPARSE as f64);
        let at = |k: usize, c: usize| nodes[node][k][c] * (1.0 - share) + nodes[node + 1][k][c] * share;
        let parabola = |t: f64, c: usize| {
            let (low, middle, high) = (at(0, c), at(1, c), at(2, c));
            middle + t * (high - low) / 2.0 + t * t * (high - 2.0 * middle + low) / 2.0
        };
        (-DUVS..=DUVS)
            .map(|d| f64::from(d) / f64::from(DUVS))
            .map(|t| [parabola(t, 0), parabola(t, 1)])
            .collect()
    };
    Some((0..MIREDS).map(row).collect())
}

/// How frequent lights of this white are, up to a factor.
fn frequency(mired: f64, duv: f64) -> f64 {
    let bell = |off: f64| (-0.5 * off * off).exp();
    let kind: f64 = LIGHTS.iter().map(|[share, centre, width]| share * bell((mired - centre) / width)).sum();
    let own = if mired < 250.0 { DAYLIGHT_DUV } else { 0.0 };
    let tint: f64 = DUV_SPREAD.iter().map(|[share, width]| share * bell((duv - own) / width)).sum();
    kind * tint
}
