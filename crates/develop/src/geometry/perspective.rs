//! What shall stand upright, lie level or be a rectangle, and the map that makes it so.

use darkroot_colour::{Matrix3, Vector3};
use darkroot_photo::Size;

use super::homography::{from_square, moved, scaled};
use crate::error::GeometryFault;

/// What is known of how the camera was held, in places of the upright picture before it is straightened.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Perspective {
    /// What it is known by.
    pub by: Marks,
    /// Whether places are shares of the picture's width and height, 0 to 1; else they are columns and rows.
    pub shares: bool,
}

/// A place, column and row.
type Place = [f64; 2];

/// What was marked in the picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Marks {
    /// Corners of what shall become a rectangle: top left, top right, bottom right, bottom left.
    Corners([Place; 4]),
    /// Lines that are upright in the scene, and such that are level and face the viewer. At least one of both.
    Lines {
        /// What shall be upright.
        vertical: Option<Lines>,
        /// What shall be level.
        horizontal: Option<Lines>,
    },
}

/// Lines that are parallel in the scene, each by two places on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Lines {
    /// One tells how the camera leans.
    One([Place; 2]),
    /// Two tell where they would meet as well.
    Two([[Place; 2]; 2]),
}

/// From places of the picture as it shall be to those of the picture of that size as it is.
pub(super) fn undone(asked: &Perspective, canvas: Size) -> Result<Matrix3, GeometryFault> {
    let size = [canvas.width as f64, canvas.height as f64];
    let place = |[x, y]: Place| if asked.shares { [x * size[0], y * size[1]] } else { [x, y] };
    match &asked.by {
        Marks::Corners(corners) => rectangle(corners.map(place)).ok_or(GeometryFault::Corners),
        Marks::Lines { vertical, horizontal } => {
            let middle = size.map(|side| 0.5 * side);
            let centred = |p: Place| {
                let [x, y] = place(p);
                [x - middle[0], y - middle[1]]
            };
            let meeting = |lines: &Option<Lines>| lines.as_ref().map(|lines| lines.meet(centred, size));
            let faults =
                |met: Option<Option<Vector3>>| met.map(|v| v.ok_or(GeometryFault::Lines)).transpose();
            let (down, right) = (faults(meeting(vertical))?, faults(meeting(horizontal))?);
            let [x, y] = middle;
            let about = about_the_middle(down, right, size).ok_or(GeometryFault::Lines)?;
            Ok(moved(x, y) * about * moved(-x, -y))
        }
    }
}

/// A quadrangle becomes a rectangle that has the mean length of opposite sides, and the place of the corners' mean.
fn rectangle(corners: [Place; 4]) -> Option<Matrix3> {
    let from_square = from_square(corners)?;
    let side = |i: usize, j: usize| (corners[i][0] - corners[j][0]).hypot(corners[i][1] - corners[j][1]);
    let (width, height) = (0.5 * (side(0, 1) + side(3, 2)), 0.5 * (side(0, 3) + side(1, 2)));
    let mean = [0, 1].map(|axis| corners.iter().map(|corner| corner[axis]).sum::<f64>() / 4.0);
    let to_square = scaled(1.0 / width, 1.0 / height) * moved(0.5 * width - mean[0], 0.5 * height - mean[1]);
    Some(from_square * to_square)
}

impl Lines {
    /// Where they meet, in homogeneous pixels from the middle: a direction where that is far away. `None` where a line is a point,
    /// both are the same, or they meet in the picture.
    fn meet(&self, centred: impl Fn(Place) -> Place, [width, height]: [f64; 2]) -> Option<Vector3> {
        let point = |p: Place| {
            let [x, y] = centred(p);
            Vector3::new(x, y, 1.0)
        };
        let unit = width.hypot(height);
        let line = |[a, b]: &[Place; 2]| {
            let direction = point(*b) - point(*a);
            let through = point(*a).cross(&point(*b)) / direction.norm();
            (direction.norm() > 1e-3 * unit && through.iter().all(|v| v.is_finite()))
                .then_some((direction, through))
        };
        match self {
            Self::One(one) => Some(line(one)?.0.normalize()),
            Self::Two([one, two]) => {
                let met = line(one)?.1.cross(&line(two)?.1);
                let in_units = Vector3::new(met.x / unit, met.y / unit, met.z);
                let is_inside =
                    2.0 * met.x.abs() < width * met.z.abs() && 2.0 * met.y.abs() < height * met.z.abs();
                (in_units.norm() > 1e-6 && !is_inside).then(|| met / met.xy().norm())
            }
        }
    }
}

/// The map that has upright lines meet at `down` and level ones at `right`, both from the middle, which stays where it is and as
/// large as it is. Where only one is known, the other direction crosses it at a right angle in the middle, and nothing runs
/// together along it.
///
/// How long upright things are beside level ones follows where both meet: they tell the distance at which the scene was projected
/// (Hartley and Zisserman, "Multiple View Geometry", 2004, 8.6: the middle sees both points at a right angle). Else the middle keeps
/// its shape.
fn about_the_middle(down: Option<Vector3>, right: Option<Vector3>, size: [f64; 2]) -> Option<Matrix3> {
    // Which of its two ends a direction names is a matter of sign.
    let downwards = |v: Vector3| if v.y < 0.0 { -v } else { v };
    let rightwards = |v: Vector3| if v.x < 0.0 { -v } else { v };
    let (down, right) = match (down.map(downwards), right.map(rightwards)) {
        (Some(down), Some(right)) => (down, right),
        (Some(down), None) => (down, Vector3::new(down.y, -down.x, 0.0)),
        (None, Some(right)) => (Vector3::new(-right.y, right.x, 0.0), right),
        (None, None) => return None,
    };
    if down.y.abs() <= down.x.abs() || right.x.abs() <= right.y.abs() {
        return None;
    }
    let square = -(down.x * right.x + down.y * right.y) / (down.z * right.z);
    let diagonal = size[0].hypot(size[1]);
    // Between a fisheye's and a long telescope's.
    let tells = square.is_finite() && (0.3..20.0).contains(&(square.sqrt() / diagonal));
    let length = |v: &Vector3| if tells { (1.0 + square * v.z * v.z).sqrt() } else { 1.0 };
    let (right, down) = (right / length(&right), down / length(&down));
    let area = right.x * down.y - right.y * down.x;
    if area <= 1e-3 || area.is_nan() {
        return None;
    }
    let (right, down) = (right / area.sqrt(), down / area.sqrt());
    Some(Matrix3::new(right.x, down.x, 0.0, right.y, down.y, 0.0, right.z, down.z, 1.0))
}
