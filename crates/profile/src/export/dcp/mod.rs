//! DCP: a camera profile as Adobe's programs, RawTherapee and darktable read it (DNG 1.7.1, chapter 6 and "Camera
//! Profiles").
//!
//! A forward matrix takes balanced camera RGB to XYZ, and a table over hue and saturation of ProPhoto RGB corrects
//! the rest. The table has one layer: it depends on chromaticity alone, as every model of degree one does. A
//! program finds the white of the light with the color matrix, which takes XYZ to *unbalanced* camera RGB. A Darkroot
//! profile knows balanced RGB only, so whoever writes a DCP must give the neutral: the camera RGB of the light's white.
//!
//! No tone curve and no look are written: programs add their own.

mod file;
mod hue_sat;
mod import;
mod read;

pub use hue_sat::HueSatMap;
pub use import::{Imported, camera, import};

use darkroot_colour::adaptation::bradford;
use darkroot_colour::temperature::{daylight_xy, planckian_xy};
use darkroot_colour::{Matrix3, RgbSpace, Vector3, Xyz, white};

use super::{DcpLimit, Error};
use crate::{Calibration, Light, Model, Profile, Rendering};

/// What a DCP says, for one light or two.
#[derive(Debug, Clone, PartialEq)]
pub struct Dcp {
    /// The camera, as `UniqueCameraModel`.
    pub camera: String,
    /// Name of the profile.
    pub name: String,
    /// One or two lights, the warmer first.
    pub lights: Vec<DcpLight>,
    /// Tone curve, look table and exposure; nothing where the file has none of both. It is read, and never written.
    pub rendering: Rendering,
    /// What the file has besides, in words.
    pub left_out: Vec<String>,
}

/// What a DCP says for one light.
#[derive(Debug, Clone, PartialEq)]
pub struct DcpLight {
    /// `LightSource` of Exif 2.32 that is nearest in temperature.
    pub illuminant: u16,
    /// XYZ to unbalanced camera RGB.
    pub color_matrix: Matrix3,
    /// Balanced camera RGB to XYZ relative to D50.
    pub forward_matrix: Matrix3,
    /// What the matrix leaves.
    pub map: HueSatMap,
}

/// Whether bytes begin as a DCP does.
pub fn is_dcp(bytes: &[u8]) -> bool {
    matches!(bytes.get(..4), Some(b"IIRC" | b"MMCR"))
}

/// A calibration and its camera's neutral: unbalanced camera RGB of the light's white, of any scale.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WithNeutral<'a> {
    /// The calibration.
    pub calibration: &'a Calibration,
    /// Unbalanced camera RGB of the light's white.
    pub neutral: [f64; 3],
}

impl Dcp {
    /// The DCP of one calibration or two.
    ///
    /// # Errors
    /// No calibration or more than two, a plain polynomial, a neutral that is not positive, or a model whose matrix near
    /// grey has no inverse.
    pub fn of(profile: &Profile, calibrations: &[WithNeutral<'_>]) -> Result<Self, Error> {
        if !(1..=2).contains(&calibrations.len()) {
            return Err(DcpLimit::Lights.into());
        }
        let mut by_warmth = calibrations.to_vec();
        by_warmth.sort_by(|a, b| a.calibration.light.kelvin().total_cmp(&b.calibration.light.kelvin()));
        let lights: Vec<DcpLight> = by_warmth.iter().map(DcpLight::of).collect::<Result<_, _>>()?;
        if let [one, two] = &lights[..]
            && one.illuminant == two.illuminant
        {
            return Err(DcpLimit::SameTemperature.into());
        }
        let names: Vec<&str> = by_warmth.iter().map(|c| c.calibration.light.name.as_str()).collect();
        let camera = profile.camera().name();
        Ok(Self {
            name: format!("Darkroot {camera} {}", names.join(" ")),
            camera,
            lights,
            rendering: Rendering::default(),
            left_out: Vec::new(),
        })
    }

    /// The file.
    pub fn write(&self) -> Vec<u8> {
        file::write(self)
    }

    /// Reads a file. Where it has no forward matrix, the color matrix implies one; of a table of several layers, the
    /// one for middle grey is taken.
    ///
    /// # Errors
    /// Bytes that are no DCP, or one with an unusable matrix or table.
    pub fn read(bytes: &[u8]) -> Result<Self, Error> {
        read::read(bytes)
    }
}

impl DcpLight {
    /// What a DCP says of a calibration.
    ///
    /// # Errors
    /// A model that depends on exposure, a neutral that is none, a matrix without inverse.
    pub fn of(of: &WithNeutral<'_>) -> Result<Self, Error> {
        let WithNeutral { calibration: Calibration { light, model, .. }, neutral } = of;
        if !model.is_exposure_invariant() {
            return Err(DcpLimit::ChangesWithExposure.into());
        }
        if !neutral.iter().all(|v| *v > 0.0 && v.is_finite()) {
            return Err(DcpLimit::Neutral.into());
        }
        let forward = file::rounded(&near_grey(model));
        let inverse = forward.try_inverse().ok_or(DcpLimit::NoInverse)?;
        let largest = neutral.iter().copied().fold(0.0, f64::max);
        let unbalance = Matrix3::from_diagonal(&(Vector3::from(*neutral) / largest));
        let color_matrix = unbalance * inverse * bradford(light.xy.xyz(), white::D50);
        let map = HueSatMap::of(model, &forward).ok_or(DcpLimit::NoInverse)?;
        Ok(Self { illuminant: illuminant(light), color_matrix, forward_matrix: forward, map })
    }

