//! The two steps as their definition says, number by number: what the fast ones are tested against.

use std::f64::consts::PI;

use darkroot_photo::{Rect, Size};

use super::alike::REACH;
use super::groups::Step;
use super::planes::Planes;
use super::shrink::{Cut, FAR, MARGIN, NOTHING, Weigh};
use crate::denoise::Random;
use crate::view::Cancel;

/// Numbers of a stack: block, row, column.
type Stack = Vec<[[f64; 8]; 8]>;

fn cosine(k: usize, i: usize) -> f64 {
    (PI * (2 * i + 1) as f64 * k as f64 / 16.0).cos() * if k == 0 { 0.125f64.sqrt() } else { 0.5 }
}

/// Haar's function number `k` of `n` places, at place `i`, where the first is even and number 2^j + m lives on part m of 2^j.
fn haar(k: usize, i: usize, n: usize) -> f64 {
    if k == 0 {
        return (n as f64).recip().sqrt();
    }
    let parts = 1 << k.ilog2();
    let (length, part) = (n / parts, k - parts);
    match i.checked_sub(part * length) {
        Some(within) if within < length => {
            let sign = if within < length / 2 { 1.0 } else { -1.0 };
            sign / (length as f64).sqrt()
        }
        _ => 0.0,
    }
}

/// Sums over a stack with the product of three functions as weights; `back` the other way.
fn transformed(stack: &Stack, back: bool) -> Stack {
    let n = stack.len();
    let turn = |k: usize, i: usize| if back { (i, k) } else { (k, i) };
    let mut along = vec![[[0.0; 8]; 8]; n];
    for (k, along) in along.iter_mut().enumerate() {
        for (i, block) in stack.iter().enumerate() {
            let (of, at) = turn(k, i);
            for (to, from) in along.as_flattened_mut().iter_mut().zip(block.as_flattened()) {
                *to += haar(of, at, n) * from;
            }
        }
    }
    let mut out = vec![[[0.0; 8]; 8]; n];
    for (out, block) in out.iter_mut().zip(&along) {
        let down = |k: usize, x: usize| -> f64 {
            (0..8).map(|i| turn(k, i)).zip(block).map(|((of, at), row)| cosine(of, at) * row[x]).sum()
        };
        for (k, row) in out.iter_mut().enumerate() {
            for (l, v) in row.iter_mut().enumerate() {
                *v = (0..8).map(|x| (turn(l, x), x)).map(|((of, at), x)| cosine(of, at) * down(k, x)).sum();
            }
        }
    }
    out
}

/// Means of blocks of all planes; what is alike, plane 0 of `guide` tells.
fn step(
    noisy: &Planes,
    guide: &Planes,
    n: usize,
    strengths: [f32; 4],
    take: impl Fn(&mut Stack, &Stack, f64) -> f64,
) -> [Vec<f64>; 4] {
    let Rect { width, height, .. } = noisy.rect;
    let (columns, rows) = (width - 8, height - 8);
    let block = |planes: &Planes, k: usize, (x, y): (usize, usize)| {
        let mut block = [[0.0; 8]; 8];
        for (r, row) in block.iter_mut().enumerate() {
            for (c, v) in row.iter_mut().enumerate() {
                *v = f64::from(planes.planes[k][(y + r) * width + x + c]);
            }
        }
        block
    };
    let every_fourth = |last: usize| (0..last).step_by(4).chain([last]);
    let mut sums = [0; 4].map(|_| vec![(0.0, 0.0); width * height]);
    for y in every_fourth(rows) {
        for x in every_fourth(columns) {
            let own = block(guide, 0, (x, y));
            let near = |at: usize, last: usize| at.saturating_sub(REACH)..=(at + REACH).min(last);
            let mut places: Vec<(f64, (usize, usize))> = near(y, rows)
                .flat_map(|v| near(x, columns).map(move |u| (u, v)))
                .map(|place| {
                    let other = block(guide, 0, place);
                    let pairs = own.as_flattened().iter().zip(other.as_flattened());
                    (pairs.map(|(a, b)| (a - b) * (a - b)).sum(), place)
                })
                .collect();
            places.sort_by(|a, b| a.0.total_cmp(&b.0));
            let places: Vec<(usize, usize)> = places[..n].iter().map(|(_, place)| *place).collect();
            for k in 0..4 {
                let of = |planes: &Planes| {
                    transformed(&places.iter().map(|p| block(planes, k, *p)).collect(), false)
                };
                let mut stack = of(noisy);
                let left = take(&mut stack, &of(guide), f64::from(strengths[k]));
                for (block, (x, y)) in transformed(&stack, true).iter().zip(&places) {
                    for r in 0..8 {
                        for c in 0..8 {
                            let sum = &mut sums[k][(y + r) * width + x + c];
                            *sum = (sum.0 + block[r][c] / left, sum.1 + 1.0 / left);
                        }
                    }
                }
            }
        }
    }
    sums.map(|sums| sums.into_iter().map(|(sum, weight)| sum / weight).collect())
}

