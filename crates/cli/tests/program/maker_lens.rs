//! What makers' notes say of the lens is corrected where it is asked for, and said where it is not.

mod drawn;

use darkroot_simulate::makers::{self, RafNotes};

use super::*;
use drawn::{Motif, drawn, files};

/// Samples of a developed picture in balanced camera RGB.
fn samples(desk: &Desk, name: &str, options: &[&str]) -> (usize, usize, Vec<f32>) {
    let all = [
        &[name, "-o", "o.tif", "--overwrite", "--look", "linear", "--space", "camera", "--bits", "32"],
        options,
    ];
    desk.develop(&all.concat());
    let picture = image::open(desk.path("o.tif")).unwrap().into_rgb32f();
    let (width, height) = picture.dimensions();
    (width as usize, height as usize, picture.into_raw())
}

/// By how much the lines of a channel are off straight at most, upright or level, and how many there are.
fn off_straight(
    (width, height, samples): &(usize, usize, Vec<f32>),
    channel: usize,
    upright: bool,
) -> (f64, usize) {
    let (across, along) = if upright { (*width, *height) } else { (*height, *width) };
    let light = |i: usize, j: usize| {
        let (x, y) = if upright { (i, j) } else { (j, i) };
        f64::from(samples[3 * (y * width + x) + channel])
    };
    let mut lines: Vec<Vec<f64>> = Vec::new();
    for j in 8..along - 8 {
        let most = (8..across - 8).map(|i| light(i, j)).fold(0.0, f64::max);
        for i in 10..across - 10 {
            let peak = light(i, j);
            let is_peak = peak > 0.4 * most
                && (i - 5..i).all(|k| light(k, j) <= peak)
                && (i + 1..i + 6).all(|k| light(k, j) < peak);
            if !is_peak {
                continue;
            }
            let floor = light(i - 10, j).min(light(i + 10, j));
            let window = i - 9..i + 10;
            let weight = |k: usize| (light(k, j) - floor).max(0.0);
            let sum: f64 = window.clone().map(weight).sum();
            let place = window.map(|k| weight(k) * (k as f64 + 0.5)).sum::<f64>() / sum;
            match lines.iter_mut().find(|line| line.last().is_some_and(|last| (last - place).abs() < 2.0)) {
                Some(line) => line.push(place),
                None => lines.push(vec![place]),
            }
        }
    }
    lines.retain(|line| line.len() > along / 2);
    let off = |line: &Vec<f64>| {
        let mean = line.iter().sum::<f64>() / line.len() as f64;
        line.iter().map(|v| (v - mean).abs()).fold(0.0, f64::max)
    };
    (lines.iter().map(off).fold(0.0, f64::max), lines.len())
}

#[test]
fn a_grid_through_the_lens_is_straight_in_every_colour() {
    let desk = Desk::new();
    for (motif, upright) in [(Motif::Upright, true), (Motif::Level, false)] {
        for (name, bytes) in files(motif) {
            desk.put(name, bytes);
            let (off, lines) = off_straight(&samples(&desk, name, &["--lens", "off"]), 1, upright);
            assert!(off > 1.0 && lines > 3, "{name}: {off} {lines}");
            let corrected = samples(&desk, name, &["--lens", "maker"]);
            for channel in 0..3 {
                let (off, lines) = off_straight(&corrected, channel, upright);
                println!("{name} channel {channel}: {off:.3} pixels off straight, {lines} lines");
                assert!(off < 0.2 && lines >= 5, "{name} channel {channel}: {off} {lines}");
            }
        }
    }
}

#[test]
fn light_that_the_lens_lost_is_made_good_where_the_note_says_how_much() {
    let desk = Desk::new();
    let spread = |name: &str, options: &[&str]| {
        let (width, height, samples) = samples(&desk, name, options);
        let green = |x: usize, y: usize| samples[3 * (y * width + x) + 1];
        let middle = green(width / 2, height / 2);
        [(6, 6), (width - 7, height - 7), (width / 2, 6), (6, height / 2)]
            .map(|(x, y)| (green(x, y) / middle - 1.0).abs())
            .into_iter()
            .fold(0.0, f32::max)
    };
    for (name, bytes) in files(Motif::Grey) {
        desk.put(name, bytes);
        let has_light = name.starts_with("fuji");
        assert!(spread(name, &["--lens", "off"]) > 0.3, "{name}");
        let corrected = spread(name, &["--lens", "maker"]);
        assert_eq!(corrected < 0.01, has_light, "{name}: {corrected}");
        assert!(spread(name, &["--lens", "maker", "--vignetting=false"]) > 0.3, "{name}");
    }
}

