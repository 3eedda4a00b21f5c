//! The four samples of a Bayer block as brightness and three differences of colour.

/// An orthonormal change of four stabilised samples: noise of variance 1 stays so, and stays independent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rotation {
    /// Rows: grey, red less blue, red and blue less green, green less green.
    pub(super) rows: [[f32; 4]; 4],
}

impl Rotation {
    /// With the axis of grey given for the samples of a block, whose channels stand in `channels`.
    pub(super) fn with_grey(grey: [f32; 4], channels: [usize; 4]) -> Self {
        let places = |channel: usize| channels.map(|c| f32::from(u8::from(c == channel)));
        let [red, green, blue] = [0, 1, 2].map(places);
        // The two greens differ in sign.
        let mut sign = -1.0;
        let greens = green.map(|g| {
            sign = if g > 0.0 { -sign } else { sign };
            g * sign
        });
        let wanted = [
            grey,
            [0, 1, 2, 3].map(|i| red[i] - blue[i]),
            [0, 1, 2, 3].map(|i| 0.5 * (red[i] + blue[i] - green[i])),
            greens,
        ];
        // Gram and Schmidt.
        let mut rows = [[0f32; 4]; 4];
        for i in 0..4 {
            let mut row = wanted[i];
            for done in &rows[..i] {
                let along: f32 = (0..4).map(|k| row[k] * done[k]).sum();
                row = [0, 1, 2, 3].map(|k| row[k] - along * done[k]);
            }
            let length = row.iter().map(|v| v * v).sum::<f32>().sqrt().max(f32::MIN_POSITIVE);
            rows[i] = row.map(|v| v / length);
        }
        Self { rows }
    }

    /// Rotates rows of stabilised samples, one for each place of the block.
    #[inline(always)]
    pub(super) fn forth(&self, samples: [&[f32]; 4], planes: [&mut [f32]; 4]) {
        let n = planes[0].len();
        let [a, b, c, d] = samples.map(|s| &s[..n]);
        for (plane, row) in planes.into_iter().zip(self.rows) {
            let plane = &mut plane[..n];
            for i in 0..n {
                plane[i] = row[0] * a[i] + row[1] * b[i] + row[2] * c[i] + row[3] * d[i];
            }
        }
    }

    /// One row of the samples of a place of the block from rows of the rotated planes.
    #[inline(always)]
    pub(super) fn back(&self, place: usize, planes: [&[f32]; 4], samples: &mut [f32]) {
        let [p, q, r, s] = self.rows.map(|row| row[place]);
        combine([p, q, r, s], planes, samples);
    }

    /// The same for variances.
    #[inline(always)]
    pub(super) fn back_squared(&self, place: usize, planes: [&[f32]; 4], samples: &mut [f32]) {
        combine(self.rows.map(|row| row[place] * row[place]), planes, samples);
    }
}

#[inline(always)]
fn combine(weights: [f32; 4], planes: [&[f32]; 4], out: &mut [f32]) {
    let n = out.len();
    let [a, b, c, d] = planes.map(|p| &p[..n]);
    for i in 0..n {
        out[i] = weights[0] * a[i] + weights[1] * b[i] + weights[2] * c[i] + weights[3] * d[i];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_keeps_lengths_and_grey_lies_on_one_axis() {
        for channels in [[0, 1, 1, 2], [1, 0, 2, 1], [1, 2, 0, 1], [2, 1, 1, 0]] {
            let grey = channels.map(|c| [0.6, 1.0, 0.8][c]);
            let rotation = Rotation::with_grey(grey, channels);
            let samples = grey.map(|g| vec![g]);
            let mut planes = [0; 4].map(|_| vec![0f32]);
            rotation.forth(samples.each_ref().map(|s| &s[..]), planes.each_mut().map(|p| &mut p[..]));
            assert!(planes[1..].iter().all(|p| p[0].abs() < 1e-6), "{planes:?}");
            for (place, grey) in grey.into_iter().enumerate() {
                let mut back = [0.0];
                rotation.back(place, planes.each_ref().map(|p| &p[..]), &mut back);
                assert!((back[0] - grey).abs() < 1e-6);
                rotation.back_squared(place, [&[1.0], &[1.0], &[1.0], &[1.0]], &mut back);
                assert!((back[0] - 1.0).abs() < 1e-6);
            }
        }
    }
}
