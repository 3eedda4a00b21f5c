//! Where outputs go, decided for all inputs before anything is written.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use darkroot_encode::Format;
use darkroot_photo::metadata::{Directory, tag};

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
    /// A name for each input: a path with {stem}, {ext}, {parent}, {camera}, {date}, {seq}.
    Template(String),
}

/// Names that cannot be used. Each message says what to do.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NamingError {
    /// Two inputs would write the same file.
    #[error(
        "{first} and {second} would both be written to {output}; name them apart with a template such as \
         `-o 'OUT/{{parent}}-{{stem}}-{{seq}}.jpg'`",
        first = first.display(), second = second.display(), output = output.display()
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
    #[error("{path}: is a raw file of this run and would be overwritten by a picture", path = path.display())]
    OverInput {
        /// The file.
        path: PathBuf,
    },
    /// A placeholder that does not exist.
    #[error(
        "`{{{name}}}` is no placeholder; there are {{stem}} {{ext}} {{parent}} {{camera}} {{date}} {{seq}}"
    )]
    Placeholder {
        /// What stands in the braces.
        name: String,
    },
    /// A placeholder that does not exist in batches.
    #[error(
        "`{{{name}}}` is no placeholder; there are {{folder}} {{stem}} {{suffix}} {{ext}} {{parent}} {{camera}} \
         {{date}} {{year}} {{month}} {{day}} {{seq}}"
    )]
    BatchPlaceholder {
        /// What stands in the braces.
        name: String,
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
        "{path}: its ending names no picture format; use .jpg .png .tif .webp .avif .exr or .jxl",
        path = path.display()
    )]
    Format {
        /// The output.
        path: PathBuf,
    },
}

impl Target {
    /// What a person means by an output: a template if it has braces, a folder if it is one or ends like one,
    /// else a file.
    pub fn parse(text: &str) -> Self {
        let path = PathBuf::from(text);
        if text.contains('{') {
            Self::Template(text.to_owned())
        } else if text.ends_with(['/', std::path::MAIN_SEPARATOR]) || path.is_dir() {
            Self::Folder(path)
        } else {
            Self::File(path)
        }
    }

    /// The format that its name says, if it says one.
    ///
    /// # Errors
    /// A file or template whose ending is no picture format.
    pub fn format(&self) -> Result<Option<Format>, NamingError> {
        let path = match self {
            Self::Beside | Self::Folder(_) => return Ok(None),
            Self::File(path) => path.clone(),
            Self::Template(text) if text.ends_with("{ext}") => return Ok(None),
            Self::Template(text) => PathBuf::from(text),
        };
        let extension = path.extension().and_then(|e| e.to_str());
        extension.and_then(Format::from_extension).map(Some).ok_or(NamingError::Format { path })
    }

    /// Whether file names need what stands inside the files (camera, date).
    fn needs_headers(&self) -> bool {
        matches!(self, Self::Template(t) if t.contains("{camera}") || t.contains("{date}"))
    }
}

