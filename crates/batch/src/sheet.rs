//! The report of a run: JSON for programs, and a contact sheet as one HTML page, failures first.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use darkroot::page::page;
use darkroot::{Error, VERSION, path_text, write_text};
use maud::{Markup, html};
use serde_json::json;

use super::causes::{causes, in_page};
use super::item::{BatchPlan, Item, State};
use super::journal;
use super::names::key_shown;
use super::outcome::{Event, Summary};
use darkroot::shown;

/// How the page looks.
const STYLE: &str = include_str!("sheet.css");

/// Collects what happened. Small pictures wait in a temporary file, so memory stays flat over thousands of files.
#[derive(Debug)]
pub struct Sheet {
    html: Vec<PathBuf>,
    json: Vec<PathBuf>,
    rows: Vec<Row>,
    pictures: Option<File>,
    /// Why the run was stopped, in words.
    stopped: Option<String>,
}

/// Why there is no report.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SheetError {
    /// A name that tells of no kind of report.
    #[error("{path}: cannot be written: a report ends in .html or .json", path = shown(path))]
    Ending {
        /// The report.
        path: PathBuf,
    },
    /// A place that cannot be written.
    #[error(transparent)]
    Write(#[from] Error),
}

/// What became of a file.
#[derive(Debug, Clone, Default)]
struct Row {
    /// Key of its input.
    input: String,
    output: String,
    error: Option<String>,
    words: String,
    json: Option<serde_json::Value>,
    /// Place and length of its picture in the temporary file.
    picture: Option<(u64, usize)>,
}

