//! How the maker of a profile would show its colours: tone curve and look table of a DCP (DNG 1.7.1, chapter 6, "Profile
//! Look Table" and "Tone Curve"). Nothing of it is colorimetry, so models take no part in it.

/// What is laid over colours as measured: the look table first, then the curve.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Rendering {
    /// Stops of exposure that are added to the file's own.
    pub exposure: f64,
    /// The table; `None` for none.
    pub table: Option<LookTable>,
    /// The curve; `None` where whoever renders takes its own.
    pub curve: Option<ToneCurve>,
}

/// A tone curve over linear light, 0 to 1 each way: the natural cubic spline through its points.
#[derive(Debug, Clone, PartialEq)]
pub struct ToneCurve {
    points: Vec<[f64; 2]>,
    /// Slope at each point.
    slopes: Vec<f64>,
}

/// A table over hue, saturation and value of linear ProPhoto RGB: shift of hue in degrees, factor for saturation and factor for
/// value; linear between its nodes.
#[derive(Debug, Clone, PartialEq)]
pub struct LookTable {
    divisions: [usize; 3],
    coded: bool,
    nodes: Vec<[f32; 3]>,
}

/// Most points of a curve and most nodes of a table.
const MOST_POINTS: usize = 65_536;
const MOST_NODES: usize = 2_000_000;

impl Rendering {
    /// Whether it says anything of tones or colours.
    pub fn is_any(&self) -> bool {
        self.table.is_some() || self.curve.is_some()
    }
}

impl ToneCurve {
    /// A curve through points from left to right. `None` where there are fewer than two or too many of them, in disorder, or
    /// outside of 0 to 1.
    pub fn new(points: Vec<[f64; 2]>) -> Option<Self> {
        let sound = (2..=MOST_POINTS).contains(&points.len())
            && points.iter().flatten().all(|v| (0.0..=1.0).contains(v))
            && points.windows(2).all(|pair| pair[0][0] < pair[1][0]);
        sound.then(|| Self { slopes: natural_slopes(&points), points })
    }

    /// Its points.
    pub fn points(&self) -> &[[f64; 2]] {
        &self.points
    }

    /// What it shows of light; light beyond its points is shown as theirs.
    pub fn at(&self, light: f64) -> f64 {
        let right = self.points.partition_point(|[x, _]| *x <= light).clamp(1, self.points.len() - 1);
        let ([x0, y0], [x1, y1]) = (self.points[right - 1], self.points[right]);
        let width = x1 - x0;
        let t = ((light - x0) / width).clamp(0.0, 1.0);
        // Hermite's cubic.
        let (square, cube) = (t * t, t * t * t);
        let ends = y0 * (1.0 - 3.0 * square + 2.0 * cube) + y1 * (3.0 * square - 2.0 * cube);
        let (m0, m1) = (self.slopes[right - 1], self.slopes[right]);
        (ends + width * (m0 * (t - 2.0 * square + cube) + m1 * (cube - square))).clamp(0.0, 1.0)
    }
}

/// Slopes with which neighbouring cubics bend alike at each point, and not at all at both ends (de Boor, "A Practical Guide
/// to Splines", chapter IV).
fn natural_slopes(points: &[[f64; 2]]) -> Vec<f64> {
    let widths: Vec<f64> = points.windows(2).map(|p| p[1][0] - p[0][0]).collect();
    let secants: Vec<f64> = points.windows(2).zip(&widths).map(|(p, w)| (p[1][1] - p[0][1]) / w).collect();
    let last = points.len() - 1;
    // Rows of a tridiagonal system: below, on and above the diagonal, and the right side.
    let row = |i: usize| match i {
        0 => [0.0, 2.0, 1.0, 3.0 * secants[0]],
        i if i == last => [1.0, 2.0, 0.0, 3.0 * secants[last - 1]],
        i => {
            let (before, after) = (widths[i - 1], widths[i]);
            let right = 3.0 * (after * secants[i - 1] + before * secants[i]);
            [after, 2.0 * (before + after), before, right]
        }
    };
    // Thomas's elimination; the diagonal is dominant.
    let mut reduced: Vec<[f64; 2]> = Vec::with_capacity(points.len());
    for i in 0..=last {
        let [below, on, above, right] = row(i);
        let [above_before, right_before] = reduced.last().copied().unwrap_or_default();
        let pivot = on - below * above_before;
        reduced.push([above / pivot, (right - below * right_before) / pivot]);
    }
    let mut slopes = vec![0.0; points.len()];
    let mut next = 0.0;
    for (slope, [above, right]) in slopes.iter_mut().zip(&reduced).rev() {
        next = right - above * next;
        *slope = next;
    }
    slopes
}

