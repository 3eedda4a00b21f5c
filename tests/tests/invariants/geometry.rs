//! Where things stand in a picture that was cropped, turned, straightened, freed of its lens or made smaller.

use darkroot_develop::{
    Cancel, Crop, Flip, Geometry, Lens, Marks, Perspective, Recipe, Resize, Scale, Turn, View,
};
use darkroot_lens::Corrections;
use darkroot_photo::correction::{Distortion, Projection, Warp};
use darkroot_photo::{Capture, Correction, Layout, Orientation, Picture, Rect, Size};
use darkroot_simulate::camera::filters;
use darkroot_simulate::{Exposure, Scene};
use darkroot_tests::{
    camera, develop, exact, flat_grey, measuring, pixels, plan, rendered, rendered_in_tiles, with_light,
};

pub(crate) const SIZE: Size = Size { width: 300, height: 200 };

/// What lies in a column and row of the frame, the middle of the first pixel being (0.5, 0.5): even waves.
fn waves(x: f64, y: f64) -> [f64; 3] {
    [
        0.3 + 0.1 * (x / 9.0).sin() + 0.08 * (y / 7.0).cos(),
        0.4 + 0.1 * (x / 11.0).cos(),
        0.3 + 0.15 * (y / 8.0).sin(),
    ]
}

/// A capture of something, whose camera sees linear sRGB.
pub(crate) fn capture(light: impl Fn(f64, f64) -> [f64; 3]) -> Capture {
    let neutral = camera(Layout::Rgb).neutral(&Exposure::default().light);
    let seen = |x: usize, y: usize| {
        let light = light(x as f64 + 0.5, y as f64 + 0.5);
        [0, 1, 2].map(|c| (light[c] * neutral[c]) as f32)
    };
    with_light(flat_grey(Layout::Rgb, SIZE, 0.5), seen)
}

/// The picture in balanced camera RGB, which needs no profile.
pub(crate) fn developed(capture: &Capture, crop: Crop, geometry: Geometry) -> Picture {
    let mut recipe = Recipe { crop, geometry, ..measuring() };
    recipe.output.space = darkroot_develop::OutputSpace::Camera;
    develop(capture, None, &recipe)
}

/// Fails unless every pixel of a picture shows what lies where `place` says, for each of red, green and blue.
fn shows(picture: &Picture, what: &str, place: impl Fn(usize, f64, f64) -> [f64; 2]) {
    for (i, pixel) in pixels(picture).iter().enumerate() {
        let (x, y) = (i % picture.size.width, i / picture.size.width);
        for (c, seen) in pixel.iter().enumerate() {
            let [u, v] = place(c, x as f64 + 0.5, y as f64 + 0.5);
            let edge = 4.0;
            if u < edge || v < edge || u > SIZE.width as f64 - edge || v > SIZE.height as f64 - edge {
                continue;
            }
            let truth = waves(u, v)[c];
            assert!((seen - truth).abs() < 1.5e-3, "{what} at {x} {y}, colour {c}: {seen} for {truth}");
        }
    }
}

fn of_corners(corners: [[f64; 2]; 4]) -> Option<Perspective> {
    Some(Perspective { by: Marks::Corners(corners), shares: false })
}

fn turned(degrees: f64, [x, y]: [f64; 2], about: [f64; 2]) -> [f64; 2] {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let (dx, dy) = (x - about[0], y - about[1]);
    [about[0] + cos * dx - sin * dy, about[1] + sin * dx + cos * dy]
}

#[test]
fn a_straightened_picture_shows_what_lies_there_and_nothing_else() {
    let middle = [SIZE.width as f64 / 2.0, SIZE.height as f64 / 2.0];
    for degrees in [-20.0, -1.3, 0.2, 3.0, 45.0] {
        let geometry = Geometry { straighten: degrees, ..Geometry::default() };
        let picture = developed(&capture(waves), Crop::Default, geometry);
        let (width, height) = (picture.size.width as f64, picture.size.height as f64);
        assert!((width / height - 1.5).abs() < 0.02, "{width} {height}");
        let place = |_, x: f64, y: f64| {
            turned(-degrees, [x + middle[0] - width / 2.0, y + middle[1] - height / 2.0], middle)
        };
        shows(&picture, &format!("{degrees} degrees"), place);
        // All four corners lie in the frame, and one touches its edge.
        let corners = [[0.0, 0.0], [width, 0.0], [0.0, height], [width, height]].map(|[x, y]| place(0, x, y));
        let out = |[x, y]: [f64; 2]| (-x).max(-y).max(x - SIZE.width as f64).max(y - SIZE.height as f64);
        let farthest = corners.into_iter().map(out).fold(f64::MIN, f64::max);
        assert!((-1.5..1e-6).contains(&farthest), "{degrees}: {farthest}");
    }
}