/// The outputs of all inputs, in their order. Each input comes with the format of its picture.
///
/// # Errors
/// Outputs that collide, also where they differ only in case; an output that is an input; a wrong placeholder.
pub fn plan_outputs(inputs: &[(PathBuf, Format)], target: &Target) -> Result<Vec<Job>, NamingError> {
    let mut jobs = Vec::with_capacity(inputs.len());
    for (i, (input, format)) in inputs.iter().enumerate() {
        let format = *format;
        let output = match target {
            Target::Beside => input.with_extension(format.extension()),
            Target::Folder(folder) => {
                let name = input.with_extension(format.extension());
                folder.join(name.file_name().unwrap_or(name.as_os_str()))
            }
            Target::File(path) => path.clone(),
            Target::Template(text) => fill(text, input, i + 1, format, target.needs_headers())?,
        };
        jobs.push(Job { input: input.clone(), output });
    }
    let mut taken: HashMap<String, &Path> = HashMap::new();
    let originals: HashMap<String, &Path> = inputs.iter().map(|(i, _)| (key(i), i.as_path())).collect();
    for job in &jobs {
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

/// The path with its folder in the one form that the system knows it by.
fn place(path: &Path) -> PathBuf {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let folder = std::fs::canonicalize(folder).unwrap_or_else(|_| folder.to_owned());
    folder.join(path.file_name().unwrap_or_default())
}

/// The place in a form in which names that differ only in case are one, as they are on many disks.
fn key(path: &Path) -> String {
    place(path).to_string_lossy().to_lowercase()
}

/// Whether two paths name one file.
pub(crate) fn same(a: &Path, b: &Path) -> bool {
    key(a) == key(b)
}

fn fill(
    template: &str,
    input: &Path,
    number: usize,
    format: Format,
    headers: bool,
) -> Result<PathBuf, NamingError> {
    let header = headers.then(|| header(input)).flatten();
    let text = |s: Option<&std::ffi::OsStr>| s.map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
    let mut out = String::new();
    let mut rest = template;
    while let Some((before, after)) = rest.split_once('{') {
        let Some((name, tail)) = after.split_once('}') else {
            return Err(NamingError::Placeholder { name: after.to_owned() });
        };
        out.push_str(before);
        let value = match name {
            "stem" => text(input.file_stem()),
            "ext" => format.extension().to_owned(),
            "parent" => text(place(input).parent().and_then(Path::file_name)),
            "seq" => format!("{number:04}"),
            "camera" => header.as_ref().map_or("unknown".into(), |h| h.0.clone()),
            "date" => header.as_ref().map_or("undated".into(), |h| h.1.clone()),
            other => return Err(NamingError::Placeholder { name: other.to_owned() }),
        };
        out.push_str(&value);
        rest = tail;
    }
    out.push_str(rest);
    Ok(PathBuf::from(out))
}

/// Camera and date (2026-05-01) as they can stand in a file name.
fn header(input: &Path) -> Option<(String, String)> {
    let bytes = crate::files::read(input).ok()?;
    darkroot_raw::header(&bytes, &darkroot_raw::Limits::default()).ok().map(|capture| header_of(&capture))
}

/// Camera and date of a capture as they can stand in a file name.
pub fn header_of(capture: &darkroot_photo::Capture) -> (String, String) {
    let clean = |s: String| s.replace(|c: char| !c.is_alphanumeric() && c != '-' && c != '.', "_");
    let date = capture.metadata.text(Directory::Exif, tag::DATE_TIME_ORIGINAL).and_then(|d| d.get(..10));
    let date = date.map_or_else(|| "undated".to_owned(), |d| d.replace(':', "-"));
    (clean(capture.camera.name()), clean(date))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outputs(inputs: &[&str], target: Target) -> Result<Vec<String>, NamingError> {
        let inputs: Vec<_> = inputs.iter().map(|i| (PathBuf::from(i), Format::Jpeg)).collect();
        let jobs = plan_outputs(&inputs, &target)?;
        Ok(jobs.iter().map(|j| j.output.display().to_string()).collect())
    }

    #[test]
    fn outputs_lie_beside_their_inputs_or_in_the_folder() {
        assert_eq!(outputs(&["a/DSC_1.NEF"], Target::Beside).unwrap(), ["a/DSC_1.jpg"]);
        assert_eq!(outputs(&["a/x.v2.dng"], Target::parse("out/")).unwrap(), ["out/x.v2.jpg"]);
    }

    #[test]
    fn templates_are_filled_in() {
        let target = Target::parse("out/{parent}-{stem}-{seq}.{ext}");
        assert_eq!(
            outputs(&["roll/1.nef", "roll/2.nef"], target).unwrap(),
            ["out/roll-1-0001.jpg", "out/roll-2-0002.jpg"]
        );
        let wrong = outputs(&["1.nef"], Target::parse("{name}.jpg")).unwrap_err();
        assert!(wrong.to_string().contains("{stem}"), "{wrong}");
    }

    #[test]
    fn each_input_has_the_ending_of_its_own_format() {
        let inputs = [("x.nef".into(), Format::Jpeg), ("x.dng".into(), Format::Png)];
        let jobs = plan_outputs(&inputs, &Target::parse("out/{stem}.{ext}")).unwrap();
        assert_eq!((&jobs[0].output, &jobs[1].output), (&"out/x.jpg".into(), &"out/x.png".into()));
    }

    #[test]
    fn two_inputs_for_one_output_are_found_before_anything_is_written() {
        for (a, b) in [("x.nef", "x.dng"), ("x.nef", "X.NEF")] {
            let error = outputs(&[a, b], Target::Beside).unwrap_err();
            assert!(matches!(error, NamingError::Collision { .. }), "{error}");
        }
        assert!(outputs(&["a.nef", "b.nef"], Target::File("c.jpg".into())).is_err());
    }

    #[test]
    fn an_output_over_its_input_is_refused() {
        let error = outputs(&["x.jpg"], Target::Beside).unwrap_err();
        assert!(matches!(error, NamingError::OverInput { .. }), "{error}");
    }
}
