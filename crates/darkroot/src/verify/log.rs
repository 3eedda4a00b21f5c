//! The log of judged shots: CSV, a line a shot, for people, plots and spreadsheets.

use std::path::{Path, PathBuf};

use darkroot_profile::Summary;

use crate::fault::ChartError;
use crate::{Error, files, shown};

/// Columns of the log.
const COLUMNS: [&str; 15] = [
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
    "profile",
    "preset",
    "limits",
];

/// Those of a log as it was before a shot's profile and limits were written down.
const FIRST_COLUMNS: usize = 12;

/// How a shot came out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// It keeps the limits.
    Passed,
    /// It does not.
    Failed,
    /// There were no limits to keep.
    Unjudged,
}

impl Outcome {
    const WORDS: [(Self, &str); 3] =
        [(Self::Passed, "pass"), (Self::Failed, "fail"), (Self::Unjudged, "unjudged")];

    pub(crate) fn word(self) -> &'static str {
        Self::WORDS.iter().find(|(outcome, _)| *outcome == self).map_or("", |(_, word)| word)
    }
}

/// One line of a log.
#[derive(Debug, Clone, PartialEq)]
pub struct LogLine {
    /// Day of the shot, as it was given or as the camera wrote it; may be empty.
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
    /// How it came out.
    pub outcome: Outcome,
    /// The profile that it was judged by: a file, or "built in".
    pub profile: String,
    /// Name of the preset; empty if none was asked for.
    pub preset: String,
    /// The limits, in words; empty if there were none.
    pub limits: String,
}

/// A text as a cell: one line, and nothing that a spreadsheet takes for a formula.
fn cell(text: &str) -> String {
    let line = shown(text);
    if line.starts_with(is_formula) { format!("'{line}") } else { line }
}

/// The text of a cell.
fn text(cell: &str) -> String {
    cell.strip_prefix('\'').filter(|rest| rest.starts_with(is_formula)).unwrap_or(cell).to_owned()
}

/// Whether a text that begins so is a formula to some spreadsheet, or an escaped one.
fn is_formula(first: char) -> bool {
    matches!(first, '=' | '+' | '-' | '@' | '＝' | '＋' | '－' | '＠' | '\'')
}

impl LogLine {
    fn cells(&self) -> [String; 15] {
        let Summary { mean, median, p95, max } = self.de2000;
        let [mean, median, p95, max] = [mean, median, p95, max].map(|v| format!("{v:.4}"));
        let [red, green, blue] = self.white.map(|v| format!("{v:.6}"));
        [
            cell(&self.date),
            cell(&shown(&self.file)),
            cell(&self.camera),
            cell(&self.light),
            mean,
            median,
            p95,
            max,
            red,
            green,
            blue,
            self.outcome.word().to_owned(),
            cell(&self.profile),
            cell(&self.preset),
            cell(&self.limits),
        ]
    }

    fn from_cells(cells: &csv::StringRecord) -> Option<Self> {
        let cells: Vec<&str> = cells.iter().collect();
        let (first, rest) = cells.split_at_checked(FIRST_COLUMNS)?;
        let [date, file, camera, light, mean, median, p95, max, r, g, b, result] = first else { return None };
        let [profile, preset, limits] = match rest {
            [] => [""; 3],
            [profile, preset, limits] => [*profile, *preset, *limits],
            _ => return None,
        };
        let number = |s: &str| s.trim().parse::<f64>().ok().filter(|v| v.is_finite());
        let outcome = Outcome::WORDS.iter().find(|(_, word)| *word == result.trim());
        Some(Self {
            date: text(date),
            file: text(file).into(),
            camera: text(camera),
            light: text(light),
            de2000: Summary {
                mean: number(mean)?,
                median: number(median)?,
                p95: number(p95)?,
                max: number(max)?,
            },
            white: [number(r)?, number(g)?, number(b)?],
            outcome: outcome.map(|(outcome, _)| *outcome)?,
            profile: text(profile),
            preset: text(preset),
            limits: text(limits),
        })
    }
}

