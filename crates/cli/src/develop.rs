//! `darkroot develop`.

use std::io::Write;
use std::path::PathBuf;

use anyhow::Result;
use clap::{Args, ValueEnum};
use darkroot::{
    ChromaSubsampling, EncodeOptions, Engine, Format, Job, ProfileChoice, ProfileStore, Report, Settings,
    Target, plan_outputs,
};
use develop::{Balance, Bits, Crop, Demosaic, Exposure, Highlights, Look, OutputSpace, Recipe};
use raw::Decoder;

use crate::progress::Progress;
use crate::{Common, Outcome, values};

/// Develop raw photographs into pictures
///
/// Without options every FILE becomes a JPEG in sRGB beside it. The output's ending, or --format, chooses
/// another format.
#[derive(Debug, Args)]
pub(crate) struct Develop {
    /// Raw files (NEF, DNG, CR2, ARW, RAF, ...)
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,

    /// Where to write: a file, a folder, or a name with {stem} {ext} {parent} {camera} {date} {seq}
    #[arg(short, long, value_name = "OUT", help_heading = "Output")]
    output: Option<String>,

    /// Format, where the output's ending does not say it
    #[arg(long, value_enum, help_heading = "Output")]
    format: Option<FormatName>,

    /// Replace outputs that exist
    #[arg(long, help_heading = "Output")]
    overwrite: bool,

    /// Colour space: srgb, display-p3, adobe-rgb, prophoto, rec2020, ecirgb-v2, each also with -linear;
    /// aces2065-1; camera (linear camera RGB before any profile)
    #[arg(long, value_parser = values::space, help_heading = "Output")]
    space: Option<OutputSpace>,

    /// Bits a sample; 32 is floating point
    #[arg(long, value_enum, help_heading = "Output")]
    bits: Option<BitsName>,

    /// Quality of JPEG and AVIF, 1 to 100
    #[arg(long, value_name = "N", default_value_t = 92, value_parser = clap::value_parser!(u8).range(1..=100),
          help_heading = "Output")]
    quality: u8,

    /// Chroma subsampling of JPEG
    #[arg(long, value_enum, default_value = "444", help_heading = "Output")]
    chroma: ChromaName,

    /// Exposure in stops: 1 is twice the light
    #[arg(long, value_name = "EV", default_value = "0", allow_hyphen_values = true, value_parser = values::stops,
          help_heading = "Picture")]
    exposure: f64,

    /// Choose the exposure from the picture
    #[arg(long, help_heading = "Picture")]
    auto_exposure: bool,

    /// as-shot, daylight, auto, 5200K, 5200K,+8 (tint), spot:X,Y[,SIDE] (grey in the picture), or R,G,B
    #[arg(long, visible_alias = "wb", value_name = "WB", default_value = "as-shot", value_parser = values::balance,
          help_heading = "Picture")]
    white_balance: Balance,

    /// Rendering from scene to display; linear is strict: numbers proportional to light, nothing automatic
    #[arg(long, value_enum, default_value = "neutral", help_heading = "Picture")]
    look: LookName,

    /// What becomes of clipped highlights (the linear look keeps them unless clip is asked for)
    #[arg(long, value_enum, default_value = "rebuild", help_heading = "Picture")]
    highlights: HighlightsName,

    /// How missing colours are interpolated
    #[arg(long, value_enum, default_value = "best", help_heading = "Picture")]
    demosaic: DemosaicName,

    /// Which part of the frame
    #[arg(long, value_enum, default_value = "default", help_heading = "Picture")]
    crop: CropName,

    /// Colour profile: a file, `auto` (your folder, then built in, then the file's matrices) or `matrix`
    #[arg(long, value_name = "FILE", default_value = "auto", help_heading = "Picture")]
    profile: String,

    /// Second opinion: develop with imagepipe's fixed pipeline
    #[arg(long, value_enum, default_value = "darkroot", help_heading = "Comparison")]
    engine: EngineName,

    /// Library that decodes the samples
    #[arg(long, value_enum, default_value = "flashraw", help_heading = "Comparison")]
    decoder: DecoderName,

    /// Report each file as a line of JSON on stdout
    #[arg(long)]
    json: bool,
}

impl Develop {
    /// Develops every file; one that fails does not stop the others.
    pub(crate) fn run(self, common: Common) -> Result<Outcome> {
        let mut settings = self.settings();
        let target = self.output.as_deref().map_or(Target::Beside, Target::parse);
        let named = if settings.format.is_some() { None } else { target.format()? };
        let format = settings.format.or(named).unwrap_or_else(|| settings.default_format());
        settings.format = Some(format);
        settings.resolve(format)?;
        let jobs = plan_outputs(&self.files, &target, format)?;
        if let Target::Folder(folder) = &target {
            std::fs::create_dir_all(folder).map_err(|e| {
                anyhow::anyhow!("{}: the folder cannot be made: {e}; choose another `-o`", folder.display())
            })?;
        }
        let store = match ProfileStore::user_folder() {
            Some(folder) => ProfileStore::with_user_folder(&folder),
            None => ProfileStore::builtin(),
        };
        for fault in &store.faults {
            crate::say(format_args!("warning: {fault}; it is not used"));
        }

        let progress = Progress::new(&jobs, common.quiet);
        let mut failures = 0;
        for (number, job) in jobs.iter().enumerate() {
            progress.begin(number, job);
            let result = darkroot::develop(job, &settings, &store, Some(&|step| progress.step(step)));
            match &result {
                Ok(report) if !common.quiet => progress.say(&words(report, common.verbose)),
                Ok(_) => {}
                Err(error) => progress.say(&format!("error: {error}")),
            }
            failures += usize::from(result.is_err());
            if self.json {
                print_json(job, &result)?;
            }
        }
        progress.finish();
        if failures > 0 && jobs.len() > 1 {
            crate::say(format_args!("{} of {} files failed", failures, jobs.len()));
        }
        Ok(if failures == 0 { Outcome::Done } else { Outcome::SomeFailed })
    }

