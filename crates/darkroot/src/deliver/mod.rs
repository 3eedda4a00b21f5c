//! Finished pictures of a chart, Darkroot's or anyone's: opened through their own colour profile, judged by the chart's
//! reference.

mod edges;
mod even;
mod figures;
mod target;

use std::path::{Path, PathBuf};

use darkroot_calibrate::shot::Chart;
use darkroot_chart::{ChartLayout, Quad, Reference, distortion, patch_noise};
use darkroot_colour::temperature::Temperature;
use darkroot_colour::{Matrix3, Vector3, Xyz, white};
use darkroot_encode::SourceProfile;
use darkroot_encode::source_profile::LINEAR;
use darkroot_photo::{Layout, Mosaic, Size};

pub use darkroot_calibrate::delivery::{
    Bound, Delivery, Details, DynamicRange, Edges, Found, GUIDELINES, Grey, Guideline, Level, Metric, Row,
    Scale, Step, UNLIMITED, Uniformity, Verdict, preset,
};
pub use darkroot_chart::banding::{Banding, Bands};
pub use darkroot_chart::noise::visual::PIXELS_PER_DEGREE;
pub use figures::figures;

use crate::fault::ChartError;
use crate::light::LightSource;
use crate::shot::rendered::{self, is_rendered};
use crate::shot::{View, locate_in};
use crate::{Error, files, provenance};
use target::{Target, pitch_of};

/// Mireds between two lights, or between the white of a picture and D50, from which they are not the same.
const OTHER_LIGHT: f64 = 50.0;

/// How a finished picture is to be judged.
#[derive(Debug, Clone, PartialEq)]
pub struct DeliveryRequest {
    /// The chart.
    pub layout: ChartLayout,
    /// What its patches are.
    pub reference: Reference,
    /// Corners of the chart by hand, in pixels of the picture.
    pub corners: Option<Quad>,
    /// Names of patches to leave out.
    pub exclude: Vec<String>,
    /// A picture of an even surface, delivered in the same way.
    pub flat: Option<PathBuf>,
    /// Millimetres between the middles of two patches side by side, where they are known.
    pub pitch: Option<f64>,
    /// Pixels of the picture in a degree of sight, for visual noise; [`PIXELS_PER_DEGREE`] is usual.
    pub pixels_per_degree: f64,
    /// The light that the chart was taken in, where it is named.
    pub light: Option<LightSource>,
    /// Judge a picture whose light or balance is another all the same.
    pub accept: bool,
}

/// How it is known which light a picture is judged under.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LightFrom {
    /// It was named.
    Named,
    /// The picture says so in its XMP, as reproductions of Darkroot do.
    Picture,
    /// Nothing tells: D50, as the reference has it.
    Assumed,
}

/// A finished picture, judged.
#[derive(Debug, Clone, PartialEq)]
pub struct JudgedPicture {
    /// The file.
    pub path: PathBuf,
    /// Its colour space, as its profile calls it.
    pub space: String,
    /// Whether it has a profile; else it was taken for sRGB.
    pub is_tagged: bool,
    /// Whether its profile has tables.
    pub has_tables: bool,
    /// Bits of a sample.
    pub bits: u16,
    /// Day of the shot, YYYY-MM-DD, where the picture tells.
    pub date: Option<String>,
    /// The light that it was judged under.
    pub light: LightSource,
    /// How that is known.
    pub light_from: LightFrom,
    /// Where the chart is.
    pub corners: Quad,
    /// The parts of the patches that were measured.
    pub windows: Vec<Quad>,
    /// How sure that is, 0..=1.
    pub confidence: f64,
    /// Pixels in a degree of sight, by which visual noise is told.
    pub pixels_per_degree: f64,
    /// The figures.
    pub delivery: Delivery,
    /// Linear light of the brightest grey ([`LINEAR`]), which drift is told by.
    pub white: [f64; 3],
    /// The picture, to look at.
    pub view: View,
}

/// Whether a file is named like a picture that can be judged.
pub fn is_picture(path: &Path) -> bool {
    is_rendered(path)
}

/// Opens a finished picture, finds the chart in it and judges it.
///
/// # Errors
/// A file that cannot be read, a profile that tells no colours, no chart, or a picture of another light than the one named.
pub fn judge(path: &Path, request: &DeliveryRequest) -> Result<JudgedPicture, Error> {
    let of_chart = |fault: ChartError| Error::chart(path, fault);
    let opened = Opened::read(path)?;
    let view = View::of_picture(opened.light);
    let place = locate_in(&view, &request.layout, request.corners.as_ref()).map_err(of_chart)?;
    let chart = Chart::new(&request.layout, &request.reference).map_err(|e| Error::chart(path, e))?;
    let (light, light_from) = light_of(&opened.says, request).map_err(of_chart)?;

    let target = Target::new(&place, &chart, &request.reference).map_err(|e| Error::chart(path, e))?;
    let patches = target.measured(&view.frame.light, &request.exclude).map_err(|e| Error::chart(path, e))?;
    let to_xyz = LINEAR.to_xyz_under(white::D50);
    let luminance = [0, 1, 2].map(|c| to_xyz[(1, c)]);
    let noise = patch_noise(&view.frame.light, &to_xyz, &target.windows, request.pixels_per_degree);
    let even = request.flat.as_deref().map(even::evenness).transpose()?;
    let details = Details {
        edges: edges::edges(&view.frame.light, luminance, &place.patches, &request.layout, &target.edges),
        scale: request.pitch.or_else(|| pitch_of(&request.layout)).map(|pitch| Scale {
            found: pitch_in_pixels(&place.patches, request.layout.columns) / (pitch / 25.4),
            stated: opened.resolution,
        }),
        distortion: distortion::distortion(&view.frame.light, luminance, &place.patches, &request.layout),
        uniformity: even.map(|(uniformity, _)| uniformity),
        banding: even.and_then(|(_, banding)| banding),
    };
    let colour = |rgb: [f64; 3]| xyz(&to_xyz, rgb);
    let mut delivery = darkroot_calibrate::delivery::judge(&patches, &noise, colour, &light, details);
    delivery.notes.extend(chart.notes.iter().cloned());
    check_balance(&delivery, request.accept).map_err(of_chart)?;
    let brightest = delivery.greys.first().map(|grey| grey.name.clone());
    let white = delivery.patches.iter().find(|patch| Some(&patch.name) == brightest.as_ref());
    let white = white.map_or([0.0; 3], |patch| patch.rgb);
    Ok(JudgedPicture {
        path: path.to_owned(),
        space: opened.space,
        is_tagged: opened.is_tagged,
        has_tables: opened.has_tables,
        bits: opened.bits,
        date: opened.date,
        light,
        light_from,
        corners: place.corners,
        windows: target.windows,
        confidence: place.confidence,
        pixels_per_degree: request.pixels_per_degree,
        delivery,
        white,
        view,
    })
}

