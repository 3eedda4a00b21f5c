//! A camera's profile: one model per light, or the camera itself; and which model serves which white.

use std::sync::Arc;

use darkroot_colour::temperature::Temperature;
use darkroot_colour::{Xy, Xyz};

use crate::camera::KnownCamera;
use crate::camera::light::STRANGE_DUV;
use crate::{Figures, Kind, Model, Rendering};

/// The camera that a profile is for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ProfileCamera {
    /// Maker's common name ("Nikon").
    pub make: String,
    /// Model's common name, without the maker ("D700").
    pub model: String,
    /// Other names of the same camera, make and model in one ("NIKON CORPORATION NIKON D700").
    pub aliases: Vec<String>,
}

impl ProfileCamera {
    /// Whether this is the camera of that make and model; case and spaces do not matter.
    pub fn is(&self, make: &str, model: &str) -> bool {
        let plain = |s: &str| s.chars().filter(|c| !c.is_whitespace()).flat_map(char::to_lowercase).collect();
        let asked: String = plain(&format!("{make}{model}"));
        let own: String = plain(&format!("{}{}", self.make, self.model));
        let alias = |a: &String| -> bool {
            let alias: String = plain(a);
            alias == asked
        };
        own == asked || self.aliases.iter().any(alias)
    }

    /// Make and model in one.
    pub fn name(&self) -> String {
        format!("{} {}", self.make, self.model).trim().to_owned()
    }
}

/// The light of a calibration.
#[derive(Debug, Clone, PartialEq)]
pub struct Light {
    /// Its name ("D65", "A", "studio flash").
    pub name: String,
    /// Chromaticity of its white.
    pub xy: Xy,
}

impl Light {
    /// Correlated colour temperature, K.
    pub fn kelvin(&self) -> f64 {
        Temperature::of(self.xy).kelvin
    }
}

/// What the camera's colours mean under one light.
#[derive(Debug, Clone, PartialEq)]
pub struct Calibration {
    /// The light.
    pub light: Light,
    /// How the model was fitted.
    pub kind: Kind,
    /// Balanced camera RGB to XYZ relative to D50.
    pub model: Model,
    /// How far the model is off.
    pub figures: Figures,
    /// The colours of the fit, where the profile keeps them.
    pub patches: Vec<Patch>,
}

impl Calibration {
    /// A calibration of which nothing is known but its model.
    pub fn new(light: Light, kind: Kind, model: Model) -> Self {
        Self { light, kind, model, figures: Figures::default(), patches: Vec::new() }
    }
}

/// A colour of the fit and what the model makes of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Patch {
    /// Its name on the chart ("A1", "dark skin").
    pub name: String,
    /// Balanced camera RGB, 1 for the white of the light.
    pub rgb: [f64; 3],
    /// What it should be: XYZ relative to D50, Y = 1 for the white of the light.
    pub xyz: Xyz,
    /// CIEDE2000 between that and the model's XYZ.
    pub de2000: f64,
}

/// Where a profile came from, as far as it is known; empty texts are not.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Origin {
    /// In words.
    pub summary: String,
    /// The chart that was shot.
    pub chart: String,
    /// File with the reference colours or reflectances of the fit.
    pub reference: String,
    /// SHA-256 of that file, hexadecimal.
    pub reference_sha256: String,
    /// File with the camera's spectral sensitivities.
    pub sensitivities: String,
    /// SHA-256 of that file, hexadecimal.
    pub sensitivities_sha256: String,
    /// Day of the fit, YYYY-MM-DD.
    pub date: String,
    /// Program that made the fit, with its version.
    pub program: String,
}

/// What one camera's colours mean.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    camera: ProfileCamera,
    knowledge: Knowledge,
    origin: Origin,
    rendering: Option<Arc<Rendering>>,
}

