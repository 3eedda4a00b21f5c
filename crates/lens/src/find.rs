//! The lens of a shot.

use crate::catalogue::{self, Camera, Lens};
use crate::corrections::{Corrections, Distortion, Known, Measured, Tca, Vignetting};
use crate::interpolate;
use crate::name;

/// How far beyond its range a lens's focal length may be written, as a part of it: cameras round.
const FOCAL_ROUNDING: f64 = 0.07;

/// A sensor this much larger than the one that a lens was measured with still counts as that one (as in lensfun).
const SAME_CROP: f64 = 0.96;

/// What stands for a distance that is not known, in m (the manual of lensfun recommends it).
const FAR: f64 = 1000.0;

/// What a photograph's metadata say of camera and lens.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Shot<'a> {
    /// The camera's maker (Exif `Make`).
    pub camera_make: &'a str,
    /// The camera's model (Exif `Model`).
    pub camera_model: &'a str,
    /// The lens's maker (Exif `LensMake`).
    pub lens_make: Option<&'a str>,
    /// The lens's name (Exif `LensModel`, or what a maker note has).
    pub lens_model: Option<&'a str>,
    /// Focal length in mm, as on the lens.
    pub focal_length: f64,
    /// F-number. Without it there is no correction of vignetting.
    pub aperture: Option<f64>,
    /// Distance of what is in focus, in m; far away if not known.
    pub distance: Option<f64>,
    /// Diagonal of a frame of 36 mm x 24 mm through that of the picture, where it is not that of the camera's whole
    /// sensor, or the database may not know the camera.
    pub crop_factor: Option<f64>,
}

impl<'a> Shot<'a> {
    /// A shot of which only camera and focal length (mm) are known.
    pub fn new(camera_make: &'a str, camera_model: &'a str, focal_length: f64) -> Self {
        Self { camera_make, camera_model, focal_length, ..Self::default() }
    }
}

/// By what a lens was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Found {
    /// Its name.
    Name,
    /// The metadata have only focal lengths and f-numbers ("18.0-55.0 mm f/3.5-5.6"), and one zoom lens of the database
    /// that fits the camera has these. There may be lenses that the database does not know.
    Numbers,
    /// The camera: its lens cannot be changed.
    Camera,
}

/// A lens of the database, and what is known of it at the settings of a shot.
#[derive(Debug, Clone, PartialEq)]
pub struct Match {
    /// Camera of the database, maker and model; `None` if it has none such.
    pub camera: Option<String>,
    /// Lens of the database, maker and model.
    pub lens: String,
    /// By what it was found.
    pub found: Found,
    known: Known,
}

impl Match {
    /// Whether distortion was measured.
    pub fn has_distortion(&self) -> bool {
        self.known.distortion.is_some()
    }

    /// Whether lateral chromatic aberration was measured.
    pub fn has_tca(&self) -> bool {
        self.known.tca.is_some()
    }

    /// Whether vignetting was measured near the aperture of the shot.
    pub fn has_vignetting(&self) -> bool {
        self.known.vignetting.is_some()
    }

    /// The corrections of a picture of the whole sensor, width and height in pixels, either way up.
    pub fn corrections(&self, size: (usize, usize)) -> Corrections {
        self.known.over(size)
    }
}

/// The lens that a shot was taken with, if the database knows it for sure: by its name, or because the camera has no
/// other. Nothing is loaded before and nothing kept.
pub fn find(shot: &Shot) -> Option<Match> {
    if !(shot.focal_length.is_finite() && shot.focal_length > 0.0) {
        return None;
    }
    let camera = camera(shot);
    let crop = shot.crop_factor.or(camera.map(|c| c.crop))?;
    if !(0.05..=50.0).contains(&crop) {
        return None;
    }
    let (lenses, found) = match camera.filter(Camera::is_fixed) {
        Some(camera) => (fixed(shot, &camera)?, Found::Camera),
        None => named(shot, camera.as_ref())?,
    };
    let lens = lenses.first()?;
    let full = |makers: &str, model: &str| {
        let known = model.to_lowercase().starts_with(&makers.to_lowercase());
        if known || makers.is_empty() { model.to_owned() } else { format!("{makers} {model}") }
    };
    Some(Match {
        camera: camera.map(|c| full(c.makers.first(), c.models.first())),
        lens: full(lens.makers().first(), lens.models().first()),
        found,
        known: known(shot, &lenses, crop),
    })
}

