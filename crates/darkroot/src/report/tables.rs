//! Tables of the models that were compared.

use darkroot_calibrate::{Calibrated, Compared, EXPOSURES};
use darkroot_profile::Errors;
use maud::{Markup, PreEscaped, html};

/// Errors of every model, on patches of the fit and on patches left out.
pub(super) fn models(calibrated: &Calibrated) -> Markup {
    let heads = ["mean", "median", "95&nbsp;%", "max"];
    html! {
        h3 { "Models" }
        div.wide {
            table.models {
                tr {
                    th { "model" }
                    th.group colspan="4" { "training" }
                    th.group colspan="4" { "each patch left out" }
                    th {}
                }
                tr { th {} @for head in heads.iter().chain(&heads) { th { (PreEscaped(head)) } } th {} }
                @for compared in &calibrated.compared {
                    tr class=[chosen(calibrated, compared)] {
                        td { (compared.kind) }
                        @match &compared.result {
                            Ok(figures) => {
                                (cells(figures.training))
                                (cells(figures.leave_one_out))
                                td.words { (compared.settings) }
                            }
                            Err(reason) => { td.words colspan="9" { (reason) } }
                        }
                    }
                }
            }
        }
        p.legend {
            "dE2000 under the light. Training error says little: any model fits what it has seen."
        }
    }
}

fn chosen(calibrated: &Calibrated, compared: &Compared) -> Option<&'static str> {
    (compared.kind == calibrated.calibration.kind).then_some("chosen")
}

fn cells(errors: Option<Errors>) -> Markup {
    let summary = errors.map(|e| e.de2000).filter(|s| s.max.is_finite());
    html! {
        @match summary {
            Some(s) => { @for v in [s.mean, s.median, s.p95, s.max] { td { (format!("{v:.2}")) } } }
            None => { td colspan="4" { "not determined" } }
        }
    }
}

/// Every model on the same patches at other exposures.
pub(super) fn exposures(calibrated: &Calibrated) -> Markup {
    html! {
        h3 { "Exposure" }
        div.wide {
            table.models {
                tr { th { "model" } @for stops in EXPOSURES { th { (signed(stops)) } } }
                @for compared in &calibrated.compared {
                    @if let Some(means) = compared.exposures {
                        tr class=[chosen(calibrated, compared)] {
                            td { (compared.kind) }
                            @for mean in means { td { (format!("{mean:.2}")) } }
                        }
                    }
                }
            }
        }
        p.legend {
            "Mean dE2000 on the patches with so many stops more light. Of a model that keeps colours at every exposure all \
             figures of a row are the same."
        }
    }
}

/// Stops with their sign; 0 has none.
fn signed(stops: i32) -> String {
    if stops == 0 { "0".to_owned() } else { format!("{stops:+}") }
}