#[test]
fn what_is_done_and_what_is_not_is_said() {
    let desk = Desk::new();
    for (name, bytes) in files(Motif::Upright) {
        desk.put(name, bytes);
        let maker = match &name[..4] {
            "sony" => "Sony",
            "olym" => "Olympus",
            _ => "Fujifilm",
        };
        let parts = match maker {
            "Fujifilm" => "(distortion, lateral chromatic aberration and vignetting)",
            _ => "(distortion and lateral chromatic aberration)",
        };
        let unasked = desk.develop(&[name, "-o", "unasked.png", "--overwrite"]);
        assert!(
            unasked.err.contains(&format!("{maker}'s note on the lens {parts} is not applied unasked")),
            "{}",
            unasked.err
        );
        desk.develop(&[name, "-o", "file.png", "--lens", "file", "--overwrite"]);
        assert!(desk.read("unasked.png") == desk.read("file.png"), "{name}");
        let asked = desk.develop(&[name, "-o", "asked.png", "--lens", "maker", "--overwrite"]);
        for words in [&format!("corrected as {maker}'s note says {parts}"), "could not be checked"] {
            assert!(asked.err.contains(words), "{}", asked.err);
        }
        assert!(desk.read("asked.png") != desk.read("file.png"), "{name}");
        let inspected = desk.run(&["inspect", name]);
        assert!(
            inspected.out.contains(&format!("{maker}'s note describes the lens {parts}")),
            "{}",
            inspected.out
        );
        // Of Sony's vignetting readings differ.
        assert_eq!(inspected.out.contains("differ by a factor of two"), maker == "Sony", "{}", inspected.out);
        assert_eq!(asked.err.contains("differ by a factor of two"), maker == "Sony", "{}", asked.err);
    }
    // Colours alone can be left.
    let run = desk.develop(&["olympus.orf", "-o", "plain.png", "--lens", "maker", "--ca=false"]);
    assert!(run.err.contains("as Olympus's note says (distortion)"), "{}", run.err);
}

#[test]
fn numbers_of_no_lens_are_refused_in_words_and_the_picture_is_developed_without() {
    let desk = Desk::new();
    let plain = drawn(14, Motif::Upright);
    let sony = |lists: Vec<makers::List<i16>>| makers::arw(&plain, &lists, None).unwrap();
    let raf = |number: u16, numbers: Vec<f64>, part: u16| {
        makers::raf(&plain, &RafNotes { lens: vec![(number, numbers)], part, ..RafNotes::default() }).unwrap()
    };
    let olympus = |number: u16, numbers: Vec<f32>| {
        makers::orf(&drawn(12, Motif::Upright), &[(number, numbers)]).unwrap()
    };
    let bent = |v: f64| [vec![1.0], (1..=9).map(|i| f64::from(i) / 9.0).collect(), vec![v; 9]].concat();
    for (name, bytes, words) in [
        ("count.arw", sony(vec![(0x7037, vec![40, 1, 2])]), "names 40 numbers and has 2"),
        ("minus.arw", sony(vec![(0x7037, vec![-3, 1, 2])]), "names -3 numbers"),
        ("single.arw", sony(vec![(0x7037, vec![1, 5])]), "a single number"),
        (
            "wild.arw",
            sony(vec![(0x7037, vec![4, 0, i16::MIN, i16::MAX, 0])]),
            "distortion is that of no lens",
        ),
        ("odd.arw", sony(vec![(0x7035, vec![3, 1, 2, 3]), (0x7037, vec![2, 1, 2])]), "that blue has not"),
        ("nan.orf", olympus(0x150a, vec![f32::NAN, 0.0, 0.0, 1.0]), "distortion is that of no lens"),
        ("zero.orf", olympus(0x150a, vec![0.0; 4]), "distortion is that of no lens"),
        ("huge.orf", olympus(0x150a, vec![1e30, 0.0, 0.0, 1.0]), "distortion is that of no lens"),
        ("short.orf", olympus(0x150a, vec![0.1, 0.0]), "is not 4 numbers"),
        ("apart.orf", olympus(0x150c, vec![0.5, 0.0, 0.0, 0.0, 0.0, 0.0]), "aberration is that of no lens"),
        ("count.raf", raf(0xf00b, vec![1.0, 2.0, 3.0], 0), "3 numbers, whose meaning is not known"),
        (
            "order.raf",
            raf(0xf00b, [vec![1.0], vec![0.5; 9], vec![1.0; 9]].concat(), 0),
            "no numbers in order",
        ),
        ("wild.raf", raf(0xf00b, bent(-90.0), 0), "distortion is that of no lens"),
        ("dark.raf", raf(0xf010, bent(0.0), 0), "no numbers in order"),
        ("part.raf", raf(0xf00b, bent(-1.0), 4), "only a part of the sensor"),
    ] {
        desk.put(name, bytes);
        let run = desk.develop(&[name, "-o", "o.png", "--lens", "maker", "--overwrite"]);
        assert!(
            run.err.contains("note on the lens is not applied") && run.err.contains(words),
            "{name}: {}",
            run.err
        );
        let inspected = desk.run(&["inspect", name]);
        assert!(inspected.out.contains(words), "{name}: {}", inspected.out);
        desk.develop(&[name, "-o", "file.png", "--lens", "file", "--overwrite"]);
        assert!(desk.read("o.png") == desk.read("file.png"), "{name}");
    }
    // Nothing is said where nothing is to be said.
    for (name, bytes) in [
        ("none.arw", sony(vec![(0x7035, vec![4, 0, 0, 0, 0]), (0x7037, vec![3, 0, 0, 0])])),
        ("none.raf", raf(0xf00b, vec![0.0; 19], 0)),
        ("none.orf", olympus(0x1510, vec![0.0, 0.0, 0.0, 1.0])),
    ] {
        desk.put(name, bytes);
        let run = desk.develop(&[name, "-o", "o.png", "--overwrite"]);
        assert!(!run.err.contains("note on the lens"), "{name}: {}", run.err);
    }
}

