//! The core, as a program with a window uses it: analysis once, a plan for each move of a slider, views; beside the
//! whole picture.
//!
//! `cargo bench -p darkroot --bench core`.

#![allow(missing_docs, clippy::expect_used)] // Criterion's macros document nothing; a bench may stop.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use darkroot::{Cancel, Photo, ProfileStore, Scale, Settings, View};
use darkroot_photo::{Rect, Size};
use darkroot_simulate::{Camera, Scene, expose, samples};

/// 24 MP.
const SIZE: Size = Size { width: 6000, height: 4000 };

fn core(c: &mut Criterion) {
    let scene = Scene::still_life(SIZE);
    let photo = Photo::from(expose::expose(&scene, &Camera::nikon_d750(), &samples::exposure(1)));
    let store = ProfileStore::builtin();
    let settings = Settings::default();
    let mut auto = Settings::default();
    auto.recipe.exposure.auto = true;

    let mut group = c.benchmark_group("24 MP");
    group.sample_size(10);
    group.bench_function("analysis", |b| b.iter(|| black_box(photo.analyse())));
    let analysis = photo.analyse();
    for (name, settings) in [("plan", &settings), ("plan, automatic exposure", &auto)] {
        group.bench_function(name, |b| b.iter(|| photo.plan(&analysis, &store, settings).expect("a plan")));
    }
    let plan = photo.plan(&analysis, &store, &settings).expect("a plan");
    for (name, scale) in [("whole", Scale::FULL), ("1/2", Scale::HALF), ("1/4", Scale::QUARTER)] {
        let view = plan.whole(scale);
        group.bench_function(name, |b| b.iter(|| plan.render(view, &Cancel::default()).expect("a picture")));
    }
    let part = View::of(Rect { x: 2000, y: 1000, width: 1400, height: 900 });
    group.bench_function("1400 x 900 at full scale", |b| {
        b.iter(|| plan.render(part, &Cancel::default()).expect("a picture"));
    });
    group.finish();
}

criterion_group!(benches, core);
criterion_main!(benches);
