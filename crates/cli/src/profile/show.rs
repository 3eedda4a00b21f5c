//! `darkroot profile show`.

use std::fmt::Write as _;
use std::io::Write as _;

use anyhow::Result;
use clap::Args;
use darkroot::shown;
use darkroot::store::Found;
use darkroot_colour::{Lab, white};
use darkroot_profile::camera::KnownCamera;
use darkroot_profile::{Calibration, Errors, Model, polynomial};

use crate::Outcome;

/// Show a profile: terms, error figures, a plot of the residuals
#[derive(Debug, Args)]
pub(super) struct Show {
    /// Profile file, or the name of a camera with a profile
    profile: String,
}

impl Show {
    pub(super) fn run(self) -> Result<Outcome> {
        let found = super::store().choose(&self.profile)?;
        crate::out::lines().write_all(words(&found).as_bytes())?;
        Ok(Outcome::Done)
    }
}

fn words(found: &Found) -> String {
    let profile = &found.profile;
    let mut text = format!("{} ({})\n", shown(&profile.camera().name()), found.place);
    if !profile.camera().aliases.is_empty() {
        let _ = writeln!(text, "also called    {}", shown(&profile.camera().aliases.join("; ")));
    }
    let origin = profile.origin();
    for (label, value) in [
        ("origin", &origin.summary),
        ("chart", &origin.chart),
        ("reference", &origin.reference),
        ("measured in", &origin.sensitivities),
        ("date", &origin.date),
        ("program", &origin.program),
    ] {
        if !value.is_empty() {
            let _ = writeln!(text, "{label:15}{}", shown(value));
        }
    }
    if let Some(known) = profile.known_camera() {
        describe_camera(&mut text, known);
    }
    for calibration in profile.calibrations() {
        describe(&mut text, calibration);
    }
    text
}

/// What a profile that is a camera knows; its calibrations, which follow, are three of all that it can make.
fn describe_camera(text: &mut String, known: &KnownCamera) {
    let peak = |channel: usize| {
        let largest = known.samples()[channel].iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1));
        largest.map_or(0, |(i, _)| 380 + 10 * i)
    };
    let _ = writeln!(
        text,
        "{:15}380 to 780 nm every 10 nm; red is most sensitive at {} nm, green at {} nm, blue at {} nm",
        "sensitivities",
        peak(0),
        peak(1),
        peak(2)
    );
    if let Some(expected) = known.expected() {
        let _ = writeln!(
            text,
            "{:15}mean dE2000 {expected:.1} under daylight, for they are an estimate",
            "expected"
        );
    }
}

fn describe(text: &mut String, calibration: &Calibration) {
    let light = &calibration.light;
    let _ = writeln!(
        text,
        "\n{}: xy {:.4}, {:.4}, {:.0} K; model {}",
        shown(&light.name),
        light.xy.x,
        light.xy.y,
        light.kelvin(),
        calibration.kind
    );
    let figures = &calibration.figures;
    let sets = [
        ("training", figures.training),
        ("leave-one-out", figures.leave_one_out),
        ("held out", figures.held_out),
    ];
    if sets.iter().any(|(_, e)| e.is_some()) {
        let _ = writeln!(text, "  {:14}{:>28}   {:>28}", "", "dE2000 mean median 95 % max", "dE*uv");
    }
    for (label, Errors { de2000, de_uv }) in sets.into_iter().filter_map(|(l, e)| Some((l, e?))) {
        let four = |s: darkroot_profile::Summary| {
            format!("{:7.2}{:7.2}{:7.2}{:7.2}", s.mean, s.median, s.p95, s.max)
        };
        let _ = writeln!(text, "  {label:14}{}   {}", four(de2000), four(de_uv));
    }
    terms(text, &calibration.model);
    if !calibration.patches.is_empty() {
        plot(text, calibration);
    }
}

fn terms(text: &mut String, model: &Model) {
    let line = |text: &mut String, name: &str, [x, y, z]: [f64; 3]| {
        let _ = writeln!(text, "  {name:14}{x:12.6}{y:12.6}{z:12.6}");
    };
    if model.root.is_some() || model.polynomial.is_some() {
        let _ = writeln!(text, "  {:14}{:>12}{:>12}{:>12}", "term", "X", "Y", "Z");
    }
    for (term, xyz) in model.root.iter().flat_map(|part| part.terms()) {
        line(text, &term.name(), xyz);
    }
    for (term, xyz) in model.polynomial.iter().flat_map(|part| part.terms()) {
        line(text, &polynomial::name(term), xyz);
    }
    if let Some(part) = &model.hue_plane {
        let _ = writeln!(text, "  {} matrices round the hues", part.knots().len());
    }
    if let Some(part) = &model.residual {
        let _ = writeln!(text, "  {} bumps over chromaticity", part.centres().len());
    }
}

/// Columns and rows of the plot.
const WIDTH: usize = 61;
const HEIGHT: usize = 25;

/// Residuals in the a*b* plane: where the reference colours stand, and how far the model is off.
fn plot(text: &mut String, calibration: &Calibration) {
    let colours: Vec<(Lab, f64)> =
        calibration.patches.iter().map(|p| (p.xyz.lab(white::D50), p.de2000)).collect();
    let reach = colours.iter().map(|(lab, _)| lab.a.abs().max(lab.b.abs())).fold(20.0, f64::max) * 1.05;
    let mut cells = vec![vec![' '; WIDTH]; HEIGHT];
    for (x, cell) in cells[HEIGHT / 2].iter_mut().enumerate() {
        *cell = if x == WIDTH / 2 { '+' } else { '-' };
    }
    for (y, row) in cells.iter_mut().enumerate() {
        if y != HEIGHT / 2 {
            row[WIDTH / 2] = '|';
        }
    }
    let mut drawn = vec![vec![f64::NEG_INFINITY; WIDTH]; HEIGHT];
    for (lab, error) in colours {
        let place = |v: f64, cells: usize| {
            (((v / reach + 1.0) / 2.0 * (cells - 1) as f64).round() as usize).min(cells - 1)
        };
        let (x, y) = (place(lab.a, WIDTH), HEIGHT - 1 - place(lab.b, HEIGHT));
        // Where colours meet, the worst is seen.
        if error > drawn[y][x] {
            drawn[y][x] = error;
            cells[y][x] = match error {
                e if e < 0.5 => '.',
                e if e < 1.0 => 'o',
                e if e < 2.0 => 'O',
                _ => '@',
            };
        }
    }
    let _ = writeln!(
        text,
        "  residuals over a* (right) and b* (up), +-{reach:.0}; dE2000: . < 0.5 <= o < 1 <= O < 2 <= @"
    );
    for row in cells {
        let line: String = row.into_iter().collect();
        let _ = writeln!(text, "  {}", line.trim_end());
    }
    let worst = calibration.patches.iter().max_by(|a, b| a.de2000.total_cmp(&b.de2000));
    if let Some(patch) = worst {
        let _ = writeln!(text, "  worst: {} with {:.2}", shown(&patch.name), patch.de2000);
    }
}
