//! A local tone map lies in the picture where it lies in the frame, however that is turned, cut or made smaller.

use std::sync::Arc;

use darkroot_colour::RgbSpace;
use darkroot_develop::{Bits, Cancel, Crop, Geometry, LocalTone, Look, Recipe, Scale, Turn, View};
use darkroot_photo::{Capture, Layout, LocalToneMap, Rect, Size};
use darkroot_simulate::camera::filters;
use darkroot_tests::{develop, flat_grey, mean, output, plan, rendered, rendered_in_tiles};

const SIZE: Size = Size { width: 240, height: 160 };

/// An even grey; the file makes the left half of it half as bright, and leaves the right half.
fn capture(layout: Layout) -> Capture {
    let local_tone = LocalToneMap {
        points: [1, 4],
        spacing: [1.0, 0.25],
        origin: [0.5, 0.125],
        entries: 1,
        weights: [0.2, 0.2, 0.2, 0.2, 0.2],
        gamma: 1.0,
        gains: vec![0.5, 0.5, 1.0, 1.0],
    };
    Capture { local_tone: Some(Arc::new(local_tone)), ..flat_grey(layout, SIZE, 0.1) }
}

fn recipe() -> Recipe {
    Recipe { output: output(RgbSpace::SRGB.linear(), Bits::Float), ..Recipe::default() }
}

/// Light of two places of the picture, each a square of 8 pixels.
fn at(capture: &Capture, recipe: &Recipe, places: [(usize, usize); 2]) -> [f64; 2] {
    let picture = develop(capture, None, recipe);
    places.map(|(x, y)| mean(&picture, Rect { x, y, width: 8, height: 8 })[1])
}

#[test]
fn the_map_turns_with_the_picture_and_is_cut_with_it() {
    for layout in [filters("RGGB"), Layout::Rgb] {
        let capture = capture(layout);
        let off = Recipe { local_tone: LocalTone::Off, ..recipe() };
        let [left, right] = at(&capture, &off, [(20, 80), (212, 80)]);
        assert!((left / right - 1.0).abs() < 1e-3, "{left} {right}");
        let whole = right;
        let dark = |light: f64| light < 0.75 * whole;
        let bright = |light: f64| (light / whole - 1.0).abs() < 1e-3;
        let [left, right] = at(&capture, &recipe(), [(20, 80), (212, 80)]);
        assert!(dark(left) && bright(right), "{left} {right} of {whole}");
        let turned = |turn| Recipe { geometry: Geometry { turn, ..Geometry::default() }, ..recipe() };
        let [left, right] = at(&capture, &turned(Turn::Half), [(20, 80), (212, 80)]);
        assert!(bright(left) && dark(right), "{left} {right} of {whole}");
        let [top, bottom] = at(&capture, &turned(Turn::Right), [(80, 20), (80, 212)]);
        assert!(dark(top) && bright(bottom), "{top} {bottom} of {whole}");
        // By a map between pixels, too.
        let straightened =
            Recipe { geometry: Geometry { straighten: 2.0, ..Geometry::default() }, ..recipe() };
        let [left, right] = at(&capture, &straightened, [(20, 60), (180, 60)]);
        assert!(dark(left) && bright(right), "{left} {right} of {whole}");
        // The right half alone.
        let cut = Recipe { crop: Crop::Rect { x: 128, y: 0, width: 100, height: 100 }, ..recipe() };
        let [left, right] = at(&capture, &cut, [(40, 50), (80, 50)]);
        assert!(bright(left) && bright(right), "{left} {right} of {whole}");
    }
}

#[test]
fn looks_that_measure_leave_it_out() {
    let capture = capture(filters("RGGB"));
    for look in [Look::Linear, Look::Reproduction] {
        let [left, right] = at(&capture, &Recipe { look, ..recipe() }, [(20, 80), (212, 80)]);
        assert!((left / right - 1.0).abs() < 1e-3, "{look:?}: {left} {right}");
        let notes = plan(&capture, None, &Recipe { look, ..recipe() }).unwrap().notes;
        assert!(notes.contains(&"the file's local tone map is not applied".to_owned()), "{notes:?}");
    }
    let notes = plan(&capture, None, &recipe()).unwrap().notes;
    assert!(notes.contains(&"the file's local tone map is applied".to_owned()), "{notes:?}");
}

#[test]
fn tiles_regions_and_scales_agree() {
    let plan = plan(&capture(filters("RGGB")), None, &recipe()).unwrap();
    let whole = rendered(&plan);
    assert_eq!(whole, rendered_in_tiles(&plan, 37, 23));
    let rect = Rect { x: 90, y: 31, width: 60, height: 40 };
    let part = plan.render(View { scale: Scale::FULL, rect }, &Cancel::default()).unwrap();
    let inner = Rect { x: 10, y: 5, width: 30, height: 20 };
    let same = Rect { x: rect.x + inner.x, y: rect.y + inner.y, ..inner };
    assert_eq!(mean(&part, inner), mean(&whole, same));
    let quarter = Scale::halved(2).unwrap();
    let small = plan.render(plan.whole(quarter), &Cancel::default()).unwrap();
    for x in [4, 50] {
        let (small, large) = (
            mean(&small, Rect { x, y: 16, width: 4, height: 4 })[1],
            mean(&whole, Rect { x: 4 * x, y: 64, width: 16, height: 16 })[1],
        );
        assert!((small / large - 1.0).abs() < 5e-3, "{x}: {small} {large}");
    }
}