#[test]
fn what_the_lens_did_is_undone_as_the_file_says() {
    let planes = [
        [0.985, 0.03, -0.01, 0.002, 0.001, -0.0005],
        [0.98, 0.035, -0.012, 0.001, 0.001, -0.0005],
        [0.975, 0.04, -0.012, 0.001, 0.001, -0.0005],
    ];
    let mut capture = capture(waves);
    let warp = Warp {
        projection: Projection::Rectilinear,
        planes: planes.iter().map(|p| Distortion::from(*p)).collect(),
        centre: (0.48, 0.53),
    };
    capture.picture_corrections = vec![Correction::Warp(warp)];
    let geometry = Geometry { lens: Lens::File, ..Geometry::default() };
    let picture = developed(&capture, Crop::Default, geometry);
    assert_eq!(picture.size, SIZE);
    // DNG 1.7, chapter 7, WarpRectilinear.
    let centre = [0.5 + 0.48 * 299.0, 0.5 + 0.53 * 199.0];
    let reach = (0.52f64 * 299.0).hypot(0.53 * 199.0);
    shows(&picture, "lens", |c, x, y| {
        let [k0, k1, k2, k3, t0, t1] = planes[c];
        let (dx, dy) = ((x - centre[0]) / reach, (y - centre[1]) / reach);
        let r2 = dx * dx + dy * dy;
        let f = k0 + k1 * r2 + k2 * r2 * r2 + k3 * r2 * r2 * r2;
        [
            centre[0] + reach * (f * dx + t0 * 2.0 * dx * dy + t1 * (r2 + 2.0 * dx * dx)),
            centre[1] + reach * (f * dy + t1 * 2.0 * dx * dy + t0 * (r2 + 2.0 * dy * dy)),
        ]
    });
    let off = developed(&capture, Crop::Default, Geometry { lens: Lens::Off, ..Geometry::default() });
    shows(&off, "off", |_, x, y| [x, y]);
    // Nobody who measures gets it unasked.
    assert!(developed(&capture, Crop::Default, Geometry::default()) == off);
}

#[test]
fn what_newer_files_say_of_the_lens_is_undone() {
    // Odd powers, and a radius from which on nothing more is said.
    let mut radial = [0.0; 15];
    (radial[0], radial[1], radial[3], radial[14]) = (0.97, 0.02, -0.015, 0.01);
    let plane = Distortion { radial, tangential: [0.001, -0.002], valid: [0.05, 0.8] };
    let reach = (0.5f64 * 299.0).hypot(0.5 * 199.0);
    for (projection, name) in
        [(Projection::Rectilinear, "factor"), (Projection::RectilinearInverse, "inverse")]
    {
        let plane = match projection {
            Projection::RectilinearInverse => Distortion { radial: radial.map(|k| 1.04 * k), ..plane },
            _ => plane,
        };
        let mut capture = capture(waves);
        let warp = Warp { projection, planes: vec![plane], centre: (0.5, 0.5) };
        capture.picture_corrections = vec![Correction::Warp(warp)];
        let picture =
            developed(&capture, Crop::Default, Geometry { lens: Lens::File, ..Geometry::default() });
        // DNG 1.7, chapter 7, WarpRectilinear2.
        shows(&picture, name, |_, x, y| {
            let (dx, dy) = ((x - 150.0) / reach, (y - 100.0) / reach);
            let r = dx.hypot(dy).clamp(0.05, 0.8);
            let sum: f64 = (0..15).map(|i| plane.radial[i] * r.powi(i as i32)).sum();
            let f = if name == "inverse" { 1.0 / sum } else { sum };
            let r2 = dx * dx + dy * dy;
            let [t0, t1] = plane.tangential;
            [
                150.0 + reach * (f * dx + t0 * 2.0 * dx * dy + t1 * (r2 + 2.0 * dx * dx)),
                100.0 + reach * (f * dy + t1 * 2.0 * dx * dy + t0 * (r2 + 2.0 * dy * dy)),
            ]
        });
    }
}

