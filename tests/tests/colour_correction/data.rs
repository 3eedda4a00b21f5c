//! The measured spectra, by name.

use std::path::PathBuf;

use darkroot::spectra;
use darkroot_colour::Spectrum;
use darkroot_colour::illuminant::Illuminant;
use darkroot_profile::Sensitivities;
use darkroot_profile::spectra::in_31_channels;

/// The folder of spectra. Tests that need it are ignored where it is not (`tests/build.rs`).
pub(super) fn folder() -> PathBuf {
    darkroot_tests::real_files("spectra")
}

fn file(name: &str) -> PathBuf {
    folder().join(name).with_extension("csv")
}

/// A camera of the data folder.
pub(super) fn camera(name: &str) -> Sensitivities {
    spectra::read_sensitivities(&file(&format!("cam_{name}"))).unwrap().0
}

/// Reflectances of a file, all of them.
pub(super) fn reflectances(name: &str) -> Vec<Spectrum> {
    spectra::read(&file(name)).unwrap().reflectances()
}

/// A light in the papers' 31 channels.
pub(super) fn light(name: &str) -> Spectrum {
    in_31_channels(&Illuminant::by_name(name).unwrap().spectrum())
}

fn listed(name: &str, list: &str) -> Vec<Spectrum> {
    let names = std::fs::read_to_string(folder().join(list)).unwrap();
    let names: Vec<String> = names.split_whitespace().map(str::to_owned).collect();
    spectra::read(&file(name)).unwrap().only(&names).unwrap().reflectances()
}

/// The 24 patches of the classic chart.
pub(super) fn classic_24() -> Vec<Spectrum> {
    reflectances("colorchecker_classic24_babelcolor_380-730_10")
}

/// Surfaces that a prior may rest on where DC-180, rawtoaces 190, Esser and clothes judge: none of these is among them.
pub(super) fn surfaces_of_the_prior() -> Vec<Spectrum> {
    SURFACES.iter().flat_map(|name| reflectances(&format!("refl_iset_{name}"))).collect()
}

const SURFACES: [&str; 11] = [
    "dupontpaintchip_vhrel",
    "food_vhrel",
    "hair_vhrel",
    "munsellsamples_vhrel",
    "nature_vhrel",
    "objects_vhrel",
    "gretagdigitalcolorsg",
    "macbethchart",
    "africanamerican_vhrel",
    "caucasian_vhrel",
    "eastindian_vhrel",
];

/// The 96 inner patches of the Digital SG.
pub(super) fn sg_96() -> Vec<Spectrum> {
    listed("colorchecker_sg_all_380-730_1", "sg96_patch_names.txt")
}

/// The 180 inner patches of the DC.
pub(super) fn dc_180() -> Vec<Spectrum> {
    listed("colorchecker_dc_all_380-730_1", "dc180_patch_names.txt")
}

/// The 1995 reflectances of Simon Fraser University.
pub(super) fn sfu_1995() -> Vec<Spectrum> {
    reflectances("sfu1995_380-780_4")
}

/// All 140 patches of the Digital SG, row by row.
pub(super) fn sg_140() -> Vec<Spectrum> {
    let names: Vec<String> =
        (1..=10).flat_map(|row| ('A'..='N').map(move |column| format!("{column}{row}"))).collect();
    let file = spectra::read(&file("colorchecker_sg_all_380-730_1")).unwrap();
    file.only(&names).unwrap().reflectances()
}
