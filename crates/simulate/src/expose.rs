//! Scene x light x camera -> a capture.

use darkroot_colour::Spectrum;
use darkroot_photo::metadata::{Directory, Value, tag};
use darkroot_photo::{
    AsShot, Capture, Counts, Layout, Metadata, Mosaic, Orientation, Rect, Size, Source, WhiteLevel,
};

use crate::exact::exp2;
use crate::{Camera, Scene, chart, random};

/// How a scene is lit and exposed.
#[derive(Debug, Clone, PartialEq)]
pub struct Exposure {
    /// The light, relative power.
    pub light: Spectrum,
    /// Share of saturation at which the largest camera value of the white patch of [`chart`] lands when `stops`
    /// is 0.
    pub white: f64,
    /// Stops more light than that: +1 is twice the light.
    pub stops: f64,
    /// Loss of light in the corners, 0 (none) to 1; it grows with the square of the distance from the centre.
    pub falloff: f64,
    /// Share of the light that the lens spreads evenly over the picture, 0 to 1.
    pub glare: f64,
    /// Standard deviation of the lens's Gaussian blur in pixels; 0 for none.
    pub blur: f64,
    /// Seed of shot noise and read noise; `None` for counts that are only rounded.
    pub noise: Option<u64>,
    /// How the camera is held. The scene stands upright in the developed picture.
    pub orientation: Orientation,
    /// What the camera writes about the shot, besides make, model and orientation.
    pub metadata: Metadata,
}

impl Default for Exposure {
    /// Daylight of 5500 K, white at 0.55 of saturation, no falloff, glare, blur or noise.
    fn default() -> Self {
        Self {
            light: Spectrum::daylight(5500.0),
            white: 0.55,
            stops: 0.0,
            falloff: 0.0,
            glare: 0.0,
            blur: 0.0,
            noise: None,
            orientation: Orientation::Upright,
            metadata: metadata(),
        }
    }
}

/// Shot data of a still life in a studio, at a date that does not change.
pub fn metadata() -> Metadata {
    let mut m = Metadata::default();
    let text = |s: &str| Value::Text(s.to_owned());
    m.set(Directory::Image, tag::SOFTWARE, text("Darkroot simulate"));
    m.set(Directory::Image, tag::DATE_TIME, text("2026:01:01 12:00:00"));
    m.set(Directory::Image, tag::ARTIST, text("Darkroot"));
    m.set(Directory::Image, tag::COPYRIGHT, text("CC0-1.0"));
    m.set(Directory::Exif, tag::EXPOSURE_TIME, Value::Rationals(vec![(1, 60)]));
    m.set(Directory::Exif, tag::F_NUMBER, Value::Rationals(vec![(8, 1)]));
    m.set(Directory::Exif, tag::ISO, Value::Shorts(vec![100]));
    m.set(Directory::Exif, tag::DATE_TIME_ORIGINAL, text("2026:01:01 12:00:00"));
    m.set(Directory::Exif, tag::FOCAL_LENGTH, Value::Rationals(vec![(85, 1)]));
    m.set(
        Directory::Exif,
        tag::LENS_SPECIFICATION,
        Value::Rationals(vec![(85, 1), (85, 1), (18, 10), (18, 10)]),
    );
    m.set(Directory::Exif, tag::LENS_MAKE, text("Darkroot"));
    m.set(Directory::Exif, tag::LENS_MODEL, text("Simulated 85mm f/1.8"));
    m
}

