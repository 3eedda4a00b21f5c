//! The history of a log as a page.

use maud::{Markup, html};

use super::log::{LogLine, Outcome};
use crate::page::{STYLE, page};

/// A line of a plot: name, colour, values.
type Series<'a> = (&'a str, &'a str, Vec<f64>);

/// The history of a log as a page with plots.
pub fn history(lines: &[LogLine]) -> String {
    let failed = lines.iter().filter(|l| l.outcome == Outcome::Failed).count();
    let css = format!("{STYLE}{HISTORY_STYLE}");
    page(
        "History",
        &css,
        html! {
            h1 { (lines.len()) " shots, " (failed) " failed" }
            (plots_of(lines))
        },
    )
}

/// Rules of a page with plots of a log.
pub(crate) const HISTORY_STYLE: &str = ".plot{width:100%;height:auto}";

/// Mean and largest error, and the drift of white, shot by shot.
pub(crate) fn plots_of(lines: &[LogLine]) -> Markup {
    let first = lines.first().map_or([1.0; 3], |l| l.white);
    let drift = |c: usize| lines.iter().map(|l| 100.0 * (l.white[c] / first[c] - 1.0)).collect::<Vec<_>>();
    let errors = [
        ("mean dE2000", "#1f5fa8", lines.iter().map(|l| l.de2000.mean).collect()),
        ("largest", "#b00020", lines.iter().map(|l| l.de2000.max).collect()),
    ];
    let white = [("red", "#b00020", drift(0)), ("green", "#2d7a2d", drift(1)), ("blue", "#1f5fa8", drift(2))];
    let failed = lines.iter().filter(|l| l.outcome == Outcome::Failed).count();
    html! {
        h2 { "Errors" }
        (plot(lines, &errors))
        h2 { "White against the first shot, %" }
        (plot(lines, &white))
        @if failed > 0 { p.legend { "Hollow dots: shots that failed." } }
    }
}

fn plot(lines: &[LogLine], series: &[Series<'_>]) -> Markup {
    const WIDTH: f64 = 900.0;
    const HEIGHT: f64 = 260.0;
    const LEFT: f64 = 60.0;
    const RIGHT: f64 = WIDTH - 20.0;
    /// Below the names of the series, and above the dates.
    const TOP: f64 = 34.0;
    const BOTTOM: f64 = HEIGHT - 24.0;
    let all = || series.iter().flat_map(|(_, _, v)| v.iter().copied());
    let (low, high) = (all().fold(0.0, f64::min), all().fold(1e-3, f64::max));
    let x = |i: usize| LEFT + (RIGHT - LEFT) * i as f64 / (lines.len().max(2) - 1) as f64;
    let y = |v: f64| BOTTOM - (BOTTOM - TOP) * (v - low) / (high - low);
    let mut levels = vec![high, 0.0];
    // A label so near to that of 0 would be written over it.
    levels.extend((y(low) - y(0.0) > 14.0).then_some(low));
    html! {
        svg.plot viewBox=(format!("0 0 {WIDTH} {HEIGHT}")) role="img" aria-label="history" {
            @for level in levels {
                path d=(format!("M{LEFT} {:.1}H{RIGHT}", y(level))) stroke="#ccc" {}
                text x=(LEFT - 8.0) y=(format!("{:.1}", y(level) + 4.0)) text-anchor="end" { (format!("{level:.2}")) }
            }
            @if let [first, .., last] = lines {
                text x=(LEFT) y=(HEIGHT - 4.0) { (first.date) }
                text x=(RIGHT) y=(HEIGHT - 4.0) text-anchor="end" { (last.date) }
            }
            @for (k, series) in series.iter().enumerate() {
                text x=(LEFT + 120.0 * k as f64) y="14" style=(format!("fill:{}", series.1)) { (series.0) }
                (curve(lines, series, &x, &y))
            }
        }
    }
}

/// One line of a plot: a dot for each shot, hollow where it failed.
fn curve(
    lines: &[LogLine],
    (_, colour, values): &Series<'_>,
    x: &dyn Fn(usize) -> f64,
    y: &dyn Fn(f64) -> f64,
) -> Markup {
    let place = |(i, v): (usize, &f64)| [format!("{:.1}", x(i)), format!("{:.1}", y(*v))];
    let places: Vec<[String; 2]> = values.iter().enumerate().map(place).collect();
    let points = places.iter().map(|p| p.join(",")).collect::<Vec<_>>().join(" ");
    html! {
        polyline points=(points) fill="none" stroke=(colour) stroke-width="2" {}
        @for ((line, value), [x, y]) in lines.iter().zip(values).zip(&places) {
            circle cx=(x) cy=(y) r="4" fill=(if line.outcome == Outcome::Failed { "#fff" } else { *colour }) stroke=(colour) stroke-width="1.5" {
                title { (line.date) (format!(" {value:.3}")) }
            }
        }
    }
}
