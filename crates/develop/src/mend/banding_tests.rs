//! Banding that was added is found and taken away; what a scene shows is none.

use darkroot_photo::{Capture, Counts, Mosaic, Rect, Size};

use super::Mends;
use super::tests::{BLACK, ELECTRON, capture, mends};
use crate::denoise::Random;
use crate::light::LinearLight;

const SIZE: Size = super::tests::SIZE;

/// Light at a column and row, with offsets of rows of this standard deviation, all in electrons; and the offsets.
fn banded(light: impl Fn(usize, usize) -> f32, strength: f32, seed: u64) -> (Capture, Vec<f32>) {
    let mut random = Random::new(seed + 100);
    let offsets: Vec<f32> = (0..SIZE.height).map(|_| strength * random.normal()).collect();
    let electrons = |i: usize| light(i % SIZE.width, i / SIZE.width) + offsets[i / SIZE.width];
    (capture(&(0..SIZE.area()).map(electrons).collect::<Vec<_>>(), seed), offsets)
}

/// Dark and brighter from left to right and back, so that windows of both lie everywhere.
fn shaded(x: usize, _: usize) -> f32 {
    90.0 + 70.0 * (x as f32 / 30.0).sin()
}

/// Shaded light times what `rows` has for each row.
fn striped(rows: impl Fn(usize) -> f32) -> impl Fn(usize, usize) -> f32 {
    move |x, y| shaded(x, y) * rows(y)
}

/// Means of rows of mended light, in electrons.
fn row_means(capture: &Capture, mends: &Mends) -> Vec<f32> {
    let light = LinearLight::of(capture);
    let mut row = vec![0.0; SIZE.width];
    let mut mean = |y: usize| {
        mends.levelled(capture, &light, (0, y), &mut row);
        row.iter().sum::<f32>() / SIZE.width as f32 / ELECTRON
    };
    (0..SIZE.height).map(&mut mean).collect()
}

/// Power of the differences of successive rows.
fn unrest(means: &[f32]) -> f32 {
    means.windows(2).map(|v| (v[1] - v[0]).powi(2)).sum::<f32>() / means.len() as f32
}

#[test]
fn banding_is_measured_and_taken_away() {
    for (i, strength) in [0.8f32, 2.0, 6.0].into_iter().enumerate() {
        let (banded, offsets) = banded(shaded, strength, i as u64);
        let mends = mends(&banded);
        let found = mends.banding().unwrap() * noise();
        assert!((found / strength - 1.0).abs() < 0.25, "{strength}: {found}");
        let means = row_means(&banded, &mends);
        let (before, after) = (unrest(&offsets), unrest(&means));
        // Of 600 samples the mean scatters too.
        assert!(after < 0.2 * before + 3.0 * noise().powi(2) / 600.0, "{strength}: {before} {after}");
        // All of it stays as bright as it was.
        let all = |mends: &Mends| row_means(&banded, mends).iter().sum::<f32>() / SIZE.height as f32;
        let (kept, mended) = (all(&Mends::default()), all(&mends));
        assert!((kept / mended - 1.0).abs() < 5e-4, "{strength}: {kept} {mended}");
    }
}

/// Standard deviation of a sample in the darkest windows, in electrons.
fn noise() -> f32 {
    (36.0f32 + 9.0).sqrt()
}

/// With columns beside the picture that no light reaches; in them the rows have these offsets, in electrons, and noise.
fn with_masked(capture: &Capture, offsets: &[f32]) -> Capture {
    const MASKED: usize = 64;
    let mut random = Random::new(55);
    let Counts::U16(mosaic) = &capture.counts else { panic!() };
    let rows = mosaic.samples.chunks_exact(SIZE.width).zip(offsets);
    let mut samples = Vec::new();
    for (row, offset) in rows {
        samples.extend((0..MASKED).map(|_| (BLACK + 0.25 * (offset + 3.0 * random.normal())).round() as u16));
        samples.extend(row);
    }
    let size = Size { width: SIZE.width + MASKED, ..SIZE };
    let counts = Counts::U16(Mosaic { size, samples, layout: mosaic.layout.clone() });
    Capture { counts, active_area: Rect { x: MASKED, ..Rect::full(SIZE) }, ..capture.clone() }
}

