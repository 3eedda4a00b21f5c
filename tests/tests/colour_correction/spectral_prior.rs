//! The spectral prior on colours, cameras and lights that it never saw. The prior is built from the eleven cameras
//! of rawtoaces, without the one that is tested; its reflectances are none of those that are judged.

use darkroot_colour::{Spectrum, Xyz};
use darkroot_profile::fit::metric::lab_derivatives;
use darkroot_profile::fit::population::Population;
use darkroot_profile::fit::prior::Prior;
use darkroot_profile::fit::virtual_set::VirtualSet;
use darkroot_profile::fit::{self, Knowledge, Samples, spectral};
use darkroot_profile::{Errors, Kind, Model};
use rayon::prelude::*;

use super::data;
use super::held_out::{cases, unseen};

/// The cameras of the prior.
const CAMERAS: [&str; 11] = [
    "nikon_d70",
    "nikon_d200",
    "nikon_d700",
    "nikon_d5100",
    "nikon_d7000",
    "canon_eos_5d_mark_ii",
    "canon_xti",
    "canon_powershot_s90",
    "sony_ilce-7rm2",
    "sony_ilce-7sm2",
    "arri_d21",
];
/// The prior for a test camera under a light: all cameras but those of the same model.
fn prior(test: &str, light: &Spectrum) -> Prior {
    let others = CAMERAS.iter().filter(|name| !test.ends_with(*name));
    let others: Vec<_> = others.map(|name| data::camera(&format!("rawtoaces_{name}"))).collect();
    Prior::under(&Population::of(&others, usize::MAX).unwrap(), light).unwrap()
}

fn surfaces() -> VirtualSet {
    VirtualSet::of(&data::surfaces_of_the_prior())
}

/// Normal noise of standard deviation 1 from a simple generator, the same on every machine.
struct Noise(u64);

