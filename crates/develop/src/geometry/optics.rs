//! What is done about the lens, by whose word: the file's own correction, else the maker's note where that is asked for, else
//! lensfun's database.

use darkroot_photo::{Capture, Correction, Rect};

use super::lens::{LensWarp, half_diagonal};
use super::vignetting::Vignetting;
use super::{Geometry, Lens};

/// What is done about the lens.
#[derive(Debug, Default)]
pub(super) struct Optics {
    /// In the order in which they are applied.
    pub(super) warps: Vec<LensWarp>,
    /// Whether they leave open how large the picture gets. What the file carries says so itself.
    pub(super) is_to_fit: bool,
    /// With the middle of the lens's picture, in columns and rows of the frame.
    pub(super) vignetting: Option<(Vignetting, [f64; 2])>,
    /// What became of what the file carries, and of what the maker's note says.
    pub(super) note: Option<String>,
}

/// Nobody who measures gets the file's correction unasked. `shown` is what the maker shows, from the corner of the active area.
pub(super) fn optics(capture: &Capture, asked: &Geometry, measuring: bool, shown: Rect) -> Optics {
    let of_file = match asked.lens {
        Lens::Off => Vec::new(),
        Lens::Auto if measuring => Vec::new(),
        _ => LensWarp::of_file(capture, asked.keep_fringes),
    };
    if !of_file.is_empty() {
        let what =
            match (of_file.iter().any(LensWarp::moves_all), of_file.iter().any(LensWarp::splits_colours)) {
                (true, true) => "distortion and lateral chromatic aberration",
                (true, false) => "distortion",
                (false, _) => "lateral chromatic aberration",
            };
        let note = Some(format!("the lens is corrected as the file says ({what})"));
        return Optics { warps: of_file, note, ..Optics::default() };
    }
    let with_light = |vignetting: Option<Vignetting>| {
        vignetting.filter(|_| !asked.keep_vignetting).map(|v| (v, capture.default_crop.middle()))
    };
    match (&capture.maker_lens, asked.lens) {
        (Some(told), Lens::Maker) => {
            let told = told.clone().without(asked.keep_fringes, asked.keep_vignetting);
            let reach = half_diagonal(shown.size());
            let note = format!(
                "the lens is corrected as {}'s note says ({}); that could not be checked against the camera's own pictures{}",
                told.maker,
                told.parts(),
                told.and_left()
            );
            Optics {
                warps: LensWarp::told(&told, shown).into_iter().collect(),
                is_to_fit: true,
                vignetting: with_light(told.gain.map(|gain| Vignetting::Told { gain, reach })),
                note: Some(note),
            }
        }
        (_, Lens::Lensfun | Lens::Maker) => {
            let known = asked.known.map(|known| if asked.keep_fringes { known.without_tca() } else { known });
            Optics {
                warps: known.and_then(|known| LensWarp::known(known, shown)).into_iter().collect(),
                is_to_fit: true,
                vignetting: with_light(known.filter(|k| k.has_vignetting()).map(Vignetting::Measured)),
                note: not_applied(capture),
            }
        }
        _ => Optics { note: not_applied(capture), ..Optics::default() },
    }
}

/// What the file has of the lens and nobody asked for.
fn not_applied(capture: &Capture) -> Option<String> {
    let mut all = capture.mosaic_corrections.iter().chain(&capture.picture_corrections);
    if all.any(|correction| matches!(correction, Correction::Warp(_))) {
        return Some("the file's correction of the lens is not applied".to_owned());
    }
    capture.maker_lens.as_ref().map(|told| {
        format!(
            "{}'s note on the lens ({}) is not applied unasked: it could not be checked against the camera's own pictures",
            told.maker,
            told.parts()
        )
    })
}
