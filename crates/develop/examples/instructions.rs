//! Runs a stage so many times over the same half megapixel, for a program that counts instructions:
//! `valgrind --tool=callgrind instructions STAGE TIMES`. `tests/instructions/guard.py` takes the difference of two counts.
//! Without arguments it names the stages. At the end it says a sum over the bits of what the stage gave, which must not depend on
//! the vectors that the processor has: those that valgrind gives a program are narrower than those of a new machine.

#![allow(clippy::print_stdout)]

use std::hint::black_box;
use std::sync::Arc;

use darkroot_colour::{RgbSpace, TransferCurve};
use darkroot_develop::demosaic::Method;
use darkroot_develop::gamut::Primaries;
use darkroot_develop::level::Levels;
use darkroot_develop::sharpen::Sharpener;
use darkroot_develop::tone::{Curve, Tones};
use darkroot_develop::transfer::Encoder;
use darkroot_develop::{
    Analysis, Cancel, Demosaic, Geometry, Look, Recipe, Scale, balance, correct, demosaic, gamut, plan,
    sharpen, tone, transfer,
};
use darkroot_photo::{Counts, Display, Rgb, Samples, Scene, Toned};
use darkroot_profile::Order;

#[path = "../benches/fixture/mod.rs"]
mod fixture;
use fixture::{BORDER, SIZE, X_TRANS, capture, model, mosaic, planes};

/// A stage ready to run as often as it is asked to. It tells what came out to whoever wants to know.
type Ready = Box<dyn FnMut(&mut Option<Sum>)>;

/// Over the bits of numbers, in their order.
#[derive(Default)]
struct Sum(u64);

impl Sum {
    fn add<T: Copy>(&mut self, numbers: &[T], bits: impl Fn(T) -> u64) {
        self.0 = numbers.iter().fold(self.0, |sum, n| (sum ^ bits(*n)).wrapping_mul(0x0100_0000_01b3));
    }

    fn add_row(&mut self, row: &[f32]) {
        self.add(row, |v| u64::from(v.to_bits()));
    }

    fn add_picture<S>(&mut self, picture: &Rgb<S>) {
        picture.planes().iter().for_each(|plane| self.add_row(plane));
    }
}

fn level_and_balance() -> Option<Ready> {
    let capture = capture();
    let layout = capture.counts.layout().clone();
    let levels = Levels::new(&capture);
    let mut row = vec![0f32; SIZE.width];
    Some(Box::new(move |sum| {
        let Counts::U16(counts) = &capture.counts else { return };
        for (y, stored) in counts.samples.chunks_exact(SIZE.width).enumerate() {
            levels.row(stored, 0, y, &mut row);
            balance::row(&mut row, &layout, [2.0, 1.0, 1.5], 0, y);
            black_box(&row);
            sum.iter_mut().for_each(|sum| sum.add_row(&row));
        }
    }))
}

fn interpolation(array: &str) -> Option<Ready> {
    let mosaic = mosaic(array);
    let method = Method::of(&mosaic.layout, Demosaic::Best)?;
    let mut picture = Rgb::black(SIZE);
    Some(Box::new(move |sum| {
        demosaic::demosaic(black_box(&mosaic), method, BORDER, &mut picture);
        sum.iter_mut().for_each(|sum| sum.add_picture(&picture));
    }))
}

fn sharpening() -> Ready {
    let (wide, sharpener) = (planes(), Sharpener::of(0.6, 1.0, None, [1.0; 3], 1.0));
    let (mut scratch, mut picture) = (sharpen::Scratch::default(), Rgb::black(SIZE));
    Box::new(move |sum| {
        sharpen::sharpen(black_box(&wide), &sharpener, &mut scratch, &mut picture);
        sum.iter_mut().for_each(|sum| sum.add_picture(&picture));
    })
}

fn correction(order: Order) -> Ready {
    let model = model(order);
    // Its results become its input: no value costs more than another.
    let mut picture = Some(planes());
    Box::new(move |sum| {
        picture = picture.take().map(|p| correct::correct(p, &model).into_space());
        sum.iter_mut().zip(&picture).for_each(|(sum, picture)| sum.add_picture(picture));
    })
}

fn tone_and_gamut() -> Option<Ready> {
    let curve = Curve::of(Look::Neutral, &Tones::default(), None)?;
    let primaries = Primaries::new(&RgbSpace::SRGB);
    let mut picture = Some(planes::<Scene>());
    Some(Box::new(move |sum| {
        let toned: Option<Rgb<Toned>> = picture.take().map(|p| tone::tone(p, &curve));
        picture = toned.map(|p| gamut::fit(p, &primaries).into_space());
        sum.iter_mut().zip(&picture).for_each(|(sum, picture)| sum.add_picture(picture));
    }))
}

/// A view of 1024 x 512 pixels that is interpolated, and with `angle` 0 the same without: what the map costs is the difference.
fn warped(angle: f64) -> Option<Ready> {
    let analysis = Analysis::deferred(Arc::new(capture()));
    let geometry = Geometry { straighten: angle, ..Geometry::default() };
    let recipe = Recipe { geometry, ..Recipe::default() };
    let plan = plan(&analysis, None, &recipe).ok()?;
    let cancel = Cancel::default();
    Some(Box::new(move |sum| {
        let picture = black_box(plan.render(plan.whole(Scale::FULL), &cancel).ok());
        if let (Some(sum), Some(Samples::U8(samples))) = (sum, picture.map(|p| p.samples)) {
            sum.add(&samples, u64::from);
        }
    }))
}

fn to_8_bits() -> Option<Ready> {
    let encoder = Encoder::new(TransferCurve::Srgb);
    let display = planes::<Display>();
    let mut samples = vec![0u8; 3 * SIZE.area()];
    Some(Box::new(move |sum| {
        transfer::encode(display.planes(), &encoder, black_box(&mut samples));
        sum.iter_mut().for_each(|sum| sum.add(&samples, u64::from));
    }))
}

const STAGES: [&str; 10] = [
    "level and balance",
    "Bayer",
    "X-Trans",
    "sharpen",
    "order 2",
    "order 4",
    "tone and gamut",
    "transfer to 8 bits",
    "as it is",
    "straightened",
];

fn ready(stage: &str) -> Option<Ready> {
    match stage {
        "level and balance" => level_and_balance(),
        "Bayer" => interpolation("RGGB"),
        "X-Trans" => interpolation(X_TRANS),
        "sharpen" => Some(sharpening()),
        "order 2" => Some(correction(Order::Two)),
        "order 4" => Some(correction(Order::Four)),
        "tone and gamut" => tone_and_gamut(),
        "transfer to 8 bits" => to_8_bits(),
        "as it is" => warped(0.0),
        "straightened" => warped(0.5),
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
    for _ in 1..times {
        run(&mut None);
    }
    let mut sum = Some(Sum::default());
    run(&mut sum);
    println!("{:016x}", sum.unwrap_or_default().0);
}