/// The camera of a shot: same model, and a maker with a name in common; `None` also if that says two that differ.
fn camera(shot: &Shot) -> Option<Camera> {
    let model = name::words(shot.camera_model);
    let asked = name::brand([shot.camera_make, shot.camera_model]);
    let without = |words: &[String], brand: &[String]| -> Vec<String> {
        words.iter().filter(|word| !brand.contains(word)).cloned().collect()
    };
    let is_it = |camera: &Camera| {
        let brand = name::brand(camera.makers.iter());
        let bare = without(&model, &brand);
        !bare.is_empty()
            && brand.iter().any(|word| asked.contains(word))
            && camera.models.iter().any(|known| without(&name::words(known), &brand) == bare)
    };
    let numbers = name::numbers(&model);
    let mut found = catalogue::cameras(&numbers).filter(is_it);
    let first = found.next()?;
    // Some have modes with frames of different shape, each with a crop factor.
    let same_crop =
        |other: Camera| shot.crop_factor.is_some() || (other.crop / first.crop - 1.0).abs() < 0.01;
    found.all(|other| other.mount == first.mount && same_crop(other)).then_some(first)
}

/// The lens of a camera that has one only: not with a converter, and not a phone's other one. What the firmware CHDK
/// stored is raw, as what is to be corrected; of others, the camera's own pictures may have been measured.
fn fixed(shot: &Shot, camera: &Camera) -> Option<Vec<Lens>> {
    let fits = |lens: &Lens| lens.mounts().iter().any(|mount| mount == camera.mount);
    let lenses = catalogue::lenses(&[]).filter(|lens| fits(lens) && reaches(*lens, shot.focal_length));
    let (raw, others): (Vec<Lens>, Vec<Lens>) =
        lenses.partition(|lens| lens.models().first().ends_with("with CHDK's DNG"));
    let plain = |lens: &Lens| [", ", " + "].iter().all(|with| !lens.models().first().contains(with));
    one_lens(raw).or_else(|| one_lens(others.into_iter().filter(plain).collect()))
}

/// The lens that a shot names.
fn named(shot: &Shot, camera: Option<&Camera>) -> Option<(Vec<Lens>, Found)> {
    let text = shot.lens_model?;
    let mounts = camera.map(Camera::mounts);
    let fits = |lens: &Lens| match &mounts {
        Some(mounts) => lens.mounts().iter().any(|mount| mounts.contains(&mount)),
        None => !lens.mounts().iter().all(catalogue::is_fixed),
    };
    let asked = Asked::new(shot, text);
    let mut candidates: Vec<(Lens, Likeness)> = catalogue::lenses(&name::numbers(&asked.words))
        .filter(fits)
        .filter_map(|lens| Some((lens, asked.likeness(lens)?)))
        .filter(|(lens, _)| reaches(*lens, shot.focal_length))
        .collect();
    let best = candidates.iter().map(|(_, likeness)| *likeness).min()?;
    candidates
        .retain(|(_, likeness)| (likeness.found, likeness.differences) == (best.found, best.differences));
    candidates.sort_by_key(|(_, likeness)| *likeness);
    Some((one_lens(candidates.into_iter().map(|(lens, _)| lens).collect())?, best.found))
}

/// How a lens's name is like the one asked for, best first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Likeness {
    found: Found,
    /// In how many words that say little it differs.
    differences: usize,
    /// Which of the lens's names it is.
    name: usize,
}

/// A lens as the metadata name it.
struct Asked {
    words: Vec<String>,
    /// The lens's maker, as far as the metadata say.
    maker: Vec<String>,
    camera_maker: Vec<String>,
}

impl Asked {
    fn new(shot: &Shot, text: &str) -> Self {
        let words = name::lens_words(text);
        let sigma = shot.lens_make.is_none() && name::is_sigma(&words);
        let maker = name::brand(if sigma { Some("Sigma") } else { shot.lens_make });
        Self { words, maker, camera_maker: name::brand([shot.camera_make]) }
    }