fn cut(stack: &mut Stack, _: &Stack, strength: f64) -> f64 {
    let mut kept = 0.0;
    for (i, v) in stack.as_flattened_mut().as_flattened_mut().iter_mut().enumerate() {
        if i == 0 || v.abs() >= f64::from(FAR) * strength {
            kept += 1.0;
        } else {
            *v = 0.0;
        }
    }
    kept / (64 * stack.len()) as f64
}

fn weigh(stack: &mut Stack, guide: &Stack, strength: f64) -> f64 {
    let noise = f64::from(MARGIN) * strength * strength;
    let mut left = 0.0;
    for (n, (block, guide)) in stack.iter_mut().zip(guide).enumerate() {
        let power: f64 = guide.as_flattened().iter().map(|v| v * v).sum();
        let nothing = n > 0 && power < f64::from(NOTHING) * noise;
        for (i, (v, guide)) in block.as_flattened_mut().iter_mut().zip(guide.as_flattened()).enumerate() {
            let weight = match (n, i) {
                (0, 0) => 1.0,
                _ if nothing => 0.0,
                _ => guide * guide / (guide * guide + noise),
            };
            *v *= weight;
            left += weight * weight;
        }
    }
    left / (64 * stack.len()) as f64
}

/// An edge, a pattern and noise.
fn planes(rect: Rect) -> Planes {
    let mut random = Random::new(17);
    let mut planes = Planes::empty(rect);
    for (k, plane) in planes.planes.iter_mut().enumerate() {
        for (i, v) in plane.iter_mut().enumerate() {
            let (x, y) = ((i % rect.width) as f32, (i / rect.width) as f32);
            let edge = if x + 0.5 * y > 40.0 { 12.0 } else { 0.0 };
            *v = 30.0 / (k + 1) as f32 + edge + 4.0 * (0.9 * x + 0.1 * k as f32 * y).sin() + random.normal();
        }
    }
    planes
}

#[test]
fn the_fast_steps_do_what_the_slow_ones_do() {
    let frame = Size { width: 61, height: 46 };
    let rect = Rect::full(frame);
    let noisy = planes(rect);
    let strengths = [1.0, 0.7, 1.2, 0.4];
    let fast = Step { noisy: &noisy, guide: &noisy, frame, strengths };
    let sums = fast.over::<{ Cut::GROUP }, Cut>(rect, &Cancel::default()).unwrap();
    let slow = step(&noisy, &noisy, Cut::GROUP, strengths, cut);
    let mut guide = Planes::empty(rect);
    guide.by_rows(|y, rows| rows.into_iter().enumerate().for_each(|(k, row)| sums.means(k, (0, y), row)));
    assert_alike(&guide, &slow);
    let fast = Step { guide: &guide, ..fast };
    let sums = fast.over::<{ Weigh::GROUP }, Weigh>(rect, &Cancel::default()).unwrap();
    let slow = step(&noisy, &guide, Weigh::GROUP, strengths, weigh);
    let mut clean = Planes::empty(rect);
    clean.by_rows(|y, rows| rows.into_iter().enumerate().for_each(|(k, row)| sums.means(k, (0, y), row)));
    assert_alike(&clean, &slow);
}

fn assert_alike(fast: &Planes, slow: &[Vec<f64>; 4]) {
    for (k, (fast, slow)) in fast.planes.iter().zip(slow).enumerate() {
        for (i, (fast, slow)) in fast.iter().zip(slow).enumerate() {
            assert!((f64::from(*fast) - slow).abs() < 1e-4, "plane {k} at {i}: {fast} {slow}");
        }
    }
}
