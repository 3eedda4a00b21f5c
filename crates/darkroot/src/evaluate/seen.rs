//! Surfaces that are judged on, as a camera sees them in some light.

use darkroot_colour::{Spectrum, Xyz};
use darkroot_profile::fit::{FitError, Samples};
use darkroot_profile::spectra::white;
use darkroot_profile::{Effective, Errors, Model, Summary};

use super::ReflectanceSet;

/// Sets of surfaces, each and all together.
pub(super) struct Seen {
    sets: Vec<Samples>,
    all: Samples,
}

impl Seen {
    /// By a camera that stands in this light.
    pub(super) fn by(
        camera: &Effective,
        light: &Spectrum,
        judged: &[ReflectanceSet],
    ) -> Result<Self, FitError> {
        let render = |set: &ReflectanceSet| camera.render(&set.reflectances, light);
        let sets = judged.iter().map(render).collect::<Result<Vec<_>, _>>()?;
        let rgb = sets.iter().flat_map(|s| s.rgb().to_vec()).collect();
        let xyz = sets.iter().flat_map(|s| s.xyz().to_vec()).collect();
        Ok(Self { all: Samples::new(rgb, xyz, white(light))?, sets })
    }

    /// dE2000 of a model over all of them.
    pub(super) fn errors(&self, model: &Model) -> Summary {
        errors(model, &self.all)
    }

    /// The mean for each set.
    pub(super) fn means(&self, model: &Model) -> Vec<f64> {
        self.sets.iter().map(|set| errors(model, set).mean).collect()
    }
}

fn errors(model: &Model, samples: &Samples) -> Summary {
    let estimates: Vec<Xyz> = samples.rgb().iter().map(|rgb| model.xyz(*rgb)).collect();
    Errors::between(&estimates, samples.xyz(), samples.white()).de2000
}
