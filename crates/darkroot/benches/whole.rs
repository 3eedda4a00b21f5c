//! The whole job, a raw file to a JPEG, in megapixels per second (criterion shows Melem/s), with imagepipe on the
//! same file as the baseline.
//!
//! `cargo bench -p darkroot`.

#![allow(missing_docs, clippy::expect_used)] // Criterion's macros document nothing; a bench may stop.

use std::path::Path;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use darkroot::{Control, Engine, Job, ProfileStore, Settings};
use darkroot_photo::Size;
use darkroot_simulate::{Camera, Scene, dng, expose, nef, samples};

const SIZE: Size = Size { width: 3000, height: 2000 };

fn develop(input: &Path, output: &Path, engine: Engine) {
    let settings = Settings { engine, overwrite: true, ..Settings::default() };
    let job = Job { input: input.to_owned(), output: output.to_owned() };
    darkroot::develop(&job, &settings, &ProfileStore::builtin(), Control::default())
        .expect("a sound raw file");
}

fn whole(c: &mut Criterion) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let scene = Scene::still_life(SIZE);
    let nikon = expose::expose(&scene, &Camera::nikon_d750(), &samples::exposure(1));
    let one = expose::expose(&scene, &Camera::simulated_one(), &samples::exposure(2));
    let files = [
        ("NEF, lossless", nef::write(&nikon, nef::Storage::Lossless).expect("a Bayer capture")),
        ("DNG, lossless JPEG tiles", dng::write(&one, dng::Storage::JpegTiles)),
    ];
    let mut group = c.benchmark_group("raw file to JPEG");
    group.throughput(Throughput::Elements(SIZE.area() as u64));
    group.sample_size(10);
    for (name, bytes) in files {
        let input = folder.path().join("bench.raw");
        let output = folder.path().join("bench.jpg");
        std::fs::write(&input, bytes).expect("room for a raw file");
        group.bench_function(format!("{name}, darkroot"), |b| {
            b.iter(|| develop(&input, &output, Engine::Darkroot))
        });
        if cfg!(feature = "imagepipe") {
            group.bench_function(format!("{name}, imagepipe"), |b| {
                b.iter(|| develop(&input, &output, Engine::Imagepipe));
            });
        }
    }
    group.finish();
}

criterion_group!(benches, whole);
criterion_main!(benches);