#[test]
fn a_fisheye_is_straightened() {
    let mut capture = capture(waves);
    let coefficients = [1.0, 0.12, -0.02, 0.01, 0.0, 0.0];
    let warp =
        Warp { projection: Projection::Fisheye, planes: vec![coefficients.into()], centre: (0.5, 0.5) };
    capture.picture_corrections = vec![Correction::Warp(warp)];
    let picture = developed(&capture, Crop::Default, Geometry { lens: Lens::File, ..Geometry::default() });
    let reach = (0.5f64 * 299.0).hypot(0.5 * 199.0);
    shows(&picture, "fisheye", |_, x, y| {
        let (dx, dy) = ((x - 150.0) / reach, (y - 100.0) / reach);
        let r = dx.hypot(dy).max(1e-12);
        let a = r.atan();
        let [k0, k1, k2, k3, ..] = coefficients;
        let f = (k0 * a + k1 * a.powi(3) + k2 * a.powi(5) + k3 * a.powi(7)) / r;
        [150.0 + reach * f * dx, 100.0 + reach * f * dy]
    });
}

#[test]
fn what_lensfun_knows_of_the_lens_is_undone() {
    let shot = darkroot_lens::Shot {
        lens_model: Some("EF-S18-55mm f/3.5-5.6 IS"),
        aperture: Some(3.5),
        ..darkroot_lens::Shot::new("Canon", "Canon EOS 550D", 18.0)
    };
    let known = darkroot_lens::find(&shot).unwrap().corrections((SIZE.width, SIZE.height));
    assert!(known.has_distortion() && known.has_tca() && known.has_vignetting());
    // As this lens draws the waves: darker towards the corners.
    let dark = capture(|x, y| {
        let gain = known.gain(x - 150.0, y - 100.0);
        waves(x, y).map(|v| v / gain)
    });
    let asked = Geometry { lens: Lens::Lensfun, known: Some(known), ..Geometry::default() };
    // All of the picture comes from the frame, and it is as large as that allows: about the middle some zoom fits all.
    let place = |known: &Corrections, zoom: f64, c: usize, x: f64, y: f64| {
        let (u, v) = known.place(zoom * (x - 150.0), zoom * (y - 100.0))[c];
        [150.0 + u, 100.0 + v]
    };
    let zoom_of = |known: &Corrections| {
        let border = (0..=300).flat_map(|i| {
            let along = f64::from(i);
            [[along, 0.0], [along, 200.0], [0.0, along / 1.5], [300.0, along / 1.5]]
        });
        let whole = |zoom: f64| {
            border.clone().all(|[x, y]| {
                (0..3).all(|c| {
                    let [u, v] = place(known, zoom, c, x, y);
                    (0.0..=300.0).contains(&u) && (0.0..=200.0).contains(&v)
                })
            })
        };
        (0..10_000).map(|i| 1.5 - f64::from(i) * 1e-4).find(|&zoom| whole(zoom)).unwrap()
    };
    let zoom = zoom_of(&known);
    assert!(zoom < 1.0, "{zoom}");
    let picture = developed(&dark, Crop::Default, asked);
    assert_eq!(picture.size, SIZE);
    shows(&picture, "lensfun", |c, x, y| place(&known, zoom, c, x, y));
    // Parts of it can be left.
    let kept = Geometry { keep_vignetting: true, keep_fringes: true, ..asked };
    let (green, plain) = (known.without_tca(), developed(&capture(waves), Crop::Default, kept));
    let zoom = zoom_of(&green);
    shows(&plain, "green", |c, x, y| place(&green, zoom, c, x, y));
    // The file's own correction goes first.
    let mut with_own = dark;
    let planes = vec![[0.97, 0.03, 0.0, 0.0, 0.0, 0.0].into()];
    let own = Warp { projection: Projection::Rectilinear, planes, centre: (0.5, 0.5) };
    with_own.picture_corrections = vec![Correction::Warp(own)];
    let file = Geometry { lens: Lens::File, ..Geometry::default() };
    assert!(developed(&with_own, Crop::Default, asked) == developed(&with_own, Crop::Default, file));
}