#[test]
fn aspect_ratios_that_the_camera_was_set_to_are_honoured() {
    let desk = Desk::new();
    let mut plain = drawn(14, Motif::Upright);
    plain.default_crop = darkroot_photo::Rect { x: 4, y: 4, width: 600, height: 392 };
    let raf = |records: Vec<makers::List<u16>>| {
        makers::raf(&plain, &RafNotes { records, ..RafNotes::default() }).unwrap()
    };
    for (name, bytes, size) in [
        ("whole.raf", raf(vec![(0x0115, vec![2, 3])]), (600, 392)),
        ("square.raf", raf(vec![(0x0115, vec![1, 1])]), (392, 392)),
        ("wide.raf", raf(vec![(0x0115, vec![9, 16])]), (600, 338)),
        ("wrong.raf", raf(vec![(0x0115, vec![0, 16])]), (600, 392)),
        (
            "zoom.raf",
            raf(vec![
                (0x0115, vec![1, 1]),
                (0x0117, vec![0, 1]),
                (0x0118, vec![100, 152]),
                (0x0119, vec![200, 304]),
            ]),
            (200, 200),
        ),
        (
            "idle.raf",
            raf(vec![(0x0117, vec![0, 0]), (0x0118, vec![100, 152]), (0x0119, vec![200, 304])]),
            (600, 392),
        ),
        (
            "beyond.raf",
            raf(vec![(0x0117, vec![0, 1]), (0x0118, vec![300, 152]), (0x0119, vec![200, 304])]),
            (600, 392),
        ),
        ("whole.arw", makers::arw(&plain, &[], Some((600, 392))).unwrap(), (600, 392)),
        ("wide.arw", makers::arw(&plain, &[], Some((600, 336))).unwrap(), (600, 336)),
        // A smaller JPEG beside the raw file is no crop.
        ("small.arw", makers::arw(&plain, &[], Some((304, 200))).unwrap(), (600, 392)),
        ("large.arw", makers::arw(&plain, &[], Some((9000, 392))).unwrap(), (600, 392)),
    ] {
        desk.put(name, bytes);
        let run = desk.develop(&[name, "-o", "o.png", "--overwrite", "--lens", "off"]);
        assert_eq!(image::image_dimensions(desk.path("o.png")).unwrap(), size, "{name}");
        assert_eq!(run.err.contains("cut to what was chosen"), size != (600, 392), "{name}: {}", run.err);
        desk.develop(&[name, "-o", "o.png", "--overwrite", "--crop", "100%"]);
        assert_eq!(image::image_dimensions(desk.path("o.png")).unwrap(), (600, 392), "{name}");
    }
}
