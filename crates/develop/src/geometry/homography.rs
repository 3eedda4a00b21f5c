//! Maps of the plane that keep lines straight, as matrices for homogeneous columns and rows.

use darkroot_colour::{Matrix3, Vector3};

/// Adds to columns and rows.
pub(super) fn moved(x: f64, y: f64) -> Matrix3 {
    Matrix3::new(1.0, 0.0, x, 0.0, 1.0, y, 0.0, 0.0, 1.0)
}

/// Multiplies columns and rows.
pub(super) fn scaled(x: f64, y: f64) -> Matrix3 {
    Matrix3::new(x, 0.0, 0.0, 0.0, y, 0.0, 0.0, 0.0, 1.0)
}

/// Turns about a point, clockwise as pictures are seen.
pub(super) fn turned(degrees: f64, [x, y]: [f64; 2]) -> Matrix3 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    moved(x, y) * Matrix3::new(cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0) * moved(-x, -y)
}

/// Takes the unit square to a quadrangle, whose corners follow each other clockwise from that of (0, 0): Heckbert,
/// "Fundamentals of Texture Mapping and Image Warping", 1989, 2.2.3. `None` where it is not convex.
pub(super) fn from_square(corners: [[f64; 2]; 4]) -> Option<Matrix3> {
    let turns = |i: usize| {
        let [a, b, c] = [0, 1, 2].map(|k| corners[(i + k) % 4]);
        (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0])
    };
    if !(0..4).all(|i| turns(i) > 0.0) {
        return None;
    }
    let [a, b, c, d] = corners;
    let sum = [0, 1].map(|i| a[i] - b[i] + c[i] - d[i]);
    let (one, two) = ([0, 1].map(|i| b[i] - c[i]), [0, 1].map(|i| d[i] - c[i]));
    let area = one[0] * two[1] - two[0] * one[1];
    let g = (sum[0] * two[1] - two[0] * sum[1]) / area;
    let h = (one[0] * sum[1] - sum[0] * one[1]) / area;
    let found = Matrix3::new(
        b[0] - a[0] + g * b[0],
        d[0] - a[0] + h * d[0],
        a[0],
        b[1] - a[1] + g * b[1],
        d[1] - a[1] + h * d[1],
        a[1],
        g,
        h,
        1.0,
    );
    found.iter().all(|v| v.is_finite()).then_some(found)
}

/// Where a map takes a point; `None` where that lies at infinity or behind it.
pub(super) fn place(map: &Matrix3, [x, y]: [f64; 2]) -> Option<[f64; 2]> {
    let v = map * Vector3::new(x, y, 1.0);
    (v.z > 1e-9).then(|| [v.x / v.z, v.y / v.z])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_square_goes_where_it_should() {
        let corners = [[3.0, 4.0], [20.0, 1.0], [25.0, 30.0], [1.0, 22.0]];
        let map = from_square(corners).unwrap();
        for (from, to) in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].into_iter().zip(corners) {
            let found = place(&map, from).unwrap();
            assert!((0..2).all(|i| (found[i] - to[i]).abs() < 1e-9), "{found:?} {to:?}");
        }
        let [a, b, c, d] = corners;
        assert_eq!(from_square([a, c, b, d]), None);
        assert_eq!(from_square([a, d, c, b]), None);
        assert_eq!(from_square([a, a, c, d]), None);
    }

    #[test]
    fn a_quarter_turn_is_clockwise() {
        let found = place(&turned(90.0, [5.0, 5.0]), [9.0, 5.0]).unwrap();
        assert!((found[0] - 5.0).abs() < 1e-9 && (found[1] - 9.0).abs() < 1e-9, "{found:?}");
    }
}
