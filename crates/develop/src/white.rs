//! The white of the light: from the camera's neutral to a chromaticity and back (DNG 1.7, chapter 6, "Mapping
//! Camera Color Space to CIE XYZ Space").

use darkroot_colour::adaptation::bradford;
use darkroot_colour::temperature::{Temperature, daylight_xy};
use darkroot_colour::{Matrix3, RgbSpace, Spectrum, Vector3, Xy, Xyz, white};
use darkroot_photo::{Calibration, Capture};

/// The maker's matrices of one camera.
#[derive(Debug, Clone, PartialEq)]
pub struct CameraMatrix {
    /// By rising temperature of the light; those without one only when there is no other.
    calibrations: Vec<Calibration>,
    analog_balance: Vector3,
}

impl CameraMatrix {
    /// The matrices of a capture; `None` when it has none.
    pub fn of(capture: &Capture) -> Option<Self> {
        let mut calibrations: Vec<Calibration> =
            capture.calibrations.iter().filter(|c| c.kelvin.is_some()).cloned().collect();
        calibrations.sort_by(|a, b| a.kelvin.unwrap_or(0.0).total_cmp(&b.kelvin.unwrap_or(0.0)));
        if calibrations.is_empty() {
            calibrations.extend(capture.calibrations.first().cloned());
        }
        let analog_balance = Vector3::from(capture.analog_balance);
        (!calibrations.is_empty()).then_some(Self { calibrations, analog_balance })
    }

    /// Camera RGB of a white; the largest value is 1. `None` when the matrices give no positive values for it.
    pub fn neutral_of(&self, white: Xy) -> Option<[f64; 3]> {
        let neutral = self.at(Temperature::of(white).kelvin).xyz_to_camera * Vector3::from(white.xyz());
        let largest = neutral.max();
        (neutral.min() > 0.0).then(|| (neutral / largest).into())
    }

    /// Chromaticity of the white that gives this neutral: the matrix depends on the white's temperature, so this
    /// is a fixed point, found by iteration as the specification describes.
    pub fn white_of(&self, neutral: [f64; 3]) -> Xy {
        let mut xy = white::D50_XY;
        for _ in 0..30 {
            let matrix = self.at(Temperature::of(xy).kelvin).xyz_to_camera;
            let next = matrix
                .try_inverse()
                .and_then(|inverse| Xyz::from(inverse * Vector3::from(neutral)).xy())
                .filter(|w| w.x > 0.0 && w.y > 0.0);
            let Some(next) = next else { return xy };
            let step = (next.x - xy.x).abs() + (next.y - xy.y).abs();
            // The mean of two steps cannot swing between two values for ever.
            xy = Xy::new((xy.x + next.x) / 2.0, (xy.y + next.y) / 2.0);
            if step < 1e-7 {
                break;
            }
        }
        xy
    }

    /// Balanced camera RGB of surfaces under a light, as far as the matrices tell: XYZ through them.
    pub(crate) fn colours(&self, light: &Spectrum, surfaces: &[(Spectrum, f64)]) -> Option<Vec<[f64; 3]>> {
        let white = light.white();
        let matrix = self.at(Temperature::of(white.xy()?).kelvin).xyz_to_camera;
        let neutral = matrix * Vector3::from(white);
        let seen = |surface: &Spectrum| {
            let rgb = matrix * Vector3::from(surface.reflected_xyz(light));
            rgb.component_div(&neutral).into()
        };
        (neutral.min() > 0.0).then(|| surfaces.iter().map(|(surface, _)| seen(surface)).collect())
    }

