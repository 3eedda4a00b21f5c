//! The one place that knows which fit belongs to which kind of model.

use darkroot_colour::{Spectrum, Xyz};

use super::virtual_set::VirtualSet;
use super::{Fit, FitError, Knowledge, Samples, anchored, hue_plane, plain, spectral};
use crate::spectra::Effective;
use crate::{Figures, Kind, Order};

/// A fitted model with its kind and errors.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// What was fitted.
    pub kind: Kind,
    /// The model and its estimates for colours left out.
    pub fit: Fit,
    /// Its errors.
    pub figures: Figures,
}

/// What is known beside the colours of the samples. Some kinds of models need it.
#[derive(Debug, Clone, Copy)]
pub enum Background<'a> {
    /// Nothing.
    ColoursOnly,
    /// The reflectance of each colour, the light, and what is known of cameras.
    Reflectances(Knowledge<'a>),
    /// The reflectance of each colour, and the camera itself.
    Camera {
        /// Reflectances of the samples.
        reflectances: &'a [Spectrum],
        /// The light.
        light: &'a Spectrum,
        /// The camera under that light.
        camera: &'a Effective,
    },
}

/// Fits one kind of model to colours of which nothing else is known.
///
/// # Errors
/// Too few colours, colours that do not determine the model, or a kind that needs reflectances.
pub fn fit(samples: &Samples, kind: Kind) -> Result<Candidate, FitError> {
    let fit = fit_knowing(samples, kind, Background::ColoursOnly)?;
    Ok(Candidate { kind, figures: fit.figures(samples), fit })
}

/// Fits one kind of model, with all that is known.
///
/// # Errors
/// Too few colours, colours that do not determine the model, or a kind that needs more than is known.
pub fn fit_knowing(samples: &Samples, kind: Kind, background: Background<'_>) -> Result<Fit, FitError> {
    match kind {
        Kind::Linear => plain::root(samples, Order::One),
        Kind::Root(order) => plain::root(samples, order),
        Kind::Polynomial(degree) => plain::polynomial(samples, degree),
        Kind::Anchored => anchored::fit(samples),
        Kind::HuePlane => hue_plane::fit(samples),
        Kind::Half => half(samples),
        Kind::Spectral | Kind::Chromatic => match background {
            Background::ColoursOnly => Err(FitError::NoSpectra { kind }),
            Background::Reflectances(knowledge) => spectral::fit(samples, knowledge, kind),
            Background::Camera { reflectances, light, camera } => {
                let set = VirtualSet::of(reflectances);
                spectral::fit_known_camera(&set, camera, light, samples, kind)
            }
        },
    }
}

/// The mean of an anchored and a hue-plane model.
fn half(samples: &Samples) -> Result<Fit, FitError> {
    let (anchored, hue_plane) = (anchored::fit(samples)?, hue_plane::fit(samples)?);
    let mean = |(a, b): (&Xyz, &Xyz)| Xyz::new((a.x + b.x) / 2.0, (a.y + b.y) / 2.0, (a.z + b.z) / 2.0);
    Ok(Fit {
        model: anchored.model.mix(&hue_plane.model, 0.5),
        left_out: anchored.left_out.iter().zip(&hue_plane.left_out).map(mean).collect(),
        settings: format!("{}; {}", anchored.settings, hue_plane.settings),
    })
}
