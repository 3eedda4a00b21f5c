//! From a profile to the text of its file.

use std::fmt::Write;

use super::{CAMERA_VERSION, FORMAT, RENDERING_VERSION, VERSION, WHITE, rendering};
use crate::camera::{Judged, KnownCamera};
use crate::{Calibration, Errors, Model, Origin, Profile, Summary, polynomial};

/// The text of a profile's file. [`super::parse`] gives the same profile back, to the last bit.
pub fn format(profile: &Profile) -> String {
    let camera = profile.camera();
    let aliases: Vec<String> = camera.aliases.iter().map(|a| quoted(a)).collect();
    let version = match (profile.rendering(), profile.known_camera()) {
        (Some(_), _) => RENDERING_VERSION,
        (None, Some(_)) => CAMERA_VERSION,
        (None, None) => VERSION,
    };
    let mut text = String::new();
    // Writing to a String cannot fail.
    let _ = write!(
        text,
        "format = {}\nversion = {version}\nwhite = {}\n\n[camera]\nmake = {}\nmodel = {}\naliases = [{}]\n",
        quoted(FORMAT),
        quoted(WHITE),
        quoted(&camera.make),
        quoted(&camera.model),
        aliases.join(", "),
    );
    write_origin(&mut text, profile.origin());
    match profile.known_camera() {
        Some(known) => write_sensitivities(&mut text, known),
        None => profile.calibrations().iter().for_each(|c| write_calibration(&mut text, c)),
    }
    if let Some(rendering) = profile.rendering() {
        rendering::write(&mut text, rendering);
    }
    text
}

fn quoted(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}

fn write_origin(text: &mut String, origin: &Origin) {
    let fields = [
        ("summary", &origin.summary),
        ("chart", &origin.chart),
        ("reference", &origin.reference),
        ("reference_sha256", &origin.reference_sha256),
        ("sensitivities", &origin.sensitivities),
        ("sensitivities_sha256", &origin.sensitivities_sha256),
        ("date", &origin.date),
        ("program", &origin.program),
    ];
    if fields.iter().any(|(_, value)| !value.is_empty()) {
        text.push_str("\n[origin]\n");
    }
    for (name, value) in fields.into_iter().filter(|(_, value)| !value.is_empty()) {
        let _ = writeln!(text, "{name} = {}", quoted(value));
    }
}

fn write_sensitivities(text: &mut String, known: &KnownCamera) {
    text.push_str("\n[sensitivities] # 380 to 780 nm every 10 nm\n");
    for (name, samples) in ["red", "green", "blue"].iter().zip(known.samples()) {
        let values: Vec<String> = samples.iter().map(ToString::to_string).collect();
        let _ = writeln!(text, "{name} = [{}]", values.join(", "));
    }
    if let Some(expected) = known.expected() {
        let _ = writeln!(text, "expected_de2000 = {expected:?}");
    }
    for Judged { light, errors } in known.figures() {
        let _ = writeln!(text, "\n[[sensitivities.held_out]] # mean, median, 95th percentile, largest");
        let _ = writeln!(text, "light = {}", quoted(light));
        let _ = writeln!(text, "de2000 = {:?}\nde_uv = {:?}", four(errors.de2000), four(errors.de_uv));
    }
}

fn four(s: Summary) -> [f64; 4] {
    [s.mean, s.median, s.p95, s.max]
}

fn write_calibration(text: &mut String, calibration: &Calibration) {
    let Calibration { light, kind, model, figures, patches } = calibration;
    let _ = write!(
        text,
        "\n[[calibration]]\nlight = {}\nxy = {:?}\nkelvin = {:.0}\nmodel = {}\n",
        quoted(&light.name),
        [light.xy.x, light.xy.y],
        light.kelvin(),
        quoted(&kind.to_string()),
    );
    write_model(text, model);
    let sets = [
        ("training", figures.training),
        ("leave_one_out", figures.leave_one_out),
        ("held_out", figures.held_out),
    ];
    if sets.iter().any(|(_, errors)| errors.is_some()) {
        text.push_str("\n[calibration.figures] # mean, median, 95th percentile, largest\n");
    }
    for (name, Errors { de2000, de_uv }) in sets.into_iter().filter_map(|(n, e)| Some((n, e?))) {
        let _ = writeln!(text, "{name} = {{ de2000 = {:?}, de_uv = {:?} }}", four(de2000), four(de_uv));
    }
    for patch in patches {
        let _ = write!(
            text,
            "\n[[calibration.patch]]\nname = {}\nrgb = {:?}\nxyz = {:?}\nde2000 = {:?}\n",
            quoted(&patch.name),
            patch.rgb,
            [patch.xyz.x, patch.xyz.y, patch.xyz.z],
            patch.de2000,
        );
    }
}

fn write_model(text: &mut String, model: &Model) {
    if let Some(root) = &model.root {
        let _ = writeln!(text, "order = {}\n\n[calibration.terms] # X, Y, Z", root.order().number());
        for (term, xyz) in root.terms() {
            let _ = writeln!(text, "{} = {xyz:?}", quoted(&term.name()));
        }
    }
    if let Some(part) = &model.hue_plane {
        text.push_str("\n[calibration.hue_plane]\nmatrices = [\n");
        for matrix in part.knots() {
            let _ = writeln!(text, "    {:?},", matrix.transpose().as_slice());
        }
        text.push_str("]\n");
    }
    if let Some(part) = &model.residual {
        text.push_str("\n[calibration.residual] # r, g, b, X, Y, Z\ncentres = [\n");
        for centre in part.centres() {
            let ([r, g, b], [x, y, z]) = (centre.rgb, centre.weight);
            let _ = writeln!(text, "    {:?},", [r, g, b, x, y, z]);
        }
        text.push_str("]\n");
    }
    if let Some(part) = &model.polynomial {
        text.push_str("\n[calibration.polynomial] # X, Y, Z\n");
        for (term, xyz) in part.terms() {
            let _ = writeln!(text, "{} = {xyz:?}", quoted(&polynomial::name(term)));
        }
    }
}
