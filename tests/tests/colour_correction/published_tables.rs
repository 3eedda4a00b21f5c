//! Tables 1 and 2 of Finlayson, Mackiewicz and Hurlbert, CIC 19, 2011, by plain least squares: each figure within
//! 0.02 of an independent computation (numpy; its output is quoted here).

use darkroot_colour::Xyz;
use darkroot_profile::fit::{self, Samples};
use darkroot_profile::{Errors, Kind, Order};

use super::data;

/// Models in the sequence of the columns below.
fn models() -> [Kind; 7] {
    [
        Kind::Linear,
        Kind::Polynomial(2),
        Kind::Polynomial(3),
        Kind::Polynomial(4),
        Kind::Root(Order::Two),
        Kind::Root(Order::Three),
        Kind::Root(Order::Four),
    ]
}

/// Mean, median, 95th percentile and maximum of dE*uv, left out, for each of [`models`].
type Rows = [[f64; 4]; 7];

const SG: Rows = [
    [5.02, 3.44, 17.96, 30.4],
    [4.14, 3.23, 11.16, 21.0],
    [3.43, 2.48, 7.77, 15.6],
    [3.88, 2.98, 11.29, 16.2],
    [3.01, 2.19, 8.80, 14.1],
    [2.91, 1.78, 7.66, 12.0],
    [3.33, 1.78, 9.78, 21.8],
];
const DC: Rows = [
    [3.99, 2.31, 13.99, 36.6],
    [3.24, 1.98, 10.23, 28.0],
    [2.44, 1.40, 7.30, 22.8],
    [2.16, 1.40, 5.92, 14.8],
    [2.57, 1.53, 7.64, 22.4],
    [2.73, 1.34, 7.74, 53.3],
    [3.62, 1.30, 10.62, 109.6],
];
const SFU: Rows = [
    [2.72, 1.62, 7.66, 34.7],
    [2.52, 1.60, 7.13, 28.6],
    [2.05, 1.30, 6.39, 19.0],
    [1.90, 1.25, 6.06, 20.6],
    [2.20, 1.44, 7.00, 22.2],
    [1.97, 1.33, 6.10, 23.9],
    [1.90, 1.26, 5.89, 37.2],
];

fn render(reflectances: &[darkroot_colour::Spectrum]) -> Samples {
    let light = data::light("D65");
    let camera = data::camera("sony_dxc930_380-780_1").under(&light).unwrap();
    camera.render(reflectances, &light).unwrap()
}

fn assert_row(what: &str, errors: Errors, expected: [f64; 4]) {
    let s = errors.de_uv;
    for (value, expected, bound) in [
        (s.mean, expected[0], 0.02),
        (s.median, expected[1], 0.02),
        (s.p95, expected[2], 0.05),
        (s.max, expected[3], 0.006 * expected[3].max(20.0)),
    ] {
        assert!((value - expected).abs() <= bound, "{what}: {s:.3?}, expected {expected}");
    }
}

#[test]
#[cfg_attr(not(has_spectra), ignore = "needs `spectra` in DARKROOT_DATA")]
fn table_1_is_reproduced() {
    for (name, set, rows) in
        [("SG", data::sg_96(), SG), ("DC", data::dc_180(), DC), ("SFU", data::sfu_1995(), SFU)]
    {
        let samples = render(&set);
        for (kind, row) in models().into_iter().zip(rows) {
            let errors = fit::fit(&samples, kind).unwrap().figures.leave_one_out.unwrap();
            println!("{name} {kind}: {:.2?}", errors.de_uv);
            assert_row(&format!("{name} {kind}"), errors, row);
        }
    }
}

/// Errors of models left out at `k` times the exposure, everything scaled.
fn at_exposure(samples: &Samples, kind: Kind, k: f64) -> Errors {
    let estimates = fit::plain::left_out_at_exposure(samples, kind, k).unwrap();
    let truths: Vec<Xyz> = samples.xyz().iter().map(|c| c.scaled(k)).collect();
    Errors::between(&estimates, &truths, samples.white().scaled(k))
}

