//! The settings that a person can name, by the names of their flags.

use std::fmt;

/// A setting. Its name is the same on the command line and in files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Key {
    /// File format of the picture.
    Format,
    /// Colour space of the picture.
    Space,
    /// Bits a sample.
    Bits,
    /// Quality of JPEG and AVIF.
    Quality,
    /// Chroma subsampling of JPEG.
    Chroma,
    /// Stops to add.
    Exposure,
    /// Whether exposure is chosen from the picture first.
    AutoExposure,
    /// White of the light.
    WhiteBalance,
    /// Rendering from scene to display.
    Look,
    /// What becomes of clipped highlights.
    Highlights,
    /// How missing colours are interpolated.
    Demosaic,
    /// Which part of the frame.
    Crop,
    /// Which profile gives the colours.
    Profile,
    /// Which program develops.
    Engine,
    /// Which library decodes.
    Decoder,
}

impl Key {
    /// Every key.
    pub const ALL: [Self; 15] = [
        Self::Format,
        Self::Space,
        Self::Bits,
        Self::Quality,
        Self::Chroma,
        Self::Exposure,
        Self::AutoExposure,
        Self::WhiteBalance,
        Self::Look,
        Self::Highlights,
        Self::Demosaic,
        Self::Crop,
        Self::Profile,
        Self::Engine,
        Self::Decoder,
    ];

    /// Its name: that of the flag, without the dashes before it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Format => "format",
            Self::Space => "space",
            Self::Bits => "bits",
            Self::Quality => "quality",
            Self::Chroma => "chroma",
            Self::Exposure => "exposure",
            Self::AutoExposure => "auto-exposure",
            Self::WhiteBalance => "white-balance",
            Self::Look => "look",
            Self::Highlights => "highlights",
            Self::Demosaic => "demosaic",
            Self::Crop => "crop",
            Self::Profile => "profile",
            Self::Engine => "engine",
            Self::Decoder => "decoder",
        }
    }

    /// What holds where nobody says anything.
    pub fn default_text(self) -> &'static str {
        match self {
            Self::Format | Self::Space | Self::Bits | Self::Profile => "auto",
            Self::Quality => "92",
            Self::Chroma => "444",
            Self::Exposure => "0",
            Self::AutoExposure => "false",
            Self::WhiteBalance => "as-shot",
            Self::Look => "neutral",
            Self::Highlights => "rebuild",
            Self::Demosaic => "best",
            Self::Crop => "default",
            Self::Engine => "darkroot",
            Self::Decoder => "flashraw",
        }
    }

    /// The key of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|key| key.name() == name)
    }

    /// Whether its values are numbers (where they are not `auto`).
    pub fn is_number(self) -> bool {
        matches!(self, Self::Bits | Self::Quality | Self::Chroma | Self::Exposure)
    }

    /// Whether its values are `true` and `false`.
    pub fn is_switch(self) -> bool {
        self == Self::AutoExposure
    }

    /// The key that a person may have meant by a name that is none.
    pub(super) fn nearest(name: &str) -> Option<Self> {
        /// More slips of the finger than this make another word.
        const MOST_SLIPS: usize = 2;
        let name = name.to_lowercase().replace(['_', ' '], "-");
        if name == "wb" {
            return Some(Self::WhiteBalance);
        }
        let (slips, key) = Self::ALL.into_iter().map(|key| (slips(&name, key.name()), key)).min()?;
        (slips <= MOST_SLIPS).then_some(key)
    }

    /// Every name, for messages.
    pub(super) fn names() -> String {
        Self::ALL.map(Self::name).join(", ")
    }
}

impl fmt::Display for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Letters to insert, delete or replace between two words (Levenshtein distance).
fn slips(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.chars().enumerate() {
        let mut diagonal = std::mem::replace(&mut row[0], i + 1);
        for (j, y) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(x != *y);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(diagonal + 1).min(row[j] + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_name_is_the_name_of_one_key() {
        for key in Key::ALL {
            assert_eq!(Key::from_name(key.name()), Some(key));
        }
        let mut sorted = Key::ALL;
        sorted.sort();
        assert_eq!(sorted, Key::ALL);
    }

    #[test]
    fn slips_of_the_finger_are_recognised() {
        for (typed, meant) in [
            ("spcae", Some(Key::Space)),
            ("white_balance", Some(Key::WhiteBalance)),
            ("wb", Some(Key::WhiteBalance)),
            ("Exposre", Some(Key::Exposure)),
            ("sharpening", None),
            ("", None),
        ] {
            assert_eq!(Key::nearest(typed), meant, "{typed}");
        }
    }
}
