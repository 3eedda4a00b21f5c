//! Runs a stage so many times over the same half megapixel, for a program that counts instructions:
//! `valgrind --tool=callgrind instructions STAGE TIMES`. `tests/instructions/guard.py` takes the difference of two counts.
//! Without arguments it names the stages.

#![allow(clippy::print_stdout)]

use std::hint::black_box;

use darkroot_colour::{RgbSpace, TransferCurve};
use darkroot_develop::demosaic::Method;
use darkroot_develop::gamut::Primaries;
use darkroot_develop::level::Levels;
use darkroot_develop::tone::Curve;
use darkroot_develop::transfer::Encoder;
use darkroot_develop::{Demosaic, Look, balance, correct, demosaic, gamut, tone, transfer};
use darkroot_photo::{
    BlackLevel, Capture, Cfa, Counts, Display, Layout, Mosaic, Rgb, Scene, Size, Toned, WhiteLevel,
};
use darkroot_profile::{Order, PlaneModel, RootPolynomial};

const SIZE: Size = Size { width: 1024, height: 512 };
const BORDER: usize = 16;

/// Light with smooth shading, edges and noise.
fn light(i: usize, width: usize) -> f32 {
    let (x, y) = (i % width, i / width);
    let edge = if (x / 37 + y / 23) % 3 == 0 { 0.5 } else { 0.1 };
    edge + 0.2 * (x as f32 / width as f32) + ((x * 7919 + y * 104_729) % 1000) as f32 * 2e-5
}

fn planes<S>() -> Rgb<S> {
    let plane = |k: f32| (0..SIZE.area()).map(|i| light(i, SIZE.width) * k).collect();
    Rgb::from_planes(SIZE, [plane(0.8), plane(1.0), plane(0.5)]).unwrap_or_else(|| Rgb::black(SIZE))
}

/// A stage ready to run as often as it is asked to.
type Ready = Box<dyn FnMut()>;

fn level_and_balance() -> Option<Ready> {
    let layout = Layout::Cfa(Cfa::parse("RGGB")?);
    let samples = (0..SIZE.area()).map(|i| (light(i, SIZE.width) * 15000.0) as u16).collect();
    let counts = Counts::U16(Mosaic { size: SIZE, layout: layout.clone(), samples });
    let capture = Capture {
        black: BlackLevel::uniform(512.0),
        white: WhiteLevel([16383.0; 3]),
        ..Capture::bare(counts)
    };
    let levels = Levels::new(&capture);
    let mut row = vec![0f32; SIZE.width];
    Some(Box::new(move || {
        let Counts::U16(counts) = &capture.counts else { return };
        for (y, stored) in counts.samples.chunks_exact(SIZE.width).enumerate() {
            levels.row(stored, 0, y, &mut row);
            balance::row(&mut row, &layout, [2.0, 1.0, 1.5], 0, y);
            black_box(&row);
        }
    }))
}

fn interpolation(array: &str) -> Option<Ready> {
    let size = Size { width: SIZE.width + 2 * BORDER, height: SIZE.height + 2 * BORDER };
    let samples = (0..size.area()).map(|i| light(i, size.width)).collect();
    let mosaic = Mosaic { size, layout: Layout::Cfa(Cfa::parse(array)?), samples };
    let method = Method::of(&mosaic.layout, Demosaic::Best)?;
    let mut picture = Rgb::black(SIZE);
    Some(Box::new(move || demosaic::demosaic(black_box(&mosaic), method, BORDER, &mut picture)))
}

fn correction(order: Order) -> Option<Ready> {
    let terms = order.terms().len();
    let coefficients = (0..terms).map(|i| [0.5, 0.4, 0.3].map(|c| c / (1.0 + i as f64))).collect();
    let model = PlaneModel::new(&RootPolynomial::new(order, coefficients)?.into());
    // Its results become its input: they must not grow without end, and no value costs more than another.
    let mut picture = Some(planes());
    Some(Box::new(move || picture = picture.take().map(|p| correct::correct(p, &model).into_space())))
}

fn tone_and_gamut() -> Option<Ready> {
    let curve = Curve::of(Look::Neutral)?;
    let primaries = Primaries::new(&RgbSpace::SRGB);
    let mut picture = Some(planes::<Scene>());
    Some(Box::new(move || {
        let toned: Option<Rgb<Toned>> = picture.take().map(|p| tone::tone(p, curve));
        picture = toned.map(|p| gamut::fit(p, &primaries).into_space());
    }))
}

fn to_8_bits() -> Option<Ready> {
    let encoder = Encoder::new(TransferCurve::Srgb);
    let display = planes::<Display>();
    let mut samples = vec![0u8; 3 * SIZE.area()];
    Some(Box::new(move || transfer::encode(display.planes(), &encoder, black_box(&mut samples))))
}

const STAGES: [&str; 7] =
    ["level and balance", "Bayer", "X-Trans", "order 2", "order 4", "tone and gamut", "transfer to 8 bits"];

fn ready(stage: &str) -> Option<Ready> {
    match stage {
        "level and balance" => level_and_balance(),
        "Bayer" => interpolation("RGGB"),
        "X-Trans" => interpolation("GBGGRG RGRBGB GBGGRG GRGGBG BGBRGR GRGGBG"),
        "order 2" => correction(Order::Two),
        "order 4" => correction(Order::Four),
        "tone and gamut" => tone_and_gamut(),
        "transfer to 8 bits" => to_8_bits(),
        _ => None,
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [stage, times] = &arguments[..] else {
        println!("{}", STAGES.join("\n"));
        return;
    };
    let (Some(mut run), Ok(times)) = (ready(stage), times.parse::<u32>()) else {
        println!("no stage `{stage}`, or `{times}` is no number");
        return;
    };
    for _ in 0..times {
        run();
    }
}