#[test]
fn masked_columns_tell_banding_from_a_scene() {
    // A scene in which nothing else could: stripes across all of it.
    let scene = striped(|y| 1.0 + 0.05 * (0.4 * y as f32).sin());
    let (banded, offsets) = banded(&scene, 3.0, 4);
    assert_eq!(mends(&banded).banding(), None);
    let masked = with_masked(&banded, &offsets);
    let mends = mends(&masked);
    let found = mends.banding().unwrap() * noise();
    assert!((found / 3.0 - 1.0).abs() < 0.25, "{found}");
    let mut row = vec![0.0; SIZE.width];
    let mut unrest = [0.0, 0.0];
    for (unrest, mends) in unrest.iter_mut().zip([&Mends::default(), &mends]) {
        let light = LinearLight::of(&masked);
        let mut mean = |y: usize| {
            mends.levelled(&masked, &light, (64, y), &mut row);
            let truth: f32 = (0..SIZE.width).map(|x| scene(x, y)).sum();
            (row.iter().sum::<f32>() / ELECTRON - truth) / SIZE.width as f32
        };
        let means: Vec<f32> = (0..SIZE.height).map(&mut mean).collect();
        *unrest = self::unrest(&means);
    }
    assert!(unrest[1] < 0.25 * unrest[0], "{unrest:?}");
}

#[test]
fn masked_columns_alone_change_nothing() {
    let (clean, _) = banded(shaded, 0.0, 3);
    let mut random = Random::new(9);
    let quiet = vec![0.0; SIZE.height];
    let own: Vec<f32> = (0..SIZE.height).map(|_| 4.0 * random.normal()).collect();
    for (name, offsets) in [("quiet", quiet), ("not shared by the picture", own)] {
        assert_eq!(mends(&with_masked(&clean, &offsets)).banding(), None, "{name}");
    }
}

#[test]
fn nearly_no_light_shows_it_too() {
    let (banded, _) = banded(|_, _| 2.0, 1.5, 8);
    assert!(mends(&banded).banding().is_some());
}

#[test]
fn without_banding_nothing_is_changed() {
    for seed in 0..12 {
        let (clean, _) = banded(shaded, 0.0, seed);
        assert_eq!(mends(&clean).banding(), None, "{seed}");
        let (dark, _) = banded(|_, _| 3.0, 0.0, seed);
        assert_eq!(mends(&dark).banding(), None, "{seed}");
    }
}

#[test]
fn stripes_and_textures_of_a_scene_are_no_banding() {
    let mut random = Random::new(5);
    let rough: Vec<f32> = (0..SIZE.height + 2).map(|_| random.normal()).collect();
    let none = |name: &str, rows: &dyn Fn(usize) -> f32| {
        for seed in [1, 2] {
            let (scene, _) = banded(striped(rows), 0.0, seed);
            assert_eq!(mends(&scene).banding(), None, "{name} {seed}");
        }
    };
    for period in [2.0f32, 3.0, 4.0, 5.0, 7.5, 12.0, 30.0, 90.0] {
        for depth in [0.02, 0.1, 0.5] {
            none("waves", &|y| 1.0 + depth * (std::f32::consts::TAU * y as f32 / period).sin());
        }
    }
    for depth in [0.02, 0.05, 0.2] {
        // Even without any lens.
        none("random rows", &|y| 1.0 + depth * rough[y]);
        none("seen by a lens", &|y| 1.0 + depth * (0.25 * (rough[y] + rough[y + 2]) + 0.5 * rough[y + 1]));
    }
    none("bright stripes", &|y| if y % 40 < 3 { 4.0 } else { 1.0 });
    none("a horizon", &|y| if y < 217 { 1.0 } else { 0.3 });
    none("lines", &|y| if y.is_multiple_of(57) { 2.0 } else { 1.0 });
}

/// A part of the picture, and whether a place is in it.
type Part = (&'static str, fn(usize, usize) -> bool);

#[test]
fn stripes_in_one_part_of_a_scene_are_no_banding() {
    let mut random = Random::new(6);
    let rough: Vec<f32> = (0..SIZE.height).map(|_| random.normal()).collect();
    let places: [Part; 4] = [
        ("left", |x, _| x < 300),
        ("right", |x, _| x > 350),
        ("where it is dark", |x, y| shaded(x, y) < 80.0),
        ("where it is bright", |x, y| shaded(x, y) > 100.0),
    ];
    for (name, is_there) in places {
        let (scene, _) =
            banded(|x, y| shaded(x, y) + if is_there(x, y) { 4.0 * rough[y] } else { 0.0 }, 0.0, 3);
        assert_eq!(mends(&scene).banding(), None, "{name}");
    }
}
