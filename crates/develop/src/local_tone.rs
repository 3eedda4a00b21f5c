//! The local tone map of a DNG (ProfileGainTableMap, DNG specification 1.7.1): light is multiplied by a gain that depends on the
//! place and on the light there, as the maker's own rendering does it.
//!
//! The light is linear RIMM (ProPhoto RGB) at the maker's exposure, before a person's; at each place four tables are interpolated.

use std::sync::Arc;

use darkroot_colour::RgbSpace;
use darkroot_photo::{Capture, LocalToneMap, Rgb, Scene};

use crate::cones::{Rows, from_scene, rows, times};
use crate::recipe::LocalTone;

/// A map made ready for loops.
#[derive(Debug, Clone)]
pub(crate) struct LocalGains {
    map: Arc<LocalToneMap>,
    /// From linear Rec. 2020 to RIMM at the maker's exposure.
    from_scene: Rows,
}

impl LocalGains {
    /// The map of a capture, where it has one and that is to be applied; a note says which. `for_people` is whether the look is one
    /// for people.
    pub(crate) fn asked(
        capture: &Capture,
        asked: LocalTone,
        for_people: bool,
        notes: &mut Vec<String>,
    ) -> Option<Self> {
        let map = capture.local_tone.as_ref()?;
        let applied = asked == LocalTone::Auto && for_people;
        let becomes = if applied { "applied" } else { "not applied" };
        notes.push(format!("the file's local tone map is {becomes}"));
        applied.then(|| Self::of(map, capture.baseline_exposure))
    }

    /// Of a capture whose maker brightens pictures by so many stops.
    fn of(map: &Arc<LocalToneMap>, baseline_exposure: f64) -> Self {
        let to_rimm = from_scene(&RgbSpace::PROPHOTO) * baseline_exposure.exp2();
        Self { map: Arc::clone(map), from_scene: rows(&to_rimm) }
    }

    /// The gain for scene light at a place, given as shares of the width and the height of the active area.
    fn gain(&self, scene: [f32; 3], place: [f32; 2]) -> f32 {
        let map = &*self.map;
        let [r, g, b] = times(self.from_scene, scene);
        let seen = [r, g, b, r.min(g).min(b), r.max(g).max(b)];
        let light: f32 = seen.iter().zip(map.weights).map(|(v, weight)| v * weight).sum();
        let light = light.clamp(0.0, 1.0).powf(map.gamma) * map.entries as f32;
        let (entry, next, above) = between(light, map.entries);
        let axis = |axis: usize, share: f32| {
            let at = (share - map.origin[axis] as f32) / map.spacing[axis].max(1e-6) as f32;
            between(at, map.points[axis])
        };
        let (top, bottom, down) = axis(0, place[1]);
        let (left, right, along) = axis(1, place[0]);
        let mix = |a: f32, b: f32, share: f32| a + share * (b - a);
        let of_table = |row: usize, column: usize| {
            let table = &map.gains[(row * map.points[1] + column) * map.entries..][..map.entries];
            mix(table[entry], table[next], above)
        };
        let of_row = |row: usize| mix(of_table(row, left), of_table(row, right), along);
        mix(of_row(top), of_row(bottom), down)
    }
}

/// The two of `count` points that a place lies between, and its share of the way; before the first and after the last one it is
/// that point. What is no number is before the first.
fn between(at: f32, count: usize) -> (usize, usize, f32) {
    let at = at.max(0.0).min((count - 1) as f32);
    let first = at as usize;
    (first, (first + 1).min(count - 1), at - first as f32)
}

/// Multiplies the light of a picture. `place` tells where a pixel lies, by its number.
pub(crate) fn brighten(picture: &mut Rgb<Scene>, local: &LocalGains, place: impl Fn(usize) -> [f32; 2]) {
    let [r, g, b] = picture.planes_mut();
    for (i, ((r, g), b)) in r.iter_mut().zip(g).zip(b).enumerate() {
        let gain = local.gain([*r, *g, *b], place(i));
        [*r, *g, *b] = [*r * gain, *g * gain, *b * gain];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use darkroot_photo::Size;

    /// Two tables side by side, in the middles of the halves of the picture, of four entries.
    fn map() -> Arc<LocalToneMap> {
        Arc::new(LocalToneMap {
            points: [1, 2],
            spacing: [1.0, 0.5],
            origin: [0.5, 0.25],
            entries: 4,
            weights: [0.0, 0.0, 0.0, 0.0, 1.0],
            gamma: 1.0,
            gains: vec![4.0, 2.0, 1.0, 0.5, 1.0, 1.0, 1.0, 1.0],
        })
    }

    fn grey(local: &LocalGains, light: f32, place: [f32; 2]) -> f32 {
        let mut picture: Rgb<Scene> =
            Rgb::from_planes(Size { width: 1, height: 1 }, [light; 3].map(|v| vec![v])).unwrap();
        brighten(&mut picture, local, |_| place);
        let [r, g, b] = picture.at(0, 0);
        assert!((r - g).abs() < 1e-6 && (g - b).abs() < 1e-6);
        r / light
    }

    #[test]
    fn tables_are_interpolated_by_light_and_by_place() {
        let local = LocalGains::of(&map(), 0.0);
        // Entries lie at 0, 1/4, 1/2 and 3/4 of the light; the last one goes on.
        for (light, gain) in
            [(1e-6, 4.0), (0.125, 3.0), (0.25, 2.0), (0.375, 1.5), (0.75, 0.5), (1.0, 0.5), (9.0, 0.5)]
        {
            assert!((grey(&local, light, [0.25, 0.5]) - gain).abs() < 1e-3, "{light}");
            assert!((grey(&local, light, [0.0, 0.0]) - gain).abs() < 1e-3, "{light}");
            assert!((grey(&local, light, [0.75, 0.9]) - 1.0).abs() < 1e-3, "{light}");
            assert!((grey(&local, light, [0.5, 0.2]) - (gain + 1.0) / 2.0).abs() < 1e-3, "{light}");
        }
    }

    #[test]
    fn the_makers_exposure_counts_and_the_exponent() {
        // A stop of the maker's: 0.125 counts as 0.25.
        assert!((grey(&LocalGains::of(&map(), 1.0), 0.125, [0.25, 0.5]) - 2.0).abs() < 1e-3);
        let root = LocalGains::of(&Arc::new(LocalToneMap { gamma: 0.5, ..(*map()).clone() }), 0.0);
        assert!((grey(&root, 0.0625, [0.25, 0.5]) - 2.0).abs() < 1e-3);
    }

    #[test]
    fn light_that_is_no_number_harms_nothing() {
        let local = LocalGains::of(&map(), 0.0);
        for light in [f32::NAN, f32::INFINITY, -1.0, f32::MAX] {
            assert!(local.gain([light; 3], [0.5, 0.5]).is_finite());
        }
        assert!(local.gain([0.2; 3], [f32::NAN, f32::INFINITY]).is_finite());
    }
}