    fn settings(&self) -> Settings {
        Settings {
            recipe: Recipe {
                balance: self.white_balance,
                highlights: self.highlights.into(),
                demosaic: self.demosaic.into(),
                exposure: Exposure { stops: self.exposure, auto: self.auto_exposure },
                look: self.look.into(),
                crop: self.crop.into(),
                ..Recipe::default()
            },
            space: self.space,
            bits: self.bits.map(Bits::from),
            format: self.format.map(Format::from),
            encode: EncodeOptions {
                quality: self.quality,
                subsampling: self.chroma.into(),
                ..EncodeOptions::default()
            },
            profile: match self.profile.as_str() {
                "auto" => ProfileChoice::Automatic,
                "matrix" => ProfileChoice::Matrix,
                file => ProfileChoice::File(file.into()),
            },
            engine: self.engine.into(),
            decoder: self.decoder.into(),
            overwrite: self.overwrite,
            ..Settings::default()
        }
    }
}

/// What was done to a file, for a person.
fn words(report: &Report, verbose: bool) -> String {
    let mut text = format!(
        "{} -> {} ({} x {}, {}, {} bits, {:.2} s)\n  colours: {}",
        report.input.display(),
        report.output.display(),
        report.width,
        report.height,
        report.space,
        report.bits,
        report.seconds,
        report.colours,
    );
    if let Some(profile) = &report.profile {
        text += &format!(", {profile}");
    }
    if verbose {
        let [r, g, b] = report.multipliers;
        text +=
            &format!("\n  camera: {}; decoder: {}; engine: {}", report.camera, report.decoder, report.engine);
        text += &format!("\n  white balance: {r:.3} {g:.3} {b:.3}");
        if let (Some(kelvin), Some(tint)) = (report.kelvin, report.tint) {
            text += &format!(" ({kelvin:.0} K, tint {tint:+.0})");
        }
        text += &format!("\n  demosaic: {}; exposure: x {:.3}", report.demosaic, report.gain);
    }
    for note in &report.notes {
        text += &format!("\n  note: {note}");
    }
    text
}

fn print_json(job: &Job, result: &Result<Report, darkroot::Error>) -> Result<()> {
    let line = match result {
        Ok(report) => {
            let mut line = serde_json::to_value(report)?;
            line["status"] = "done".into();
            line
        }
        Err(error) => serde_json::json!({
            "status": "failed", "input": job.input.to_string_lossy(), "output": job.output.to_string_lossy(),
            "error": error.to_string(),
        }),
    };
    writeln!(std::io::stdout(), "{line}")?;
    Ok(())
}

/// A list of words for an option, each standing for a value of the library.
macro_rules! words_for {
    ($name:ident for $target:ty { $($(#[$doc:meta])* $variant:ident = $word:literal => $value:expr,)* }) => {
        #[derive(Debug, Clone, Copy, ValueEnum)]
        pub(crate) enum $name { $($(#[$doc])* #[value(name = $word)] $variant,)* }

        impl From<$name> for $target {
            fn from(name: $name) -> Self {
                match name { $($name::$variant => $value,)* }
            }
        }
    };
}

words_for!(FormatName for Format {
    Jpeg = "jpeg" => Self::Jpeg,
    Png = "png" => Self::Png,
    Tiff = "tiff" => Self::Tiff,
    Webp = "webp" => Self::Webp,
    Avif = "avif" => Self::Avif,
    Exr = "exr" => Self::Exr,
    Jxl = "jxl" => Self::Jxl,
});
words_for!(BitsName for Bits {
    Eight = "8" => Self::Eight,
    Sixteen = "16" => Self::Sixteen,
    Float = "32" => Self::Float,
});
words_for!(ChromaName for ChromaSubsampling {
    Full = "444" => Self::S444,
    Half = "422" => Self::S422,
    Quarter = "420" => Self::S420,
});
words_for!(LookName for Look {
    /// Gentle contrast, soft highlights, colours as measured
    Neutral = "neutral" => Self::Neutral,
    /// More contrast and chroma
    Vivid = "vivid" => Self::Vivid,
    /// Low contrast, for further editing
    Flat = "flat" => Self::Flat,
    /// Strictly scene-linear, for measurement
    Linear = "linear" => Self::Linear,
});
words_for!(HighlightsName for Highlights {
    /// Estimate clipped channels from the others
    Rebuild = "rebuild" => Self::Rebuild,
    /// Cut all channels where the first one clips
    Clip = "clip" => Self::Clip,
    /// Leave the values as they are
    Keep = "keep" => Self::Keep,
});
words_for!(DemosaicName for Demosaic {
    /// The best for the sensor
    Best = "best" => Self::Best,
    /// Fast and soft
    Bilinear = "bilinear" => Self::Bilinear,
});
words_for!(CropName for Crop {
    /// What the maker shows
    Default = "default" => Self::Default,
    /// Everything that light falls on
    Active = "active" => Self::Active,
});
words_for!(EngineName for Engine {
    Darkroot = "darkroot" => Self::Darkroot,
    Imagepipe = "imagepipe" => Self::Imagepipe,
});
words_for!(DecoderName for Decoder {
    Flashraw = "flashraw" => Self::Flashraw,
    Rawloader = "rawloader" => Self::Rawloader,
});
