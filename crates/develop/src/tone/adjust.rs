//! What a person changes about the tones of a look: by zones of brightness, in stops around middle grey.

use std::sync::Arc;

use super::Points;
use super::headroom::Headroom;

/// Changes of a look. All are 0 (saturation 1) where nothing is changed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tones {
    /// Stops by which what is two stops brighter than middle grey gets brighter still, and what is two stops darker darker;
    /// beyond, it grows to 2.2 times that. -1..=1.
    pub contrast: f32,
    /// Stops by which shadows get brighter: all of it from three and a half stops under middle grey on, none at half a stop
    /// above it. -2..=2.
    pub shadows: f32,
    /// Stops by which highlights get brighter: all of it from three and a half stops above middle grey on, none at half a
    /// stop under it. -2..=2.
    pub highlights: f32,
    /// Stops by which what is nearly black gets brighter: all of it seven stops under middle grey, none at two. -2..=2.
    pub black: f32,
    /// Stops by which what is nearly white gets brighter: all of it three stops above middle grey, where sensors clip, none
    /// at one. -1..=1.
    pub white: f32,
    /// Stops above white that the picture has room for, 0..=4: all that is shown is a share of the brightest light there is room
    /// for, so that 1 is that light and white lies below.
    pub headroom: f32,
    /// Lightness that is shown in place of what all of the above gives.
    pub curve: Option<Points>,
    /// Factor on chroma, 0..=2.
    pub saturation: f32,
    /// How much more chroma pale colours get, as a share of what they have; pure ones get none. -1..=1.
    pub vibrance: f32,
}

impl Default for Tones {
    fn default() -> Self {
        Self {
            contrast: 0.0,
            shadows: 0.0,
            highlights: 0.0,
            black: 0.0,
            white: 0.0,
            headroom: 0.0,
            curve: None,
            saturation: 1.0,
            vibrance: 0.0,
        }
    }
}

impl Tones {
    /// Whether brightness stays as the look has it.
    pub(super) fn keeps_curve(&self) -> bool {
        let zones = [self.contrast, self.shadows, self.highlights, self.black, self.white, self.headroom];
        self.curve.is_none() && zones.iter().all(|v| *v == 0.0)
    }

    /// Stops that light gets which is so many stops brighter than middle grey.
    fn stops(&self, stops: f64) -> f64 {
        // Half of a slope of 1.118 at grey, so that two stops become one more.
        let bent = 0.559 * stops / (1.0 + (0.25 * stops).powi(2)).sqrt();
        let zones = [
            (self.shadows, zone(stops, 0.5, -3.5)),
            (self.highlights, zone(stops, -0.5, 3.5)),
            (self.black, zone(stops, -2.0, -7.0)),
            (self.white, zone(stops, 1.0, 3.0)),
        ];
        let sum: f64 = zones.iter().map(|(amount, share)| f64::from(*amount) * share).sum();
        f64::from(self.contrast) * bent + sum
    }
}

/// 0 up to the first number of stops, 1 from the second on, smooth between.
fn zone(stops: f64, none: f64, all: f64) -> f64 {
    let along = ((stops - none) / (all - none)).clamp(0.0, 1.0);
    along * along * (3.0 - 2.0 * along)
}

/// Lowest and highest power of two of scene light in the table; below, it goes straight to what is shown of none.
const POWERS: (i32, i32) = (-18, 20);
/// Bits of the mantissa that tell entries apart.
const BITS: u32 = 6;
/// 1 / the least light of the table.
const UNDER: f32 = (1u32 << -POWERS.0) as f32;
/// Least that a curve rises from one entry to the next, in stops.
const LEAST_RISE: f64 = 1e-4;

/// A curve as a table over scene light, 2^6 entries for each doubling, straight between them.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Table {
    entries: Arc<[f32]>,
    /// What is shown of no light.
    black: f32,
}

impl Table {
    /// What a curve shows of light after `tones` changed it about `grey`. The curve is asked for no light first, then for more and
    /// more.
    pub(super) fn of(tones: &Tones, grey: f64, mut curve: impl FnMut(f32) -> f32) -> Self {
        let black = curve(0.0) / tones.headroom.exp2();
        let count = ((POWERS.1 - POWERS.0) as usize) << BITS;
        let mut last = f64::NEG_INFINITY;
        let mut headroom = (tones.headroom > 0.0).then(|| Headroom::of(tones.headroom, grey));
        let entry = |i: usize| {
            let first = ((127 + POWERS.0) as u32) << 23;
            let light = f64::from(f32::from_bits(first + ((i as u32) << (23 - BITS))));
            let stops = (light / grey).log2();
            // However much is asked for, brighter light is shown brighter.
            last = (stops + tones.stops(stops)).max(last + LEAST_RISE);
            let light = grey * last.exp2();
            let shown = curve(light as f32);
            headroom.as_mut().map_or(shown, |headroom| headroom.at(light, shown))
        };
        Self { entries: (0..=count).map(entry).collect(), black }
    }

    /// What is shown of scene light, which is not negative.
    #[inline(always)]
    pub(super) fn at(&self, light: f32) -> f32 {
        let first = ((127 + POWERS.0) as u32) << BITS;
        let bits = light.to_bits();
        let place = bits >> (23 - BITS);
        if place < first {
            // Under the table.
            return self.black + (self.entries[0] - self.black) * light * UNDER;
        }
        let i = ((place - first) as usize).min(self.entries.len() - 2);
        let part = (bits & ((1 << (23 - BITS)) - 1)) as f32 * (1.0 / (1u32 << (23 - BITS)) as f32);
        self.entries[i] + part * (self.entries[i + 1] - self.entries[i])
    }
}
