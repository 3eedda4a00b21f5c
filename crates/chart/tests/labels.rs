//! Photographs with charts labelled by hand, where `DARKROOT_DATA` (seen from the top of the repository) has them.

#![allow(clippy::unwrap_used)] // Clippy takes the helpers of tests for production code.

use std::path::PathBuf;

use darkroot_chart::{ChartLayout, Options, detect};
use rayon::prelude::*;

mod labelled;

/// The folder of labelled charts. The test is ignored where it is not (`tests/build.rs`).
fn folder() -> PathBuf {
    let top = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../..");
    top.join(std::env::var_os("DARKROOT_DATA").unwrap()).join("charts")
}

#[test]
#[cfg_attr(not(has_labelled_charts), ignore = "needs `charts` in DARKROOT_DATA")]
fn every_usable_chart_is_found_the_right_way_round_and_none_is_invented() {
    let folder = folder();
    let photos = labelled::read(&folder).unwrap();
    let layouts = ChartLayout::builtin();
    let searched: Vec<_> = photos
        .par_iter()
        .map(|p| detect::find(&labelled::open(&p.path).unwrap(), &layouts, &Options::default()))
        .collect();
    let mut totals = labelled::Totals::default();
    for (photo, found) in photos.iter().zip(&searched) {
        let outcome = labelled::compare(photo, found);
        assert!(outcome.invented.is_empty(), "{}: {:?}", photo.name, outcome.invented);
        totals.add(&outcome);
    }
    assert_eq!((totals.found, totals.turned), (totals.usable, 0), "{totals}");
    // The best peer reaches 0.040.
    assert!(totals.median() < 0.006, "{totals}");
}
