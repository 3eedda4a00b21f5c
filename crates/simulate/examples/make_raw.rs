//! Writes one simulated raw file of any size, for benches and for tests against other decoders.
//!
//! `cargo run --release -p darkroot-simulate --example make_raw -- --format nef --width 6000 --height 4000 --out a.nef`

use std::path::PathBuf;
use std::process::ExitCode;

use darkroot_colour::Spectrum;
use darkroot_photo::{AsShot, Capture, Counts, Layout, Orientation, Size};
use darkroot_simulate::expose::expose;
use darkroot_simulate::{Camera, Exposure, Scene, camera, dng, nef, samples};

const USAGE: &str = "make_raw --format nef|dng --width W --height H --out PATH
  [--scene still-life|flat|ramp|gradient] [--cfa RGGB|...|xtrans] [--linear] [--bits 12|14]
  [--storage uncompressed|jpeg-strip|jpeg-tiles|lossless|lossy|lossy-split|packed-highest|packed-lowest]
  [--stops S] [--no-noise]
  [--kelvin K (daylight, 4000 to 25000) | --tungsten] [--orientation 1..8] [--masked COLUMNSxROWS]
  [--counts PATH (the samples, as 16-bit little-endian numbers)]";

struct Args {
    format: String,
    storage: String,
    scene: String,
    size: Size,
    layout: Option<Layout>,
    bits: u8,
    masked: (usize, usize),
    exposure: Exposure,
    out: PathBuf,
    counts: Option<PathBuf>,
}

fn main() -> ExitCode {
    match parse(std::env::args().skip(1)).and_then(|args| run(&args)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

fn run(args: &Args) -> Result<(), String> {
    let mut camera = match (args.format.as_str(), args.bits) {
        ("nef", 12) => Camera::nikon_d750_12_bit(),
        ("nef", _) => Camera::nikon_d750(),
        _ => Camera::simulated_one(),
    };
    camera.masked = args.masked;
    if let Some(layout) = &args.layout {
        camera.layout = layout.clone();
    }
    let scene = match args.scene.as_str() {
        "flat" => Scene::flat(args.size, Spectrum::constant(0.18)),
        "ramp" => Scene::ramp(args.size, Spectrum::constant(0.9), -12.0, 1.0),
        "gradient" => Scene::gradient(args.size),
        _ => Scene::still_life(args.size),
    };
    let capture = expose(&scene, &camera, &args.exposure);
    let bytes = match (args.format.as_str(), args.storage.as_str()) {
        ("nef", "uncompressed") => nef::write(&capture, nef::Storage::Uncompressed),
        ("nef", "packed-highest") => nef::write(&capture, nef::Storage::PackedHighestFirst),
        ("nef", "packed-lowest") => nef::write(&capture, nef::Storage::PackedLowestFirst),
        ("nef", "lossy") => nef::write(&capture, nef::Storage::Lossy),
        ("nef", "lossy-split") => nef::write(&capture, nef::Storage::LossyWithSplit),
        ("nef", _) => nef::write(&capture, nef::Storage::Lossless),
        (_, "uncompressed") => Some(dng::write(&capture, dng::Storage::Uncompressed)),
        (_, "jpeg-strip") => Some(dng::write(&capture, dng::Storage::JpegStrip)),
        _ => Some(dng::write(&capture, dng::Storage::JpegTiles)),
    };
    let bytes = bytes.ok_or("A NEF holds 12 or 14 bits under a 2x2 filter array, of even width.")?;
    save(&args.out, &bytes)?;
    if let (Some(path), Counts::U16(mosaic)) = (&args.counts, &capture.counts) {
        save(path, &mosaic.samples.iter().flat_map(|s| s.to_le_bytes()).collect::<Vec<u8>>())?;
    }
    eprintln!("{}: {}", args.out.display(), facts(&capture));
    Ok(())
}

fn facts(capture: &Capture) -> String {
    let neutral = match capture.as_shot {
        Some(AsShot::Neutral(n)) => n,
        _ => [1.0; 3],
    };
    format!(
        "{}, {:?}, black {}, white {}, neutral {:.6} {:.6} {:.6}",
        capture.camera.name(),
        capture.counts.size(),
        capture.black.mean(),
        capture.white.0[0],
        neutral[0],
        neutral[1],
        neutral[2]
    )
}

fn save(path: &PathBuf, bytes: &[u8]) -> Result<(), String> {
    std::fs::write(path, bytes).map_err(|e| format!("{}: {e}", path.display()))
}

fn parse(mut words: impl Iterator<Item = String>) -> Result<Args, String> {
    let mut args = Args {
        format: "dng".to_owned(),
        storage: String::new(),
        scene: "still-life".to_owned(),
        size: Size { width: 720, height: 480 },
        layout: None,
        bits: 14,
        masked: (0, 0),
        exposure: samples::exposure(1),
        out: PathBuf::new(),
        counts: None,
    };
    while let Some(option) = words.next() {
        let mut value = || words.next().ok_or_else(|| format!("{option} needs a value\n{USAGE}"));
        match option.as_str() {
            "--format" => args.format = value()?,
            "--storage" => args.storage = value()?,
            "--scene" => args.scene = value()?,
            "--width" => args.size.width = number(&value()?)?,
            "--height" => args.size.height = number(&value()?)?,
            "--bits" => args.bits = number(&value()?)?,
            "--cfa" => {
                let letters = value()?;
                args.layout =
                    Some(if letters == "xtrans" { camera::x_trans() } else { camera::filters(&letters) });
            }
            "--linear" => args.layout = Some(Layout::Rgb),
            "--masked" => {
                let text = value()?;
                let (columns, rows) = text.split_once('x').ok_or(USAGE)?;
                args.masked = (number(columns)?, number(rows)?);
            }
            "--stops" => args.exposure.stops = number(&value()?)?,
            "--kelvin" => args.exposure.light = Spectrum::daylight(number(&value()?)?),
            "--tungsten" => args.exposure.light = Spectrum::illuminant_a(),
            "--orientation" => args.exposure.orientation = Orientation::from_exif(number(&value()?)?),
            "--no-noise" => args.exposure.noise = None,
            "--out" => args.out = value()?.into(),
            "--counts" => args.counts = Some(value()?.into()),
            _ => return Err(format!("{option}?\n{USAGE}")),
        }
    }
    if args.out.as_os_str().is_empty() { Err(USAGE.to_owned()) } else { Ok(args) }
}

fn number<T: std::str::FromStr>(text: &str) -> Result<T, String> {
    text.parse().map_err(|_| format!("{text} is not a number that fits\n{USAGE}"))
}
