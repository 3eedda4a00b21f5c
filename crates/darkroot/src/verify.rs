//! A new shot of a chart against a profile: is the camera still what it was?

use std::path::{Path, PathBuf};

use darkroot_colour::difference::{de2000, de2000_sl1};
use darkroot_colour::white;
use darkroot_profile::{Errors, Profile, Summary};

use crate::calibrate::{Judged, judge};
use crate::make_profile::ChartRequest;
use crate::shot::{Shot, open};
use crate::{Error, Settings};

/// What a shot says about a profile.
#[derive(Debug, Clone, PartialEq)]
pub struct Verification {
    /// The shot.
    pub shot: Shot,
    /// Every patch by the profile.
    pub patches: Vec<Judged>,
    /// Errors over the usable patches.
    pub errors: Errors,
    /// CIEDE2000 with SL = 1 over them, which weighs dark and bright as much as middle greys.
    pub sl1: Summary,
    /// Share of patches below dE2000 4.
    pub within_four: f64,
    /// What the profile says of itself: patches left out of its fit.
    pub promised: Option<Summary>,
}

/// Limits that a shot must keep.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Limits {
    /// Largest mean of dE2000.
    pub mean: Option<f64>,
    /// Largest single dE2000.
    pub max: Option<f64>,
    /// Share of patches that must be below dE2000 4.
    pub within_four: Option<f64>,
    /// Whether dE2000 counts with SL = 1.
    pub sl1: bool,
}

/// Conformance presets by name. The limits are those that secondary sources give for colour accuracy; the standards
/// ask for more than colour.
pub const PRESETS: [(&str, Limits); 3] = [
    // FADGI, "Technical Guidelines for Digitizing Cultural Heritage Materials", 4 stars: mean < 2, 90 % of the patches
    // below 4.
    ("fadgi-4star", Limits { mean: Some(2.0), max: None, within_four: Some(0.9), sl1: false }),
    // Metamorfoze Preservation Imaging Guidelines, full: mean at most 3, largest 7, SL = 1.
    ("metamorfoze-full", Limits { mean: Some(3.0), max: Some(7.0), within_four: None, sl1: true }),
    // ISO 19264-1, level A: mean at most 4, largest 10.
    ("iso19264-a", Limits { mean: Some(4.0), max: Some(10.0), within_four: None, sl1: false }),
];

impl Limits {
    /// Which limits a shot does not keep, in words.
    pub fn broken(&self, found: &Verification) -> Vec<String> {
        let (s, what) =
            if self.sl1 { (found.sl1, "dE2000 (SL = 1)") } else { (found.errors.de2000, "dE2000") };
        let mut broken = Vec::new();
        if let Some(limit) = self.mean.filter(|limit| s.mean > *limit) {
            broken.push(format!("mean {what} is {:.2}, more than {limit}", s.mean));
        }
        if let Some(limit) = self.max.filter(|limit| s.max > *limit) {
            broken.push(format!("the largest {what} is {:.2}, more than {limit}", s.max));
        }
        if let Some(share) = self.within_four.filter(|share| found.within_four < *share) {
            broken.push(format!(
                "{:.0} % of the patches are below dE2000 4, less than {:.0} %",
                100.0 * found.within_four,
                100.0 * share
            ));
        }
        broken
    }
}

/// Measures the first shot of a request and judges it by a profile.
///
/// # Errors
/// A shot that cannot be used, or of another camera than the profile's.
pub fn verify(profile: &Profile, request: &ChartRequest, settings: &Settings) -> Result<Verification, Error> {
    let (path, light) = request.shots.first().ok_or(Error::NoLight)?;
    let (shot, _) = open(path, &request.layout, &request.reference, &request.options, settings)?;
    if !crate::store::is_for(profile, &shot.camera) {
        let what = format!(
            "was taken with {} {}, the profile is for {}",
            shot.camera.common_make,
            shot.camera.common_model,
            profile.camera().name()
        );
        return Err(Error::Chart { path: path.clone(), what });
    }
    let model = profile.model_for(light.light.kelvin());
    let (patches, errors) = judge(light, &shot.patches, &model)
        .map_err(|e| Error::Fit { light: light.light.name.clone(), what: e.to_string() })?;
    let pairs: Vec<_> = patches
        .iter()
        .filter(|p| p.excluded.is_none())
        .map(|p| (p.corrected.lab(white::D50), p.reference.lab(white::D50)))
        .collect();
    let sl1 = Summary::of(&pairs.iter().map(|(a, b)| de2000_sl1(*a, *b)).collect::<Vec<_>>());
    let below = pairs.iter().filter(|(a, b)| de2000(*a, *b) < 4.0).count();
    let nearest = profile.calibrations().iter().min_by(|a, b| {
        let off =
            |c: &darkroot_profile::Calibration| (1e6 / c.light.kelvin() - 1e6 / light.light.kelvin()).abs();
        off(a).total_cmp(&off(b))
    });
    let promised = nearest.and_then(|c| c.figures.leave_one_out.or(c.figures.held_out)).map(|e| e.de2000);
    Ok(Verification {
        within_four: below as f64 / pairs.len().max(1) as f64,
        shot,
        patches,
        errors,
        sl1,
        promised,
    })
}

