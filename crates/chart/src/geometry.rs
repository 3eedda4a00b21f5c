//! Plane geometry: quadrilaterals and the perspective maps between them. Pixel centres have integer coordinates.

use darkroot_colour::decomposition::symmetric_eigen;
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

/// Four corners in the sequence top left, top right, bottom right, bottom left of the chart as printed: x to the
/// right, y down, in pixels.
pub type Quad = [[f64; 2]; 4];

/// A perspective map of the plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Homography(pub Matrix3<f64>);

impl Homography {
    /// The map of the unit square (top left, top right, bottom right, bottom left) onto a quadrilateral. `None` when
    /// three of its corners lie on a line.
    pub fn onto(quad: &Quad) -> Option<Self> {
        const SQUARE: Quad = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        if (0..4).any(|i| turn(quad[i], quad[(i + 1) % 4], quad[(i + 2) % 4]).abs() <= 1e-9) {
            return None;
        }
        let pairs: Vec<_> = SQUARE.iter().copied().zip(quad.iter().copied()).collect();
        Self::fitted(&pairs)
    }

    /// The map with the least squares of distances between images of the first points and the second points: linear
    /// solution on normalised coordinates (Hartley and Zisserman, "Multiple View Geometry", 2004, algorithm 4.2), then
    /// Gauss-Newton on the distances. `None` for fewer than four points or when they determine no map.
    pub fn fitted(pairs: &[([f64; 2], [f64; 2])]) -> Option<Self> {
        if pairs.len() < 4 {
            return None;
        }
        let from = Normalisation::of(pairs.iter().map(|p| p.0))?;
        let to = Normalisation::of(pairs.iter().map(|p| p.1))?;
        let normalised: Vec<_> = pairs.iter().map(|(a, b)| (from.apply(*a), to.apply(*b))).collect();
        let mut map = linear(&normalised)?;
        for _ in 0..3 {
            match improved(map, &normalised) {
                Some(better) => map = better,
                None => break,
            }
        }
        let matrix = to.inverse() * map * from.matrix();
        let map = Self(matrix / matrix[(2, 2)]);
        map.0.iter().all(|m| m.is_finite()).then_some(map)
    }

    /// Where a point goes; not finite for points of the vanishing line.
    pub fn apply(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let p = self.0 * Vector3::new(x, y, 1.0);
        [p.x / p.z, p.y / p.z]
    }

    /// How the image moves when a point moves: rows are the image's x and y, columns the point's.
    pub fn derivative(&self, [x, y]: [f64; 2]) -> [[f64; 2]; 2] {
        let p = self.0 * Vector3::new(x, y, 1.0);
        let (u, v) = (p.x / p.z, p.y / p.z);
        let m = &self.0;
        let part = |row: usize, column: usize, image: f64| (m[(row, column)] - image * m[(2, column)]) / p.z;
        [[part(0, 0, u), part(0, 1, u)], [part(1, 0, v), part(1, 1, v)]]
    }

    /// The map back. `None` when the plane is mapped onto a line.
    pub fn inverse(&self) -> Option<Self> {
        self.0.try_inverse().filter(|m| m.iter().all(|m| m.is_finite())).map(Self)
    }

    /// First `first`, then this map.
    pub fn after(&self, first: &Self) -> Self {
        Self(self.0 * first.0)
    }

    /// The map that scales and shifts along the axes.
    pub fn scale_shift(scale: [f64; 2], shift: [f64; 2]) -> Self {
        Self(Matrix3::new(scale[0], 0.0, shift[0], 0.0, scale[1], shift[1], 0.0, 0.0, 1.0))
    }
}

