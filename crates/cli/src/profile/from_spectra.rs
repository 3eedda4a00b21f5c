//! `darkroot profile from-spectra`.

use std::path::PathBuf;

use anyhow::{Result, bail};
use clap::Args;
use darkroot_profile::{Errors, Kind, ProfileCamera};

use crate::{Common, Outcome};

/// Make a profile from a camera's spectral sensitivities, without a shot
///
/// Without reflectances the profile is the camera itself: the model for the light of each photograph follows from its
/// sensitivities. With them it has a calibration for each light, fitted to these reflectances.
#[derive(Debug, Args)]
pub(super) struct FromSpectra {
    /// CSV with three spectra, red, green and blue: `name,380,385,...` and a row for each
    #[arg(long, value_name = "FILE")]
    sensitivities: PathBuf,

    /// CSV of reflectances to fit to; several may be given
    #[arg(long, value_name = "FILE", num_args = 1.., requires = "lights")]
    reflectances: Vec<PathBuf>,

    /// CSV of reflectances to judge by, which take no part in the fit
    #[arg(long, value_name = "FILE", num_args = 1..)]
    held_out: Vec<PathBuf>,

    /// Light of a calibration, or to judge under: D65, A, LED-B3, 5500K, lamp.csv, lamps.csv:NAME; several may be given
    #[arg(long = "light", value_name = "LIGHT", num_args = 1..)]
    lights: Vec<String>,

    /// Maker of the camera, as pictures name it in short ("Nikon")
    #[arg(long)]
    make: String,

    /// Model of the camera without the maker ("D700")
    #[arg(long = "camera-model", value_name = "MODEL")]
    camera_model: String,

    /// Another name of the same camera, maker and model in one
    #[arg(long = "alias", value_name = "NAME")]
    aliases: Vec<String>,

    /// Kind of model to fit to reflectances
    #[arg(long, default_value = "spectral", value_parser = crate::values::kind, requires = "reflectances")]
    model: Kind,

    /// Allow a model that is no good for pictures (plain polynomials)
    #[arg(long)]
    force: bool,

    /// Date to write into the profile, YYYY-MM-DD; none if not given
    #[arg(long, default_value = "")]
    date: String,

    /// Profile to write
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,

    /// Replace an existing file
    #[arg(long)]
    overwrite: bool,
}

impl FromSpectra {
    pub(super) fn run(self, common: Common) -> Result<Outcome> {
        if !self.model.keeps_exposure() && !self.force {
            bail!(
                "colours by {} change with exposure, so it is no good for pictures; take root-2, anchored or \
                 spectral, or add `--force`",
                self.model
            );
        }
        let lights = self.lights.iter().map(|l| darkroot::light::find(l)).collect::<Result<_, _>>()?;
        let request = darkroot::FromSpectra {
            camera: ProfileCamera { make: self.make, model: self.camera_model, aliases: self.aliases },
            sensitivities: self.sensitivities,
            lights,
            reflectances: self.reflectances,
            held_out: self.held_out,
            kind: self.model,
            date: self.date,
        };
        let profile = darkroot::from_spectra(&request)?;
        darkroot::store::write(&profile, &self.output, self.overwrite)?;
        if common.quiet {
            return Ok(Outcome::Done);
        }
        if let Some(known) = profile.known_camera() {
            for judged in known.figures() {
                say(&judged.light, "held out", judged.errors);
            }
            return Ok(Outcome::Done);
        }
        for calibration in profile.calibrations() {
            let judged = calibration.figures.held_out.map(|e| ("held out", e));
            let judged = judged.or(calibration.figures.leave_one_out.map(|e| ("left out", e)));
            if let Some((how, e)) = judged {
                say(&calibration.light.name, how, e);
            }
        }
        Ok(Outcome::Done)
    }
}

fn say(light: &str, how: &str, errors: Errors) {
    let s = errors.de2000;
    crate::say(format_args!("{light}: dE2000 {how} mean {:.2}, 95 % {:.2}, max {:.2}", s.mean, s.p95, s.max));
}
