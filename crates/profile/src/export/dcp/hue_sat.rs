//! The table over hue and saturation of linear ProPhoto RGB (DNG 1.7.1, chapter 6, "Hue/Saturation/Value Mapping
//! Table"), of one layer.

use darkroot_colour::{Matrix3, RgbSpace, Vector3, white};

use crate::Model;
use crate::hue_plane::{at_position, position};

/// Hues and saturations of the tables that are written.
const HUES: usize = 90;
const SATURATIONS: usize = 30;

/// Shift of hue in degrees, factor for saturation, factor for value; linear between its nodes.
#[derive(Debug, Clone, PartialEq)]
pub struct HueSatMap {
    hues: usize,
    saturations: usize,
    /// By hue from red on, saturation from 0 to 1 varying fastest.
    nodes: Vec<[f64; 3]>,
}

impl HueSatMap {
    /// A table with these nodes, the saturation varying fastest. `None` when there are fewer than one hue or two
    /// saturations, the number does not fit or one is not finite.
    pub fn new(hues: usize, saturations: usize, nodes: Vec<[f64; 3]>) -> Option<Self> {
        let sound = hues >= 1
            && saturations >= 2
            && hues.checked_mul(saturations) == Some(nodes.len())
            && nodes.iter().flatten().all(|v| v.is_finite());
        sound.then_some(Self { hues, saturations, nodes })
    }

    /// The table that changes nothing.
    pub fn neutral() -> Self {
        Self { hues: 1, saturations: 2, nodes: vec![[0.0, 1.0, 1.0]; 2] }
    }

    /// The table that makes `forward`, balanced camera RGB to XYZ, into the model. `None` when the matrix has no
    /// inverse.
    pub fn of(model: &Model, forward: &Matrix3) -> Option<Self> {
        let to_prophoto = RgbSpace::PROPHOTO.from_xyz_under(white::D50);
        let to_camera = (to_prophoto * forward).try_inverse()?;
        let node = |i: usize| {
            let hue = (i / SATURATIONS) as f64 * 6.0 / HUES as f64;
            let pure = Vector3::from(at_position(hue));
            let white = to_camera * Vector3::repeat(1.0);
            let slope = to_camera * (pure - Vector3::repeat(1.0));
            // Beyond this saturation camera RGB would be negative; there the table stays as it is.
            let reach = white.iter().zip(slope.iter()).filter(|(_, s)| **s < 0.0).map(|(w, s)| -w / s);
            let reach = reach.fold(1.0, f64::min);
            let saturation = (i % SATURATIONS) as f64 / (SATURATIONS - 1) as f64;
            // At 0 there is no hue: what the colours next to it need.
            const NEXT_TO_GREY: f64 = 1e-4;
            let at = saturation.clamp(NEXT_TO_GREY, reach.max(NEXT_TO_GREY));
            let rgb = (white + slope * at).map(|v| v.max(0.0));
            let wanted = to_prophoto * Vector3::from(model.xyz(rgb.into()));
            let [hue_wanted, saturation_wanted, value] = hsv(wanted.into());
            let shift = (hue_wanted - hue + 3.0).rem_euclid(6.0) - 3.0;
            // Greys keep their value: a rule of the format.
            let value = if saturation > 0.0 { value } else { 1.0 };
            [shift * 60.0, (saturation_wanted / at).max(0.0), value.max(0.0)]
        };
        Self::new(HUES, SATURATIONS, (0..HUES * SATURATIONS).map(node).collect())
    }

    /// Number of hues and of saturations.
    pub fn dimensions(&self) -> [usize; 2] {
        [self.hues, self.saturations]
    }

    /// All nodes, the saturation varying fastest.
    pub fn nodes(&self) -> &[[f64; 3]] {
        &self.nodes
    }

    /// Linear ProPhoto RGB corrected; negative channels count as 0, as in the DNG SDK.
    pub fn apply(&self, rgb: [f64; 3]) -> [f64; 3] {
        let rgb = rgb.map(|v| v.max(0.0));
        let [hue, saturation, value] = hsv(rgb);
        let across = hue * self.hues as f64 / 6.0;
        let up = saturation.clamp(0.0, 1.0) * (self.saturations - 1) as f64;
        let (h, s) = ((across as usize).min(self.hues - 1), (up as usize).min(self.saturations - 2));
        let (share_h, share_s) = (across - h as f64, up - s as f64);
        let node = |h: usize, s: usize| Vector3::from(self.nodes[h % self.hues * self.saturations + s]);
        let along = |h: usize| node(h, s) * (1.0 - share_s) + node(h, s + 1) * share_s;
        let found = along(h) * (1.0 - share_h) + along(h + 1) * share_h;
        let hue = (hue + found[0] / 60.0).rem_euclid(6.0);
        let saturation = (saturation * found[1]).clamp(0.0, 1.0);
        at_position(hue).map(|pure| value * found[2] * (1.0 - saturation + saturation * pure))
    }
}

/// Hue 0..6, saturation and value; a colour with a negative channel has a saturation above 1.
fn hsv(rgb: [f64; 3]) -> [f64; 3] {
    let (low, high) = rgb.into_iter().fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(v), h.max(v)));
    let saturation = if high > 0.0 { (high - low) / high } else { 0.0 };
    [position(rgb), saturation, high]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::tests::{forward, models};
    use proptest::prelude::*;

    #[test]
    fn a_matrix_needs_no_table() {
        let map = HueSatMap::of(&models()[0], &forward()).unwrap();
        for [shift, saturation, value] in map.nodes().iter().copied() {
            // Beyond the camera's gamut the last saturation it has stands for all, which changes nothing either.
            assert!(shift.abs() < 1e-6 && (saturation - 1.0).abs() < 1e-6 && (value - 1.0).abs() < 1e-6);
        }
    }

    #[test]
    fn greys_keep_their_value() {
        for model in models() {
            let map = HueSatMap::of(&model, &forward()).unwrap();
            for row in map.nodes().chunks(SATURATIONS) {
                assert!((row[0][2] - 1.0).abs() < f64::EPSILON);
            }
            for grey in [0.0, 0.18, 1.0, 3.0] {
                assert!(map.apply([grey; 3]).iter().all(|v| (v - grey).abs() < 1e-12));
            }
        }
    }

    proptest! {
        #[test]
        fn twice_the_light_is_twice_the_colour(r in 0f64..1.0, g in 0f64..1.0, b in 0f64..1.0) {
            let map = HueSatMap::of(&models()[1], &forward()).unwrap();
            let (one, two) = (map.apply([r, g, b]), map.apply([2.0 * r, 2.0 * g, 2.0 * b]));
            for (one, two) in one.into_iter().zip(two) {
                prop_assert!((2.0 * one - two).abs() < 1e-9);
            }
        }
    }
}
