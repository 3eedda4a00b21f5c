use super::*;
use crate::gamut::{self, Primaries};
use darkroot_colour::{Oklab, Vector3, Xyz, oklab, white};
use darkroot_photo::Size;

const LOOKS: [Look; 3] = [Look::Neutral, Look::Vivid, Look::Flat];

/// Linear sRGB of colours of a scene in linear sRGB, toned.
fn shown(scene: &[[f64; 3]], look: Look) -> Vec<[f64; 3]> {
    by_curve(scene, &Curve::of(look, &Tones::default(), None).unwrap())
}

/// The same in the neutral look, changed.
fn shown_with(scene: &[[f64; 3]], tones: &Tones) -> Vec<[f64; 3]> {
    by_curve(scene, &Curve::of(Look::Neutral, tones, None).unwrap())
}

fn by_curve(scene: &[[f64; 3]], curve: &Curve) -> Vec<[f64; 3]> {
    let to_rec2020 = RgbSpace::REC2020.from_xyz_under(white::D65) * RgbSpace::SRGB.to_xyz_under(white::D65);
    let scene: Vec<Vector3> = scene.iter().map(|v| to_rec2020 * Vector3::from(*v)).collect();
    let plane = |c: usize| scene.iter().map(|v| v[c] as f32).collect::<Vec<f32>>();
    let size = Size { width: scene.len(), height: 1 };
    let picture = Rgb::from_planes(size, [plane(0), plane(1), plane(2)]).unwrap();
    let picture = gamut::fit(tone(picture, curve), &Primaries::new(&RgbSpace::SRGB));
    (0..size.width).map(|x| picture.at(x, 0).map(f64::from)).collect()
}

fn of_srgb(rgb: [f64; 3]) -> Oklab {
    Oklab::of(Xyz::from(RgbSpace::SRGB.to_xyz_under(white::D65) * Vector3::from(rgb)))
}

/// Linear sRGB of an Oklab colour.
fn srgb_of(l: f64, chroma: f64, hue: f64) -> [f64; 3] {
    let lab = Vector3::new(l, chroma * hue.to_radians().cos(), chroma * hue.to_radians().sin());
    let cones = oklab::OPPONENTS.try_inverse().unwrap() * lab;
    let xyz = oklab::CONES.try_inverse().unwrap() * cones.map(|v| v * v * v);
    (RgbSpace::SRGB.from_xyz_under(white::D65) * xyz).into()
}

/// The colour of a hue at this share of the most chroma that sRGB has there, its brightest channel 1.
fn of_hue(hue: f64, share: f64) -> [f64; 3] {
    let (mut inside, mut outside) = (0.0, 0.5);
    for _ in 0..40 {
        let middle = (inside + outside) / 2.0;
        let fits = srgb_of(0.6, middle, hue).iter().all(|v| (0.0..=1.0).contains(v));
        if fits { inside = middle } else { outside = middle }
    }
    let rgb = srgb_of(0.6, share * inside, hue);
    let most = rgb.iter().copied().fold(0.0, f64::max);
    rgb.map(|v| v / most)
}

/// A colour from so many stops below clipping to so many above.
fn stops(colour: [f64; 3], from: f64, to: f64) -> Vec<[f64; 3]> {
    let steps = ((to - from) / 0.05).round() as usize;
    (0..=steps).map(|i| colour.map(|v| v * (from + 0.05 * i as f64).exp2())).collect()
}

#[test]
fn every_curve_rises_from_black_to_white() {
    for look in LOOKS {
        let curve = Curve::of(look, &Tones::default(), None).unwrap();
        let mut previous = curve.at(0.0);
        assert!(previous.abs() < 1e-9, "{look:?}");
        for i in 1..=2000 {
            let now = curve.at(i as f32 / 1000.0);
            assert!(now >= previous, "{look:?} at {i}");
            previous = now;
        }
        assert!((curve.at(1.0) - 1.0).abs() < 1e-6, "{look:?}");
        let grey = curve.at(METERED_GREY as f32);
        assert!((0.23..0.29).contains(&grey), "{look:?} {grey}");
    }
}

