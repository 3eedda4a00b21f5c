//! Things with rows and columns that are no charts.

#![allow(clippy::unwrap_used, reason = "what cannot be set up shall fail")]

use darkroot_chart::{ChartLayout, Homography, SearchImage};

use super::{Random, Shot, hash};

/// Every kind of clutter.
pub(crate) const KINDS: [&str; 14] = [
    "keyboard",
    "calculator",
    "window front",
    "tiles",
    "qr code",
    "brick",
    "text",
    "coloured grid",
    "coloured 6 by 4",
    "book shelf",
    "swatches",
    "shuffled classic",
    "mirrored classic",
    "checks",
];

/// Size of the pictures.
const SIZE: [usize; 2] = [480, 360];

/// A picture of a kind of clutter, the same for the same number.
pub(crate) fn picture(kind: &str, number: u64) -> SearchImage {
    let mut random = Random(hash(77, number as i64, kind.bytes().map(i64::from).sum()));
    let pattern = pattern(kind, &mut random);
    let (share, degrees) = (random.within(0.35, 0.9), random.within(-180.0, 180.0));
    let quad = super::placed(&mut random, SIZE, [6.0, 4.0], share, degrees);
    let place = Homography::onto(&quad).unwrap();
    let map = place.after(&Homography::scale_shift([1.0 / 6.0, 0.25], [0.0, 0.0]));
    let shot = Shot::some(&mut random, SIZE, map);
    shot.picture(&mut random, &*pattern)
}

pub(crate) type Pattern = Box<dyn Fn(f64, f64) -> [f64; 3]>;

/// A kind of clutter by name; a step is 1 of the plane.
fn pattern(kind: &str, random: &mut Random) -> Pattern {
    let seed = random.next();
    let gap = random.within(0.04, 0.4);
    let palette: Vec<[f64; 3]> = (0..4 + random.below(6)).map(|_| random.colour()).collect();
    let ground = random.colour().map(|v| v * if seed.is_multiple_of(2) { 0.1 } else { 1.0 });
    let cell = move |x: f64, y: f64, gap: f64| -> Option<(i64, i64)> {
        let (i, j) = (x.floor(), y.floor());
        (x - i < 1.0 - gap && y - j < 1.0 - gap).then_some((i as i64, j as i64))
    };
    let of_palette = move |i: i64, j: i64| palette[(hash(seed, i, j) % palette.len() as u64) as usize];
    let own = move |i: i64, j: i64| Random(hash(seed, i, j)).colour();
    let grey = move |i: i64, j: i64, low: f64, high: f64| [Random(hash(seed, i, j)).within(low, high); 3];
    match kind {
        "keyboard" => Box::new(move |x, y| {
            let shifted = x + [0.0, 0.25, 0.5, 0.75][(y.floor() as i64).rem_euclid(4) as usize];
            let Some((i, j)) = cell(shifted, y, 0.15) else { return [0.01; 3] };
            let (fx, fy) = (shifted - i as f64, y - j as f64);
            let letter = (0.2..0.45).contains(&fx) && (0.2..0.5).contains(&fy) && (fx * 12.0).sin() > 0.0;
            if letter { [0.8; 3] } else { grey(i, j, 0.03, 0.06) }
        }),
        "calculator" => Box::new(move |x, y| {
            if y < 0.0 || !(0.0..5.0).contains(&x) || y > 7.0 {
                return if (-1.5..-0.3).contains(&y) && (0.0..4.7).contains(&x) {
                    [0.35, 0.45, 0.3]
                } else {
                    ground
                };
            }
            match cell(x, y, gap) {
                Some((i, j)) if (x - i as f64 - 0.3).abs() < 0.08 && (y - j as f64 - 0.35).abs() < 0.15 => {
                    [0.9; 3]
                }
                Some((i, j)) => of_palette(i / 2, j / 3),
                None => [0.05; 3],
            }
        }),
        "window front" => Box::new(move |x, y| match cell(x, y * 0.8, gap) {
            Some((i, j)) => {
                let sky = Random(hash(seed, i, j)).within(0.2, 0.9);
                [0.5 * sky, 0.6 * sky, 0.8 * sky + 0.03 * (y * 0.8 - j as f64)]
            }
            None => ground,
        }),
        "tiles" => Box::new(move |x, y| cell(x, y, gap).map_or(ground, |(i, j)| of_palette(i, j))),
        "qr code" => Box::new(move |x, y| {
            let inside = (0.0..25.0).contains(&(4.0 * x)) && (0.0..25.0).contains(&(4.0 * y));
            let bit = hash(seed, (4.0 * x).floor() as i64, (4.0 * y).floor() as i64).is_multiple_of(2);
            if inside && bit { [0.02; 3] } else { [0.85; 3] }
        }),
        "brick" => Box::new(move |x, y| {
            let row = (2.0 * y).floor() as i64;
            match cell(x + 0.5 * row.rem_euclid(2) as f64, 2.0 * y, 0.12) {
                Some((i, j)) => {
                    let shade = Random(hash(seed, i, j)).within(0.5, 1.3);
                    [0.35 * shade, 0.16 * shade, 0.1 * shade]
                }
                None => [0.4; 3],
            }
        }),
        "text" => Box::new(move |x, y| {
            let (i, j) = ((9.0 * x).floor() as i64, (3.0 * y).floor() as i64);
            let line = (3.0 * y).fract().abs() < 0.5;
            if line && !hash(seed, i, j).is_multiple_of(3) { [0.04; 3] } else { [0.8; 3] }
        }),
        "coloured grid" => Box::new(move |x, y| cell(x, y, gap).map_or([0.02; 3], |(i, j)| own(i, j))),
        "coloured 6 by 4" => Box::new(move |x, y| {
            let inside = (0.0..6.0).contains(&x) && (0.0..4.0).contains(&y);
            cell(x, y, gap).filter(|_| inside).map_or([0.02; 3], |(i, j)| own(i, j))
        }),
        "book shelf" => Box::new(move |x, y| {
            let shelf = (0.5 * y).floor() as i64;
            if (0.5 * y).rem_euclid(1.0) > 0.93 {
                [0.3, 0.2, 0.1]
            } else {
                own((3.0 * x).floor() as i64, shelf)
            }
        }),
        "swatches" => Box::new(move |x, y| match cell(x, y, gap) {
            // Hues across, lightness down: a paint card.
            Some((i, j)) => {
                let (hue, light) = (i as f64 * 0.9, (0.35 - 0.07 * j as f64).max(0.03));
                [0.0, 2.1, 4.2].map(|phase| light * (1.05 + (hue + phase).cos()))
            }
            None => [0.75; 3],
        }),
        "shuffled classic" => {
            let layout = ChartLayout::by_name("classic24").unwrap();
            let mut colours = super::colours(&layout);
            for i in (1..colours.len()).rev() {
                colours.swap(i, random.below(i + 1));
            }
            Box::new(super::chart_before(&layout, &colours, move |_, _| ground))
        }
        "mirrored classic" => {
            let layout = ChartLayout::by_name("passport24").unwrap();
            let mut colours = super::colours(&layout);
            colours.chunks_mut(6).for_each(<[_]>::reverse);
            Box::new(super::chart_before(&layout, &colours, move |_, _| ground))
        }
        "checks" => Box::new(move |x, y| {
            if (x.floor() as i64 + y.floor() as i64).rem_euclid(2) == 0 { [0.02; 3] } else { ground }
        }),
        _ => unreachable!(),
    }
}
