//! Charts made up under some light, by some camera, from somewhere: found, the right way round, and in their places.

#![allow(clippy::unwrap_used, reason = "a test that cannot be set up shall fail")]

use darkroot_chart::{ChartLayout, Found, Homography, Options, Refusal, SearchImage, detect};
use rayon::prelude::*;

mod scene;
use scene::{Random, Shot, hash};

const FRAME: [usize; 2] = [900, 600];

struct Truth {
    layout: ChartLayout,
    map: Homography,
}

impl Truth {
    fn centre(&self, i: usize) -> [f64; 2] {
        let [left, right] = self.layout.column_edges(i % self.layout.columns);
        let [top, bottom] = self.layout.row_edges(i / self.layout.columns);
        self.map.apply([(left + right) / 2.0, (top + bottom) / 2.0])
    }

    /// Median distance of the patches' centres in patches; `None` for another layout.
    fn error(&self, found: &Found) -> Option<f64> {
        if (found.columns, found.rows) != (self.layout.columns, self.layout.rows) {
            return None;
        }
        let distance = |i: usize| {
            let (is, should) = (found.centre(i), self.centre(i));
            (is[0] - should[0]).hypot(is[1] - should[1]) / found.patch_pixels
        };
        let mut errors: Vec<f64> = (0..found.columns * found.rows).map(distance).collect();
        errors.sort_by(f64::total_cmp);
        Some(errors[errors.len() / 2])
    }
}

fn chart(name: &str, seed: u64, share: f64, change: impl Fn(&mut Shot)) -> (Truth, SearchImage) {
    let mut random = Random(hash(seed, 3, name.bytes().map(i64::from).sum()));
    let layout = ChartLayout::by_name(name).unwrap();
    let extent = scene::extent(&layout);
    let degrees = random.within(-180.0, 180.0);
    let quad = scene::placed(&mut random, FRAME, extent, share, degrees);
    let scale = Homography::scale_shift([1.0 / extent[0], 1.0 / extent[1]], [0.0, 0.0]);
    let map = Homography::onto(&quad).unwrap().after(&scale);
    let mut shot = Shot::some(&mut random, FRAME, map);
    change(&mut shot);
    let pattern = scene::chart_before(&layout, &scene::colours(&layout), scene::blotches(seed, 2.5));
    let picture = shot.picture(&mut random, &pattern);
    (Truth { layout, map }, picture)
}

/// Share of the charts found in their places, and all that was found elsewhere.
fn check(name: &str, count: u64, share: [f64; 2], change: impl Fn(&mut Shot) + Sync) -> (f64, Vec<String>) {
    let results: Vec<(bool, Vec<String>)> = (0..count)
        .into_par_iter()
        .map(|seed| {
            let share = share[0] + (share[1] - share[0]) * seed as f64 / count as f64;
            let (truth, picture) = chart(name, seed, share, &change);
            let search = detect::search(&picture, &ChartLayout::builtin(), &Options::default());
            let (mut hit, mut wrong) = (false, Vec::new());
            for found in &search.found {
                match truth.error(found) {
                    Some(error) if error < 0.04 => hit = true,
                    other => wrong.push(format!("{name} {seed}: {} {other:?}", found.layout)),
                }
            }
            if let Some(rejected) = &search.rejected {
                eprintln!("{name} {seed} {share:.2}: {}", rejected.reason);
            }
            (hit, wrong)
        })
        .collect();
    let hits = results.iter().filter(|(hit, _)| *hit).count();
    (hits as f64 / count as f64, results.into_iter().flat_map(|(_, wrong)| wrong).collect())
}

fn found(name: &str, least: f64, share: [f64; 2], change: impl Fn(&mut Shot) + Sync) {
    let (hits, wrong) = check(name, 12, share, change);
    assert!(wrong.is_empty(), "{wrong:#?}");
    assert!(hits >= least, "{name}: {hits}");
}

#[test]
fn charts_of_24_are_found_any_way_round() {
    for name in ["classic24", "passport24", "nano24", "cameratrax24", "spyder24"] {
        found(name, 0.9, [0.25, 0.6], |_| {});
    }
}

#[test]
fn large_charts_are_found_any_way_round() {
    for name in ["sg140", "spyder48", "dc240"] {
        found(name, 0.9, [0.4, 0.6], |_| {});
    }
}

#[test]
fn a_chart_of_8_percent_of_the_width_is_found() {
    found("classic24", 0.8, [0.08, 0.1], |shot| {
        shot.blur = 0;
        shot.noise = 0.005;
    });
}

#[test]
fn a_chart_in_the_gradient_of_two_stops_is_found() {
    found("classic24", 0.9, [0.5, 0.6], |shot| shot.shade = [4.0, 0.0]);
}

#[test]
fn a_chart_half_in_shadow_is_found() {
    found("classic24", 0.8, [0.5, 0.6], |shot| shot.shadow = Some([0.0, 0.3, 0.35]));
}

#[test]
fn a_dim_and_noisy_chart_is_found() {
    found("passport24", 0.8, [0.3, 0.6], |shot| shot.noise = 0.04);
}

#[test]
fn both_of_two_charts_are_found() {
    let mut random = Random(11);
    let layout = ChartLayout::by_name("classic24").unwrap();
    let extent = scene::extent(&layout);
    let chart = scene::chart_before(&layout, &scene::colours(&layout), scene::blotches(4, 3.0));
    // The second stands on its head to the right.
    let pattern =
        move |x: f64, y: f64| if x < 8.0 { chart(x, y) } else { chart(9.0 + extent[0] - x, extent[1] - y) };
    let map = Homography::scale_shift([45.0, 45.0], [80.0, 180.0]);
    let picture = Shot::some(&mut random, FRAME, map).picture(&mut random, &pattern);
    let mut turns: Vec<i32> = detect::find(&picture, &ChartLayout::builtin(), &Options::default())
        .iter()
        .map(|f| f.rotation_degrees.abs().round() as i32)
        .collect();
    turns.sort_unstable();
    assert_eq!(turns, [0, 180]);
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let (_, picture) = chart("passport24", 2, 0.4, |_| {});
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| detect::search(&picture, &ChartLayout::builtin(), &Options::default()))
    };
    let one = with(1);
    assert_eq!(one.found.len(), 1);
    assert_eq!(one, with(3));
}

#[test]
fn a_chart_that_is_cut_off_is_refused_in_words() {
    let (_, picture) = chart("classic24", 1, 0.5, |shot| {
        shot.map = Homography::scale_shift([60.0, 60.0], [-80.0, 150.0]);
    });
    let search = detect::search(&picture, &ChartLayout::builtin(), &Options::default());
    assert!(search.found.is_empty(), "{:?}", search.found);
    let reason = search.rejected.unwrap().reason;
    let cut_off = matches!(reason, Refusal::UnknownColours { .. } | Refusal::BeyondPicture { .. });
    assert!(cut_off && reason.to_string().contains("picture"), "{reason}");
}
