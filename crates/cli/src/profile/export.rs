//! `darkroot profile export`.

use std::path::PathBuf;

use anyhow::{Context as _, Result, bail};
use clap::{Args, ValueEnum};
use darkroot::export::{ExportRequest, Target, export};
use darkroot_develop::OutputSpace;
use darkroot_profile::export::cube::Shaper;
use darkroot_profile::export::icc;

use crate::{Common, Outcome};

/// Write a profile for other programs: DCP, ICC, .cube or CLF
///
/// The file is read back, and how far it is from the profile is said. ICC, cube and CLF take balanced camera RGB, as
/// `darkroot develop --space camera` writes it; a DCP takes raw files.
#[derive(Debug, Args)]
pub(super) struct Export {
    /// Profile file, or the name of a camera with a profile
    profile: String,

    /// Format to write
    #[arg(long, value_name = "FORMAT")]
    to: Format,

    /// Light of the calibration, or a temperature (4000K) to interpolate at, where the profile has several; a DCP may
    /// have two (the coldest and the warmest if none is named)
    #[arg(long = "light", value_name = "LIGHT", num_args = 1..)]
    lights: Vec<String>,

    /// For a DCP: a raw file of the camera, whose matrices say what its sensor makes of the light's white
    #[arg(long = "for", value_name = "RAW", conflicts_with = "neutrals")]
    raw_file: Option<PathBuf>,

    /// For a DCP, instead of `--for`: what the sensor makes of the light's white, once for each light
    #[arg(long = "neutral", value_name = "R,G,B", value_parser = neutral)]
    neutrals: Vec<[f64; 3]>,

    /// For cube and CLF: colour space of what comes out [default: rec2020-linear for cube, aces2065-1 for CLF]
    #[arg(long, value_name = "SPACE", value_parser = crate::values::space)]
    space: Option<OutputSpace>,

    /// For cube: what goes in, camera RGB itself or its square root [default: sqrt]
    #[arg(long, value_name = "SHAPER")]
    shaper: Option<ShaperName>,

    /// For ICC, cube and CLF: nodes along each side of the table, 2 to 129 [default: 33]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(2..=129))]
    grid: Option<u8>,

    /// For ICC: version of the format; 2 for older programs [default: 4]
    #[arg(long, value_name = "VERSION")]
    icc_version: Option<IccVersion>,

    /// File to write
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,

    /// Replace an existing file
    #[arg(long)]
    overwrite: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Format {
    /// Camera profile of Adobe's programs, RawTherapee, darktable
    Dcp,
    /// ICC input profile
    Icc,
    /// 3-D table of Adobe and Resolve
    Cube,
    /// Common LUT Format of the Academy, version 3
    Clf,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum ShaperName {
    None,
    Sqrt,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum IccVersion {
    #[value(name = "2")]
    Two,
    #[value(name = "4")]
    Four,
}

impl Export {
    pub(super) fn run(self, common: Common) -> Result<Outcome> {
        self.refuse_what_does_not_fit()?;
        let profile = super::store().choose(&self.profile)?.profile;
        let exported = export(&profile, &self.request())?;
        darkroot::export::write(&self.output, &exported.bytes, self.overwrite)?;
        if !common.quiet {
            for (light, found) in exported.deviations {
                crate::say(format_args!(
                    "{light}: read back, dE2000 from the profile mean {:.3}, 95 % {:.3}, max {:.3} ({} colours in sRGB)",
                    found.de2000.mean, found.de2000.p95, found.de2000.max, found.colours
                ));
            }
        }
        Ok(Outcome::Done)
    }

    fn request(&self) -> ExportRequest {
        let version = match self.icc_version {
            Some(IccVersion::Two) => icc::Version::Two,
            Some(IccVersion::Four) | None => icc::Version::Four,
        };
        let target = match self.to {
            Format::Dcp => Target::Dcp,
            Format::Icc => Target::Icc(version),
            Format::Cube => Target::Cube,
            Format::Clf => Target::Clf,
        };
        let usual = ExportRequest::to(target);
        ExportRequest {
            lights: self.lights.clone(),
            raw_file: self.raw_file.clone(),
            neutrals: self.neutrals.clone(),
            space: self.space,
            shaper: match self.shaper {
                Some(ShaperName::None) => Shaper::None,
                Some(ShaperName::Sqrt) | None => usual.shaper,
            },
            grid: self.grid.map_or(usual.grid, usize::from),
            ..usual
        }
    }

    fn refuse_what_does_not_fit(&self) -> Result<()> {
        let is = |formats: &[Format]| formats.contains(&self.to);
        for (given, fits, option, formats) in [
            (self.raw_file.is_some(), is(&[Format::Dcp]), "--for", "dcp"),
            (!self.neutrals.is_empty(), is(&[Format::Dcp]), "--neutral", "dcp"),
            (self.space.is_some(), is(&[Format::Cube, Format::Clf]), "--space", "cube and clf"),
            (self.shaper.is_some(), is(&[Format::Cube]), "--shaper", "cube"),
            (self.icc_version.is_some(), is(&[Format::Icc]), "--icc-version", "icc"),
            (self.grid.is_some(), !is(&[Format::Dcp]), "--grid", "icc, cube and clf"),
        ] {
            if given && !fits {
                bail!("`{option}` belongs to {formats}; leave it out, or choose another `--to`");
            }
        }
        Ok(())
    }
}

/// `--neutral`.
fn neutral(text: &str) -> Result<[f64; 3]> {
    let numbers: Vec<f64> = text.split(',').map_while(|n| n.trim().parse().ok()).collect();
    let usable = numbers.iter().all(|v| *v > 0.0 && v.is_finite()) && text.split(',').count() == 3;
    let numbers: [f64; 3] = numbers.try_into().ok().filter(|_| usable).with_context(|| {
        format!(
            "`{text}` is no neutral: three numbers above 0, the camera RGB of the light's white (0.47,1,0.68)"
        )
    })?;
    Ok(numbers)
}
