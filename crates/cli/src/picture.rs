//! The options that say how a picture shall be, the same for every command that makes pictures.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use clap::builder::{PossibleValue, PossibleValuesParser};
use clap::{Arg, ArgMatches, Args, FromArgMatches};
use darkroot::recipe::{Effective, Layer, Layers, Origin, RecipeError};
use darkroot::settings::{Group, Kind, SETTINGS};
use darkroot::{Format, Key, Settings, Target};

/// What the person asked for; where an option was not given, recipes and then defaults hold.
#[derive(Debug, Clone, Args)]
pub(crate) struct Picture {
    #[command(flatten)]
    given: Given,

    /// Settings from a TOML file, named like these options; they count more than those of folders, less than
    /// options and sidecars
    #[arg(long, value_name = "FILE", help_heading = "Recipes")]
    recipe: Option<PathBuf>,

    /// Ignore every `darkroot.toml` in folders and every `FILE.darkroot.toml` beside a file
    #[arg(long, help_heading = "Recipes")]
    no_recipes: bool,
}

impl Picture {
    /// The layers of this run; what the options say is among them.
    pub(crate) fn layers(&self) -> Result<Layers, RecipeError> {
        let given = self.given.0.iter().map(|(key, text)| (*key, text.clone()));
        Layers::new(self.recipe.as_deref(), Layer::flags(given)?, !self.no_recipes)
    }

    /// Whether white balance or profile were asked for.
    pub(crate) fn names_colours(&self) -> bool {
        self.given.0.iter().any(|(key, _)| matches!(key.name(), "white-balance" | "profile"))
    }
}

/// Settings that were given as options: one for each row of the table of settings.
#[derive(Debug, Clone, Default)]
struct Given(Vec<(Key, String)>);

impl FromArgMatches for Given {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let mut given = Self::default();
        given.update_from_arg_matches(matches)?;
        Ok(given)
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        let text = |key: Key| matches.get_one::<String>(key.name()).map(|text| (key, text.clone()));
        self.0 = Key::all().filter_map(text).collect();
        Ok(())
    }
}

impl Args for Given {
    fn augment_args(command: clap::Command) -> clap::Command {
        Key::all().fold(command, |command, key| command.arg(option(key)))
    }

    fn augment_args_for_update(command: clap::Command) -> clap::Command {
        Self::augment_args(command)
    }
}

/// The option for a setting.
fn option(key: Key) -> Arg {
    let setting = key.setting();
    let heading = match setting.group {
        Group::Output => "Output",
        Group::Picture => "Picture",
        Group::Comparison => "Comparison",
    };
    let mut option = Arg::new(setting.name)
        .long(setting.name)
        .help(format!("{} [default: {}]", setting.help, setting.default))
        .help_heading(heading);
    if let Some(alias) = setting.alias {
        option = option.visible_alias(alias);
    }
    if !setting.placeholder.is_empty() {
        option = option.value_name(setting.placeholder);
    }
    match setting.kind {
        Kind::Words(_) => option.value_parser(words(key)),
        Kind::Switch => option
            .num_args(0..=1)
            .require_equals(true)
            .default_missing_value("true")
            .value_parser(PossibleValuesParser::new(["true", "false"])),
        Kind::Number { .. } => {
            option.allow_hyphen_values(true).value_parser(move |text: &str| key.checked(text))
        }
        // A lamp's spectrum goes along in the text: workers, journals and recipes need no file then.
        Kind::Text { .. } if setting.name == "illuminant" => option.value_parser(move |text: &str| {
            let text = darkroot::light::without_file(text).map_err(|fault| fault.to_string())?;
            key.checked(&text).map_err(|fault| fault.to_string())
        }),
        Kind::Text { .. } | Kind::File(_) | Kind::Path(_) => {
            option.value_parser(move |text: &str| key.checked(text))
        }
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
            fits.with_context(|| format!("{}, with settings from {sources}", darkroot::shown(file)))?;
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
        if keys.len() == SETTINGS.len() { path } else { format!("{path} ({})", names(keys)) }
    };
    effective.files().into_iter().map(one).collect::<Vec<_>>().join("; ")
}

/// The same files for machines, in rising priority.
pub(crate) fn source_paths(effective: &Effective) -> Vec<String> {
    effective
        .files()
        .iter()
        .filter_map(|(origin, _)| Some(darkroot::path_text::text(origin.path()?)))
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
    let (text, origin) = effective.get(Key::FORMAT);
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
    darkroot::shown(inner.as_deref().unwrap_or(path))
}

/// The words of a setting, with what they mean for the help.
pub(crate) fn words(key: Key) -> PossibleValuesParser {
    let words = if let Kind::Words(words) = key.setting().kind { words } else { &[] };
    PossibleValuesParser::new(words.iter().map(|word| {
        let value = PossibleValue::new(word.word);
        let value = if word.also.is_empty() { value } else { value.alias(word.also) };
        if word.help.is_empty() { value } else { value.help(word.help) }
    }))
}
