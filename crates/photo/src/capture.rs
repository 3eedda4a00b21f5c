//! A decoded raw file: everything known about one exposure.

use std::sync::Arc;

use darkroot_colour::{Matrix3, Xy};
use serde::{Deserialize, Serialize};

use crate::{
    BlackLevel, Correction, Counts, LocalToneMap, MakerLens, Metadata, Orientation, Rect, WhiteLevel,
};

/// Which camera took the picture.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Camera {
    /// Maker as written in the file; may be empty.
    pub make: String,
    /// Model as written in the file; may be empty.
    pub model: String,
    /// The maker's common name ("Nikon" for "NIKON CORPORATION").
    pub common_make: String,
    /// The model's common name, without the maker ("D700" for "NIKON D700").
    pub common_model: String,
}

impl Camera {
    /// Common name of the camera, "Nikon D700"; "an unknown camera" when the file does not say.
    pub fn name(&self) -> String {
        match (self.common_make.is_empty(), self.common_model.is_empty()) {
            (true, true) => "an unknown camera".to_owned(),
            (true, false) => self.common_model.clone(),
            (false, true) => self.common_make.clone(),
            (false, false) => format!("{} {}", self.common_make, self.common_model),
        }
    }
}

/// What the file says of the white of the light.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum AsShot {
    /// Camera RGB of a neutral surface, largest value not more than 1 by custom (DNG AsShotNeutral; the
    /// reciprocal of multipliers).
    Neutral([f64; 3]),
    /// Chromaticity of the white (DNG AsShotWhiteXY).
    White(Xy),
}

/// The maker's colour calibration for one light.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Calibration {
    /// Correlated colour temperature of the light, K; `None` when the file names no light.
    pub kelvin: Option<f64>,
    /// XYZ to camera RGB (DNG ColorMatrix).
    pub color_matrix: Matrix3,
    /// Balanced camera RGB to XYZ under D50 (DNG ForwardMatrix).
    pub forward_matrix: Option<Matrix3>,
    /// Reference camera RGB to that of this specimen (DNG CameraCalibration).
    pub camera_calibration: Option<Matrix3>,
}

/// How the file was stored and who decoded it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Source {
    /// Container, "NEF", "DNG", ...
    pub format: String,
    /// Compression in words.
    pub compression: String,
    /// Bits a stored sample.
    pub bits: u8,
    /// Decoder that was used, with its version.
    pub decoder: String,
}

/// One exposure as decoded. Rectangles and black levels count from the first stored sample.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Capture {
    /// The camera.
    pub camera: Camera,
    /// The samples.
    pub counts: Counts,
    /// Where light falls on the sensor.
    pub active_area: Rect,
    /// What the maker shows, inside the active area.
    pub default_crop: Rect,
    /// The part of that which was chosen, in the camera or by who edited the file (DNG DefaultUserCrop, or a maker's note);
    /// `None` for all of it.
    pub user_crop: Option<Rect>,
    /// How to turn the picture upright.
    pub orientation: Orientation,
    /// Width of a pixel over its height; 1 for nearly every camera.
    pub pixel_aspect: f64,
    /// Stored value of no light.
    pub black: BlackLevel,
    /// Stored value of saturation.
    pub white: WhiteLevel,
    /// White of the light; `None` when the file does not say.
    pub as_shot: Option<AsShot>,
    /// Whether the stored samples are white-balanced already.
    pub balance_applied: bool,
    /// Whether the samples are no light of the scene but what the camera rendered for display (its embedded JPEG), made
    /// linear again.
    pub rendered: bool,
    /// The maker's matrices, none, one or several.
    pub calibrations: Vec<Calibration>,
    /// Gains that the camera applied before storing (DNG AnalogBalance).
    pub analog_balance: [f64; 3],
    /// Stops by which the maker brightens the picture (DNG BaselineExposure).
    pub baseline_exposure: f64,
    /// Variance of noise as the maker knows it (DNG NoiseProfile): factor of the linear light and constant, for all
    /// channels or for each; empty where the file does not say.
    pub noise_profile: Vec<[f64; 2]>,
    /// Corrections on linear samples before demosaicing (DNG OpcodeList2).
    pub mosaic_corrections: Vec<Correction>,
    /// Corrections on demosaiced camera RGB (DNG OpcodeList3).
    pub picture_corrections: Vec<Correction>,
    /// What the maker's note says of the lens; `None` where it says nothing that is understood.
    pub maker_lens: Option<MakerLens>,
    /// What the maker's rendering does to each part of the picture; `None` where the file does not say.
    pub local_tone: Option<Arc<LocalToneMap>>,
    /// What the camera wrote about the shot.
    pub metadata: Metadata,
    /// How the file was stored.
    pub source: Source,
    /// What had to be assumed or left out, in words. Nothing is guessed in silence.
    pub notes: Vec<String>,
}

