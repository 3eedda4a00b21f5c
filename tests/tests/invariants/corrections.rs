//! The corrections that a DNG carries, seen in finished pictures: on a flat field each pixel has a known value.

use darkroot_colour::RgbSpace;
use darkroot_develop::{Bits, Geometry, Lens, Output, OutputSpace, Recipe};
use darkroot_photo::correction::{Area, GainMap, Projection, Vignette, Warp};
use darkroot_photo::{Capture, Correction, Layout, Rect, Size};
use darkroot_simulate::camera::filters;
use darkroot_tests::{flat_grey, layouts, measuring, output, pixels};

const SIZE: Size = Size { width: 70, height: 46 };
const LEVEL: f32 = 0.4;

/// Balanced camera RGB: what corrections act on.
fn sensor() -> Recipe {
    Recipe { output: Output { space: OutputSpace::Camera, bits: Bits::Float }, ..measuring() }
}

fn everywhere(planes: usize) -> Area {
    Area { rect: Rect::full(SIZE), plane: 0, planes, row_pitch: 1, column_pitch: 1 }
}

fn with(mosaic: Vec<Correction>, picture: Vec<Correction>, layout: Layout) -> Capture {
    Capture { mosaic_corrections: mosaic, picture_corrections: picture, ..flat_grey(layout, SIZE, LEVEL) }
}

/// Fails unless the developed grey has the expected share of the light at each pixel, however it is cut.
fn check(capture: &Capture, expected: impl Fn(usize, usize) -> f64, tolerance: f64, what: &str) {
    let plan = darkroot_tests::plan(capture, None, &sensor()).unwrap();
    let whole = darkroot_tests::rendered(&plan);
    for (columns, rows) in [(1, 46), (7, 5), (33, 17)] {
        assert!(
            darkroot_tests::rendered_in_tiles(&plan, columns, rows) == whole,
            "{what}: tiles of {columns} x {rows}"
        );
    }
    for (i, p) in pixels(&whole).iter().enumerate() {
        let (x, y) = (i % SIZE.width, i / SIZE.width);
        let right = expected(x, y) * f64::from(LEVEL);
        for v in p {
            assert!((v - right).abs() < tolerance, "{what} at {x},{y}: {p:?}, not {right}");
        }
    }
}

/// Every list and every kind of sensor that a correction can meet, with the samples a pixel.
fn places() -> Vec<(&'static str, Layout, bool, usize)> {
    let rgb = filters("RGGB");
    vec![
        ("before demosaicing", rgb.clone(), true, 1),
        ("before, linear RGB", Layout::Rgb, true, 3),
        ("after demosaicing", rgb, false, 3),
        ("after, linear RGB", Layout::Rgb, false, 3),
    ]
}

fn check_everywhere(
    correction: impl Fn(usize) -> Correction,
    expected: impl Fn(usize, usize) -> f64,
    tolerance: f64,
    what: &str,
) {
    for (place, layout, before, planes) in places() {
        let list = vec![correction(planes)];
        let (mosaic, picture) = if before { (list, vec![]) } else { (vec![], list) };
        let capture = with(mosaic, picture, layout);
        // What varies over the picture is interpolated before it is seen.
        let tolerance = if before && planes == 1 { tolerance } else { 1e-5 };
        check(&capture, &expected, tolerance, &format!("{what} {place}"));
    }
}

#[test]
fn a_polynomial_is_the_sum_of_its_powers() {
    // Linear in the sample, so that the balance between channels stays.
    check_everywhere(
        |planes| Correction::Polynomial(everywhere(planes), vec![0.0, 0.5]),
        |_, _| 0.5,
        1e-5,
        "half",
    );
    for (place, layout, before, planes) in places() {
        if before {
            continue;
        }
        let square = Correction::Polynomial(everywhere(planes), vec![0.1, 0.5, 0.25]);
        let level = f64::from(LEVEL);
        let value = (0.1 + 0.5 * level + 0.25 * level * level) / level;
        check(&with(vec![], vec![square], layout), |_, _| value, 1e-5, place);
    }
}

