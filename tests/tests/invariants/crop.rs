//! A crop is a part of the whole; borders and odd areas do not shift the filter array.

use darkroot_colour::RgbSpace;
use darkroot_develop::{Bits, Crop, Recipe};
use darkroot_photo::{Capture, Orientation, Rect, Size};
use darkroot_simulate::expose::expose;
use darkroot_simulate::{Camera, Exposure, Scene};
use darkroot_tests::{camera, develop, exact, layouts, measuring, output, pixels};

const SIZE: Size = Size { width: 91, height: 63 };

#[test]
fn the_default_crop_is_the_same_region_of_the_active_area() {
    for (name, layout) in layouts() {
        for exif in [1, 3, 6] {
            let orientation = Orientation::from_exif(exif);
            let camera = Camera { masked: (5, 3), ..camera(layout.clone()) };
            let exposure = Exposure { stops: 1.5, noise: Some(2), orientation, ..Exposure::default() };
            let scene = Scene::still_life(orientation.applied_to(SIZE));
            let mut capture = expose(&scene, &camera, &exposure);
            let area = capture.active_area;
            let crop = Rect { x: area.x + 7, y: area.y + 4, width: 61, height: 45 };
            capture.default_crop = crop;
            let at = |crop| {
                develop(
                    &capture,
                    None,
                    &Recipe { crop, output: output(RgbSpace::SRGB, Bits::Sixteen), ..Recipe::default() },
                )
            };
            let (whole, part) = (at(Crop::Active), at(Crop::Default));
            assert_eq!(part.size, orientation.applied_to(crop.size()));
            assert_eq!(whole.size, orientation.applied_to(area.size()));
            let (x0, y0) = orientation.place(crop.x - area.x, crop.y - area.y, area.size());
            let (x1, y1) =
                orientation.place(crop.right() - 1 - area.x, crop.bottom() - 1 - area.y, area.size());
            let (left, top) = (x0.min(x1), y0.min(y1));
            let (all, part_pixels) = (pixels(&whole), pixels(&part));
            for (y, row) in part_pixels.chunks_exact(part.size.width).enumerate() {
                let same = &all[(top + y) * whole.size.width + left..][..row.len()];
                assert!(row == same, "{name}, orientation {exif}, row {y}");
            }
        }
    }
}

/// Mean difference of two pictures of the same scene, as a share of its mean.
fn difference(one: &Capture, two: &Capture) -> f64 {
    let (one, two) = (develop(one, None, &measuring()), develop(two, None, &measuring()));
    assert_eq!(one.size, two.size);
    let (one, two) = (pixels(&one), pixels(&two));
    let sum: f64 = one.iter().flatten().zip(two.iter().flatten()).map(|(a, b)| (a - b).abs()).sum();
    sum / one.iter().flatten().sum::<f64>()
}

#[test]
fn a_masked_border_of_any_size_does_not_change_the_colours() {
    let scene = Scene::gradient(SIZE);
    for (name, layout) in layouts() {
        let bare = exact(&scene, &camera(layout.clone()), &Exposure::default());
        for masked in [(1, 0), (0, 1), (1, 1), (2, 3), (5, 4)] {
            let camera = Camera { masked, ..camera(layout.clone()) };
            let bordered = exact(&scene, &camera, &Exposure::default());
            assert_eq!((bordered.active_area.x, bordered.active_area.y), masked);
            // The other phase of the array interpolates a little differently; a shifted one would swap colours.
            let difference = difference(&bare, &bordered);
            assert!(difference < 0.005, "{name}, border {masked:?}: {difference}");
        }
    }
}

#[test]
fn a_masked_border_does_not_shine_into_the_picture() {
    for (name, layout) in layouts() {
        let camera = Camera { masked: (4, 6), ..camera(layout) };
        let capture = exact(&Scene::gradient(SIZE), &camera, &Exposure::default());
        let mut lit = capture.clone();
        let darkroot_photo::Counts::F32(mosaic) = &mut lit.counts else {
            panic!("exact captures are floating-point")
        };
        let planes = mosaic.layout.planes();
        let row = mosaic.size.width * planes;
        for (i, v) in mosaic.samples.iter_mut().enumerate() {
            if i / row < 6 || i % row < 4 * planes {
                *v = 0.9;
            }
        }
        assert!(develop(&capture, None, &measuring()) == develop(&lit, None, &measuring()), "{name}");
    }
}

#[test]
fn a_capture_of_any_small_size_develops() {
    for (name, layout) in layouts() {
        for (width, height) in [(1, 1), (2, 1), (1, 2), (2, 2), (3, 2), (1, 40), (40, 1), (5, 7), (12, 13)] {
            let size = Size { width, height };
            let capture = expose(&Scene::gradient(size), &camera(layout.clone()), &Exposure::default());
            let picture = develop(&capture, None, &measuring());
            assert_eq!(picture.size, size, "{name}");
            assert!(pixels(&picture).iter().flatten().all(|v| v.is_finite()), "{name} {width} x {height}");
        }
    }
}
