//! tmp
use encode::*;
use photo::*;
use std::time::Instant;
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let v: Vec<u16> =
        std::fs::read("/tmp/real.u16")?.chunks_exact(2).map(|b| u16::from_le_bytes([b[0], b[1]])).collect();
    let what = std::env::args().nth(1).unwrap_or_default();
    let size = Size { width: 6000, height: 4000 };
    for format in Format::ALL {
        for &bits in format.bits() {
            if !what.is_empty() && !format.name().contains(&what) {
                continue;
            }
            let samples = match bits {
                8 => Samples::U8(v.iter().map(|&x| (x / 257) as u8).collect()),
                16 => Samples::U16(v.clone()),
                _ => Samples::F32(v.iter().map(|&x| (f32::from(x) / 65535.0).powf(2.2)).collect()),
            };
            let space =
                if format == Format::Exr { colour::RgbSpace::SRGB.linear() } else { colour::RgbSpace::SRGB };
            let p = Picture { size, samples, space: PictureSpace::Rgb(space) };
            let speeds: &[u8] = if format == Format::Avif { &[8, 9, 10] } else { &[9] };
            for &s in speeds {
                let mut f = std::fs::File::create(format!("/tmp/real-{bits}.{}", format.extension()))?;
                let t = Instant::now();
                let r = write(
                    &p,
                    format,
                    &Options { avif_speed: s, ..Options::default() },
                    &Metadata::default(),
                    &mut f,
                );
                eprintln!(
                    "{:6} ms {:8} kB {format} {bits} {s} {r:?}",
                    t.elapsed().as_millis(),
                    f.metadata()?.len() / 1000
                );
            }
        }
    }
    Ok(())
}
