//! Lines that are upright or level in a scene are so in the picture of a camera that was held otherwise.

use darkroot_colour::{Matrix3, Vector3};
use darkroot_develop::{Crop, Geometry, Lines, Marks, Perspective, Recipe};
use darkroot_photo::Size;
use darkroot_tests::{measuring, pixels, plan};

use crate::geometry::{SIZE, capture, developed};

/// Distance of the picture from the eye, pixels.
const EYE: f64 = 320.0;
/// Distance of the grid's lines, pixels of the picture of a camera that looks straight at it.
const APART: f64 = 60.0;

/// Two places on a line.
type Line = [[f64; 2]; 2];

/// How a camera was turned: degrees up, to the right and about its axis.
#[derive(Clone, Copy)]
struct Held {
    up: f64,
    right: f64,
    roll: f64,
}

impl Held {
    /// Takes places of the wall, as a camera that looks straight at it sees them from the middle, to those that this one sees.
    fn map(self) -> Matrix3 {
        let turn = |degrees: f64, [a, b]: [usize; 2]| {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let mut m = Matrix3::identity();
            (m[(a, a)], m[(b, b)], m[(a, b)], m[(b, a)]) = (cos, cos, -sin, sin);
            m
        };
        let seen = turn(self.roll, [0, 1]) * turn(self.up, [1, 2]) * turn(self.right, [0, 2]);
        let eye = Matrix3::from_diagonal(&Vector3::new(EYE, EYE, 1.0));
        eye * seen * eye.try_inverse().unwrap()
    }
}

fn at(map: &Matrix3, [x, y]: [f64; 2]) -> [f64; 2] {
    let v = map * Vector3::new(x, y, 1.0);
    [v.x / v.z, v.y / v.z]
}

fn middle() -> [f64; 2] {
    [0.5 * SIZE.width as f64, 0.5 * SIZE.height as f64]
}

/// A picture of a wall with bright lines across it, upright and level, and what a line of the wall is in it.
fn wall(held: Held) -> (darkroot_photo::Capture, impl Fn([f64; 2], [f64; 2]) -> Line) {
    let map = held.map();
    let back = map.try_inverse().unwrap();
    let [cx, cy] = middle();
    let capture = capture(move |x, y| {
        let [u, v] = at(&back, [x - cx, y - cy]);
        let near = |w: f64| (w / APART - (w / APART).round()).abs() * APART;
        let bright = |away: f64| (-0.5 * (away / 1.6).powi(2)).exp();
        // Red are upright lines, green level ones.
        [0.1 + 0.7 * bright(near(u)), 0.1 + 0.7 * bright(near(v)), 0.2]
    });
    let line = move |a: [f64; 2], b: [f64; 2]| {
        [a, b].map(|p| {
            let [x, y] = at(&map, p);
            [x + cx, y + cy]
        })
    };
    (capture, line)
}

/// Where lines of a colour cross each row (or column): by line, places along the rows.
fn crossings(picture: &darkroot_photo::Picture, channel: usize, upright: bool) -> Vec<Vec<f64>> {
    let all = pixels(picture);
    let Size { width, height } = picture.size;
    let (across, along) = if upright { (width, height) } else { (height, width) };
    let light = |i: usize, j: usize| {
        let (x, y) = if upright { (i, j) } else { (j, i) };
        all[y * width + x][channel] - 0.1
    };
    let mut lines: Vec<Vec<f64>> = Vec::new();
    for j in 2..along - 2 {
        for i in 6..across - 6 {
            let peak = light(i, j);
            if peak < 0.35
                || (i - 2..i).any(|k| light(k, j) > peak)
                || (i + 1..i + 3).any(|k| light(k, j) >= peak)
            {
                continue;
            }
            let window = i - 5..i + 6;
            let sum: f64 = window.clone().map(|k| light(k, j)).sum();
            let place = window.map(|k| light(k, j) * (k as f64 + 0.5)).sum::<f64>() / sum;
            match lines.iter_mut().find(|line| line.last().is_some_and(|last| (last - place).abs() < 3.0)) {
                Some(line) => line.push(place),
                None => lines.push(vec![place]),
            }
        }
    }
    lines.retain(|line| line.len() > along / 2);
    lines
}

/// Fails unless lines run straight along rows or columns, to 0.2 pixel; their distances.
pub(crate) fn straight(picture: &darkroot_photo::Picture, channel: usize, upright: bool) -> f64 {
    let lines = crossings(picture, channel, upright);
    assert!(lines.len() >= 2, "{} lines", lines.len());
    let means: Vec<f64> = lines
        .iter()
        .map(|line| {
            let mean = line.iter().sum::<f64>() / line.len() as f64;
            let off = line.iter().map(|v| (v - mean).abs()).fold(0.0, f64::max);
            assert!(off < 0.2, "channel {channel}: {off} pixels off straight");
            mean
        })
        .collect();
    let gaps: Vec<f64> = means.windows(2).map(|pair| pair[1] - pair[0]).collect();
    gaps.iter().sum::<f64>() / gaps.len() as f64
}

fn with(by: Marks) -> Geometry {
    Geometry { perspective: Some(Perspective { by, shares: false }), ..Geometry::default() }
}