impl Sheet {
    /// For reports at these places: `.html` is a contact sheet, `.json` for programs.
    ///
    /// # Errors
    /// Another ending, or no room for the small pictures.
    pub fn new(places: &[PathBuf]) -> Result<Self, SheetError> {
        let mut sheet =
            Self { html: Vec::new(), json: Vec::new(), rows: Vec::new(), pictures: None, stopped: None };
        for place in places {
            match place.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase).as_deref() {
                Some("html" | "htm") => sheet.html.push(place.clone()),
                Some("json") => sheet.json.push(place.clone()),
                _ => return Err(SheetError::Ending { path: place.clone() }),
            }
        }
        if let Some(place) = sheet.html.first() {
            sheet.pictures = Some(tempfile::tempfile().map_err(|e| Error::write(place, e))?);
        }
        Ok(sheet)
    }

    /// Whether small pictures are shown.
    pub fn wants_thumbnails(&self) -> bool {
        self.pictures.is_some()
    }

    fn is_wanted(&self) -> bool {
        !self.html.is_empty() || !self.json.is_empty()
    }

    /// Takes note of an event.
    pub fn record(&mut self, event: &Event<'_>) {
        if !self.is_wanted() {
            return;
        }
        match event {
            Event::Done { item, done, colours, thumbnail } => {
                let mut words = format!("{} × {}, {:.2} s; {colours}", done.width, done.height, done.seconds);
                for note in &done.notes {
                    words += "; ";
                    words += note;
                }
                let picture = thumbnail.and_then(|t| self.keep(t));
                let json = serde_json::to_value(done).ok();
                self.rows.push(Row { words, json, picture, ..row(item) });
            }
            Event::Failed { item, words, .. } => {
                self.rows.push(Row { error: Some((*words).to_owned()), ..row(item) });
            }
            Event::Stopping { words, .. } => self.stopped = Some((*words).to_owned()),
            Event::Begun(_) | Event::Later(_) | Event::Gone(_) => {}
        }
    }

    /// The small picture of an output that was done before.
    pub fn picture(&mut self, item: &Item, picture: &str) {
        let picture = self.keep(picture);
        self.rows.push(Row { picture, words: "unchanged".into(), ..row(item) });
    }

    /// Keeps a picture; without room for it the sheet goes without.
    fn keep(&mut self, picture: &str) -> Option<(u64, usize)> {
        let file = self.pictures.as_mut()?;
        let at = file.seek(SeekFrom::End(0)).ok()?;
        file.write_all(picture.as_bytes()).ok()?;
        Some((at, picture.len()))
    }

    /// Writes the reports.
    ///
    /// # Errors
    /// Places that cannot be written.
    pub fn write(&mut self, plan: &BatchPlan, summary: &Summary) -> Result<(), Error> {
        if !self.is_wanted() {
            return Ok(());
        }
        let told: std::collections::HashSet<String> = self.rows.iter().map(|r| r.input.clone()).collect();
        for item in plan.items.iter().filter(|i| !told.contains(&i.source.key)) {
            let words = if matches!(item.state, State::Done(_)) { "unchanged" } else { "left to do" };
            self.rows.push(Row { words: words.into(), ..row(item) });
        }
        let place = plan.items.iter().map(|i| i.source.key.as_str());
        let order: std::collections::HashMap<&str, usize> = place.enumerate().map(|(i, k)| (k, i)).collect();
        self.rows.sort_by_key(|r| (r.error.is_none(), order.get(r.input.as_str()).copied()));
        for path in &self.json {
            write_text(path, &self.to_json(plan, summary), true)?;
        }
        for path in self.html.clone() {
            let page = self.page(plan, summary, &path).map_err(|e| Error::write(&path, e))?;
            write_text(&path, &page, true)?;
        }
        Ok(())
    }

    /// Key of the input and sentence of every file that failed.
    fn failures(&self) -> Vec<(&str, &str)> {
        self.rows.iter().filter_map(|row| Some((row.input.as_str(), row.error.as_deref()?))).collect()
    }

    fn to_json(&self, plan: &BatchPlan, summary: &Summary) -> String {
        let row = |row: &Row| {
            let status = match (&row.error, row.words.as_str()) {
                (Some(_), _) => "failed",
                (None, "unchanged") => "unchanged",
                (None, "left to do") => "left",
                _ => "done",
            };
            json!({
                "input": row.input, "output": row.output, "status": status, "error": row.error,
                "journal": row.json,
            })
        };
        let value = json!({
            "program": format!("darkroot {VERSION}"),
            "at": journal::now(),
            "output_folder": path_text::text(&plan.out),
            "done": summary.done, "failed": summary.failed, "unchanged": summary.skipped,
            "left": summary.left, "stopped": self.stopped, "interrupted": summary.interrupted,
            "seconds": summary.seconds, "megapixels": summary.pixels as f64 / 1e6,
            "faults": plan.faults.iter().map(ToString::to_string).collect::<Vec<_>>(),
            "left_out": plan.left_out.iter().map(|left| json!({
                "input": left.input, "instead": left.instead, "output": left.output,
            })).collect::<Vec<_>>(),
            "causes": causes(&self.failures()).into_iter().map(|(cause, files)| json!({
                "cause": cause, "files": files,
            })).collect::<Vec<_>>(),
            "files": self.rows.iter().map(row).collect::<Vec<_>>(),
        });
        format!("{value:#}\n")
    }

    fn page(&mut self, plan: &BatchPlan, summary: &Summary, place: &Path) -> io::Result<String> {
        let base = place.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let mut figures = Vec::new();
        for row in self.rows.iter().filter(|r| r.error.is_none()) {
            let picture = match (row.picture, self.pictures.as_mut()) {
                (Some(place), Some(file)) => Some(kept(file, place)?),
                _ => None,
            };
            figures.push(figure(
                row,
                &link(base, &plan.out.join(path_text::path(&row.output))),
                picture.as_deref(),
            ));
        }
        let faults: Vec<String> = plan.faults.iter().map(ToString::to_string).collect();
        let failures = self.failures();
        let causes = causes(&failures);
        let body = html! {
            header { (head(plan, summary, self.stopped.as_deref())) }
            @if !faults.is_empty() || !causes.is_empty() {
                section.failures {
                    h2 { "Failed" }
                    @if !faults.is_empty() { ul { @for words in faults { li { (words) } } } }
                    @for (cause, files) in causes { (in_page(cause, &files)) }
                }
            }
            @if !plan.left_out.is_empty() {
                section { h2 { "Left out" } ul { @for left in &plan.left_out { li { (left.words()) } } } }
            }
            main { @for figure in figures { (figure) } }
        };
        let pictures = summary.done + summary.skipped;
        let title = format!("{pictures} pictures in {}", shown(&plan.out));
        Ok(page(&title, STYLE, body))
    }
}

