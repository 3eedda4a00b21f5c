//! What both evaluations of known cameras do: names of cameras, what counts of a light, and surfaces that may not help.

use std::path::Path;

use darkroot_colour::Spectrum;

use super::ReflectanceSet;
use super::published::key;
use crate::ProfileStore;

/// Names of the camera in a file of sensitivities, as [`key`]s: those that a built-in profile gives for the file, or the file's
/// own, `cam_SOURCE_MAKE_MODEL.csv`. There is at least one.
pub(super) fn names(built_in: &ProfileStore, path: &Path) -> Vec<String> {
    let file = path.file_name().unwrap_or_default().to_string_lossy();
    let profile = built_in.all().into_iter().find(|found| found.profile.origin().sensitivities == file);
    match profile.map(|found| found.profile.camera().clone()) {
        Some(camera) => std::iter::once(camera.name()).chain(camera.aliases).map(|name| key(&name)).collect(),
        None => vec![key(&of_file(path))],
    }
}

/// "nikon d700" for `cam_source_nikon_d700.csv`.
fn of_file(path: &Path) -> String {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let parts: Vec<&str> = stem.split('_').collect();
    let first = if parts.first() == Some(&"cam") { 2 } else { 0 };
    parts.get(first..).unwrap_or_default().join(" ")
}

/// The surfaces of which none is judged on.
pub(super) fn without_judged(surfaces: &[Spectrum], judged: &[ReflectanceSet]) -> Vec<Spectrum> {
    let is_judged = |s: &Spectrum| judged.iter().flat_map(|set| &set.reflectances).any(|j| near(s, j));
    surfaces.iter().filter(|s| !is_judged(s)).cloned().collect()
}

/// Whether two reflectances are the same measurement.
fn near(a: &Spectrum, b: &Spectrum) -> bool {
    a.0.iter().zip(&b.0).all(|(a, b)| (a - b).abs() < 1e-6)
}

/// The light, dark outside of the wavelengths that count.
pub(super) fn cut(light: &Spectrum, (first, last): (f64, f64)) -> Spectrum {
    let counts = |nm: f64| (first..=last).contains(&nm);
    Spectrum(std::array::from_fn(|i| if counts(Spectrum::wavelength(i)) { light.0[i] } else { 0.0 }))
}