    /// XYZ relative to D50 of balanced camera RGB.
    pub fn xyz(&self, rgb: [f64; 3]) -> Xyz {
        let to_prophoto = RgbSpace::PROPHOTO.from_xyz_under(white::D50);
        let prophoto = to_prophoto * self.forward_matrix * Vector3::from(rgb);
        let corrected = Vector3::from(self.map.apply(prophoto.into()));
        (RgbSpace::PROPHOTO.to_xyz_under(white::D50) * corrected).into()
    }
}

/// The matrix that a model is near grey, its rows scaled so that (1,1,1) gives D50: for homogeneous models that are
/// smooth at grey they already do.
fn near_grey(model: &Model) -> Matrix3 {
    let matrix = model.jacobian([0.5; 3]);
    let found = matrix * Vector3::repeat(1.0);
    let scale = Vector3::from(white::D50).component_div(&found);
    if scale.iter().all(|s| s.is_finite() && *s > 0.0) {
        Matrix3::from_diagonal(&scale) * matrix
    } else {
        matrix
    }
}

/// Lights of Exif's `LightSource` that a DCP may name, with the temperatures that the DNG SDK takes them for, K.
const CODES: [(u16, f64); 7] =
    [(17, 2850.0), (24, 3200.0), (14, 4150.0), (23, 5000.0), (20, 5500.0), (21, 6500.0), (22, 7500.0)];

/// The light that a `LightSource` of Exif means; D50 where it says nothing.
fn light_of(code: u16) -> Light {
    let (name, xy) = match code {
        3 | 17 => ("A", white::A_XY),
        24 => ("3200K", planckian_xy(3200.0)),
        15 => ("3450K", planckian_xy(3450.0)),
        2 | 14 => ("4150K", planckian_xy(4150.0)),
        1 | 4 | 9 | 18 | 20 => ("D55", daylight_xy(5503.0)),
        10 | 12 | 19 | 21 => ("D65", white::D65_XY),
        11 | 22 => ("D75", daylight_xy(7504.0)),
        _ => ("D50", white::D50_XY),
    };
    Light { name: name.to_owned(), xy }
}

/// `LightSource` of Exif whose temperature is nearest in mired: programs only use the temperature, to interpolate
/// between two lights.
fn illuminant(light: &Light) -> u16 {
    let away = |kelvin: f64| (1e6 / kelvin - 1e6 / light.kelvin()).abs();
    CODES.into_iter().min_by(|a, b| away(a.1).total_cmp(&away(b.1))).map_or(255, |(code, _)| code)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::deviation;
    use crate::export::tests::{calibration, models, profile};

    const NEUTRAL: [f64; 3] = [0.5, 1.0, 0.7];

    fn dcp(model: Model) -> Dcp {
        let calibration = calibration(model);
        let with = WithNeutral { calibration: &calibration, neutral: NEUTRAL };
        Dcp::of(&profile(vec![calibration.clone()]), &[with]).unwrap()
    }

    #[test]
    fn what_is_read_back_is_the_model() {
        for model in models() {
            let read = Dcp::read(&dcp(model.clone()).write()).unwrap();
            let found = deviation(&calibration(model), |rgb| read.lights[0].xyz(rgb)).de2000;
            assert!(found.mean < 0.1 && found.max < 2.0, "{found:?}");
        }
    }

    #[test]
    fn the_color_matrix_gives_the_neutral_for_the_light() {
        let light = &dcp(models().remove(1)).lights[0];
        let camera = light.color_matrix * Vector3::from(white::D65_XY.xyz());
        assert!((camera - Vector3::from(NEUTRAL)).amax() < 1e-6, "{camera}");
        assert_eq!(light.illuminant, 21);
    }

    #[test]
    fn what_cannot_be_written_is_refused() {
        let polynomial = crate::samples_for_tests::all_parts().remove(3);
        let one = calibration(models().remove(0));
        let profile = profile(vec![one.clone()]);
        let with = |calibration, neutral| WithNeutral { calibration, neutral };
        let same = [with(&one, NEUTRAL), with(&one, NEUTRAL)];
        assert!(Dcp::of(&profile, &same).is_err() && Dcp::of(&profile, &[]).is_err());
        assert!(Dcp::of(&profile, &[with(&one, [1.0, 0.0, 1.0])]).is_err());
        assert!(Dcp::of(&profile, &[with(&calibration(polynomial), NEUTRAL)]).is_err());
    }
}
