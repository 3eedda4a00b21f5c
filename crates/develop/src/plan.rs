//! What the loops use: everything computed once for one capture, one profile and one recipe.

use std::sync::Arc;

use darkroot_colour::temperature::Temperature;
use darkroot_colour::{RgbSpace, TransferCurve, Xy, Xyz, white};
use darkroot_photo::{AsShot, Correction, Layout, Size};
use darkroot_profile::{Model, PlaneModel, Profile};

use crate::analysis::Analysis;
use crate::base::Base;
use crate::corrections::is_supported;
use crate::demosaic::Method;
use crate::error::Error;
use crate::gamut::{Mapping, Primaries};
use crate::geometry::lay;
use crate::highlights::{Rebuild, Treatment, least};
use crate::local_tone::LocalGains;
use crate::lut;
use crate::recipe::{Bits, Crop, Exposure, Highlights, Look, OutputSpace, Recipe};
use crate::shown::Shown;
use crate::tally::{Clipped, Tally};
use crate::transfer::Encoder;
use crate::view::Scale;
use crate::whites::Whites;
use crate::{auto_exposure, neutral};

mod before_exposure;
use before_exposure::{denoiser, lateral, mends, noise_left, sharpener};

/// What the colours of a picture were computed with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Colours {
    /// A profile.
    Profile,
    /// The maker's matrices, from the file or the decoder's list.
    CameraMatrix,
    /// Nothing is known of the camera: its RGB was taken for linear sRGB.
    Assumed,
    /// Monochrome sensor.
    Grey,
}

/// A recipe made ready for one capture, with the capture.
#[derive(Debug, Clone)]
pub struct Plan {
    /// What the colours are computed with.
    pub colours: Colours,
    /// White of the light; `None` when nothing tells it.
    pub white: Option<Temperature>,
    /// Factor on scene-linear light.
    pub gain: f32,
    /// Stray light in balanced camera RGB, which is taken off; 0 unless whoever made the plan knows of some.
    pub veil: [f32; 3],
    /// What had to be assumed or left out, in words.
    pub notes: Vec<String>,
    /// What the stages before exposure use.
    pub(crate) base: Base,
    /// Balanced camera RGB to linear Rec. 2020; `None` for camera output.
    pub(crate) model: Option<PlaneModel>,
    /// What the file does to each part of the picture; `None` for nothing.
    pub(crate) local_tone: Option<LocalGains>,
    /// How light is shown; `None` where it is shown in proportion.
    pub(crate) shown: Option<Shown>,
    /// What is laid over the look.
    pub(crate) lut: Option<lut::Laid>,
    pub(crate) gamut: Mapping,
    pub(crate) tally: Arc<Tally>,
    colour_model: Option<Model>,
    pub(crate) primaries: Primaries,
    pub(crate) encoder: Encoder,
    pub(crate) space: OutputSpace,
    pub(crate) bits: Bits,
}

impl Plan {
    /// Size of the developed picture, upright.
    pub fn size(&self) -> Size {
        self.size_at(Scale::FULL)
    }

    /// White-balance multipliers; the smallest is 1.
    pub fn multipliers(&self) -> [f32; 3] {
        self.base.multipliers
    }

    /// Demosaicing method.
    pub fn demosaic(&self) -> Method {
        self.base.demosaic
    }

    /// What rendering has cut until now, all views together; nothing where colours are mapped or kept.
    pub fn clipped(&self) -> Clipped {
        self.tally.clipped()
    }

    /// What the plan makes of light of the sensor (camera RGB, not balanced, 1 = the white level) before exposure: XYZ
    /// relative to D50, Y = 1 for white. `None` for camera output.
    pub fn colour_of(&self, camera: [f64; 3]) -> Option<Xyz> {
        let model = self.colour_model.as_ref()?;
        Some(model.xyz([0, 1, 2].map(|c| camera[c] * f64::from(self.base.multipliers[c]))))
    }

