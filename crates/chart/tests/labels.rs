//! Photographs with charts labelled by hand, where `DARKROOT_DATA` (seen from the top of the repository) has them.

use std::path::PathBuf;

use darkroot_chart::{ChartLayout, Options, detect};
use rayon::prelude::*;

mod labelled;

fn folder() -> Option<PathBuf> {
    let data = std::env::var_os("DARKROOT_DATA").map(PathBuf::from);
    let top = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../..");
    let folder = data.map(|data| top.join(data).join("charts")).filter(|f| f.join("labels.json").is_file());
    if folder.is_none() {
        eprintln!("DARKROOT_DATA does not point to labelled charts: nothing is tested here");
    }
    folder
}

#[test]
fn every_usable_chart_is_found_the_right_way_round_and_none_is_invented() {
    let Some(folder) = folder() else { return };
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