#[test]
fn contrast_grows_from_flat_to_vivid() {
    let shadows = |look| Curve::of(look, &Tones::default(), None).unwrap().at(0.02);
    assert!(shadows(Look::Flat) > shadows(Look::Neutral) && shadows(Look::Neutral) > shadows(Look::Vivid));
}

#[test]
fn half_saturated_colours_keep_their_hue_up_to_clipping() {
    for look in LOOKS {
        for hue in (0..360).step_by(10) {
            let colour = of_hue(f64::from(hue), 0.5);
            for (rgb, shown) in stops(colour, -4.0, 0.0).iter().zip(shown(&stops(colour, -4.0, 0.0), look)) {
                let (seen, wanted) = (of_srgb(shown), of_srgb(*rgb));
                // What has next to no chroma has no hue.
                if seen.chroma() > 0.01 {
                    let skew = seen.hue_difference(wanted);
                    assert!(skew < 3.0, "{look:?} hue {hue}: {skew} degrees at {rgb:?}");
                }
            }
        }
    }
}

#[test]
fn skin_keeps_its_hue() {
    // Light, medium and dark skin of a colour chart, linear sRGB at the exposure of a metered grey.
    for skin in [[0.56, 0.31, 0.24], [0.30, 0.15, 0.10], [0.17, 0.08, 0.055]] {
        let skin = skin.map(|v: f64| v * METERED_GREY / 0.18);
        let scene = stops(skin, -2.0, 1.5);
        for (rgb, shown) in scene.iter().zip(shown(&scene, Look::Neutral)) {
            let skew = of_srgb(shown).hue_difference(of_srgb(*rgb));
            assert!(skew < 2.0, "{skew} degrees at {rgb:?}");
        }
    }
}

#[test]
fn chroma_falls_smoothly_to_white() {
    for look in LOOKS {
        for hue in (0..360).step_by(15) {
            let shown = shown(&stops(of_hue(f64::from(hue), 0.5), -1.0, 4.0), look);
            let seen: Vec<Oklab> = shown.into_iter().map(of_srgb).collect();
            let most = seen.iter().map(|c| c.chroma()).fold(0.0, f64::max);
            for pair in seen.windows(2) {
                let (step, l) = (pair[1].chroma() - pair[0].chroma(), pair[1].l - pair[0].l);
                assert!(step.abs() < 0.2 * most && l > -0.002, "{look:?} {hue}: {pair:?}");
            }
            assert!(seen[seen.len() - 1].chroma() < 0.01, "{look:?} {hue}");
        }
    }
}

#[test]
fn pure_colours_stay_bright_and_of_their_colour() {
    let at = |rgb: [f64; 3]| shown(&[rgb], Look::Neutral)[0];
    // Yellow is no peach, red no orange, blue neither purple nor grey.
    let yellow = at([0.9, 0.9, 0.0]);
    assert!(yellow[0] > 0.85 && yellow[1] > 0.85 && yellow[2] < 0.25, "{yellow:?}");
    let red = at([0.7, 0.0, 0.0]);
    assert!(red[0] > 0.8 && red[1] < 0.12 && red[2] < 0.12, "{red:?}");
    for light in [0.05, 0.2, 0.5, 1.0] {
        let blue = at([0.0, 0.0, light]);
        assert!(blue[2] > light * 0.7 && blue[0] < 0.02 && blue[1] < 0.065, "{light}: {blue:?}");
    }
}

#[test]
fn noise_about_black_stays_black() {
    let noise = [-0.004, -0.001, 0.0, 0.0005, 0.002];
    for i in 0..125 {
        let scene = [noise[i % 5], noise[i / 5 % 5], noise[i / 25]];
        let shown = shown(&[scene], Look::Neutral)[0];
        assert!(shown.iter().all(|v| *v < 0.004), "{scene:?}: {shown:?}");
    }
}

