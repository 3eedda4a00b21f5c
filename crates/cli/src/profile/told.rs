//! What a calibration came to, for people and for machines.

use darkroot::LightSource;
use darkroot::make_profile::{Calibrated, Compared, JudgedPatch, MadeLight};
use darkroot::shot::{Gate, Verdict};
use darkroot::shown;
use darkroot_profile::{Errors, Profile};
use serde_json::json;

use crate::hint;

pub(super) fn say_light(light: &MadeLight) {
    for shot in &light.shots {
        for gate in shot.gates.iter().filter(|g| g.verdict != Verdict::Good) {
            let (path, advice) = (shown(&shot.path), hint::advice(gate));
            crate::say(format_args!("  warning: {path}: {}; {advice}", gate.words()));
        }
        for note in &shot.notes {
            crate::say(format_args!("  note: {}", shown(note)));
        }
    }
    for gate in light.gates.iter().filter(|g| g.verdict != Verdict::Good) {
        crate::say(format_args!("  warning: {}; {}", gate.words(), hint::advice(gate)));
    }
    say_notes(&light.calibrated);
    if let Some([red, _, blue]) = light.white_balance {
        crate::say(format_args!(
            "  note: the white balance in the file is not that of the chart's light: to see the chart as it is, develop with \
             `--white-balance {red:.3},1,{blue:.3}`"
        ));
    }
    say_models(&light.light, &light.calibrated);
}

/// How far a profile that is a camera is off under the lights of its patches.
pub(super) fn say_camera(profile: &Profile) {
    for judged in profile.known_camera().into_iter().flat_map(|known| known.figures()) {
        let (light, errors) = (&judged.light, judged.errors.de2000);
        crate::say(format_args!(
            "  the camera under {light}, left out, dE2000: mean {:.2}, max {:.2}",
            errors.mean, errors.max
        ));
    }
}

/// What had to be assumed for a fit.
pub(super) fn say_notes(calibrated: &Calibrated) {
    for note in &calibrated.notes {
        crate::say(format_args!("  note: {}", shown(note)));
    }
}

/// Every model that was tried, with its errors.
pub(super) fn say_models(light: &LightSource, calibrated: &Calibrated) {
    let chosen = calibrated.calibration.kind;
    crate::say(format_args!("  {}, dE2000 (mean / max):  training   left out", light.light.name));
    for compared in &calibrated.compared {
        let mark = if compared.kind == chosen { "->" } else { "  " };
        let kind = compared.kind.to_string();
        match &compared.result {
            Ok(f) => {
                let pair = |e: Option<Errors>| match e.map(|e| e.de2000).filter(|s| s.max.is_finite()) {
                    Some(s) => format!("{:5.2} / {:5.2}", s.mean, s.max),
                    None => "not determined".to_owned(),
                };
                crate::say(format_args!(
                    "  {mark} {kind:13} {}   {}",
                    pair(f.training),
                    pair(f.leave_one_out)
                ));
            }
            Err(reason) => crate::say(format_args!("  {mark} {kind:13} {reason}")),
        }
    }
}

/// Everything about one light, for machines.
pub(super) fn figures(light: &MadeLight) -> serde_json::Value {
    let shots: Vec<_> = light
        .shots
        .iter()
        .map(|s| {
            json!({
                "file": darkroot::path_text::text(&s.path),
                "corners": s.corners,
                "confidence": s.confidence,
                "glare": s.glare,
                "unevenness": s.slope.range(),
                "gates": gates(&s.gates),
            })
        })
        .collect();
    let mut figures = fit_figures(&light.light, &light.calibrated);
    figures["gates"] = gates(&light.gates).into();
    figures["shots"] = shots.into();
    figures
}

/// The fit under one light, for machines.
pub(super) fn fit_figures(light: &LightSource, calibrated: &Calibrated) -> serde_json::Value {
    let summary = |e: Option<Errors>| {
        e.map(|e| {
            let s = e.de2000;
            json!({ "mean": s.mean, "median": s.median, "p95": s.p95, "max": s.max })
        })
    };
    let model = |c: &Compared| match &c.result {
        Ok(f) => json!({
            "model": c.kind.to_string(),
            "training": summary(f.training),
            "leave_one_out": summary(f.leave_one_out),
            "exposures": c.exposures,
        }),
        Err(reason) => json!({ "model": c.kind.to_string(), "error": reason.to_string() }),
    };
    let patch = |p: &JudgedPatch| {
        json!({
            "name": p.name,
            "rgb": p.rgb,
            "uncertainty": p.uncertainty,
            "de2000": p.de2000,
            "left_out_de2000": p.left_out,
            "excluded": p.excluded,
        })
    };
    json!({
        "light": light.light.name,
        "model": calibrated.calibration.kind.to_string(),
        "models": calibrated.compared.iter().map(model).collect::<Vec<_>>(),
        "white_rgb": calibrated.white_rgb,
        "patches": calibrated.patches.iter().map(patch).collect::<Vec<_>>(),
    })
}

/// Checks, for machines; a value that could not be measured is null.
fn gates(gates: &[Gate]) -> Vec<serde_json::Value> {
    let one = |g: &Gate| {
        let verdict = match g.verdict {
            Verdict::Good => "good",
            Verdict::Warning => "warning",
            Verdict::Refused => "failed",
        };
        json!({ "name": g.name(), "verdict": verdict, "value": g.value(), "words": g.words() })
    };
    gates.iter().map(one).collect()
}
