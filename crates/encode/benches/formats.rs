//! Encoding on one thread, in megapixels per second (criterion shows Melem/s): `cargo bench -p darkroot-encode`.

#![allow(missing_docs, clippy::expect_used)] // Criterion's macros document nothing; a bench may stop.

use std::hint::black_box;
use std::io::Cursor;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use darkroot_colour::RgbSpace;
use darkroot_encode::{ChromaSubsampling, Format, Options, write};
use darkroot_photo::{Metadata, Picture, PictureSpace, Samples, Size};

const SIZE: Size = Size { width: 2048, height: 1024 };

/// Smooth shading, edges and a little noise, as photographs have them.
fn picture() -> Picture {
    let sample = |i: usize| {
        let (x, y, channel) = (i / 3 % SIZE.width, i / 3 / SIZE.width, i % 3);
        let edge = if (x / 37 + y / 23) % 3 == 0 { 120 } else { 40 };
        let noise = (x * 7919 + y * 104_729 + channel * 31 + x * y % 13) % 7;
        (edge + 60 * x / SIZE.width + 10 * channel + noise) as u8
    };
    let samples = (0..3 * SIZE.area()).map(sample).collect();
    Picture { size: SIZE, samples: Samples::U8(samples), space: PictureSpace::Rgb(RgbSpace::SRGB) }
}

fn formats(c: &mut Criterion) {
    let mut group = c.benchmark_group("formats");
    group.sample_size(20).throughput(Throughput::Elements(SIZE.area() as u64));
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    let picture = picture();
    for (name, subsampling) in
        [("JPEG, 4:4:4", ChromaSubsampling::S444), ("JPEG, 4:2:0", ChromaSubsampling::S420)]
    {
        let options = Options { subsampling, ..Options::default() };
        let mut file = Cursor::new(Vec::new());
        group.bench_function(name, |b| {
            b.iter(|| {
                file.set_position(0);
                one.install(|| {
                    write(black_box(&picture), Format::Jpeg, &options, &Metadata::default(), &mut file)
                })
                .expect("a picture that fits")
            })
        });
    }
    group.finish();
}

criterion_group!(benches, formats);
criterion_main!(benches);
