//! A smooth function of chromaticity times the mean of the channels: the residual that a hue-plane model leaves.

use darkroot_colour::{Matrix3, Vector3, Xyz};

use crate::model::Part;

/// Width of the Gaussian kernel, in units of the sphere of [`direction`].
pub const WIDTH: f64 = 0.2;

/// A sum of bumps: (r + g + b)/3 times the sum over j of c_j (k(x, z_j) - k(x, w) k(w, z_j)). Here x is the colour's
/// [`direction`], z_j that of bump j's centre, w that of grey, c_j what the bump adds to XYZ, and k a Gaussian of
/// [`WIDTH`]. The second product makes the function 0 on the grey axis; it is homogeneous of degree one.
#[derive(Debug, Clone, PartialEq)]
pub struct Residual {
    centres: Vec<Centre>,
}

/// One bump of the function.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Centre {
    /// Chromaticity where it stands: r, g, b of any scale, none negative, not all 0.
    pub rgb: [f64; 3],
    /// What it adds to X, Y and Z.
    pub weight: [f64; 3],
}

/// The square roots of the channels as a vector of length 1; negative channels count as 0, and black as grey.
pub fn direction(rgb: [f64; 3]) -> Vector3 {
    let roots = Vector3::from(rgb.map(|v| v.max(0.0).sqrt()));
    let length = roots.norm();
    if length > 0.0 { roots / length } else { grey() }
}

/// Direction of grey.
pub fn grey() -> Vector3 {
    Vector3::repeat(1.0 / 3f64.sqrt())
}

/// The kernel between two directions.
pub fn kernel(a: &Vector3, b: &Vector3) -> f64 {
    (-(a - b).norm_squared() / (2.0 * WIDTH * WIDTH)).exp()
}

/// The kernel of a centre, made zero at grey.
pub fn white_exact_kernel(x: &Vector3, centre: &Vector3) -> f64 {
    kernel(x, centre) - kernel(x, &grey()) * kernel(&grey(), centre)
}

impl Residual {
    /// A sum of bumps. `None` when a value is not finite or a centre has no chromaticity.
    pub fn new(centres: Vec<Centre>) -> Option<Self> {
        let placed = |c: &Centre| c.rgb.iter().all(|v| *v >= 0.0) && c.rgb.iter().any(|v| *v > 0.0);
        let finite = |c: &Centre| c.rgb.iter().chain(&c.weight).all(|v| v.is_finite());
        centres.iter().all(|c| placed(c) && finite(c)).then_some(Self { centres })
    }

    /// The bumps.
    pub fn centres(&self) -> &[Centre] {
        &self.centres
    }

    /// XYZ at a direction, for colours whose channels have the mean 1.
    pub fn at(&self, x: &Vector3) -> Vector3 {
        self.centres.iter().fold(Vector3::zeros(), |sum, centre| {
            sum + Vector3::from(centre.weight) * white_exact_kernel(x, &direction(centre.rgb))
        })
    }
}

impl Part for Residual {
    fn xyz(&self, rgb: [f64; 3]) -> Xyz {
        let mean = rgb.iter().sum::<f64>() / 3.0;
        (self.at(&direction(rgb)) * mean).into()
    }

    fn then(&self, matrix: &Matrix3) -> Self {
        let through = |c: &Centre| Centre { weight: (matrix * Vector3::from(c.weight)).into(), ..*c };
        Self { centres: self.centres.iter().map(through).collect() }
    }

    fn plus(&self, other: &Self) -> Self {
        Self { centres: self.centres.iter().chain(&other.centres).copied().collect() }
    }

    fn map(&self, change: impl Fn(f64) -> f64) -> Self {
        let changed = |c: &Centre| Centre { rgb: c.rgb.map(&change), weight: c.weight.map(&change) };
        Self { centres: self.centres.iter().map(changed).collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_added_to_grey() {
        let centre = Centre { rgb: [0.7, 0.2, 0.1], weight: [0.3, -0.2, 5.0] };
        let residual = Residual::new(vec![centre]).unwrap();
        for grey in [0.0, 1e-6, 0.18, 4.0] {
            let c = residual.xyz([grey; 3]);
            assert!(c.x.abs() + c.y.abs() + c.z.abs() < 1e-15, "{grey}");
        }
        assert!(residual.xyz([0.7, 0.2, 0.1]).z > 0.1);
    }
}
