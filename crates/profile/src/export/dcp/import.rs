//! A DCP as a Darkroot profile: a matrix for each hue near grey, and a smooth function of chromaticity for the rest.

use std::sync::Arc;

use darkroot_colour::{Matrix3, Vector3, Xyz, white};
use nalgebra::DMatrix;

use super::{Dcp, DcpLight, HueSatMap, light_of};
use crate::export::{DcpFault, Deviation, Error, deviation};
use crate::fit::least_squares::Problem;
use crate::hue_plane::{CORNERS, at_position};
use crate::model::Part as _;
use crate::residual::{Centre, direction, white_exact_kernel};
use crate::{Calibration, HuePlane, Kind, Model, Origin, Profile, ProfileCamera, Residual};

/// A DCP as a profile.
#[derive(Debug, Clone, PartialEq)]
pub struct Imported {
    /// The profile; its summary says in words what was taken and left out.
    pub profile: Profile,
    /// How far each calibration is from what the DCP says, bluest light first.
    pub deviations: Vec<Deviation>,
}

/// Steps along each side of the triangle of chromaticities (see [`chromaticities`]): of the grid on which bumps stand,
/// and of the finer grid on which they are fitted to the DCP's table.
const CENTRES: usize = 15;
const PLACES: usize = 60;

/// The profile of a DCP.
///
/// Near grey, matrices round the hues say what matrix and table of the file say together; the matrix' rows are scaled
/// so that white is white. Away from grey, bumps over chromaticity say what is left, smooth where the table has corners.
///
/// # Errors
/// Bytes that are no DCP, or one whose numbers give no model.
pub fn import(bytes: &[u8]) -> Result<Imported, Error> {
    let dcp = Dcp::read(bytes)?;
    let mut both = Vec::new();
    for light in &dcp.lights {
        let light = DcpLight {
            forward_matrix: white_preserving(&light.forward_matrix).ok_or(DcpFault::NoColours)?,
            ..light.clone()
        };
        let (kind, model) = model(&light).ok_or(DcpFault::NoColours)?;
        let calibration = Calibration::new(light_of(light.illuminant), kind, model);
        let off = deviation(&calibration, |rgb| light.xyz(rgb));
        both.push((calibration, off));
    }
    both.sort_by(|a, b| b.0.light.kelvin().total_cmp(&a.0.light.kelvin()));
    let (calibrations, deviations): (Vec<_>, Vec<Deviation>) = both.into_iter().unzip();
    let origin = Origin { summary: summary(&dcp, &deviations), ..Origin::default() };
    let profile = Profile::new(camera_of(&dcp.camera), calibrations, origin).ok_or(DcpFault::NoColours)?;
    let profile = profile.rendered_by(Some(Arc::new(dcp.rendering)));
    Ok(Imported { profile, deviations })
}

/// The camera that a DCP is for, without the work of making a profile of it.
///
/// # Errors
/// Bytes that are no DCP, or one whose matrices give no colours.
pub fn camera(bytes: &[u8]) -> Result<ProfileCamera, Error> {
    let dcp = Dcp::read(bytes)?;
    if dcp.lights.iter().any(|light| white_preserving(&light.forward_matrix).is_none()) {
        return Err(DcpFault::NoColours.into());
    }
    Ok(camera_of(&dcp.camera))
}

/// "Nikon D700": the first word is the maker.
fn camera_of(name: &str) -> ProfileCamera {
    let (make, model) = name.trim().split_once(' ').unwrap_or(("", name.trim()));
    ProfileCamera { make: make.to_owned(), model: model.trim().to_owned(), aliases: Vec::new() }
}

fn summary(dcp: &Dcp, deviations: &[Deviation]) -> String {
    let mean = deviations.iter().map(|d| d.de2000.mean).fold(0.0, f64::max);
    let max = deviations.iter().map(|d| d.de2000.max).fold(0.0, f64::max);
    let mut text = format!("DCP \"{}\", dE2000 from it mean {mean:.2}, max {max:.2} in sRGB", dcp.name);
    let looks =
        [(dcp.rendering.curve.is_some(), "tone curve"), (dcp.rendering.table.is_some(), "look table")];
    let looks: Vec<&str> = looks.into_iter().filter(|(there, _)| *there).map(|(_, what)| what).collect();
    if !looks.is_empty() {
        text += &format!("; with a {} for the look that takes them", looks.join(" and a "));
    }
    if !dcp.left_out.is_empty() {
        text += &format!("; without {}", dcp.left_out.join(", "));
    }
    text
}

fn white_preserving(matrix: &Matrix3) -> Option<Matrix3> {
    let scale = Vector3::from(white::D50).component_div(&(matrix * Vector3::repeat(1.0)));
    scale.iter().all(|s| s.is_finite() && *s > 0.0).then(|| Matrix3::from_diagonal(&scale) * matrix)
}

