//! How much memory a file takes.

use std::path::PathBuf;

use darkroot_encode::Format;

use darkroot::settings::{Engine, Settings};
use darkroot_develop::{Bits, DenoiseBy};

/// What a worker holds besides pictures: program, profiles, stacks, the tiles of one thread.
pub(crate) const WORKER: u64 = 40 << 20;
/// Tiles of one more thread.
const THREAD: u64 = 12 << 20;

/// Bytes for reading a file and what stands at its head.
pub(crate) fn head(file: u64) -> u64 {
    WORKER + 2 * file
}

/// Bytes that a worker holds at most while it develops a file of so many bytes and samples. Measured for every format with
/// the operating system's count (a test of the program holds it to that): the file and its samples, then the samples and the
/// picture, then the picture and what its encoder keeps.
pub(crate) fn develop(
    file: u64,
    samples: u64,
    float: bool,
    pixels: u64,
    settings: &Settings,
    format: Format,
) -> u64 {
    let bits = settings.resolve(format).map_or(Bits::Sixteen, |recipe| recipe.output.bits);
    let picture = 3
        * pixels
        * match bits {
            Bits::Eight => 1,
            Bits::Sixteen => 2,
            Bits::Float => 4,
        };
    // The embedded JPEG has three colours a pixel; it may be as large as the frame.
    let (samples, float) = if settings.from_preview { (3 * pixels, false) } else { (samples, float) };
    // flashraw gives 16-bit counts; floating point is kept as such.
    let counts = samples * if float { 4 } else { 2 };
    // Dark frames, then flats, beside the photograph; one more while it is decoded.
    let frames = |path: &Option<PathBuf>| {
        let named = path.as_ref().and_then(|path| darkroot::frames::named(path).ok());
        named.map_or(0, |frames| (frames.len() as u64 + 1) * counts + file)
    };
    let beside = frames(&settings.dark).max(frames(&settings.flat));
    let decode = file + 2 * counts + beside;
    // Noise of the coarse scales, and what it is looked for in.
    let noise =
        2 * pixels + if settings.recipe.denoise.by == DenoiseBy::Likeness { likeness(pixels) } else { 0 };
    if settings.encode.progressive && format == Format::Jpeg {
        // The whole picture, its coefficients, and the file.
        return WORKER + THREAD + decode.max(counts + noise + 4 * picture);
    }
    if format.takes_bands() && settings.engine == Engine::Darkroot {
        // A few bands of rows, and what they became; two small pictures for a gain map.
        let small = if settings.hdr > 0.0 { 2 * pixels } else { 0 };
        return WORKER + THREAD + decode.max(counts + noise + picture / 16 + small);
    }
    // Floating point, and what becomes of it, in place of bytes.
    let absolute = if settings.hdr > 0.0 { 18 * pixels } else { 0 };
    let render = counts + noise + picture.max(absolute);
    let encode = absolute + picture + encoder(format, bits, picture, pixels);
    WORKER + THREAD + decode.max(render).max(encode)
}

/// What taking noise away by likeness holds: light of the whole frame, and for 1150 rows of it what is looked at.
fn likeness(pixels: u64) -> u64 {
    let width = (pixels * 3 / 2).isqrt();
    4 * pixels + 17 * pixels.min(1150 * width)
}

/// What an encoder holds beside the picture.
fn encoder(format: Format, bits: Bits, picture: u64, pixels: u64) -> u64 {
    match format {
        // Bands that wait for those above them.
        Format::Jpeg | Format::Png | Format::Tiff | Format::Dng => picture / 2,
        Format::Webp => 5 * pixels,
        Format::Avif => 40 * pixels,
        Format::Exr => picture / 8,
        Format::Jxl if bits == Bits::Eight => 6 * pixels,
        Format::Jxl => 18 * pixels,
    }
}

/// Bytes for looking for charts and measuring one: samples, linear light in floating point, a smaller picture.
pub(crate) fn chart(file: u64, samples: u64, pixels: u64) -> u64 {
    WORKER + file + 2 * samples + 4 * samples + 12 * pixels
}
