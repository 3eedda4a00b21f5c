//! Hints for charts, profiles and what is judged by them.

use std::error::Error;

use darkroot::export::ExportError;
use darkroot::fault::{ChartError, NeutralError};
use darkroot::shot::{Finding, Gate};

/// What to do about an error of a chart job.
pub(super) fn hint(error: &(dyn Error + 'static)) -> Option<String> {
    use darkroot::Error as E;
    if let Some(of_export) = error.downcast_ref() {
        return export(of_export).map(str::to_owned);
    }
    let words = match error.downcast_ref::<E>()? {
        E::Chart { source, .. } => return of_chart(source),
        E::Neutral { source: NeutralError::NoMatrix, .. } => "`--neutral` takes them",
        E::NotListed { .. } => "`darkroot profile list --all` shows these cameras",
        E::NoProfile { .. } => "`darkroot profile list` shows these",
        E::NoLight => "name one with `--light`",
        E::SeveralShots { .. } => {
            "add `--average` to take the mean of them, or give the light of each with its own `--light`"
        }
        _ => return None,
    };
    Some(words.to_owned())
}

fn export(error: &ExportError) -> Option<&'static str> {
    match error {
        ExportError::SeveralLights { .. } => Some("`--light` names it"),
        ExportError::ManyLights { .. } => Some("give fewer to `--light`"),
        ExportError::NoNeutral { .. } => Some(
            "name a raw file of the camera with `--for FILE`, or give the camera RGB of the white with `--neutral R,G,B`",
        ),
        ExportError::CurveInClf => Some("add `-linear` to the name of the space"),
        ExportError::IntoCamera => Some("choose another `--space`"),
        _ => None,
    }
}

fn of_chart(error: &ChartError) -> Option<String> {
    let words = match error {
        ChartError::Rendered => "or add `--allow-rendered` for a profile that serves this rendering only",
        ChartError::OtherLight { .. } => {
            "leave `--light` out, or add `--accept` to judge it under the named one all the same"
        }
        ChartError::OtherBalance { .. } => {
            "`develop --white-balance chart` does; add `--accept` to judge it as it is"
        }
        ChartError::NotFound { .. } => "or give its corners, `--corners x,y,x,y,x,y,x,y`",
        ChartError::NoReference => "name it with `--reference`",
        ChartError::Refused(gate) => {
            let options = options(&gate.finding).map_or_else(String::new, |o| o + "; ");
            return Some(format!("{options}or use the shot as it is: add `--accept`"));
        }
        _ => return None,
    };
    Some(words.to_owned())
}

/// What was found and what to do about it, with the options of this program.
pub(crate) fn advice(gate: &Gate) -> String {
    let mut words = gate.advice();
    if let Some(options) = options(&gate.finding) {
        words = format!("{words}; {options}");
    }
    words
}

/// Options that help where a check is not good.
fn options(finding: &Finding) -> Option<String> {
    let words = match finding {
        Finding::Evenness { .. } | Finding::ColourOfLight { .. } => "give a `--flat`, or add `--even-out`",
        Finding::Glare(_) if finding.is_black_too_high() => {
            "add `--correct-glare`, which takes that out too, or give a `--dark`"
        }
        Finding::Glare(_) => "or add `--correct-glare`",
        Finding::Light { found, .. } => {
            let near = darkroot::shot::near(*found);
            return Some(format!(
                "that is `--light {near:.0}K` or the lamp; `--reference` takes a file of spectra"
            ));
        }
        Finding::Sharpness(None) => "`darkroot chart --preview` shows the grid",
        Finding::Linearity(_) => "give a `--dark` for long exposures",
        _ => return None,
    };
    Some(words.to_owned())
}
