//! What a shot of a chart tells of a photograph in the same light: exposure, black and white balance.

use std::path::{Path, PathBuf};

use darkroot_calibrate::shot::{Chart, Companions};
use darkroot_calibrate::{MeasuredPatch, white_of, white_under};
use darkroot_chart::{ChartLayout, Rejected};
use darkroot_colour::white;
use darkroot_develop::{Balance, Plan};
use darkroot_photo::metadata::{Directory, tag};
use darkroot_photo::{Camera, Capture};

use crate::charts::NamedReference;
use crate::deliver::pitch_in_pixels;
use crate::fault::ChartError;
use crate::light::LightSource;
use crate::photo::Photo;
use crate::settings::{ChartShot, FromChart, Settings};
use crate::shot::{self, Correct, Shot, ShotOptions, View, common_name};
use crate::{Error, charts, files, find_chart, shown};

/// Stops between the exposures of two shots from which a person is told.
const OTHER_EXPOSURE: f64 = 0.05;

/// What a shot of a chart tells.
#[derive(Debug, Clone, PartialEq)]
pub struct Told {
    /// The shot.
    pub(crate) path: PathBuf,
    /// SHA-256 of its file; empty where it is the photograph itself.
    pub(crate) sha256: String,
    /// Title of the chart.
    pub(crate) chart: String,
    /// Its reference: name, and hash of the file where it is one.
    pub(crate) reference: (String, String),
    /// Name of the white patch.
    patch: String,
    /// L* of that by the reference.
    pub(crate) lightness: f64,
    /// Y of that, 1 for a perfect white.
    luminance: f64,
    /// Camera RGB of it, 1 = the white level, less the veil.
    white: [f64; 3],
    /// Camera RGB of the light's white, through the greys.
    neutral: [f64; 3],
    /// Camera RGB where no light comes from, where that is to be taken off.
    pub(crate) veil: [f64; 3],
    patches: Vec<MeasuredPatch>,
    /// Pixels between the middles of two patches.
    pitch: f64,
    camera: Camera,
    /// Light that the settings of the camera let in, relative.
    exposure: Option<f64>,
}

/// What the settings' own shot of a chart tells; `None` where there is none, or it is the photograph itself.
///
/// # Errors
/// A file that cannot be read, shows no chart, or a shot that is not good enough.
pub(crate) fn of_file(settings: &Settings) -> Result<Option<Told>, Error> {
    let ChartShot::File(path) = &settings.chart.shot else { return Ok(None) };
    let bytes = files::read(path)?;
    let photo = Photo::open_with(&bytes, settings.decoder, &settings.limits)
        .map_err(|source| Error::Raw { path: path.clone(), source })?;
    let told = of_photo(path, &photo, &settings.chart)?;
    Ok(Some(Told { sha256: files::sha256(&bytes), ..told }))
}

/// What the chart in a photograph tells.
///
/// # Errors
/// No chart in it, or one that cannot be measured.
pub(crate) fn of_photo(path: &Path, photo: &Photo, asked: &FromChart) -> Result<Told, Error> {
    let view = View::of(path, photo)?;
    let Measured { shot, chart, reference, pitch } = measured(path, &view, asked)?;
    let of_chart = |fault| Error::chart(path, fault);
    let usable = shot.patches.iter().zip(&shot.measurements).filter(|(patch, _)| patch.excluded.is_none());
    let luminance = |patch: &MeasuredPatch| patch.reference.xyz_d50().y;
    let brightest = usable.max_by(|(a, _), (b, _)| luminance(a).total_cmp(&luminance(b)));
    let (patch, measurement) = brightest.ok_or_else(|| of_chart(ChartError::DarkGreys))?;
    let neutral = white_of(&shot.patches).map_err(|_| of_chart(ChartError::DarkGreys))?;
    if neutral.iter().chain(&patch.rgb).any(|v| *v <= 0.0) {
        return Err(of_chart(ChartError::DarkGreys));
    }
    Ok(Told {
        path: path.to_owned(),
        sha256: String::new(),
        chart,
        reference: (reference.name, reference.sha256),
        patch: patch.name.clone(),
        lightness: patch.reference.xyz_d50().lab(white::D50).l,
        luminance: luminance(patch),
        white: patch.rgb,
        neutral,
        // The slope of light is left in, so what is missing of a patch is the veil.
        veil: [0, 1, 2].map(|c| measurement.mean[c] - patch.rgb[c]),
        camera: shot.camera,
        patches: shot.patches,
        pitch,
        exposure: exposure_of(photo.capture()),
    })
}

/// A chart that was found and measured.
struct Measured {
    shot: Shot,
    /// Its title.
    chart: String,
    reference: NamedReference,
    /// Pixels between the middles of two patches.
    pitch: f64,
}

