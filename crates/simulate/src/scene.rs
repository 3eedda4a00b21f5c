//! What each pixel shows: light and shade times a mixture of reflectances.

use darkroot_colour::{Lab, Spectrum, Xyz};
use darkroot_photo::{Rect, Size};

use crate::chart_scene::{ChartScene, FRAME_REFLECTANCE, WALL_REFLECTANCE};
use crate::exact::exp2;
use crate::reflectance::of_lab;
use crate::still_life::{self, StillLife};

/// Bands that are rendered at the same time.
const BANDS: usize = 8;

/// A picture of reflectances, upright. Under any light a perfect diffuser that stands upright towards the camera
/// has the light's white with Y = 1.
#[derive(Debug, Clone)]
pub struct Scene {
    size: Size,
    materials: Vec<Spectrum>,
    motif: Motif,
    patches: Vec<Patch>,
}

/// A patch of one reflectance whose place is known.
#[derive(Debug, Clone, PartialEq)]
pub struct Patch {
    /// What it is called.
    pub name: &'static str,
    /// Its corners in pixels from the top left corner of the picture, clockwise from its own top left.
    pub corners: [(f64, f64); 4],
    /// Its reflectance, evenly lit: the XYZ of a pixel well inside it are `reflectance.reflected_xyz(&light)`.
    pub reflectance: Spectrum,
}

impl Patch {
    /// Its colour under `light`; Y = 1 is a perfect diffuser.
    pub fn xyz(&self, light: &Spectrum) -> Xyz {
        self.reflectance.reflected_xyz(light)
    }

    /// The pixels well inside it: the middle `share` (0 to 1) of its width and height, rounded inwards. `None` when
    /// that is less than a pixel.
    pub fn inside(&self, share: f64) -> Option<Rect> {
        let [(left, top), _, (right, bottom), _] = self.corners;
        let shrink = (1.0 - share) / 2.0;
        let (dx, dy) = (shrink * (right - left), shrink * (bottom - top));
        let (x0, x1) = ((left + dx).ceil().max(0.0) as usize, (right - dx).floor().max(0.0) as usize);
        let (y0, y1) = ((top + dy).ceil().max(0.0) as usize, (bottom - dy).floor().max(0.0) as usize);
        (x1 > x0 && y1 > y0).then(|| Rect { x: x0, y: y0, width: x1 - x0, height: y1 - y0 })
    }
}

#[derive(Debug, Clone)]
enum Motif {
    Flat,
    Ramp { from: f64, to: f64 },
    Gradient,
    Chart(ChartScene),
    StillLife(StillLife),
}

impl Scene {
    /// Fruit in a bowl, a vase and a steel ball on an oak table, with a 24-patch chart, a grey card and a resolution
    /// target that reaches half a cycle per pixel; made for 3:2 and 4:3. The reflection of the window in the ball is
    /// about ten times as bright as white, so that it clips.
    pub fn still_life(size: Size) -> Self {
        let motif = StillLife::new(size);
        let materials = still_life::materials();
        let patches = motif.patches(&materials);
        Self { size, materials, motif: Motif::StillLife(motif), patches }
    }

    /// One reflectance everywhere.
    pub fn flat(size: Size, reflectance: Spectrum) -> Self {
        Self { size, materials: vec![reflectance], motif: Motif::Flat, patches: Vec::new() }
    }

    /// One reflectance, lit from `from` stops in the first column evenly to `to` stops in the last.
    pub fn ramp(size: Size, reflectance: Spectrum, from: f64, to: f64) -> Self {
        Self { motif: Motif::Ramp { from, to }, ..Self::flat(size, reflectance) }
    }

    /// Four colours in the corners (red and yellow above, blue and green below), mixed between.
    pub fn gradient(size: Size) -> Self {
        let corners = [(50.0, 60.0, 35.0), (85.0, 0.0, 75.0), (35.0, 15.0, -50.0), (55.0, -45.0, 35.0)];
        let materials = corners.map(|(l, a, b)| of_lab(Lab { l, a, b })).to_vec();
        Self { size, materials, motif: Motif::Gradient, patches: Vec::new() }
    }

    /// A chart with patches of these reflectances, row by row, before a grey wall. `corners` are the outer corners of the
    /// corner patches, in pixels (integers are pixel centres), clockwise from the first patch; `gap` is the width of
    /// the gap between patches, in patch widths.
    pub fn chart(size: Size, corners: [[f64; 2]; 4], patches: &[Spectrum], columns: usize, gap: f64) -> Self {
        let rows = patches.len() / columns.max(1);
        let around = [FRAME_REFLECTANCE, WALL_REFLECTANCE].map(Spectrum::constant);
        let materials = patches.iter().take(columns * rows).cloned().chain(around).collect();
        let motif = Motif::Chart(ChartScene::new(corners, columns, rows, gap));
        Self { size, materials, motif, patches: Vec::new() }
    }

    /// Size in pixels.
    pub fn size(&self) -> Size {
        self.size
    }

    /// The distinct reflectances that it mixes.
    pub fn materials(&self) -> &[Spectrum] {
        &self.materials
    }

    /// The patches with known colours, of charts and grey cards.
    pub fn patches(&self) -> &[Patch] {
        &self.patches
    }

