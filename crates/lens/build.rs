//! Writes the lensfun database as two files that the library includes: `lenses.tsv`, the texts, and `numbers.bin`, the
//! coefficients. `src/catalogue.rs` reads them and says what they look like.

use std::collections::BTreeMap;
use std::error::Error;
use std::fmt::Write as _;
use std::path::PathBuf;

use lensfun::{Database, DistortionModel, Lens, TcaModel, VignettingModel};

/// Between texts of one field.
const UNIT: &str = "\u{1f}";

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo:rerun-if-changed=build.rs");
    let database = Database::load_bundled()?;
    let mut text = String::new();
    let mut numbers: Vec<u8> = Vec::new();
    for mount in &database.mounts {
        writeln!(
            text,
            "M\t{}\t{}",
            field([mount.name.as_str()]),
            field(mount.compat.iter().map(String::as_str))
        )?;
    }
    for camera in &database.cameras {
        let makers = field(names(&camera.maker, &camera.maker_localized));
        let models = field(names(&camera.model, &camera.model_localized));
        writeln!(text, "C\t{makers}\t{models}\t{}\t{}", field([camera.mount.as_str()]), camera.crop_factor)?;
    }
    for lens in database.lenses {
        lens_line(lens, &mut text, &mut numbers)?;
    }
    let folder = PathBuf::from(std::env::var_os("OUT_DIR").ok_or("OUT_DIR is not set")?);
    std::fs::write(folder.join("lenses.tsv"), text)?;
    std::fs::write(folder.join("numbers.bin"), numbers)?;
    Ok(())
}

/// A lens as a line of text; its coefficients go to `numbers`.
fn lens_line(mut lens: Lens, text: &mut String, numbers: &mut Vec<u8>) -> Result<(), Box<dyn Error>> {
    // The range of focal lengths, from the name or the measurements where the file does not say it.
    lens.guess_parameters();
    if lens.center_x != 0.0 || lens.center_y != 0.0 {
        return Err(format!("{}: the optical centre is not the picture's middle", lens.model).into());
    }
    let makers = field(names(&lens.maker, &lens.maker_localized));
    let models = field(names(&lens.model, &lens.model_localized));
    let mounts = field(lens.mounts.iter().map(String::as_str));
    let from = numbers.len() / size_of::<f32>();
    let (model, distortion) = distortion_rows(&lens);
    let tca = tca_rows(&lens);
    let vignetting: Vec<[f32; 6]> = lens
        .calib_vignetting
        .iter()
        .filter_map(|c| match c.model {
            VignettingModel::Pa { k1, k2, k3 } => Some([c.focal, c.aperture, c.distance, k1, k2, k3]),
            VignettingModel::None => None,
        })
        .collect();
    let (distortion, tca) = (last_of_each(&distortion, 1), last_of_each(&tca, 1));
    let vignetting = last_of_each(&vignetting, 3);
    let all = distortion.as_flattened().iter().chain(tca.as_flattened()).chain(vignetting.as_flattened());
    numbers.extend(all.flat_map(|n| n.to_le_bytes()));
    writeln!(
        text,
        "L\t{makers}\t{models}\t{mounts}\t{}\t{}\t{}\t{}\t{model}\t{from}\t{}\t{}\t{}",
        lens.focal_min,
        lens.focal_max,
        lens.crop_factor,
        lens.aspect_ratio,
        distortion.len(),
        tca.len(),
        vignetting.len(),
    )?;
    Ok(())
}

/// Focal length and three coefficients, with the name of the model: `ptlens` or `poly5`. The model `poly3` is `ptlens`
/// with `b = k1`. Where a lens has measurements of two models, the first one counts, as in lensfun.
fn distortion_rows(lens: &Lens) -> (&'static str, Vec<[f32; 4]>) {
    let known = lens.calib_distortion.iter().filter_map(|c| match c.model {
        DistortionModel::None => None,
        DistortionModel::Poly3 { k1 } => Some(("poly3", [c.focal, 0.0, k1, 0.0])),
        DistortionModel::Poly5 { k1, k2 } => Some(("poly5", [c.focal, k1, k2, 0.0])),
        DistortionModel::Ptlens { a, b, c: linear } => Some(("ptlens", [c.focal, a, b, linear])),
    });
    let known: Vec<_> = known.collect();
    let first = known.first().map_or("ptlens", |(model, _)| model);
    let rows = known.iter().filter(|(model, _)| *model == first).map(|(_, row)| *row).collect();
    (if first == "poly5" { "poly5" } else { "ptlens" }, rows)
}

/// Focal length, then constant, linear and quadratic coefficient of red, and those of blue. The model `linear` has only
/// the constant ones.
fn tca_rows(lens: &Lens) -> Vec<[f32; 7]> {
    let known = lens.calib_tca.iter().filter_map(|c| match c.model {
        TcaModel::None => None,
        TcaModel::Linear { kr, kb } => Some((false, [c.focal, kr, 0.0, 0.0, kb, 0.0, 0.0])),
        TcaModel::Poly3 { red: [v, l, q], blue: [w, m, r] } => Some((true, [c.focal, v, l, q, w, m, r])),
    });
    let known: Vec<_> = known.collect();
    let first = known.first().is_some_and(|(model, _)| *model);
    known.iter().filter(|(model, _)| *model == first).map(|(_, row)| *row).collect()
}

/// Rows without those whose first numbers come once more: of measurements at the same settings, the last counts, as in
/// lensfun 0.3.
fn last_of_each<const N: usize>(rows: &[[f32; N]], keys: usize) -> Vec<[f32; N]> {
    let again = |at: usize| rows[at + 1..].iter().any(|later| later[..keys] == rows[at][..keys]);
    rows.iter().enumerate().filter(|(at, _)| !again(*at)).map(|(_, row)| *row).collect()
}

/// The name without a language, which is what cameras write, and the English one.
fn names<'a>(plain: &'a str, localised: &'a BTreeMap<String, String>) -> Vec<&'a str> {
    let english = localised.get("en").map(String::as_str).filter(|name| *name != plain);
    [Some(plain), english].into_iter().flatten().collect()
}

/// Texts as one field.
fn field<'a>(texts: impl IntoIterator<Item = &'a str>) -> String {
    let clean = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    texts.into_iter().map(clean).collect::<Vec<_>>().join(UNIT)
}