    /// The model that takes balanced camera RGB to XYZ relative to D50; `None` for balanced camera output.
    pub fn colour_model(&self) -> Option<&Model> {
        self.colour_model.as_ref()
    }

    /// Size of the developed picture at a scale, upright.
    pub fn size_at(&self, scale: Scale) -> Size {
        scale.of(self.base.laid.size)
    }
}

/// Prepares every stage for the capture of an analysis. Without a profile the camera's own matrices serve. What the
/// analysis has not looked at yet, it looks at now; else this takes a millisecond or two.
///
/// # Errors
/// A sensor that cannot be developed, or a white balance that is impossible for this capture.
pub fn plan(analysis: &Analysis, profile: Option<&Profile>, recipe: &Recipe) -> Result<Plan, Error> {
    let capture = analysis.capture();
    let layout = capture.counts.layout();
    let demosaic =
        Method::of(layout, recipe.demosaic).ok_or_else(|| Error::Filters { filters: filters(layout) })?;
    let raw_output = recipe.output.space == OutputSpace::Raw;
    let camera_output = raw_output || recipe.output.space == OutputSpace::Camera;
    // What the camera rendered for display has its look already.
    let overlay = recipe.lut.as_ref();
    let shown = if capture.rendered { None } else { Shown::of(recipe, profile, camera_output)? };
    let reproduced = recipe.look == Look::Reproduction && !capture.rendered;
    let linear = shown.is_none() && !reproduced;
    let measuring = linear || camera_output && !raw_output;
    // Neither noise nor blur of the original's picture is anybody's to take away unasked.
    let as_it_is = measuring || reproduced;
    let usual_sharpening = if as_it_is || raw_output { 0.0 } else { 1.0 };
    let sharpening = recipe.sharpen.unwrap_or(usual_sharpening);
    let laid = lay(capture, recipe.crop, &recipe.geometry, measuring, sharpening)?;
    let mut notes = Vec::new();
    let whites = whites(analysis, profile);
    let neutral = neutral::neutral(analysis, &whites, recipe.balance, &laid, &mut notes)?;
    let multipliers = neutral::multipliers(neutral);
    let white = whites.white_of(neutral);
    let (colours, model) = colours(analysis, profile, neutral, white, &mut notes);
    let (space, transfer) = match recipe.output.space {
        OutputSpace::Rgb(space) => (space, space.curve),
        OutputSpace::Camera | OutputSpace::Raw => (RgbSpace::REC2020, TransferCurve::Linear),
    };
    let mends = mends(analysis, recipe, measuring);
    notes.extend(mends.notes());
    let denoiser = denoiser(analysis, recipe.denoise, as_it_is, multipliers, &mends);
    let is_applied = |correction: &&Correction| is_supported(correction);
    notes.extend(laid.lens_note.clone());
    if recipe.crop == Crop::Default && capture.user_crop.is_some() {
        notes.push(
            "the picture is cut to what was chosen, as the file says; a crop of 100% shows all of it"
                .to_owned(),
        );
    }
    let lateral = lateral(analysis, &recipe.geometry, measuring || demosaic == Method::None, &laid);
    notes.extend(lateral.map(|lateral| lateral.note()));
    let is_uneven = analysis.light().is_corrected()
        || !capture.picture_corrections.is_empty()
        || laid.vignetting.is_some();
    let highlights = match recipe.highlights {
        _ if camera_output => Treatment::Keep,
        // A measurement must not contain what was guessed.
        Highlights::Rebuild if linear => Treatment::Keep,
        wanted => treatment(analysis, wanted, multipliers, is_uneven),
    };
    let for_people = shown.is_some() && !camera_output;
    let local_tone = LocalGains::asked(capture, recipe.local_tone, for_people, &mut notes);
    Ok(Plan {
        colours,
        white: white.map(Temperature::of),
        gain: gain(
            analysis,
            recipe.exposure,
            Shown::baseline(shown.as_ref(), capture, profile),
            &model,
            multipliers,
        ),
        veil: [0.0; 3],
        notes,
        base: Base {
            capture: Arc::clone(capture),
            light: Arc::clone(analysis.light()),
            laid,
            multipliers,
            demosaic,
            noise: noise_left(analysis, demosaic, denoiser.as_deref(), multipliers),
            mends,
            denoiser,
            lateral,
            sharpener: sharpener(analysis, sharpening, multipliers, &highlights),
            picture_corrections: capture.picture_corrections.iter().filter(is_applied).cloned().collect(),
            highlights,
        },
        model: (!camera_output).then(|| {
            let to_scene = RgbSpace::REC2020.from_xyz_under(white::D50);
            PlaneModel::new(&model.then(&to_scene))
        }),
        colour_model: (recipe.output.space != OutputSpace::Camera).then_some(model),
        gamut: Mapping::of(recipe.gamut, linear, reproduced),
        tally: Arc::default(),
        local_tone,
        lut: overlay.filter(|_| shown.is_some()).and_then(lut::Laid::of),
        shown,
        primaries: Primaries::new(&space),
        encoder: Encoder::new(transfer),
        space: recipe.output.space,
        bits: recipe.output.bits,
    })
}

