//! Spatial frequency response of slanted edges in a finished picture, after ISO 12233:2017, annex D (the method as P. D.
//! Burns describes it: "Slanted-Edge MTF for Digital Camera and Scanner Analysis", PICS 2000).
//!
//! Edge of each row by the centroid of its derivative; a straight line through these; every pixel by its distance from that
//! line, in bins of a quarter of a pixel; the derivative of these, in a Hamming window; its Fourier transform, divided by
//! what the derivative takes.

use std::f64::consts::PI;

use darkroot_photo::Mosaic;

use crate::Quad;

/// Bins a pixel.
const OVERSAMPLED: f64 = 4.0;
/// Frequencies at which the response is computed: 0 to 1 cycles a pixel.
const FREQUENCIES: usize = 201;
/// Slants of edges that tell, degrees from the rows or columns of pixels.
const SLANT: std::ops::RangeInclusive<f64> = 2.0..=30.0;
/// Fewest rows that make an edge, and fewest pixels on each side of it.
const FEWEST_ROWS: usize = 20;
const FEWEST_BESIDE: f64 = 6.0;
/// Most pixels on each side of an edge that are looked at.
const MOST_BESIDE: f64 = 32.0;
/// The part of a patch's side, about its middle, over which an edge is read.
const ALONG: f64 = 0.6;
/// Least contrast of an edge, darker over lighter side: below, noise tells as much.
const CONTRAST: f64 = 0.7;
/// Share of the gap beside a patch that is looked at.
const INTO_GAP: f64 = 0.85;

/// What an edge shows.
#[derive(Debug, Clone, PartialEq)]
pub struct EdgeResponse {
    /// Response from 0 to 1 cycles a pixel, in even steps; 1 at 0.
    pub response: Vec<f64>,
    /// How far the edge in red and in blue lies from that in green, pixels across the edge.
    pub shifts: [f64; 2],
}

impl EdgeResponse {
    /// The lowest frequency, cycles a pixel, at which the response falls to a share; 1 where it does not.
    pub fn falls_to(&self, share: f64) -> f64 {
        let step = 1.0 / (FREQUENCIES - 1) as f64;
        let below = self.response.windows(2).position(|pair| pair[1] < share);
        below.map_or(1.0, |i| {
            let (high, low) = (self.response[i], self.response[i + 1]);
            step * (i as f64 + (high - share) / (high - low).max(1e-12))
        })
    }

    /// The largest response at a frequency from 0.1 to 0.5 cycles a pixel. Lower ones are bound to 1, where noise decides.
    pub fn peak(&self) -> f64 {
        let last = (FREQUENCIES - 1) / 2;
        self.response[FREQUENCIES / 10..=last].iter().copied().fold(0.0, f64::max)
    }
}

/// A straight edge in a picture, between two even surfaces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgeLine {
    /// One end, in pixels.
    pub from: [f64; 2],
    /// The other.
    pub to: [f64; 2],
    /// How far both sides are even, in pixels.
    pub clear: f64,
}

/// Edges of any place, as targets have them for this purpose.
pub fn responses_of(light: &Mosaic<f32>, luminance: [f64; 3], edges: &[EdgeLine]) -> Vec<EdgeResponse> {
    let strip = |edge: &EdgeLine| Strip::along(light, edge.from, edge.to, INTO_GAP * edge.clear);
    edges.iter().filter_map(strip).filter_map(|strip| response(&strip, luminance)).collect()
}

/// The edges of patches towards what lies around them. `patches` are whole patches in pixels of the picture, `gap` is the
/// width of what lies between them as a share of a patch, `luminance` how much red, green and blue count.
pub fn responses(light: &Mosaic<f32>, luminance: [f64; 3], patches: &[Quad], gap: f64) -> Vec<EdgeResponse> {
    let edges = patches.iter().flat_map(|quad| (0..4).map(move |side| (quad, side)));
    let strips = edges.filter_map(|(quad, side)| Strip::of(light, quad, side, gap));
    strips.filter_map(|strip| response(&strip, luminance)).collect()
}

/// Where a patch really is, by its four edges: how far its centre lies from that of the quadrilateral, pixels. `None` where an
/// edge has too little contrast.
pub(crate) fn centre_shift(
    light: &Mosaic<f32>,
    luminance: [f64; 3],
    quad: &Quad,
    gap: f64,
) -> Option<[f64; 2]> {
    let seen = |rgb: [f64; 3]| (0..3).map(|c| luminance[c] * rgb[c]).sum::<f64>();
    let mut shift = [0.0; 2];
    for side in 0..4 {
        let strip = Strip::of(light, quad, side, gap)?;
        let line = strip.line(&seen)?;
        let rows = (strip.rows[0] + strip.rows[1]) as f64 / 2.0;
        let expected = strip.start + strip.slope * (rows - strip.rows[0] as f64);
        shift[usize::from(strip.exchanged)] += (line[0] + line[1] * rows - expected) / 2.0;
    }
    Some(shift)
}