    /// Balanced camera RGB to XYZ relative to D50, (1,1,1) to D50 exactly, for the light whose neutral and
    /// white these are.
    ///
    /// Forward matrices do it where the maker gives them. Else the inverse of the color matrix does, with
    /// Bradford adaptation from the white, as the specification has it; but only for whites that lights have.
    /// Balanced samples, artistic choices and strange lamps give whites off the Planckian locus, for which a
    /// color matrix says nothing: there the forward matrix that it implies for its own light serves.
    pub fn to_xyz_d50(&self, neutral: [f64; 3], white: Xy) -> Matrix3 {
        let neutral = Vector3::from(neutral);
        let light = Temperature::of(white);
        let here = self.at(light.kelvin);
        let to_reference = here.reference_to_camera.try_inverse().unwrap_or_else(Matrix3::identity);
        let rebalance = Matrix3::from_diagonal(&(to_reference * neutral).map(|v| 1.0 / v));
        let unbalance = Matrix3::from_diagonal(&neutral);
        let forward = white_preserving(here.forward * rebalance * to_reference * unbalance);
        let plausible = ((STRANGE_DUV - light.duv.abs()) / (STRANGE_DUV - ORDINARY_DUV)).clamp(0.0, 1.0);
        if here.forward_is_given || plausible <= 0.0 {
            return forward;
        }
        let camera_to_xyz = here.xyz_to_camera.try_inverse().unwrap_or_else(Matrix3::identity);
        let inverse = white_preserving(bradford(white.xyz(), white::D50) * camera_to_xyz * unbalance);
        forward + (inverse - forward) * plausible
    }

    /// The matrices for a light of `kelvin`: between two calibrations by mired, beyond them the nearest.
    fn at(&self, kelvin: f64) -> Matrices {
        let mut low = &self.calibrations[0];
        let mut weight = 0.0;
        let mut high = low;
        for next in &self.calibrations {
            let (Some(a), Some(b)) = (low.kelvin, next.kelvin) else { break };
            high = next;
            if kelvin <= b {
                weight = if b > a {
                    ((1.0 / a - 1.0 / kelvin) / (1.0 / a - 1.0 / b)).clamp(0.0, 1.0)
                } else {
                    0.0
                };
                break;
            }
            low = next;
        }
        let mix = |a: Matrix3, b: Matrix3| a + (b - a) * weight;
        let identity = Matrix3::identity;
        let color = mix(low.color_matrix, high.color_matrix);
        let calibration = mix(
            low.camera_calibration.unwrap_or_else(identity),
            high.camera_calibration.unwrap_or_else(identity),
        );
        let forward = mix(forward_matrix(low), forward_matrix(high));
        let forward_is_given = low.forward_matrix.is_some() && high.forward_matrix.is_some();
        let reference_to_camera = Matrix3::from_diagonal(&self.analog_balance) * calibration;
        Matrices {
            xyz_to_camera: reference_to_camera * color,
            reference_to_camera,
            forward,
            forward_is_given,
        }
    }
}

struct Matrices {
    xyz_to_camera: Matrix3,
    reference_to_camera: Matrix3,
    forward: Matrix3,
    /// Whether the maker gives it; else it is derived.
    forward_is_given: bool,
}

/// Distances from the Planckian locus (CIE 1960 uv): daylight and lamps lie within the first, nothing ordinary
/// beyond the second.
const ORDINARY_DUV: f64 = 0.006;
const STRANGE_DUV: f64 = 0.010;

/// The forward matrix of a calibration: its own, or the one that its color matrix implies for its own light (D65
/// where it names none, as lists of camera matrices have it).
fn forward_matrix(calibration: &Calibration) -> Matrix3 {
    if let Some(forward) = calibration.forward_matrix {
        return white_preserving(forward);
    }
    let white = match calibration.kelvin {
        Some(kelvin) if kelvin < 4000.0 => Temperature { kelvin, duv: 0.0 }.xy(),
        Some(kelvin) => daylight_xy(kelvin),
        None => white::D65_XY,
    };
    let neutral = calibration.color_matrix * Vector3::from(white.xyz());
    let camera_to_xyz = calibration.color_matrix.try_inverse().unwrap_or_else(Matrix3::identity);
    white_preserving(bradford(white.xyz(), white::D50) * camera_to_xyz * Matrix3::from_diagonal(&neutral))
}