impl Noise {
    fn uniform(&mut self) -> f64 {
        // SplitMix64 (Steele, Lea, Flood 2014).
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (((z ^ (z >> 31)) >> 11) as f64 + 0.5) / (1u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        (-2.0 * self.uniform().ln()).sqrt() * (std::f64::consts::TAU * self.uniform()).cos()
    }
}

/// Share of the points of the RGB cube where the determinant of the derivatives has another sign than elsewhere.
fn folds(model: &Model) -> f64 {
    const LEVELS: [f64; 6] = [0.02, 0.1, 0.25, 0.5, 0.75, 1.0];
    let points = (0..216).map(|i| [LEVELS[i / 36], LEVELS[i / 6 % 6], LEVELS[i % 6]]);
    let mut determinants: Vec<f64> = points.map(|rgb| model.jacobian(rgb).determinant()).collect();
    determinants.sort_by(f64::total_cmp);
    let sign = determinants[108].signum();
    determinants.iter().filter(|d| *d * sign <= 0.0).count() as f64 / 216.0
}

/// Noise in dark saturated colours against that of the matrix by least squares: the largest of three.
fn noise_growth(model: &Model, samples: &Samples) -> f64 {
    const DARK: [[f64; 3]; 3] = [[0.02, 0.004, 0.003], [0.003, 0.006, 0.02], [0.004, 0.015, 0.005]];
    let linear = fit::fit(samples, Kind::Linear).unwrap().fit.model;
    let noise = |model: &Model, rgb: [f64; 3]| {
        (lab_derivatives(model.xyz(rgb), samples.white()) * model.jacobian(rgb)).norm()
    };
    DARK.into_iter().map(|rgb| noise(model, rgb) / noise(&linear, rgb)).fold(0.0, f64::max)
}

/// Mean, maximum, folds and noise of one case.
type Case = (f64, f64, f64, f64);

struct Held {
    mean: f64,
    max: f64,
    worst_folds: f64,
    noise: f64,
    worst_noise: f64,
}

/// Means over all cameras and lights.
fn held_out(chart: &[Spectrum], kind: Kind, noise: f64) -> Held {
    held_out_with(chart, kind, noise, &surfaces(), prior)
}

/// The same with another virtual set and another prior.
fn held_out_with(
    chart: &[Spectrum],
    kind: Kind,
    noise: f64,
    set: &VirtualSet,
    prior: impl Fn(&str, &Spectrum) -> Prior + Sync,
) -> Held {
    let unseen = unseen();
    let one = |(number, (camera, name)): (usize, (&str, &str))| {
        let light = data::light(name);
        let effective = data::camera(camera).under(&light).unwrap();
        let clean = effective.render(chart, &light).unwrap();
        let mut source = Noise(number as u64 + 1);
        let rgb = clean
            .rgb()
            .iter()
            .map(|rgb| rgb.map(|v| (v * (1.0 + noise * source.normal())).max(1e-5)))
            .collect();
        let samples = Samples::new(rgb, clean.xyz().to_vec(), clean.white()).unwrap();
        let prior = prior(camera, &light);
        let knowledge = Knowledge { reflectances: chart, light: &light, prior: &prior, set };
        let model = spectral::model_only(&samples, knowledge, kind).unwrap();
        let truth = effective.render(&unseen, &light).unwrap();
        let estimates: Vec<Xyz> = truth.rgb().iter().map(|rgb| model.xyz(*rgb)).collect();
        let s = Errors::between(&estimates, truth.xyz(), truth.white()).de2000;
        (s.mean, s.max, folds(&model), noise_growth(&model, &clean))
    };
    // Noise is drawn several times for each case.
    let rounds = if noise > 0.0 { 4 } else { 1 };
    let all: Vec<Case> =
        (0..rounds).flat_map(|_| cases()).collect::<Vec<_>>().into_par_iter().enumerate().map(one).collect();
    let mean = |f: &dyn Fn(&Case) -> f64| all.iter().map(f).sum::<f64>() / all.len() as f64;
    Held {
        mean: mean(&|v| v.0),
        max: mean(&|v| v.1),
        worst_folds: all.iter().map(|v| v.2).fold(0.0, f64::max),
        noise: mean(&|v| v.3),
        worst_noise: all.iter().map(|v| v.3).fold(0.0, f64::max),
    }
}

fn assert_held_out(kind: Kind, chart: &[Spectrum], noise: f64, mean: f64, max: f64) {
    let held = held_out(chart, kind, noise);
    println!(
        "{kind} on {} patches, noise {noise}: mean {:.3} max {:.2} folds {:.3} noise x{:.2} (worst x{:.2})",
        chart.len(),
        held.mean,
        held.max,
        held.worst_folds,
        held.noise,
        held.worst_noise
    );
    assert!(held.noise <= 1.2, "noise x{:.3}", held.noise);
    assert!(held.mean <= mean && held.max <= max, "{kind}: {:.3} {:.2}", held.mean, held.max);
    assert!(held.worst_folds <= 0.0, "{kind} folds {:.3} of the cube", held.worst_folds);
}

#[test]
#[cfg_attr(not(has_spectra), ignore = "needs `spectra` in DARKROOT_DATA")]
fn the_chromatic_model_is_as_good_as_it_should_be() {
    assert_held_out(Kind::Chromatic, &data::classic_24(), 0.0, 0.595, 2.92);
    assert_held_out(Kind::Chromatic, &data::sg_96(), 0.0, 0.595, 2.92);
}

#[test]
#[cfg_attr(not(has_spectra), ignore = "needs `spectra` in DARKROOT_DATA")]
fn the_chromatic_model_stands_noisy_patches() {
    assert_held_out(Kind::Chromatic, &data::classic_24(), 0.03, 0.77, 3.5);
}

#[test]
#[cfg_attr(not(has_spectra), ignore = "needs `spectra` in DARKROOT_DATA")]
fn the_spectral_model_is_as_good_as_it_should_be() {
    assert_held_out(Kind::Spectral, &data::classic_24(), 0.0, 0.58, 2.9);
    assert_held_out(Kind::Spectral, &data::sg_96(), 0.0, 0.58, 2.9);
}

#[test]
#[cfg_attr(not(has_spectra), ignore = "needs `spectra` in DARKROOT_DATA")]
fn the_spectral_model_stands_noisy_patches() {
    assert_held_out(Kind::Spectral, &data::classic_24(), 0.03, 0.77, 3.5);
}

/// Not held out: the cameras and reflectances of the built-in statistics are among those judged here.
#[test]
#[cfg_attr(not(has_spectra), ignore = "needs `spectra` in DARKROOT_DATA")]
fn the_statistics_in_the_program_are_as_good_as_the_spectra() {
    let set = VirtualSet::builtin().unwrap();
    let cameras = Population::builtin().unwrap();
    let prior = |_: &str, light: &Spectrum| Prior::under(&cameras, light).unwrap();
    for kind in [Kind::Spectral, Kind::Chromatic] {
        let held = held_out_with(&data::classic_24(), kind, 0.0, set, prior);
        println!("built in, {kind}: mean {:.3} max {:.2} folds {:.3}", held.mean, held.max, held.worst_folds);
        assert!(held.mean < 0.60 && held.max < 3.1 && held.worst_folds <= 0.0);
    }
}
