//! Where outputs go, decided for all inputs before anything is written.

mod part;
pub use part::PathPart;

pub mod template;
use template::{Fields, PLACEHOLDERS};

use std::collections::HashMap;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use darkroot_encode::Format;
use darkroot_photo::metadata::{Directory, tag};

use crate::files::is_stream;
use crate::{path_text, shown};

/// One input and its output.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Job {
    /// The raw file.
    pub input: PathBuf,
    /// The picture to write.
    pub output: PathBuf,
}

/// What `-o` asks for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Target {
    /// Beside each input.
    Beside,
    /// Into this folder.
    Folder(PathBuf),
    /// This file (for one input).
    File(PathBuf),
    /// A name for each input, as [`template::fill`] takes it.
    Template(String),
    /// Standard output (for one input).
    Stream,
}

/// Names that cannot be used. Each message says what to do.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NamingError {
    /// Two inputs would write the same file.
    #[error(
        "{first} and {second} would both be written to {output}; name them apart with a template such as \
         `-o 'OUT/{{parent}}-{{stem}}-{{seq}}.jpg'`",
        first = shown(first), second = shown(second), output = shown(output)
    )]
    Collision {
        /// An input.
        first: PathBuf,
        /// Another input.
        second: PathBuf,
        /// The common output.
        output: PathBuf,
    },
    /// The output is an input.
    #[error("{path}: is a raw file of this run and would be overwritten by a picture", path = shown(path))]
    OverInput {
        /// The file.
        path: PathBuf,
    },
    /// A placeholder that does not exist.
    #[error("`{{{name}}}` is no placeholder; there are {folder}{PLACEHOLDERS}")]
    Placeholder {
        /// What stands in the braces.
        name: String,
        /// Placeholders that there are beside those of every template.
        folder: &'static str,
    },
    /// A template with bytes that are no Unicode.
    #[error("{}: names with placeholders are written in Unicode", shown(template))]
    TemplateText {
        /// As it was given.
        template: PathBuf,
    },
    /// An input that a picture cannot be called after, nor put beside.
    #[error("{}: has neither a name nor a folder for its picture; name the picture", shown(path))]
    NoName {
        /// The input.
        path: PathBuf,
    },
    /// Several pictures in one stream.
    #[error(
        "standard output takes one picture, and {count} files are to be developed; develop them into a folder"
    )]
    Stream {
        /// Number of inputs.
        count: usize,
    },
    /// The format that was asked for is not that of the name.
    #[error(
        "{}: its ending names {named}, but {asked} was asked for; give it the ending of {asked}",
        shown(path)
    )]
    OtherFormat {
        /// The output.
        path: PathBuf,
        /// The format that the ending names.
        named: Format,
        /// The format that was asked for.
        asked: Format,
    },
    /// A template that leaves the output folder.
    #[error(
        "`{template}` leads out of the output folder; name files below it, such as `{{folder}}/{{stem}}.{{ext}}`"
    )]
    Outside {
        /// As it was given.
        template: String,
    },
    /// The ending names no format.
    #[error(
        "{path}: its ending names no picture format; use .jpg .png .tif .webp .avif .exr .jxl or .dng",
        path = shown(path)
    )]
    Format {
        /// The output.
        path: PathBuf,
    },
}

impl Target {
    /// The folder below which all outputs of a template lie, whatever stands in the files; none for other targets.
    pub fn root(&self) -> Option<PathBuf> {
        let Self::Template(text) = self else { return None };
        let fixed = &text[..text.find('{').unwrap_or(text.len())];
        Some(fixed.rsplit_once(std::path::is_separator).map_or_else(PathBuf::new, |(root, _)| root.into()))
    }

    /// What a person means by an output: standard output if it is `-`, a template if it has braces, a folder if it is
    /// one or ends like one, else a file.
    ///
    /// # Errors
    /// A template that is no Unicode.
    pub fn parse(text: &OsStr) -> Result<Self, NamingError> {
        let path = PathBuf::from(text);
        let bytes = text.as_encoded_bytes();
        Ok(if is_stream(&path) {
            Self::Stream
        } else if bytes.contains(&b'{') {
            let text = text.to_str().ok_or(NamingError::TemplateText { template: path })?;
            Self::Template(text.to_owned())
        } else if bytes.last().is_some_and(|b| std::path::is_separator(char::from(*b))) || path.is_dir() {
            Self::Folder(path)
        } else {
            Self::File(path)
        })
    }

    /// The format that its name says, if it says one.
    ///
    /// # Errors
    /// A file or template whose ending is no picture format.
    pub fn format(&self) -> Result<Option<Format>, NamingError> {
        let path = self.path();
        let is_open = match self {
            Self::Beside | Self::Folder(_) | Self::Stream => true,
            Self::File(_) => false,
            Self::Template(text) => text.ends_with("{ext}"),
        };
        if is_open {
            return Ok(None);
        }
        let extension = path.extension().and_then(|e| e.to_str());
        extension
            .and_then(Format::from_extension)
            .map(Some)
            .ok_or_else(|| NamingError::Format { path: path.to_owned() })
    }