impl Capture {
    /// What is shown where nobody asks for another part.
    pub fn shown(&self) -> Rect {
        self.user_crop.unwrap_or(self.default_crop)
    }

    /// Whether its parts fit together: counts, rectangles in the frame, black levels. Of what comes from another process that is not to be taken for granted.
    pub fn is_sound(&self) -> bool {
        let within = |inner: Rect, outer: Rect| inner.intersection(outer) == Some(inner);
        let whole = Rect::full(self.counts.size());
        let black = &self.black;
        let block = black.columns.checked_mul(black.rows).and_then(|block| block.checked_mul(black.planes));
        self.counts.is_sound()
            && within(self.active_area, whole)
            && within(self.default_crop, self.active_area)
            && self.user_crop.is_none_or(|crop| within(crop, self.default_crop))
            && block.is_some_and(|block| block > 0 && block == black.values.len())
            && self.mosaic_corrections.iter().chain(&self.picture_corrections).all(Correction::is_sound)
            && self.maker_lens.as_ref().is_none_or(MakerLens::is_sound)
            && self.local_tone.as_ref().is_none_or(|map| map.is_sound())
    }

    /// A capture of which nothing is known but its samples: all of the frame is shown as it stands, black is 0 and white
    /// 1, and no matrix, light or metadata is there.
    pub fn bare(counts: Counts) -> Self {
        let frame = Rect::full(counts.size());
        let bits = if matches!(counts, Counts::U16(_)) { 16 } else { 32 };
        let nothing = String::new;
        Self {
            camera: Camera::default(),
            counts,
            active_area: frame,
            default_crop: frame,
            user_crop: None,
            orientation: Orientation::Upright,
            pixel_aspect: 1.0,
            black: BlackLevel::uniform(0.0),
            white: WhiteLevel([1.0; 3]),
            as_shot: None,
            balance_applied: false,
            rendered: false,
            calibrations: Vec::new(),
            analog_balance: [1.0; 3],
            baseline_exposure: 0.0,
            noise_profile: Vec::new(),
            mosaic_corrections: Vec::new(),
            picture_corrections: Vec::new(),
            maker_lens: None,
            local_tone: None,
            metadata: Metadata::default(),
            source: Source { format: nothing(), compression: nothing(), bits, decoder: nothing() },
            notes: Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::correction::{Area, GainMap};
    use crate::{Layout, MakerLens, Mosaic, Radial, Size};

    #[test]
    fn parts_that_do_not_fit_together_are_seen() {
        let size = Size { width: 4, height: 2 };
        let counts = Counts::U16(Mosaic { size, layout: Layout::Monochrome, samples: vec![0; 8] });
        let sound = Capture::bare(counts);
        assert!(sound.is_sound());
        let unsound = |change: fn(&mut Capture)| {
            let mut capture = sound.clone();
            change(&mut capture);
            !capture.is_sound()
        };
        let area = |pitch: usize| Area {
            rect: Rect { x: 0, y: 0, width: 4, height: 2 },
            plane: 0,
            planes: 1,
            row_pitch: 1,
            column_pitch: pitch,
        };
        assert!(unsound(|c| c.active_area.width = 5));
        assert!(unsound(|c| c.black.values.clear()));
        assert!(unsound(|c| match &mut c.counts {
            Counts::U16(mosaic) => mosaic.samples.truncate(7),
            Counts::F32(mosaic) => mosaic.samples.truncate(7),
        }));
        let with =
            |correction: Correction| Capture { picture_corrections: vec![correction], ..sound.clone() };
        let map = |gains: usize| GainMap {
            rows: 2,
            columns: 2,
            planes: 1,
            vertical: (0.0, 1.0),
            horizontal: (0.0, 1.0),
            gains: vec![1.0; gains],
        };
        assert!(with(Correction::Gain(area(1), map(4))).is_sound());
        assert!(!with(Correction::Gain(area(1), map(3))).is_sound());
        assert!(!with(Correction::Polynomial(area(0), vec![1.0])).is_sound());
        let short: Radial = serde_json::from_str(r#"{"values":[1.0]}"#).unwrap();
        let flat = || Radial::of(|_| 1.0);
        let lens = |third: Radial| MakerLens {
            maker: "Sony".into(),
            places: [flat(), flat(), third],
            gain: None,
            left: None,
        };
        let with = |lens: MakerLens| Capture { maker_lens: Some(lens), ..sound.clone() };
        assert!(with(lens(flat())).is_sound() && !with(lens(short)).is_sound());
    }
}