/// A strip across an edge, with rows that run across it: in pixels as they are, or with columns and rows exchanged.
struct Strip<'a> {
    light: &'a Mosaic<f32>,
    exchanged: bool,
    /// First and last row.
    rows: [usize; 2],
    /// Where the edge is expected in the first row, and how far it moves from row to row.
    start: f64,
    slope: f64,
    /// Pixels on each side.
    beside: f64,
}

fn response(strip: &Strip<'_>, luminance: [f64; 3]) -> Option<EdgeResponse> {
    let seen = |rgb: [f64; 3]| (0..3).map(|c| luminance[c] * rgb[c]).sum::<f64>();
    let line = strip.line(&seen)?;
    if !SLANT.contains(&line[1].atan().to_degrees().abs()) {
        return None;
    }
    let response = transform(&strip.spread(line, &seen)?)?;
    let middle = (strip.rows[0] + strip.rows[1]) as f64 / 2.0;
    let across = 1.0 / line[1].hypot(1.0);
    let place = |c: usize| strip.line(&|rgb: [f64; 3]| rgb[c]).map(|l| across * (l[0] + l[1] * middle));
    let green = place(1)?;
    Some(EdgeResponse { response, shifts: [place(0)? - green, place(2)? - green] })
}

impl<'a> Strip<'a> {
    /// The strip along a side of a patch.
    fn of(light: &'a Mosaic<f32>, quad: &Quad, side: usize, gap: f64) -> Option<Self> {
        let (from, to, behind) = (quad[side], quad[(side + 1) % 4], quad[(side + 3) % 4]);
        let length = (to[0] - from[0]).hypot(to[1] - from[1]);
        let depth = (behind[0] - from[0]).hypot(behind[1] - from[1]);
        Self::along(light, from, to, (INTO_GAP * gap * length.min(depth)).min(depth / 3.0))
    }

    /// The strip along an edge, so many pixels on each side.
    fn along(light: &'a Mosaic<f32>, from: [f64; 2], to: [f64; 2], beside: f64) -> Option<Self> {
        let exchanged = (to[0] - from[0]).abs() > (to[1] - from[1]).abs();
        let turned = |p: [f64; 2]| if exchanged { [p[1], p[0]] } else { p };
        let ([x0, y0], [x1, y1]) = (turned(from), turned(to));
        let beside = beside.min(MOST_BESIDE);
        // Also where a place is none.
        if !(beside >= FEWEST_BESIDE && (x1 - x0).hypot(y1 - y0).is_finite()) {
            return None;
        }
        let slope = (x1 - x0) / (y1 - y0);
        let (low, high) = (y0.min(y1), y0.max(y1));
        let cut = (high - low) * (1.0 - ALONG) / 2.0;
        let (first, last) = ((low + cut).ceil(), (high - cut).floor());
        let (height, width) = if exchanged {
            (light.size.width as f64, light.size.height as f64)
        } else {
            (light.size.height as f64, light.size.width as f64)
        };
        let at = |y: f64| x0 + slope * (y - y0);
        let inside = [first, last].iter().all(|y| {
            // The line that is found may lie half a side away.
            let reach = 1.5 * beside + 2.0;
            *y >= 0.0 && *y < height && at(*y) - reach >= 0.0 && at(*y) + reach < width
        });
        if !inside || last - first < FEWEST_ROWS as f64 {
            return None;
        }
        let rows = [first as usize, last as usize];
        Some(Self { light, exchanged, rows, start: at(first), slope, beside })
    }

    fn pixel(&self, x: usize, y: usize, seen: &dyn Fn([f64; 3]) -> f64) -> f64 {
        let (x, y) = if self.exchanged { (y, x) } else { (x, y) };
        let first = 3 * (y * self.light.size.width + x);
        seen([0, 1, 2].map(|c| f64::from(self.light.samples[first + c])))
    }

    /// Columns about a place.
    fn columns(&self, middle: f64) -> std::ops::RangeInclusive<usize> {
        (middle - self.beside).ceil() as usize..=(middle + self.beside).floor() as usize
    }

    /// The edge as a line: its column in row 0, and its slope. `None` where it has too little contrast or is none.
    fn line(&self, seen: &dyn Fn([f64; 3]) -> f64) -> Option<[f64; 2]> {
        let mut line = [self.start - self.slope * self.rows[0] as f64, self.slope];
        for pass in 0..3 {
            let mut places = Vec::new();
            for y in self.rows[0]..=self.rows[1] {
                let middle = line[0] + line[1] * y as f64;
                // The first pass takes all of the strip; then a window follows the edge.
                let reach = if pass == 0 { f64::INFINITY } else { self.beside };
                places.push([y as f64, self.centroid(y, middle, reach, seen)?]);
            }
            line = fitted(&places)?;
            let strayed = [self.rows[0], self.rows[1]].into_iter().any(|y| {
                let here = line[0] + line[1] * y as f64;
                (here - self.start - self.slope * (y - self.rows[0]) as f64).abs() > self.beside / 2.0
            });
            if strayed {
                return None;
            }
        }
        Some(line)
    }