/// What the page begins with: the folder and the run's figures.
fn head(plan: &BatchPlan, summary: &Summary, stopped: Option<&str>) -> Markup {
    let Summary { done, failed, skipped, left, seconds, pixels, .. } = summary;
    let mega = format!("{:.0}", *pixels as f64 / 1e6);
    html! {
        h1 { (shown(&plan.out)) }
        p { "darkroot " (VERSION) ", " (journal::now()) }
        dl {
            div { dt { "developed" } dd { (done) } }
            div { dt { "unchanged" } dd { (skipped) } }
            div.bad[*failed > 0] { dt { "failed" } dd { (failed) } }
            div.bad[*left > 0] { dt { "left" } dd { (left) } }
            div { dt { "megapixels" } dd { (mega) } }
            div { dt { "seconds" } dd { (format!("{seconds:.0}")) } }
        }
        @if let Some(reason) = stopped {
            p.bad { "Stopped: " (reason) }
        }
    }
}

/// One picture of the page. `picture` is a small JPEG as base 64.
fn figure(row: &Row, link: &str, picture: Option<&str>) -> Markup {
    html! {
        figure {
            a href=(link) {
                @match picture {
                    Some(jpeg) => img alt="" loading="lazy" src={ "data:image/jpeg;base64," (jpeg) };,
                    None => span.none { "no preview" },
                }
            }
            figcaption { b { (key_shown(&row.output)) } span { (row.words) } }
        }
    }
}

/// Reads a picture back from the temporary file.
fn kept(file: &mut File, (at, length): (u64, usize)) -> io::Result<String> {
    let mut text = vec![0; length];
    file.seek(SeekFrom::Start(at))?;
    file.read_exact(&mut text)?;
    Ok(String::from_utf8_lossy(&text).into_owned())
}

fn row(item: &Item) -> Row {
    Row { input: item.source.key.clone(), output: item.output.clone(), ..Row::default() }
}

/// A link from a page in `base` to a file: relative where the file lies below, so that both can be moved together.
fn link(base: &Path, file: &Path) -> String {
    let absolute = |p: &Path| std::path::absolute(p).unwrap_or_else(|_| p.to_owned());
    let (base, file) = (absolute(base), absolute(file));
    let (prefix, path) = match file.strip_prefix(&base) {
        Ok(below) => ("", below),
        Err(_) => ("file://", file.as_path()),
    };
    let bytes = path.as_os_str().as_encoded_bytes();
    let encoded: String = bytes
        .iter()
        .map(|&b| match b {
            b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'/' | b'.' | b'-' | b'_' | b'~' => {
                char::from(b).to_string()
            }
            _ => format!("%{b:02X}"),
        })
        .collect();
    format!("{prefix}{encoded}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_lead_to_the_file_from_anywhere() {
        assert_eq!(link(Path::new("/a/b"), Path::new("/a/b/c d/é.jpg")), "c%20d/%C3%A9.jpg");
        assert_eq!(link(Path::new("/a/b"), Path::new("/x/y.jpg")), "file:///x/y.jpg");
    }

    #[test]
    fn texts_in_the_page_are_escaped() {
        let row = Row { output: "a<b>&.jpg".into(), words: "\"x\"".into(), ..Row::default() };
        let page = figure(&row, "a%3Cb%3E%26.jpg", None).into_string();
        assert!(page.contains("<b>a&lt;b&gt;&amp;.jpg</b>") && page.contains("no preview"), "{page}");
    }

    #[test]
    fn other_endings_are_refused() {
        assert!(Sheet::new(&["report.pdf".into()]).unwrap_err().to_string().contains(".html"));
    }
}