/// Distance between the middles of neighbours in a row, the mean over the chart.
pub(crate) fn pitch_in_pixels(patches: &[Quad], columns: usize) -> f64 {
    let middle = |quad: &Quad| [0, 1].map(|k| quad.iter().map(|p| p[k]).sum::<f64>() / 4.0);
    let pairs = (0..patches.len().saturating_sub(1)).filter(|i| (i + 1) % columns.max(1) != 0);
    let lengths: Vec<f64> = pairs
        .map(|i| {
            let ([ax, ay], [bx, by]) = (middle(&patches[i]), middle(&patches[i + 1]));
            (bx - ax).hypot(by - ay)
        })
        .collect();
    lengths.iter().sum::<f64>() / lengths.len().max(1) as f64
}

fn xyz(to_xyz: &Matrix3, rgb: [f64; 3]) -> Xyz {
    Xyz::from(to_xyz * Vector3::from(rgb))
}

/// A picture in linear light, and what it says of itself.
pub(crate) struct Opened {
    pub(crate) light: Mosaic<f32>,
    space: String,
    is_tagged: bool,
    has_tables: bool,
    bits: u16,
    date: Option<String>,
    /// Pixels an inch that it states.
    resolution: Option<f64>,
    /// The light that its colours are those of.
    says: Option<LightSource>,
}

impl Opened {
    pub(crate) fn read(path: &Path) -> Result<Self, Error> {
        let of_profile = |fault| Error::chart(path, ChartError::SourceProfile(fault));
        let bytes = files::read(path)?;
        let stated = darkroot_encode::exif::stated(&bytes);
        let encoded = rendered::encoded(path, &bytes)?;
        drop(bytes);
        let profile = match &encoded.icc {
            Some(bytes) => SourceProfile::read(bytes).map_err(of_profile)?,
            None => SourceProfile::srgb(),
        };
        let mut samples = encoded.samples;
        profile.linearise(&mut samples);
        let size: Size = encoded.size;
        Ok(Self {
            light: Mosaic { size, layout: Layout::Rgb, samples },
            space: profile.description().to_owned(),
            is_tagged: encoded.icc.is_some(),
            has_tables: profile.has_tables(),
            bits: encoded.bits,
            date: stated.date.and_then(|text| crate::naming::date(&text)),
            resolution: stated.resolution,
            says: encoded.xmp.as_deref().and_then(provenance::light_in),
        })
    }
}

/// Distance of two lights in mired.
fn apart(one: f64, other: f64) -> f64 {
    (1e6 / one - 1e6 / other).abs()
}

/// The light to judge under: the one that was named, if the picture does not say another, else the one that it says, else
/// that of the reference.
fn light_of(
    says: &Option<LightSource>,
    request: &DeliveryRequest,
) -> Result<(LightSource, LightFrom), ChartError> {
    match (&request.light, says) {
        (Some(named), Some(says))
            if apart(named.light.kelvin(), says.light.kelvin()) > OTHER_LIGHT && !request.accept =>
        {
            let (says, named) = (says.light.name.clone(), named.light.name.clone());
            Err(ChartError::OtherLight { says, named })
        }
        (Some(named), _) => Ok((named.clone(), LightFrom::Named)),
        (None, Some(says)) => Ok((says.clone(), LightFrom::Picture)),
        (None, None) => Ok((LightSource::assumed(), LightFrom::Assumed)),
    }
}

/// Greys that are far from neutral were balanced for another light.
fn check_balance(delivery: &Delivery, accept: bool) -> Result<(), ChartError> {
    // The darkest have too little light to tell.
    let bright = delivery.greys.iter().filter(|grey| grey.found.l > 30.0);
    let sum = bright.fold([0.0; 3], |sum, grey| {
        let Xyz { x, y, z } = grey.found.xyz(white::D50);
        [sum[0] + x, sum[1] + y, sum[2] + z]
    });
    let total: f64 = sum.iter().sum();
    if accept || total.is_nan() || total <= 0.0 {
        return Ok(());
    }
    let kelvin = Temperature::of(darkroot_colour::Xy::new(sum[0] / total, sum[1] / total)).kelvin;
    let d50 = Temperature::of(white::D50_XY).kelvin;
    if apart(kelvin, d50) > OTHER_LIGHT { Err(ChartError::OtherBalance { kelvin }) } else { Ok(()) }
}
