//! What lies around each pixel of a plane. Results are smaller than planes: they have no pixels whose surroundings are not
//! all there.

use darkroot_colour::simd::vectorised;

use super::{AROUND, Plane};

/// The smallest of 3 x 3.
pub(super) fn smallest(plane: &Plane, out: &mut Plane) {
    of_nine(
        plane,
        #[inline(always)]
        |a, b| if a < b { a } else { b },
        out,
    );
}

/// The largest of 3 x 3.
pub(super) fn largest(plane: &Plane, out: &mut Plane) {
    of_nine(
        plane,
        #[inline(always)]
        |a, b| if a > b { a } else { b },
        out,
    );
}

fn of_nine(plane: &Plane, pick: impl Fn(f32, f32) -> f32, out: &mut Plane) {
    let (width, height) = (plane.width - 2, plane.height() - 2);
    out.resize(width, height);
    let mut columns = vec![0f32; plane.width];
    for (y, out) in out.samples.chunks_exact_mut(width).enumerate() {
        let [above, here, below] = [0, 1, 2].map(|i| plane.row(y + i));
        vectorised(
            #[inline(always)]
            || {
                for (((column, a), b), c) in columns.iter_mut().zip(above).zip(here).zip(below) {
                    *column = pick(pick(*a, *b), *c);
                }
                for (out, at) in out.iter_mut().zip(columns.windows(3)) {
                    *out = pick(pick(at[0], at[1]), at[2]);
                }
            },
        );
    }
}

/// Mean square of 5 x 5.
pub(super) fn squares(plane: &Plane, out: &mut Plane) {
    const SIDE: usize = 2 * AROUND + 1;
    const SHARE: f32 = 1.0 / (SIDE * SIDE) as f32;
    let (width, height) = (plane.width + 1 - SIDE, plane.height() + 1 - SIDE);
    out.resize(width, height);
    let mut columns = vec![0f32; plane.width];
    for (y, out) in out.samples.chunks_exact_mut(width).enumerate() {
        let rows: [&[f32]; SIDE] = std::array::from_fn(|i| plane.row(y + i));
        vectorised(
            #[inline(always)]
            || {
                let n = columns.len();
                let [a, b, c, d, e] = rows.map(|row| &row[..n]);
                for (i, column) in columns.iter_mut().enumerate() {
                    *column = a[i] * a[i] + b[i] * b[i] + c[i] * c[i] + d[i] * d[i] + e[i] * e[i];
                }
                for (out, at) in out.iter_mut().zip(columns.windows(SIDE)) {
                    *out = SHARE * (at[0] + at[1] + at[2] + at[3] + at[4]);
                }
            },
        );
    }
}
