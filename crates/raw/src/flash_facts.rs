//! Facts about a file in flashraw's types to the same in ours.

use darkroot_colour::{Matrix3, Xy};
use darkroot_photo::{AsShot, BlackLevel, Calibration, Camera, Cfa, Filter, Layout, Rect, Size, WhiteLevel};
use flashraw::{
    BlackLevel as FlashBlack, CfaColor, CfaPattern, ColorMatrices, ColorMatrix, FrameInfo, RawMetadata,
    SensorLayout,
};

use crate::{Damage, Error, Unknown};

pub(crate) fn camera(meta: &RawMetadata) -> Camera {
    let common = |canonical: &str, written: &str| {
        let name = if canonical.trim().is_empty() { written } else { canonical };
        name.trim().to_owned()
    };
    let make = common(&meta.canonical_make, &meta.make);
    let model = common(&meta.canonical_model, &meta.model);
    // Some cameras repeat the maker in the model.
    let common_model = match model.split_once(' ') {
        Some((first, rest)) if !make.is_empty() && first.eq_ignore_ascii_case(&make) => rest.to_owned(),
        _ => model,
    };
    Camera {
        make: meta.make.trim().to_owned(),
        model: meta.model.trim().to_owned(),
        common_make: make,
        common_model,
    }
}

pub(crate) fn layout(info: &FrameInfo) -> Result<Layout, Error> {
    match (info.cpp, &info.cfa) {
        (1, Some(cfa)) => Ok(Layout::Cfa(filters(cfa)?)),
        (1, None) => Ok(Layout::Monochrome),
        (3, _) => Ok(Layout::Rgb),
        (samples, _) => Err(Error::Camera {
            camera: "this camera".into(),
            reason: Unknown::Samples { samples, layout: format!("{:?}", info.layout) },
            decoder: "flashraw",
        }),
    }
}

pub(crate) fn filters(cfa: &CfaPattern) -> Result<Cfa, Error> {
    let filters = cfa
        .colors()
        .into_iter()
        .map(|c| match c {
            CfaColor::Red => Filter::Red,
            CfaColor::Green => Filter::Green,
            CfaColor::Blue => Filter::Blue,
            other => Filter::Other(other.letter()),
        })
        .collect();
    Cfa::new(cfa.width(), filters).ok_or(Error::DecoderFailed { decoder: "flashraw" })
}

pub(crate) fn rect(r: flashraw::Rect, size: Size) -> Rect {
    let r = Rect { x: r.x as usize, y: r.y as usize, width: r.width as usize, height: r.height as usize };
    r.intersection(Rect::full(size)).unwrap_or(Rect::full(size))
}

/// Width of a pixel over its height, from DNG DefaultScale where there is one. Linear pictures keep theirs.
pub(crate) fn pixel_aspect(meta: &RawMetadata, info: &FrameInfo) -> f64 {
    let scale = meta.dng.as_ref().and_then(|d| d.default_scale);
    let aspect = scale.map_or(f64::from(info.pixel_aspect), |(h, v)| h / v);
    if aspect.is_finite() && (0.25..=4.0).contains(&aspect) { aspect } else { 1.0 }
}

pub(crate) fn black_level(black: &FlashBlack) -> Result<BlackLevel, Error> {
    let (rows, columns) = (usize::from(black.rows.max(1)), usize::from(black.cols.max(1)));
    let planes = usize::from(black.samples.max(1));
    let finite = black.values.iter().chain(&black.row_deltas).chain(&black.col_deltas).all(|v| v.is_finite());
    if !finite {
        return Err(Damage::BlackLevel.into());
    }
    let mut values = black.values.clone();
    values.resize(rows * columns * planes, values.last().copied().unwrap_or(0.0));
    Ok(BlackLevel {
        columns,
        rows,
        planes,
        values,
        row_deltas: black.row_deltas.clone(),
        column_deltas: black.col_deltas.clone(),
    })
}

