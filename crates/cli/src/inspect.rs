//! `darkroot inspect`.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::PathBuf;

use anyhow::Result;
use clap::Args;
use clap::builder::TypedValueParser;
use darkroot::{Inspection, Key, ProfileStore, Settings, settings};
use darkroot_raw::Decoder;

use crate::deadline::Deadline;
use crate::sandbox::{self, Sandbox};
use crate::{Common, Outcome, picture};
use darkroot::shown;

/// Say what a raw file is: camera, levels, white balance, matrices, clipping
#[derive(Debug, Args)]
pub(crate) struct Inspect {
    /// Raw files
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,

    /// One line of JSON for each file
    #[arg(long)]
    json: bool,

    /// Add the hash and the mean of the decoded samples
    #[arg(long)]
    samples_hash: bool,

    /// Write the embedded JPEG preview of the one FILE to OUT, as it is stored, and say nothing else
    #[arg(long, value_name = "OUT")]
    preview: Option<PathBuf>,

    /// Replace an existing preview file
    #[arg(long, requires = "preview")]
    overwrite: bool,

    /// Library that decodes the samples
    #[arg(long, default_value = "flashraw", value_parser = decoder())]
    decoder: Decoder,

    #[command(flatten)]
    deadline: Deadline,

    #[command(flatten)]
    sandbox: Sandbox,
}

fn decoder() -> impl TypedValueParser<Value = Decoder> {
    picture::words(Key::named("decoder")).try_map(|text| settings::text::decoder(&text))
}

impl Inspect {
    pub(crate) fn run(self, common: Common) -> Result<Outcome> {
        self.sandbox.say(common);
        let reach = sandbox::reading(&self.files);
        if let Some(out) = &self.preview {
            let [file] = &self.files[..] else {
                anyhow::bail!("`--preview` takes the preview of one file; name one file");
            };
            self.sandbox.confine(&sandbox::writing(reach, out))?;
            common.start_threads();
            let saved =
                self.deadline.over(file, 0, |_| (), || darkroot::save_preview(file, out, self.overwrite));
            return Ok(match saved {
                Ok(preview) => {
                    crate::say(format_args!(
                        "{}: {} x {} pixels",
                        shown(out),
                        preview.size.width,
                        preview.size.height
                    ));
                    Outcome::Done
                }
                Err(error) => {
                    crate::say(format_args!("error: {}", crate::hint::words(&error)));
                    Outcome::SomeFailed
                }
            });
        }
        let settings = Settings { decoder: self.decoder, ..Settings::default() };
        let store = ProfileStore::of_user();
        self.sandbox.confine(&reach)?;
        common.start_threads();
        let mut outcome = Outcome::Done;
        for (number, file) in self.files.iter().enumerate() {
            let after = self.files.len() - number - 1;
            let look = || darkroot::inspect(file, &settings, &store, self.samples_hash);
            match self.deadline.over(file, after, |_| (), look) {
                Ok(inspection) => {
                    let text = if self.json {
                        serde_json::to_string(&inspection)? + "\n"
                    } else {
                        words(&inspection)
                    };
                    let mut out = if self.json { crate::out::json() } else { crate::out::lines() };
                    out.write_all(text.as_bytes())?;
                }
                Err(error) => {
                    crate::say(format_args!("error: {}", crate::hint::words(&error)));
                    outcome = Outcome::SomeFailed;
                }
            }
        }
        Ok(outcome)
    }
}

