//! The report on a finished picture of a chart.

use darkroot_calibrate::JudgedPatch;
use darkroot_chart::ChartLayout;
use darkroot_colour::difference::de2000;
use darkroot_colour::{Lab, RgbSpace, Vector3, white};
use darkroot_encode::source_profile::LINEAR;
use maud::{Markup, html};

use super::{measured, plots, shown, swatches};
use crate::deliver::{GUIDELINES, Grey, Guideline, JudgedPicture, LightFrom, Verdict};
use crate::from_chart;
use crate::page::{STYLE, base64, page};
use crate::verify::history::{HISTORY_STYLE, plots_of};
use crate::verify::{LogLine, Outcome};

/// Longest side of the picture.
const LONGEST: usize = 1000;

/// The page of one picture; `verdicts` are the limits that were asked for, with the guideline's name.
pub fn html(
    judged: &JudgedPicture,
    layout: &ChartLayout,
    asked: Option<&str>,
    verdicts: &[Verdict],
) -> String {
    let name = judged.path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let body = html! {
        header {
            h1 { (name) }
            p { (about(judged)) }
        }
        (section(judged, layout, asked, verdicts))
    };
    page(&format!("Delivery {name}"), STYLE, body)
}

/// Everything about one picture but its name.
fn section(
    judged: &JudgedPicture,
    layout: &ChartLayout,
    asked: Option<&str>,
    verdicts: &[Verdict],
) -> Markup {
    html! {
        section {
            @if let Some(asked) = asked { (headline(asked, verdicts)) }
            (picture(judged))
            (limits(verdicts))
            h3 { "Patches: as delivered | as reference | as delivered" }
            (swatches(&as_shown(&judged.delivery.patches), layout))
            p.legend { "dE2000 of each patch, and without lightness." }
            div.columns {
                (measured::greys(judged))
                (plots::vectors(&judged.delivery.patches))
                (plots::lightness(&judged.delivery.patches))
            }
            (measured::details(judged))
            (levels(judged))
            (measured::unlimited(judged))
            @if !judged.delivery.notes.is_empty() {
                ul.notes { @for note in &judged.delivery.notes { li { (note) } } }
            }
        }
    }
}

/// The patches with what a page shows of them: their colour in the picture, and its error without lightness.
fn as_shown(patches: &[JudgedPatch]) -> Vec<JudgedPatch> {
    let to_srgb = RgbSpace::SRGB.from_xyz_under(white::D50);
    let one = |patch: &JudgedPatch| {
        let (found, truth) = (patch.corrected.lab(white::D50), patch.reference.lab(white::D50));
        let unlit = de2000(Lab { l: truth.l, ..found }, truth);
        let rgb: [f64; 3] = (to_srgb * Vector3::from(patch.corrected)).into();
        JudgedPatch { rgb, left_out: Some(unlit), ..patch.clone() }
    };
    patches.iter().map(one).collect()
}

/// Most pictures that a page shows one by one.
const SHOWN: usize = 60;

/// The page of several pictures: a row for each, their drift in the order in which they come, and then each by itself.
pub fn table(
    judged: &[JudgedPicture],
    layout: &ChartLayout,
    lines: &[LogLine],
    asked: Option<&str>,
    verdicts: &[Vec<Verdict>],
) -> String {
    let failed = lines.iter().filter(|line| line.outcome == Outcome::Failed).count();
    let number = |v: f64| format!("{v:.2}");
    let greys = |found: &JudgedPicture, of: fn(&Grey) -> f64| {
        number(found.delivery.greys.iter().map(of).fold(0.0, f64::max))
    };
    let row = |(found, line): (&JudgedPicture, &LogLine)| {
        let class = match line.outcome {
            Outcome::Passed => "good",
            Outcome::Failed => "refused",
            Outcome::Unjudged => "",
        };
        html! {
            tr class=(class) {
                td { (line.outcome.word()) }
                td { (line.date) }
                td { (from_chart::file_name(&found.path)) }
                td { (number(found.delivery.de2000.mean)) }
                td { (number(found.delivery.de2000.max)) }
                td { (greys(found, |grey| grey.lightness_error().abs())) }
                td { (greys(found, Grey::colour_error)) }
                td { (greys(found, |grey| grey.noise.lightness)) }
            }
        }
    };
    let body = html! {
        h1 { (judged.len()) " pictures, " (failed) " failed" }
        @if let Some(asked) = asked { p { "Limits: " (asked) } }
        table.gates {
            tr {
                th { "" } th { "date" } th { "file" } th { "mean dE2000" } th { "largest" } th { "L*" } th { "dE(a*b*)" }
                th { "noise" }
            }
            @for one in judged.iter().zip(lines) { (row(one)) }
        }
        (plots_of(lines))
        @for (found, verdicts) in judged.iter().zip(verdicts).take(SHOWN) {
            h2 { (from_chart::file_name(&found.path)) " " small { (about(found)) } }
            (section(found, layout, asked, verdicts))
        }
        @if judged.len() > SHOWN { p.legend { "The first " (SHOWN) " pictures are shown." } }
    };
    page("Deliveries", &format!("{STYLE}{HISTORY_STYLE}"), body)
}

