//! The core, as a program with a window uses it: analysis once, a plan for each move of a slider, views; beside the
//! whole picture.
//!
//! `cargo bench -p darkroot --bench core`.

#![allow(missing_docs, clippy::expect_used)] // Criterion's macros document nothing; a bench may stop.

use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::{Criterion, criterion_group, criterion_main};
use darkroot::{Cancel, Photo, Plan, ProfileStore, Scale, Settings, View};
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
    let tile = View::of(Rect { x: 2000, y: 1000, width: 512, height: 512 });
    group.bench_function("512 x 512 at full scale", |b| {
        b.iter(|| plan.render(tile, &Cancel::default()).expect("a picture"));
    });
    // From the wish to stop, in the middle of the whole picture, until rendering has stopped.
    group.bench_function("cancelling", |b| {
        b.iter_custom(|times| (0..times).map(|i| cancelling(&plan, i)).sum());
    });
    group.finish();
}

/// Time that a rendering of the whole picture goes on after it was cancelled, some milliseconds after its beginning.
fn cancelling(plan: &Plan, i: u64) -> Duration {
    let cancel = Cancel::default();
    std::thread::scope(|scope| {
        let rendering = scope.spawn(|| {
            let cancelled = plan.render(plan.whole(Scale::FULL), &cancel).is_err();
            (cancelled, Instant::now())
        });
        std::thread::sleep(Duration::from_millis(20 + i % 40));
        let wish = Instant::now();
        cancel.cancel();
        let (cancelled, end) = rendering.join().expect("no panic");
        assert!(cancelled, "the rendering was over before it was cancelled");
        end - wish
    })
}

criterion_group!(benches, core);
criterion_main!(benches);