    /// Centroid of the derivative of a row; columns are those of the strip as it was expected.
    fn centroid(&self, y: usize, middle: f64, reach: f64, seen: &dyn Fn([f64; 3]) -> f64) -> Option<f64> {
        let expected = self.start + self.slope * (y - self.rows[0]) as f64;
        let columns = self.columns(expected);
        let values: Vec<f64> = columns.clone().map(|x| self.pixel(x, y, seen)).collect();
        let (mut sum, mut moment) = (0.0, 0.0);
        for (i, pair) in values.windows(2).enumerate() {
            let place = (*columns.start() + i) as f64 + 0.5;
            let away = (place - middle) / reach;
            let weight = if away.abs() < 1.0 { 0.54 + 0.46 * (PI * away).cos() } else { 0.0 };
            sum += weight * (pair[1] - pair[0]);
            moment += weight * (pair[1] - pair[0]) * place;
        }
        let ends = [values.first()?, values.last()?].map(|v| v.max(0.0));
        let told = ends[0].min(ends[1]) < CONTRAST * ends[0].max(ends[1]);
        (told && sum.abs() > 0.0).then(|| moment / sum).filter(|place| place.is_finite())
    }

    /// The edge in quarters of a pixel, from one side to the other; bins without a pixel lie between their neighbours.
    fn spread(&self, line: [f64; 2], seen: &dyn Fn([f64; 3]) -> f64) -> Option<Vec<f64>> {
        let across = 1.0 / line[1].hypot(1.0);
        let half = ((self.beside - 1.0) * across * OVERSAMPLED).floor() as isize;
        let count = (2 * half + 1) as usize;
        let mut bins = vec![(0.0, 0usize); count];
        for y in self.rows[0]..=self.rows[1] {
            let middle = line[0] + line[1] * y as f64;
            for x in self.columns(middle) {
                let bin = ((x as f64 - middle) * across * OVERSAMPLED).round() as isize + half;
                if let Some(bin) = usize::try_from(bin).ok().and_then(|bin| bins.get_mut(bin)) {
                    *bin = (bin.0 + self.pixel(x, y, seen), bin.1 + 1);
                }
            }
        }
        let mut edge: Vec<f64> = Vec::with_capacity(count);
        for i in 0..count {
            let mean = |&(sum, n): &(f64, usize)| (n > 0).then(|| sum / n as f64);
            let here = mean(&bins[i]);
            let between = || Some((edge.last()? + mean(bins.get(i + 1)?)?) / 2.0);
            let value = here.or_else(between)?;
            edge.push(value);
        }
        Some(edge)
    }
}

/// A straight line through places (row, column): column in row 0, and slope.
fn fitted(places: &[[f64; 2]]) -> Option<[f64; 2]> {
    let count = places.len() as f64;
    let mean = [0, 1].map(|k| places.iter().map(|p| p[k]).sum::<f64>() / count);
    let squares: f64 = places.iter().map(|p| (p[0] - mean[0]).powi(2)).sum();
    let product: f64 = places.iter().map(|p| (p[0] - mean[0]) * (p[1] - mean[1])).sum();
    let slope = product / squares;
    slope.is_finite().then(|| [mean[1] - slope * mean[0], slope])
}

/// The response of an edge in quarters of a pixel.
fn transform(edge: &[f64]) -> Option<Vec<f64>> {
    let spread: Vec<f64> = edge.windows(3).map(|three| (three[2] - three[0]) / 2.0).collect();
    let weight: f64 = spread.iter().sum();
    let middle = spread.iter().enumerate().map(|(i, v)| i as f64 * v).sum::<f64>() / weight;
    if !middle.is_finite() {
        return None;
    }
    let reach = middle.max(spread.len() as f64 - 1.0 - middle);
    let windowed: Vec<f64> = spread
        .iter()
        .enumerate()
        .map(|(i, v)| v * (0.54 + 0.46 * (PI * (i as f64 - middle) / reach).cos()))
        .collect();
    let at = |frequency: f64| {
        let turn = 2.0 * PI * frequency / OVERSAMPLED;
        let (mut real, mut imaginary) = (0.0, 0.0);
        for (i, v) in windowed.iter().enumerate() {
            real += v * (turn * i as f64).cos();
            imaginary += v * (turn * i as f64).sin();
        }
        // A difference over two bins takes sin(x)/x of what there is.
        let derivative = if turn > 0.0 { turn.sin() / turn } else { 1.0 };
        real.hypot(imaginary) / derivative
    };
    let none = at(0.0);
    let response: Vec<f64> =
        (0..FREQUENCIES).map(|i| at(i as f64 / (FREQUENCIES - 1) as f64) / none).collect();
    response.iter().all(|v| v.is_finite()).then_some(response)
}

#[cfg(test)]
mod tests;
