//! Arguments that cannot be read: what was most likely meant.

use std::ffi::OsString;

use clap::builder::StyledStr;
use clap::error::{ContextKind, ContextValue, Error, ErrorKind};
use clap::{Command, CommandFactory, Parser};

use crate::Cli;

/// What people look for under another name, and where it is here. The second is an option that must be there for the
/// words to be true; empty where there is none.
const INSTEAD: [(&[&str], &str, &str); 11] = [
    (
        &["size", "width", "height", "scale", "long-edge"],
        "resize",
        "`--resize` takes long:2048, 1920x1080, 50% and more",
    ),
    (&["angle", "horizon"], "straighten", "`--straighten` takes degrees, or auto"),
    (&["aspect", "ratio"], "crop", "`--crop` takes 3:2, 80% or X,Y,WIDTH,HEIGHT"),
    (&["sharpness", "sharpening"], "sharpen", "`--sharpen` takes auto, off, or a number from 0 to 2"),
    (
        &["noise", "noise-reduction", "nr"],
        "denoise",
        "`--denoise` takes auto, off, best, or a number from 0 to 2",
    ),
    (&["out", "outdir", "out-dir", "output-dir", "dest"], "output", "`-o` says where pictures go"),
    (&["input", "in", "file"], "output", "files are named without an option"),
    (&["force", "replace", "yes"], "overwrite", "`--overwrite` replaces what is there"),
    (&["ev", "brightness"], "exposure", "`--exposure` takes stops"),
    (
        &["temperature", "temp", "kelvin", "tint"],
        "white-balance",
        "`--white-balance` takes 5200K or 5200K,+8",
    ),
    (&["icc", "colorspace", "color-space", "colour-space"], "space", "`--space` chooses the colour space"),
];

/// Reads the arguments; help and what is wrong with them end the program.
pub(crate) fn parse() -> Cli {
    let arguments: Vec<OsString> = std::env::args_os().collect();
    Cli::try_parse_from(&arguments).unwrap_or_else(|error| end(error, &arguments))
}

fn end(mut error: Error, arguments: &[OsString]) -> ! {
    if error.kind() == ErrorKind::DisplayVersion && arguments.iter().any(|argument| argument == "--long") {
        crate::version::say_all();
    }
    let mut all = Cli::command();
    all.build();
    in_one_line(&mut error);
    mend(&mut error, &all, arguments);
    let plain = |text: &OsString| darkroot::shown(text).as_str() == text.as_os_str();
    if !error.use_stderr() || arguments.iter().all(plain) {
        error.exit();
    }
    // Colours are left out, as what is theirs cannot be told from what is an argument's.
    crate::say(format_args!("{}", error.to_string().trim_end()));
    std::process::exit(error.exit_code());
}

/// An argument, such as the name of a file that a pattern found, may hold anything.
fn in_one_line(error: &mut Error) {
    let shown = |value: &ContextValue| match value {
        ContextValue::String(text) => Some(ContextValue::String(darkroot::shown(text))),
        ContextValue::Strings(texts) => {
            Some(ContextValue::Strings(texts.iter().map(darkroot::shown).collect()))
        }
        _ => None,
    };
    let plain: Vec<_> = error.context().filter_map(|(kind, value)| Some((kind, shown(value)?))).collect();
    for (kind, value) in plain {
        error.insert(kind, value);
    }
}

/// Takes out guesses that are far from what was written, and says what we know.
fn mend(error: &mut Error, all: &Command, arguments: &[OsString]) {
    let Some(ContextValue::String(typed)) = error.get(ContextKind::InvalidArg) else {
        keep_near(error, ContextKind::InvalidSubcommand, ContextKind::SuggestedSubcommand);
        return;
    };
    let typed = typed.trim_start_matches('-').split('=').next().unwrap_or_default().to_owned();
    keep_near(error, ContextKind::InvalidValue, ContextKind::SuggestedValue);
    if error.get(ContextKind::InvalidValue).is_some() {
        return;
    }
    keep_near(error, ContextKind::InvalidArg, ContextKind::SuggestedArg);
    // That it could be the name of a file is rarely what was meant.
    error.remove(ContextKind::Suggested);
    let command = arguments.iter().skip(1).find_map(|text| all.find_subcommand(text.to_str()?));
    if error.get(ContextKind::SuggestedArg).is_none()
        && let Some(command) = command
    {
        // The line was made for the guess.
        let usage = command.clone().render_usage();
        error.insert(ContextKind::Usage, ContextValue::StyledStr(usage));
    }
    let has = |option: &str| {
        option.is_empty() || command.is_some_and(|c| c.get_arguments().any(|a| a.get_long() == Some(option)))
    };
    let known = INSTEAD.iter().find(|(names, option, _)| names.contains(&typed.as_str()) && has(option));
    if let Some((.., words)) = known {
        error.remove(ContextKind::SuggestedArg);
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![StyledStr::from(*words)]));
    }
}

/// Keeps a guess only if a slip of the finger lies between it and what was written.
fn keep_near(error: &mut Error, written: ContextKind, guess: ContextKind) {
    let text = |value: &ContextValue| value.to_string().trim_start_matches('-').to_owned();
    let Some(typed) = error.get(written).map(text) else { return };
    let typed = typed.split('=').next().unwrap_or_default().to_owned();
    let guesses: Vec<String> = match error.remove(guess) {
        Some(ContextValue::String(one)) => vec![one],
        Some(ContextValue::Strings(several)) => several,
        _ => return,
    };
    let is_near = |guess: &String| darkroot::nearest(&typed, [guess.trim_start_matches('-')]).is_some();
    let mut near: Vec<String> = guesses.into_iter().filter(is_near).collect();
    match (near.len(), guess) {
        (0, _) => return,
        (1, ContextKind::SuggestedArg | ContextKind::SuggestedValue) => {
            error.insert(guess, ContextValue::String(near.remove(0)))
        }
        _ => error.insert(guess, ContextValue::Strings(near)),
    };
}
