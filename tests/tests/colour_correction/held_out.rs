//! Colours, cameras and lights that took no part in choosing anything: 16 cameras, three lights, four sets of
//! reflectances, each model fitted to 24 patches and to 96.

use darkroot_colour::{Spectrum, Xyz};
use darkroot_profile::fit;
use darkroot_profile::{Errors, Kind, Order};
use rayon::prelude::*;

use super::data;

const CAMERAS: [&str; 16] = [
    "camspec_nikon_d3",
    "camspec_nikon_d300s",
    "camspec_nikon_d50",
    "camspec_nikon_d90",
    "camspec_nikon_d3x",
    "camspec_canon_40d",
    "camspec_canon_500d",
    "camspec_canon_1dmarkiii",
    "camspec_pentax_k5",
    "camspec_olympus_epl2",
    "camspec_phase_one",
    "butcherg_nikon_d7000",
    "butcherg_nikon_d3500",
    "rawtoaces_arri_d21",
    "rawtoaces_sony_ilce-7rm2",
    "rawtoaces_nikon_d70",
];
const LIGHTS: [&str; 3] = ["D50", "FL11", "LED-B5"];

/// Every camera under every light.
pub(super) fn cases() -> Vec<(&'static str, &'static str)> {
    CAMERAS.iter().flat_map(|camera| LIGHTS.iter().map(move |light| (*camera, *light))).collect()
}

/// The colours that are judged.
pub(super) fn unseen() -> Vec<Spectrum> {
    let mut all = data::dc_180();
    for name in ["refl_rawtoaces190", "refl_iset_esserchart", "refl_iset_clothes_vhrel"] {
        all.extend(data::reflectances(name));
    }
    all
}

/// Mean over cameras and lights of the mean, 95th percentile and maximum of CIEDE2000.
fn held_out(chart: &[Spectrum], kind: Kind) -> [f64; 3] {
    let unseen = unseen();
    let one = |(camera, light): (&str, &str)| {
        let light = data::light(light);
        let camera = data::camera(camera).under(&light).unwrap();
        let model = fit::fit(&camera.render(chart, &light).unwrap(), kind).unwrap().fit.model;
        let truth = camera.render(&unseen, &light).unwrap();
        let estimates: Vec<Xyz> = truth.rgb().iter().map(|rgb| model.xyz(*rgb)).collect();
        let s = Errors::between(&estimates, truth.xyz(), truth.white()).de2000;
        [s.mean, s.p95, s.max]
    };
    let all: Vec<[f64; 3]> = cases().into_par_iter().map(one).collect();
    [0, 1, 2].map(|k| all.iter().map(|v| v[k]).sum::<f64>() / all.len() as f64)
}

fn assert_held_out(kind: Kind, expected: [[f64; 3]; 2]) {
    for (chart, expected) in [data::classic_24(), data::sg_96()].iter().zip(expected) {
        let found = held_out(chart, kind);
        println!("{kind} on {}: {found:.3?}", chart.len());
        assert!((found[0] - expected[0]).abs() <= 0.02, "{kind}: {found:.3?}, expected {expected:?}");
        assert!(found[1] <= expected[1] + 0.05 && found[2] <= expected[2] + 0.2, "{kind}: {found:.3?}");
    }
}

#[test]
#[cfg_attr(not(has_spectra), ignore = "needs `spectra` in DARKROOT_DATA")]
fn a_matrix_is_as_good_as_it_should_be() {
    assert_held_out(Kind::Linear, [[1.00, 2.65, 5.1], [1.00, 2.59, 4.9]]);
}

#[test]
#[cfg_attr(not(has_spectra), ignore = "needs `spectra` in DARKROOT_DATA")]
fn the_papers_root_polynomial_is_as_good_as_it_should_be() {
    assert_held_out(Kind::Root(Order::Two), [[0.75, 2.09, 7.3], [0.68, 1.72, 4.4]]);
}

#[test]
#[cfg_attr(not(has_spectra), ignore = "needs `spectra` in DARKROOT_DATA")]
fn the_anchored_model_is_as_good_as_it_should_be() {
    assert_held_out(Kind::Anchored, [[0.67, 1.86, 4.0], [0.62, 1.64, 3.2]]);
}

#[test]
#[cfg_attr(not(has_spectra), ignore = "needs `spectra` in DARKROOT_DATA")]
fn the_hue_plane_model_is_as_good_as_it_should_be() {
    assert_held_out(Kind::HuePlane, [[0.63, 1.66, 3.2], [0.65, 1.62, 2.9]]);
}

#[test]
#[cfg_attr(not(has_spectra), ignore = "needs `spectra` in DARKROOT_DATA")]
fn the_mean_of_both_is_as_good_as_it_should_be() {
    assert_held_out(Kind::Half, [[0.62, 1.65, 3.2], [0.60, 1.54, 2.9]]);
}
