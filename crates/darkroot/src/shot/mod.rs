//! A shot of a chart: where the chart is, what its patches are, whether the shot is good enough.

mod corrections;
mod gates;
mod rendered;
mod view;

use std::path::{Path, PathBuf};

use darkroot_chart::{Layout, Measurement, Quad, Reference, Slope, edge_width, measure};
use darkroot_colour::white;

use corrections::{ColourChange, Corrections, Patches, Sloped, Wanted};

pub use corrections::Fold;
pub use gates::{Gate, Verdict, gates};
pub(crate) use gates::{agreement, light_of, linearity};
pub use view::View;

use crate::calibrate::{MeasuredPatch, is_clipped};
use crate::find_chart::{self, Place};
use crate::{Error, Settings};

/// What a person says about a shot.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ShotOptions {
    /// Corners of the chart by hand: outer corners of the corner patches, in pixels of the developed picture, from
    /// patch 1 on clockwise as the chart is printed.
    pub corners: Option<Quad>,
    /// A shot of an even surface in the same light.
    pub flat: Option<PathBuf>,
    /// A shot with the lens closed.
    pub dark: Option<PathBuf>,
    /// Take the slope of light over the chart out, as far as the patches show it: for each channel on its own where the
    /// light's colour changes and patches that had no say in it bear that out, else one for all.
    pub even_out: bool,
    /// Take the glare out that the patches show, channel by channel: it has the colour of what dazzles.
    pub correct_glare: bool,
    /// Names of patches to leave out.
    pub exclude: Vec<String>,
    /// Use shots that fail a gate.
    pub accept: bool,
    /// Take rendered pictures (JPEG, PNG, TIFF) too.
    pub allow_rendered: bool,
}

/// A measured shot.
#[derive(Debug, Clone, PartialEq)]
pub struct Shot {
    /// The file.
    pub path: PathBuf,
    /// The camera.
    pub camera: darkroot_photo::Camera,
    /// Chart corners in pixels of the developed picture.
    pub corners: Quad,
    /// The part of each patch that was measured.
    pub windows: Vec<Quad>,
    /// How sure the detection is, 0..=1; 1 for corners by hand.
    pub confidence: f64,
    /// Every patch of the layout.
    pub patches: Vec<MeasuredPatch>,
    /// The measurements as they were, before corrections.
    pub measurements: Vec<Measurement>,
    /// Slope of light over the chart.
    pub slope: Slope,
    /// Stray light in green as a share of white.
    pub glare: f64,
    /// All patches as corrected without the help of some: what to cross-validate with. Empty where nothing was corrected
    /// by the patches themselves.
    pub folds: Vec<Fold>,
    /// What was checked.
    pub gates: Vec<Gate>,
    /// What had to be assumed.
    pub notes: Vec<String>,
    /// Exposure time in seconds, where the camera tells.
    pub exposure_seconds: Option<f64>,
}

