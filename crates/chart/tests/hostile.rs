//! Pictures that are broken, empty or extreme: no panic and no chart.

use darkroot_chart::{ChartLayout, Options, SearchImage, detect};

mod scene;
use scene::Random;

fn nothing_in(width: usize, height: usize, value: impl FnMut() -> f32) {
    let plane: Vec<f32> = std::iter::repeat_with(value).take(width * height).collect();
    let picture = SearchImage { width, height, planes: [plane.clone(), plane.clone(), plane] };
    let search = detect::search(&picture, &ChartLayout::builtin(), &Options::default());
    assert!(search.found.is_empty());
    assert!(search.rejected.is_some_and(|r| !r.reason.to_string().is_empty()));
}

#[test]
fn constant_pictures_hold_no_chart() {
    for value in [0.0, 1.0, -1.0, f32::NAN, f32::INFINITY, f32::MIN_POSITIVE, f32::MAX] {
        nothing_in(200, 120, || value);
    }
}

#[test]
fn tiny_and_thin_pictures_hold_no_chart() {
    let mut random = Random(5);
    for (width, height) in [(1, 1), (0, 0), (1, 900), (900, 1), (2, 2), (41, 1), (3, 60), (5000, 2)] {
        nothing_in(width, height, || random.within(0.0, 1.0) as f32);
    }
}

#[test]
fn noise_with_values_that_are_no_numbers_holds_no_chart() {
    let mut random = Random(6);
    nothing_in(300, 200, || match random.below(5) {
        0 => f32::NAN,
        1 => f32::INFINITY,
        2 => -1e30,
        _ => random.within(0.0, 1e20) as f32,
    });
}

#[test]
fn planes_of_another_size_hold_no_chart() {
    let picture =
        SearchImage { width: 100, height: 100, planes: [vec![0.5; 10_000], vec![0.5; 10_000], vec![]] };
    assert!(detect::find(&picture, &ChartLayout::builtin(), &Options::default()).is_empty());
    let huge = SearchImage { width: usize::MAX, height: 3, planes: [vec![], vec![], vec![]] };
    assert!(detect::find(&huge, &ChartLayout::builtin(), &Options::default()).is_empty());
}

#[test]
fn strange_options_do_no_harm() {
    let picture = SearchImage { width: 60, height: 50, planes: [0; 3].map(|_| vec![0.5; 3000]) };
    for search_side in [0, 1, usize::MAX] {
        let options = Options { search_side, most: 0 };
        assert!(detect::find(&picture, &ChartLayout::builtin(), &options).is_empty());
        assert!(detect::find(&picture, &[], &options).is_empty());
    }
}
