//! Hints for files, settings and names of outputs.

use std::error::Error;

use darkroot::files::Special;
use darkroot::{NamingError, RecipeError, SettingsError};

/// What to do about an error of the core.
pub(super) fn hint(error: &(dyn Error + 'static)) -> Option<String> {
    if let Some(darkroot::Error::Settings { source, .. }) = error.downcast_ref() {
        return settings(source);
    }
    if let Some(of_file) = error.downcast_ref() {
        return file(of_file).map(str::to_owned);
    }
    if let Some(of_raw) = error.downcast_ref() {
        return raw(of_raw).map(str::to_owned);
    }
    if let Some(of_settings) = error.downcast_ref() {
        return settings(of_settings);
    }
    if let Some(of_name) = error.downcast_ref() {
        return name(of_name).map(str::to_owned);
    }
    let words = match error.downcast_ref() {
        Some(RecipeError::Profile { .. }) => "name it with `--profile`",
        _ => return None,
    };
    Some(words.to_owned())
}

fn name(error: &NamingError) -> Option<&'static str> {
    match error {
        NamingError::OverInput { .. } => Some("choose another `-o`"),
        NamingError::Format { .. } => Some("or add `--format`"),
        NamingError::OtherFormat { .. } => Some("or leave out `--format`"),
        NamingError::NoName { .. } => Some("`-o FILE`, or `-o -` for standard output"),
        NamingError::Stream { .. } => Some("`-o FOLDER/` takes one"),
        _ => None,
    }
}

fn file(error: &darkroot::Error) -> Option<&'static str> {
    use darkroot::Error as E;
    match error {
        E::Raw { source, .. } => raw(source),
        E::Read { source, .. } if matches!(Special::of(source), Some(Special::NotAFile { .. })) => {
            Some("`-` reads standard input")
        }
        E::Plan { source: darkroot_develop::Error::NoMatrix, .. } => {
            Some("use `--white-balance as-shot`, `auto` or multipliers")
        }
        E::Plan { source: darkroot_develop::Error::Filters { .. }, .. } => {
            Some("`darkroot inspect` still works")
        }
        E::Plan { source: darkroot_develop::Error::NoProfileLook, .. } => {
            Some("`--profile` takes a .dcp file that has them")
        }
        E::OtherCamera { .. } => Some("`--profile` takes another"),
        E::Exists { .. } => Some("add `--overwrite` to replace it, or choose another `-o`"),
        E::Write { .. } => Some("`-o` takes another folder"),
        E::Engine { .. } => Some("leave out `--engine`"),
        _ => None,
    }
}

fn raw(error: &darkroot_raw::Error) -> Option<&'static str> {
    use darkroot_raw::Error as E;
    match error {
        E::Compression { .. } => {
            Some("`--from-preview` develops it, and `darkroot inspect --preview OUT.jpg` writes it as it is")
        }
        E::WrongDecoder { .. } => Some("leave out `--decoder rawloader`"),
        E::DecoderFailed { .. } => Some("`--decoder` takes flashraw or rawloader"),
        _ => None,
    }
}

fn settings(error: &SettingsError) -> Option<String> {
    let words = match error {
        SettingsError::Bits { .. } => "choose another `--bits` or format".to_owned(),
        SettingsError::LinearInEightBits { .. } => "or choose another `--look`".to_owned(),
        SettingsError::CurveOnLinear { space } => format!("add `--space {space}-linear`"),
        SettingsError::Preview { settings } => {
            let options: Vec<String> = settings.iter().map(|name| format!("`--{name}`")).collect();
            format!("leave out {} or `--from-preview`", options.join(", "))
        }
        SettingsError::CameraNeedsFloat => "or leave out `--space camera`".to_owned(),
        SettingsError::Engine { settings } => {
            let options: Vec<String> = settings.iter().map(|name| format!("`--{name}`")).collect();
            format!("leave out {}", options.join(", "))
        }
        _ => return None,
    };
    Some(words)
}

#[cfg(test)]
mod tests {
    use crate::hint::words;

    #[test]
    fn a_file_that_exists_is_told_with_the_option_that_replaces_it() {
        let error = darkroot::Error::Exists { path: "a.jpg".into() };
        assert!(!error.to_string().contains("--"), "{error}");
        let told = words(&error);
        assert_eq!(told, "a.jpg: exists already; add `--overwrite` to replace it, or choose another `-o`");
    }
}