/// Twice the signed area of a triangle: positive when it turns clockwise on the screen (y down).
pub fn turn(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Area of a quadrilateral: positive when its corners run clockwise on the screen (y down).
pub fn area(quad: &Quad) -> f64 {
    (turn(quad[0], quad[1], quad[2]) + turn(quad[0], quad[2], quad[3])) / 2.0
}

/// Whether a quadrilateral is convex and its corners run clockwise on the screen, so it is not mirrored.
pub fn is_convex(quad: &Quad) -> bool {
    (0..4).all(|i| turn(quad[i], quad[(i + 1) % 4], quad[(i + 2) % 4]) > 0.0)
}

/// Whether a point lies in a convex quadrilateral whose corners run clockwise.
pub fn contains(quad: &Quad, point: [f64; 2]) -> bool {
    (0..4).all(|i| turn(quad[i], quad[(i + 1) % 4], point) >= 0.0)
}

/// Centre and scale that bring points near the unit square.
struct Normalisation {
    centre: [f64; 2],
    scale: f64,
}

impl Normalisation {
    fn of(points: impl Iterator<Item = [f64; 2]> + Clone) -> Option<Self> {
        let n = points.clone().count() as f64;
        let sum = points.clone().fold([0.0; 2], |s, p| [s[0] + p[0], s[1] + p[1]]);
        let centre = [sum[0] / n, sum[1] / n];
        let spread = points.map(|p| (p[0] - centre[0]).hypot(p[1] - centre[1])).sum::<f64>() / n;
        (spread.is_finite() && spread > 0.0).then_some(Self { centre, scale: 1.0 / spread })
    }

    fn apply(&self, p: [f64; 2]) -> [f64; 2] {
        [(p[0] - self.centre[0]) * self.scale, (p[1] - self.centre[1]) * self.scale]
    }

    fn matrix(&self) -> Matrix3<f64> {
        let (s, [x, y]) = (self.scale, self.centre);
        Matrix3::new(s, 0.0, -s * x, 0.0, s, -s * y, 0.0, 0.0, 1.0)
    }

    fn inverse(&self) -> Matrix3<f64> {
        let (s, [x, y]) = (1.0 / self.scale, self.centre);
        Matrix3::new(s, 0.0, x, 0.0, s, y, 0.0, 0.0, 1.0)
    }
}

/// The direct linear transform: the vector with the smallest algebraic error.
fn linear(pairs: &[([f64; 2], [f64; 2])]) -> Option<Matrix3<f64>> {
    let mut normal = SMatrix::<f64, 9, 9>::zeros();
    for ([x, y], [u, v]) in pairs {
        let one = SVector::<f64, 9>::from([*x, *y, 1.0, 0.0, 0.0, 0.0, -u * x, -u * y, -u]);
        let two = SVector::<f64, 9>::from([0.0, 0.0, 0.0, *x, *y, 1.0, -v * x, -v * y, -v]);
        normal += one * one.transpose() + two * two.transpose();
    }
    let eigen = symmetric_eigen(normal)?;
    let smallest = (0..9).min_by(|a, b| eigen.eigenvalues[*a].total_cmp(&eigen.eigenvalues[*b]))?;
    let h = eigen.eigenvectors.column(smallest);
    let map = Matrix3::new(h[0], h[1], h[2], h[3], h[4], h[5], h[6], h[7], h[8]);
    (map[(2, 2)].abs() > 1e-12).then(|| map / map[(2, 2)])
}

/// One Gauss-Newton step; `None` when it does not lower the distances.
fn improved(map: Matrix3<f64>, pairs: &[([f64; 2], [f64; 2])]) -> Option<Matrix3<f64>> {
    let mut normal = SMatrix::<f64, 8, 8>::zeros();
    let mut right = SVector::<f64, 8>::zeros();
    for ([x, y], target) in pairs {
        let p = map * Vector3::new(*x, *y, 1.0);
        let (u, v, w) = (p.x / p.z, p.y / p.z, 1.0 / p.z);
        let by = [x * w, y * w, w];
        let rows = [
            [by[0], by[1], by[2], 0.0, 0.0, 0.0, -u * by[0], -u * by[1]],
            [0.0, 0.0, 0.0, by[0], by[1], by[2], -v * by[0], -v * by[1]],
        ];
        for (row, error) in rows.into_iter().zip([target[0] - u, target[1] - v]) {
            let row = SVector::<f64, 8>::from(row);
            normal += row * row.transpose();
            right += row * error;
        }
    }
    let step = normal.cholesky()?.solve(&right);
    let s = |i: usize| step[i];
    let next = map + Matrix3::new(s(0), s(1), s(2), s(3), s(4), s(5), s(6), s(7), 0.0);
    let squares = |m: &Matrix3<f64>| -> f64 {
        let h = Homography(*m);
        pairs.iter().map(|(a, b)| h.apply(*a).iter().zip(b).map(|(p, q)| (p - q).powi(2)).sum::<f64>()).sum()
    };
    (squares(&next) < squares(&map)).then_some(next)
}

#[cfg(test)]
mod tests {
    use super::*;

    const QUAD: Quad = [[10.0, 20.0], [110.0, 12.0], [130.0, 90.0], [4.0, 80.0]];

    #[test]
    fn corners_go_to_corners() {
        let map = Homography::onto(&QUAD).unwrap();
        for (from, to) in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].into_iter().zip(QUAD) {
            let got = map.apply(from);
            assert!((got[0] - to[0]).abs() < 1e-6 && (got[1] - to[1]).abs() < 1e-6, "{got:?} {to:?}");
        }
    }

    #[test]
    fn the_map_back_undoes_the_map() {
        let map = Homography::onto(&QUAD).unwrap();
        let back = map.inverse().unwrap();
        let p = back.apply(map.apply([0.3, 0.7]));
        assert!((p[0] - 0.3).abs() < 1e-9 && (p[1] - 0.7).abs() < 1e-9);
    }

    #[test]
    fn many_points_give_the_map_they_were_made_by() {
        let map = Homography::onto(&QUAD).unwrap();
        let pairs: Vec<_> = (0..35)
            .map(|i| [f64::from(i % 7), f64::from(i / 7)])
            .map(|p| (p, map.apply([p[0] / 6.0, p[1] / 4.0])))
            .collect();
        let fitted = Homography::fitted(&pairs).unwrap();
        for (from, to) in &pairs {
            let got = fitted.apply(*from);
            assert!((got[0] - to[0]).abs() < 1e-6 && (got[1] - to[1]).abs() < 1e-6);
        }
    }

    #[test]
    fn the_derivative_is_the_change_of_the_image() {
        let map = Homography::onto(&QUAD).unwrap();
        let (p, step) = ([0.4, 0.6], 1e-6);
        let derivative = map.derivative(p);
        for axis in 0..2 {
            let mut q = p;
            q[axis] += step;
            let (a, b) = (map.apply(p), map.apply(q));
            for row in 0..2 {
                assert!(((b[row] - a[row]) / step - derivative[row][axis]).abs() < 1e-3);
            }
        }
    }

    #[test]
    fn points_on_a_line_or_not_finite_make_no_map() {
        assert_eq!(Homography::onto(&[[0.0, 0.0], [1.0, 1.0], [2.0, 2.0], [0.0, 3.0]]), None);
        assert_eq!(Homography::fitted(&[([0.0; 2], [0.0; 2]); 9]), None);
        assert_eq!(Homography::fitted(&[([0.0, 1.0], [f64::NAN, 0.0]); 4]), None);
        assert_eq!(Homography::fitted(&[]), None);
    }
}
