//! Which reference the chart of a shot is, where nobody names one.

use darkroot_calibrate::LightSource;
use darkroot_calibrate::reference::left_out;
use darkroot_chart::Reference;

use super::{ChartRequest, Found, ShotOptions};

/// The reference that patches left out of a fit to the others bear out.
pub(crate) struct WhichReference<'a> {
    pub(crate) reference: &'a Reference,
    pub(crate) name: &'a str,
    pub(crate) sha256: &'a str,
    /// How it was chosen, where there was a choice.
    pub(crate) note: Option<String>,
}

impl<'a> WhichReference<'a> {
    /// The best of a request's references for a shot under a light; a reference by which the shot cannot be used is not.
    pub(crate) fn of(request: &'a ChartRequest, found: &Found<'_>, light: &LightSource) -> Self {
        let own = Self {
            reference: &request.reference,
            name: &request.reference_name,
            sha256: &request.reference_sha256,
            note: None,
        };
        if request.other_references.is_empty() {
            return own;
        }
        // Whether the shot is good enough is not the question here.
        let options = ShotOptions { accept: true, ..request.options.clone() };
        let off = |which: &Self| {
            let shot = found.shot(&request.layout, which.reference, &options).ok()?;
            left_out(light, &shot.patches).ok().filter(|off| off.is_finite())
        };
        let others = request.other_references.iter().map(|other| Self {
            reference: &other.colours,
            name: &other.name,
            sha256: &other.sha256,
            note: None,
        });
        let mut tried = vec![(off(&own).unwrap_or(f64::INFINITY), own)];
        tried.extend(others.filter_map(|which| Some((off(&which)?, which))));
        tried.sort_by(|a, b| a.0.total_cmp(&b.0));
        let note = note(&tried);
        let (_, best) = tried.swap_remove(0);
        Self { note: Some(note), ..best }
    }
}

/// What was compared.
fn note(tried: &[(f64, WhichReference<'_>)]) -> String {
    let in_words = |(off, which): &(f64, WhichReference<'_>)| format!("{} {off:.2}", which.name);
    let all: Vec<String> = tried.iter().map(in_words).collect();
    format!(
        "no reference was named: {} is the built-in one that the chart is most like (patches left out of a fit, mean dE2000: {})",
        tried[0].1.name,
        all.join(", ")
    )
}
