use darkroot_photo::Cfa;

use super::*;

fn demosaic(mosaic: &Mosaic<f32>, method: Method, border: usize) -> Rgb<CameraSpace> {
    let mut picture = Rgb::black(Size { width: 0, height: 0 });
    super::demosaic(mosaic, method, border, &mut picture);
    picture
}

fn mosaic(cfa: &Cfa, size: Size, light: impl Fn(usize, usize, usize) -> f32) -> Mosaic<f32> {
    let samples = (0..size.area())
        .map(|i| {
            let (x, y) = (i % size.width, i / size.width);
            light(x, y, cfa.at(x, y).plane().unwrap())
        })
        .collect();
    Mosaic { size, layout: Layout::Cfa(cfa.clone()), samples }
}

const X_TRANS: &str = "GBGGRG RGRBGB GBGGRG GRGGBG BGBRGR GRGGBG";
const SIZE: Size = Size { width: 48, height: 40 };

fn methods() -> Vec<(Cfa, Method)> {
    let bayer = Cfa::parse("RGGB").unwrap();
    let mut all: Vec<(Cfa, Method)> = (0..4).map(|i| (bayer.shifted(i % 2, i / 2), Method::Lmmse)).collect();
    all.push((bayer, Method::Bilinear));
    let x_trans = Cfa::parse(X_TRANS).unwrap();
    all.extend((0..18).map(|i| (x_trans.shifted(i % 6, i / 6), Method::XTrans)));
    all.push((x_trans, Method::Bilinear));
    all
}

#[test]
fn a_flat_field_stays_flat() {
    for (cfa, method) in methods() {
        let flat = [0.3, 0.5, 0.7];
        let picture = demosaic(&mosaic(&cfa, SIZE, |_, _, c| flat[c]), method, 14);
        for (plane, expected) in picture.planes().iter().zip(flat) {
            assert!(plane.iter().all(|v| (v - expected).abs() < 1e-5), "{method:?} {cfa}");
        }
    }
}

#[test]
fn a_grey_ramp_stays_grey() {
    for (cfa, method) in methods() {
        // Linear in the square root, the domain of interpolation.
        let ramp = |x: usize, y: usize, _| ((x as f32 + 2.0 * y as f32) / 200.0).powi(2);
        let picture = demosaic(&mosaic(&cfa, SIZE, ramp), method, 14);
        for y in 0..picture.size().height {
            for x in 0..picture.size().width {
                let expected = ramp(x + 14, y + 14, 0);
                assert!(
                    picture.at(x, y).iter().all(|v| (v - expected).abs() < 0.02),
                    "{method:?} {cfa} at {x},{y}: {:?} is not {expected}",
                    picture.at(x, y)
                );
            }
        }
    }
}

#[test]
fn twice_the_light_is_twice_the_picture() {
    for (cfa, method) in methods() {
        let noise =
            |x: usize, y: usize, c: usize| ((x * 7919 + y * 104_729 + c * 31) % 1000) as f32 / 1000.0 - 0.05;
        let one = demosaic(&mosaic(&cfa, SIZE, noise), method, 14);
        let two = demosaic(&mosaic(&cfa, SIZE, |x, y, c| 2.0 * noise(x, y, c)), method, 14);
        for (a, b) in one.planes().iter().zip(two.planes()) {
            for (a, b) in a.iter().zip(b) {
                assert!((2.0 * a - b).abs() < 1e-4, "{method:?} {cfa}: {a} {b}");
            }
        }
    }
}

#[test]
fn a_pixel_does_not_depend_on_where_its_tile_begins() {
    for (cfa, method) in methods() {
        let light = |x: usize, y: usize, c: usize| ((x * 7919 + y * 104_729 + c * 31) % 1000) as f32 / 1000.0;
        let border = method.stage().border;
        let whole = demosaic(&mosaic(&cfa, SIZE, light), method, border);
        for (x0, y0) in [(1, 0), (0, 1), (5, 3), (8, 4)] {
            let size = Size { width: 37, height: 33 };
            let part = mosaic(&cfa.shifted(x0, y0), size, |x, y, c| light(x + x0, y + y0, c));
            let part = demosaic(&part, method, border);
            for y in 0..part.size().height {
                for x in 0..part.size().width {
                    let bits = |rgb: [f32; 3]| rgb.map(f32::to_bits);
                    let (a, b) = (whole.at(x + x0, y + y0), part.at(x, y));
                    assert_eq!(bits(a), bits(b), "{method:?} {cfa} at {x},{y}");
                }
            }
        }
    }
}

#[test]
fn samples_that_were_measured_are_kept() {
    let light = |x: usize, y: usize, _| ((x * 31 + y * 17) % 100) as f32 / 100.0;
    for (cfa, method) in methods() {
        let picture = demosaic(&mosaic(&cfa, SIZE, light), method, 14);
        for y in 0..picture.size().height {
            for x in 0..picture.size().width {
                let plane = cfa.at(x + 14, y + 14).plane().unwrap();
                assert!((picture.at(x, y)[plane] - light(x + 14, y + 14, 0)).abs() < 1e-5);
            }
        }
    }
}

#[test]
fn an_array_with_the_counts_of_x_trans_in_another_order_is_no_x_trans() {
    let of = |letters: &str| Method::of(&Layout::Cfa(Cfa::parse(letters).unwrap()), Demosaic::Best);
    assert_eq!(of(X_TRANS), Some(Method::XTrans));
    assert_eq!(of("GBGGRG RGRBGB GBGGRG GRGGBG BGBRGR GRGGGB"), Some(Method::Bilinear));
}
