//! Pictures for a screen: which settings they are rendered with, and their bytes.

use darkroot::{ChromaSubsampling, EncodeOptions, Format, Key, Settings};
use darkroot_colour::{RgbSpace, Vector3, white};
use darkroot_develop::{Bits, Look, Mending, OutputSpace};
use darkroot_photo::{Metadata, Picture, PictureSpace, Samples};
use serde::Deserialize;

/// What a screen shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Gamut {
    /// Colours of sRGB.
    #[default]
    Srgb,
    /// Those of Display P3.
    DisplayP3,
}

impl Gamut {
    pub(crate) fn space(self) -> RgbSpace {
        match self {
            Self::Srgb => RgbSpace::SRGB,
            Self::DisplayP3 => RgbSpace::DISPLAY_P3,
        }
    }
}

/// Settings by which a screen shows what a file's settings ask for: in its own space, 8 bits, at the picture's own size. Light that
/// is not for a screen (the linear look, camera RGB) stays as it is; [`for_screen`] bends it.
pub(crate) fn shown(mut settings: Settings, gamut: Gamut) -> Settings {
    settings.recipe.geometry.resize = darkroot_develop::Resize::None;
    settings.hdr = 0.0;
    if settings.recipe.look == Look::Linear || settings.space == Some(OutputSpace::Camera) {
        settings.format = Some(Format::Exr);
        settings.bits = Some(Bits::Float);
        if settings.space != Some(OutputSpace::Camera) {
            settings.space = None;
        }
    } else {
        settings.format = Some(Format::Png);
        settings.bits = Some(Bits::Eight);
        settings.space = Some(OutputSpace::Rgb(gamut.space()));
    }
    settings
}

/// The same with noise left in, which halves the time of a view.
pub(crate) fn with_noise(mut settings: Settings) -> Settings {
    settings.recipe.denoise.amount = Some(0.0);
    settings
}

/// Settings by which a photograph that was just opened is seen soonest: what is wrong with its samples, which takes longer to
/// find than to mend, is left in.
pub(crate) fn at_once(settings: Settings) -> Settings {
    let mut settings = with_noise(settings);
    settings.recipe.hot_pixels = Mending::Off;
    settings.recipe.banding = Mending::Off;
    settings.recipe.geometry.keep_fringes = true;
    settings.recipe.sharpen = Some(0.0);
    settings
}

/// A picture in a space and with samples that a screen takes.
pub(crate) fn for_screen(picture: Picture, gamut: Gamut) -> Picture {
    let Samples::F32(samples) = &picture.samples else { return picture };
    let (to, space) = (gamut.space(), PictureSpace::Rgb(gamut.space()));
    // Camera RGB has no colours yet: it is shown as if it were the screen's own.
    let matrix = match picture.space {
        PictureSpace::Rgb(from) => to.from_xyz_under(white::D65) * from.to_xyz_under(white::D65),
        PictureSpace::Camera | PictureSpace::Raw => darkroot_colour::Matrix3::identity(),
    };
    let bent = samples.chunks_exact(3).flat_map(|rgb| {
        let light = matrix * Vector3::new(rgb[0].into(), rgb[1].into(), rgb[2].into());
        [0, 1, 2].map(|c| (to.curve.encode(light[c].clamp(0.0, 1.0)) * 255.0).round() as u8)
    });
    Picture { size: picture.size, samples: Samples::U8(bent.collect()), space }
}

/// How a picture is sent.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Sent {
    /// A JPEG: small, for pictures that change.
    #[default]
    Jpeg,
    /// A PNG: every sample as it was rendered.
    Png,
}

/// Quality of JPEG: nothing of it is seen at the size of a screen.
const QUALITY: u8 = 93;
/// Quality for a picture that is seen for a moment.
const QUICK_QUALITY: u8 = 85;

/// The bytes of a picture, with its colour space, and their kind. One that is seen for a moment only may be coarser.
pub(crate) fn bytes(
    picture: &Picture,
    sent: Sent,
    quick: bool,
) -> Result<(Vec<u8>, &'static str), darkroot_encode::Error> {
    let (format, kind) = match sent {
        Sent::Jpeg => (Format::Jpeg, "image/jpeg"),
        Sent::Png => (Format::Png, "image/png"),
    };
    let mut out = std::io::Cursor::new(Vec::new());
    let (quality, subsampling) = match quick {
        true => (QUICK_QUALITY, ChromaSubsampling::S420),
        false => (QUALITY, ChromaSubsampling::S444),
    };
    let options = EncodeOptions { quality, subsampling, ..EncodeOptions::default() };
    darkroot_encode::write(picture, format, &options, &Metadata::default(), &mut out)?;
    Ok((out.into_inner(), kind))
}

/// Settings that other files decide, such as a profile: each with its text.
pub(crate) fn named_files(values: &[(Key, String)]) -> impl Iterator<Item = (Key, &str)> {
    values.iter().filter(|(key, text)| key.is_file(text)).map(|(key, text)| (*key, text.as_str()))
}
