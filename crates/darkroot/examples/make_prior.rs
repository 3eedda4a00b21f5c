//! Makes the statistics of the spectral prior that are built into the program (crates/profile/data) from published
//! spectra: `cargo run --release -p darkroot --example make_prior -- SPECTRA crates/profile/data`.
//!
//! Mean and first principal components of the sensitivities of eleven cameras, and representative reflectances
//! (means of clusters, reduced to their first principal components). The spectra themselves are not in this
//! repository.

use std::path::{Path, PathBuf};

use darkroot::spectra;
use darkroot_colour::Spectrum;
use darkroot_profile::fit::population::{Population, format_reflectances, smoothed};
use darkroot_profile::fit::representatives::clusters;

/// Apache-2.0, from rawtoaces.
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
/// Apache-2.0 (rawtoaces) and MIT (ISETCam).
const REFLECTANCES: [&str; 14] = [
    "rawtoaces190",
    "iset_africanamerican_vhrel",
    "iset_caucasian_vhrel",
    "iset_clothes_vhrel",
    "iset_dupontpaintchip_vhrel",
    "iset_eastindian_vhrel",
    "iset_esserchart",
    "iset_food_vhrel",
    "iset_gretagdigitalcolorsg",
    "iset_hair_vhrel",
    "iset_macbethchart",
    "iset_munsellsamples_vhrel",
    "iset_nature_vhrel",
    "iset_objects_vhrel",
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
    std::fs::write(to.join("reflectances.csv"), reflectances(from)?)?;
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

fn reflectances(from: &Path) -> Result<String, Box<dyn std::error::Error>> {
    let mut all: Vec<Spectrum> = Vec::new();
    for name in REFLECTANCES {
        all.extend(spectra::read(&from.join(format!("refl_{name}.csv")))?.reflectances());
    }
    let clusters = clusters(&all, CLUSTERS);
    let means: Vec<Spectrum> = clusters.iter().map(|c| c.mean.clone()).collect();
    let weights = clusters.iter().map(|c| (c.members.len() as f64).sqrt());
    let representative: Vec<(Spectrum, f64)> =
        smoothed(&means, &all, SHAPES).into_iter().zip(weights).collect();
    Ok(format_reflectances(&representative))
}
