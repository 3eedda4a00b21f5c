//! Charts and references as people name them.

use std::path::Path;

use darkroot_chart::{ChartLayout, Reference};

use crate::fault::ChartError;
use crate::{Error, files};

/// A reference and where it is from.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedReference {
    /// The colours.
    pub colours: Reference,
    /// Name of the file or of the built-in reference.
    pub name: String,
    /// SHA-256 of the file, hexadecimal; empty for those built in.
    pub sha256: String,
    /// Where nobody named one: what else the chart may be. Which one it is, a shot tells.
    pub others: Vec<Self>,
}

impl NamedReference {
    fn builtin(name: &str) -> Option<Self> {
        let colours = darkroot_chart::builtin_reference::builtin(name)?;
        Some(Self { colours, name: name.to_owned(), sha256: String::new(), others: Vec::new() })
    }
}

/// Every chart that is built in.
pub fn layouts() -> Vec<ChartLayout> {
    ChartLayout::builtin()
}

/// The layout of a chart: one that is built in, or a file that describes one (TOML or Argyll's `.cht`).
///
/// # Errors
/// Neither of both, or a file that describes none.
pub fn layout(text: &str) -> Result<ChartLayout, Error> {
    if let Some(layout) = ChartLayout::by_name(text) {
        return Ok(layout);
    }
    let path = Path::new(text);
    if path.is_file() {
        let content = read(path)?;
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let toml = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("toml"));
        let read =
            if toml { ChartLayout::from_toml(&content) } else { ChartLayout::from_cht(&stem, &content) };
        return read.map_err(|e| Error::chart(path, e));
    }
    Err(Error::chart(path, ChartError::UnknownChart))
}

/// A file that describes charts or their patches, as text.
pub(crate) fn read(path: &Path) -> Result<String, Error> {
    String::from_utf8(files::read_text(path)?).map_err(|_| Error::chart(path, ChartError::NotText))
}

/// Names of the charts that are built in.
pub(crate) fn names() -> String {
    let names: Vec<String> = ChartLayout::builtin().into_iter().map(|l| l.name).collect();
    names.join(", ")
}

/// The reference colours of a chart: a file, one that is built in by name, or those that are built in for the layout.
///
/// # Errors
/// Neither of both, a file that cannot be used, or a chart without a built-in reference.
pub fn reference(text: Option<&str>, layout: &ChartLayout) -> Result<NamedReference, Error> {
    let fault = |fault: ChartError| Err(Error::chart(Path::new(text.unwrap_or(&layout.name)), fault));
    let Some(text) = text else {
        let names = darkroot_chart::builtin_reference::of_layout(&layout.name);
        let mut built_in = names.iter().filter_map(|name| NamedReference::builtin(name));
        return match built_in.next() {
            Some(first) => Ok(NamedReference { others: built_in.collect(), ..first }),
            None => fault(ChartError::NoReference),
        };
    };
    if let Some(found) = NamedReference::builtin(text) {
        return Ok(found);
    }
    let path = Path::new(text);
    let content = read(path)?;
    let sha256 = files::sha256(content.as_bytes());
    let colours = match Reference::parse(&content) {
        Ok(colours) => colours,
        Err(e) => return fault(e.into()),
    };
    Ok(NamedReference {
        colours,
        name: path.file_name().unwrap_or_default().to_string_lossy().into_owned(),
        sha256,
        others: Vec::new(),
    })
}