#[test]
fn four_corners_become_a_rectangle() {
    let corners = [[60.0, 40.0], [240.0, 25.0], [250.0, 170.0], [50.0, 160.0]];
    let geometry = Geometry { perspective: of_corners(corners), ..Geometry::default() };
    // Bright lines along the sides of the quadrangle.
    let near = |x: f64, y: f64| {
        let of_side = |i: usize| {
            let (a, b) = (corners[i], corners[(i + 1) % 4]);
            let length = (b[0] - a[0]).hypot(b[1] - a[1]);
            (((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])) / length).abs()
        };
        (0..4).map(of_side).fold(f64::MAX, f64::min)
    };
    let lines = capture(|x, y| [0.1 + 0.8 * (-0.5 * (near(x, y) / 1.5).powi(2)).exp(); 3]);
    let picture = developed(&lines, Crop::Default, geometry);
    let all = pixels(&picture);
    // Whole columns and rows are bright, and the rest is dark: lines stand upright and lie level.
    let (width, height) = (picture.size.width, picture.size.height);
    let column = |x: usize| (0..height).map(|y| all[y * width + x][1]).fold(f64::MAX, f64::min);
    let row = |y: usize| (0..width).map(|x| all[y * width + x][1]).fold(f64::MAX, f64::min);
    let bright = |n: usize, least: &dyn Fn(usize) -> f64| (0..n).filter(|&i| least(i) > 0.5).count();
    let found = (bright(width, &column), bright(height, &row));
    assert!(found.0 >= 2 && found.1 >= 2, "{found:?} of {width} x {height}");
}

#[test]
fn crops_and_turns_of_whole_pixels_are_those_pixels() {
    let scene = Scene::still_life(Size { width: 62, height: 41 });
    let mut capture = exact(&scene, &camera(filters("GRBG")), &Exposure::default());
    for orientation in [Orientation::Upright, Orientation::Rotate270, Orientation::Transverse] {
        capture.orientation = orientation;
        let whole = develop(&capture, None, &Recipe::default());
        let (all, size) = (pixels(&whole), whole.size);
        let of = |crop, geometry| develop(&capture, None, &Recipe { crop, geometry, ..Recipe::default() });
        let rect = Rect { x: 5, y: 3, width: 21, height: 30 };
        let crop = Crop::Rect { x: rect.x, y: rect.y, width: rect.width, height: rect.height };
        let part = of(crop, Geometry::default());
        assert_eq!(part.size, rect.size());
        for (i, pixel) in pixels(&part).iter().enumerate() {
            assert_eq!(*pixel, all[(i / 21 + 3) * size.width + i % 21 + 5]);
        }
        for (turn, flip) in
            [(Turn::Right, Flip::None), (Turn::Left, Flip::Horizontal), (Turn::Half, Flip::Vertical)]
        {
            let turned = of(Crop::Default, Geometry { turn, flip, ..Geometry::default() });
            for (i, pixel) in pixels(&turned).iter().enumerate() {
                let (mut x, mut y) = (i % turned.size.width, i / turned.size.width);
                match flip {
                    Flip::None => {}
                    Flip::Horizontal => x = turned.size.width - 1 - x,
                    Flip::Vertical => y = turned.size.height - 1 - y,
                }
                let (u, v) = match turn {
                    Turn::None => (x, y),
                    Turn::Right => (y, size.height - 1 - x),
                    Turn::Half => (size.width - 1 - x, size.height - 1 - y),
                    Turn::Left => (size.width - 1 - y, x),
                };
                assert_eq!(*pixel, all[v * size.width + u], "{orientation:?} {turn:?} {flip:?}");
            }
        }
        let square = of(Crop::Aspect(1.0), Geometry::default()).size;
        assert_eq!(square, Size { width: 41, height: 41 });
        assert_eq!(of(Crop::Share(0.5), Geometry::default()).size.width, size.width.div_ceil(2));
    }
}

#[test]
fn tiles_and_views_of_a_mapped_picture_are_parts_of_it() {
    let scene = Scene::still_life(Size { width: 230, height: 150 });
    let mut capture = exact(&scene, &camera(filters("RGGB")), &Exposure::default());
    capture.orientation = Orientation::Rotate90;
    let warp = Warp {
        projection: Projection::Rectilinear,
        planes: vec![
            [0.99, 0.02, 0.0, 0.0, 0.0, 0.0].into(),
            [0.99, 0.021, 0.0, 0.0, 0.0, 0.0].into(),
            [0.99, 0.022, 0.0, 0.0, 0.0, 0.0].into(),
        ],
        centre: (0.5, 0.5),
    };
    capture.picture_corrections = vec![Correction::Warp(warp)];
    for (straighten, resize) in [(2.5, Resize::None), (0.0, Resize::Share(0.4)), (-1.0, Resize::Share(1.7))] {
        let geometry = Geometry { straighten, resize, ..Geometry::default() };
        let plan = plan(&capture, None, &Recipe { geometry, ..Recipe::default() }).unwrap();
        let whole = rendered(&plan);
        for (columns, rows) in [(31, 17), (7, 200), (1000, 5)] {
            assert!(rendered_in_tiles(&plan, columns, rows) == whole, "{straighten} {columns} {rows}");
        }
        let rect = Rect { x: 9, y: 11, width: 40, height: 23 };
        let view = plan.render(View { scale: Scale::FULL, rect }, &Cancel::default()).unwrap();
        let all = pixels(&whole);
        for (i, pixel) in pixels(&view).iter().enumerate() {
            assert_eq!(*pixel, all[(i / 40 + 11) * whole.size.width + i % 40 + 9]);
        }
        for scale in [Scale::HALF, Scale::QUARTER] {
            let small = plan.render(plan.whole(scale), &Cancel::default()).unwrap();
            assert_eq!(small.size, scale.of(whole.size));
        }
    }
}

