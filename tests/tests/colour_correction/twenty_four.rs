//! The papers' protocol on data that the project carries: the simulated camera and its chart of 24 patches, against
//! numpy's least squares with each patch really left out.

use darkroot_colour::illuminant::Illuminant;
use darkroot_profile::fit::virtual_set::VirtualSet;
use darkroot_profile::fit::{self, Samples, spectral};
use darkroot_profile::spectra::in_31_channels;
use darkroot_profile::{Kind, Order, Sensitivities};
use darkroot_simulate::{Camera, chart};

fn samples() -> Samples {
    let light = in_31_channels(&Illuminant::by_name("D65").unwrap().spectrum());
    let camera = Sensitivities(Camera::simulated_one().sensitivities).under(&light).unwrap();
    camera.render(&chart::reflectances(), &light).unwrap()
}

/// Mean, median, 95th percentile and maximum by numpy 1.26, `numpy.linalg.lstsq` without each patch in turn: dE2000,
/// then dE*uv.
#[expect(clippy::approx_constant, reason = "a median that happens to be near pi / 6")]
const NUMPY: [(Kind, [f64; 4], [f64; 4]); 5] = [
    (Kind::Linear, [1.1375, 0.8823, 3.2974, 3.7131], [2.2104, 2.1709, 4.8112, 5.2086]),
    (Kind::Polynomial(2), [0.9131, 0.6085, 2.4512, 3.1284], [1.8580, 1.2414, 5.5590, 5.6259]),
    (Kind::Polynomial(3), [1.1313, 0.9009, 3.2981, 4.6026], [2.4252, 1.2774, 9.0484, 12.2255]),
    (Kind::Root(Order::Two), [0.3508, 0.2807, 1.0726, 1.3576], [0.7670, 0.5236, 2.4260, 2.5696]),
    (Kind::Root(Order::Three), [0.4370, 0.2453, 1.1985, 1.4369], [0.9739, 0.5657, 2.7492, 2.9368]),
];

#[test]
fn errors_of_patches_left_out_are_those_of_numpy() {
    let samples = samples();
    for (kind, de2000, de_uv) in NUMPY {
        let errors = fit::fit(&samples, kind).unwrap().figures.leave_one_out.unwrap();
        for (found, expected) in [(errors.de2000, de2000), (errors.de_uv, de_uv)] {
            let found = [found.mean, found.median, found.p95, found.max];
            for (f, e) in found.into_iter().zip(expected) {
                assert!((f - e).abs() < 2e-4, "{kind}: {found:?}, expected {expected:?}");
            }
        }
    }
}

#[test]
fn channel_gains_only_rescale_the_coefficients() {
    let samples = samples();
    let gains = [2.1, 1.0, 0.7];
    let scaled = samples.rgb().iter().map(|rgb| [0, 1, 2].map(|c| rgb[c] * gains[c])).collect();
    let scaled = Samples::new(scaled, samples.xyz().to_vec(), samples.white()).unwrap();
    for order in [Order::One, Order::Two, Order::Three] {
        let coefficients = |samples: &Samples| {
            let root = fit::plain::root(samples, order).unwrap().model.root.unwrap();
            root.terms().collect::<Vec<_>>()
        };
        for ((term, one), (_, other)) in coefficients(&samples).into_iter().zip(coefficients(&scaled)) {
            let gain: f64 =
                (0..3).map(|c| gains[c].powf(f64::from(term.powers[c]) / f64::from(term.root))).product();
            for (a, b) in one.into_iter().zip(other) {
                assert!((a - b * gain).abs() < 1e-8 * (1.0 + a.abs()), "{}", term.name());
            }
        }
    }
}

#[test]
fn greys_stay_grey_in_models_that_promise_it() {
    let samples = samples();
    let white = samples.white();
    for kind in [Kind::Anchored, Kind::HuePlane, Kind::Half] {
        let model = fit::fit(&samples, kind).unwrap().fit.model;
        for grey in [1e-6, 0.01, 0.18, 1.0, 4.0] {
            let found = model.xyz([grey; 3]);
            let off = (found.x - grey * white.x).abs().max((found.z - grey * white.z).abs());
            assert!(off.max((found.y - grey).abs()) < 1e-12 * grey.max(1e-3), "{kind} {grey}: {found:?}");
        }
    }
}

#[test]
fn models_of_the_virtual_set_keep_greys_hold_at_every_exposure_and_do_not_fold() {
    let light = in_31_channels(&Illuminant::by_name("D65").unwrap().spectrum());
    let camera = Sensitivities(Camera::simulated_one().sensitivities).under(&light).unwrap();
    let set = VirtualSet::of(&chart::reflectances());
    let samples = samples();
    let linear = fit::fit(&samples, Kind::Linear).unwrap().figures.leave_one_out.unwrap().de2000.mean;
    for kind in [Kind::Spectral, Kind::Chromatic] {
        let fit = spectral::fit_known_camera(&set, &camera, &light, &samples, kind).unwrap();
        let white = samples.white();
        for k in [-20, -7, 0, 3, 20].map(|e| 2f64.powi(e)) {
            let grey = fit.model.xyz([k; 3]);
            let off = (grey.x - k * white.x).abs().max((grey.z - k * white.z).abs());
            assert!(off.max((grey.y - k).abs()) < 1e-12 * k, "{kind} {k}: {grey:?}");
            for rgb in [[0.9, 0.2, 0.05], [0.1, 0.7, 0.4], [0.0, 0.1, 1.0]] {
                let (one, other) = (fit.model.xyz(rgb), fit.model.xyz(rgb.map(|v| v * k)));
                let off = (one.x * k - other.x).abs().max((one.z * k - other.z).abs());
                assert!(off.max((one.y * k - other.y).abs()) < 1e-12 * k, "{kind} {k}: {off:e}");
            }
        }
        assert!(darkroot_profile::lint::folds(&fit.model) <= 0.0, "{kind} folds");
        let unseen = fit.figures(&samples).leave_one_out.unwrap().de2000.mean;
        println!("{kind}: left out {unseen:.3}, linear {linear:.3}");
        assert!(unseen < 0.5 * linear, "{kind}: {unseen} against {linear}");
    }
}

#[test]
fn a_model_that_cannot_be_fitted_says_why() {
    let samples = samples();
    let words = |samples: &Samples, kind| fit::fit(samples, kind).unwrap_err().to_string();
    assert!(words(&samples, Kind::Polynomial(4)).contains("at least 35 colours and there are 24"));
    assert!(words(&samples, Kind::Spectral).contains("reflectances"));
    let grey: Vec<[f64; 3]> = (1..=24).map(|i| [f64::from(i) / 24.0; 3]).collect();
    let grey = Samples::new(grey, samples.xyz().to_vec(), samples.white()).unwrap();
    for kind in [Kind::Linear, Kind::Anchored, Kind::HuePlane] {
        assert!(words(&grey, kind).contains("too much alike"), "{kind}");
    }
}