const LEFT: ([f64; 2], [f64; 2]) = ([-60.0, -50.0], [-60.0, 40.0]);
const RIGHT: ([f64; 2], [f64; 2]) = ([60.0, -30.0], [60.0, 60.0]);
const TOP: ([f64; 2], [f64; 2]) = ([-80.0, -60.0], [50.0, -60.0]);
const BOTTOM: ([f64; 2], [f64; 2]) = ([-40.0, 60.0], [70.0, 60.0]);

#[test]
fn two_upright_lines_undo_a_camera_that_looked_up_and_leant() {
    for held in [Held { up: 12.0, right: 0.0, roll: 0.0 }, Held { up: -8.0, right: 0.0, roll: 3.0 }] {
        let (capture, line) = wall(held);
        let vertical = Some(Lines::Two([line(LEFT.0, LEFT.1), line(RIGHT.1, RIGHT.0)]));
        let picture = developed(&capture, Crop::Default, with(Marks::Lines { vertical, horizontal: None }));
        let gap = straight(&picture, 0, true);
        // Level lines are level as well: the camera did not look aside. The middle keeps its scale.
        straight(&picture, 1, false);
        assert!((gap / APART - 1.0).abs() < 0.06, "{gap}");
    }
}

#[test]
fn two_level_lines_undo_a_camera_that_looked_aside() {
    let (capture, line) = wall(Held { up: 0.0, right: 10.0, roll: -2.0 });
    let horizontal = Some(Lines::Two([line(TOP.0, TOP.1), line(BOTTOM.0, BOTTOM.1)]));
    let picture = developed(&capture, Crop::Default, with(Marks::Lines { vertical: None, horizontal }));
    straight(&picture, 0, true);
    straight(&picture, 1, false);
}

#[test]
fn four_lines_undo_both_and_squares_are_square() {
    let (capture, line) = wall(Held { up: 9.0, right: -11.0, roll: 2.0 });
    let vertical = Some(Lines::Two([line(LEFT.0, LEFT.1), line(RIGHT.0, RIGHT.1)]));
    let horizontal = Some(Lines::Two([line(TOP.0, TOP.1), line(BOTTOM.0, BOTTOM.1)]));
    let picture = developed(&capture, Crop::Default, with(Marks::Lines { vertical, horizontal }));
    let (across, down) = (straight(&picture, 0, true), straight(&picture, 1, false));
    assert!((across / down - 1.0).abs() < 0.01, "{across} {down}");
}

#[test]
fn one_line_says_how_the_camera_leant() {
    let (capture, line) = wall(Held { up: 0.0, right: 0.0, roll: 4.0 });
    for marks in [
        Marks::Lines { vertical: Some(Lines::One(line(LEFT.1, LEFT.0))), horizontal: None },
        Marks::Lines { vertical: None, horizontal: Some(Lines::One(line(TOP.0, TOP.1))) },
    ] {
        let picture = developed(&capture, Crop::Default, with(marks));
        assert!((straight(&picture, 0, true) - APART).abs() < 0.1);
    }
}

#[test]
fn shares_of_the_picture_are_the_same_as_its_pixels() {
    let (capture, line) = wall(Held { up: 7.0, right: 0.0, roll: 0.0 });
    let [left, right] = [line(LEFT.0, LEFT.1), line(RIGHT.0, RIGHT.1)];
    let share = |line: [[f64; 2]; 2]| line.map(|[x, y]| [x / SIZE.width as f64, y / SIZE.height as f64]);
    let lines = |a, b| Marks::Lines { vertical: Some(Lines::Two([a, b])), horizontal: None };
    let by_shares = Perspective { by: lines(share(left), share(right)), shares: true };
    let shares = Geometry { perspective: Some(by_shares), ..Geometry::default() };
    let one = developed(&capture, Crop::Default, shares);
    let two = developed(&capture, Crop::Default, with(lines(left, right)));
    assert_eq!(one.size, two.size);
    let off = pixels(&one).iter().zip(pixels(&two)).map(|(a, b)| (a[0] - b[0]).abs()).fold(0.0, f64::max);
    assert!(off < 1e-3, "{off}");
}

#[test]
fn lines_that_tell_nothing_are_refused() {
    let (capture, _) = wall(Held { up: 0.0, right: 0.0, roll: 0.0 });
    let level = [[10.0, 50.0], [200.0, 60.0]];
    let same = [[10.0, 10.0], [12.0, 150.0]];
    let crossing = [[100.0, 10.0], [200.0, 190.0]];
    let other = [[200.0, 10.0], [100.0, 190.0]];
    let none = Marks::Lines { vertical: None, horizontal: None };
    let upright = |lines| Marks::Lines { vertical: Some(lines), horizontal: None };
    for by in [
        none,
        upright(Lines::One(level)),
        upright(Lines::One([[10.0, 10.0], [10.0, 10.0]])),
        upright(Lines::Two([same, same])),
        upright(Lines::Two([crossing, other])),
        upright(Lines::One([[10.0, f64::NAN], [10.0, 90.0]])),
    ] {
        let refused = plan(&capture, None, &Recipe { geometry: with(by), ..measuring() });
        assert!(refused.is_err_and(|e| e.to_string().contains("lines")), "{by:?}");
    }
}