impl LookTable {
    /// A table of so many hues, saturations and values; the nodes by value, then hue, the saturation varying fastest. `coded`
    /// says whether values are looked up and multiplied as the curve of sRGB has them. `None` for fewer than one hue, two
    /// saturations and one value, another number of nodes, or numbers that are not finite.
    pub fn new(divisions: [usize; 3], coded: bool, nodes: Vec<[f32; 3]>) -> Option<Self> {
        let [hues, saturations, values] = divisions;
        let count = hues.checked_mul(saturations).and_then(|n| n.checked_mul(values));
        let sound = hues >= 1
            && saturations >= 2
            && values >= 1
            && count == Some(nodes.len())
            && nodes.len() <= MOST_NODES
            && nodes.iter().flatten().all(|v| v.is_finite());
        sound.then_some(Self { divisions, coded, nodes })
    }

    /// Numbers of hues, saturations and values.
    pub fn divisions(&self) -> [usize; 3] {
        self.divisions
    }

    /// All nodes, as [`Self::new`] takes them.
    pub fn nodes(&self) -> &[[f32; 3]] {
        &self.nodes
    }

    /// Whether values are coded by the curve of sRGB. In a table of one value none is.
    pub fn is_coded(&self) -> bool {
        self.coded && self.divisions[2] > 1
    }

    /// Linear ProPhoto RGB through the table; negative channels count as 0. `encode` and `decode` are the curve of sRGB and its
    /// inverse over 0 to 1, for tables that [are coded](Self::is_coded). Light beyond 1 is taken as that of 1, in proportion.
    #[inline]
    pub fn apply(&self, rgb: [f32; 3], encode: impl Fn(f32) -> f32, decode: impl Fn(f32) -> f32) -> [f32; 3] {
        let rgb = rgb.map(|v| if v > 0.0 { v } else { 0.0 });
        let high = rgb[0].max(rgb[1]).max(rgb[2]);
        let low = rgb[0].min(rgb[1]).min(rgb[2]);
        if high <= 0.0 {
            return [0.0; 3];
        }
        let beyond = high.max(1.0);
        let value = high / beyond;
        let coded = if self.is_coded() { encode(value) } else { value };
        let hue = hue(rgb, high, high - low);
        let saturation = (high - low) / high;
        let [shift, more, brighter] = self.at(hue, saturation, coded);
        let value = (coded * brighter).max(0.0);
        let value = beyond * if self.is_coded() { decode(value.min(1.0)) } else { value };
        let saturation = (saturation * more).clamp(0.0, 1.0);
        let hue = hue + shift * (1.0 / 60.0);
        let ramp = |centre: f32| {
            let away = (hue - centre) * (1.0 / 6.0);
            let away = 6.0 * (away - away.floor());
            (2.0 - away.min(6.0 - away)).clamp(0.0, 1.0)
        };
        [0.0, 2.0, 4.0].map(|centre| value * (1.0 - saturation + saturation * ramp(centre)))
    }