fn model(light: &DcpLight) -> Option<(Kind, Model)> {
    let forward = light.forward_matrix;
    if light.map == HueSatMap::neutral() {
        return Some((Kind::Linear, Model::linear(&forward)));
    }
    let near_grey = near_grey(light)?;
    let centres: Vec<[f64; 3]> = chromaticities(CENTRES);
    let places: Vec<[f64; 3]> = chromaticities(PLACES);
    let wanted: Vec<Vector3> = places.iter().map(|rgb| Vector3::from(light.xyz(*rgb))).collect();
    let kernels = DMatrix::from_fn(places.len(), centres.len(), |place, centre| {
        white_exact_kernel(&direction(places[place]), &direction(centres[centre]))
    });
    let mut weights = vec![[0.0; 3]; centres.len()];
    for k in 0..3 {
        // In CIELAB a difference counts by the cube root's slope, and less where colours are saturated.
        let weight = |i: usize| {
            let lab = Xyz::from(wanted[i]).lab(white::D50);
            wanted[i][k].max(0.02).powf(-2.0 / 3.0) / (1.0 + 0.045 * lab.chroma())
        };
        let missing = |i: usize| wanted[i][k] - Vector3::from(near_grey.xyz(places[i]))[k];
        let solved = fit(&kernels, |i| (weight(i), missing(i)))?;
        for (weight, solved) in weights.iter_mut().zip(solved) {
            weight[k] = solved;
        }
    }
    let bumps = centres.into_iter().zip(weights).map(|(rgb, weight)| Centre { rgb, weight }).collect();
    let model = Model { hue_plane: Some(near_grey), residual: Residual::new(bumps), ..Model::default() };
    Kind::Chromatic.fits(&model).then_some((Kind::Chromatic, model))
}

/// The matrices that keep white and give what the DCP gives for a little of each hue.
fn near_grey(light: &DcpLight) -> Option<HuePlane> {
    const HUES: usize = 36;
    /// Of the DCPs that RawTherapee ships, those tried came out best with 0.12 to 0.25.
    const A_LITTLE: f64 = 0.2;
    let knot = |i: usize| {
        let pure = Vector3::from(at_position(i as f64 * CORNERS as f64 / HUES as f64));
        let rgb = pure * A_LITTLE + Vector3::repeat(1.0 - A_LITTLE);
        let missing = Vector3::from(light.xyz(rgb.into())) - light.forward_matrix * rgb;
        // Along this axis greys are 0 and the pure colour is 1.
        let chroma = pure - Vector3::repeat(pure.mean());
        light.forward_matrix + missing / A_LITTLE * (chroma / chroma.norm_squared()).transpose()
    };
    HuePlane::new((0..HUES).map(knot).collect())
}

/// Weights of the bumps for one of X, Y and Z by ridge regression; `row` gives weight and target of a place.
fn fit(kernels: &DMatrix<f64>, row: impl Fn(usize) -> (f64, f64)) -> Option<Vec<f64>> {
    const RIDGE: f64 = 1e-4;
    let (places, bumps) = kernels.shape();
    let rows = DMatrix::from_fn(places + bumps, bumps, |i, j| match i.checked_sub(places) {
        None => kernels[(i, j)] * row(i).0,
        Some(penalised) => {
            if penalised == j {
                RIDGE
            } else {
                0.0
            }
        }
    });
    let targets =
        DMatrix::from_fn(places + bumps, 1, |i, _| if i < places { row(i).0 * row(i).1 } else { 0.0 });
    let solved = Problem { rows, targets, data: places, block: 1 }.solve()?;
    Some(solved.iter().copied().collect())
}

/// Camera RGB whose square roots have shares on a triangular lattice; the mean of the channels is 1.
fn chromaticities(steps: usize) -> Vec<[f64; 3]> {
    let all = (0..=steps).flat_map(|r| (0..=steps - r).map(move |b| [r, steps - r - b, b]));
    all.map(|counts| {
        let squares = counts.map(|n| (n * n) as f64);
        let mean = squares.iter().sum::<f64>() / 3.0;
        squares.map(|v| v / mean)
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::dcp::WithNeutral;
    use crate::export::tests::{calibration, models, profile};

    fn exported(model: Model) -> Vec<u8> {
        let calibration = calibration(model);
        let with = WithNeutral { calibration: &calibration, neutral: [0.5, 1.0, 0.7] };
        Dcp::of(&profile(vec![calibration.clone()]), &[with]).unwrap().write()
    }

    #[test]
    fn a_profile_comes_back_from_its_dcp() {
        for model in models() {
            let imported = import(&exported(model.clone())).unwrap();
            let back = &imported.profile.calibrations()[0].model;
            let found = deviation(&calibration(model), |rgb| back.xyz(rgb)).de2000;
            assert!(found.mean < 0.2 && found.max < 2.0, "{found:?}");
            let white = Vector3::from(back.xyz([1.0; 3])) - Vector3::from(white::D50);
            assert!(white.amax() < 1e-12);
            assert!(imported.profile.camera().is("Nikon", "D\"7<00>"));
            assert_eq!(
                crate::file::parse(&crate::file::format(&imported.profile)).as_ref(),
                Ok(&imported.profile)
            );
        }
    }
}
