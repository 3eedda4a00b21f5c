//! `darkroot profile export`.

use std::path::PathBuf;

use anyhow::{Context as _, Result, bail};
use clap::{Args, ValueEnum};
use darkroot_colour::{RgbSpace, Xyz};
use darkroot_develop::OutputSpace;
use darkroot_profile::export::clf::Clf;
use darkroot_profile::export::cube::{self, Shaper};
use darkroot_profile::export::dcp::{Dcp, WithNeutral};
use darkroot_profile::export::icc::{self, Icc};
use darkroot_profile::export::{clf, deviation};
use darkroot_profile::{Calibration, Profile};

use super::lights;
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

/// What an exported file makes of balanced camera RGB.
type ReadBack = Box<dyn Fn([f64; 3]) -> Xyz>;

impl Export {
    pub(super) fn run(self, common: Common) -> Result<Outcome> {
        self.refuse_what_does_not_fit()?;
        let profile = super::store().choose(&self.profile)?.profile;
        let calibrations = self.calibrations(&profile)?;
        let (bytes, read_back) = match self.to {
            Format::Dcp => self.dcp(&profile, &calibrations)?,
            _ => self.table(&profile, &calibrations[0])?,
        };
        darkroot::export::write(&self.output, &bytes, self.overwrite)?;
        if !common.quiet {
            for (calibration, read_back) in calibrations.iter().zip(read_back) {
                let found = deviation(calibration, read_back);
                crate::say(format_args!(
                    "{}: read back, dE2000 from the profile mean {:.3}, 95 % {:.3}, max {:.3} ({} colours in sRGB)",
                    calibration.light.name,
                    found.de2000.mean,
                    found.de2000.p95,
                    found.de2000.max,
                    found.colours
                ));
            }
        }
        Ok(Outcome::Done)
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

    /// The calibrations to write, coldest first; one but for a DCP.
    fn calibrations(&self, profile: &Profile) -> Result<Vec<Calibration>> {
        let most = if self.to == Format::Dcp { 2 } else { 1 };
        if self.lights.len() > most {
            let what = if most == 2 { "a DCP has at most two lights" } else { "this format has one light" };
            bail!("{what}; give fewer to `--light`");
        }
        if !self.lights.is_empty() {
            return self.lights.iter().map(|light| lights::choose(profile, Some(light))).collect();
        }
        match profile.calibrations() {
            [coldest, .., warmest] if most == 2 => Ok(vec![coldest.clone(), warmest.clone()]),
            _ => Ok(vec![lights::choose(profile, None)?]),
        }
    }

    fn dcp(&self, profile: &Profile, calibrations: &[Calibration]) -> Result<(Vec<u8>, Vec<ReadBack>)> {
        let names: Vec<&str> = calibrations.iter().map(|c| c.light.name.as_str()).collect();
        let neutrals = match &self.raw_file {
            Some(raw_file) => {
                let whites: Vec<_> = calibrations.iter().map(|c| c.light.xy).collect();
                darkroot::export::neutrals(profile, raw_file, &whites)?
            }
            None => self.neutrals.clone(),
        };
        if neutrals.len() != calibrations.len() {
            bail!(
                "a DCP needs what the sensor makes of the light's white, once for each of its lights ({}): name a raw \
                 file of the camera with `--for FILE`, or give the camera RGB of the white with `--neutral R,G,B`",
                names.join(", ")
            );
        }
        let pairs = calibrations.iter().zip(neutrals);
        let with: Vec<_> = pairs.map(|(calibration, neutral)| WithNeutral { calibration, neutral }).collect();
        let bytes = Dcp::of(profile, &with)?.write();
        let mut read = Dcp::read(&bytes)?.lights;
        // In the file the warmer light is first.
        if read.len() == 2 && calibrations[0].light.kelvin() > calibrations[1].light.kelvin() {
            read.swap(0, 1);
        }
        let read_back = read.into_iter().map(|light| Box::new(move |rgb| light.xyz(rgb)) as ReadBack);
        Ok((bytes, read_back.collect()))
    }

    fn table(&self, profile: &Profile, calibration: &Calibration) -> Result<(Vec<u8>, Vec<ReadBack>)> {
        let size = self.grid.map_or(icc::SIZE, usize::from);
        let (bytes, read_back): (Vec<u8>, ReadBack) = match self.to {
            Format::Cube => {
                let shaper = match self.shaper {
                    Some(ShaperName::None) => Shaper::None,
                    Some(ShaperName::Sqrt) | None => Shaper::SquareRoot,
                };
                let space = self.space(RgbSpace::REC2020.linear())?;
                let settings = cube::Settings { size, shaper, space };
                let text = cube::write(profile, calibration, &settings);
                let read = cube::read(&text)?;
                (text.into_bytes(), Box::new(move |rgb| cube::xyz(&read, &settings, rgb)))
            }
            Format::Clf => {
                let space = self.space(RgbSpace::ACES2065_1)?;
                if space != space.linear() {
                    bail!("CLF is written for linear spaces; add `-linear` to the name of the space");
                }
                let text = clf::write(profile, calibration, size, &space);
                let read = Clf::read(&text)?;
                (text.into_bytes(), Box::new(move |rgb| read.xyz(&space, rgb)))
            }
            Format::Icc | Format::Dcp => {
                let version = match self.icc_version {
                    Some(IccVersion::Two) => icc::Version::Two,
                    Some(IccVersion::Four) | None => icc::Version::Four,
                };
                let bytes = icc::write(profile, calibration, size, version);
                let read = Icc::read(&bytes)?;
                (bytes, Box::new(move |rgb| read.xyz(rgb)))
            }
        };
        Ok((bytes, vec![read_back]))
    }

    fn space(&self, usual: RgbSpace) -> Result<RgbSpace> {
        match self.space {
            None => Ok(usual),
            Some(OutputSpace::Rgb(space)) => Ok(space),
            Some(OutputSpace::Camera) => {
                bail!("the profile leads out of camera RGB; choose another `--space`")
            }
        }
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
