//! Dark and flat frames, as a person takes them for photographs.

use darkroot_colour::Spectrum;
use darkroot_photo::{Capture, Counts};

use super::*;

/// A grey wall in a lens that loses light in the corners.
fn wall(stops: f64, seed: u64) -> Capture {
    let grey = Spectrum::from_fn(|_| 0.5);
    let exposure = Exposure { falloff: 0.5, stops, noise: Some(seed), ..Exposure::default() };
    expose(&Scene::flat(FRAME, grey), &Camera::simulated_one(), &exposure)
}

/// What a sensor adds without light: a glow that grows to the left, and two hot pixels.
fn warmed(mut capture: Capture, glow: f32) -> Vec<u8> {
    let width = capture.counts.size().width;
    if let Counts::U16(mosaic) = &mut capture.counts {
        for (i, count) in mosaic.samples.iter_mut().enumerate() {
            let (x, y) = (i % width, i / width);
            let hot = (x, y) == (40, 30) || (x, y) == (41, 33);
            *count += if hot { 2000 } else { (glow * (width - x) as f32) as u16 };
        }
    }
    dng::write(&capture, dng::Storage::Uncompressed)
}

/// A frame without light.
fn dark() -> Capture {
    let exposure = Exposure { white: 1e-9, noise: Some(3), ..Exposure::default() };
    expose(&Scene::flat(FRAME, Spectrum::from_fn(|_| 0.0)), &Camera::simulated_one(), &exposure)
}

/// Green of a picture of 16 bits, and its largest distance from the mean, as a share of that; edges are left out.
fn green(desk: &Desk, name: &str) -> (f64, f64) {
    let picture = image::open(desk.path(name)).unwrap().into_rgb16();
    let (width, height) = picture.dimensions();
    let inside = |x: &u32, y: &u32| (4..width - 4).contains(x) && (4..height - 4).contains(y);
    let pixels = picture.enumerate_pixels().filter(|(x, y, _)| inside(x, y));
    // Means of 8 x 8 pixels: noise is no slope.
    let mut blocks = std::collections::BTreeMap::<_, Vec<f64>>::new();
    for (x, y, pixel) in pixels {
        blocks.entry((x / 8, y / 8)).or_default().push(f64::from(pixel[1]));
    }
    let means: Vec<f64> =
        blocks.values().filter(|b| b.len() == 64).map(|b| b.iter().sum::<f64>() / 64.0).collect();
    let mean = means.iter().sum::<f64>() / means.len() as f64;
    (mean, means.iter().map(|v| (v - mean).abs()).fold(0.0, f64::max) / mean)
}

#[test]
fn a_flat_frame_evens_out_and_several_count_as_their_median() {
    let desk = Desk::new();
    let raw = |capture: &Capture| dng::write(capture, dng::Storage::Uncompressed);
    desk.put("a.dng", raw(&wall(-1.0, 1)));
    for (i, seed) in [11, 12, 13].into_iter().enumerate() {
        desk.put(&format!("flats/{i}.dng"), raw(&wall(0.3, seed)));
    }
    desk.put("flats/readme.txt", "taken on Monday");
    let options = ["--look", "linear", "--format", "tiff"];
    desk.develop(&[&["a.dng", "-o", "plain.tif"], &options[..]].concat());
    desk.develop(&[&["a.dng", "-o", "one.tif", "--flat", "flats/0.dng"], &options[..]].concat());
    let run = desk.develop(&[&["a.dng", "-o", "three.tif", "--flat", "flats"], &options[..]].concat());
    assert!(run.err.contains("evened out by 3 flat frames"), "{}", run.err);
    let (plain, one, three) = (green(&desk, "plain.tif"), green(&desk, "one.tif"), green(&desk, "three.tif"));
    assert!(plain.1 > 0.1, "{plain:?}");
    assert!(one.1 < 0.03 && three.1 < 0.025, "{one:?} {three:?}");
    // As bright as the middle.
    assert!(three.0 > plain.0, "{plain:?} {three:?}");
}

