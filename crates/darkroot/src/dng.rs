//! What a DNG says to the raw developer that will finish the picture.

use std::path::Path;
use std::sync::Arc;

use darkroot_colour::temperature::Temperature;
use darkroot_colour::white;
use darkroot_develop::{Bits, Look, Output, OutputSpace, Plan, Recipe};
use darkroot_encode::Dng;
use darkroot_encode::dng::{CameraColours, HueSatTable};
use darkroot_photo::{Capture, Picture};
use darkroot_profile::export::dcp::{DcpLight, WithNeutral};
use darkroot_profile::{Calibration, Kind, Light};

use crate::from_chart::file_name;

/// Pixels that the longer side of the picture to look at has at least.
pub(crate) const PREVIEW: usize = 1024;

/// The recipe of the picture to look at, which has the look that was asked for.
pub(crate) fn shown(recipe: &Recipe) -> Recipe {
    let look = if recipe.look == Look::Linear { Look::Neutral } else { recipe.look };
    Recipe { look, output: Output { space: OutputSpace::default(), bits: Bits::Eight }, ..recipe.clone() }
}

/// The recipe of the samples, which have no look. What is measured stays as it is.
pub(crate) fn samples(recipe: &Recipe) -> Recipe {
    let look = if recipe.look == Look::Linear { Look::Linear } else { Look::Neutral };
    Recipe { look, ..recipe.clone() }
}

/// What the DNG of a plan says. The colours are those of the plan, for its white and no other: matrix and table make of the
/// samples what the profile's model does.
///
/// # Errors
/// A model that a table cannot hold.
pub(crate) fn facts(
    input: &Path,
    capture: &Capture,
    plan: &Plan,
    preview: Picture,
) -> Result<Dng, darkroot_profile::export::Error> {
    let white = plan.white.map_or(white::D50_XY, Temperature::xy);
    let neutral = plan.multipliers().map(|multiplier| 1.0 / f64::from(multiplier));
    let largest = neutral.into_iter().fold(0.0, f64::max);
    let neutral = neutral.map(|v| v / largest);
    let light = Light { name: "as shot".to_owned(), xy: white };
    let colours = match plan.colour_model() {
        Some(model) => {
            let calibration = Calibration::new(light, Kind::Spectral, model.clone());
            let light = DcpLight::of(&WithNeutral { calibration: &calibration, neutral })?;
            let nodes = light.map.nodes().iter().map(|node| node.map(|v| v as f32)).collect();
            CameraColours {
                name: format!("Darkroot {}", capture.camera.name()),
                neutral,
                illuminant: light.illuminant,
                color_matrix: light.color_matrix,
                forward_matrix: light.forward_matrix,
                table: Some(HueSatTable { dimensions: light.map.dimensions(), nodes }),
            }
        }
        None => CameraColours::default(),
    };
    Ok(Dng {
        camera: capture.camera.name(),
        original: file_name(input),
        exposure: f64::from(plan.gain).log2(),
        colours,
        preview: Some(Arc::new(preview)),
    })
}
