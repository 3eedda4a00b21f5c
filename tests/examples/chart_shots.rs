//! Writes shots of a chart by a measured camera, simulated:
//! `chart_shots OUT SENSITIVITIES.csv REFLECTANCES.csv [CHART [LIGHT [GLARE]]]`.
//!
//! `OUT` gets `chart.dng` (a tilted chart, with noise), `flat.dng` (an even surface in the same light) and `reference.csv`
//! (the spectra of the patches).

use std::fmt::Write;
use std::path::Path;
use std::process::ExitCode;

use darkroot::{charts, light, spectra};
use darkroot_colour::Spectrum;
use darkroot_photo::Size;
use darkroot_simulate::{Camera, Exposure, Scene, dng, expose::expose};

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
        return Err("chart_shots OUT SENSITIVITIES.csv REFLECTANCES.csv [CHART [LIGHT [GLARE]]]".into());
    };
    let layout = charts::layout(rest.first().map_or("classic24", String::as_str))?;
    let light = light::find(rest.get(1).map_or("D50", String::as_str))?;
    let glare: f64 = rest.get(2).map_or(Ok(0.0), |text| text.parse())?;
    let (sensitivities, _) = spectra::read_sensitivities(Path::new(sensitivities))?;
    let camera = Camera { sensitivities: sensitivities.0, ..Camera::simulated_one() };
    let patches = spectra::read(Path::new(reflectances))?.reflectances();
    if patches.len() != layout.patches.len() {
        return Err(format!(
            "{reflectances} has {} spectra, the chart {}",
            patches.len(),
            layout.patches.len()
        )
        .into());
    }
    // Patches of 76 pixels, five degrees from the rows.
    let (columns, rows) = (88.0 * layout.columns as f64, 88.0 * layout.rows as f64);
    let size = Size { width: columns as usize + 240, height: rows as usize + 240 };
    let lean = |x: f64, y: f64| [120.0 + x + 0.08 * (y - rows / 2.0), 120.0 + y - 0.08 * (x - columns / 2.0)];
    let corners = [lean(0.0, 0.0), lean(columns, 0.0), lean(columns, rows), lean(0.0, rows)];
    let scene = Scene::chart(size, corners, &patches, layout.columns, layout.gap);
    let spectrum = light.spectrum.ok_or("the light has no spectrum")?;
    let exposure = Exposure { light: spectrum, glare, noise: Some(5), blur: 0.6, ..Exposure::default() };
    let out = Path::new(out);
    std::fs::create_dir_all(out)?;
    let write = |name: &str, scene: &Scene| {
        std::fs::write(
            out.join(name),
            dng::write(&expose(scene, &camera, &exposure), dng::Storage::Uncompressed),
        )
    };
    write("chart.dng", &scene)?;
    write("flat.dng", &Scene::flat(size, Spectrum::constant(0.5)))?;
    let mut table = "name".to_owned();
    (0..81).for_each(|i| _ = write!(table, ",{}", Spectrum::wavelength(i)));
    for (place, patch) in layout.patches.iter().zip(&patches) {
        _ = write!(table, "\n{}", place.name);
        patch.0.iter().for_each(|v| _ = write!(table, ",{v:.5}"));
    }
    std::fs::write(out.join("reference.csv"), table + "\n")?;
    Ok(())
}
