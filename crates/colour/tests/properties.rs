//! What holds for every colour, white and spectrum.

use darkroot_colour::difference::{de_uv, de76, de94, de2000, de2000_sl1};
use darkroot_colour::temperature::Temperature;
use darkroot_colour::{Cat, Illuminant, Lab, Measured, RgbSpace, Spectrum, TristimulusWeights, Xyz, white};
use proptest::prelude::*;

fn near(one: Xyz, two: Xyz, tolerance: f64) -> bool {
    (one.x - two.x).abs().max((one.y - two.y).abs()).max((one.z - two.z).abs()) < tolerance
}

prop_compose! {
    fn any_xyz()(x in 1e-4..1.5f64, y in 1e-4..1.5f64, z in 1e-4..1.5f64) -> Xyz {
        Xyz::new(x, y, z)
    }
}

prop_compose! {
    fn any_lab()(l in 0.0..100.0f64, a in -128.0..128.0f64, b in -128.0..128.0f64) -> Lab {
        Lab { l, a, b }
    }
}

prop_compose! {
    fn any_light()(i in 0..darkroot_colour::illuminant::ILLUMINANTS.len()) -> Illuminant {
        darkroot_colour::illuminant::ILLUMINANTS[i]
    }
}

fn any_cat() -> impl Strategy<Value = Cat> {
    prop_oneof![Just(Cat::Bradford), Just(Cat::Cat02), Just(Cat::Cat16)]
}

proptest! {
    #[test]
    fn adaptation_there_and_back_is_the_same_colour(c in any_xyz(), cat in any_cat(), light in any_light()) {
        let there = cat.adapt(c, light.white(), white::D50);
        prop_assert!(near(cat.adapt(there, white::D50, light.white()), c, 1e-12));
    }

    #[test]
    fn adaptation_takes_white_to_white(cat in any_cat(), from in any_light(), to in any_light()) {
        prop_assert!(near(cat.adapt(from.white(), from.white(), to.white()), to.white(), 1e-12));
    }

    #[test]
    fn lab_and_luv_and_back_are_the_same_colour(c in any_xyz(), light in any_light()) {
        let white = light.white();
        prop_assert!(near(c.lab(white).xyz(white), c, 1e-12));
        prop_assert!(near(c.luv(white).xyz(white), c, 1e-10));
    }

    #[test]
    fn chromaticity_and_back_is_the_same(c in any_xyz()) {
        let xy = c.xy().unwrap();
        let back = xy.uv_prime().xy();
        prop_assert!((back.x - xy.x).abs() < 1e-12 && (back.y - xy.y).abs() < 1e-12);
    }

    #[test]
    fn a_colour_does_not_differ_from_itself(c in any_lab()) {
        for de in [de76, de94, de2000, de2000_sl1] {
            prop_assert!(de(c, c).abs() < 1e-12);
        }
    }

    #[test]
    fn symmetrical_differences_are_symmetrical(one in any_lab(), two in any_lab()) {
        for de in [de76, de2000, de2000_sl1] {
            let there = de(one, two);
            prop_assert!(there >= 0.0 && (de(two, one) - there).abs() < 1e-9 * (1.0 + there));
        }
    }

    #[test]
    fn distances_in_luv_obey_the_triangle(a in any_xyz(), b in any_xyz(), c in any_xyz()) {
        let [a, b, c] = [a, b, c].map(|xyz| xyz.luv(white::D65));
        prop_assert!(de_uv(a, c) <= de_uv(a, b) + de_uv(b, c) + 1e-9);
    }

    #[test]
    fn greys_keep_the_white_of_the_light(grey in 0.0..1.0f64, light in any_light()) {
        let found = Spectrum::constant(grey).reflected_xyz(&light.spectrum());
        prop_assert!(near(found, light.white().scaled(grey), 1e-12));
    }

    #[test]
    fn weights_do_not_depend_on_the_strength_of_the_light(k in 1e-6..1e6f64, light in any_light()) {
        let nm = darkroot_colour::observer::every_ten_nm();
        let weights = |k| TristimulusWeights::new(&light.spectrum().scaled(k), &nm).unwrap().white();
        prop_assert!(near(weights(k), weights(1.0), 1e-12));
    }

    #[test]
    fn measured_spectra_stay_within_what_was_measured(values in proptest::collection::vec(0.0..1.0f64, 31..=31)) {
        let measured = Measured::new(&darkroot_colour::observer::every_ten_nm(), &values).unwrap();
        let low = values.iter().copied().fold(f64::MAX, f64::min) - 1e-12;
        let high = values.iter().copied().fold(0.0, f64::max) + 1e-12;
        for spectrum in [measured.spectrum(), measured.averaged()] {
            prop_assert!(spectrum.0.iter().all(|v| (low..=high).contains(v)));
        }
        for (nm, value) in darkroot_colour::observer::every_ten_nm().into_iter().zip(&values) {
            prop_assert!((measured.smooth().unwrap().at(nm) - value).abs() < 1e-9);
        }
    }

    #[test]
    fn temperature_and_back_is_the_same_white(mired in 40.0..600.0f64, duv in -0.02..0.02f64) {
        let kelvin = 1e6 / mired;
        let back = Temperature::of(Temperature { kelvin, duv }.xy());
        prop_assert!((1e6 / back.kelvin - mired).abs() < 0.02 && (back.duv - duv).abs() < 1e-5, "{back:?}");
    }

    #[test]
    fn rgb_to_xyz_and_back_is_the_same(r in 0.0..1.0f64, g in 0.0..1.0f64, b in 0.0..1.0f64) {
        for space in [RgbSpace::SRGB, RgbSpace::PROPHOTO, RgbSpace::ACES2065_1, RgbSpace::ACESCG] {
            let rgb = darkroot_colour::Vector3::new(r, g, b);
            let back = space.from_xyz_under(white::D50) * (space.to_xyz_under(white::D50) * rgb);
            prop_assert!((back - rgb).amax() < 1e-12);
        }
    }
}