#[test]
fn grey_stays_grey_and_what_is_no_colour_harms_nothing() {
    let inputs =
        [[0.2f32; 3], [0.0; 3], [-0.1; 3], [7.0; 3], [f32::INFINITY; 3], [f32::NAN; 3], [f32::MAX; 3]];
    for look in LOOKS {
        for v in inputs {
            let picture = Rgb::from_planes(Size { width: 1, height: 1 }, v.map(|v| vec![v])).unwrap();
            let toned = tone(picture, &Curve::of(look, &Tones::default(), None).unwrap()).at(0, 0);
            let wanted = Curve::of(look, &Tones::default(), None).unwrap().at(lesser(v[0], BRIGHTEST));
            assert!(toned.iter().all(|t| (t - wanted).abs() < 2e-6), "{look:?} {v:?}: {toned:?}");
        }
        for v in [[f32::INFINITY, 0.0, 0.1], [0.1, f32::NAN, 0.1], [-1.0, f32::MAX, 0.0], [1e-30, 0.0, 1e-20]]
        {
            let picture = Rgb::from_planes(Size { width: 1, height: 1 }, v.map(|v| vec![v])).unwrap();
            let toned = tone(picture, &Curve::of(look, &Tones::default(), None).unwrap()).at(0, 0);
            assert!(toned.iter().all(|t| t.is_finite()), "{look:?} {v:?}: {toned:?}");
        }
    }
}

#[test]
fn a_changed_curve_rises_from_black_to_white_too() {
    let extremes = [-2.0f32, 0.0, 2.0];
    for shadows in extremes {
        for highlights in extremes {
            for (contrast, white, black) in
                [(-1.0, 1.0, -2.0), (1.0, -1.0, 2.0), (1.0, 1.0, 2.0), (-1.0, -1.0, -2.0)]
            {
                let tones = Tones { contrast, shadows, highlights, black, white, ..Tones::default() };
                for look in LOOKS {
                    let curve = Curve::of(look, &tones, None).unwrap();
                    let mut previous = curve.at(0.0);
                    assert!(previous.abs() < 1e-9);
                    for i in 1..4000 {
                        let now = curve.at((f64::from(i) * 0.01 - 22.0).exp2() as f32);
                        assert!(now >= previous && now <= 1.0, "{look:?} {tones:?} at {i}: {previous} {now}");
                        previous = now;
                    }
                }
            }
        }
    }
}

#[test]
fn the_table_is_the_curve_where_nothing_is_changed_and_zones_move_by_the_stops_asked_for() {
    for look in LOOKS {
        let plain = Curve::of(look, &Tones::default(), None).unwrap();
        let hardly = Curve::of(look, &Tones { contrast: 1e-9, ..Tones::default() }, None).unwrap();
        for i in 0..2000 {
            let light = (f64::from(i) * 0.015 - 20.0).exp2() as f32;
            let (one, other) = (plain.at(light), hardly.at(light));
            assert!((one - other).abs() < 1e-5 + 2e-4 * one, "{look:?} at {light}: {one} {other}");
        }
        let at = |stops: f64| (METERED_GREY * stops.exp2()) as f32;
        for (tones, stops, moved) in [
            (Tones { contrast: 0.5, ..Tones::default() }, 2.0, 0.5),
            (Tones { contrast: 0.5, ..Tones::default() }, -2.0, -0.5),
            (Tones { contrast: 0.5, ..Tones::default() }, 0.0, 0.0),
            (Tones { shadows: 1.0, ..Tones::default() }, -4.0, 1.0),
            (Tones { shadows: 1.0, ..Tones::default() }, 1.0, 0.0),
            (Tones { highlights: -1.0, ..Tones::default() }, 3.5, -1.0),
            (Tones { highlights: -1.0, ..Tones::default() }, -1.0, 0.0),
            (Tones { black: 1.0, ..Tones::default() }, -7.5, 1.0),
            (Tones { white: 0.5, ..Tones::default() }, 3.0, 0.5),
        ] {
            let changed = Curve::of(look, &tones, None).unwrap().at(at(stops));
            let wanted = plain.at(at(stops + moved));
            assert!((changed / wanted - 1.0).abs() < 2e-3, "{look:?} {tones:?}: {changed} {wanted}");
        }
    }
}

