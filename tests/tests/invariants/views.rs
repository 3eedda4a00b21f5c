//! Views: rectangles and smaller scales against the whole picture.

use std::sync::Arc;

use darkroot_colour::RgbSpace;
use darkroot_colour::difference::de2000;
use darkroot_develop::{
    Analysis, Balance, Bits, Cancel, Cancelled, Crop, Highlights, Kept, Look, Recipe, Scale, View,
};
use darkroot_photo::{Capture, Layout, Orientation, Picture, Rect, Samples, Size};
use darkroot_simulate::expose::expose;
use darkroot_simulate::{Exposure, Scene};
use darkroot_tests::{camera, lab, layouts, output, pixels, plan, rendered};

const SIZE: Size = Size { width: 187, height: 131 };

fn still_life(layout: Layout, orientation: Orientation) -> Capture {
    let exposure = Exposure { stops: 0.5, noise: Some(3), orientation, ..Exposure::default() };
    expose(&Scene::still_life(orientation.applied_to(SIZE)), &camera(layout), &exposure)
}

fn bayer() -> Capture {
    still_life(layouts().remove(0).1, Orientation::Upright)
}

fn captures() -> Vec<(String, Capture)> {
    let mut all = Vec::new();
    for (name, layout) in layouts() {
        for orientation in [Orientation::Upright, Orientation::Rotate90, Orientation::MirrorHorizontal] {
            let capture = still_life(layout.clone(), orientation);
            all.push((format!("{name} {orientation:?}"), capture));
        }
    }
    all
}

/// The part of a picture in a rectangle.
fn part(picture: &Picture, rect: Rect) -> Vec<u8> {
    let Samples::U8(all) = &picture.samples else { panic!("8 bits are the default") };
    let row = |y: usize| &all[3 * (y * picture.size.width + rect.x)..][..3 * rect.width];
    (rect.y..rect.bottom()).flat_map(row).copied().collect()
}

#[test]
fn a_rectangle_at_full_scale_is_that_rectangle_of_the_whole_picture() {
    for (name, capture) in captures() {
        let plan = plan(&capture, None, &Recipe { crop: Crop::Active, ..Recipe::default() }).unwrap();
        let whole = rendered(&plan);
        let size = plan.size();
        for rect in [
            Rect { x: 0, y: 0, width: 40, height: 30 },
            Rect { x: 33, y: 17, width: 61, height: 1 },
            Rect { x: size.width - 9, y: size.height - 11, width: 9, height: 11 },
        ] {
            let view = plan.render(View::of(rect), &Cancel::default()).unwrap();
            assert_eq!(view.size, rect.size());
            assert!(view.samples == Samples::U8(part(&whole, rect)), "{name} {rect:?}");
        }
    }
}

#[test]
fn a_rectangle_at_a_smaller_scale_is_that_rectangle_of_the_smaller_picture() {
    for (name, capture) in captures() {
        let plan = plan(&capture, None, &Recipe::default()).unwrap();
        for scale in [Scale::HALF, Scale::QUARTER, Scale::halved(3).unwrap()] {
            let all = plan.render(plan.whole(scale), &Cancel::default()).unwrap();
            assert_eq!(all.size, scale.of(plan.size()), "{name}");
            let rect = Rect { x: 3, y: 2, width: 11, height: 9 };
            let view = plan.render(View { scale, rect }, &Cancel::default()).unwrap();
            assert!(view.samples == Samples::U8(part(&all, rect)), "{name} 1/{}", scale.bin());
        }
    }
}

/// Mean dE2000 of a view against means over the whole picture.
fn departure(whole: &Picture, view: &Picture, bin: usize) -> f64 {
    let decode = |v: f64| RgbSpace::SRGB.curve.decode(v);
    let light = |picture| pixels(picture).into_iter().map(|p| p.map(decode)).collect::<Vec<_>>();
    let (all, small) = (light(whole), light(view));
    let lab = |rgb| lab(&RgbSpace::SRGB.linear(), rgb);
    let (columns, rows) = (whole.size.width / bin, whole.size.height / bin);
    let mut sum = 0.0;
    for y in 0..rows {
        for x in 0..columns {
            let mut mean = [0.0; 3];
            for i in 0..bin * bin {
                let rgb = all[(y * bin + i / bin) * whole.size.width + x * bin + i % bin];
                mean = [0, 1, 2].map(|c| mean[c] + rgb[c] / (bin * bin) as f64);
            }
            let seen = small[y * view.size.width + x];
            sum += de2000(lab(mean), lab(seen));
        }
    }
    sum / (columns * rows) as f64
}