    /// What the nodes round a place say, linear between them: round in hue (0 to 6), held at the ends of the others.
    #[inline]
    fn at(&self, hue: f32, saturation: f32, value: f32) -> [f32; 3] {
        let [hues, saturations, values] = self.divisions;
        let place = |v: f32, last: usize| {
            let first = (v as usize).min(last);
            (first, v - first as f32)
        };
        let (h, along_h) = place(hue * hues as f32 * (1.0 / 6.0), hues - 1);
        let (s, along_s) = place(saturation.min(1.0) * (saturations - 1) as f32, saturations - 2);
        let (v, along_v) = place(value.min(1.0) * (values - 1) as f32, values.saturating_sub(2));
        let next_h = if h + 1 < hues { h + 1 } else { 0 };
        let mix = |a: [f32; 3], b: [f32; 3], share: f32| [0, 1, 2].map(|i| a[i] + share * (b[i] - a[i]));
        let of_hue = |v: usize, h: usize| {
            let at = (v * hues + h) * saturations + s;
            mix(self.nodes[at], self.nodes[at + 1], along_s)
        };
        let of_value = |v: usize| mix(of_hue(v, h), of_hue(v, next_h), along_h);
        if values == 1 { of_value(0) } else { mix(of_value(v), of_value(v + 1), along_v) }
    }
}

