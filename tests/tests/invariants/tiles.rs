//! The picture does not depend on the number of threads or on the tiles (architecture, invariant 3).

use darkroot_colour::RgbSpace;
use darkroot_develop::{Balance, Bits, Crop, Demosaic, Exposure as Brightness, Highlights, Look, Recipe};
use darkroot_photo::{Capture, Layout, Orientation, Picture, Size};
use darkroot_profile::Profile;
use darkroot_simulate::expose::expose;
use darkroot_simulate::{Camera, Exposure, Scene};
use darkroot_tests::{bent_profile, camera, layouts, output};

/// Odd, so that no tile and no filter array fits.
const SIZE: Size = Size { width: 53, height: 37 };
const BITS: [Bits; 3] = [Bits::Eight, Bits::Sixteen, Bits::Float];
const LOOKS: [Look; 4] = [Look::Neutral, Look::Vivid, Look::Flat, Look::Linear];
const HIGHLIGHTS: [Highlights; 3] = [Highlights::Rebuild, Highlights::Clip, Highlights::Keep];

/// A bright and noisy picture of which a part clips.
fn capture(layout: Layout, orientation: Orientation) -> Capture {
    let camera = Camera { masked: (3, 1), ..camera(layout) };
    let exposure = Exposure { stops: 1.5, noise: Some(5), falloff: 0.3, orientation, ..Exposure::default() };
    expose(&Scene::still_life(orientation.applied_to(SIZE)), &camera, &exposure)
}

/// Fails unless every way to cut the work gives the same bits.
fn check(
    capture: &Capture,
    profile: Option<&Profile>,
    recipe: &Recipe,
    tiles: &[(usize, usize)],
    what: &str,
) {
    let in_pool = |threads: usize, columns: usize, rows: usize| -> Picture {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            darkroot_tests::rendered_in_tiles(
                &darkroot_tests::plan(capture, profile, recipe).unwrap(),
                columns,
                rows,
            )
        })
    };
    let whole = in_pool(1, SIZE.width, SIZE.width);
    for (i, &(columns, rows)) in tiles.iter().enumerate() {
        let threads = 1 + (i + 1) % 3;
        let cut = in_pool(threads, columns, rows);
        assert!(cut == whole, "{what}: {columns} x {rows} with {threads} threads");
    }
    let usual = darkroot_tests::rendered(&darkroot_tests::plan(capture, profile, recipe).unwrap());
    assert!(usual == whole, "{what}: rendered as always");
}

#[test]
fn every_sensor_in_every_orientation_gives_the_same_bits_in_any_tiles() {
    for (i, (name, layout)) in layouts().into_iter().chain([("grey", Layout::Monochrome)]).enumerate() {
        for exif in 1..=8 {
            let capture = capture(layout.clone(), Orientation::from_exif(exif as u32));
            let recipe = Recipe {
                look: LOOKS[(i + exif) % 4],
                output: output(RgbSpace::DISPLAY_P3, BITS[(i + exif) % 3]),
                ..Recipe::default()
            };
            check(&capture, None, &recipe, &[(33, 5), (7, 64)], &format!("{name}, orientation {exif}"));
        }
    }
}

#[test]
fn tiles_of_a_few_pixels_are_as_good_as_any() {
    for (name, layout) in layouts() {
        let capture = capture(layout, Orientation::Rotate90);
        for tiles in [[(1, 23), (7, 5)], [(64, 1), (2, 40)]] {
            check(&capture, None, &Recipe::default(), &tiles, name);
        }
    }
}

#[test]
fn every_look_with_every_treatment_of_highlights_gives_the_same_bits_in_any_tiles() {
    let layouts = layouts();
    for (i, look) in LOOKS.into_iter().enumerate() {
        for (j, highlights) in HIGHLIGHTS.into_iter().enumerate() {
            // Bayer, X-Trans and linear RGB in turn.
            let (name, layout) = &layouts[3 + (i + j) % 3];
            let capture = capture(layout.clone(), Orientation::Upright);
            for bits in BITS {
                let output = output(RgbSpace::SRGB, bits);
                let recipe = Recipe { look, highlights, output, ..Recipe::default() };
                check(
                    &capture,
                    None,
                    &recipe,
                    &[(19, 11)],
                    &format!("{name} {look:?} {highlights:?} {bits:?}"),
                );
            }
        }
    }
}

#[test]
fn what_is_chosen_from_the_whole_picture_does_not_depend_on_threads_or_tiles() {
    for (name, layout) in layouts() {
        let capture = capture(layout, Orientation::Upright);
        let profile = bent_profile(&capture, 3);
        let recipe = Recipe {
            balance: Balance::Auto,
            exposure: Brightness { stops: 0.3, auto: true },
            output: output(RgbSpace::REC2020, Bits::Float),
            ..Recipe::default()
        };
        for (crop, demosaic) in [(Crop::Active, Demosaic::Bilinear), (Crop::Default, Demosaic::Best)] {
            let recipe = Recipe { crop, demosaic, ..recipe.clone() };
            check(&capture, Some(&profile), &recipe, &[(13, 9), (31, 8), (53, 1)], name);
        }
    }
}

#[test]
fn tiles_larger_than_any_picture_are_the_whole_picture() {
    let capture = capture(layouts().remove(0).1, Orientation::Upright);
    let plan = darkroot_tests::plan(&capture, None, &Recipe::default()).unwrap();
    assert!(
        darkroot_tests::rendered_in_tiles(&plan, usize::MAX, usize::MAX) == darkroot_tests::rendered(&plan)
    );
}
