//! What was done to one file.

use std::path::{Path, PathBuf};

use darkroot_colour::temperature::Temperature;
use darkroot_develop::{Bits, Colours, Plan};
use darkroot_encode::Format;
use darkroot_photo::{Capture, PictureSpace, Size};
use darkroot_profile::Profile;

use crate::ChosenProfile;
use crate::metadata::Keep;
use serde::Serialize;

/// What was done to one file.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Report {
    /// The raw file.
    #[serde(serialize_with = "crate::path_text::serialize")]
    pub input: PathBuf,
    /// The picture.
    #[serde(serialize_with = "crate::path_text::serialize")]
    pub output: PathBuf,
    /// Its format.
    pub format: String,
    /// Its colour space.
    pub space: String,
    /// Its bits a sample, as they stand in the file.
    pub bits: u8,
    /// Its width in pixels.
    pub width: usize,
    /// Its height in pixels.
    pub height: usize,
    /// The camera.
    pub camera: String,
    /// Decoder and version.
    pub decoder: String,
    /// Whether the picture was made from the embedded JPEG, and not from the sensor's samples.
    pub from_preview: bool,
    /// "darkroot" or "imagepipe".
    pub engine: String,
    /// What gave the colours, in words.
    pub colours: String,
    /// Path of the profile or "built in", when a profile was used.
    pub profile: Option<String>,
    /// Correlated colour temperature of the light, K, and tint, where known.
    pub kelvin: Option<f64>,
    /// Tint of the light: positive above the Planckian locus (greenish light), as raw developers show it.
    pub tint: Option<f64>,
    /// White-balance multipliers of red, green and blue; the smallest is 1.
    pub multipliers: [f32; 3],
    /// Demosaicing method.
    pub demosaic: String,
    /// Factor on scene-linear light (exposure).
    pub gain: f32,
    /// What had to be assumed or left out.
    pub notes: Vec<String>,
    /// Time taken.
    pub seconds: f64,
}

/// What gave the colours, in words.
pub fn colours(plan: &Plan, capture: &Capture, chosen: Option<&ChosenProfile<'_>>) -> String {
    match (plan.colours, chosen) {
        (Colours::Profile, Some(chosen)) if chosen.estimated => chosen.place.to_string(),
        (Colours::Profile, Some(chosen)) => {
            let profile = &chosen.profile;
            let lights = || {
                profile.calibrations().iter().map(|c| c.light.name.as_str()).collect::<Vec<_>>().join(", ")
            };
            let light = profile.known_camera().map_or_else(lights, |_| "its sensitivities".to_owned());
            format!("profile for {} ({light})", profile.camera().name())
        }
        _ if capture.rendered => "the camera's own (embedded JPEG)".to_owned(),
        (Colours::CameraMatrix, _) if capture.source.format == "DNG" => "matrix in the file".to_owned(),
        (Colours::CameraMatrix, _) => "camera matrix".to_owned(),
        (Colours::Grey, _) => "monochrome".to_owned(),
        _ => "assumed".to_owned(),
    }
}

/// What a rendered plan has cut, in words; nothing where nothing was.
pub(super) fn clipped(plan: &Plan) -> Option<String> {
    let cut = plan.clipped();
    if cut.above + cut.below == 0 {
        return None;
    }
    let share = |count: u64| 100.0 * count as f64 / cut.pixels.max(1) as f64;
    Some(format!(
        "{:.3} % of the pixels are brighter than white and {:.3} % have colours outside of {}: they were clipped",
        share(cut.above),
        share(cut.below),
        plan.picture_space().name()
    ))
}

/// What a person is told of a profile that was made for other lights.
pub(super) fn far_light(profile: &Profile, white: Temperature) -> Option<String> {
    let far = profile.far_from(white)?;
    Some(format!(
        "the profile is for {} ({:.0} K) and the light of this photograph has {:.0} K: colours can be off by dE2000 {:.1} more \
         than in that light; a shot of the chart in this light makes a profile for both",
        far.nearest.name,
        far.nearest.kelvin(),
        white.kelvin,
        far.more
    ))
}

/// What is said where a reproduction's file does not tell how it came about.
pub(super) fn without_provenance(format: Format, keep: Keep) -> Option<String> {
    let has_place = !matches!(format, Format::Avif | Format::Exr);
    if keep == Keep::None {
        return Some("without metadata the picture does not tell how it came about".to_owned());
    }
    (!has_place)
        .then(|| format!("{format} gets no provenance: it has no place for XMP, as TIFF and JPEG have"))
}

/// What can be said of every picture.
pub(super) fn blank_report(
    input: &Path,
    capture: &Capture,
    size: Size,
    space: &PictureSpace,
    bits: Bits,
) -> Report {
    Report {
        input: input.to_owned(),
        output: PathBuf::new(),
        format: String::new(),
        space: space.name(),
        bits: bits.count(),
        width: size.width,
        height: size.height,
        camera: capture.camera.name(),
        decoder: capture.source.decoder.clone(),
        from_preview: capture.rendered,
        engine: String::new(),
        colours: String::new(),
        profile: None,
        kelvin: None,
        tint: None,
        multipliers: [1.0; 3],
        demosaic: String::new(),
        gain: 1.0,
        notes: Vec::new(),
        seconds: 0.0,
    }
}