/// White level for red, green and blue; monochrome has one for all.
pub(crate) fn white_level(info: &FrameInfo, layout: &Layout) -> WhiteLevel {
    let plane = |i: usize| if *layout == Layout::Monochrome { 0 } else { i };
    WhiteLevel([0, 1, 2].map(|i| info.white_level.at(plane(i)) as f32))
}

pub(crate) fn as_shot(meta: &RawMetadata, info: &FrameInfo) -> Option<AsShot> {
    let usable = |n: [f64; 3]| n.iter().all(|&v| v.is_finite() && v > 1e-4 && v < 1e4).then_some(n);
    let dng = meta.dng.as_ref();
    let neutral = dng.and_then(|d| d.as_shot_neutral.as_deref()).and_then(|n| <[f64; 3]>::try_from(n).ok());
    if let Some(neutral) = neutral.and_then(usable) {
        return Some(AsShot::Neutral(neutral));
    }
    if let Some((x, y)) = dng.and_then(|d| d.as_shot_white_xy)
        && x > 0.0
        && y > 0.0
        && x + y < 1.0
    {
        return Some(AsShot::White(Xy::new(x, y)));
    }
    let [r, g, b, _] = info.white_balance?.coeffs.map(f64::from);
    usable([1.0 / r, 1.0 / g, 1.0 / b]).map(AsShot::Neutral)
}

/// The calibrations and the analog balance of three-colour sensors.
pub(crate) fn calibrations(matrices: &ColorMatrices) -> (Vec<Calibration>, [f64; 3]) {
    let paired = |list: &[ColorMatrix], i: usize, of: &ColorMatrix| {
        let by_light = list.iter().find(|m| m.illuminant == of.illuminant && m.illuminant.0 != 0);
        by_light.or_else(|| list.get(i).filter(|_| list.len() == matrices.color.len())).and_then(matrix)
    };
    let calibrations = matrices
        .color
        .iter()
        .enumerate()
        .filter_map(|(i, m)| {
            Some(Calibration {
                kelvin: m.illuminant.temperature().map(f64::from),
                color_matrix: matrix(m).filter(|m| m.try_inverse().is_some())?,
                forward_matrix: paired(&matrices.forward, i, m).filter(|m| m.try_inverse().is_some()),
                camera_calibration: paired(&matrices.calibration, i, m).filter(|m| m.try_inverse().is_some()),
            })
        })
        .collect();
    let analog = match matrices.analog_balance[..] {
        [r, g, b] if [r, g, b].iter().all(|&v| v.is_finite() && v > 0.0) => [r, g, b].map(f64::from),
        _ => [1.0; 3],
    };
    (calibrations, analog)
}

/// Pairs of DNG NoiseProfile, as many as are whole.
pub(crate) fn noise_profile(meta: &RawMetadata) -> Vec<[f64; 2]> {
    let numbers = meta.dng.as_ref().and_then(|d| d.noise_profile.as_deref()).unwrap_or_default();
    numbers.as_chunks().0.to_vec()
}

pub(crate) fn matrix(m: &ColorMatrix) -> Option<Matrix3> {
    (m.rows == 3 && m.values.len() == 9 && m.values.iter().all(|v| v.is_finite()))
        .then(|| Matrix3::from_row_iterator(m.values.iter().map(|&v| f64::from(v))))
}

/// The compression in words.
pub(crate) fn compression_name(info: &FrameInfo) -> String {
    use flashraw::Compression as C;
    match info.compression {
        C::Uncompressed => "uncompressed".into(),
        C::LosslessJpeg => "lossless JPEG".into(),
        C::LossyJpeg => "lossy JPEG".into(),
        C::Deflate => "deflate".into(),
        C::JpegXl => "JPEG XL".into(),
        C::NikonHuffman => "Nikon Huffman".into(),
        C::NikonHighEfficiency => "Nikon High Efficiency".into(),
        other => format!("{other:?}"),
    }
    .to_owned()
        + match info.layout {
            SensorLayout::Foveon => ", Foveon layers",
            _ => "",
        }
}