#[test]
fn a_smaller_view_shows_what_the_whole_picture_reduced_shows() {
    for (name, capture) in captures() {
        let plan = plan(&capture, None, &Recipe::default()).unwrap();
        let whole = rendered(&plan);
        // The still life in so few pixels is nearly all edges, and those are sharpened: the worst that there is.
        for (scale, most) in [(Scale::HALF, 0.67), (Scale::QUARTER, 3.0)] {
            // Columns that are not whole lie at the other end of a mirrored picture.
            let view = plan.render(plan.whole(scale), &Cancel::default()).unwrap();
            let off = departure(&whole, &view, scale.bin());
            assert!(off < most, "{name} 1/{}: {off}", scale.bin());
        }
    }
}

#[test]
fn a_view_that_is_rendered_again_is_the_same_whatever_was_kept_of_it() {
    // What moves between two renderings, and whether the camera RGB before it serves again.
    type Move = fn(&mut Recipe);
    let moves: [(&str, bool, Move); 11] = [
        ("nothing", true, |_| {}),
        ("exposure", true, |recipe| recipe.exposure.stops = 1.3),
        ("look", true, |recipe| recipe.look = Look::Vivid),
        ("contrast", true, |recipe| recipe.tones.contrast = 0.3),
        ("space", true, |recipe| recipe.output = output(RgbSpace::ADOBE_RGB, Bits::Sixteen)),
        ("white balance", false, |recipe| recipe.balance = Balance::Multipliers([1.9, 1.0, 1.4])),
        ("noise", false, |recipe| recipe.denoise.amount = Some(0.0)),
        ("highlights", false, |recipe| recipe.highlights = Highlights::Clip),
        ("crop", false, |recipe| recipe.crop = Crop::Rect { x: 8, y: 4, width: 90, height: 60 }),
        ("straightened", false, |recipe| recipe.geometry.straighten = 1.5),
        ("exposure when straightened", true, |recipe| recipe.exposure.stops = -0.5),
    ];
    for (name, capture) in captures() {
        let analysis = Analysis::of(Arc::new(capture));
        for scale in [Scale::FULL, Scale::HALF, Scale::QUARTER] {
            let (kept, cancel) = (Kept::default(), Cancel::default());
            let mut recipe = Recipe::default();
            for (i, (what, serves, change)) in moves.iter().enumerate() {
                change(&mut recipe);
                let plan = darkroot_develop::plan(&analysis, None, &recipe).unwrap();
                let view = plan.whole(scale);
                if i > 0 && !(name.starts_with("linear RGB") && *what == "noise") {
                    assert_eq!(plan.is_kept(view, &kept), *serves, "{name} 1/{}: {what}", scale.bin());
                }
                let again = plan.render_again(view, &kept, &cancel).unwrap();
                assert!(plan.is_kept(view, &kept), "{name}: {what}");
                assert!(again == plan.render(view, &cancel).unwrap(), "{name} 1/{}: {what}", scale.bin());
            }
        }
    }
}

#[test]
fn nothing_is_kept_of_another_photograph_or_another_view() {
    let (kept, cancel) = (Kept::default(), Cancel::default());
    let one = plan(&bayer(), None, &Recipe::default()).unwrap();
    one.render_again(one.whole(Scale::HALF), &kept, &cancel).unwrap();
    assert!(one.is_kept(one.whole(Scale::HALF), &kept));
    assert!(!one.is_kept(one.whole(Scale::QUARTER), &kept));
    let another = plan(&bayer(), None, &Recipe::default()).unwrap();
    assert!(!another.is_kept(another.whole(Scale::HALF), &kept));
}

#[test]
fn one_analysis_serves_every_recipe() {
    let capture = bayer();
    let analysis = Analysis::of(Arc::new(capture.clone()));
    for crop in [Crop::Default, Crop::Active] {
        let recipe = Recipe { crop, ..Recipe::default() };
        let again = darkroot_develop::plan(&analysis, None, &recipe).unwrap();
        assert!(rendered(&again) == rendered(&plan(&capture, None, &recipe).unwrap()));
    }
}

#[test]
fn what_is_cancelled_gives_no_picture() {
    let capture = bayer();
    let plan = plan(&capture, None, &Recipe::default()).unwrap();
    let cancel = Cancel::default();
    cancel.cancel();
    assert_eq!(plan.render(plan.whole(Scale::FULL), &cancel), Err(Cancelled));
}

#[test]
fn a_view_beyond_the_picture_is_cut_to_it() {
    let capture = bayer();
    let plan = plan(&capture, None, &Recipe::default()).unwrap();
    let size = plan.size();
    let far = View::of(Rect { x: size.width - 4, y: 0, width: 100, height: 7 });
    assert_eq!(plan.render(far, &Cancel::default()).unwrap().size, Size { width: 4, height: 7 });
    let outside = View::of(Rect { x: size.width, y: 0, width: 5, height: 5 });
    assert_eq!(plan.render(outside, &Cancel::default()).unwrap().size.area(), 0);
}