/// What a profile knows.
#[derive(Debug, Clone, PartialEq)]
enum Knowledge {
    /// Models for some lights: at least one, by falling temperature of the light (rising mired).
    Calibrations(Vec<Calibration>),
    /// How the camera sees, from which the model for any light follows.
    Camera(Box<KnownCamera>),
}

impl Profile {
    /// A profile of these calibrations. `None` when there are none.
    pub fn new(camera: ProfileCamera, mut calibrations: Vec<Calibration>, origin: Origin) -> Option<Self> {
        calibrations.sort_by(|a, b| b.light.kelvin().total_cmp(&a.light.kelvin()));
        let knowledge = Knowledge::Calibrations(calibrations);
        let some = matches!(&knowledge, Knowledge::Calibrations(all) if !all.is_empty());
        some.then_some(Self { camera, knowledge, origin, rendering: None })
    }

    /// A profile that is a camera: the model for the light of each photograph follows from its sensitivities.
    pub fn of_camera(camera: ProfileCamera, known: KnownCamera, origin: Origin) -> Self {
        Self { camera, knowledge: Knowledge::Camera(Box::new(known)), origin, rendering: None }
    }

    /// The same with how its maker would show its colours; nothing where that says nothing.
    #[must_use]
    pub fn rendered_by(self, rendering: Option<Arc<Rendering>>) -> Self {
        Self { rendering: rendering.filter(|rendering| rendering.is_any()), ..self }
    }

    /// How its maker would show its colours, where the profile says it.
    pub fn rendering(&self) -> Option<&Arc<Rendering>> {
        self.rendering.as_ref()
    }

    /// How the camera sees, where the profile knows it.
    pub fn known_camera(&self) -> Option<&KnownCamera> {
        match &self.knowledge {
            Knowledge::Camera(known) => Some(known),
            Knowledge::Calibrations(_) => None,
        }
    }

    /// The camera.
    pub fn camera(&self) -> &ProfileCamera {
        &self.camera
    }

    /// The calibrations, bluest light first. Those of a profile that is a camera are computed when they are first asked
    /// for: D65, D50 and A stand for all lights.
    pub fn calibrations(&self) -> &[Calibration] {
        match &self.knowledge {
            Knowledge::Calibrations(all) => all,
            Knowledge::Camera(known) => known.calibrations(),
        }
    }

    /// Where the profile came from.
    pub fn origin(&self) -> &Origin {
        &self.origin
    }

    /// Whether it depends on the light which model serves.
    pub fn has_several_lights(&self) -> bool {
        !matches!(&self.knowledge, Knowledge::Calibrations(all) if all.len() == 1)
    }

    /// The model for a white: between two lights by their mired (1e6 / K), beyond them the nearest; or what the camera's
    /// sensitivities give for it.
    pub fn model_for(&self, white: Xy) -> Model {
        match &self.knowledge {
            Knowledge::Calibrations(all) => between(all, Temperature::of(white).kelvin),
            Knowledge::Camera(known) => known.model_for(white),
        }
    }
}

/// How far a photograph's light is from the lights of a profile.
#[derive(Debug, Clone, PartialEq)]
pub struct FarLight {
    /// The nearest light of the profile.
    pub nearest: Light,
    /// By how much the colours are to be expected to be off beyond the profile's own error, mean dE2000.
    pub more: f64,
}

/// dE2000 for each mired by which a light is warmer, or bluer, than the one that a model was made for, and the error of
/// models in their own light: five cameras and 253 surfaces, models for A, D50 and D65 under black bodies and daylight of 80
/// to 400 mired (`docs/colour.md`). The two add up as squares.
const WARMER: f64 = 0.0105;
const BLUER: f64 = 0.014;
const OWN_ERROR: f64 = 0.6;
/// Errors that nobody is told of.
const SMALL: f64 = 0.3;