    /// The picture, row by row, as anything linear sees it: `response` gives three numbers for a reflectance, such
    /// as [`Camera::response`](crate::Camera::response).
    pub fn seen_by(&self, response: impl Fn(&Spectrum) -> [f64; 3]) -> Vec<[f32; 3]> {
        let palette: Vec<[f32; 3]> = self.materials.iter().map(|m| response(m).map(|v| v as f32)).collect();
        let Size { width, height } = self.size;
        let mut pixels = vec![[0.0; 3]; width * height];
        let rows_a_band = height.div_ceil(BANDS).max(1);
        std::thread::scope(|scope| {
            for (band, pixels) in pixels.chunks_mut((rows_a_band * width).max(1)).enumerate() {
                let palette = &palette;
                scope.spawn(move || {
                    for (i, pixel) in pixels.iter_mut().enumerate() {
                        *pixel = self.pixel(i % width, band * rows_a_band + i / width, palette);
                    }
                });
            }
        });
        pixels
    }

    /// XYZ of each pixel under `light`, row by row; Y = 1 is a perfect diffuser.
    pub fn xyz(&self, light: &Spectrum) -> Vec<[f32; 3]> {
        self.seen_by(|reflectance| {
            let Xyz { x, y, z } = reflectance.reflected_xyz(light);
            [x, y, z]
        })
    }

    /// Colour of the pixel in column `x` of row `y`.
    fn pixel(&self, x: usize, y: usize, palette: &[[f32; 3]]) -> [f32; 3] {
        let across = (x as f64 + 0.5) / self.size.width as f64;
        let down = (y as f64 + 0.5) / self.size.height as f64;
        match &self.motif {
            Motif::StillLife(motif) => motif.pixel(x, y, palette),
            Motif::Flat => palette[0],
            Motif::Chart(chart) => chart.pixel(x, y, palette),
            Motif::Ramp { from, to } => {
                let light = exp2(from + (to - from) * across) as f32;
                palette[0].map(|v| v * light)
            }
            Motif::Gradient => {
                let weights = [
                    (1.0 - across) * (1.0 - down),
                    across * (1.0 - down),
                    (1.0 - across) * down,
                    across * down,
                ];
                let mix = |c: usize| weights.iter().zip(palette).map(|(&w, p)| w as f32 * p[c]).sum();
                std::array::from_fn(mix)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Camera;

    const SIZE: Size = Size { width: 360, height: 240 };

    #[test]
    fn every_pixel_inside_a_patch_has_its_colour() {
        let light = Spectrum::daylight(5500.0);
        let camera = Camera::simulated_one();
        for size in [SIZE, Size { width: 320, height: 240 }] {
            let scene = Scene::still_life(size);
            let (xyz, rgb) = (scene.xyz(&light), scene.seen_by(|r| camera.response(r, &light)));
            assert_eq!(scene.patches().len(), 25);
            for patch in scene.patches() {
                let inside = patch.inside(0.6).unwrap();
                let truth = patch.xyz(&light);
                let seen = camera.response(&patch.reflectance, &light);
                for y in inside.y..inside.bottom() {
                    for x in inside.x..inside.right() {
                        let (pixel, camera) = (xyz[y * size.width + x], rgb[y * size.width + x]);
                        assert!((f64::from(pixel[1]) - truth.y).abs() < 1e-6, "{} at {x}, {y}", patch.name);
                        assert!((f64::from(camera[0]) - seen[0]).abs() < 1e-6, "{} at {x}, {y}", patch.name);
                    }
                }
            }
        }
    }

    #[test]
    fn the_still_life_has_a_highlight_and_no_light_from_nowhere() {
        let xyz = Scene::still_life(SIZE).xyz(&Spectrum::daylight(5500.0));
        let brightest = xyz.iter().map(|p| p[1]).fold(0.0, f32::max);
        assert!(brightest > 5.0, "{brightest}");
        assert!(xyz.iter().flatten().all(|v| v.is_finite() && *v > 0.0));
        let mean = xyz.iter().map(|p| p[1]).sum::<f32>() / xyz.len() as f32;
        assert!((0.05..0.3).contains(&mean), "{mean}");
    }

    #[test]
    fn a_chart_in_perspective_has_its_patches_where_they_should_be() {
        let patches: Vec<Spectrum> = (1..=6).map(|i| Spectrum::constant(f64::from(i) / 10.0)).collect();
        let corners = [[20.0, 10.0], [90.0, 20.0], [85.0, 70.0], [15.0, 60.0]];
        let size = Size { width: 110, height: 80 };
        let xyz = Scene::chart(size, corners, &patches, 3, 0.2).xyz(&Spectrum::constant(1.0));
        let y = |x: usize, y: usize| xyz[y * 110 + x][1];
        for (x, row, expected) in [(26, 18, 0.1), (84, 24, 0.3), (22, 54, 0.4), (78, 63, 0.6), (2, 2, 0.22)] {
            assert!((y(x, row) - expected).abs() < 1e-5, "{x}, {row}: {}", y(x, row));
        }
    }

    #[test]
    fn a_ramp_doubles_with_each_stop() {
        let size = Size { width: 100, height: 1 };
        let scene = Scene::ramp(size, Spectrum::constant(0.5), -5.0, 5.0);
        let xyz = scene.xyz(&Spectrum::daylight(5500.0));
        assert!((xyz[60][1] / xyz[50][1] - 2.0).abs() < 1e-5);
    }
}