/// The capture that `camera` makes of `scene`.
///
/// Light on the sensor is (1 - glare) x scene (blurred) + glare x mean of the scene, times 1 - falloff x r^2 (r = 1 in the
/// corner); a count is black level + share of saturation x (white level - black level), rounded, at most the white
/// level. Noise has the variance of the electrons counted plus that of reading them.
pub fn expose(scene: &Scene, camera: &Camera, exposure: &Exposure) -> Capture {
    let light = &exposure.light;
    let reference = camera.response(&chart::white(), light).into_iter().fold(0.0, f64::max);
    let gain = exposure.white / reference * exp2(exposure.stops);
    let upright = scene.size();
    let mut picture = scene.seen_by(|r| camera.response(r, light).map(|v| v * gain));
    if exposure.blur > 0.0 {
        picture = blurred(&picture, upright, exposure.blur);
    }
    let lit = exposure.orientation.applied_to(upright);
    let (left, top) = camera.masked;
    let size = Size { width: lit.width + left, height: lit.height + top };
    let active_area = Rect { x: left, y: top, width: lit.width, height: lit.height };
    let optics = Optics::new(exposure, &picture, upright);

    let light_at = |x: usize, y: usize| {
        if x < left || y < top {
            return [0.0; 3];
        }
        let (u, v) = exposure.orientation.place(x - left, y - top, lit);
        optics.through(picture[v * upright.width + u], u, v)
    };
    let samples = counted(camera, size, exposure.noise, light_at);

    let margin = if 4 * camera.crop < lit.width.min(lit.height) { camera.crop } else { 0 };
    let default_crop = Rect {
        x: left + margin,
        y: top + margin,
        width: lit.width - 2 * margin,
        height: lit.height - 2 * margin,
    };
    Capture {
        camera: camera.names(),
        counts: Counts::U16(Mosaic { size, layout: camera.layout.clone(), samples }),
        active_area,
        default_crop,
        user_crop: None,
        orientation: exposure.orientation,
        pixel_aspect: 1.0,
        black: camera.black.clone(),
        white: WhiteLevel([f32::from(camera.white); 3]),
        as_shot: Some(AsShot::Neutral(camera.neutral(light))),
        balance_applied: false,
        rendered: false,
        calibrations: vec![
            camera.calibration(&Spectrum::illuminant_a(), 2856.0),
            camera.calibration(&Spectrum::daylight(6504.0), 6504.0),
        ],
        analog_balance: [1.0; 3],
        baseline_exposure: 0.0,
        mosaic_corrections: Vec::new(),
        noise_profile: Vec::new(),
        picture_corrections: Vec::new(),
        maker_lens: None,
        local_tone: None,
        metadata: exposure.metadata.clone(),
        source: Source {
            format: String::new(),
            compression: String::new(),
            bits: camera.bits,
            decoder: format!("simulate {}", env!("CARGO_PKG_VERSION")),
        },
        notes: Vec::new(),
    }
}

/// The counts of every sample, by the light that falls on it.
fn counted(
    camera: &Camera,
    size: Size,
    noise: Option<u64>,
    light_at: impl Fn(usize, usize) -> [f32; 3],
) -> Vec<u16> {
    let planes = camera.layout.planes();
    let mut samples = Vec::with_capacity(size.area() * planes);
    for y in 0..size.height {
        for x in 0..size.width {
            let seen = light_at(x, y);
            match &camera.layout {
                Layout::Rgb => samples.extend((0..3).map(|c| {
                    let index = (3 * (y * size.width + x) + c) as u64;
                    count(camera, camera.black.at(x, y, c), seen[c], noise, index)
                })),
                layout => {
                    let plane = match layout {
                        Layout::Cfa(cfa) => cfa.at(x, y).plane().unwrap_or(1),
                        _ => 1,
                    };
                    let index = (y * size.width + x) as u64;
                    samples.push(count(camera, camera.black.at(x, y, 0), seen[plane], noise, index));
                }
            }
        }
    }
    samples
}

/// What the lens does to the light.
struct Optics {
    direct: f32,
    veil: [f32; 3],
    falloff: f64,
    size: Size,
}

impl Optics {
    fn new(exposure: &Exposure, picture: &[[f32; 3]], size: Size) -> Self {
        let mean = |c: usize| {
            let sum: f64 = picture.iter().map(|p| f64::from(p[c])).sum();
            sum / picture.len().max(1) as f64
        };
        Self {
            direct: (1.0 - exposure.glare) as f32,
            veil: std::array::from_fn(|c| (exposure.glare * mean(c)) as f32),
            falloff: exposure.falloff,
            size,
        }
    }

    fn through(&self, light: [f32; 3], x: usize, y: usize) -> [f32; 3] {
        let (w, h) = (self.size.width as f64, self.size.height as f64);
        let (dx, dy) = (x as f64 + 0.5 - w / 2.0, y as f64 + 0.5 - h / 2.0);
        let r2 = 4.0 * (dx * dx + dy * dy) / (w * w + h * h);
        let gain = (1.0 - self.falloff * r2) as f32;
        std::array::from_fn(|c| (light[c] * self.direct + self.veil[c]) * gain)
    }
}

/// A picture through a lens that spreads every point as a Gaussian; beyond its edges the picture goes on as it ends.
fn blurred(picture: &[[f32; 3]], size: Size, deviation: f64) -> Vec<[f32; 3]> {
    let reach = (4.0 * deviation).ceil() as isize;
    let weight = |d: isize| exp2(-0.5 * (d as f64 / deviation).powi(2) * std::f64::consts::LOG2_E);
    let sum: f64 = (-reach..=reach).map(weight).sum();
    let weights: Vec<(isize, f32)> = (-reach..=reach).map(|d| (d, (weight(d) / sum) as f32)).collect();
    let along = |picture: &[[f32; 3]], down: bool| -> Vec<[f32; 3]> {
        let at = |i: usize, d: isize| {
            let (x, y) = (i % size.width, i / size.width);
            if down {
                y.saturating_add_signed(d).min(size.height - 1) * size.width + x
            } else {
                y * size.width + x.saturating_add_signed(d).min(size.width - 1)
            }
        };
        let pixel = |i: usize| {
            let mut mean = [0f32; 3];
            for (d, weight) in &weights {
                for (m, v) in mean.iter_mut().zip(picture[at(i, *d)]) {
                    *m += weight * v;
                }
            }
            mean
        };
        (0..picture.len()).map(pixel).collect()
    };
    along(&along(picture, false), true)
}