#[test]
fn vignetting_is_brightened_towards_the_corners() {
    let vignette = Vignette { coefficients: [0.3, 0.1, 0.0, 0.0, 0.05], centre: (0.4, 0.5) };
    let (w, h) = (SIZE.width as f64, SIZE.height as f64);
    let farthest = (0.6 * w).hypot(0.5 * h);
    let gain = |x: usize, y: usize| {
        let r2 = ((x as f64 + 0.5 - 0.4 * w).hypot(y as f64 + 0.5 - 0.5 * h) / farthest).powi(2);
        1.0 + 0.3 * r2 + 0.1 * r2 * r2 + 0.05 * r2.powi(5)
    };
    check_everywhere(|_| Correction::Vignette(vignette.clone()), gain, 4e-3, "vignette");
}

#[test]
fn a_gain_map_is_interpolated_between_its_points() {
    let map = GainMap {
        rows: 2,
        columns: 3,
        planes: 1,
        vertical: (0.0, 1.0),
        horizontal: (0.0, 0.5),
        gains: vec![1.0, 1.2, 1.6, 0.8, 1.0, 1.4],
    };
    let gain = |x: usize, y: usize| {
        let (u, v) = ((x as f64 + 0.5) / SIZE.width as f64, (y as f64 + 0.5) / SIZE.height as f64);
        let upper = if u < 0.5 { 1.0 + 0.4 * u } else { 1.2 + 0.8 * (u - 0.5) };
        upper - 0.2 * v
    };
    check_everywhere(|planes| Correction::Gain(everywhere(planes), map.clone()), gain, 4e-3, "gain map");
}

#[test]
fn scales_by_row_and_column_are_multiplied() {
    let rows: Vec<f32> = (0..SIZE.height).map(|y| 1.0 + y as f32 / 200.0).collect();
    let columns: Vec<f32> = (0..SIZE.width).map(|x| 1.5 - x as f32 / 200.0).collect();
    let row = |_: usize, y: usize| 1.0 + y as f64 / 200.0;
    let column = |x: usize, _: usize| 1.5 - x as f64 / 200.0;
    check_everywhere(|planes| Correction::RowScale(everywhere(planes), rows.clone()), row, 4e-3, "rows");
    check_everywhere(
        |planes| Correction::ColumnScale(everywhere(planes), columns.clone()),
        column,
        4e-3,
        "columns",
    );
}

#[test]
fn deltas_by_row_and_column_are_added() {
    // After demosaicing the channels are balanced, so that the same is added to each.
    let rows: Vec<f32> = (0..SIZE.height).map(|y| y as f32 / 1000.0).collect();
    let columns: Vec<f32> = (0..SIZE.width).map(|x| x as f32 / -2000.0).collect();
    let both =
        vec![Correction::RowDelta(everywhere(3), rows), Correction::ColumnDelta(everywhere(3), columns)];
    let light = f64::from(LEVEL);
    let expected = |x: usize, y: usize| 1.0 + (y as f64 / 1000.0 - x as f64 / 2000.0) / light;
    check(&with(vec![], both, filters("RGGB")), expected, 1e-5, "deltas");
}

#[test]
fn a_table_maps_sixteen_bit_values() {
    let halved: Vec<u16> = (0..=u16::MAX).map(|i| i / 2).collect();
    for (place, layout, before, planes) in places() {
        let list = vec![Correction::Table(everywhere(planes), halved.clone())];
        let (mosaic, picture) = if before { (list, vec![]) } else { (vec![], list) };
        check(&with(mosaic, picture, layout), |_, _| 0.5, 1e-4, place);
    }
}

#[test]
fn a_correction_touches_only_its_rectangle_its_plane_and_its_pitch() {
    let half = |area| Correction::Polynomial(area, vec![0.0, 0.5]);
    let inner = Rect { x: 11, y: 9, width: 30, height: 20 };
    let inside = |x: usize, y: usize| (11..41).contains(&x) && (9..29).contains(&y);
    let capture = with(vec![], vec![half(Area { rect: inner, ..everywhere(3) })], filters("RGGB"));
    check(&capture, |x, y| if inside(x, y) { 0.5 } else { 1.0 }, 1e-5, "rectangle");

    let area = Area { rect: inner, plane: 1, planes: 1, row_pitch: 2, column_pitch: 3 };
    let capture = with(vec![], vec![half(area)], Layout::Rgb);
    let picture =
        pixels(&darkroot_tests::rendered(&darkroot_tests::plan(&capture, None, &sensor()).unwrap()));
    for (i, p) in picture.iter().enumerate() {
        let (x, y) = (i % SIZE.width, i / SIZE.width);
        let hit = inside(x, y) && (x - 11).is_multiple_of(3) && (y - 9).is_multiple_of(2);
        let share = |v: f64| v / f64::from(LEVEL);
        assert!((share(p[0]) - 1.0).abs() < 1e-5 && (share(p[2]) - 1.0).abs() < 1e-5, "{x},{y}: {p:?}");
        assert!((share(p[1]) - if hit { 0.5 } else { 1.0 }).abs() < 1e-5, "{x},{y}: {p:?}");
    }
}

