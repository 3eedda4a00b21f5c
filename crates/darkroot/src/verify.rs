//! A new shot of a chart against a profile, and the log of such shots.

use std::path::{Path, PathBuf};

use darkroot_calibrate::judge::judge;
use darkroot_profile::{Profile, Summary};
use maud::{Markup, html};

pub use darkroot_calibrate::judge::{Broken, Judgement, Limits, PRESETS};

use crate::fault::ChartError;
use crate::make_profile::ChartRequest;
use crate::page::{STYLE, page};
use crate::shot::{Shot, common_name, open};
use crate::{Error, Settings};

/// What a shot says about a profile.
#[derive(Debug, Clone, PartialEq)]
pub struct Verification {
    /// The shot.
    pub shot: Shot,
    /// What its patches say.
    pub judgement: Judgement,
}

/// Measures the first shot of a request and judges it by a profile.
///
/// # Errors
/// A shot that cannot be used, or of another camera than the profile's.
pub fn verify(profile: &Profile, request: &ChartRequest, settings: &Settings) -> Result<Verification, Error> {
    let (path, light) = request.shots.first().ok_or(Error::NoLight)?;
    let (shot, _) = open(path, &request.layout, &request.reference, &request.options, settings)?;
    if !crate::store::is_for(profile, &shot.camera) {
        let (camera, of) = (common_name(&shot.camera), profile.camera().name());
        return Err(Error::chart(path, ChartError::OtherCamera { camera, of }));
    }
    let judgement = judge(profile, light, &shot.patches).map_err(|e| Error::fit(light, e))?;
    Ok(Verification { shot, judgement })
}

/// Columns of the log.
const COLUMNS: [&str; 12] = [
    "date",
    "file",
    "camera",
    "light",
    "de2000_mean",
    "de2000_median",
    "de2000_p95",
    "de2000_max",
    "white_r",
    "white_g",
    "white_b",
    "result",
];

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
    fn cells(&self) -> [String; 12] {
        // A line is a shot, whatever its texts hold.
        let plain = |s: &str| s.replace(['\n', '\r'], " ");
        let Summary { mean, median, p95, max } = self.de2000;
        let [mean, median, p95, max] = [mean, median, p95, max].map(|v| format!("{v:.4}"));
        let [red, green, blue] = self.white.map(|v| format!("{v:.6}"));
        [
            plain(&self.date),
            plain(&self.file.display().to_string()),
            plain(&self.camera),
            plain(&self.light),
            mean,
            median,
            p95,
            max,
            red,
            green,
            blue,
            if self.passed { "pass" } else { "fail" }.to_owned(),
        ]
    }

    fn from_cells(cells: &csv::StringRecord) -> Option<Self> {
        let cells: Vec<&str> = cells.iter().collect();
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
        let mut text = csv::Writer::from_writer(Vec::new());
        if !path.exists() {
            text.write_record(COLUMNS)?;
        }
        text.write_record(line.cells())?;
        let text = text.into_inner().map_err(csv::IntoInnerError::into_error)?;
        let mut file = std::fs::OpenOptions::new().create(true).append(true).open(path)?;
        file.write_all(&text)?;
        file.sync_all()
    };
    write().map_err(|e| Error::write(path, e))
}

/// Reads a log; lines that are torn or of another program are left out, and counted.
///
/// # Errors
/// A file that cannot be read, or that is no log.
pub fn read_log(path: &Path) -> Result<(Vec<LogLine>, usize), Error> {
    let text = std::fs::read_to_string(path).map_err(|e| Error::read(path, e))?;
    let mut lines = text.lines();
    if lines.next().is_none_or(|head| !head.split(',').eq(COLUMNS)) {
        return Err(Error::chart(path, ChartError::NoLog));
    }
    // Line by line, so that a quote that is torn off spoils no line but its own.
    let parse = |line: &str| {
        let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(line.as_bytes());
        LogLine::from_cells(&reader.records().next()?.ok()?)
    };
    let all: Vec<Option<LogLine>> = lines.map(parse).collect();
    let torn = all.iter().filter(|l| l.is_none()).count();
    Ok((all.into_iter().flatten().collect(), torn))
}

/// A line of a plot: name, colour, values.
type Series<'a> = (&'a str, &'a str, Vec<f64>);

/// The history of a log as a page with plots: mean and largest error, and the drift of white, shot by shot.
pub fn history(lines: &[LogLine]) -> String {
    let first = lines.first().map_or([1.0; 3], |l| l.white);
    let drift = |c: usize| lines.iter().map(|l| 100.0 * (l.white[c] / first[c] - 1.0)).collect::<Vec<_>>();
    let errors = [
        ("mean dE2000", "#1f5fa8", lines.iter().map(|l| l.de2000.mean).collect()),
        ("largest", "#b00020", lines.iter().map(|l| l.de2000.max).collect()),
    ];
    let white = [("red", "#b00020", drift(0)), ("green", "#2d7a2d", drift(1)), ("blue", "#1f5fa8", drift(2))];
    let failed = lines.iter().filter(|l| !l.passed).count();
    let css = format!("{STYLE}.plot{{width:100%;height:auto}}");
    page(
        "History",
        &css,
        html! {
            h1 { (lines.len()) " shots, " (failed) " failed" }
            h2 { "Errors" }
            (plot(lines, &errors))
            h2 { "White against the first shot, %" }
            (plot(lines, &white))
            @if failed > 0 { p.legend { "Hollow dots: shots that failed." } }
        },
    )
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
            circle cx=(x) cy=(y) r="4" fill=(if line.passed { *colour } else { "#fff" }) stroke=(colour) stroke-width="1.5" {
                title { (line.date) (format!(" {value:.3}")) }
            }
        }
    }
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
        assert!(lines[0].passed && !lines[1].passed && lines[0].camera == "Nikon, D700");
        // As logs were written before texts were quoted.
        let old =
            "2026-05-01,a.nef,Nikon D700,D50,0.5000,0.5000,1.0000,1.5000,0.300000,0.600000,0.400000,pass\n";
        std::fs::write(&path, COLUMNS.join(",") + "\n" + old + "2026-05-02,\"b.nef,Nik\n" + old).unwrap();
        let (read, torn) = read_log(&path).unwrap();
        assert_eq!((read.len(), torn), (2, 1));
        assert!((read[1].de2000.max - 1.5).abs() < 1e-9 && read[1].camera == "Nikon D700");
        let page = history(&lines);
        assert!(page.contains("2 shots, 1 failed") && page.matches("<circle").count() == 10);
    }
}
