//! Plane geometry: quadrilaterals and the perspective maps between them. Pixel centres have integer coordinates.

/// Four corners in the sequence top left, top right, bottom right, bottom left of the chart as printed: x to the
/// right, y down, in pixels.
pub type Quad = [[f64; 2]; 4];

/// A perspective map of the plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Homography(pub nalgebra::Matrix3<f64>);
