//! The model of a camera for a white that no photograph had before: what a photograph waits for.
//!
//! `cargo bench -p darkroot-profile`, on one thread.

#![allow(missing_docs, clippy::expect_used)] // Criterion's macros document nothing; a bench may stop.

use std::hint::black_box;

use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use darkroot_colour::temperature::Temperature;
use darkroot_profile::Profile;
use darkroot_profile::file;

/// Measured cameras of which the models fold little and much.
const CAMERAS: [(&str, &str); 2] = [
    ("Nikon D850", include_str!("../../../profiles/nikon/d850.toml")),
    ("Fujifilm X-T4", include_str!("../../../profiles/fujifilm/x-t4.toml")),
];

fn white(c: &mut Criterion) {
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().expect("one thread");
    let mut group = c.benchmark_group("model for a new white");
    for (name, text) in CAMERAS {
        let profile: Profile = file::parse(text).expect("a profile");
        let camera = profile.known_camera().expect("a camera");
        for (light, kelvin, tint) in
            [("daylight", 5600.0, 4.0), ("lamp", 2900.0, 0.0), ("fluorescent", 4100.0, 12.0)]
        {
            let xy = Temperature::from_kelvin_tint(kelvin, tint).xy();
            // A camera remembers whites: each round has one that knows none.
            group.bench_function(format!("{name}, {light}"), |b| {
                b.iter_batched(
                    || camera.clone(),
                    |camera| black_box(camera.model_for(xy)),
                    BatchSize::LargeInput,
                );
            });
        }
    }
    group.finish();
}

criterion_group!(benches, white);
criterion_main!(benches);
