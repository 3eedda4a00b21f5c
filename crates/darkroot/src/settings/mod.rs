//! Everything a person can ask for when developing files, checked once.
//!
//! [`table`] has every setting with its name, values, default and words for people; [`Settings`] is what they mean.

pub mod setting;
pub use setting::{Changes, Group, Kind, Setting, Word};

pub mod from_chart;
pub use from_chart::{ChartShot, FromChart};

pub mod error;
pub use error::SettingsError;

mod about;
mod check;
mod files;
mod frames;
mod geometry;
mod perspective;
mod tones;
mod words;

pub mod table;
pub use table::SETTINGS;

pub mod key;
mod noise;
pub use key::Key;

mod describe;
pub use describe::describe;

pub mod text;
pub use text::NotAValue;
pub(crate) use text::is_file_name;

pub mod spaces;
pub use spaces::{SPACES, space};

use std::path::PathBuf;

use darkroot_colour::RgbSpace;
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
    /// Stops above white that are shown on screens with room for them; 0 for none.
    pub hdr: f32,
    /// How files are written.
    pub encode: darkroot_encode::Options,
    /// The file of a table that is laid over the look.
    pub lut: Option<PathBuf>,
    /// The space in which that takes and gives colours.
    pub lut_space: RgbSpace,
    /// A dark frame, or a folder of them.
    pub dark: Option<PathBuf>,
    /// A flat frame, or a folder of them.
    pub flat: Option<PathBuf>,
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

impl Settings {
    /// Files and folders that are read for these settings beside the photograph and its profile.
    pub fn files(&self) -> impl Iterator<Item = PathBuf> {
        let own = [&self.lut, &self.dark, &self.flat].into_iter().flatten().cloned();
        own.chain(self.chart.files())
    }

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
        let mut recipe = self.recipe.clone();
        // A flat frame shows the shading of the lens.
        recipe.geometry.keep_vignetting |= self.flat.is_some();
        let linear = recipe.look == Look::Linear;
        let srgb = RgbSpace::SRGB;
        recipe.output.space = self.space.unwrap_or(match format {
            Format::Dng => OutputSpace::Raw,
            Format::Exr => OutputSpace::Rgb(srgb.linear()),
            _ if linear => OutputSpace::Rgb(srgb.linear()),
            _ => OutputSpace::Rgb(srgb),
        });
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
        check::tones(self, &recipe, linear || camera)?;
        if recipe.look == Look::Camera && recipe.tones.curve.is_some() {
            return Err(SettingsError::CurveOnCamera);
        }
        from_chart::check(self, recipe.output.space)?;
        check::hdr(self, &recipe, format)?;
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
            OutputSpace::Raw => PictureSpace::Raw,
        };
        format.accepts(&space)?;
        if self.engine == Engine::Imagepipe {
            check::imagepipe(self, &recipe)?;
        }
        if self.from_preview {
            check::preview(self, &recipe)?;
        }
        Ok(recipe)
    }
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
        assert_eq!(recipe.output.space, OutputSpace::Rgb(RgbSpace::SRGB.linear()));
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