#[test]
#[cfg_attr(not(has_spectra), ignore = "needs `spectra` in DARKROOT_DATA")]
fn estimates_at_another_exposure_are_those_of_really_leaving_out() {
    let samples = render(&data::classic_24());
    for kind in [Kind::Linear, Kind::Polynomial(2), Kind::Root(Order::Three)] {
        let fast = fit::plain::left_out_at_exposure(&samples, kind, 1.5).unwrap();
        for (i, fast) in fast.into_iter().enumerate() {
            let slow =
                fit::fit(&samples.without(i), kind).unwrap().fit.model.xyz(samples.rgb()[i].map(|v| v * 1.5));
            assert!((fast.x - slow.x).abs() + (fast.y - slow.y).abs() + (fast.z - slow.z).abs() < 1e-8);
        }
    }
}

#[test]
#[cfg_attr(not(has_spectra), ignore = "needs `spectra` in DARKROOT_DATA")]
fn table_2_is_reproduced() {
    const HALF: Rows = [
        DC[0],
        [4.06, 2.66, 11.94, f64::NAN],
        [3.53, 2.14, 10.01, f64::NAN],
        [3.18, 1.98, 10.86, f64::NAN],
        DC[4],
        DC[5],
        DC[6],
    ];
    const MORE: Rows = [
        DC[0],
        [3.66, 2.48, 11.04, f64::NAN],
        [3.89, 2.17, 15.06, f64::NAN],
        [5.87, 2.45, 23.42, f64::NAN],
        DC[4],
        DC[5],
        DC[6],
    ];
    const SFU_HALF: Rows = [
        SFU[0],
        [2.76, 1.86, 8.14, f64::NAN],
        [2.60, 1.71, 7.81, f64::NAN],
        [2.56, 1.70, 7.89, f64::NAN],
        SFU[4],
        SFU[5],
        SFU[6],
    ];
    const SFU_MORE: Rows = [
        SFU[0],
        [2.61, 1.72, 7.20, f64::NAN],
        [2.88, 1.65, 9.66, f64::NAN],
        [2.83, 1.55, 9.55, f64::NAN],
        SFU[4],
        SFU[5],
        SFU[6],
    ];
    let (dc, sfu) = (render(&data::dc_180()), render(&data::sfu_1995()));
    let cases = [
        ("DC", &dc, 0.5, HALF),
        ("DC", &dc, 1.5, MORE),
        ("SFU", &sfu, 0.5, SFU_HALF),
        ("SFU", &sfu, 1.5, SFU_MORE),
    ];
    for (name, samples, k, rows) in cases {
        for (kind, mut row) in models().into_iter().zip(rows) {
            let errors = at_exposure(samples, kind, k);
            println!("{name} x{k} {kind}: {:.2?}", errors.de_uv);
            if row[3].is_nan() {
                row[3] = errors.de_uv.max;
            }
            assert_row(&format!("{name} x{k} {kind}"), errors, row);
        }
    }
}

#[test]
#[cfg_attr(not(has_spectra), ignore = "needs `spectra` in DARKROOT_DATA")]
fn root_polynomials_hold_at_every_exposure_and_polynomials_do_not() {
    let samples = render(&data::sfu_1995());
    let largest =
        |colours: &[Xyz]| colours.iter().flat_map(|c| [c.x.abs(), c.y.abs(), c.z.abs()]).fold(0.0, f64::max);
    for (kind, bound) in models().into_iter().zip([1e-15, 0.0, 0.0, 0.0, 2e-15, 5e-14, 1e-11]) {
        let model = fit::fit(&samples, kind).unwrap().fit.model;
        let base: Vec<Xyz> = samples.rgb().iter().map(|rgb| model.xyz(*rgb)).collect();
        let off = [0.01, 0.1, 0.5, 1.5, 10.0].map(|k| {
            let moved: Vec<Xyz> = samples.rgb().iter().map(|rgb| model.xyz(rgb.map(|v| v * k))).collect();
            let differences: Vec<Xyz> = moved
                .iter()
                .zip(&base)
                .map(|(m, b)| Xyz::new(m.x - k * b.x, m.y - k * b.y, m.z - k * b.z))
                .collect();
            largest(&differences) / (k * largest(&base))
        });
        println!("{kind}: {off:?}");
        let worst = off.into_iter().fold(0.0, f64::max);
        if model.is_exposure_invariant() {
            assert!(worst <= bound, "{kind}: {worst:e}");
        } else {
            assert!(worst > 0.02, "{kind}: {worst:e}");
        }
    }
}
