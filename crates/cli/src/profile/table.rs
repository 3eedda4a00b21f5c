//! `darkroot profile TABLE.ti3 --light LIGHT`: patches that were measured elsewhere.

use std::path::Path;

use anyhow::{Result, bail};
use clap::Args;
use darkroot::{FromTable, TableProfile, from_table, shown, table_camera};
use darkroot_profile::ProfileCamera;

use super::make::Make;
use super::{shot_args, told};
use crate::{Common, Outcome};

/// What a table does not say itself.
#[derive(Debug, Args)]
pub(super) struct TableArgs {
    /// For tables: maker of the camera, as pictures name it in short ("Nikon")
    #[arg(long)]
    make: Option<String>,

    /// For tables: model of the camera without the maker ("D700")
    #[arg(long = "camera-model", value_name = "MODEL")]
    camera_model: Option<String>,

    /// For tables: XYZ were measured in the light of the shot, relative to its white; without it they are those under D50,
    /// as references have them
    #[arg(long)]
    measured_in_light: bool,
}

impl TableArgs {
    /// Says that shots need none of it.
    pub(super) fn refuse(&self) -> Result<()> {
        if self.make.is_some() || self.camera_model.is_some() || self.measured_in_light {
            bail!(
                "`--make`, `--camera-model` and `--measured-in-light` are for tables of patches; raw shots tell it themselves"
            );
        }
        Ok(())
    }
}

/// Whether a file is a table of patches, by its name.
pub(super) fn is_one(path: &Path) -> bool {
    let known = ["ti3", "cgats", "txt", "csv", "tsv"];
    path.extension().is_some_and(|e| known.iter().any(|k| e.eq_ignore_ascii_case(k)))
}

/// Makes the profile.
pub(super) fn run(make: &Make, output: &Path, common: Common) -> Result<Outcome> {
    if let Some(shot) = make.shots.iter().find(|path| !is_one(path)) {
        bail!("{}: is no table of patches, but others are; give tables, or shots of a chart", shown(shot));
    }
    let (Some(maker), Some(model)) = (&make.table.make, &make.table.camera_model) else {
        bail!("a table does not say which camera it is from: add `--make Nikon --camera-model D700`");
    };
    if make.as_camera && make.table.measured_in_light {
        bail!(
            "`--as-camera` needs what the patches are in every light: spectra, Lab or XYZ under D50; leave \
             `--measured-in-light` out"
        );
    }
    for (given, option) in [
        (make.report.is_some(), "--report"),
        (make.average, "--average"),
        (make.shot.is_for_shots(), "--reference, --corners, --flat, --dark, --even-out and --correct-glare"),
    ] {
        if given {
            bail!("{option} needs raw shots of a chart, not a table of patches");
        }
    }
    let request = FromTable {
        camera: ProfileCamera { make: maker.clone(), model: model.clone(), aliases: Vec::new() },
        tables: shot_args::in_lights(&make.shots, &make.lights)?,
        measured_in_light: make.table.measured_in_light,
        kind: make.model,
        exclude: make.shot.exclude().to_vec(),
        date: make.date.clone(),
    };
    let made = from_table(&request)?;
    let camera = make.as_camera.then(|| table_camera(&made)).transpose()?;
    let made = TableProfile { profile: camera.unwrap_or(made.profile), lights: made.lights };
    darkroot::store::write(&made.profile, output, make.overwrite)?;
    if make.json {
        for (light, calibrated) in &made.lights {
            use std::io::Write as _;
            writeln!(crate::out::json(), "{}", told::fit_figures(light, calibrated))?;
        }
    }
    if !common.quiet {
        let camera = made.profile.camera().name();
        crate::say(format_args!("{}: profile for {}", shown(output), shown(&camera)));
        for (light, calibrated) in &made.lights {
            told::say_notes(calibrated);
            told::say_models(light, calibrated);
        }
        told::say_camera(&made.profile);
    }
    Ok(Outcome::Done)
}
