//! Colour spaces by the names that people write.

use darkroot_colour::RgbSpace;
use darkroot_develop::OutputSpace;

/// The spaces that a person can name, without the `-linear` ending.
pub const SPACES: [(&str, RgbSpace); 6] = [
    ("srgb", RgbSpace::SRGB),
    ("display-p3", RgbSpace::DISPLAY_P3),
    ("adobe-rgb", RgbSpace::ADOBE_RGB),
    ("prophoto", RgbSpace::PROPHOTO),
    ("rec2020", RgbSpace::REC2020),
    ("ecirgb-v2", RgbSpace::ECIRGB_V2),
];

/// The space of a name: one of [`SPACES`], each also with `-linear`, `aces2065-1` or `camera`.
pub fn space(name: &str) -> Option<OutputSpace> {
    if name == "camera" {
        return Some(OutputSpace::Camera);
    }
    if name == "aces2065-1" {
        return Some(OutputSpace::Rgb(RgbSpace::ACES2065_1));
    }
    let (base, linear) = name.strip_suffix("-linear").map_or((name, false), |base| (base, true));
    let (_, space) = SPACES.iter().find(|(n, _)| *n == base)?;
    Some(OutputSpace::Rgb(if linear { space.linear() } else { *space }))
}

pub(super) fn space_name(space: &RgbSpace) -> String {
    SPACES.iter().find(|(_, s)| s.primaries == space.primaries).map_or(space.name, |(n, _)| n).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_space_has_a_linear_form() {
        for (name, plain) in SPACES {
            assert_eq!(space(name), Some(OutputSpace::Rgb(plain)));
            assert_eq!(space(&format!("{name}-linear")), Some(OutputSpace::Rgb(plain.linear())));
        }
        assert_eq!(space("srgb-lines"), None);
    }
}
