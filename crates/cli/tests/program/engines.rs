//! The second decoder and the second engine, on the samples of the repository.

use serde_json::Value;

use super::*;

/// Develops a sample to a PNG; the picture and the report.
fn developed(desk: &Desk, name: &str, arguments: &[&str]) -> (image::RgbImage, Value) {
    let path = sample(name);
    let fixed = ["develop", path.to_str().unwrap(), "-o", "o.png", "--overwrite", "--json"];
    let run = desk.run(&[&fixed, arguments].concat());
    assert_eq!(run.code, 0, "{name} {arguments:?}: {}", run.err);
    (image::open(desk.path("o.png")).unwrap().to_rgb8(), serde_json::from_str(&run.out).unwrap())
}

fn difference(one: &image::RgbImage, two: &image::RgbImage) -> f64 {
    assert_eq!(one.dimensions(), two.dimensions());
    let sum: u64 = one.iter().zip(two.iter()).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
    sum as f64 / one.len() as f64
}

#[test]
fn both_decoders_give_the_same_picture_of_a_dng() {
    let desk = Desk::new();
    let (own, first) = developed(&desk, "still-life.dng", &[]);
    let (other, second) = developed(&desk, "still-life.dng", &["--decoder", "rawloader"]);
    assert!(first["decoder"].as_str().unwrap().contains("flashraw"), "{first}");
    assert!(second["decoder"].as_str().unwrap().contains("rawloader"), "{second}");
    assert!(own == other);
}

#[test]
fn a_nef_that_the_other_decoder_does_not_know_is_refused_in_words() {
    // It looks for a tag of the maker note that simulated files lack.
    let desk = Desk::new();
    let path = sample("still-life.nef");
    let arguments = ["develop", path.to_str().unwrap(), "--decoder", "rawloader", "-o", "o.jpg"];
    desk.fails(1, &arguments, &["still-life.nef", "Nikon D750", "rawloader does not know"]);
    assert!(desk.names().is_empty());
}

#[cfg(feature = "imagepipe")]
#[test]
fn the_second_engine_develops_the_samples() {
    let desk = Desk::new();
    for name in ["still-life.dng", "still-life.nef"] {
        let (own, _) = developed(&desk, name, &[]);
        let (other, report) = developed(&desk, name, &["--engine", "imagepipe"]);
        assert_eq!(report["engine"], "imagepipe");
        assert!(report["colours"].as_str().unwrap().contains("imagepipe"), "{report}");
        let difference = difference(&own, &other);
        // Another rendering of the same scene.
        assert!((0.5..60.0).contains(&difference), "{name}: {difference}");
    }
}

#[cfg(feature = "imagepipe")]
#[test]
fn the_second_engine_refuses_what_it_does_not_have() {
    let desk = Desk::with_dng();
    let refused: [(&[&str], &str); 8] = [
        (&["--profile", "matrix"], "--profile"),
        (&["--space", "adobe-rgb"], "--space"),
        (&["--bits", "32", "-o", "o.tif"], "--bits"),
        (&["--look", "vivid"], "--look"),
        (&["--exposure", "1"], "--exposure"),
        (&["--wb", "daylight"], "--white-balance"),
        (&["--highlights", "clip"], "--highlights"),
        (&["--crop", "active"], "--crop"),
    ];
    for (arguments, word) in refused {
        desk.fails(
            2,
            &[&["develop", "a.dng", "--engine", "imagepipe"], arguments].concat(),
            &["leave out", word],
        );
    }
    assert_eq!(desk.names(), ["a.dng"]);
}

#[test]
fn every_option_of_the_picture_changes_it() {
    let desk = Desk::new();
    let (plain, _) = developed(&desk, "still-life.dng", &[]);
    let options: [&[&str]; 12] = [
        &["--exposure", "0.5"],
        &["--exposure", "-0.5"],
        &["--auto-exposure"],
        &["--white-balance", "3500K"],
        &["--wb", "5500K,+30"],
        &["--wb", "auto"],
        &["--wb", "spot:600,300,20"],
        &["--wb", "2,1,2"],
        &["--look", "vivid"],
        &["--look", "flat"],
        &["--demosaic", "bilinear"],
        &["--highlights", "keep"],
    ];
    for arguments in options {
        let (changed, _) = developed(&desk, "still-life.dng", arguments);
        assert!(changed != plain, "{arguments:?}");
    }
    let (whole, _) = developed(&desk, "still-life.dng", &["--crop", "active"]);
    assert_eq!((plain.dimensions(), whole.dimensions()), ((712, 472), (720, 480)));
}