#[test]
fn a_curve_by_points_is_what_the_look_shows_in_the_lightness_asked_for() {
    let lightness = |shown: f32| 100.0 * darkroot_colour::TransferCurve::LStar.encode(f64::from(shown));
    let points = Points::new(&[[0.0, 8.0], [30.0, 20.0], [70.0, 80.0]]).unwrap();
    for look in LOOKS {
        let plain = Curve::of(look, &Tones::default(), None).unwrap();
        let curve = Curve::of(look, &Tones { curve: Some(points), ..Tones::default() }, None).unwrap();
        assert!((lightness(curve.at(0.0)) - 8.0).abs() < 1e-3);
        let mut previous = 0.0;
        for i in 0..4000 {
            let light = (f64::from(i) * 0.0075 - 22.0).exp2() as f32;
            let (now, wanted) = (curve.at(light), points.lightness(lightness(plain.at(light))));
            assert!((lightness(now) - wanted).abs() < 0.02, "{look:?} at {light}: {now} {wanted}");
            assert!(now >= previous && now <= 1.0, "{look:?} at {light}");
            previous = now;
        }
    }
}

#[test]
fn saturation_and_vibrance_keep_hue_and_lightness_and_leave_grey() {
    let scene: Vec<[f64; 3]> = (0..12)
        .flat_map(|hue| [0.15, 0.5].map(|share| of_hue(f64::from(hue) * 30.0, share).map(|v| v * 0.15)))
        .chain([[0.18; 3]])
        .collect();
    let plain: Vec<Oklab> = shown_with(&scene, &Tones::default()).into_iter().map(of_srgb).collect();
    let chroma = |c: &Oklab| c.a.hypot(c.b);
    for (tones, pale, rich) in [
        (Tones { saturation: 1.3, ..Tones::default() }, 1.2..1.4, 1.15..1.45),
        (Tones { saturation: 0.5, ..Tones::default() }, 0.45..0.55, 0.4..0.6),
        (Tones { vibrance: 0.5, ..Tones::default() }, 1.15..1.5, 1.0..1.25),
        (Tones { saturation: 0.0, ..Tones::default() }, 0.0..0.01, 0.0..0.01),
    ] {
        let changed: Vec<Oklab> = shown_with(&scene, &tones).into_iter().map(of_srgb).collect();
        for (i, (before, after)) in plain.iter().zip(&changed).enumerate() {
            if i == 24 {
                assert!(chroma(after) < 1e-3 && (before.l - after.l).abs() < 1e-4, "{tones:?}: {after:?}");
                continue;
            }
            let ratio = chroma(after) / chroma(before);
            let range = if i % 2 == 0 { &pale } else { &rich };
            assert!(range.contains(&ratio), "{tones:?} colour {i}: {ratio}");
            assert!((before.l - after.l).abs() < 0.02, "{tones:?} colour {i}: {} {}", before.l, after.l);
            if tones.saturation > 0.0 {
                assert!(after.hue_difference(*before) < 3.0, "{tones:?} colour {i}");
            }
        }
    }
}

#[test]
fn headroom_leaves_dark_light_alone_and_shows_bright_light_in_proportion() {
    for look in LOOKS {
        for stops in [1.0, 2.0, 3.0] {
            let plain = Curve::of(look, &Tones::default(), None).unwrap();
            let high = Curve::of(look, &Tones { headroom: stops, ..Tones::default() }, None).unwrap();
            let peak = stops.exp2();
            let mut previous = 0.0;
            for i in 1..=4000 {
                let light = i as f32 / 500.0;
                let (sdr, hdr) = (plain.at(light), peak * high.at(light));
                assert!(
                    hdr > sdr - 1e-4 && hdr >= previous && hdr <= peak,
                    "{look:?} {stops} at {light}: {sdr} {hdr}"
                );
                if light < METERED_GREY as f32 {
                    assert!(
                        (hdr - sdr).abs() < 1e-3 * sdr.max(0.01),
                        "{look:?} {stops} at {light}: {sdr} {hdr}"
                    );
                }
                previous = hdr;
            }
            // Twice the light is twice as bright where there is room.
            let at = |light| peak * high.at(light);
            if stops >= 2.0 {
                assert!((at(1.0) / at(0.5) - 2.0).abs() < 0.01, "{look:?} {}", at(1.0) / at(0.5));
            }
            assert!(at(1e5) > 0.999 * peak, "{look:?}");
        }
    }
}
