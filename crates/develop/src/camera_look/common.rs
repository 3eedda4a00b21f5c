//! One look of a camera, by those of several photographs.

use super::{CameraLook, median};
use crate::tone::Points;

/// Lightness at which looks are compared: from the first on, in such steps.
const FIRST: f64 = 4.0;
const STEP: f64 = 8.0;
const COUNT: usize = 12;
/// What lies this far beyond the points of a look is still told by it, L*.
const BEYOND: f64 = 4.0;

/// The median of the looks at every lightness that half of them tell of; [`CameraLook::left`] is then what they usually differ from
/// it. `None` where they have too little in common.
pub fn common(looks: &[CameraLook]) -> Option<CameraLook> {
    let curves: Vec<(&CameraLook, Points)> =
        looks.iter().filter_map(|look| Some((look, Points::new(&look.points).ok()?))).collect();
    let told = |at: f64| -> Vec<f64> {
        let tells = |look: &CameraLook| {
            let (first, last) = (look.points.first(), look.points.last());
            first.zip(last).is_some_and(|(a, b)| (a[0] - BEYOND..=b[0] + BEYOND).contains(&at))
        };
        curves.iter().filter(|(look, _)| tells(look)).map(|(_, curve)| curve.lightness(at)).collect()
    };
    let (mut points, mut apart) = (Vec::new(), Vec::new());
    let mut high = 0.0f64;
    for at in (0..COUNT).map(|i| FIRST + STEP * i as f64) {
        let values = told(at);
        if 2 * values.len() < curves.len() || values.is_empty() {
            continue;
        }
        let middle = median(values.clone());
        apart.extend(values.iter().map(|v| (v - middle).abs()));
        high = ((10.0 * middle).round() / 10.0).max(high);
        points.push([at, high]);
    }
    let saturation = median(looks.iter().map(|look| look.saturation).collect());
    let saturation = (100.0 * saturation).round() / 100.0;
    (points.len() >= 3).then(|| CameraLook { points, saturation, left: median(apart) })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn look(points: &[[f64; 2]], saturation: f64) -> CameraLook {
        CameraLook { points: points.to_vec(), saturation, left: 0.5 }
    }

    #[test]
    fn the_look_that_most_have_is_found_and_one_that_was_edited_does_not_matter() {
        let usual = [[5.0, 3.0], [30.0, 35.0], [60.0, 70.0], [92.0, 95.0]];
        let dark = [[5.0, 3.0], [30.0, 35.0], [50.0, 58.0]];
        let edited = [[5.0, 30.0], [30.0, 60.0], [60.0, 85.0], [92.0, 99.0]];
        let looks = [look(&usual, 1.1), look(&dark, 1.08), look(&usual, 1.12), look(&edited, 1.5)];
        let common = common(&looks).unwrap();
        let (found, wanted) = (Points::new(&common.points).unwrap(), Points::new(&usual).unwrap());
        for at in [10.0, 30.0, 45.0, 60.0, 80.0] {
            let off = (found.lightness(at) - wanted.lightness(at)).abs();
            assert!(off < 1.5, "{at}: {off}");
        }
        assert!((1.09..=1.12).contains(&common.saturation), "{}", common.saturation);
        assert_eq!(super::common(&[]), None);
    }
}
