//! The profiles that are built into the program, against the spectra that they were made from.

use darkroot::ProfileStore;
use darkroot_colour::illuminant::Illuminant;
use darkroot_colour::{Spectrum, Vector3, Xyz, adaptation, white};
use darkroot_profile::lint::{Severity, check};
use darkroot_profile::spectra::white as white_of;
use darkroot_profile::{Errors, Kind, Model, Sensitivities};

use super::data;

/// Make and model of each profile, and its sensitivities.
const CAMERAS: [(&str, &str); 11] = [
    ("ARRI D-21", "rawtoaces_arri_d21"),
    ("Canon EOS 5D Mark II", "rawtoaces_canon_eos_5d_mark_ii"),
    ("Canon EOS 400D", "rawtoaces_canon_xti"),
    ("Canon PowerShot S90", "rawtoaces_canon_powershot_s90"),
    ("Nikon D70", "rawtoaces_nikon_d70"),
    ("Nikon D200", "rawtoaces_nikon_d200"),
    ("Nikon D700", "rawtoaces_nikon_d700"),
    ("Nikon D5100", "rawtoaces_nikon_d5100"),
    ("Nikon D7000", "rawtoaces_nikon_d7000"),
    ("Sony ILCE-7RM2", "rawtoaces_sony_ilce-7rm2"),
    ("Sony ILCE-7SM2", "rawtoaces_sony_ilce-7sm2"),
];

#[test]
fn every_profile_passes_the_lint_and_shows_its_figures() {
    let store = ProfileStore::builtin();
    for (name, _) in CAMERAS {
        let found = store.choose(name).unwrap();
        let lights: Vec<&str> = found.profile.calibrations().iter().map(|c| c.light.name.as_str()).collect();
        assert!(lights.starts_with(&["D65"]) && lights.ends_with(&["A"]), "{name}: {lights:?}");
        for calibration in found.profile.calibrations() {
            assert_eq!(calibration.kind, Kind::Spectral);
            assert!(calibration.figures.held_out.is_some() && calibration.figures.leave_one_out.is_some());
            for finding in check(calibration) {
                assert!(finding.severity < Severity::Failure, "{name}: {finding:?}");
            }
        }
        assert!(!found.profile.origin().reference_sha256.is_empty());
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
fn lights_between_the_calibrations_are_nearly_as_good() {
    let store = ProfileStore::builtin();
    let judge = data::reflectances("refl_iset_esserchart");
    for (light, most) in [("D65", 1.3), ("D55", 1.3), ("D50", 1.6), ("A", 1.7)] {
        let spectrum = Illuminant::by_name(light).unwrap().spectrum();
        let kelvin = darkroot_colour::temperature::Temperature::of(spectrum.white().xy().unwrap()).kelvin;
        let mut sum = 0.0;
        for (name, file) in CAMERAS {
            let camera = data::camera(file);
            let model = store.choose(name).unwrap().profile.model_for(kelvin);
            let e = errors(&model, &camera, &spectrum, &judge).de2000;
            println!("{light} {name}: {:.2} {:.2} {:.2}", e.mean, e.p95, e.max);
            assert!(e.mean < most, "{light} {name}: {e:?}");
            sum += e.mean;
        }
        println!("{light}: mean over cameras {:.3}", sum / CAMERAS.len() as f64);
    }
}

#[test]
#[cfg_attr(not(has_spectra), ignore = "needs `spectra` in DARKROOT_DATA")]
fn the_script_makes_the_same_files_again() {
    let spectra = data::folder();
    // The first of the script's profiles, by the same library call.
    let request = darkroot::FromSpectra {
        camera: ProfileStore::builtin().choose("Nikon D700").unwrap().profile.camera().clone(),
        sensitivities: spectra.join("cam_rawtoaces_nikon_d700.csv"),
        lights: ["D65", "D50", "A"].map(|l| darkroot::light::find(l).unwrap()).to_vec(),
        reflectances: [
            "rawtoaces190",
            "iset_clothes_vhrel",
            "iset_dupontpaintchip_vhrel",
            "iset_food_vhrel",
            "iset_hair_vhrel",
            "iset_munsellsamples_vhrel",
            "iset_nature_vhrel",
            "iset_objects_vhrel",
            "iset_africanamerican_vhrel",
            "iset_caucasian_vhrel",
            "iset_eastindian_vhrel",
            "iset_macbethchart",
        ]
        .map(|n| spectra.join(format!("refl_{n}.csv")))
        .to_vec(),
        held_out: ["iset_esserchart", "iset_gretagdigitalcolorsg"]
            .map(|n| spectra.join(format!("refl_{n}.csv")))
            .to_vec(),
        kind: Kind::Spectral,
        date: "2026-11-22".to_owned(),
    };
    let text = darkroot_profile::file::format(&darkroot::from_spectra(&request).unwrap());
    let shipped =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../profiles/nikon/d700.toml")).unwrap();
    assert_eq!(text, shipped);
}