/// What tells whites from neutrals. Samples that the camera has balanced already have their white at (1,1,1), and another
/// white is relative to it.
fn whites<'a>(analysis: &'a Analysis, profile: Option<&'a Profile>) -> Whites<'a> {
    let whites = Whites::of(analysis.matrix(), profile);
    match (analysis.capture().balance_applied, analysis.capture().as_shot) {
        (true, Some(AsShot::Neutral(shot))) => whites.applied(shot),
        _ => whites,
    }
}

fn filters(layout: &Layout) -> String {
    if let Layout::Cfa(cfa) = layout { cfa.to_string() } else { String::new() }
}

/// The model of the camera under this light, and where it is from.
fn colours(
    analysis: &Analysis,
    profile: Option<&Profile>,
    neutral: [f64; 3],
    white: Option<Xy>,
    notes: &mut Vec<String>,
) -> (Colours, Model) {
    let assumed = Model::linear(&RgbSpace::SRGB.to_xyz_under(white::D50));
    if *analysis.capture().counts.layout() == Layout::Monochrome {
        return (Colours::Grey, assumed);
    }
    match (profile, analysis.matrix()) {
        (Some(profile), _) => {
            if white.is_none() && profile.has_several_lights() {
                notes.push(
                    "the white of the light is not known; the profile was used as for daylight of 5000 K"
                        .to_owned(),
                );
            }
            (Colours::Profile, profile.model_for(white.unwrap_or(white::D50_XY)))
        }
        (None, Some(matrix)) => {
            let white = white.unwrap_or(white::D50_XY);
            (Colours::CameraMatrix, Model::linear(&matrix.to_xyz_d50(neutral, white)))
        }
        (None, None) => {
            notes.push("no colour matrix is known for this camera: its RGB was taken for sRGB".to_owned());
            (Colours::Assumed, assumed)
        }
    }
}

/// Factor on scene-linear light. A linear look has nothing automatic but what was asked for.
fn gain(analysis: &Analysis, exposure: Exposure, baseline: f64, model: &Model, multipliers: [f32; 3]) -> f32 {
    let stops =
        if exposure.auto { auto_exposure::stops(analysis.survey(), model, multipliers) } else { baseline };
    2f64.powf(exposure.stops + stops) as f32
}

/// What becomes of clipped samples of this capture.
fn treatment(analysis: &Analysis, wanted: Highlights, multipliers: [f32; 3], uneven: bool) -> Treatment {
    if wanted == Highlights::Keep {
        return Treatment::Keep;
    }
    let survey = analysis.survey();
    let limits = [0, 1, 2].map(|c| multipliers[c] * survey.saturation[c]);
    if wanted == Highlights::Clip {
        return Treatment::Clip { limit: least(limits) };
    }
    Treatment::Rebuild(Rebuild { limits, colours: analysis.clipped_colours(multipliers), uneven })
}
