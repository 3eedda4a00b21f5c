//! Which files of a folder are taken: raw files, and what patterns say.

use std::path::{Path, PathBuf};

use glob::{MatchOptions, Pattern};

/// Endings of raw files, lower case. Other files in folders are passed over, unless a pattern includes them.
pub const RAW_ENDINGS: [&str; 34] = [
    "3fr", "ari", "arw", "bay", "cr2", "cr3", "crw", "cs1", "dcr", "dcs", "dng", "erf", "fff", "gpr", "iiq",
    "k25", "kdc", "mef", "mos", "mrw", "nef", "nrw", "orf", "ori", "pef", "raf", "raw", "rw2", "rwl", "sr2",
    "srf", "srw", "sti", "x3f",
];

/// How names are compared with patterns.
pub(crate) const MATCHING: MatchOptions = MatchOptions {
    case_sensitive: false,
    require_literal_separator: false,
    require_literal_leading_dot: false,
};

/// Inputs that make no batch.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FindError {
    /// Nothing there.
    #[error("{input}: there is no such file or folder; check the name")]
    Missing {
        /// As it was given.
        input: String,
    },
    /// A pattern that is none.
    #[error("`{pattern}` is no pattern: {reason}")]
    Pattern {
        /// As it was given.
        pattern: String,
        /// What is wrong with it.
        reason: glob::PatternError,
    },
}

/// What of a folder is taken.
pub(crate) struct Filter {
    include: Vec<Pattern>,
    exclude: Vec<Pattern>,
    out: Option<PathBuf>,
}

impl Filter {
    pub(crate) fn new(include: &[String], exclude: &[String], out: &Path) -> Result<Self, FindError> {
        let patterns = |texts: &[String]| -> Result<Vec<Pattern>, FindError> {
            let one = |text: &String| {
                Pattern::new(text).map_err(|e| FindError::Pattern { pattern: text.clone(), reason: e })
            };
            texts.iter().map(one).collect()
        };
        Ok(Self {
            include: patterns(include)?,
            exclude: patterns(exclude)?,
            out: std::fs::canonicalize(out).ok(),
        })
    }

    fn matches(patterns: &[Pattern], key: &str, name: &str) -> bool {
        patterns.iter().any(|p| p.matches_with(key, MATCHING) || p.matches_with(name, MATCHING))
    }

    /// Whether a file that was named itself is taken.
    pub(crate) fn keeps(&self, key: &str, name: &str) -> bool {
        let included = self.include.is_empty() || Self::matches(&self.include, key, name);
        included && !self.excludes(key, name)
    }

    pub(crate) fn excludes(&self, key: &str, name: &str) -> bool {
        Self::matches(&self.exclude, key, name)
    }

    /// Whether a file in a folder is taken.
    pub(crate) fn takes(&self, key: &str, name: &str) -> bool {
        let raw = || {
            let ending = Path::new(name).extension().and_then(|e| e.to_str());
            ending.is_some_and(|e| RAW_ENDINGS.contains(&e.to_ascii_lowercase().as_str()))
        };
        self.keeps(key, name) && (!self.include.is_empty() || raw())
    }

    pub(crate) fn is_out(&self, path: &Path) -> bool {
        self.out.is_some() && std::fs::canonicalize(path).ok() == self.out
    }
}
