//! Pictures as a lens draws them, and files in which makers' notes describe that lens.

use darkroot_colour::Spectrum;
use darkroot_photo::{BlackLevel, Capture, Counts, Layout, Size};
use darkroot_simulate::expose::expose;
use darkroot_simulate::makers::{self, RafNotes};
use darkroot_simulate::{Camera, Exposure, Scene};

const SIZE: Size = Size { width: 608, height: 400 };

/// By what the radius of a place is multiplied by the lens: red and blue lie off green.
fn factor(channel: usize, r: f64) -> f64 {
    let off = [0.0012, 0.0, -0.0008][channel] * r * r;
    (1.0 - 0.09 * r * r + 0.02 * r.powi(4)) * (1.0 + off)
}

/// What is left of the light.
fn light(r: f64) -> f64 {
    1.0 - 0.4 * r * r
}

/// What is photographed.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Motif {
    /// Bright lines.
    Upright,
    Level,
    /// An even grey.
    Grey,
}

/// A capture by a camera of so many bits, as that lens draws it.
pub(super) fn drawn(bits: u8, motif: Motif) -> Capture {
    let white = if bits == 12 { 4000 } else { 15_892 };
    let black = if bits == 12 { 256.0 } else { 512.0 };
    let camera =
        Camera { bits, white, black: BlackLevel::uniform(black), crop: 0, ..Camera::simulated_one() };
    let grey = Scene::flat(SIZE, Spectrum::constant(0.5));
    let mut capture = expose(&grey, &camera, &Exposure::default());
    let neutral = camera.neutral(&Exposure::default().light);
    let Counts::U16(mosaic) = &mut capture.counts else { panic!("whole numbers") };
    let Layout::Cfa(cfa) = mosaic.layout.clone() else { panic!("a filter array") };
    let (cx, cy) = (SIZE.width as f64 / 2.0, SIZE.height as f64 / 2.0);
    let reach = cx.hypot(cy);
    for (i, sample) in mosaic.samples.iter_mut().enumerate() {
        let (x, y) = (i % SIZE.width, i / SIZE.width);
        let channel = cfa.at(x, y).plane().unwrap();
        let (dx, dy) = (x as f64 + 0.5 - cx, y as f64 + 0.5 - cy);
        let taken = dx.hypot(dy) / reach;
        let straight = (0..40).fold(taken, |r, _| taken / factor(channel, r));
        let [u, v] = [dx, dy].map(|d| d * if taken > 0.0 { straight / taken } else { 1.0 });
        let near = |w: f64| (w / 60.0 - (w / 60.0).round()).abs() * 60.0;
        let line = |away: f64| (-0.5 * (away / 3.0).powi(2)).exp();
        let shown = match motif {
            Motif::Upright => 0.05 + 0.6 * line(near(u)),
            Motif::Level => 0.05 + 0.6 * line(near(v)),
            Motif::Grey => 0.4,
        };
        let share = shown * light(taken) * neutral[channel];
        *sample = (f64::from(black) + share * (f64::from(white) - f64::from(black))).round() as u16;
    }
    capture
}

/// Distortion and colours at so many knots, as Sony writes them.
fn of_sony(knots: usize) -> Vec<makers::List<i16>> {
    let list = |unit: f64, value: &dyn Fn(f64) -> f64| -> Vec<i16> {
        (0..knots).map(|i| (unit * value((i as f64 + 0.5) / (knots as f64 - 1.0))).round() as i16).collect()
    };
    let distortion = list(16384.0, &|r| factor(1, r) - 1.0);
    let apart = |c: usize| list(2_097_152.0, &|r| factor(c, r) / factor(1, r) - 1.0);
    let counted = |lists: &[Vec<i16>]| {
        let all = lists.concat();
        [vec![all.len() as i16], all].concat()
    };
    vec![
        (0x7032, counted(&[vec![3000; knots]])),
        (0x7035, counted(&[apart(0), apart(2)])),
        (0x7037, counted(&[distortion])),
    ]
}

/// The same as Olympus writes it.
fn of_olympus() -> Vec<makers::List<f32>> {
    vec![(0x150a, vec![-0.09, 0.02, 0.0, 1.0]), (0x150c, vec![0.0, 0.0012, 0.0, 0.0, -0.0008, 0.0])]
}

/// The same as Fujifilm's newer or older cameras write it, with the light.
fn of_fujifilm(newer: bool) -> Vec<makers::List<f64>> {
    let knots: Vec<f64> = if newer {
        vec![0.353_521, 0.5, 0.612_676, 0.707_042, 0.790_845, 0.866_197, 0.935_211, 1.0, 1.060_563]
    } else {
        (0..=10).map(|i| f64::from(i) / 10.0).collect()
    };
    // Knots are radii as taken.
    let straight = |taken: f64| (0..60).fold(taken, |r, _| taken / factor(1, r));
    let values = |knots: &[f64], of: &dyn Fn(f64) -> f64| knots.iter().map(|&r| of(r)).collect::<Vec<f64>>();
    let distortion = values(&knots, &|taken| 100.0 * (factor(1, straight(taken)) - 1.0));
    let of_colours = if newer { &knots[..] } else { &knots[1..] };
    let apart =
        |c: usize| values(of_colours, &|taken| factor(c, straight(taken)) / factor(1, straight(taken)) - 1.0);
    let unknown = vec![416.555_556];
    let last = if newer { unknown.clone() } else { Vec::new() };
    vec![
        (0xf00b, [unknown.clone(), knots.clone(), distortion].concat()),
        (0xf00f, [unknown.clone(), of_colours.to_vec(), apart(0), apart(2), last].concat()),
        (0xf010, [unknown, knots.clone(), values(&knots, &|taken| 100.0 * light(taken))].concat()),
    ]
}

/// Files of all makers, with what they are called.
pub(super) fn files(motif: Motif) -> Vec<(&'static str, Vec<u8>)> {
    let raf = |newer| RafNotes { lens: of_fujifilm(newer), ..RafNotes::default() };
    vec![
        ("sony16.arw", makers::arw(&drawn(14, motif), &of_sony(16), None).unwrap()),
        ("sony11.arw", makers::arw(&drawn(14, motif), &of_sony(11), None).unwrap()),
        ("olympus.orf", makers::orf(&drawn(12, motif), &of_olympus()).unwrap()),
        ("fuji9.raf", makers::raf(&drawn(14, motif), &raf(true)).unwrap()),
        ("fuji11.raf", makers::raf(&drawn(14, motif), &raf(false)).unwrap()),
    ]
}