#[test]
fn dark_frames_take_off_glow_and_mend_hot_pixels() {
    let desk = Desk::new();
    let options = ["--look", "linear", "--format", "tiff", "--bits", "16"];
    let dim = || wall(-4.0, 1);
    desk.put("clean.dng", dng::write(&dim(), dng::Storage::Uncompressed));
    desk.put("a.dng", warmed(dim(), 1.0));
    for name in ["d1", "d2", "d3"] {
        desk.put(&format!("darks/{name}.dng"), warmed(dark(), 1.0));
    }
    desk.develop(&[&["clean.dng", "-o", "clean.tif"], &options[..]].concat());
    desk.develop(&[&["a.dng", "-o", "warm.tif"], &options[..]].concat());
    let run = desk.develop(&[&["a.dng", "-o", "dark.tif", "--dark", "darks"], &options[..]].concat());
    assert!(run.err.contains("3 dark frames taken off; 2 pixels that are hot in them"), "{}", run.err);
    let pixels = |name| image::open(desk.path(name)).unwrap().into_rgb16();
    let (clean, warm, mended) = (pixels("clean.tif"), pixels("warm.tif"), pixels("dark.tif"));
    let away = |a: &image::ImageBuffer<image::Rgb<u16>, Vec<u16>>| {
        a.pixels().zip(clean.pixels()).map(|(a, b)| f64::from(a[1].abs_diff(b[1]))).fold(0.0, f64::max)
    };
    // Rounded counts, and the two pixels, whose own light nobody knows.
    assert!(away(&warm) > 1000.0 && away(&mended) < 60.0, "{} {}", away(&warm), away(&mended));
}

#[test]
fn a_recipe_names_frames_beside_it_and_a_batch_does_files_again_when_they_change() {
    let desk = Desk::new();
    let raw = |capture: &Capture| dng::write(capture, dng::Storage::Uncompressed);
    desk.put("roll/a.dng", raw(&wall(-1.0, 1)));
    desk.put("frames/flat.dng", raw(&wall(0.3, 11)));
    desk.put("roll/darkroot.toml", "flat = \"../frames\"\n");
    let batch = ["batch", "roll", "-o", "out", "--format", "png"];
    let run = desk.run(&batch);
    assert_eq!(run.code, 0, "{}", run.err);
    let first = desk.read("out/a.png");
    let run = desk.run(&[&batch[..], &["--dry-run", "--json"]].concat());
    assert!(run.out.contains("\"unchanged\""), "{}", run.out);
    desk.put("frames/flat.dng", raw(&wall(0.5, 12)));
    let run = desk.run(&[&batch[..], &["--dry-run", "--json"]].concat());
    assert!(run.out.contains("file-changed"), "{}", run.out);
    assert_eq!(desk.run(&batch).code, 0);
    assert_ne!(desk.read("out/a.png"), first);
}

#[test]
fn frames_that_do_not_belong_are_sentences() {
    let desk = Desk::new();
    desk.put("a.dng", small_dng());
    desk.put("other.nef", small_nef());
    desk.put("empty/note.txt", "none");
    let size = darkroot_photo::Size { width: 80, height: 60 };
    let small = expose(&Scene::still_life(size), &Camera::simulated_one(), &Exposure::default());
    desk.put("small.dng", dng::write(&small, dng::Storage::Uncompressed));
    desk.put("dark.dng", dng::write(&dark(), dng::Storage::Uncompressed));
    for (options, words) in [
        (["--dark", "none.dng"], &["none.dng", "no such file"][..]),
        (["--dark", "other.nef"], &["other.nef", "Nikon D750", "one camera"]),
        (["--flat", "small.dng"], &["small.dng", "80 x 60", "one mode"]),
        (["--flat", "empty"], &["empty", "without a raw file"]),
        (["--flat", "dark.dng"], &["dark.dng", "too dark"]),
        (["--dark", "empty/note.txt"], &["note.txt", "is not a raw photograph"]),
    ] {
        desk.fails(1, &[&["develop", "a.dng", "-o", "o.png"], &options[..]].concat(), words);
        assert!(!desk.path("o.png").exists());
    }
}
