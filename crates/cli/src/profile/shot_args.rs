//! How a shot of a chart is read: arguments that `profile`, `verify` and `batch` share.

use std::path::PathBuf;

use anyhow::{Result, bail};
use clap::{Args, ValueEnum};
use darkroot::deliver::DeliveryRequest;
use darkroot::shot::{Correct, ShotOptions};
use darkroot::{ChartRequest, LightSource, charts, light};
use darkroot_profile::Kind;

use crate::deadline::Deadline;

/// Files, each with its light: one for all, or one for each.
pub(super) fn in_lights(files: &[PathBuf], lights: &[String]) -> Result<Vec<(PathBuf, LightSource)>> {
    let found: Vec<LightSource> = lights.iter().map(|l| light::find(l)).collect::<Result<Vec<_>, _>>()?;
    match found.as_slice() {
        [only] => Ok(files.iter().map(|f| (f.clone(), only.clone())).collect()),
        all if all.len() == files.len() => Ok(files.iter().cloned().zip(found).collect()),
        all => bail!(
            "there are {} shots and {} lights; give one light for all, or one for each shot in the same order",
            files.len(),
            all.len()
        ),
    }
}

/// Whether a shot is corrected by its own patches.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum When {
    Auto,
    Always,
    Never,
}

/// How a shot of a chart is read.
#[derive(Debug, Args)]
pub(crate) struct ShotArgs {
    /// The chart: classic24, passport24, mini24, nano24, sg140, dc240, spyder24, spyder48, or a file that describes one
    #[arg(long, value_name = "CHART", default_value = "classic24")]
    chart: String,

    /// What the patches are: a built-in reference or a file (CGATS, .cie, .ti3, CxF 3, CSV; Lab, XYZ or spectra)
    #[arg(long, value_name = "REFERENCE")]
    reference: Option<String>,

    /// Corners of the chart by hand: outer corners of the corner patches in pixels of the developed picture, from patch
    /// 1 on clockwise as the chart is printed
    #[arg(long, value_name = "X,Y,X,Y,X,Y,X,Y", value_parser = crate::values::corners)]
    corners: Option<[[f64; 2]; 4]>,

    /// A shot of an even surface in the same light, to take light fall-off out; with a finished picture one that was made in
    /// the same way, to judge how even the light is
    #[arg(long, value_name = "FILE")]
    flat: Option<PathBuf>,

    /// A shot with the lens closed, to subtract
    #[arg(long, value_name = "FILE")]
    dark: Option<PathBuf>,

    /// Take the slope of light over the chart out, as far as the patches show it: always, never, or where patches that
    /// had no part in finding it bear it out (auto). `profile` takes auto if not given, `verify` never
    #[arg(long, value_name = "WHEN", num_args = 0..=1, require_equals = true, default_missing_value = "always")]
    even_out: Option<When>,

    /// Take out the stray light that the patches show; always, never or auto, as with `--even-out`
    #[arg(long, value_name = "WHEN", num_args = 0..=1, require_equals = true, default_missing_value = "always")]
    correct_glare: Option<When>,

    /// Leave a patch out, by its name; several may be given
    #[arg(long, value_name = "PATCH")]
    exclude: Vec<String>,

    /// Use the shot even if it is not good enough
    #[arg(long)]
    accept: bool,

    /// Take rendered pictures (JPEG, PNG, TIFF) too
    #[arg(long)]
    allow_rendered: bool,

    #[command(flatten)]
    pub(crate) deadline: Deadline,
}

impl ShotArgs {
    /// Names of patches to leave out.
    pub(super) fn exclude(&self) -> &[String] {
        &self.exclude
    }

    /// Whether something is given that only a shot can have.
    pub(super) fn is_for_shots(&self) -> bool {
        let Self { reference, corners, flat, dark, even_out, correct_glare, .. } = self;
        let files = reference.is_some() || flat.is_some() || dark.is_some();
        files || corners.is_some() || even_out.is_some() || correct_glare.is_some()
    }

    /// `unless_said`: whether a shot is corrected where the arguments don't say.
    fn options(&self, unless_said: Correct) -> ShotOptions {
        let when = |given: Option<When>| match given {
            Some(When::Auto) => Correct::WhereItHelps,
            Some(When::Always) => Correct::Always,
            Some(When::Never) => Correct::Never,
            None => unless_said,
        };
        ShotOptions {
            corners: self.corners,
            flat: self.flat.clone(),
            dark: self.dark.clone(),
            even_out: when(self.even_out),
            correct_glare: when(self.correct_glare),
            exclude: self.exclude.clone(),
            accept: self.accept,
            allow_rendered: self.allow_rendered,
        }
    }

    /// A request for finished pictures. What only a shot of the sensor can have is refused.
    pub(crate) fn delivery(
        &self,
        light: Option<LightSource>,
        pitch: Option<f64>,
        pixels_per_degree: f64,
    ) -> Result<DeliveryRequest> {
        if self.dark.is_some() || self.even_out.is_some() || self.correct_glare.is_some() {
            bail!(
                "`--dark`, `--even-out` and `--correct-glare` are for raw shots: a finished picture is judged as it is"
            );
        }
        let layout = charts::layout(&self.chart)?;
        let reference = charts::reference(self.reference.as_deref(), &layout)?;
        Ok(DeliveryRequest {
            layout,
            reference: reference.colours,
            corners: self.corners,
            exclude: self.exclude.clone(),
            flat: self.flat.clone(),
            pitch,
            pixels_per_degree,
            light,
            accept: self.accept,
        })
    }

    /// A request for shots, each with its light. They are corrected as the arguments say, else `unless_said`.
    pub(crate) fn request(
        &self,
        files: &[PathBuf],
        lights: &[String],
        kind: Option<Kind>,
        date: &str,
        unless_said: Correct,
    ) -> Result<ChartRequest> {
        let shots = in_lights(files, lights)?;
        let layout = charts::layout(&self.chart)?;
        let reference = charts::reference(self.reference.as_deref(), &layout)?;
        let request = ChartRequest::of(shots, layout, reference, self.options(unless_said));
        Ok(ChartRequest { kind, date: date.to_owned(), ..request })
    }
}