/// Position on the RGB hexagon, 0 (red) to 6, of a colour with that largest channel and span.
#[inline]
fn hue([r, g, b]: [f32; 3], high: f32, span: f32) -> f32 {
    if span <= 0.0 {
        return 0.0;
    }
    let hue = if r >= high {
        (g - b) / span
    } else if g >= high {
        2.0 + (b - r) / span
    } else {
        4.0 + (r - g) / span
    };
    if hue < 0.0 { hue + 6.0 } else { hue }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hue_plane::{at_position, position};
    use proptest::prelude::*;

    fn table(coded: bool) -> LookTable {
        let node = |i: usize| {
            let (s, h, v) = (i % 4, i / 4 % 12, i / 48);
            let wave = (h as f32 * 0.5).sin();
            [20.0 * wave * v as f32, 1.0 + 0.1 * s as f32 * wave, 1.0 + 0.05 * v as f32 * s as f32 * wave]
        };
        LookTable::new([12, 4, 5], coded, (0..240).map(node).collect()).unwrap()
    }

    /// Word for word as the DNG specification has it, in double precision: `hsv`, eight nodes with their weights, `rgb`.
    fn slow(table: &LookTable, rgb: [f64; 3]) -> [f64; 3] {
        let (low, high) = rgb.into_iter().fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(v), h.max(v)));
        let (hue, saturation) = (position(rgb), if high > 0.0 { (high - low) / high } else { 0.0 });
        let coded = |v: f64| if table.coded { darkroot_colour::TransferCurve::Srgb.encode(v) } else { v };
        let decoded = |v: f64| if table.coded { darkroot_colour::TransferCurve::Srgb.decode(v) } else { v };
        let [hues, saturations, values] = table.divisions;
        let place = [
            hue * hues as f64 / 6.0,
            saturation * (saturations - 1) as f64,
            coded(high) * (values - 1) as f64,
        ];
        let mut found = [0.0; 3];
        for (h, node) in
            table.nodes.chunks_exact(saturations).enumerate().map(|(i, n)| ((i % hues, i / hues), n))
        {
            for (s, node) in node.iter().enumerate() {
                let round = |a: f64, n: f64| (a - n * (a / n).round()).abs();
                let away = [
                    round(place[0] - h.0 as f64, hues as f64),
                    (place[1] - s as f64).abs(),
                    (place[2] - h.1 as f64).abs(),
                ];
                let weight: f64 = away.iter().map(|a| (1.0 - a).max(0.0)).product();
                for (sum, v) in found.iter_mut().zip(node) {
                    *sum += weight * f64::from(*v);
                }
            }
        }
        let value = decoded((coded(high) * found[2]).clamp(0.0, 1.0));
        let saturation = (saturation * found[1]).clamp(0.0, 1.0);
        at_position((hue + found[0] / 60.0).rem_euclid(6.0))
            .map(|pure| value * (1.0 - saturation + saturation * pure))
    }

    fn fast(table: &LookTable, rgb: [f32; 3]) -> [f32; 3] {
        let curve = darkroot_colour::TransferCurve::Srgb;
        table.apply(rgb, |v| curve.encode(f64::from(v)) as f32, |v| curve.decode(f64::from(v)) as f32)
    }

    proptest! {
        #[test]
        fn a_colour_is_what_all_nodes_by_their_weights_say(
            r in 0f32..1.0, g in 0f32..1.0, b in 0f32..1.0, coded in any::<bool>(), pure in any::<bool>(),
        ) {
            let rgb = if pure { [r, g, 0.0] } else { [r, g, b] };
            let table = table(coded);
            let mut expected = slow(&table, rgb.map(f64::from));
            if !coded {
                // Only the slow one cuts.
                let raw = fast(&table, rgb);
                prop_assume!(raw.iter().all(|v| *v < 1.0));
            }
            expected.iter_mut().for_each(|v| *v = v.max(0.0));
            let found = fast(&table, rgb);
            for (a, b) in found.iter().zip(expected) {
                prop_assert!((f64::from(*a) - b).abs() < 2e-5, "{rgb:?}: {found:?} {expected:?}");
            }
        }
    }

    #[test]
    fn light_beyond_white_goes_on_in_proportion_and_black_stays() {
        let table = table(true);
        let white = fast(&table, [1.0, 0.6, 0.3]);
        let more = fast(&table, [3.0, 1.8, 0.9]);
        assert!(white.iter().zip(more).all(|(a, b)| (3.0 * a - b).abs() < 1e-5), "{white:?} {more:?}");
        assert!(fast(&table, [0.0, -1.0, f32::NAN]).iter().all(|v| v.abs() <= 0.0));
    }

    #[test]
    fn the_curve_is_the_natural_spline_through_its_points() {
        let points: Vec<[f64; 2]> =
            [0.0, 0.1, 0.25, 0.3, 0.7, 1.0].iter().map(|x: &f64| [*x, x.powf(0.6)]).collect();
        let curve = ToneCurve::new(points.clone()).unwrap();
        for [x, y] in &points {
            assert!((curve.at(*x) - y).abs() < 1e-12);
        }
        let bend = |x: f64| {
            let d = 1e-4;
            (curve.at(x - d) - 2.0 * curve.at(x) + curve.at(x + d)) / (d * d)
        };
        // It bends alike on both sides of a point, and not at the ends.
        for [x, _] in &points[1..5] {
            let (left, right) = (bend(x - 2e-4), bend(x + 2e-4));
            assert!((left - right).abs() < 0.05 * left.abs().max(1.0), "{x}: {left} {right}");
        }
        assert!(
            bend(2e-4).abs() < 0.3 && bend(1.0 - 2e-4).abs() < 0.3,
            "{} {}",
            bend(2e-4),
            bend(1.0 - 2e-4)
        );
        let straight = ToneCurve::new(vec![[0.0, 0.0], [1.0, 1.0]]).unwrap();
        assert!((0..=100).all(|i| (straight.at(f64::from(i) / 100.0) - f64::from(i) / 100.0).abs() < 1e-12));
    }

    #[test]
    fn what_is_no_rendering_is_refused() {
        assert_eq!(ToneCurve::new(vec![[0.0, 0.0]]), None);
        assert_eq!(ToneCurve::new(vec![[0.0, 0.0], [0.0, 1.0]]), None);
        assert_eq!(ToneCurve::new(vec![[0.0, 0.0], [1.0, f64::NAN]]), None);
        assert_eq!(LookTable::new([0, 2, 1], false, Vec::new()), None);
        assert_eq!(LookTable::new([2, 1, 1], false, vec![[0.0, 1.0, 1.0]; 2]), None);
        assert_eq!(LookTable::new([2, 2, 1], false, vec![[0.0, 1.0, f32::INFINITY]; 4]), None);
        assert_eq!(LookTable::new([usize::MAX, 2, 2], false, Vec::new()), None);
    }
}
