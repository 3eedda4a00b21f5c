//! What a laboratory keeps for the root-polynomial paper's third table: a chart under full and under half the light, a dark
//! frame, and what a spectroradiometer makes of every patch under both.

use darkroot_colour::Spectrum;
use darkroot_photo::Size;

use crate::{Camera, Exposure, Scene, dng, expose::expose};

/// A chart in front of a camera.
#[derive(Debug, Clone)]
pub struct Setting<'a> {
    /// The camera.
    pub camera: &'a Camera,
    /// The lamp, relative power.
    pub light: Spectrum,
    /// Names of the patches, row by row.
    pub names: &'a [String],
    /// Their reflectances.
    pub patches: &'a [Spectrum],
    /// Patches of a row.
    pub columns: usize,
    /// Gap between patches, as a share of a patch's width.
    pub gap: f64,
    /// Size of the frame.
    pub size: Size,
    /// Corners of the chart in it, clockwise from the first patch.
    pub corners: [[f64; 2]; 4],
}

/// The files of the laboratory with their names: `full.dng` and `half.dng`, `dark.dng`, `full.csv` and `half.csv`. The shots have
/// noise; the measurements are exact, with Y = 1 for a perfect white under the full light.
pub fn files(setting: &Setting<'_>) -> Vec<(&'static str, Vec<u8>)> {
    let scene = Scene::chart(setting.size, setting.corners, setting.patches, setting.columns, setting.gap);
    let shot = |scene: &Scene, stops: f64, seed: u64| {
        let exposure =
            Exposure { light: setting.light.clone(), stops, noise: Some(seed), ..Exposure::default() };
        dng::write(&expose(scene, setting.camera, &exposure), dng::Storage::Uncompressed)
    };
    let table = |level: f64| {
        let line = |(name, patch): (&String, &Spectrum)| {
            let c = patch.reflected_xyz(&setting.light).scaled(level);
            format!("{name},{:.6},{:.6},{:.6}\n", c.x, c.y, c.z)
        };
        let lines: String = setting.names.iter().zip(setting.patches).map(line).collect();
        format!("patch,X,Y,Z\n{lines}").into_bytes()
    };
    let closed = Scene::flat(setting.size, Spectrum::constant(0.0));
    vec![
        ("full.dng", shot(&scene, 0.0, 1)),
        ("half.dng", shot(&scene, -1.0, 2)),
        ("dark.dng", shot(&closed, 0.0, 3)),
        ("full.csv", table(1.0)),
        ("half.csv", table(0.5)),
    ]
}
