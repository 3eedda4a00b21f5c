//! Everything a person can ask for when developing files, checked once.
//!
//! [`table`] has every setting with its name, values, default and words for people; [`Settings`] is what they mean.

pub mod setting;
pub use setting::{Changes, Group, Kind, Setting, Word};

pub mod from_chart;
pub use from_chart::{ChartShot, FromChart};

mod about;
pub mod description;
mod files;
mod geometry;
mod tones;
mod words;

pub mod table;
pub use table::SETTINGS;

pub mod key;
pub use key::Key;

pub mod text;
pub use text::NotAValue;
pub(crate) use text::is_file_name;

pub mod spaces;
pub use spaces::{SPACES, space};

use std::path::PathBuf;

use darkroot_develop::{Bits, Look, OutputSpace, Recipe};
use darkroot_encode::Format;
use darkroot_photo::PictureSpace;
use darkroot_raw::{Decoder, Limits};

use crate::files::Tree;
use crate::light::LightSource;
use crate::metadata::About;

/// Which profile gives the colours.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum ProfileChoice {
    /// The first that fits: the user's folder, the built-in profiles, the file's own matrices.
    #[default]
    Automatic,
    /// The file's own matrices.
    Matrix,
    /// This file, or the profile in the store for the camera of this name.
    File(PathBuf),
}

/// Which program develops.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Engine {
    /// Darkroot's own stages.
    #[default]
    Darkroot,
    /// imagepipe 0.5, for comparison. It has its own fixed stages: only decoder, format and size of the recipe
    /// apply to it.
    Imagepipe,
}

/// What is asked for, apart from inputs and outputs.
#[derive(Debug, Clone, Default)]
pub struct Settings {
    /// How to develop. The output's space and bits stand here too; [`Settings::resolve`] fills in what depends on
    /// the format.
    pub recipe: Recipe,
    /// Colour space, where the person named one.
    pub space: Option<OutputSpace>,
    /// Bits a sample, where the person named them.
    pub bits: Option<Bits>,
    /// Format of the outputs, where the person named one; else their ending says.
    pub format: Option<Format>,
    /// Pixels an inch on paper that files shall state; else they state what the camera wrote.
    pub dpi: Option<u32>,
    /// What the picture says of itself.
    pub about: About,
    /// What is taken from a shot of a chart.
    pub chart: FromChart,
    /// What was asked for that is not the default, as texts by name: for the provenance of a reproduction.
    pub told: Vec<(&'static str, String)>,
    /// How files are written.
    pub encode: darkroot_encode::Options,
    /// Which profile.
    pub profile: ProfileChoice,
    /// The light that the colours are computed for, where it is not to follow from the white.
    pub light: Option<LightSource>,
    /// Which engine.
    pub engine: Engine,
    /// Which decoder.
    pub decoder: Decoder,
    /// Whether the embedded JPEG is developed in place of the samples.
    pub from_preview: bool,
    /// How much a file may ask for.
    pub limits: Limits,
    /// Whether existing outputs are replaced.
    pub overwrite: bool,
    /// The folder of outputs, if this output is one of many; nowhere below it are links followed.
    pub tree: Option<Tree>,
}

/// Settings that contradict each other. Each message says what to do.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SettingsError {
    /// The format cannot hold that many bits.
    #[error("{format} cannot hold {bits} bits a sample, only {allowed}")]
    Bits {
        /// The format.
        format: &'static str,
        /// What was asked.
        bits: u8,
        /// What it can hold.
        allowed: String,
    },
    /// The format cannot hold the space.
    #[error(transparent)]
    Space(#[from] darkroot_encode::Error),
    /// Linear light in 8 bits.
    #[error("{format} cannot hold linear light: 8 bits are too coarse for it; write a .tif or .exr file")]
    LinearInEightBits {
        /// The format.
        format: &'static str,
    },
    /// A curve on top of the linear look.
    #[error(
        "the linear look keeps numbers proportional to light, but {space} bends them; use {space}-linear"
    )]
    CurveOnLinear {
        /// The space.
        space: String,
    },
    /// Changes of a look on top of the linear one.
    #[error("numbers proportional to light leave no room for {}: choose another look for that", settings.join(", "))]
    TonesOnLinear {
        /// Names of the settings that ask for it.
        settings: Vec<&'static str>,
    },
    /// Changes of a look on top of colours as measured.
    #[error("a reproduction shows what was measured and leaves no room for {}: choose another look for that", settings.join(", "))]
    TonesOnReproduction {
        /// Names of the settings that ask for it.
        settings: Vec<&'static str>,
    },
    /// Something of a chart without its shot.
    #[error(
        "{setting} asks for what a chart shows, and no shot of one is named; name it with exposure-from-chart"
    )]
    NoChartShot {
        /// Name of the setting that asks for it.
        setting: &'static str,
    },
    /// An exposure from a chart where it cannot hold.
    #[error("exposure-from-chart does not go with {setting} as it is set; leave one of them out")]
    ChartWith {
        /// Name of the other setting.
        setting: &'static str,
    },
    /// Camera RGB in an integer format.
    #[error("camera RGB is for measurement: write a 32-bit .tif or an .exr file")]
    CameraNeedsFloat,
    /// The embedded JPEG, where light of the scene is asked for.
    #[error("the embedded JPEG is the camera's own rendering, and no scene light as {} asks for", settings.join(", "))]
    Preview {
        /// Names of the settings that ask for it.
        settings: Vec<&'static str>,
    },
    /// Options that the second engine does not have.
    #[error("imagepipe has its own fixed rendering in sRGB and does not heed {}", settings.join(", "))]
    Engine {
        /// Names of the settings that it does not heed.
        settings: Vec<&'static str>,
    },
}

