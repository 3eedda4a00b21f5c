//! Shots of a chart, tilted, uneven, noisy and with glare, to profiles that are as good as fits to true values.

use chart::{Reference, ReferenceColour};
use colour::measured::Measured;
use colour::{Spectrum, Vector3, Xyz, adaptation, white};
use darkroot::{ChartRequest, Settings, ShotOptions, make_profile};
use photo::Size;
use profile::fit::population::Population;
use profile::fit::prior::Prior;
use profile::fit::virtual_set::VirtualSet;
use profile::fit::{self, Knowledge, spectral};
use profile::spectra::white as white_of;
use profile::{Errors, Kind, Model, Sensitivities};
use simulate::{Camera, Exposure, Scene, dng, expose::expose};

use super::data;
use super::held_out::unseen;

/// Size and corners for charts of few patches; those of many are twice as large.
const SIZE: Size = Size { width: 608, height: 408 };
const CORNERS: [[f64; 2]; 4] = [[70.0, 60.0], [530.0, 84.0], [512.0, 352.0], [84.0, 340.0]];

/// Mean dE2000 on colours that the fit has not seen.
fn judged(model: &Model, camera: &Sensitivities, light: &Spectrum) -> f64 {
    let samples = camera.under(light).unwrap().render(&unseen(), light).unwrap();
    let back = adaptation::bradford(white::D50, white_of(light));
    let estimate = |rgb: &[f64; 3]| Xyz::from(back * Vector3::from(model.xyz(*rgb)));
    let estimates: Vec<Xyz> = samples.rgb().iter().map(estimate).collect();
    Errors::between(&estimates, samples.xyz(), samples.white()).de2000.mean
}

/// The same kind of model fitted to what the camera really makes of the patches.
fn ideal(kind: Kind, camera: &Sensitivities, light: &Spectrum, patches: &[Spectrum]) -> Model {
    let samples = camera.under(light).unwrap().render(patches, light).unwrap();
    let model = match kind {
        Kind::Spectral | Kind::Chromatic => {
            let prior = Prior::under(&Population::builtin().unwrap(), light).unwrap();
            let set = VirtualSet::builtin().unwrap();
            let knowledge = Knowledge { reflectances: patches, light, prior: &prior, set: &set };
            spectral::model_only(&samples, knowledge, kind).unwrap()
        }
        _ => fit::fit(&samples, kind).unwrap().fit.model,
    };
    model.then(&adaptation::bradford(samples.white(), white::D50))
}

fn shot(camera: &str, light_name: &str, layout: &str, patches: &[Spectrum]) -> (f64, f64, Kind) {
    let light = darkroot::light::find(light_name).unwrap();
    let spectrum = light.spectrum.clone().unwrap();
    let sensitivities = data::camera(camera);
    let body = Camera { sensitivities: sensitivities.0.clone(), ..Camera::simulated_one() };
    let exposure = Exposure {
        light: spectrum.clone(),
        falloff: 0.3,
        glare: 0.01,
        noise: Some(5),
        ..Exposure::default()
    };
    let layout = darkroot::charts::layout(layout).unwrap();
    let scale = if patches.len() > 50 { 2 } else { 1 };
    let size = Size { width: SIZE.width * scale, height: SIZE.height * scale };
    let corners = CORNERS.map(|p| p.map(|v| v * scale as f64));
    let scene = Scene::chart(size, corners, patches, layout.columns, layout.gap);
    let folder = std::env::temp_dir().join(format!(
        "darkroot-{}-{camera}-{light_name}-{}",
        std::process::id(),
        layout.name
    ));
    std::fs::create_dir_all(&folder).unwrap();
    let write = |name: &str, scene: &Scene| {
        let path = folder.join(name);
        std::fs::write(&path, dng::write(&expose(scene, &body, &exposure), dng::Storage::Uncompressed))
            .unwrap();
        path
    };
    let file = write("chart.dng", &scene);
    let flat = write("flat.dng", &Scene::flat(size, Spectrum::constant(0.5)));
    let nm: Vec<f64> = (0..81).map(Spectrum::wavelength).collect();
    let colours = layout.patches.iter().zip(patches).map(|(place, s)| {
        (place.name.clone(), ReferenceColour::Reflectance(Measured::new(&nm, &s.0).unwrap()))
    });
    let request = ChartRequest {
        shots: vec![(file, light)],
        reference: Reference { patches: colours.collect() },
        layout,
        reference_name: String::new(),
        reference_sha256: String::new(),
        options: ShotOptions {
            flat: Some(flat),
            correct_glare: true,
            accept: true,
            ..ShotOptions::default()
        },
        average: false,
        kind: None,
        date: String::new(),
    };
    let made = make_profile(&request, &Settings::default()).unwrap();
    std::fs::remove_dir_all(&folder).unwrap();
    let calibration = &made.profile.calibrations()[0];
    let ideal = ideal(calibration.kind, &sensitivities, &spectrum, patches);
    let found = judged(&calibration.model, &sensitivities, &spectrum);
    (found, judged(&ideal, &sensitivities, &spectrum), calibration.kind)
}

#[test]
fn a_shot_makes_a_profile_nearly_as_good_as_true_values() {
    if data::folder().is_none() {
        return;
    }
    let classic = data::classic_24();
    let sg = data::sg_140();
    let mut worst: f64 = 0.0;
    let mut sum = (0.0, 0.0);
    for camera in ["camspec_nikon_d90", "camspec_canon_40d", "camspec_pentax_k5"] {
        for light in ["D50", "A", "LED-B3"] {
            for (layout, patches) in [("classic24", &classic), ("sg140", &sg)] {
                let (found, ideal, kind) = shot(camera, light, layout, patches);
                println!("{camera} {light} {layout}: {kind} {found:.3}, from true values {ideal:.3}");
                worst = worst.max(found - ideal);
                sum = (sum.0 + found - ideal, sum.1 + 1.0);
            }
        }
    }
    println!("worse than true values by {:.3} in the mean, {worst:.3} at most", sum.0 / sum.1);
    assert!(sum.0 / sum.1 <= 0.15 && worst <= 0.25, "{:.3} {worst:.3}", sum.0 / sum.1);
}