/// Columns of the log.
const COLUMNS: &str =
    "date,file,camera,light,de2000_mean,de2000_median,de2000_p95,de2000_max,white_r,white_g,white_b,result";

/// One line of a log.
#[derive(Debug, Clone, PartialEq)]
pub struct LogLine {
    /// When, as the camera wrote it or as it was given.
    pub date: String,
    /// The shot's file name.
    pub file: PathBuf,
    /// The camera.
    pub camera: String,
    /// The light's name.
    pub light: String,
    /// Errors.
    pub de2000: Summary,
    /// Camera RGB of the brightest patch, whose drift is that of lamp and exposure.
    pub white: [f64; 3],
    /// Whether the limits were kept.
    pub passed: bool,
}

impl LogLine {
    fn text(&self) -> String {
        let plain = |s: &str| s.replace([',', '\n', '"'], " ");
        let s = self.de2000;
        format!(
            "{},{},{},{},{:.4},{:.4},{:.4},{:.4},{:.6},{:.6},{:.6},{}\n",
            plain(&self.date),
            plain(&self.file.display().to_string()),
            plain(&self.camera),
            plain(&self.light),
            s.mean,
            s.median,
            s.p95,
            s.max,
            self.white[0],
            self.white[1],
            self.white[2],
            if self.passed { "pass" } else { "fail" }
        )
    }

    fn parse(line: &str) -> Option<Self> {
        let cells: Vec<&str> = line.split(',').collect();
        let [date, file, camera, light, mean, median, p95, max, r, g, b, result] = cells[..] else {
            return None;
        };
        let number = |s: &str| s.trim().parse::<f64>().ok().filter(|v| v.is_finite());
        Some(Self {
            date: date.to_owned(),
            file: file.into(),
            camera: camera.to_owned(),
            light: light.to_owned(),
            de2000: Summary {
                mean: number(mean)?,
                median: number(median)?,
                p95: number(p95)?,
                max: number(max)?,
            },
            white: [number(r)?, number(g)?, number(b)?],
            passed: result.trim() == "pass",
        })
    }
}

/// Appends a line to a log, which is made with its header where it is missing.
///
/// # Errors
/// A file that cannot be written.
pub fn append(path: &Path, line: &LogLine) -> Result<(), Error> {
    use std::io::Write as _;
    let write = || {
        let fresh = !path.exists();
        let mut file = std::fs::OpenOptions::new().create(true).append(true).open(path)?;
        let head = if fresh { format!("{COLUMNS}\n") } else { String::new() };
        file.write_all((head + &line.text()).as_bytes())?;
        file.sync_all()
    };
    write().map_err(|e| Error::write(path, &e))
}

/// Reads a log; lines that are torn or of another program are left out, and counted.
///
/// # Errors
/// A file that cannot be read, or that is no log.
pub fn read_log(path: &Path) -> Result<(Vec<LogLine>, usize), Error> {
    let text = std::fs::read_to_string(path).map_err(|e| Error::read(path, &e))?;
    let mut lines = text.lines();
    if lines.next() != Some(COLUMNS) {
        let what = "is no log of `darkroot verify`".to_owned();
        return Err(Error::Chart { path: path.to_owned(), what });
    }
    let all: Vec<Option<LogLine>> = lines.map(LogLine::parse).collect();
    let torn = all.iter().filter(|l| l.is_none()).count();
    Ok((all.into_iter().flatten().collect(), torn))
}

