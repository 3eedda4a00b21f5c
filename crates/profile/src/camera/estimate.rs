//! A camera from its published matrix, how sure it is, and whether the matrix itself is the better choice.

use darkroot_colour::{Illuminant, Matrix3, Spectrum, Vector3, Xyz};

use super::known::KnownCamera;
use super::offsets::Observation;
use super::peers::Peers;
use super::posterior::Posterior;
use crate::Errors;
use crate::fit::virtual_set::VirtualSet;

/// Cameras that the posterior is asked for.
const DRAWS: usize = 12;

/// What a published matrix tells.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimate {
    /// The most probable camera. Its expected error is known.
    pub camera: KnownCamera,
    /// Mean dE2000 under D65 that is to be expected of it on the built-in surfaces: the mean over cameras as probable as
    /// the posterior says.
    pub expected: f64,
    /// The same of the matrix itself; `None` without a matrix.
    pub expected_of_matrix: Option<f64>,
    /// The kind of published matrices that this one is most like; `None` without a matrix.
    pub family: Option<String>,
}

impl Estimate {
    /// From a published matrix, or, without one, the mean camera. `None` where the matrix is not usable.
    pub fn of(peers: &Peers, published: Option<&Observation>) -> Option<Self> {
        let light = Illuminant::by_name("D65")?.spectrum();
        Self::judged(peers, published, VirtualSet::builtin()?, &light)
    }

    /// The same with another virtual training set for models, judged under another light than D65.
    pub fn judged(
        peers: &Peers,
        published: Option<&Observation>,
        set: &VirtualSet,
        light: &Spectrum,
    ) -> Option<Self> {
        let posterior = match published {
            Some(published) => Posterior::of(peers, published)?,
            None => Posterior::mean_camera(peers),
        };
        let camera = KnownCamera::new(&posterior.sensitivities())?;
        let white = Vector3::from(light.white());
        let surfaces: Vec<_> = peers.surfaces.iter().map(|(surface, _)| surface.clone()).collect();
        let model = camera.model_by(set, light)?;
        let matrix = published.and_then(|p| {
            let balanced = Matrix3::from_diagonal(&(p.matrix * white));
            Some(p.matrix.try_inverse()? * balanced)
        });
        let to_light = darkroot_colour::adaptation::bradford(darkroot_colour::white::D50, light.white());
        let mut totals = [0.0; 2];
        for draw in posterior.draws(DRAWS) {
            let samples = draw.under(light)?.render(&surfaces, light).ok()?;
            let error = |of: &dyn Fn([f64; 3]) -> Xyz| {
                let estimates: Vec<Xyz> = samples.rgb().iter().map(|rgb| of(*rgb)).collect();
                Errors::between(&estimates, samples.xyz(), samples.white()).de2000.mean
            };
            totals[0] += error(&|rgb| (to_light * Vector3::from(model.xyz(rgb))).into());
            totals[1] += matrix.map_or(0.0, |m| error(&|rgb| (m * Vector3::from(rgb)).into()));
        }
        let [expected, of_matrix] = totals.map(|t| t / DRAWS as f64);
        Some(Self {
            camera: camera.expecting(Some((expected * 100.0).round() / 100.0)),
            expected,
            expected_of_matrix: matrix.map(|_| of_matrix),
            family: posterior.family().map(str::to_owned),
        })
    }

    /// Whether the camera's own matrix is to be expected to be better.
    pub fn matrix_is_better(&self) -> bool {
        self.expected_of_matrix.is_some_and(|matrix| matrix < self.expected)
    }
}