/// The matrix with its rows scaled so that (1,1,1) gives D50 exactly.
fn white_preserving(matrix: Matrix3) -> Matrix3 {
    let white = matrix * Vector3::new(1.0, 1.0, 1.0);
    let scale = Vector3::from(white::D50).component_div(&white);
    if scale.iter().all(|s| s.is_finite() && *s > 0.0) {
        Matrix3::from_diagonal(&scale) * matrix
    } else {
        RgbSpace::SRGB.to_xyz_under(white::D50)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera() -> CameraMatrix {
        // XYZ to camera of a made-up camera that is redder under A.
        let d65 = Matrix3::new(0.9, -0.3, -0.05, -0.4, 1.2, 0.2, -0.05, 0.15, 0.6);
        let a = Matrix3::new(1.0, -0.35, -0.1, -0.35, 1.15, 0.2, 0.0, 0.1, 0.55);
        let calibration = |kelvin, color_matrix| Calibration {
            kelvin: Some(kelvin),
            color_matrix,
            forward_matrix: None,
            camera_calibration: None,
        };
        CameraMatrix {
            calibrations: vec![calibration(2856.0, a), calibration(6504.0, d65)],
            analog_balance: Vector3::new(1.0, 1.0, 1.0),
        }
    }

    #[test]
    fn the_neutral_of_a_white_gives_that_white_back() {
        for kelvin in [2000.0, 2856.0, 4000.0, 5003.0, 6504.0, 9000.0] {
            let white = Temperature { kelvin, duv: 0.003 }.xy();
            let found = camera().white_of(camera().neutral_of(white).unwrap());
            assert!(
                (found.x - white.x).abs() + (found.y - white.y).abs() < 1e-5,
                "{kelvin}: {found:?} {white:?}"
            );
        }
    }

    #[test]
    fn balanced_white_is_d50() {
        let white = Temperature { kelvin: 3500.0, duv: 0.0 }.xy();
        let matrix = camera().to_xyz_d50(camera().neutral_of(white).unwrap(), white);
        let d50 = matrix * Vector3::new(1.0, 1.0, 1.0);
        assert!((d50 - Vector3::from(white::D50)).norm() < 1e-12);
    }

    #[test]
    fn a_white_that_is_no_light_still_gives_sane_colours() {
        // The Nikon D1 stores balanced samples: its neutral (1,1,1) is no light.
        let matrix = camera();
        let pink = matrix.white_of([1.0, 0.55, 1.0]);
        assert!(Temperature::of(pink).duv < -STRANGE_DUV);
        let derived = matrix.at(Temperature::of(pink).kelvin).forward;
        let strange = matrix.to_xyz_d50([1.0, 0.55, 1.0], pink);
        assert!((strange - derived).amax() < 1e-9, "{strange} {derived}");
        // An ordinary light goes by the inverse of the color matrix instead.
        let daylight = matrix.neutral_of(white::D65_XY).unwrap();
        let ordinary = matrix.to_xyz_d50(daylight, matrix.white_of(daylight));
        let camera_to_xyz = matrix.calibrations[1].color_matrix.try_inverse().unwrap();
        let expected = bradford(white::D65_XY.xyz(), white::D50) * camera_to_xyz;
        let scale = ordinary[(1, 1)] / (expected[(1, 1)] * daylight[1]);
        let column = |c: usize| (expected.column(c) * daylight[c] * scale - ordinary.column(c)).amax();
        assert!((0..3).all(|c| column(c) < 1e-3), "{ordinary} {expected}");
    }

    #[test]
    fn a_forward_matrix_is_used_where_there_is_one() {
        let mut camera = camera();
        let forward = RgbSpace::PROPHOTO.to_xyz_under(white::D50);
        for c in &mut camera.calibrations {
            c.forward_matrix = Some(forward);
        }
        let white = Temperature { kelvin: 3500.0, duv: 0.0 }.xy();
        let matrix = camera.to_xyz_d50(camera.neutral_of(white).unwrap(), white);
        assert!((matrix - forward).norm() < 1e-3);
    }
}
