//! Pictures that are made smaller: what they show and what they must not; and grids behind a lens.

use std::f64::consts::PI;

use darkroot_develop::{Crop, Geometry, Lens, OutputSpace, Recipe, Resize};
use darkroot_photo::correction::{Distortion, Projection, Warp};
use darkroot_photo::{Capture, Correction, Picture};
use darkroot_simulate::Exposure;
use darkroot_simulate::camera::filters;
use darkroot_tests::{camera, develop, flat_grey, measuring, pixels, with_light};

use crate::geometry::{SIZE, capture, developed};
use crate::perspective::straight;

/// As [`developed`], sharpened as people get it.
fn sharpened(capture: &Capture, geometry: Geometry) -> Picture {
    let mut recipe = Recipe { geometry, sharpen: Some(1.0), ..measuring() };
    recipe.output.space = OutputSpace::Camera;
    develop(capture, None, &recipe)
}

/// Swing of the zone plate about its mean.
const SWING: f64 = 0.35;

#[test]
fn of_a_zone_plate_is_left_what_the_smaller_picture_can_show_and_no_more() {
    // |x| / 300 periods a column and |y| / 300 a row at a distance from the middle: half a period a column at the sides.
    let plate = |x: f64, y: f64| 0.4 + SWING * (PI * (x * x + y * y) / 300.0).cos();
    let light = capture(|x, y| [plate(x - 150.0, y - 100.0); 3]);
    for share in [0.5, 0.37, 0.25] {
        let geometry = Geometry { resize: Resize::Share(share), ..Geometry::default() };
        let picture = developed(&light, Crop::Default, geometry);
        let (columns, rows) = (picture.size.width, picture.size.height);
        let (across, down) = (300.0 / columns as f64, 200.0 / rows as f64);
        let (mut shown, mut gone, mut aliases) = (0f64, 0f64, Vec::new());
        for (i, pixel) in pixels(&picture).iter().enumerate() {
            let (x, y) = (i % columns, i / columns);
            let at = [(x as f64 + 0.5) * across - 150.0, (y as f64 + 0.5) * down - 100.0];
            // Periods a pixel of the smaller picture along each axis, of which it shows up to a half.
            let most = (at[0].abs() * across / 300.0).max(at[1].abs() * down / 300.0);
            // At edges the frame goes on as it ends.
            let inside = x.min(columns - 1 - x).min(y.min(rows - 1 - y)) >= 4;
            if most < 0.33 {
                shown = shown.max((pixel[1] - plate(at[0], at[1])).abs());
            } else if most > 0.75 && inside {
                gone = gone.max((pixel[1] - 0.4).abs());
                aliases.push((pixel[1] - 0.4).powi(2));
            }
        }
        let rms = (aliases.iter().sum::<f64>() / aliases.len() as f64).sqrt();
        println!("{share}: {shown:.4} off what can be shown; of what cannot {gone:.4}, {rms:.4} in the mean");
        assert!(aliases.len() > 100);
        assert!(shown < 0.13 * SWING, "{share}: {shown}");
        assert!(gone < 0.04 * SWING && rms < 0.01 * SWING, "{share}: {gone} {rms}");
    }
}

#[test]
fn edges_have_no_halo_above_two_percent_sharpened_or_not() {
    let (dark, light) = (0.05, 0.8);
    // Slanted, so that every place between pixels occurs.
    let edge = capture(|x, y| [if x + 0.13 * y > 160.0 { light } else { dark }; 3]);
    for resize in [Resize::Share(0.5), Resize::Share(0.37), Resize::Long(100), Resize::Share(1.6)] {
        let geometry = Geometry { resize, ..Geometry::default() };
        for picture in [developed(&edge, Crop::Default, geometry), sharpened(&edge, geometry)] {
            let halo = pixels(&picture).iter().map(|p| (p[1] - light).max(dark - p[1])).fold(0.0, f64::max);
            assert!(halo < 0.02 * (light - dark), "{resize:?}: {halo}");
        }
    }
}

#[test]
fn the_mean_of_light_stays_whatever_is_asked() {
    // Columns and blocks of black and white: light is averaged, not its code.
    for (period, share) in [(2, 0.5), (3, 0.37), (5, 0.25), (2, 0.613)] {
        let bars = capture(|x, y| {
            [if (x as usize / period + y as usize / 7).is_multiple_of(2) { 0.9 } else { 0.02 }; 3]
        });
        let light = |picture: &Picture| {
            let all = pixels(picture);
            let size = picture.size;
            let inner = all.iter().enumerate().filter(|(i, _)| {
                let (x, y) = (i % size.width, i / size.width);
                x.min(size.width - 1 - x).min(y.min(size.height - 1 - y)) >= 5
            });
            let inner: Vec<f64> = inner.map(|(_, pixel)| pixel[1]).collect();
            inner.iter().sum::<f64>() / inner.len() as f64
        };
        let geometry = Geometry { resize: Resize::Share(share), ..Geometry::default() };
        let mean = light(&developed(&bars, Crop::Default, geometry));
        assert!((mean - 0.46).abs() < 0.01, "{period} {share}: {mean}");
    }
}

#[test]
fn a_grid_behind_a_lens_is_straight_and_its_colours_meet() {
    // A barrel of 3 % in the corners, red and blue pixels beside green, behind a mosaic.
    let planes = [[0.972, 0.0292, 0.0, 0.0], [0.97, 0.03, 0.0, 0.0], [0.9675, 0.0312, 0.0, 0.0]];
    let (centre, reach) = ([150.0, 100.0], 149.5f64.hypot(99.5));
    // Where a place of the frame lies after the correction: DNG 1.7, chapter 7, WarpRectilinear, the other way round.
    let corrected = |plane: [f64; 4], x: f64, y: f64| {
        let (dx, dy) = ((x - centre[0]) / reach, (y - centre[1]) / reach);
        let mut factor = 1.0;
        for _ in 0..30 {
            let square = (dx * dx + dy * dy) / (factor * factor);
            factor = plane[0] + plane[1] * square + plane[2] * square * square;
        }
        [centre[0] + reach * dx / factor, centre[1] + reach * dy / factor]
    };
    let neutral = camera(filters("RGGB")).neutral(&Exposure::default().light);
    let near = |w: f64| (-0.5 * (((w / 40.0) - (w / 40.0).round()) * 40.0 / 1.8).powi(2)).exp();
    for upright in [true, false] {
        let seen = |x: usize, y: usize| {
            [0, 1, 2].map(|c| {
                let at = corrected(planes[c], x as f64 + 0.5, y as f64 + 0.5);
                let light = 0.1 + 0.7 * near(at[usize::from(!upright)] - 10.0);
                (light * neutral[c]) as f32
            })
        };
        let mut grid = with_light(flat_grey(filters("RGGB"), SIZE, 0.5), seen);
        let planes = planes.map(|[a, b, c, d]| Distortion::from([a, b, c, d, 0.0, 0.0])).to_vec();
        grid.picture_corrections =
            vec![Correction::Warp(Warp { projection: Projection::Rectilinear, planes, centre: (0.5, 0.5) })];
        let geometry = Geometry { lens: Lens::File, ..Geometry::default() };
        let picture = developed(&grid, Crop::Default, geometry);
        for channel in 0..3 {
            let gap = straight(&picture, channel, upright);
            assert!((gap - 40.0).abs() < 0.1, "colour {channel}: {gap}");
        }
        // Without the correction it is not.
        let bent = developed(&grid, Crop::Default, Geometry { lens: Lens::Off, ..Geometry::default() });
        assert!(std::panic::catch_unwind(|| straight(&bent, 1, upright)).is_err());
    }
}