#[test]
fn corrections_are_made_in_the_order_of_their_list() {
    let add = Correction::Polynomial(everywhere(3), vec![0.1, 1.0]);
    let double = Correction::Polynomial(everywhere(3), vec![0.0, 2.0]);
    let light = f64::from(LEVEL);
    let both = with(vec![], vec![add.clone(), double.clone()], filters("RGGB"));
    check(&both, |_, _| 2.0 * (light + 0.1) / light, 1e-5, "add, then double");
    let both = with(vec![], vec![double, add], filters("RGGB"));
    check(&both, |_, _| (2.0 * light + 0.1) / light, 1e-5, "double, then add");
}

#[test]
fn places_count_from_the_active_area() {
    for (name, layout) in layouts() {
        let mut capture = flat_grey(layout, SIZE, LEVEL);
        let area = Rect { x: 6, y: 12, width: 60, height: 30 };
        (capture.active_area, capture.default_crop) = (area, area);
        let rect = Rect { x: 0, y: 0, width: 30, height: 30 };
        capture.picture_corrections =
            vec![Correction::Polynomial(Area { rect, ..everywhere(3) }, vec![0.0, 0.5])];
        let picture =
            pixels(&darkroot_tests::rendered(&darkroot_tests::plan(&capture, None, &sensor()).unwrap()));
        for (i, p) in picture.iter().enumerate() {
            let right = f64::from(LEVEL) * if i % 60 < 30 { 0.5 } else { 1.0 };
            assert!(p.iter().all(|v| (v - right).abs() < 1e-4), "{name} at {}: {p:?}", i % 60);
        }
    }
}

#[test]
fn what_is_not_applied_is_said() {
    let projection = Projection::Rectilinear;
    let planes = vec![[1.0, 0.1, 0.0, 0.0, 0.0, 0.0].into()];
    let warp = Correction::Warp(Warp { projection, planes, centre: (0.5, 0.5) });
    let warped = with(vec![], vec![warp], filters("RGGB"));
    let geometry = Geometry { lens: Lens::Off, ..Geometry::default() };
    let recipe = Recipe { geometry, output: output(RgbSpace::SRGB, Bits::Eight), ..Recipe::default() };
    let plan = darkroot_tests::plan(&warped, None, &recipe).unwrap();
    assert!(
        plan.notes.iter().any(|note| note.contains("correction of the lens is not applied")),
        "{:?}",
        plan.notes
    );
    let plain = flat_grey(filters("RGGB"), SIZE, LEVEL);
    let expected = darkroot_tests::plan(&plain, None, &recipe).unwrap();
    assert!(expected.notes.is_empty());
    assert!(darkroot_tests::rendered(&plan) == darkroot_tests::rendered(&expected));
}

#[test]
fn what_is_corrected_is_said() {
    let still = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let (larger, bent) = ([1.001, 0.0, 0.0, 0.0, 0.0, 0.0], [1.0, 0.1, 0.0, 0.0, 0.0, 0.0]);
    for (planes, words) in [
        (vec![bent], "(distortion)"),
        (vec![bent, bent, bent], "(distortion)"),
        (vec![larger, still, larger], "(lateral chromatic aberration)"),
        (vec![larger, bent, bent], "(distortion and lateral chromatic aberration)"),
    ] {
        let planes = planes.into_iter().map(Into::into).collect();
        let warp = Warp { projection: Projection::Rectilinear, planes, centre: (0.5, 0.5) };
        let warped = with(vec![], vec![Correction::Warp(warp)], filters("RGGB"));
        let geometry = Geometry { lens: Lens::File, ..Geometry::default() };
        let plan = darkroot_tests::plan(&warped, None, &Recipe { geometry, ..Recipe::default() }).unwrap();
        assert!(plan.notes.iter().any(|note| note.contains(words)), "{words}: {:?}", plan.notes);
    }
}