impl Profile {
    /// Whether a photograph of this white is beyond all lights of the profile by so much that it shows. `None` for whites
    /// that are near or between them or that no light has, and for profiles that are cameras, which know every light.
    pub fn far_from(&self, white: Temperature) -> Option<FarLight> {
        let Knowledge::Calibrations(all) = &self.knowledge else { return None };
        if white.duv.abs() >= STRANGE_DUV {
            return None;
        }
        let mired = |kelvin: f64| 1e6 / kelvin;
        let off = |c: &Calibration| mired(white.kelvin) - mired(c.light.kelvin());
        let nearest = all.iter().min_by(|a, b| off(a).abs().total_cmp(&off(b).abs()))?;
        let between = all.iter().any(|c| off(c) > 0.0) && all.iter().any(|c| off(c) < 0.0);
        let slope = if off(nearest) > 0.0 { WARMER } else { BLUER };
        let more = OWN_ERROR.hypot(slope * off(nearest)) - OWN_ERROR;
        (!between && more >= SMALL).then(|| FarLight { nearest: nearest.light.clone(), more })
    }
}

fn between(calibrations: &[Calibration], kelvin: f64) -> Model {
    let mired = |c: &Calibration| 1e6 / c.light.kelvin();
    let wanted = 1e6 / kelvin;
    let first = &calibrations[0];
    let mut previous = first;
    for next in calibrations {
        if wanted <= mired(next) {
            let span = mired(next) - mired(previous);
            let weight = if span > 0.0 { (wanted - mired(previous)) / span } else { 1.0 };
            return previous.model.mix(&next.model, weight.clamp(0.0, 1.0));
        }
        previous = next;
    }
    previous.model.clone()
}

#[cfg(test)]
mod tests {
    use super::*;
    use darkroot_colour::{Matrix3, white};

    fn two_lights() -> Profile {
        let camera =
            ProfileCamera { make: "Nikon".into(), model: "D700".into(), aliases: vec!["NIKON D 700".into()] };
        let calibration = |name: &str, xy, scale: f64| {
            let model = Model::linear(&(Matrix3::identity() * scale));
            Calibration::new(Light { name: name.into(), xy }, Kind::Linear, model)
        };
        let both = vec![calibration("A", white::A_XY, 1.0), calibration("D65", white::D65_XY, 3.0)];
        Profile::new(camera, both, Origin::default()).unwrap()
    }

    #[test]
    fn a_light_beyond_all_others_is_far() {
        let profile = two_lights();
        let far = |kelvin: f64| profile.far_from(Temperature { kelvin, duv: 0.0 });
        assert!([2500.0, 2856.0, 4000.0, 6500.0, 7500.0].iter().all(|k| far(*k).is_none()));
        let (warm, blue) = (far(1800.0).unwrap(), far(12000.0).unwrap());
        assert_eq!((warm.nearest.name.as_str(), blue.nearest.name.as_str()), ("A", "D65"));
        assert!(warm.more > 1.5 && blue.more > 0.3, "{warm:?} {blue:?}");
    }

    #[test]
    fn lights_interpolate_in_mired_and_clamp_beyond() {
        let profile = two_lights();
        let y = |kelvin: f64| between(profile.calibrations(), kelvin).xyz([1.0; 3]).y;
        let lights: Vec<f64> = profile.calibrations().iter().map(|c| c.light.kelvin()).collect();
        let middle = 2e6 / (1e6 / lights[0] + 1e6 / lights[1]);
        assert!((y(20000.0) - 3.0).abs() < 1e-12);
        assert!((y(lights[0]) - 3.0).abs() < 1e-9);
        assert!((y(middle * 0.0 + 1e6 / ((1e6 / lights[0] + 1e6 / lights[1]) / 2.0)) - 2.0).abs() < 1e-9);
        assert!((y(lights[1]) - 1.0).abs() < 1e-9);
        assert!((y(2000.0) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_camera_is_known_by_its_names() {
        let camera = two_lights().camera().clone();
        assert!(camera.is("Nikon", "D700") && camera.is("NIKON", "d700"));
        assert!(!camera.is("Nikon", "D70"));
    }
}
