//! The options that say how a picture shall be, the same for every command that makes pictures.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use darkroot::recipe::{self, Effective, Key, Layer, Layers, Origin, RecipeError};
use darkroot::{Format, Settings, Target};

/// What the person asked for; where an option was not given, recipes and then defaults hold.
#[derive(Debug, Clone, Args)]
pub(crate) struct Picture {
    /// Format, where the output's ending does not say it [default: auto]
    #[arg(long, value_parser = words(Key::Format), help_heading = "Output")]
    format: Option<String>,

    /// Colour space: srgb, display-p3, adobe-rgb, prophoto, rec2020, ecirgb-v2, each also with -linear;
    /// aces2065-1; camera (linear camera RGB before any profile); auto (sRGB, linear where the format or the
    /// look is) [default: auto]
    #[arg(long, value_parser = checked(Key::Space), help_heading = "Output")]
    space: Option<String>,

    /// Bits a sample; 32 is floating point [default: auto]
    #[arg(long, value_parser = words(Key::Bits), help_heading = "Output")]
    bits: Option<String>,

    /// Quality of JPEG and AVIF, 1 to 100 [default: 92]
    #[arg(long, value_name = "N", value_parser = checked(Key::Quality), help_heading = "Output")]
    quality: Option<String>,

    /// Chroma subsampling of JPEG [default: 444]
    #[arg(long, value_parser = words(Key::Chroma), help_heading = "Output")]
    chroma: Option<String>,

    /// Exposure in stops: 1 is twice the light [default: 0]
    #[arg(long, value_name = "EV", allow_hyphen_values = true, value_parser = checked(Key::Exposure),
          help_heading = "Picture")]
    exposure: Option<String>,

    /// Choose the exposure from the picture (=false where a recipe does and this picture shall not)
    /// [default: false]
    #[arg(long, num_args = 0..=1, require_equals = true, default_missing_value = "true", value_name = "BOOL",
          value_parser = words(Key::AutoExposure), help_heading = "Picture")]
    auto_exposure: Option<String>,

    /// as-shot, daylight, auto, 5200K, 5200K,+8 (tint), spot:X,Y[,SIDE] (grey in the picture), or R,G,B
    /// [default: as-shot]
    #[arg(long, visible_alias = "wb", value_name = "WB", value_parser = checked(Key::WhiteBalance),
          help_heading = "Picture")]
    white_balance: Option<String>,

    /// Rendering from scene to display; linear is strict: numbers proportional to light, nothing automatic
    /// [default: neutral]
    #[arg(long, value_parser = words(Key::Look), help_heading = "Picture")]
    look: Option<String>,

    /// What becomes of clipped highlights (the linear look keeps them unless clip is asked for)
    /// [default: rebuild]
    #[arg(long, value_parser = words(Key::Highlights), help_heading = "Picture")]
    highlights: Option<String>,

    /// How missing colours are interpolated [default: best]
    #[arg(long, value_parser = words(Key::Demosaic), help_heading = "Picture")]
    demosaic: Option<String>,

    /// Which part of the frame [default: default]
    #[arg(long, value_parser = words(Key::Crop), help_heading = "Picture")]
    crop: Option<String>,

    /// Colour profile: a file, `auto` (your folder, then built in, then the file's matrices) or `matrix`
    /// [default: auto]
    #[arg(long, value_name = "FILE", value_parser = checked(Key::Profile), help_heading = "Picture")]
    profile: Option<String>,

    /// Second opinion: develop with imagepipe's fixed pipeline [default: darkroot]
    #[arg(long, value_parser = words(Key::Engine), help_heading = "Comparison")]
    engine: Option<String>,

    /// Library that decodes the samples [default: flashraw]
    #[arg(long, value_parser = words(Key::Decoder), help_heading = "Comparison")]
    decoder: Option<String>,

    /// Settings from a TOML file, named like these options; they count more than those of folders, less than
    /// options and sidecars
    #[arg(long, value_name = "FILE", help_heading = "Recipes")]
    recipe: Option<PathBuf>,

    /// Ignore every `darkroot.toml` in folders and every `FILE.darkroot.toml` beside a file
    #[arg(long, help_heading = "Recipes")]
    no_recipes: bool,
}

impl Picture {
    /// The layers of this run; what the flags say is among them.
    pub(crate) fn layers(&self) -> Result<Layers, RecipeError> {
        let given = Key::ALL.into_iter().filter_map(|key| Some((key, self.given(key)?.to_owned())));
        Layers::new(self.recipe.as_deref(), Layer::flags(given)?, !self.no_recipes)
    }