/// Opens a shot, finds and measures the chart, and checks the gates.
///
/// # Errors
/// Files that cannot be read, no chart, a reference that does not fit, a gate that fails.
pub fn open(
    path: &Path,
    layout: &Layout,
    reference: &Reference,
    options: &ShotOptions,
    settings: &Settings,
) -> Result<(Shot, View), Error> {
    let fault = |what: String| Error::Chart { path: path.to_owned(), what };
    let view =
        if options.allow_rendered { View::open_any(path, settings)? } else { View::open(path, settings)? };
    let found = match &options.corners {
        Some(corners) => find_chart::by_hand(layout, corners),
        None => find_chart::best(&view, layout),
    };
    let Place { corners, patches: whole, windows, confidence } = found.map_err(fault)?;
    check_inside(&corners, &view).map_err(fault)?;
    let names: Vec<&str> = layout.patches.iter().map(|p| p.name.as_str()).collect();
    let colours = reference.for_patches(&names).map_err(|e| fault(format!("the reference {e}")))?;
    check_chart(layout, &colours).map_err(fault)?;

    let framed = |quads: &[Quad]| quads.iter().map(|q| q.map(|p| view.to_frame(p))).collect::<Vec<Quad>>();
    let in_frame = framed(&windows);
    let measurements = measure(&view.frame.light, view.frame.saturation, &in_frame);
    if let Some(i) = measurements.iter().position(|m| !m.is_complete()) {
        let what = format!(
            "patch {} covers too few pixels to be measured; come nearer, or use a longer lens",
            names[i]
        );
        return Err(fault(what));
    }
    let mut rgb: Vec<[f64; 3]> = measurements.iter().map(|m| m.mean).collect();
    if let Some(dark) = &options.dark {
        let dark = companion(dark, &view, settings)?;
        let black = measure(&dark.frame.light, dark.frame.saturation, &in_frame);
        for (rgb, black) in rgb.iter_mut().zip(&black) {
            *rgb = [0, 1, 2].map(|c| rgb[c] - black.mean[c]);
        }
    }
    let mut notes = Vec::new();
    if rendered::is_rendered(path) {
        notes.push(
            "WARNING: made from a rendered picture: the profile serves pictures rendered in just this way, and no raw \
             file"
                .to_owned(),
        );
    }
    if let Some(flat) = &options.flat {
        let flat = companion(flat, &view, settings)?;
        let even = measure(&flat.frame.light, flat.frame.saturation, &in_frame);
        if even.iter().any(|m| m.clipped > 0.01) {
            return Err(fault("the flat is clipped; take it with less light".to_owned()));
        }
        for c in 0..3 {
            let mean = even.iter().map(|m| m.mean[c]).sum::<f64>() / even.len() as f64;
            for (rgb, even) in rgb.iter_mut().zip(&even) {
                rgb[c] *= mean / even.mean[c].max(1e-6);
            }
        }
    }

    let expected: Vec<darkroot_colour::Xyz> =
        colours.iter().map(darkroot_chart::ReferenceColour::xyz_d50).collect();
    let places = darkroot_chart::windows::places(layout);
    let by_hand = |i: usize| options.exclude.iter().any(|e| e.eq_ignore_ascii_case(names[i]));
    let used: Vec<bool> =
        (0..names.len()).map(|i| !is_clipped(measurements[i].clipped) && !by_hand(i)).collect();
    let seen = rgb;
    let told = Patches { rgb: &seen, expected: &expected, places: &places, used: &used };
    let luminance = gates::luminances(&seen, &expected);
    let targets: Vec<f64> = expected.iter().map(|c| c.y).collect();
    let slope = Slope::of(&places, &luminance, &targets).unwrap_or_default();
    let veil = corrections::glare(told);
    let change = ColourChange::of(told);
    let sloped = match (options.even_out, change.is_justified()) {
        (false, _) => Sloped::Not,
        (true, true) => Sloped::Each,
        (true, false) => Sloped::Together,
    };
    let wanted = Wanted { glare: options.correct_glare, slope: sloped };
    let correction = Corrections::of(told, wanted);
    let rgb = correction.applied(told);
    let folds = corrections::folds(told, wanted);
    match sloped {
        Sloped::Not => {}
        Sloped::Together => notes.push(format!(
            "a slope of light of {:.1} % over the chart was taken out",
            100.0 * correction.slopes[1].range()
        )),
        Sloped::Each => notes.push(format!(
            "a slope of light was taken out for each channel: {} % over the chart; the light's colour changes by {:.1} %",
            gates::by_channel(correction.slopes.map(Slope::range)),
            100.0 * change.range
        )),
    }
    if options.correct_glare {
        notes.push(format!("glare was taken out: {} % of white", gates::by_channel(veil)));
    }

    let patches: Vec<MeasuredPatch> = (0..names.len())
        .map(|i| {
            let m = &measurements[i];
            let mut patch = MeasuredPatch {
                name: names[i].to_owned(),
                rgb: rgb[i],
                uncertainty: m.uncertainty(),
                clipped: m.clipped,
                reference: colours[i].clone(),
                excluded: None,
            };
            if patch.is_clipped() {
                patch.excluded = Some("clipped".to_owned());
            } else if by_hand(i) {
                patch.excluded = Some("left out by hand".to_owned());
            } else if rgb[i].iter().any(|v| *v <= 0.0) {
                patch.excluded = Some("darker than black".to_owned());
            }
            patch
        })
        .collect();
    if let Some(unknown) = options.exclude.iter().find(|e| !names.iter().any(|n| n.eq_ignore_ascii_case(e))) {
        return Err(fault(format!("the chart has no patch `{unknown}` to exclude")));
    }
    let edges = edge_width(&view.frame.light, view.frame.saturation, &framed(&whole), layout.columns);
    let mut checked = gates(&view, &measurements, &expected, slope, veil, &corners, layout, options);
    checked.push(gates::colour_change(change, options.even_out || options.flat.is_some()));
    checked.push(gates::sharpness(edges));
    if let Some(failed) = checked.iter().find(|g| g.verdict == Verdict::Refused)
        && !options.accept
    {
        return Err(fault(format!("{}; {} (or add `--accept`)", failed.words, failed.advice)));
    }
    let shot = Shot {
        path: path.to_owned(),
        camera: view.camera.clone(),
        corners,
        windows,
        confidence,
        patches,
        measurements,
        slope,
        glare: veil[1],
        folds,
        gates: checked,
        notes,
        exposure_seconds: view.exposure_seconds,
    };
    Ok((shot, view))
}

/// A flat or dark frame: it must be of the same camera and size.
fn companion(path: &Path, of: &View, settings: &Settings) -> Result<View, Error> {
    let view = View::open(path, settings)?;
    let fault = |what: String| Err(Error::Chart { path: path.to_owned(), what });
    if view.camera != of.camera {
        return fault(format!(
            "was taken with {} {}, the chart with {} {}; take both with one camera",
            view.camera.common_make, view.camera.common_model, of.camera.common_make, of.camera.common_model
        ));
    }
    if view.frame.light.size != of.frame.light.size {
        let (a, b) = (view.frame.light.size, of.frame.light.size);
        return fault(format!(
            "has {} x {} pixels, the chart {} x {}; take both at one size",
            a.width, a.height, b.width, b.height
        ));
    }
    Ok(view)
}

fn check_inside(corners: &Quad, view: &View) -> Result<(), String> {
    let inside = |[x, y]: &[f64; 2]| {
        (-0.5..=view.size.width as f64 - 0.5).contains(x)
            && (-0.5..=view.size.height as f64 - 0.5).contains(y)
    };
    if corners.iter().all(inside) {
        return Ok(());
    }
    Err(format!(
        "the chart lies partly outside of the picture ({} x {} pixels); take it whole, with some room around it",
        view.size.width, view.size.height
    ))
}

/// Whether reference colours are those of the layout, roughly.
fn check_chart(layout: &Layout, colours: &[darkroot_chart::ReferenceColour]) -> Result<(), String> {
    const MOST: f64 = 15.0;
    let off = |(patch, colour): (&darkroot_chart::PatchPlace, &darkroot_chart::ReferenceColour)| {
        darkroot_colour::difference::de2000(colour.xyz_d50().lab(white::D50), patch.lab)
    };
    let mean = layout.patches.iter().zip(colours).map(off).sum::<f64>() / colours.len().max(1) as f64;
    if mean <= MOST {
        return Ok(());
    }
    let fault =
        darkroot_chart::reference::ReferenceError::OtherChart { chart: layout.title.clone(), off: mean };
    Err(format!("of the reference: {fault}"))
}
