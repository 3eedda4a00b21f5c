use super::*;
use darkroot_chart::{ChartLayout, PatchNoise, Quad, patch_noise, windows};
use darkroot_colour::{Spectrum, Xyz, white};
use darkroot_photo::{Counts, Layout, Mosaic, Size};
use darkroot_simulate::{Camera, Exposure, Scene, expose::expose};

/// A shot of six by four patches, from light to dark in even steps of L*, by a camera without colours; `tone` is what the picture
/// makes of its light. Returns the greys as `verify` has them.
fn greys(full_well: f64, read_noise: f64, tone: impl Fn(f64) -> f64) -> Vec<Grey> {
    const WHITE: f64 = 0.9;
    let size = Size { width: 1300, height: 900 };
    let corners: Quad = [[60.0, 60.0], [1240.0, 60.0], [1240.0, 840.0], [60.0, 840.0]];
    let layout = ChartLayout::by_name("classic24").unwrap();
    let lightness = |i: usize| 96.0 - 3.3 * i as f64;
    let reflectance = |i: usize| ((lightness(i) + 16.0) / 116.0).powi(3);
    let patches: Vec<Spectrum> = (0..24).map(|i| Spectrum::constant(reflectance(i))).collect();
    let scene = Scene::chart(size, corners, &patches, 6, layout.gap);
    let camera =
        Camera { layout: Layout::Monochrome, crop: 0, full_well, read_noise, ..Camera::simulated_one() };
    let reach = darkroot_simulate::chart::white().reflected_xyz(&Spectrum::daylight(5500.0)).y;
    let exposure = Exposure { white: WHITE, noise: Some(7), ..Exposure::default() };
    let Counts::U16(counts) = expose(&scene, &camera, &exposure).counts else { panic!("whole numbers") };
    let light = |count: &u16| (f64::from(*count) - 512.0) / (15_892.0 - 512.0);
    let samples = counts.samples.iter().flat_map(|count| [tone(light(count)) as f32; 3]).collect();
    let picture = Mosaic { size, layout: Layout::Rgb, samples };
    let to_xyz = Matrix3::new(0.3, 0.3, 0.3642, 0.2, 0.7, 0.1, 0.2, 0.2, 0.4249);
    let places = windows::windows(&layout, &corners, 0.2).unwrap();
    let noise = patch_noise(&picture, &to_xyz, &places, 41.0);
    let means = darkroot_chart::measure(&picture, [f32::INFINITY; 3], &places);
    let grey = |(i, noise): (usize, &PatchNoise)| {
        let grey = |y: f64| Xyz::new(y * white::D50.x, y, y * white::D50.z).lab(white::D50);
        let (found, truth) = (grey(means[i].mean[1]), grey(reflectance(i) * WHITE / reach));
        Grey { name: format!("{i}"), found, truth, noise: *noise }
    };
    noise.iter().enumerate().map(grey).collect()
}

/// Stops from a full well to as many electrons as their noise, with that of rounding to counts.
fn truth(full_well: f64, read_noise: f64) -> f64 {
    let count = full_well / (15_892.0 - 512.0);
    let reading = read_noise * read_noise + count * count / 12.0;
    (full_well / ((1.0 + (1.0 + 4.0 * reading).sqrt()) / 2.0)).log2()
}

#[test]
fn a_noisy_sensor_has_the_range_of_its_full_well_over_its_noise() {
    for (full_well, read_noise) in [(20_000.0, 60.0), (60_000.0, 120.0), (5_000.0, 40.0)] {
        let (found, truth) =
            (dynamic_range(&greys(full_well, read_noise, |v| v)).unwrap(), truth(full_well, read_noise));
        assert!((found.stops - truth).abs() < 0.2, "{full_well} {read_noise}: {found:?}, truth {truth}");
        assert!(found.least < found.stops && found.least > truth - 0.5, "{found:?}, truth {truth}");
        assert!(found.shown < found.stops, "{found:?}");
    }
}

#[test]
fn a_clean_sensor_has_at_least_what_can_be_relied_on() {
    // Electrons of the darkest patch make more noise than reading does: the chart says little of that.
    for full_well in [60_000.0, 30_000.0] {
        let (found, truth) = (dynamic_range(&greys(full_well, 4.0, |v| v)).unwrap(), truth(full_well, 4.0));
        assert!(found.least < truth && found.least > truth - 3.0, "{found:?}, truth {truth}");
        assert!((found.stops - truth).abs() < 3.0, "{found:?}, truth {truth}");
    }
}

#[test]
fn a_tone_curve_changes_signal_and_noise_alike() {
    // A power over light, as many pictures have: the range of the light stays.
    let curved = dynamic_range(&greys(20_000.0, 60.0, |v| v.max(0.0).powf(0.8))).unwrap();
    assert!((curved.stops - truth(20_000.0, 60.0)).abs() < 0.3, "{curved:?}");
}

#[test]
fn pictures_without_noise_and_with_few_greys_tell_nothing() {
    let all = greys(20_000.0, 60.0, |v| v);
    assert_eq!(dynamic_range(&all[..4]), None);
    let clean: Vec<Grey> =
        all.iter().map(|grey| Grey { noise: PatchNoise::default(), ..grey.clone() }).collect();
    assert_eq!(dynamic_range(&clean), None);
    assert_eq!(dynamic_range(&[]), None);
}
