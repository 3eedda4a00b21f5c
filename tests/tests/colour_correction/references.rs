//! What it costs that nobody tells what the chart is: profiles of simulated shots by the references that are built in, beside
//! those by the chart's own spectra, and beside no chart at all.
//!
//! The cameras are in no prior. Models are judged on surfaces of which none is built in: the 180 of the DC and Esser's. The
//! chart that is shot is never the one that a built-in reference was measured on: the SG and the Classic are BabelColor's,
//! the built-in ones the maker's and ISETCam's.

use darkroot::Limits;
use darkroot::estimate::estimate_named;
use darkroot_colour::Spectrum;
use darkroot_profile::Model;
use rayon::prelude::*;

use super::chart_shots::{Told, judged_on, shoot};
use super::data;

/// Cameras by file, and as lists of matrices have them.
const CAMERAS: [(&str, &str); 3] = [
    ("camspec_nikon_d90", "Nikon D90"),
    ("camspec_canon_40d", "Canon EOS 40D"),
    ("camspec_pentax_k5", "Pentax K-5"),
];
const LIGHTS: [&str; 9] = ["D50", "D65", "A", "FL2", "FL11", "FL12", "LED-B3", "LED-B5", "LED-RGB1"];
const CHARTS: [&str; 2] = ["classic24", "sg140"];
/// What is told of the chart.
const TOLD: [(&str, Told); 5] = [
    ("own spectra", Told::Spectra),
    ("own Lab", Told::Lab),
    ("nothing", Told::Nothing),
    ("maker's", Told::BuiltIn("sg140")),
    ("measured", Told::BuiltIn("sg140-measured")),
];

fn surfaces() -> Vec<Spectrum> {
    let mut all = data::dc_180();
    all.extend(data::reflectances("refl_iset_esserchart"));
    all
}

/// How far off one camera is under one light, mean dE2000: by a chart of which this is told, `None` where that does not apply;
/// and without a chart, by the published matrix, the light's white known.
struct Case {
    camera: &'static str,
    light: &'static str,
    chart: &'static str,
    told: Vec<Option<f64>>,
    /// The reference that was chosen where nothing was told.
    chosen: String,
    no_chart: f64,
}

fn case(
    (camera, listed): (&'static str, &'static str),
    light: &'static str,
    chart: &'static str,
    told: &[Told],
) -> Case {
    let patches = if chart == "sg140" { data::sg_140() } else { data::classic_24() };
    let (surfaces, sensitivities) = (surfaces(), data::camera(camera));
    let source = darkroot::light::find(light).unwrap();
    let spectrum = source.spectrum.clone().unwrap();
    let judged = |model: &Model| judged_on(&surfaces, model, &sensitivities, &spectrum);
    let mut chosen = String::new();
    let mut by = |told: &Told| {
        if chart != "sg140" && matches!(told, Told::BuiltIn(_)) {
            return None;
        }
        let profile = shoot(camera, light, chart, &patches, *told, |made| made.profile.clone());
        if *told == Told::Nothing {
            chosen.clone_from(&profile.origin().reference);
        }
        Some(judged(&profile.calibrations()[0].model))
    };
    let told = told.iter().map(&mut by).collect();
    let estimated = estimate_named(listed, &Limits::default()).unwrap();
    let no_chart = judged(&estimated.profile.model_for(source.light.xy));
    Case { camera, light, chart, told, chosen, no_chart }
}

fn cases(cameras: &[(&'static str, &'static str)], lights: &[&'static str], told: &[Told]) -> Vec<Case> {
    let all: Vec<_> = cameras
        .iter()
        .flat_map(|camera| lights.iter().map(move |light| (*camera, *light)))
        .flat_map(|(camera, light)| CHARTS.map(|chart| (camera, light, chart)))
        .collect();
    all.into_par_iter().map(|(camera, light, chart)| case(camera, light, chart, told)).collect()
}

fn mean(of: impl Iterator<Item = f64> + Clone) -> f64 {
    of.clone().sum::<f64>() / of.count() as f64
}

/// Mean over cases, of those that have it.
fn column(cases: &[&Case], i: usize) -> f64 {
    mean(cases.iter().filter_map(|c| c.told[i]))
}

/// The whole table: half an hour of CPU time.
#[test]
#[ignore = "long: run by name, with `--ignored --nocapture`"]
fn the_default_is_nearly_as_good_as_true_spectra_under_nine_lights() {
    let told = TOLD.map(|(_, told)| told);
    let all = cases(&CAMERAS, &LIGHTS, &told);
    let heads: Vec<&str> = TOLD.iter().map(|(name, _)| *name).collect();
    for chart in CHARTS {
        println!("{chart}: {} | no chart", heads.join(" | "));
        let row = |name: &str, of: &[&Case]| {
            let mut cells: Vec<String> = (0..TOLD.len()).map(|i| format!("{:.2}", column(of, i))).collect();
            cells.push(format!("{:.2}", mean(of.iter().map(|c| c.no_chart))));
            println!("  {name:28} {}", cells.join(" | "));
        };
        let mine: Vec<&Case> = all.iter().filter(|c| c.chart == chart).collect();
        for light in LIGHTS {
            let of: Vec<&Case> = mine.iter().filter(|c| c.light == light).copied().collect();
            let mut chosen: Vec<&str> = of.iter().map(|c| c.chosen.as_str()).collect();
            chosen.sort_unstable();
            chosen.dedup();
            row(&format!("{light} ({})", chosen.join(", ")), &of);
        }
        for (camera, _) in CAMERAS {
            row(camera, &mine.iter().filter(|c| c.camera == camera).copied().collect::<Vec<_>>());
        }
        let others: Vec<&Case> = mine.iter().filter(|c| c.light != "D50").copied().collect();
        row("all but D50", &others);
    }
    let others: Vec<&Case> = all.iter().filter(|c| c.light != "D50").collect();
    let [spectra, lab, nothing] = [0, 1, 2].map(|i| column(&others, i));
    println!(
        "both charts, all lights but D50: own spectra {spectra:.3}, own Lab {lab:.3}, nothing {nothing:.3}"
    );
    assert!(lab < spectra + 0.2, "{lab:.3} {spectra:.3}");
}

/// The same, small: each chart under lamps.
#[test]
#[cfg_attr(not(has_spectra), ignore = "needs `spectra` in DARKROOT_DATA")]
fn a_chart_of_which_nothing_is_told_serves_lamps() {
    let all = cases(&CAMERAS[1..2], &["A", "LED-RGB1"], &[Told::Spectra, Told::Lab, Told::Nothing]);
    for case in &all {
        println!(
            "{} {}: {:.3?}, {}; no chart {:.3}",
            case.chart, case.light, case.told, case.chosen, case.no_chart
        );
    }
    // BabelColor's charts are of the time before the makers changed their colours.
    assert!(all.iter().all(|case| case.chosen != "classic24" && case.chosen != "sg140"));
    let all: Vec<&Case> = all.iter().collect();
    let [spectra, lab, nothing] = [0, 1, 2].map(|i| column(&all, i));
    let no_chart = mean(all.iter().map(|c| c.no_chart));
    println!("own spectra {spectra:.3}, own Lab {lab:.3}, nothing told {nothing:.3}, no chart {no_chart:.3}");
    assert!(lab < spectra + 0.2, "{lab:.3} {spectra:.3}");
    assert!(nothing < no_chart, "{nothing:.3} {no_chart:.3}");
}
