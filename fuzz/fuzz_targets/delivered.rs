#![no_main]

//! Finished pictures through their own colour profiles.

use std::sync::LazyLock;

use darkroot::charts;
use darkroot::deliver::{DeliveryRequest, judge};
use darkroot_fuzz::as_file;
use libfuzzer_sys::fuzz_target;

static REQUEST: LazyLock<DeliveryRequest> = LazyLock::new(|| {
    let layout = charts::layout("classic24").expect("it is built in");
    let reference = charts::reference(None, &layout).expect("it is built in").colours;
    // By hand, so that pictures that show no chart go all the way.
    let corners = Some([[2.0, 2.0], [60.0, 3.0], [61.0, 44.0], [3.0, 43.0]]);
    DeliveryRequest {
        layout,
        reference,
        corners,
        exclude: Vec::new(),
        flat: None,
        pitch: None,
        pixels_per_degree: darkroot::deliver::PIXELS_PER_DEGREE,
        light: None,
        accept: true,
    }
});

fuzz_target!(|bytes: &[u8]| {
    for name in ["picture.tif", "picture.jpg"] {
        as_file(name, bytes, |path| {
            let _ = judge(path, &REQUEST);
        });
    }
});
