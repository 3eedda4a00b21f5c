//! A raw file as something to measure: light of the sensor, and where it stands in the developed picture.

use std::path::Path;

use darkroot_calibrate::shot::SensorLight;
use darkroot_develop::{CameraMatrix, Frame};
use darkroot_photo::metadata::{Directory, tag};
use darkroot_photo::{AsShot, Camera, Layout, Mosaic, Orientation, Rect, Size};

use super::rendered;
use crate::fault::ChartError;
use crate::{Error, Photo, Settings, files};

/// Longest side of the picture in which charts are looked for.
const LONGEST: usize = 2600;

/// A raw file, decoded.
#[derive(Debug, Clone, PartialEq)]
pub struct View {
    /// The camera.
    pub camera: Camera,
    /// The light of the sensor.
    pub frame: Frame,
    /// The developed picture inside of the frame.
    crop: Rect,
    orientation: Orientation,
    /// Size of the developed picture.
    pub size: Size,
    /// The maker's matrices, where the file has them.
    pub matrix: Option<CameraMatrix>,
    /// Camera RGB of a neutral surface as the camera took it to be, where the file says so.
    pub as_shot: Option<[f64; 3]>,
    /// Exposure time, where the camera tells.
    pub exposure_seconds: Option<f64>,
    /// Day of the shot, YYYY-MM-DD, where the camera tells.
    pub date: Option<String>,
}

impl View {
    /// Decodes a raw file.
    ///
    /// # Errors
    /// A file that cannot be read or decoded.
    pub fn open(path: &Path, settings: &Settings) -> Result<Self, Error> {
        if rendered::is_rendered(path) {
            return Err(Error::chart(path, ChartError::Rendered));
        }
        let bytes = files::read(path)?;
        let photo = Photo::open_with(&bytes, settings.decoder, &settings.limits)
            .map_err(|source| Error::Raw { path: path.to_owned(), source })?;
        Self::of(path, &photo)
    }

    /// A raw file that is decoded already.
    ///
    /// # Errors
    /// A sensor that sees no colours.
    pub(crate) fn of(path: &Path, photo: &Photo) -> Result<Self, Error> {
        let (capture, analysis) = (photo.capture(), photo.analyse_as_asked());
        if matches!(capture.counts.layout(), Layout::Monochrome) {
            return Err(Error::chart(path, ChartError::Monochrome));
        }
        let (active, crop) = (capture.active_area, capture.default_crop);
        let inner = crop.intersection(active).unwrap_or(active);
        let crop = Rect { x: inner.x - active.x, y: inner.y - active.y, ..inner };
        let seconds = capture.metadata.number(Directory::Exif, tag::EXPOSURE_TIME);
        Ok(Self {
            frame: analysis.frame(),
            size: capture.orientation.applied_to(crop.size()),
            matrix: analysis.matrix().cloned(),
            as_shot: match capture.as_shot {
                Some(AsShot::Neutral(neutral)) => Some(neutral),
                _ => None,
            },
            camera: capture.camera.clone(),
            crop,
            orientation: capture.orientation,
            exposure_seconds: seconds.filter(|s| *s > 0.0),
            date: Some(crate::naming::header_of(capture).1).filter(|date| !date.is_empty()),
        })
    }

    /// Any file: a raw file, or a picture that was rendered.
    ///
    /// # Errors
    /// A file that cannot be read or decoded.
    pub fn open_any(path: &Path, settings: &Settings) -> Result<Self, Error> {
        if !rendered::is_rendered(path) {
            return Self::open(path, settings);
        }
        Ok(Self::of_picture(rendered::read(path)?))
    }

    /// A picture that was rendered, as linear light.
    pub(crate) fn of_picture(light: Mosaic<f32>) -> Self {
        let size = light.size;
        let name = |s: &str| s.to_owned();
        Self {
            camera: Camera {
                make: name("rendered"),
                model: name("picture"),
                common_make: name("rendered"),
                common_model: name("picture"),
            },
            frame: Frame { light, saturation: [1.0; 3] },
            crop: Rect::full(size),
            orientation: Orientation::Upright,
            size,
            matrix: None,
            as_shot: None,
            exposure_seconds: None,
            date: None,
        }
    }

    /// Common name of the camera.
    pub(crate) fn camera_name(&self) -> String {
        common_name(&self.camera)
    }

    /// What can be measured.
    pub(crate) fn sensor_light(&self) -> SensorLight<'_> {
        SensorLight { light: &self.frame.light, saturation: self.frame.saturation }
    }

    /// From a place in the developed picture to one in the frame.
    pub fn to_frame(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (right, bottom) = (self.crop.width as f64 - 1.0, self.crop.height as f64 - 1.0);
        let [x, y] = match self.orientation {
            Orientation::Upright => [x, y],
            Orientation::MirrorHorizontal => [right - x, y],
            Orientation::Rotate180 => [right - x, bottom - y],
            Orientation::MirrorVertical => [x, bottom - y],
            Orientation::Transpose => [y, x],
            Orientation::Rotate90 => [y, bottom - x],
            Orientation::Transverse => [right - y, bottom - x],
            Orientation::Rotate270 => [right - y, x],
        };
        [x + self.crop.x as f64, y + self.crop.y as f64]
    }

    /// The developed picture in linear camera RGB, each pixel the mean of `bin` x `bin` samples: width, height and the
    /// three planes.
    pub fn binned(&self, bin: usize) -> (Size, [Vec<f32>; 3]) {
        let stored = Size { width: self.crop.width / bin, height: self.crop.height / bin };
        let upright = self.orientation.applied_to(stored);
        let mut planes = [0, 1, 2].map(|_| vec![0f32; upright.area()]);
        let light = &self.frame.light;
        let samples = light.layout.planes();
        for y in 0..stored.height {
            for x in 0..stored.width {
                let (mut sum, mut count) = ([0f32; 3], [0f32; 3]);
                for row in self.crop.y + y * bin..self.crop.y + (y + 1) * bin {
                    for column in self.crop.x + x * bin..self.crop.x + (x + 1) * bin {
                        let first = (row * light.size.width + column) * samples;
                        let mut take = |c: usize, v: f32| {
                            sum[c] += v;
                            count[c] += 1.0;
                        };
                        match &light.layout {
                            Layout::Cfa(cfa) => {
                                if let Some(c) = cfa.at(column, row).plane() {
                                    take(c, light.samples[first]);
                                }
                            }
                            Layout::Rgb => (0..3).for_each(|c| take(c, light.samples[first + c])),
                            Layout::Monochrome => (0..3).for_each(|c| take(c, light.samples[first])),
                        }
                    }
                }
                let (u, v) = self.orientation.place(x, y, stored);
                for c in 0..3 {
                    planes[c][v * upright.width + u] = sum[c] / count[c].max(1.0);
                }
            }
        }
        (upright, planes)
    }

    /// Side of the bins in which every channel has samples and the picture is not longer than what detection wants.
    pub fn bin(&self) -> usize {
        let least = match &self.frame.light.layout {
            Layout::Cfa(cfa) if cfa.width() % 3 == 0 => 3,
            Layout::Cfa(_) => 2,
            Layout::Rgb | Layout::Monochrome => 1,
        };
        let longest = self.size.width.max(self.size.height);
        (1..=64).map(|k| k * least).find(|bin| longest / bin <= LONGEST).unwrap_or(64)
    }
}

/// Make and model of a camera as people call it.
pub(crate) fn common_name(camera: &Camera) -> String {
    format!("{} {}", camera.common_make, camera.common_model)
}
