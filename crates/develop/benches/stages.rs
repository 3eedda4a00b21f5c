//! Every stage on one thread, in megapixels per second (criterion shows Melem/s).
//!
//! `cargo bench -p darkroot-develop`; one stage: `cargo bench -p darkroot-develop -- demosaic`.

#![allow(missing_docs, clippy::expect_used)] // Criterion's macros document nothing; a bench may stop.

use std::hint::black_box;
use std::sync::Arc;

use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use darkroot_colour::{RgbSpace, TransferCurve};
use darkroot_develop::demosaic::Method;
use darkroot_develop::gamut::Primaries;
use darkroot_develop::highlights::{Rebuild, Treatment};
use darkroot_develop::level::Levels;
use darkroot_develop::tone::{Curve, Tones};
use darkroot_develop::transfer::Encoder;
use darkroot_develop::{
    Demosaic, Look, balance, correct, demosaic, exposure, gamut, highlights, tone, transfer,
};
use darkroot_photo::{CameraSpace, Counts, Display, Rgb};
use darkroot_profile::Order;

mod fixture;
use fixture::{BORDER, SIZE, X_TRANS, capture, model, mosaic, planes};

fn stages(c: &mut Criterion) {
    let mut group = c.benchmark_group("stages");
    group.throughput(Throughput::Elements(SIZE.area() as u64));
    group.sample_size(20);

    let capture = capture();
    let levels = Levels::new(&capture);
    let Counts::U16(counts) = &capture.counts else { return };
    let mut row = vec![0f32; SIZE.width];
    group.bench_function("level", |b| {
        b.iter(|| {
            for (y, stored) in counts.samples.chunks_exact(SIZE.width).enumerate() {
                levels.row(stored, 0, y, &mut row);
                black_box(&row);
            }
        });
    });
    let mut samples = mosaic("RGGB");
    let layout = samples.layout.clone();
    group.bench_function("balance", |b| {
        b.iter(|| {
            for y in 0..SIZE.height {
                let row = &mut samples.samples[y * SIZE.width..][..SIZE.width];
                balance::row(row, &layout, [1.0, 1.000_001, 1.0], 0, y);
            }
        });
    });
    let limits = [0.62, 0.6, 0.61];
    let treatment = Treatment::Rebuild(Rebuild { limits, colours: Arc::default(), uneven: false });
    group.bench_function("highlights", |b| {
        b.iter_batched(
            || mosaic("RGGB"),
            |mut m| {
                highlights::treat(&mut m, (0, 0), &treatment, &[]);
                m
            },
            BatchSize::LargeInput,
        );
    });
    for (name, letters, wanted) in [
        ("demosaic Bayer", "RGGB", Demosaic::Best),
        ("demosaic Bayer, bilinear", "RGGB", Demosaic::Bilinear),
        ("demosaic X-Trans", X_TRANS, Demosaic::Best),
    ] {
        let mosaic = mosaic(letters);
        let Some(method) = Method::of(&mosaic.layout, wanted) else { continue };
        let mut picture = Rgb::black(SIZE);
        group.bench_function(name, |b| {
            b.iter(|| demosaic::demosaic(black_box(&mosaic), method, BORDER, &mut picture));
        });
    }
    for order in [Order::One, Order::Two, Order::Three, Order::Four] {
        let model = model(order);
        group.bench_function(format!("correct, order {}", order.number()), |b| {
            b.iter_batched(planes::<CameraSpace>, |p| correct::correct(p, &model), BatchSize::LargeInput);
        });
    }
    group.bench_function("exposure", |b| {
        b.iter_batched(planes, |p| exposure::expose(p, 1.5), BatchSize::LargeInput);
    });
    if let Some(curve) = Curve::of(Look::Neutral, &Tones::default(), None) {
        group.bench_function("tone", |b| {
            b.iter_batched(planes, |p| tone::tone(p, &curve), BatchSize::LargeInput);
        });
    }
    let primaries = Primaries::new(&RgbSpace::SRGB);
    group.bench_function("gamut", |b| {
        b.iter_batched(planes, |p| gamut::fit(p, &primaries), BatchSize::LargeInput);
    });
    let encoder = Encoder::new(TransferCurve::Srgb);
    let display = planes::<Display>();
    let (mut eight, mut sixteen) = (vec![0u8; 3 * SIZE.area()], vec![0u16; 3 * SIZE.area()]);
    group.bench_function("transfer, 8 bits", |b| {
        b.iter(|| transfer::encode(display.planes(), &encoder, black_box(&mut eight)));
    });
    group.bench_function("transfer, 16 bits", |b| {
        b.iter(|| transfer::encode(display.planes(), &encoder, black_box(&mut sixteen)));
    });
    group.finish();
}

criterion_group!(benches, stages);
criterion_main!(benches);
