//! Things with rows and columns that are no charts: none of them may be taken for one.

use darkroot_chart::{ChartLayout, Found, Options, detect};
use rayon::prelude::*;

mod scene;
use scene::clutter::{KINDS, picture};

fn invented(kind: &str, number: u64) -> Vec<Found> {
    detect::find(&picture(kind, number), &ChartLayout::builtin(), &Options::default())
}

fn no_chart_is_invented_in(each: u64) {
    let all: Vec<(&str, u64)> = KINDS.iter().flat_map(|kind| (0..each).map(move |n| (*kind, n))).collect();
    let wrong: Vec<String> = all
        .par_iter()
        .flat_map_iter(|(kind, n)| {
            invented(kind, *n).into_iter().map(move |f| {
                format!("{kind} {n}: {} {:.2} unexplained {:.3}", f.layout, f.confidence, f.unexplained)
            })
        })
        .collect();
    assert!(wrong.is_empty(), "{} of {}: {wrong:#?}", wrong.len(), all.len());
}

#[test]
fn no_chart_is_invented_in_280_pictures_of_clutter() {
    no_chart_is_invented_in(20);
}

#[test]
#[ignore = "minutes; run with --release -- --ignored"]
fn no_chart_is_invented_in_thousands_of_pictures_of_clutter() {
    no_chart_is_invented_in(150);
}
