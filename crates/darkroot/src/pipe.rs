//! The second engine: imagepipe, fed with our own decode, for comparison.

use darkroot_develop::Bits;
use darkroot_photo::{Capture, Counts, Layout, Orientation, Picture, PictureSpace, Samples, Size};
use imagepipe::{ImageSource, Pipeline};
use rawloader::{CFA, RawImage, RawImageData};

/// Develops a capture with imagepipe's default pipeline, into sRGB.
///
/// The error is its own message, or what of the capture it cannot express.
pub(crate) fn develop(capture: &Capture, bits: Bits) -> Result<Picture, String> {
    let image = raw_image(capture)?;
    let run = || -> Result<Picture, String> {
        let mut pipeline = Pipeline::new_from_source(ImageSource::Raw(image))?;
        let space = PictureSpace::Rgb(darkroot_colour::RgbSpace::SRGB);
        let picture = if bits == Bits::Eight {
            let out = pipeline.output_8bit(None)?;
            let size = Size { width: out.width, height: out.height };
            Picture { size, samples: Samples::U8(out.data), space }
        } else {
            let out = pipeline.output_16bit(None)?;
            let size = Size { width: out.width, height: out.height };
            Picture { size, samples: Samples::U16(out.data), space }
        };
        Ok(picture)
    };
    std::panic::catch_unwind(std::panic::AssertUnwindSafe(run))
        .unwrap_or_else(|_| Err("it panicked".to_owned()))
}

fn raw_image(capture: &Capture) -> Result<RawImage, String> {
    let Counts::U16(mosaic) = &capture.counts else { return Err("its samples are floating-point".into()) };
    if !capture.mosaic_corrections.is_empty() {
        return Err("it has DNG corrections that imagepipe does not know".into());
    }
    let cfa = match &mosaic.layout {
        Layout::Cfa(cfa) if cfa.is_bayer() || cfa.is_xtrans() => CFA::new(&cfa.to_string().replace('/', "")),
        Layout::Rgb => CFA::new(""),
        _ => return Err("its sensor is neither Bayer nor X-Trans".into()),
    };
    let (size, crop) = (mosaic.size, capture.default_crop);
    let neutral = match capture.as_shot {
        Some(darkroot_photo::AsShot::Neutral(n)) if !capture.balance_applied => n,
        _ => [1.0; 3],
    };
    let green = |values: [f32; 3]| [values[0], values[1], values[2], values[1]];
    let level = |v: f32| v.clamp(0.0, 65535.0).round() as u16;
    let matrix = capture.calibrations.last().map(|c| c.color_matrix);
    let matrix = matrix.unwrap_or_else(darkroot_colour::Matrix3::identity);
    let mut xyz_to_cam = [[0f32; 3]; 4];
    for (r, row) in xyz_to_cam.iter_mut().take(3).enumerate() {
        *row = [0, 1, 2].map(|c| matrix[(r, c)] as f32);
    }
    Ok(RawImage {
        make: capture.camera.make.clone(),
        model: capture.camera.model.clone(),
        clean_make: capture.camera.common_make.clone(),
        clean_model: capture.camera.common_model.clone(),
        width: size.width,
        height: size.height,
        cpp: mosaic.layout.planes(),
        wb_coeffs: green(neutral.map(|n| (1.0 / n) as f32)),
        whitelevels: green(capture.white.0).map(level),
        blacklevels: [level(capture.black.mean()); 4],
        xyz_to_cam,
        cfa,
        crops: [crop.y, size.width - crop.right(), size.height - crop.bottom(), crop.x],
        blackareas: Vec::new(),
        orientation: orientation(capture.orientation),
        data: RawImageData::Integer(mosaic.samples.clone()),
    })
}

fn orientation(o: Orientation) -> rawloader::Orientation {
    use rawloader::Orientation as R;
    match o {
        Orientation::Upright => R::Normal,
        Orientation::MirrorHorizontal => R::HorizontalFlip,
        Orientation::Rotate180 => R::Rotate180,
        Orientation::MirrorVertical => R::VerticalFlip,
        Orientation::Transpose => R::Transpose,
        Orientation::Rotate90 => R::Rotate90,
        Orientation::Transverse => R::Transverse,
        Orientation::Rotate270 => R::Rotate270,
    }
}
