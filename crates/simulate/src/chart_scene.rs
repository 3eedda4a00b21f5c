//! A chart held before a wall, seen in perspective.

use darkroot_colour::{Matrix3, Vector3};

/// Samples a pixel in each direction.
const OVER: usize = 4;
/// Width of the chart's frame, in patch widths.
const FRAME: f64 = 0.4;

/// Where a chart stands and how its patches lie.
#[derive(Debug, Clone)]
pub(crate) struct ChartScene {
    columns: usize,
    rows: usize,
    gap: f64,
    /// From pixels to the unit square between the outer corners of the corner patches.
    to_chart: Matrix3,
}

/// Materials after those of the patches: frame and wall.
pub(crate) const FRAME_REFLECTANCE: f64 = 0.035;
pub(crate) const WALL_REFLECTANCE: f64 = 0.22;

impl ChartScene {
    /// A chart whose corner patches have these outer corners, in pixels (integers are pixel centres), clockwise from the
    /// first patch. Corners that are no quadrilateral give a wall without a chart.
    pub(crate) fn new(corners: [[f64; 2]; 4], columns: usize, rows: usize, gap: f64) -> Self {
        let [[x0, y0], [x1, y1], [x2, y2], [x3, y3]] = corners;
        let (dx1, dx2, dx3) = (x1 - x2, x3 - x2, x0 - x1 + x2 - x3);
        let (dy1, dy2, dy3) = (y1 - y2, y3 - y2, y0 - y1 + y2 - y3);
        let size = dx1 * dy2 - dx2 * dy1;
        let (g, h) = ((dx3 * dy2 - dx2 * dy3) / size, (dx1 * dy3 - dx3 * dy1) / size);
        // Heckbert, "Fundamentals of Texture Mapping and Image Warping", 1989, 2.2.3.
        let onto = Matrix3::new(
            x1 - x0 + g * x1,
            x3 - x0 + h * x3,
            x0,
            y1 - y0 + g * y1,
            y3 - y0 + h * y3,
            y0,
            g,
            h,
            1.0,
        );
        let beyond = Matrix3::new(0.0, 0.0, -9.0, 0.0, 0.0, -9.0, 0.0, 0.0, 1.0);
        Self { columns, rows, gap, to_chart: onto.try_inverse().unwrap_or(beyond) }
    }

    /// Colour of a pixel: the mean over its area.
    pub(crate) fn pixel(&self, x: usize, y: usize, palette: &[[f32; 3]]) -> [f32; 3] {
        let mut sum = [0f32; 3];
        for i in 0..OVER * OVER {
            let shift = |i: usize| (i as f64 + 0.5) / OVER as f64 - 0.5;
            let material = self.material(x as f64 + shift(i % OVER), y as f64 + shift(i / OVER));
            for (s, v) in sum.iter_mut().zip(palette[material]) {
                *s += v;
            }
        }
        sum.map(|v| v / (OVER * OVER) as f32)
    }

    /// Which material stands at a place.
    fn material(&self, x: f64, y: f64) -> usize {
        let (frame, wall) = (self.columns * self.rows, self.columns * self.rows + 1);
        let place = self.to_chart * Vector3::new(x, y, 1.0);
        if place[2] <= 0.0 {
            return wall;
        }
        let span = |n: usize| n as f64 + (n as f64 - 1.0) * self.gap;
        let across = place[0] / place[2] * span(self.columns);
        let down = place[1] / place[2] * span(self.rows);
        let within = |v: f64, n: usize| v > -FRAME && v < span(n) + FRAME;
        if !within(across, self.columns) || !within(down, self.rows) {
            return wall;
        }
        let cell = |v: f64, n: usize| {
            let i = (v / (1.0 + self.gap)).floor();
            let inside = v - i * (1.0 + self.gap) < 1.0;
            (inside && i >= 0.0 && (i as usize) < n).then_some(i as usize)
        };
        match (cell(across, self.columns), cell(down, self.rows)) {
            (Some(column), Some(row)) => row * self.columns + column,
            _ => frame,
        }
    }
}
