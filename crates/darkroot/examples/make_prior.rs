//! Makes the statistics of the spectral prior that are built into the program (crates/profile/data) from published
//! spectra: `cargo run --release -p darkroot --example make_prior -- SPECTRA crates/profile/data`.
//!
//! Mean and first principal components of the sensitivities of eleven cameras, representative reflectances (means of
//! clusters, reduced to their first principal components), and how published matrices differ from computed ones. The
//! spectra themselves are not in this repository. The last needs the profiles of `profiles/`, and these the program: so
//! `profiles/make.sh` comes first.

use std::path::{Path, PathBuf};

use darkroot::evaluate::published;
use darkroot::{ProfileStore, spectra};
use darkroot_colour::{Illuminant, Spectrum};
use darkroot_profile::camera::{Difference, Regression, computed, families, offsets};
use darkroot_profile::fit::population::{Population, format_reflectances, parse_reflectances, smoothed};
use darkroot_profile::fit::representatives::clusters;

/// Apache-2.0, from rawtoaces: the cameras of the prior for charts.
const CAMERAS: [&str; 11] = [
    "arri_d21",
    "canon_eos_5d_mark_ii",
    "canon_powershot_s90",
    "canon_xti",
    "nikon_d200",
    "nikon_d5100",
    "nikon_d70",
    "nikon_d700",
    "nikon_d7000",
    "sony_ilce-7rm2",
    "sony_ilce-7sm2",
];
/// Apache-2.0 (rawtoaces) and MIT (ISETCam). Two charts of ISETCam, Esser's and the SG, judge what ships and take no part.
const REFLECTANCES: [&str; 12] = [
    "rawtoaces190",
    "iset_africanamerican_vhrel",
    "iset_caucasian_vhrel",
    "iset_clothes_vhrel",
    "iset_dupontpaintchip_vhrel",
    "iset_eastindian_vhrel",
    "iset_food_vhrel",
    "iset_hair_vhrel",
    "iset_macbethchart",
    "iset_munsellsamples_vhrel",
    "iset_nature_vhrel",
    "iset_objects_vhrel",
];
/// Sets of surfaces that people compute matrices from: a chart, paints and papers, natural and made things.
const TRAINING: [&[&str]; 4] = [
    &["iset_macbethchart"],
    &["iset_munsellsamples_vhrel"],
    &["iset_nature_vhrel", "iset_food_vhrel"],
    &["iset_objects_vhrel", "iset_dupontpaintchip_vhrel"],
];
/// Principal components kept of each channel; four give the same errors.
const COMPONENTS: usize = 6;
/// Clusters of reflectances, and principal components kept of them.
const CLUSTERS: usize = 160;
const SHAPES: usize = 10;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    let [from, to] = &arguments[..] else {
        return Err("give the folder of spectra and the folder to write to".into());
    };
    std::fs::write(to.join("sensitivities.csv"), sensitivities(from)?)?;
    let representative = reflectances(from)?;
    std::fs::write(to.join("reflectances.csv"), format_reflectances(&representative))?;
    let written = parse_reflectances(&format_reflectances(&representative)).ok_or("no reflectances")?;
    std::fs::write(to.join("offsets.csv"), offsets(from, &written)?)?;
    Ok(())
}

fn sensitivities(from: &Path) -> Result<String, Box<dyn std::error::Error>> {
    let mut cameras = Vec::new();
    for name in CAMERAS {
        cameras.push(spectra::read_sensitivities(&from.join(format!("cam_rawtoaces_{name}.csv")))?.0);
    }
    let population = Population::of(&cameras, COMPONENTS).ok_or("the cameras see nothing")?;
    Ok(population.format())
}

fn reflectances(from: &Path) -> Result<Vec<(Spectrum, f64)>, Box<dyn std::error::Error>> {
    let all = read(from, &REFLECTANCES)?;
    let clusters = clusters(&all, CLUSTERS);
    let means: Vec<Spectrum> = clusters.iter().map(|c| c.mean.clone()).collect();
    let weights = clusters.iter().map(|c| (c.members.len() as f64).sqrt());
    Ok(smoothed(&means, &all, SHAPES).into_iter().zip(weights).collect())
}

fn read(from: &Path, names: &[&str]) -> Result<Vec<Spectrum>, Box<dyn std::error::Error>> {
    let mut all = Vec::new();
    for name in names {
        all.extend(spectra::read(&from.join(format!("refl_{name}.csv")))?.reflectances());
    }
    Ok(all)
}

/// How the published D65 matrices of the cameras whose sensitivities are built in differ from those that their
/// sensitivities give through the representative reflectances, and how computed ones do.
fn offsets(from: &Path, surfaces: &[(Spectrum, f64)]) -> Result<String, Box<dyn std::error::Error>> {
    let published = published::read(&from.join("published_matrices_A_D65.csv"))?;
    let light = Illuminant::by_name("D65").ok_or("no D65")?.spectrum();
    let regression = Regression::under(&light, surfaces).ok_or("the reflectances determine no matrix")?;
    let sets = TRAINING.iter().map(|names| read(from, names)).collect::<Result<Vec<_>, _>>()?;
    let (mut known, mut own) = (Vec::new(), Vec::new());
    for found in ProfileStore::builtin().all() {
        let camera = found.profile.known_camera().ok_or("a built-in profile without sensitivities")?;
        own.extend(computed(&regression, &light, camera.sensitivities(), &sets));
        match published::of(&published, found.profile.camera()) {
            Some(matrix) => known.extend(Difference::of(&regression, camera.sensitivities(), &matrix)),
            None => eprintln!("{}: no published matrix", found.profile.camera().name()),
        }
    }
    Ok(offsets::format(&families(&known, &own)))
}