/// The history of a log as a page with plots: mean and largest error, and the drift of white, shot by shot.
pub fn history(lines: &[LogLine]) -> String {
    use std::fmt::Write as _;
    const WIDTH: f64 = 900.0;
    const HEIGHT: f64 = 260.0;
    let x = |i: usize| 40.0 + (WIDTH - 60.0) * i as f64 / (lines.len().max(2) - 1) as f64;
    let plot = |series: &[(&str, &str, Vec<f64>)]| {
        let all = || series.iter().flat_map(|(_, _, v)| v.iter().copied());
        let (low, high) = (all().fold(0.0, f64::min), all().fold(1e-3, f64::max));
        let y = |v: f64| HEIGHT - 24.0 - (HEIGHT - 40.0) * (v - low) / (high - low);
        let mut svg = format!(
            "<svg class=\"plot\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" aria-label=\"history\">"
        );
        let _ = write!(
            svg,
            "<path d=\"M40 {0}H{1}\" stroke=\"#ccc\"/><text x=\"2\" y=\"14\">{high:.2}</text><text x=\"2\" y=\"{0}\">{low:.2}\
             </text>",
            y(low),
            WIDTH - 20.0
        );
        for (k, (name, colour, values)) in series.iter().enumerate() {
            let points: Vec<String> =
                values.iter().enumerate().map(|(i, v)| format!("{:.1},{:.1}", x(i), y(*v))).collect();
            let _ = write!(
                svg,
                "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"2\"/><text x=\"{}\" y=\"14\" \
                 fill=\"{colour}\">{name}</text>",
                points.join(" "),
                60 + 120 * k
            );
            for (i, v) in values.iter().enumerate() {
                let _ = write!(
                    svg,
                    "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"3\" fill=\"{colour}\"><title>{} {v:.3}</title></circle>",
                    x(i),
                    y(*v),
                    lines[i].date.replace(['<', '&', '"'], " ")
                );
            }
        }
        svg + "</svg>"
    };
    let first = lines.first().map_or([1.0; 3], |l| l.white);
    let drift = |c: usize| lines.iter().map(|l| 100.0 * (l.white[c] / first[c] - 1.0)).collect::<Vec<_>>();
    let errors = plot(&[
        ("mean dE2000", "#1f5fa8", lines.iter().map(|l| l.de2000.mean).collect()),
        ("largest", "#b00020", lines.iter().map(|l| l.de2000.max).collect()),
    ]);
    let white =
        plot(&[("red", "#b00020", drift(0)), ("green", "#2d7a2d", drift(1)), ("blue", "#1f5fa8", drift(2))]);
    let failed = lines.iter().filter(|l| !l.passed).count();
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>History</title><style>{}.plot{{width:100%;\
         height:auto}}</style></head><body><h1>{} shots, {failed} failed</h1><h2>Errors</h2>{errors}<h2>White against the \
         first shot, %</h2>{white}</body></html>\n",
        include_str!("report/page.css"),
        lines.len()
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(mean: f64) -> LogLine {
        LogLine {
            date: "2026-05-01".into(),
            file: "a.nef".into(),
            camera: "Nikon, D700".into(),
            light: "D50".into(),
            de2000: Summary { mean, median: mean, p95: 2.0 * mean, max: 3.0 * mean },
            white: [0.3, 0.6, 0.4],
            passed: mean < 1.0,
        }
    }

    #[test]
    fn a_log_survives_a_torn_line() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log.csv");
        append(&path, &line(0.5)).unwrap();
        append(&path, &line(1.5)).unwrap();
        let mut text = std::fs::read_to_string(&path).unwrap();
        text.push_str("2026-05-02,b.nef,Nik");
        std::fs::write(&path, text).unwrap();
        let (lines, torn) = read_log(&path).unwrap();
        assert_eq!((lines.len(), torn), (2, 1));
        assert!(lines[0].passed && !lines[1].passed && lines[0].camera == "Nikon  D700");
        let page = history(&lines);
        assert!(page.contains("2 shots, 1 failed") && page.matches("<circle").count() == 10);
    }

    #[test]
    fn limits_say_what_they_miss() {
        let limits = PRESETS[1].1;
        let shot = |mean: f64| Verification {
            shot: Shot {
                path: "a".into(),
                camera: darkroot_photo::Camera {
                    make: String::new(),
                    model: String::new(),
                    common_make: String::new(),
                    common_model: String::new(),
                },
                corners: [[0.0; 2]; 4],
                windows: Vec::new(),
                confidence: 1.0,
                patches: Vec::new(),
                measurements: Vec::new(),
                slope: darkroot_chart::Slope::default(),
                glare: 0.0,
                folds: Vec::new(),
                gates: Vec::new(),
                notes: Vec::new(),
                exposure_seconds: None,
            },
            patches: Vec::new(),
            errors: Errors::default(),
            sl1: Summary { mean, median: mean, p95: mean, max: 2.0 * mean },
            within_four: 1.0,
            promised: None,
        };
        assert!(limits.broken(&shot(2.0)).is_empty());
        assert_eq!(limits.broken(&shot(5.0)).len(), 2);
    }
}
