//! A real shot: a Passport in the light of a lamp, by a Canon 550D, which no built-in profile knows. What `develop` makes of it is
//! held against measured spectra of such patches (BabelColor's means of 30 charts) under A.

use std::path::PathBuf;

use darkroot::settings::{ChartShot, FromChart, ProfileChoice};
use darkroot::{Cancel, Format, Photo, ProfileStore, Scale, Settings};
use darkroot_chart::Quad;
use darkroot_colour::difference::de2000;
use darkroot_colour::{RgbSpace, Spectrum, Vector3, Xyz, adaptation, white};
use darkroot_develop::{Bits, Look, OutputSpace};
use darkroot_photo::{PictureSpace, Samples};
use darkroot_profile::Summary;

use super::{chart_shots, data};

fn file() -> PathBuf {
    data::folder().join("../raw/canon_550d_passport_chart_14bit_packed.dng")
}

/// Linear, by the chart's own greys and black, as `develop --look linear --exposure-from-chart auto --black-from-chart
/// --white-balance chart` does: XYZ of each patch relative to D50.
fn developed(windows: &[Quad], profile: ProfileChoice) -> Vec<Xyz> {
    let mut settings = Settings {
        profile,
        space: Some(OutputSpace::Rgb(RgbSpace::ACES2065_1)),
        bits: Some(Bits::Float),
        format: Some(Format::Tiff),
        ..Settings::default()
    };
    settings.chart = FromChart {
        shot: ChartShot::Itself,
        black: true,
        balance: true,
        layout: Some("passport24".to_owned()),
        reference: Some(
            data::folder().join("colorchecker_classic24_babelcolor_380-730_10.csv").display().to_string(),
        ),
        ..FromChart::default()
    };
    settings.recipe.look = Look::Linear;
    let bytes = std::fs::read(file()).unwrap();
    let store = ProfileStore::builtin();
    let photo = Photo::open_for(&bytes, &store, &settings).unwrap();
    let told = photo.told_by_chart(&file(), &settings).unwrap().unwrap();
    let plan = photo.plan_by_chart(&file(), &photo.analyse(), &store, &settings, &told).unwrap();
    let picture = plan.render(plan.whole(Scale::FULL), &Cancel::default()).unwrap();
    let (Samples::F32(samples), PictureSpace::Rgb(space)) = (&picture.samples, picture.space) else {
        unreachable!("linear floating-point RGB was asked for");
    };
    let mean = |window: &Quad| {
        let ends = |k: usize| {
            let all = window.iter().map(|p| p[k]);
            (all.clone().fold(f64::INFINITY, f64::min) as usize, all.fold(0.0, f64::max) as usize)
        };
        let ((left, right), (top, bottom)) = (ends(0), ends(1));
        let inside = (top..=bottom).flat_map(|y| (left..=right).map(move |x| (x, y)));
        let inside =
            inside.filter(|(x, y)| darkroot_chart::geometry::contains(window, [*x as f64, *y as f64]));
        let (mut sum, mut count) = ([0.0; 3], 0.0);
        for (x, y) in inside {
            let pixel = &samples[3 * (y * picture.size.width + x)..][..3];
            sum = [0, 1, 2].map(|c| sum[c] + f64::from(pixel[c]));
            count += 1.0;
        }
        let rgb = Vector3::from(sum.map(|v: f64| v / count));
        Xyz::from(space.to_xyz_under(white::D50) * rgb)
    };
    windows.iter().map(mean).collect()
}

/// dE2000 in the light of the lamp, as every figure of a chart under its own light, the exposure free.
fn errors(found: &[Xyz], light: &Spectrum) -> Summary {
    let lamp = light.white();
    let back = adaptation::bradford(white::D50, lamp);
    let truth: Vec<Xyz> = data::classic_24().iter().map(|patch| patch.reflected_xyz(light)).collect();
    let at = |scale: f64| {
        let pairs = found.iter().zip(&truth);
        let off = pairs.map(|(found, truth)| {
            let there = Xyz::from(back * Vector3::from(found.scaled(scale)));
            de2000(there.lab(lamp), truth.lab(lamp))
        });
        Summary::of(&off.collect::<Vec<_>>())
    };
    (0..=400).map(|i| at(0.8 + 0.001 * f64::from(i))).min_by(|a, b| a.mean.total_cmp(&b.mean)).unwrap()
}

#[test]
#[cfg_attr(not(has_spectra), ignore = "needs `spectra` in DARKROOT_DATA")]
fn a_real_shot_needs_no_chart() {
    let light = darkroot::light::find("A").unwrap().spectrum.unwrap();
    let made = chart_shots::passport_by_a_lamp(file());
    let windows = &made.lights[0].shots[0].windows;
    let [estimate, matrix] = [ProfileChoice::Automatic, ProfileChoice::Matrix]
        .map(|profile| errors(&developed(windows, profile), &light));
    let show = |s: Summary| format!("{:.2} / {:.1} / {:.1}", s.mean, s.p95, s.max);
    println!("developed: estimated {}; by the matrix {}", show(estimate), show(matrix));
    assert!(estimate.mean < 1.66 && estimate.mean < 0.8 * matrix.mean, "{estimate:?} {matrix:?}");
}