impl Settings {
    /// The format that outputs get when neither name nor option says: JPEG, or TIFF for reproductions and linear light.
    pub fn default_format(&self) -> Format {
        let measured = matches!(self.recipe.look, Look::Reproduction | Look::Linear);
        if measured || self.space == Some(OutputSpace::Camera) { Format::Tiff } else { Format::Jpeg }
    }

    /// The recipe for a format: fills in space and bits where nobody named them, and checks that all of it fits.
    ///
    /// # Errors
    /// Settings that contradict each other or the format.
    pub fn resolve(&self, format: Format) -> Result<Recipe, SettingsError> {
        let mut recipe = self.recipe;
        let linear = recipe.look == Look::Linear;
        let srgb = darkroot_colour::RgbSpace::SRGB;
        recipe.output.space = self.space.unwrap_or(OutputSpace::Rgb(match format {
            Format::Exr => srgb.linear(),
            _ if linear => srgb.linear(),
            _ => srgb,
        }));
        let camera = recipe.output.space == OutputSpace::Camera;
        let default_bits = if camera { 32 } else { format.default_bits() };
        recipe.output.bits = self.bits.unwrap_or(match default_bits {
            8 => Bits::Eight,
            16 => Bits::Sixteen,
            _ => Bits::Float,
        });
        let bits = recipe.output.bits.count();
        if camera && (bits != 32 || !matches!(format, Format::Tiff | Format::Exr)) {
            return Err(SettingsError::CameraNeedsFloat);
        }
        check_tones(&recipe, linear || camera)?;
        from_chart::check(self, camera)?;
        if linear && bits == 8 {
            return Err(SettingsError::LinearInEightBits { format: format.name() });
        }
        if !format.bits().contains(&bits) {
            let allowed: Vec<String> = format.bits().iter().map(u8::to_string).collect();
            return Err(SettingsError::Bits { format: format.name(), bits, allowed: allowed.join(" or ") });
        }
        let space = match recipe.output.space {
            OutputSpace::Rgb(space) => {
                if linear && space.curve != darkroot_colour::TransferCurve::Linear {
                    return Err(SettingsError::CurveOnLinear { space: spaces::space_name(&space) });
                }
                PictureSpace::Rgb(space)
            }
            OutputSpace::Camera => PictureSpace::Camera,
        };
        format.accepts(&space)?;
        if self.engine == Engine::Imagepipe {
            check_imagepipe(self, &recipe)?;
        }
        if self.from_preview {
            check_preview(self, &recipe)?;
        }
        Ok(recipe)
    }
}

/// Linear light has no look that could be changed.
fn check_tones(recipe: &Recipe, linear: bool) -> Result<(), SettingsError> {
    let settings = tones::changed(&recipe.tones);
    match recipe.look {
        _ if settings.is_empty() => Ok(()),
        _ if linear => Err(SettingsError::TonesOnLinear { settings }),
        Look::Reproduction => Err(SettingsError::TonesOnReproduction { settings }),
        _ => Ok(()),
    }
}

/// What is about the sensor's light has no meaning for a picture that the camera rendered.
fn check_preview(settings: &Settings, recipe: &Recipe) -> Result<(), SettingsError> {
    let asks = [
        ("look", matches!(recipe.look, Look::Reproduction | Look::Linear)),
        ("space", recipe.output.space == OutputSpace::Camera),
        ("profile", matches!(settings.profile, ProfileChoice::File(_))),
        ("engine", settings.engine == Engine::Imagepipe),
    ];
    let mut settings: Vec<&str> = asks.iter().filter(|(_, asks)| *asks).map(|(name, _)| *name).collect();
    // The camera's rendering has its own curve, and no look is laid over it.
    settings.extend(tones::changed(&recipe.tones));
    if settings.is_empty() { Ok(()) } else { Err(SettingsError::Preview { settings }) }
}

