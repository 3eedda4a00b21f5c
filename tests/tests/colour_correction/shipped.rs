//! The profiles that are built into the program, against the spectra that they were made from.

use darkroot::ProfileStore;
use darkroot_colour::illuminant::Illuminant;
use darkroot_colour::{Spectrum, Vector3, Xyz, adaptation, white};
use darkroot_profile::lint::{Severity, check};
use darkroot_profile::spectra::white as white_of;
use darkroot_profile::{Errors, Kind, Model, Profile, Sensitivities};

use super::data;

/// Every profile that is a camera: its name, itself, and the name of the file that it was made from.
fn cameras() -> Vec<(String, Profile, String)> {
    let all = ProfileStore::builtin();
    let known = all.all().into_iter().filter(|found| found.profile.known_camera().is_some());
    known
        .map(|found| {
            let file =
                found.profile.origin().sensitivities.trim_start_matches("cam_").trim_end_matches(".csv");
            (found.profile.camera().name(), found.profile.clone(), file.to_owned())
        })
        .collect()
}

#[test]
fn every_profile_passes_the_lint_and_shows_its_figures() {
    let cameras = cameras();
    assert_eq!(cameras.len(), 52);
    for (name, profile, _) in cameras {
        let lights: Vec<&str> = profile.calibrations().iter().map(|c| c.light.name.as_str()).collect();
        assert_eq!(lights, ["D65", "D50", "A"], "{name}");
        for calibration in profile.calibrations() {
            assert_eq!(calibration.kind, Kind::Spectral);
            assert!(calibration.figures.held_out.is_some(), "{name}");
            for finding in check(calibration) {
                assert!(finding.severity < Severity::Failure, "{name}: {finding:?}");
            }
        }
        assert!(!profile.origin().sensitivities_sha256.is_empty());
    }
}

/// Errors of a model (relative to D50) over reflectances under a light.
fn errors(model: &Model, camera: &Sensitivities, light: &Spectrum, set: &[Spectrum]) -> Errors {
    let samples = camera.under(light).unwrap().render(set, light).unwrap();
    let back = adaptation::bradford(white::D50, white_of(light));
    let estimate = |rgb: &[f64; 3]| Xyz::from(back * Vector3::from(model.xyz(*rgb)));
    let estimates: Vec<Xyz> = samples.rgb().iter().map(estimate).collect();
    Errors::between(&estimates, samples.xyz(), samples.white())
}

#[test]
#[cfg_attr(not(has_spectra), ignore = "needs `spectra` in DARKROOT_DATA")]
fn every_light_is_served_by_its_white_alone() {
    let judge = data::reflectances("refl_iset_esserchart");
    // Lamps are guessed from their white: less good than daylight, better than a matrix.
    for (light, mean, most) in
        [("D65", 0.77, 1.4), ("D55", 0.79, 1.4), ("D50", 0.80, 1.4), ("A", 0.89, 1.6), ("F11", 1.04, 1.7)]
    {
        let spectrum = Illuminant::by_name(light).unwrap().spectrum();
        let white = spectrum.white().xy().unwrap();
        let (mut sum, mut count) = (0.0, 0.0);
        for (name, profile, file) in cameras() {
            let e = errors(&profile.model_for(white), &data::camera(&file), &spectrum, &judge).de2000;
            println!("{light} {name}: {:.2} {:.2} {:.2}", e.mean, e.p95, e.max);
            assert!(e.mean < most, "{light} {name}: {e:?}");
            sum += e.mean;
            count += 1.0;
        }
        println!("{light}: mean over cameras {:.3}", sum / count);
        assert!(sum / count < mean, "{light}: {}", sum / count);
    }
}

#[test]
#[cfg_attr(not(has_spectra), ignore = "needs `spectra` in DARKROOT_DATA")]
fn the_script_makes_the_same_files_again() {
    let spectra = data::folder();
    // One of the script's profiles, by the same library call.
    let request = darkroot::FromSpectra {
        camera: ProfileStore::builtin().choose("Nikon D700").unwrap().profile.camera().clone(),
        sensitivities: spectra.join("cam_rawtoaces_nikon_d700.csv"),
        lights: ["D65", "D50", "A"].map(|l| darkroot::light::find(l).unwrap()).to_vec(),
        reflectances: Vec::new(),
        held_out: ["iset_esserchart", "iset_gretagdigitalcolorsg"]
            .map(|n| spectra.join(format!("refl_{n}.csv")))
            .to_vec(),
        kind: Kind::Spectral,
        date: "2026-11-26".to_owned(),
    };
    let text = darkroot_profile::file::format(&darkroot::from_spectra(&request).unwrap());
    let shipped =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../profiles/nikon/d700.toml")).unwrap();
    assert_eq!(text, shipped);
}
