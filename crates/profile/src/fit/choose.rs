//! All kinds of models side by side, and the best by leave-one-out.

use darkroot_colour::Xyz;

use super::{Fit, FitError, Samples, anchored, hue_plane, plain};
use crate::{Figures, Kind};

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

/// Fits one kind of model.
///
/// # Errors
/// Too few colours, colours that do not determine the model, or a kind that needs reflectances.
pub fn fit(samples: &Samples, kind: Kind) -> Result<Candidate, FitError> {
    let fit = match kind {
        Kind::Linear => plain::root(samples, crate::Order::One)?,
        Kind::Root(order) => plain::root(samples, order)?,
        Kind::Polynomial(degree) => plain::polynomial(samples, degree)?,
        Kind::Anchored => anchored::fit(samples)?,
        Kind::HuePlane => hue_plane::fit(samples)?,
        Kind::Half => half(samples)?,
        Kind::Spectral | Kind::Chromatic => return Err(FitError::NoSpectra { kind }),
    };
    Ok(Candidate { kind, figures: fit.figures(samples), fit })
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
