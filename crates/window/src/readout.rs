//! What a spot of the picture is: as the camera saw it, as light, and as it is shown.

use darkroot::{Cancel, Format, ProfileStore, Settings, View};
use darkroot_colour::{RgbSpace, Vector3, Xyz, white};
use darkroot_develop::{Balance, Bits, Lens, Look, OutputSpace, Tones};
use darkroot_photo::{Picture, Rect, Samples};
use serde::Serialize;

use crate::fault::Fault;
use crate::opened::Open;
use crate::screen::{Gamut, for_screen, shown};

/// Side of a spot, pixels.
const SIDE: usize = 5;

/// Means over a spot.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Spot {
    /// Where: first column and row, width and height, in pixels of the developed picture.
    rect: [usize; 4],
    /// Linear camera RGB, balanced; 1 is the white level of the least multiplied channel.
    camera: [f64; 3],
    /// XYZ of the scene's light relative to D50 before the look, Y = 1 for what would be white.
    xyz: [f64; 3],
    /// CIELAB of that, D50.
    lab: [f64; 3],
    /// As the screen gets it, 0 to 255.
    output: [f64; 3],
}

/// Measures the spot of 5 x 5 pixels round a pixel of the developed picture.
pub(crate) fn spot(
    open: &Open,
    store: &ProfileStore,
    settings: &Settings,
    gamut: Gamut,
    [x, y]: [usize; 2],
) -> Result<Spot, Fault> {
    let seen = shown(settings.clone(), gamut);
    // The white of all of them is that of the picture as it is shown.
    let plan = open.plan(store, &seen)?;
    let balance = Balance::Multipliers(plan.multipliers().map(f64::from));
    let measured = |space: OutputSpace, look: Look| {
        let mut other = seen.clone();
        other.chart.balance = false;
        let recipe = &mut other.recipe;
        // What is measured lies where it is shown.
        if recipe.geometry.lens == Lens::Auto && recipe.look != Look::Linear {
            recipe.geometry.lens = Lens::File;
        }
        recipe.balance = balance;
        recipe.tones = Tones::default();
        recipe.look = look;
        Settings { space: Some(space), format: Some(Format::Exr), bits: Some(Bits::Float), ..other }
    };
    let camera = measured(OutputSpace::Camera, seen.recipe.look);
    let linear = measured(OutputSpace::Rgb(RgbSpace::REC2020.linear()), Look::Linear);
    let size = plan.size();
    let start = |v: usize, length: usize| v.saturating_sub(SIDE / 2).min(length.saturating_sub(SIDE));
    let rect = Rect {
        x: start(x, size.width),
        y: start(y, size.height),
        width: SIDE.min(size.width),
        height: SIDE.min(size.height),
    };
    let picture = |settings: &Settings| -> Result<Picture, Fault> {
        let rendered = open.plan(store, settings)?.render(View::of(rect), &Cancel::default());
        rendered.map_err(|e| Fault::conflict(e.to_string()))
    };
    let light = mean(&picture(&linear)?);
    let xyz = RgbSpace::REC2020.to_xyz_under(white::D50) * Vector3::from(light);
    let lab = Xyz { x: xyz[0], y: xyz[1], z: xyz[2] }.lab(white::D50);
    Ok(Spot {
        rect: [rect.x, rect.y, rect.width, rect.height],
        camera: mean(&picture(&camera)?),
        xyz: xyz.into(),
        lab: [lab.l, lab.a, lab.b],
        output: mean(&for_screen(picture(&seen)?, gamut)),
    })
}

/// Mean of a picture's samples.
fn mean(picture: &Picture) -> [f64; 3] {
    let value = |i: usize| match &picture.samples {
        Samples::U8(s) => f64::from(s[i]),
        Samples::U16(s) => f64::from(s[i]),
        Samples::F32(s) => f64::from(s[i]),
    };
    let count = picture.size.area().max(1);
    [0, 1, 2].map(|c| (0..count).map(|i| value(3 * i + c)).sum::<f64>() / count as f64)
}