    /// As it was given; empty where nothing was.
    pub(crate) fn path(&self) -> &Path {
        match self {
            Self::Beside => Path::new(""),
            Self::Folder(path) | Self::File(path) => path,
            Self::Template(text) => Path::new(text),
            Self::Stream => Path::new("-"),
        }
    }

    /// Whether file names need what stands inside the files (camera, date).
    pub fn needs_headers(&self) -> bool {
        matches!(self, Self::Template(t) if template::needs_headers(t))
    }
}

/// The outputs of all inputs, in their order. Each input comes with the format of its picture.
///
/// # Errors
/// Outputs that collide, also where they differ only in case; an output that is an input; a wrong placeholder.
pub fn plan_outputs(inputs: &[(PathBuf, Format)], target: &Target) -> Result<Vec<Job>, NamingError> {
    if matches!(target, Target::Stream) && inputs.len() > 1 {
        return Err(NamingError::Stream { count: inputs.len() });
    }
    let mut jobs = Vec::with_capacity(inputs.len());
    for (i, (input, format)) in inputs.iter().enumerate() {
        let format = *format;
        let named_after_input = !matches!(target, Target::File(_) | Target::Stream);
        if named_after_input && is_nameless(input) {
            return Err(NamingError::NoName { path: input.clone() });
        }
        let output = match target {
            Target::Beside => input.with_extension(format.extension()),
            Target::Folder(folder) => {
                let name = input.with_extension(format.extension());
                folder.join(name.file_name().unwrap_or(name.as_os_str()))
            }
            Target::File(path) => path.clone(),
            Target::Template(text) => {
                template::fill(text, &fields(input, i + 1, format, target.needs_headers()))?
            }
            Target::Stream => PathBuf::from("-"),
        };
        jobs.push(Job { input: input.clone(), output });
    }
    let mut taken: HashMap<String, &Path> = HashMap::new();
    let originals: HashMap<String, &Path> = inputs.iter().map(|(i, _)| (key(i), i.as_path())).collect();
    for job in &jobs {
        if is_stream(&job.output) {
            continue;
        }
        let key = key(&job.output);
        if let Some(input) = originals.get(&key) {
            return Err(NamingError::OverInput { path: input.to_path_buf() });
        }
        if let Some(first) = taken.insert(key, &job.input) {
            return Err(NamingError::Collision {
                first: first.to_owned(),
                second: job.input.clone(),
                output: job.output.clone(),
            });
        }
    }
    Ok(jobs)
}

/// Whether an input is standard input, or stands among the devices and open files of the system.
fn is_nameless(input: &Path) -> bool {
    is_stream(input) || input.starts_with("/dev") || input.starts_with("/proc")
}

/// The path with its folder in the one form that the system knows it by.
fn place(path: &Path) -> PathBuf {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let folder = std::fs::canonicalize(folder).unwrap_or_else(|_| folder.to_owned());
    folder.join(path.file_name().unwrap_or_default())
}

/// The place in a form in which names that differ only in case are one, as they are on many disks.
fn key(path: &Path) -> String {
    path_text::text(&place(path)).to_lowercase()
}

/// Whether two paths name one file.
pub(crate) fn same(a: &Path, b: &Path) -> bool {
    key(a) == key(b)
}

/// What the name of an input's picture can be made of.
fn fields(input: &Path, number: usize, format: Format, headers: bool) -> Fields {
    let (camera, date) = headers.then(|| header(input)).flatten().unwrap_or_default();
    Fields {
        folder: None,
        name: input.file_name().unwrap_or_default().to_owned(),
        parent: place(input).parent().and_then(Path::file_name).unwrap_or_default().to_owned(),
        ext: format.extension().to_owned(),
        number,
        camera,
        date,
    }
}

/// Camera and date (2026-05-01) as they can stand in a file name.
fn header(input: &Path) -> Option<(String, String)> {
    let bytes = crate::files::read(input).ok()?;
    darkroot_raw::header(&bytes, &darkroot_raw::Limits::default()).ok().map(|capture| header_of(&capture))
}

/// Camera and date of a capture, as names of files have them: `Nikon_D700`, `2026-05-01`. Empty where the file does not
/// tell, or tells what is no date.
pub fn header_of(capture: &darkroot_photo::Capture) -> (String, String) {
    /// No camera has a longer name.
    const LONGEST: usize = 100;
    let clean = |c: char| if c.is_alphanumeric() || c == '-' || c == '.' { c } else { '_' };
    let camera = capture.camera.name().chars().take(LONGEST).map(clean).collect();
    let date = capture.metadata.text(Directory::Exif, tag::DATE_TIME_ORIGINAL).and_then(date);
    (camera, date.unwrap_or_default())
}

/// The day of an Exif date (2026:05:01 12:00:00) as 2026-05-01.
pub(crate) fn date(text: &str) -> Option<String> {
    let day = text.get(..10)?.replace(':', "-");
    let form = |(i, c): (usize, char)| if i == 4 || i == 7 { c == '-' } else { c.is_ascii_digit() };
    day.chars().enumerate().all(form).then_some(day)
}

#[cfg(test)]
mod tests;