fn check_imagepipe(settings: &Settings, recipe: &Recipe) -> Result<(), SettingsError> {
    let fixed = Recipe::default();
    let heeded = [
        ("profile", settings.profile == ProfileChoice::Automatic),
        ("space", recipe.output.space == OutputSpace::Rgb(darkroot_colour::RgbSpace::SRGB)),
        ("bits", recipe.output.bits != Bits::Float),
        ("look", recipe.look == fixed.look),
        ("gamut", recipe.gamut == fixed.gamut),
        ("exposure-from-chart", settings.chart.shot == ChartShot::None),
        ("exposure", recipe.exposure == fixed.exposure),
        ("white-balance", recipe.balance == fixed.balance),
        ("highlights", recipe.highlights == fixed.highlights),
        ("hot-pixels", recipe.hot_pixels == fixed.hot_pixels),
        ("denoise", recipe.denoise == fixed.denoise),
        ("sharpen", recipe.sharpen == fixed.sharpen),
        ("demosaic", recipe.demosaic == fixed.demosaic),
        ("crop", recipe.crop == fixed.crop),
        ("contrast, saturation and their like", recipe.tones == fixed.tones),
        ("rotate, straighten, lens, resize and their like", recipe.geometry == fixed.geometry),
    ];
    let unheeded: Vec<&str> = heeded.iter().filter(|(_, fits)| !fits).map(|(name, _)| *name).collect();
    if unheeded.is_empty() { Ok(()) } else { Err(SettingsError::Engine { settings: unheeded }) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settings(look: Look, space: Option<&str>, bits: Option<Bits>) -> Settings {
        let recipe = Recipe { look, ..Recipe::default() };
        Settings { recipe, space: space.map(|s| super::space(s).unwrap()), bits, ..Settings::default() }
    }

    /// Settings of a reproduction.
    fn with_chart(shot: &str, change: impl FnOnce(&mut Settings)) -> Settings {
        let mut settings = settings(Look::Reproduction, None, None);
        Key::named("exposure-from-chart").apply(shot, &mut settings).unwrap();
        change(&mut settings);
        settings
    }

    #[test]
    fn a_reproduction_goes_into_every_space_in_8_and_16_bits() {
        for (name, _) in SPACES {
            for bits in [Bits::Eight, Bits::Sixteen] {
                assert!(settings(Look::Reproduction, Some(name), Some(bits)).resolve(Format::Tiff).is_ok());
            }
        }
        assert_eq!(settings(Look::Reproduction, None, None).default_format(), Format::Tiff);
    }

    #[test]
    fn the_linear_look_is_linear_srgb_in_16_bits_unless_told_otherwise() {
        let recipe = settings(Look::Linear, None, None).resolve(Format::Tiff).unwrap();
        assert_eq!(recipe.output.space, OutputSpace::Rgb(darkroot_colour::RgbSpace::SRGB.linear()));
        assert_eq!(recipe.output.bits, Bits::Sixteen);
    }

    #[test]
    fn the_embedded_jpeg_is_no_scene_light() {
        let asked = |settings: Settings| {
            let message = settings.resolve(Format::Tiff).unwrap_err().to_string();
            assert!(message.contains("no scene light as look asks for"), "{message}");
        };
        asked(Settings { from_preview: true, ..settings(Look::Linear, None, None) });
        let rendered = Settings { from_preview: true, ..settings(Look::Vivid, Some("adobe-rgb"), None) };
        assert!(rendered.resolve(Format::Tiff).is_ok());
    }

    #[test]
    fn contradictions_are_said() {
        for (settings, format, word) in [
            (settings(Look::Linear, None, None), Format::Jpeg, ".exr"),
            (settings(Look::Linear, Some("adobe-rgb"), None), Format::Tiff, "adobe-rgb-linear"),
            (settings(Look::Neutral, Some("camera"), None), Format::Jpeg, ".exr"),
            (settings(Look::Neutral, None, Some(Bits::Sixteen)), Format::Jpeg, "16 bits"),
            (settings(Look::Neutral, Some("adobe-rgb"), None), Format::Exr, "linear"),
            (with_chart("auto", |s| s.recipe.exposure.auto = true), Format::Tiff, "auto-exposure"),
            (with_chart("auto", |s| s.space = space("camera")), Format::Tiff, "space"),
            (with_chart("off", |s| s.chart.black = true), Format::Tiff, "exposure-from-chart"),
            (with_chart("a.nef", |s| s.recipe.tones.saturation = 1.2), Format::Tiff, "for saturation"),
        ] {
            let message = settings.resolve(format).unwrap_err().to_string();
            assert!(message.contains(word), "{message}");
        }
    }
}