/// What the picture is and how it was judged, in a sentence.
pub fn about(judged: &JudgedPicture) -> String {
    let space = match (judged.is_tagged, judged.space.as_str()) {
        (false, _) => "no colour profile: taken for sRGB".to_owned(),
        (true, "") => "a colour profile without a name".to_owned(),
        (true, name) => crate::shown(name),
    };
    let tables = if judged.has_tables { " (with tables)" } else { "" };
    let why = match judged.light_from {
        LightFrom::Named => "as named",
        LightFrom::Picture => "as the picture says",
        LightFrom::Assumed => "as in the reference; `--light` names the light of the shot",
    };
    format!("{space}{tables}, {} bits; judged under {} ({why})", judged.bits, judged.light.light.name)
}

fn headline(asked: &str, verdicts: &[Verdict]) -> Markup {
    let broken = verdicts.iter().filter(|v| v.kept() == Some(false)).count();
    let open = verdicts.iter().filter(|v| v.kept().is_none()).count();
    html! {
        p.headline {
            b { @if broken == 0 { "PASS" } @else { "FAIL" } } " by " (asked) ": "
            (verdicts.len() - broken - open) " limits kept, " (broken) " not kept, " (open) " not measured."
        }
    }
}

fn limits(verdicts: &[Verdict]) -> Markup {
    html! {
        @if !verdicts.is_empty() {
            table.gates {
                caption { "Limits" }
                tr { th { "" } th { "what" } th { "found" } th { "limit" } th { "source" } }
                @for verdict in verdicts {
                    @let (class, mark) = match verdict.kept() {
                        Some(true) => ("good", "PASS"),
                        Some(false) => ("refused", "FAIL"),
                        None => ("warning", "–"),
                    };
                    tr class=(class) {
                        td { (mark) }
                        td { (verdict.metric.name()) }
                        td { @match verdict.found { Some(found) => { (found) } None => { "not measured" } } }
                        td { (verdict.bound) }
                        td { small { (verdict.source) } }
                    }
                }
            }
        }
    }
}

/// The level that each guideline gives for each metric.
fn levels(judged: &JudgedPicture) -> Markup {
    let one = |guideline: &Guideline| {
        html! {
            table.models {
                caption { (guideline.name) }
                @for row in guideline.rows {
                    tr {
                        td { (row.metric.name()) }
                        td {
                            @match judged.delivery.value(row.metric, guideline.sl1) {
                                Some(found) => { (found) }
                                None => { "not measured" }
                            }
                        }
                        td { (level(guideline, row, judged)) }
                    }
                }
            }
        }
    };
    html! {
        h3 { "Levels, by secondary sources" }
        div.columns { @for guideline in &GUIDELINES { (one(guideline)) } }
    }
}

/// The level of a row in a word.
pub fn level(guideline: &Guideline, row: &crate::deliver::Row, judged: &JudgedPicture) -> &'static str {
    let measured = judged.delivery.value(row.metric, guideline.sl1).is_some();
    match guideline.reached(row, &judged.delivery) {
        Some(level) => level.name,
        None if measured => "none",
        None => "–",
    }
}

/// The picture with the chart as it was found.
fn picture(judged: &JudgedPicture) -> Markup {
    let view = &judged.view;
    let longest = view.size.width.max(view.size.height);
    let bin = (1..).find(|bin| longest / bin <= LONGEST).unwrap_or(1);
    let jpeg = jpeg(judged, bin);
    html! {
        figure.picture {
            div.frame {
                img alt="the picture" src=(format!("data:image/jpeg;base64,{}", base64(&jpeg)));
                (shown::overlay(&judged.corners, &judged.windows, view.size))
            }
            figcaption { "The picture through its own profile, with the chart as it was found." }
        }
    }
}

fn jpeg(judged: &JudgedPicture, bin: usize) -> Vec<u8> {
    let (size, planes) = judged.view.binned(bin);
    let to_srgb = RgbSpace::SRGB.from_xyz_under(white::D50) * LINEAR.to_xyz_under(white::D50);
    let pixel = |i: usize| {
        let linear = to_srgb * Vector3::from([0, 1, 2].map(|c| f64::from(planes[c][i])));
        let linear: [f64; 3] = linear.into();
        linear.map(|v| (RgbSpace::SRGB.curve.encode(v.clamp(0.0, 1.0)) * 255.0).round() as u8)
    };
    let samples = (0..size.area()).flat_map(pixel).collect();
    shown::jpeg_of(size, samples)
}
