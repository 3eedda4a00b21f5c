//! Cameras that are known by their published matrix alone.

use std::path::PathBuf;

use darkroot::evaluate::from_matrix::{Method, Request, evaluate};
use darkroot::evaluate::{ReflectanceSet, published};
use darkroot_colour::difference::de2000;
use darkroot_colour::temperature::Temperature;
use darkroot_colour::{Illuminant, Xyz, white};

use super::data;

fn files(begin: &str) -> Vec<PathBuf> {
    let all = std::fs::read_dir(data::folder()).unwrap().flatten().map(|entry| entry.path());
    let named = |path: &PathBuf| path.file_name().unwrap().to_string_lossy().starts_with(begin);
    let mut found: Vec<PathBuf> = all.filter(named).collect();
    found.sort();
    found
}

/// Every camera and its twins left out of prior and offsets; no surface that is judged on in the prior.
#[test]
#[cfg_attr(not(has_spectra), ignore = "needs `spectra` in DARKROOT_DATA")]
fn a_matrix_tells_as_much_as_a_chart() {
    let set = |name: &str, reflectances| ReflectanceSet { name: name.to_owned(), reflectances };
    let other: Vec<PathBuf> =
        files("cam_camspec_").into_iter().chain(files("cam_butcherg_")).step_by(2).collect();
    let outcome = evaluate(&Request {
        published: published::read(&data::folder().join("published_matrices_A_D65.csv")).unwrap(),
        prior: files("cam_rawtoaces_"),
        cameras: other,
        surfaces: data::surfaces_of_the_prior(),
        judged: vec![
            set("DC", data::dc_180()),
            set("rawtoaces", data::reflectances("refl_rawtoaces190")),
            set("Esser", data::reflectances("refl_iset_esserchart")),
        ],
        chart: Some(set("CC24", data::classic_24())),
        lights: ["D65", "A"].map(|l| darkroot::light::find(l).unwrap()).to_vec(),
        between: (400.0, 700.0),
    })
    .unwrap();
    for light in ["D65", "A"] {
        let mean = |method: Method| {
            let of = |r: &&darkroot::evaluate::from_matrix::Judgement| r.light == light;
            let all: Vec<f64> = outcome
                .results
                .iter()
                .filter(of)
                .flat_map(|r| r.errors.iter().filter(|(m, _)| *m == method).map(|(_, e)| e.mean))
                .collect();
            assert!(all.len() >= 12, "{} cameras", all.len());
            all.iter().sum::<f64>() / all.len() as f64
        };
        let [matrix, spectrum, white, chart] = Method::ALL.map(mean);
        println!(
            "{light}: matrix {matrix:.3}, estimate {spectrum:.3}, by the white {white:.3}, chart {chart:.3}"
        );
        assert!(spectrum < 0.65 * matrix && white < 0.65 * matrix, "{light}: {spectrum} {white} {matrix}");
        assert!(spectrum < 1.12 * chart, "{light}: {spectrum} {chart}");
    }
}

/// Neighbouring frames of a series may not jump: the model follows the white.
#[test]
#[cfg_attr(not(has_spectra), ignore = "needs `spectra` in DARKROOT_DATA")]
fn the_model_follows_the_white_without_a_jump() {
    const STEPS: i32 = 200;
    let patches = data::classic_24();
    let store = darkroot::ProfileStore::builtin();
    for camera in ["Nikon D850", "Canon EOS R5"] {
        let known = store.choose(camera).unwrap().profile.known_camera().unwrap().clone();
        let daylight = known.sensitivities().under(&Illuminant::by_name("D55").unwrap().spectrum()).unwrap();
        let rgb: Vec<[f64; 3]> = patches.iter().map(|p| daylight.rgb(p)).collect();
        let mut last: Option<Vec<Xyz>> = None;
        let mut largest: f64 = 0.0;
        for step in 0..=STEPS {
            let share = f64::from(step) / f64::from(STEPS);
            let mired = 400.0 + share * (100.0 - 400.0);
            let tint = -30.0 + 60.0 * share;
            let model = known.model_for(Temperature::from_kelvin_tint(1e6 / mired, tint).xy());
            let xyz: Vec<Xyz> = rgb.iter().map(|rgb| model.xyz(*rgb)).collect();
            if let Some(last) = &last {
                for (a, b) in last.iter().zip(&xyz) {
                    largest = largest.max(de2000(a.lab(white::D50), b.lab(white::D50)));
                }
            }
            last = Some(xyz);
        }
        println!("{camera}: neighbours differ by {largest:.3} at most");
        assert!(largest < 0.5, "{camera}: {largest}");
    }
}
