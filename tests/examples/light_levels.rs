//! Writes what a laboratory keeps for the paper's third table, simulated with a measured camera and chart:
//! `light_levels OUT SENSITIVITIES.csv REFLECTANCES.csv [CHART [LIGHT]]`.
//!
//! `darkroot evaluate --shots OUT/full.dng OUT/half.dng --measured OUT/full.csv OUT/half.csv --dark OUT/dark.dng` judges it.

use std::path::Path;
use std::process::ExitCode;

use darkroot::{charts, light, spectra};
use darkroot_photo::Size;
use darkroot_simulate::Camera;
use darkroot_simulate::levels::{Setting, files};

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match run(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &[String]) -> Result<(), Box<dyn std::error::Error>> {
    let [out, sensitivities, reflectances, rest @ ..] = arguments else {
        return Err("light_levels OUT SENSITIVITIES.csv REFLECTANCES.csv [CHART [LIGHT]]".into());
    };
    let layout = charts::layout(rest.first().map_or("sg140", String::as_str))?;
    let light = light::find(rest.get(1).map_or("A", String::as_str))?;
    let (sensitivities, _) = spectra::read_sensitivities(Path::new(sensitivities))?;
    let camera = Camera { sensitivities: sensitivities.0, ..Camera::simulated_one() };
    let names: Vec<String> = layout.patches.iter().map(|p| p.name.clone()).collect();
    let file = spectra::read(Path::new(reflectances))?;
    let chart = file.only(&names).unwrap_or(file);
    let patches = chart.reflectances();
    let (width, height) = (160 * layout.columns + 160, 160 * layout.rows + 160);
    let edge = |x: usize, y: usize| [x as f64, y as f64];
    let setting = Setting {
        camera: &camera,
        light: light.spectrum.ok_or("the light needs a spectrum")?,
        names: &names,
        patches: &patches,
        columns: layout.columns,
        gap: layout.gap,
        size: Size { width, height },
        corners: [edge(80, 80), edge(width - 80, 80), edge(width - 80, height - 80), edge(80, height - 80)],
    };
    std::fs::create_dir_all(out)?;
    for (name, bytes) in files(&setting) {
        std::fs::write(Path::new(out).join(name), bytes)?;
    }
    Ok(())
}