/// The stored number for `light`, a share of saturation.
fn count(camera: &Camera, black: f32, light: f32, noise: Option<u64>, index: u64) -> u16 {
    let (black, white) = (f64::from(black), f64::from(camera.white));
    let mut electrons = f64::from(light) * camera.full_well;
    if let Some(seed) = noise {
        let deviation = (electrons.max(0.0) + camera.read_noise * camera.read_noise).sqrt();
        electrons += deviation * random::normal(seed, index);
    }
    (black + electrons / camera.full_well * (white - black)).round().clamp(0.0, white) as u16
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::filters;

    const SIZE: Size = Size { width: 24, height: 16 };

    fn samples(capture: &Capture) -> &[u16] {
        match &capture.counts {
            Counts::U16(mosaic) => &mosaic.samples,
            Counts::F32(_) => &[],
        }
    }

    #[test]
    fn twice_the_light_is_twice_the_count() {
        let camera = Camera::simulated_one();
        let scene = Scene::gradient(SIZE);
        let one = expose(&scene, &camera, &Exposure { stops: -1.0, ..Exposure::default() });
        let two = expose(&scene, &camera, &Exposure::default());
        for (&a, &b) in samples(&one).iter().zip(samples(&two)) {
            let (a, b) = (f64::from(a) - 512.0, f64::from(b) - 512.0);
            assert!((b - 2.0 * a).abs() <= 1.5, "{a} {b}");
        }
    }

    #[test]
    fn an_empty_picture_is_a_file_without_samples() {
        let scene = Scene::still_life(Size { width: 0, height: 0 });
        let capture = expose(&scene, &Camera::nikon_d750(), &Exposure::default());
        assert!(samples(&capture).is_empty());
        assert!(!crate::dng::write(&capture, crate::dng::Storage::JpegTiles).is_empty());
        assert!(crate::nef::write(&capture, crate::nef::Storage::Lossless).is_some());
    }

    #[test]
    fn the_white_patch_lands_where_it_is_asked_to() {
        let camera = Camera::simulated_one();
        let scene = Scene::flat(SIZE, chart::white());
        let capture = expose(&scene, &camera, &Exposure { white: 0.5, ..Exposure::default() });
        let largest = samples(&capture).iter().copied().max().unwrap();
        assert_eq!(largest, 512 + (15_892 - 512) / 2);
    }

    #[test]
    fn noise_has_the_variance_of_its_electrons() {
        let size = Size { width: 200, height: 200 };
        let camera = Camera { layout: filters("GGGG"), ..Camera::simulated_one() };
        let exposure = Exposure { noise: Some(1), ..Exposure::default() };
        let capture = expose(&Scene::flat(size, chart::white()), &camera, &exposure);
        let to_electrons = camera.full_well / (15_892.0 - 512.0);
        let electrons: Vec<f64> =
            samples(&capture).iter().map(|&s| (f64::from(s) - 512.0) * to_electrons).collect();
        let mean = electrons.iter().sum::<f64>() / electrons.len() as f64;
        let variance =
            electrons.iter().map(|e| (e - mean) * (e - mean)).sum::<f64>() / electrons.len() as f64;
        assert!((variance / (mean + 25.0) - 1.0).abs() < 0.03, "{variance} {mean}");
    }

    #[test]
    fn masked_pixels_see_no_light() {
        let camera = Camera { masked: (4, 2), ..Camera::simulated_one() };
        let capture = expose(&Scene::gradient(SIZE), &camera, &Exposure::default());
        assert_eq!(capture.counts.size(), Size { width: 28, height: 18 });
        let samples = samples(&capture);
        assert!(samples[..2 * 28].iter().all(|&s| s == 512));
        assert!(samples.chunks(28).all(|row| row[..4].iter().all(|&s| s == 512)));
        assert!(samples[2 * 28 + 4] > 512);
    }

    #[test]
    fn a_camera_held_upright_stores_the_scene_turned() {
        let camera = Camera { layout: Layout::Rgb, ..Camera::simulated_one() };
        let scene = Scene::gradient(SIZE);
        let held = Exposure { orientation: Orientation::Rotate90, ..Exposure::default() };
        let turned = expose(&scene, &camera, &held);
        let straight = expose(&scene, &camera, &Exposure::default());
        let stored = turned.counts.size();
        assert_eq!(stored, Size { width: SIZE.height, height: SIZE.width });
        let (x, y) = Orientation::Rotate90.place(3, 5, stored);
        let (a, b) = (3 * (5 * stored.width + 3), 3 * (y * SIZE.width + x));
        assert_eq!(samples(&turned)[a..a + 3], samples(&straight)[b..b + 3]);
    }
}