fn measured(path: &Path, view: &View, asked: &FromChart) -> Result<Measured, Error> {
    let layouts: Vec<ChartLayout> = match &asked.layout {
        Some(name) => vec![charts::layout(name)?],
        None => charts::layouts().into_iter().filter(|l| charts::reference(None, l).is_ok()).collect(),
    };
    let search = find_chart::search(view, &layouts);
    let found =
        search.found.first().and_then(|f| layouts.iter().find(|l| l.name == f.layout).map(|l| (f, l)));
    let Some((found, layout)) = found else {
        let reason = search.rejected.map(|Rejected { reason, .. }| reason);
        let chart =
            layouts.first().filter(|_| layouts.len() == 1).map_or("chart".to_owned(), |l| l.title.clone());
        return Err(Error::chart(path, ChartError::NotFound { chart, reason }));
    };
    let reference = charts::reference(asked.reference.as_deref(), layout)?;
    let chart = Chart::new(layout, &reference.colours).map_err(|e| Error::chart(path, e))?;
    let options = ShotOptions {
        correct_glare: if asked.black { Correct::Always } else { Correct::Never },
        even_out: Correct::Never,
        ..ShotOptions::default()
    };
    let place = find_chart::place(found);
    let shot = shot::measured(path, view, place, &chart, Companions::default(), &options)?;
    let pitch = pitch_in_pixels(&shot.windows, layout.columns);
    Ok(Measured { shot, chart: layout.title.clone(), reference, pitch })
}

/// Light that time, aperture and sensitivity let in, relative.
fn exposure_of(capture: &Capture) -> Option<f64> {
    let number = |tag| capture.metadata.number(Directory::Exif, tag).filter(|v| *v > 0.0);
    let aperture = number(tag::F_NUMBER)?;
    Some(number(tag::EXPOSURE_TIME)? * number(tag::ISO)? / (aperture * aperture))
}

impl Told {
    /// Whole pixels an inch, where patches are so many millimetres apart.
    pub(crate) fn dpi(&self, millimetres: f64) -> u32 {
        (self.pitch / (millimetres / 25.4)).round().clamp(1.0, 1e6) as u32
    }

    /// White-balance multipliers by the greys, as they are in a light; as under D50 where that is not known.
    pub(crate) fn balance(&self, light: Option<&LightSource>) -> Balance {
        let under = light.and_then(|light| white_under(&self.patches, light).ok());
        let neutral = under.unwrap_or(self.neutral);
        Balance::Multipliers(neutral.map(|v| neutral[1] / v))
    }

    /// Whether a photograph may be exposed by this shot.
    ///
    /// # Errors
    /// It was taken with another camera.
    pub(crate) fn check(&self, input: &Path, capture: &Capture) -> Result<(), Error> {
        if capture.camera == self.camera {
            return Ok(());
        }
        let (camera, of) = (common_name(&capture.camera), common_name(&self.camera));
        Err(Error::chart(input, ChartError::CompanionCamera { camera, of }))
    }

    /// Exposes a plan so that the white patch gets the lightness of its reference, `stops` on top, and takes the veil off.
    /// What was done is said in words.
    pub(crate) fn expose(&self, plan: &mut Plan, stops: f64, capture: &Capture) -> Vec<String> {
        let mut notes = Vec::new();
        let Some(found) = plan.colour_of(self.white).filter(|found| found.y > 0.0) else { return notes };
        plan.gain = (2f64.powf(stops) * self.luminance / found.y) as f32;
        notes.push(format!(
            "the exposure is that of {} in {} ({}, L* {:.2}): x {:.3} ({:+.2} stops)",
            self.patch,
            file_name(&self.path),
            self.chart,
            self.lightness,
            plan.gain,
            plan.gain.log2()
        ));
        if self.veil.iter().any(|v| v.abs() > 0.0) {
            plan.veil = [0, 1, 2].map(|c| self.veil[c] as f32 * plan.multipliers()[c]);
            let [r, g, b] = [0, 1, 2].map(|c| 100.0 * self.veil[c] / self.neutral[c]);
            notes.push(format!("stray light was taken off as the chart shows it: {r:.2} % of white in red, {g:.2} % in green, {b:.2} % in blue"));
        }
        if let (Some(here), Some(there)) = (exposure_of(capture), self.exposure) {
            let apart = (here / there).log2();
            if apart.abs() > OTHER_EXPOSURE {
                notes.push(format!(
                    "the photograph was exposed by {apart:+.2} stops from {}, and is so much lighter or darker than its \
                     original: take both at one exposure",
                    file_name(&self.path)
                ));
            }
        }
        notes
    }
}

/// The name of a file without its folder, for people.
pub(crate) fn file_name(path: &Path) -> String {
    shown(Path::new(path.file_name().unwrap_or(path.as_os_str())))
}