/// The facts for a person.
fn words(i: &Inspection) -> String {
    let mut text = String::new();
    // Writing to a String cannot fail.
    let mut line = |name: &str, value: String| {
        if !value.is_empty() {
            let _ = writeln!(text, "{name:<16}{}", shown(&value));
        }
    };
    line("file", shown(&i.input));
    line("camera", i.camera.clone());
    line("stored as", format!("{}, {}, {} bits ({})", i.format, i.compression, i.bits, i.decoder));
    let [x, y, w, h] = i.crop;
    line(
        "size",
        format!(
            "{w} x {h} at {x},{y} of a frame of {} x {}; orientation {}",
            i.frame[0], i.frame[1], i.orientation
        ),
    );
    line("filters", i.filters.clone());
    let deltas = if i.black_deltas { " (and deltas by row or column)" } else { "" };
    line("black level", format!("{}{deltas}", list(&i.black)));
    line("white level", list(&i.white));
    if let Some([r, g, b]) = i.multipliers {
        let light = match (i.kelvin, i.tint) {
            (Some(kelvin), Some(tint)) => format!(" ({kelvin:.0} K, tint {tint:+.0})"),
            _ => String::new(),
        };
        line("white balance", format!("{r:.4} {g:.4} {b:.4}{light}"));
    }
    for c in &i.calibrations {
        let light = c.kelvin.map_or("unknown light".to_owned(), |k| format!("{k:.0} K"));
        line("color matrix", format!("{light}: {}", matrix(&c.color_matrix)));
        if let Some(forward) = &c.forward_matrix {
            line("forward matrix", format!("{light}: {}", matrix(forward)));
        }
    }
    if i.baseline_exposure != 0.0 {
        line("baseline", format!("{:+.2} stops", i.baseline_exposure));
    }
    if i.corrections != [0, 0] {
        line(
            "corrections",
            format!("{} before and {} after demosaicing", i.corrections[0], i.corrections[1]),
        );
    }
    line("profile", i.profile.clone().unwrap_or_else(|| "none; the camera's matrix serves".to_owned()));
    let shot = &i.shot;
    line("date", shot.date.clone().unwrap_or_default());
    let mut exposure = Vec::new();
    exposure.extend(
        shot.exposure_time.map(|t| if t < 0.4 { format!("1/{:.0} s", 1.0 / t) } else { format!("{t:.1} s") }),
    );
    exposure.extend(shot.f_number.map(|f| format!("f/{f:.1}")));
    exposure.extend(shot.iso.map(|iso| format!("ISO {iso:.0}")));
    exposure.extend(shot.focal_length.map(|f| format!("{f:.0} mm")));
    line("exposure", exposure.join(", "));
    line("lens", shot.lens.clone().unwrap_or_default());
    line("artist", shot.artist.clone().unwrap_or_default());
    line("copyright", shot.copyright.clone().unwrap_or_default());
    if i.saturation.iter().any(|s| *s < 1.0) {
        let [r, g, b] = i.saturation.map(|s| format!("{:.1} %", s * 100.0));
        line("clips at", format!("red {r}, green {g}, blue {b} of the white level"));
    }
    line("blur", i.blur.map(|blur| format!("{blur:.2} pixels where it is sharpest")).unwrap_or_default());
    let [r, g, b] = i.clipped.map(|share| format!("{:.3} %", share * 100.0));
    line("clipped", format!("red {r}, green {g}, blue {b}"));
    if let (Some(hash), Some(mean)) = (&i.samples_hash, i.samples_mean) {
        line("samples", format!("{hash} mean={mean:.3}"));
    }
    for note in &i.notes {
        line("note", note.clone());
    }
    for (name, counts) in ["red", "green", "blue"].iter().zip(&i.histogram) {
        line(name, bars(counts));
    }
    line("", "black ^ square root of light, 64 steps".to_owned() + &" ".repeat(16) + "saturated ^");
    text
}

fn list(values: &[f32]) -> String {
    let same = values.windows(2).all(|w| (w[0] - w[1]).abs() < 1e-6);
    let shown = if same { &values[..values.len().min(1)] } else { values };
    shown.iter().map(f32::to_string).collect::<Vec<_>>().join(" ")
}

fn matrix(m: &[f64; 9]) -> String {
    m.chunks(3).map(|r| format!("{:.4} {:.4} {:.4}", r[0], r[1], r[2])).collect::<Vec<_>>().join(" | ")
}

/// A histogram as one line of bars, by the fourth root of the counts so that small ones show.
fn bars(counts: &[u64]) -> String {
    const BARS: [char; 9] = [' ', '▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];
    let most = counts.iter().copied().max().unwrap_or(0).max(1) as f64;
    let bar = |&n: &u64| BARS[((n as f64 / most).powf(0.25) * 8.0).round() as usize];
    counts.iter().map(bar).collect()
}