#[test]
fn a_smaller_picture_has_the_mean_light_and_no_false_detail() {
    let half = Geometry { resize: Resize::Share(0.5), ..Geometry::default() };
    // Black and white columns and rows of one pixel: a grey of half the light.
    let checks = capture(|x, y| [if (x as usize + y as usize).is_multiple_of(2) { 0.8 } else { 0.0 }; 3]);
    let picture = developed(&checks, Crop::Default, half);
    assert_eq!(picture.size, Size { width: 150, height: 100 });
    for pixel in pixels(&picture).iter().skip(150 * 10).take(150 * 80) {
        assert!((pixel[1] - 0.4).abs() < 0.02, "{pixel:?}");
    }
    // Waves that the small picture cannot show are gone; those that it can are there.
    for (period, resize, least, most) in [
        (3.0, Resize::Share(0.5), 0.0, 0.06),
        (3.4, Resize::Long(130), 0.0, 0.04),
        (9.0, Resize::Long(150), 0.85, 1.01),
    ] {
        let wave = capture(|x, _| [0.4 + 0.3 * (std::f64::consts::TAU * x / period).sin(); 3]);
        let picture = developed(&wave, Crop::Default, Geometry { resize, ..Geometry::default() });
        let width = picture.size.width;
        let row: Vec<f64> = pixels(&picture)[50 * width + 8..51 * width - 8].iter().map(|p| p[1]).collect();
        let swing = row.iter().fold(f64::MIN, |a, &b| a.max(b)) - row.iter().fold(f64::MAX, |a, &b| a.min(b));
        assert!((least..most).contains(&(swing / 0.6)), "{period}: {}", swing / 0.6);
    }
}

#[test]
fn edges_of_a_mapped_picture_have_no_rims() {
    let edge = capture(|x, _| [if x > 150.2 { 0.8 } else { 0.05 }; 3]);
    for (straighten, resize) in [(3.0, Resize::None), (0.0, Resize::Share(0.37)), (0.0, Resize::Share(2.0))] {
        let picture = developed(&edge, Crop::Default, Geometry { straighten, resize, ..Geometry::default() });
        for pixel in pixels(&picture) {
            assert!((0.0499..0.8001).contains(&pixel[1]), "{pixel:?}");
        }
    }
}

#[test]
fn frames_that_cannot_be_are_refused_in_words() {
    let capture = capture(waves);
    let geometry = |geometry| Recipe { geometry, ..measuring() };
    let crop = |x, y, width, height| Recipe { crop: Crop::Rect { x, y, width, height }, ..measuring() };
    let crossed = [[0.0, 0.0], [10.0, 10.0], [10.0, 0.0], [0.0, 10.0]];
    let wrong = [
        (geometry(Geometry { straighten: 46.0, ..Geometry::default() }), "45 degrees"),
        (geometry(Geometry { straighten: f64::NAN, ..Geometry::default() }), "45 degrees"),
        (geometry(Geometry { perspective: of_corners(crossed), ..Geometry::default() }), "convex"),
        (geometry(Geometry { resize: Resize::Share(1000.0), ..Geometry::default() }), "65500"),
        (geometry(Geometry { resize: Resize::Megapixels(f64::NAN), ..Geometry::default() }), "65500"),
        (crop(0, 0, 301, 10), "not inside"),
        (crop(usize::MAX, 0, 2, 10), "not inside"),
        (crop(0, 0, 0, 10), "not inside"),
        (Recipe { crop: Crop::Aspect(1e6), ..measuring() }, "nothing is left"),
        (
            Recipe { geometry: Geometry { straighten: 10.0, ..Geometry::default() }, ..crop(0, 0, 300, 200) },
            "corner",
        ),
    ];
    for (recipe, words) in wrong {
        let Err(said) = plan(&capture, None, &recipe) else { panic!("not refused: {words}") };
        let said = said.to_string();
        assert!(said.contains(words), "{said}");
    }
}