    fn likeness(&self, lens: Lens) -> Option<Likeness> {
        let brand = name::brand(lens.makers().iter());
        let is_in_name = |word| lens.models().iter().any(|known| name::lens_words(known).contains(word));
        if !self.maker.is_empty() && !self.maker.iter().any(|word| brand.contains(word) || is_in_name(word)) {
            return None;
        }
        let words: Vec<String> = self.words.iter().filter(|word| !brand.contains(word)).cloned().collect();
        // Whose lens it is, is clear; else the name must be the same with the maker's in it.
        let says_maker = words.len() < self.words.len() || !self.maker.is_empty();
        let is_of_maker = says_maker || self.camera_maker.iter().any(|word| brand.contains(word));
        let only_numbers = words.iter().all(|word| name::is_number(word));
        let names = || lens.models().iter().map(name::lens_words).enumerate();
        let by_name = |(name, mut known): (usize, Vec<String>)| {
            known.retain(|word| !(is_of_maker && brand.contains(word)));
            let differences = name::difference(&words, &known, &brand)?;
            Some(Likeness { found: Found::Name, differences, name })
        };
        // Numbers alone name a lens only together with its maker.
        let is_name = !words.is_empty() && (!only_numbers || says_maker);
        let (shortest, longest) = lens.focal_range();
        let is_zoom = words.len() >= 3 && longest > shortest;
        let by_numbers = |(name, known): (usize, Vec<String>)| {
            let same = known.iter().filter(|word| name::is_number(word)).eq(&words);
            same.then_some(Likeness { found: Found::Numbers, differences: 0, name })
        };
        let by_name = is_name.then(|| names().filter_map(by_name).min()).flatten();
        by_name.or_else(|| (only_numbers && is_zoom).then(|| names().find_map(by_numbers)).flatten())
    }
}

/// Whether a lens has such a focal length, in mm.
fn reaches(lens: Lens, focal: f64) -> bool {
    let (shortest, longest) = lens.focal_range();
    let longest = if longest > 0.0 { longest } else { f64::INFINITY };
    focal >= shortest * (1.0 - FOCAL_ROUNDING) && focal <= longest * (1.0 + FOCAL_ROUNDING)
}

/// The lenses, if they are all one and the same, by one of its names, perhaps on different sensors.
fn one_lens(lenses: Vec<Lens>) -> Option<Vec<Lens>> {
    let first = *lenses.first()?;
    let brand = name::brand(first.makers().iter());
    let names: Vec<_> = first.models().iter().map(name::lens_words).collect();
    let same = |lens: &Lens| {
        name::brand(lens.makers().iter()) == brand
            && lens.models().iter().any(|model| names.contains(&name::lens_words(model)))
    };
    lenses.iter().all(same).then_some(lenses)
}

/// What is known of a lens at the settings of a shot: each correction from the smallest sensor it was measured with that
/// covers the one at hand.
fn known(shot: &Shot, lenses: &[Lens], crop: f64) -> Known {
    let mut lenses: Vec<Lens> =
        lenses.iter().copied().filter(|lens| crop >= lens.crop() * SAME_CROP).collect();
    lenses.sort_by(|a, b| b.crop().total_cmp(&a.crop()));
    let measured = |lens: Lens| Measured { crop: lens.crop() / crop, aspect: lens.aspect() };
    let focal = shot.focal_length;
    let distance = shot.distance.filter(|d| d.is_finite() && *d > 0.0).unwrap_or(FAR);
    Known {
        distortion: lenses.iter().find_map(|lens| {
            let [_, a, b, c] = interpolate::at_focal(&lens.distortion(), focal, |_| true)?;
            Some(Distortion { terms: [a, b, c], is_poly5: lens.is_poly5(), measured: measured(*lens) })
        }),
        tca: lenses.iter().find_map(|lens| {
            let constant = |i| matches!(i, 1 | 4);
            let found = interpolate::at_focal(&lens.tca(), focal, |i| !constant(i))?;
            let [_, r0, r1, r2, b0, b1, b2] = found;
            Some(Tca { red: [r0, r1, r2], blue: [b0, b1, b2], measured: measured(*lens) })
        }),
        vignetting: shot.aperture.and_then(|aperture| {
            lenses.iter().find_map(|lens| {
                let rows = lens.vignetting();
                let terms = interpolate::vignetting(&rows, lens.focal_range(), focal, aperture, distance)?;
                Some(Vignetting { terms, measured: measured(*lens) })
            })
        }),
    }
}