/// Appends a line to a log, which is made with its header where it is missing. A log with fewer columns, as they were
/// written before, gets the others first.
///
/// # Errors
/// A file that cannot be written.
pub fn append(path: &Path, line: &LogLine) -> Result<(), Error> {
    let row = |cells: &[&str]| -> Result<Vec<u8>, Error> {
        let mut row = csv::Writer::from_writer(Vec::new());
        let written = row.write_record(cells).map_err(std::io::Error::from);
        written.map_err(|e| Error::write(path, e))?;
        row.into_inner().map_err(|e| Error::write(path, e.into_error()))
    };
    if path.exists() {
        let old = String::from_utf8(files::read_text(path)?).unwrap_or_default();
        if let Some(lines) = old.strip_prefix(&(COLUMNS[..FIRST_COLUMNS].join(",") + "\n")) {
            let mut whole = COLUMNS.join(",") + "\n";
            for line in lines.lines() {
                whole += line;
                // A torn line stays as it is.
                whole += if record(line).is_some_and(|r| r.len() == FIRST_COLUMNS) { ",,,\n" } else { "\n" };
            }
            files::write_text(path, &whole, true)?;
        }
    }
    files::append(path, &row(&COLUMNS)?, &row(&line.cells().each_ref().map(String::as_str))?)
}

/// A line by itself, so that a quote that is torn off spoils no other.
fn record(line: &str) -> Option<csv::StringRecord> {
    let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(line.as_bytes());
    reader.records().next()?.ok()
}

/// Reads a log; lines that are torn or of another program are left out, and counted.
///
/// # Errors
/// A file that cannot be read, or that is no log.
pub fn read_log(path: &Path) -> Result<(Vec<LogLine>, usize), Error> {
    let no_log = || Error::chart(path, ChartError::NoLog);
    let content = String::from_utf8(files::read_text(path)?).map_err(|_| no_log())?;
    let mut lines = content.lines();
    let head: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    if head != COLUMNS && head != COLUMNS[..FIRST_COLUMNS] {
        return Err(no_log());
    }
    let all: Vec<Option<LogLine>> = lines.map(|line| LogLine::from_cells(&record(line)?)).collect();
    let torn = all.iter().filter(|l| l.is_none()).count();
    Ok((all.into_iter().flatten().collect(), torn))
}

#[cfg(test)]
mod tests {
    use super::super::history;
    use super::*;

    fn line(mean: f64) -> LogLine {
        LogLine {
            date: "2026-05-01".into(),
            file: "a.nef".into(),
            camera: "Nikon, D700".into(),
            light: "D50".into(),
            de2000: Summary { mean, median: mean, p95: 2.0 * mean, max: 3.0 * mean },
            white: [0.3, 0.6, 0.4],
            outcome: if mean < 1.0 { Outcome::Passed } else { Outcome::Failed },
            profile: "p.toml".into(),
            preset: "fadgi-4star".into(),
            limits: "mean 2".into(),
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
        assert_eq!((lines, torn), (vec![line(0.5), line(1.5)], 1));
    }

    #[test]
    fn a_log_of_before_is_read_and_continued() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log.csv");
        let old =
            "2026-05-01,a.nef,Nikon D700,D50,0.5000,0.5000,1.0000,1.5000,0.300000,0.600000,0.400000,pass\n";
        let head = COLUMNS[..FIRST_COLUMNS].join(",");
        std::fs::write(&path, head + "\n" + old + "2026-05-02,\"b.nef,Nik\n" + old).unwrap();
        let (before, torn) = read_log(&path).unwrap();
        assert_eq!((before.len(), torn), (2, 1));
        assert!((before[1].de2000.max - 1.5).abs() < 1e-9 && before[1].camera == "Nikon D700");
        append(&path, &line(1.5)).unwrap();
        let (lines, torn) = read_log(&path).unwrap();
        assert_eq!((lines.len(), torn, &lines[..2], &lines[2]), (3, 1, &before[..], &line(1.5)));
        let page = history(&lines);
        assert!(page.contains("3 shots, 1 failed") && page.matches("<circle").count() == 15);
    }

    #[test]
    fn no_cell_is_a_formula_or_a_second_line() {
        let evil = LogLine {
            camera: "=HYPERLINK(\"http://x\",\"y\")".into(),
            light: "@SUM(1)".into(),
            profile: "-2+3\n=1".into(),
            file: "+a\u{1b}[2J.nef".into(),
            date: "'quoted".into(),
            ..line(0.5)
        };
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log.csv");
        append(&path, &evil).unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(text.lines().count() == 2 && !text.contains('\u{1b}'), "{text}");
        let row = record(text.lines().nth(1).unwrap()).unwrap();
        assert!(row.iter().all(|cell| !cell.starts_with(['=', '+', '-', '@'])), "{text}");
        let (lines, _) = read_log(&path).unwrap();
        assert_eq!(
            (&lines[0].camera, &lines[0].light, &lines[0].date),
            (&evil.camera, &evil.light, &evil.date)
        );
    }
}