    /// Whether white balance or profile were asked for.
    pub(crate) fn names_colours(&self) -> bool {
        self.white_balance.is_some() || self.profile.is_some()
    }

    fn given(&self, key: Key) -> Option<&str> {
        match key {
            Key::Format => &self.format,
            Key::Space => &self.space,
            Key::Bits => &self.bits,
            Key::Quality => &self.quality,
            Key::Chroma => &self.chroma,
            Key::Exposure => &self.exposure,
            Key::AutoExposure => &self.auto_exposure,
            Key::WhiteBalance => &self.white_balance,
            Key::Look => &self.look,
            Key::Highlights => &self.highlights,
            Key::Demosaic => &self.demosaic,
            Key::Crop => &self.crop,
            Key::Profile => &self.profile,
            Key::Engine => &self.engine,
            Key::Decoder => &self.decoder,
        }
        .as_deref()
    }
}

/// What is asked for one file.
pub(crate) struct Order {
    pub(crate) effective: Effective,
    /// With the format filled in, and checked against it.
    pub(crate) settings: Settings,
    pub(crate) format: Format,
    /// What was asked for while something else counts more.
    pub(crate) notes: Vec<String>,
}

impl Order {
    /// Whatever is wrong with it is found here, before anything is developed.
    pub(crate) fn of(file: &Path, layers: &mut Layers, target: &Target) -> Result<Self> {
        let effective = layers.for_file(file)?;
        let mut settings = effective.settings()?;
        let format = effective.format(target, &settings, layers.flags())?;
        settings.format = Some(format);
        let fits = settings.resolve(format);
        let sources = sources(&effective);
        if sources.is_empty() {
            fits?;
        } else {
            fits.with_context(|| format!("{}, with settings from {sources}", file.display()))?;
        }
        let notes = overruled(&effective, layers.flags(), format);
        Ok(Self { effective, settings, format, notes })
    }
}

/// The files that settings of a picture are from, in words: `darkroot.toml (look), a.dng.darkroot.toml (exposure)`.
/// Empty where there are none.
pub(crate) fn sources(effective: &Effective) -> String {
    let names = |keys: Vec<Key>| keys.into_iter().map(Key::name).collect::<Vec<_>>().join(", ");
    let one = |(origin, keys): (&Origin, Vec<Key>)| {
        let path = origin.path().map(shown).unwrap_or_default();
        if keys.len() == Key::ALL.len() { path } else { format!("{path} ({})", names(keys)) }
    };
    effective.files().into_iter().map(one).collect::<Vec<_>>().join("; ")
}

/// The same files for machines, in rising priority.
pub(crate) fn source_paths(effective: &Effective) -> Vec<String> {
    effective
        .files()
        .iter()
        .filter_map(|(origin, _)| Some(origin.path()?.to_string_lossy().into_owned()))
        .collect()
}

/// What the person asked for and did not get, because something else counts more: a note for each.
fn overruled(effective: &Effective, flags: &Layer, format: Format) -> Vec<String> {
    let mut notes = Vec::new();
    for (key, text) in flags.iter() {
        let (value, origin) = effective.get(key);
        if let (Origin::Sidecar(path), true) = (origin, value != text) {
            notes.push(format!("`--{key} {text}` is overruled by {}: {key} {value}", shown(path)));
        }
    }
    let (text, origin) = effective.get(Key::Format);
    let named = effective.settings().ok().and_then(|s| s.format);
    if let (Some(path), true) = (origin.path(), named.is_some_and(|named| named != format)) {
        notes.push(format!(
            "the output's ending counts more than the format {text} of {}: it is {format}",
            shown(path)
        ));
    }
    notes
}

/// A path as short as it can be: from the current folder if it lies in it.
pub(crate) fn shown(path: &Path) -> String {
    let here = std::env::current_dir().and_then(std::fs::canonicalize);
    let inner = here.ok().and_then(|here| path.strip_prefix(here).ok().map(Path::to_owned));
    inner.as_deref().unwrap_or(path).display().to_string()
}

/// The words of a key, with what they mean for the help.
pub(crate) fn words(key: Key) -> impl TypedValueParser<Value = String> {
    PossibleValuesParser::new(recipe::text::words(key).into_iter().map(|word| {
        let value = PossibleValue::new(word.word);
        if word.help.is_empty() { value } else { value.help(word.help) }
    }))
}

/// A text that the library understands.
fn checked(key: Key) -> impl Fn(&str) -> Result<String, recipe::NotAValue> + Clone + Send + Sync {
    move |text| recipe::text::checked(key, text)
}
