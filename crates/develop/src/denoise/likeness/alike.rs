//! Which blocks of a plane are like others.

use darkroot_photo::Size;

use super::planes::Plane;
use super::transform::SIDE;

/// Rows and columns around a block within which others are looked for.
pub(super) const REACH: usize = 7;
/// Columns that are compared at once, at most.
pub(super) const SPAN: usize = 96;
/// The same, with those of a block.
const WIDE: usize = SPAN + 2 * SIDE;

/// The `N` blocks that are most like one, itself first: how far from it they lie.
#[derive(Clone)]
pub(super) struct Alike<const N: usize> {
    differences: [f32; N],
    shifts: [(i16, i16); N],
}

impl<const N: usize> Alike<N> {
    pub(super) const ITSELF: Self = {
        let mut differences = [f32::INFINITY; N];
        differences[0] = -1.0;
        Self { differences, shifts: [(0, 0); N] }
    };

    /// Where the blocks begin, if the first one begins there.
    #[inline(always)]
    pub(super) fn places(&self, x: usize, y: usize) -> [(usize, usize); N] {
        let place = |(across, down): (i16, i16)| {
            (x.wrapping_add_signed(across.into()), y.wrapping_add_signed(down.into()))
        };
        self.shifts.map(place)
    }

    #[inline(always)]
    fn insert(&mut self, difference: f32, shift: (i16, i16)) {
        let mut i = N - 1;
        while self.differences[i - 1] > difference {
            self.differences[i] = self.differences[i - 1];
            self.shifts[i] = self.shifts[i - 1];
            i -= 1;
        }
        self.differences[i] = difference;
        self.shifts[i] = shift;
    }
}

/// Room for differences.
pub(super) struct Compared {
    columns: [f32; WIDE],
    sums: [f32; WIDE],
}

impl Compared {
    pub(super) fn new() -> Self {
        Self { columns: [0.0; WIDE], sums: [0.0; WIDE] }
    }

    /// Looks for blocks like those that begin at columns `at` (rising, all within [`SPAN`]) of row `y` of the frame. Blocks lie
    /// within the frame, and `plane` has all that are near.
    #[inline(always)]
    pub(super) fn find<const N: usize>(
        &mut self,
        plane: &Plane<'_>,
        frame: Size,
        (at, y): (&[usize], usize),
        alike: &mut [Alike<N>],
    ) {
        alike.fill(Alike::ITSELF);
        let (Some(&first), Some(&last)) = (at.first(), at.last()) else { return };
        for down in outwards() {
            let Some(other) = y.checked_add_signed(down).filter(|v| v + SIDE <= frame.height) else {
                continue;
            };
            for across in outwards() {
                if (across, down) == (0, 0) {
                    continue;
                }
                let begin = first.max((-across).max(0) as usize);
                let end = last.min((frame.width - SIDE).saturating_add_signed(-across));
                if begin > end {
                    continue;
                }
                let n = end - begin + 1;
                self.compare(plane, (begin, y), (begin.wrapping_add_signed(across), other), n);
                let shift = (across as i16, down as i16);
                for (x, alike) in at.iter().zip(alike.iter_mut()) {
                    if (begin..=end).contains(x) {
                        let difference = self.columns[x - begin];
                        if difference < alike.differences[N - 1] {
                            alike.insert(difference, shift);
                        }
                    }
                }
            }
        }
    }

    /// Sums of squared differences of `n` pairs of blocks, beginning at these columns and rows, into `columns`.
    #[inline(always)]
    fn compare(&mut self, plane: &Plane<'_>, one: (usize, usize), other: (usize, usize), n: usize) {
        let wide = n + SIDE - 1;
        let rows: [(&[f32], &[f32]); SIDE] = std::array::from_fn(|r| {
            (plane.row(one.0, one.1 + r, wide), plane.row(other.0, other.1 + r, wide))
        });
        let columns = &mut self.columns[..wide];
        for (i, column) in columns.iter_mut().enumerate() {
            let mut sum = 0.0;
            for (a, b) in rows {
                let difference = a[i] - b[i];
                sum += difference * difference;
            }
            *column = sum;
        }
        // Of two columns, of four, of eight.
        let sums = &mut self.sums[..wide];
        pairs(columns, 1, sums);
        pairs(sums, 2, columns);
        pairs(columns, 4, sums);
        columns.copy_from_slice(sums);
    }
}

/// Shifts from none to the farthest: what is most alike is mostly near, and found first.
fn outwards() -> impl Iterator<Item = isize> {
    (0..=2 * REACH as isize).map(|i| if i % 2 == 0 { i / 2 } else { -(i + 1) / 2 })
}

/// Sums of numbers that lie `step` apart; the last `step` are left as they are.
#[inline(always)]
fn pairs(numbers: &[f32], step: usize, out: &mut [f32]) {
    let n = numbers.len().saturating_sub(step);
    let (near, far, out) = (&numbers[..n], &numbers[step..][..n], &mut out[..n]);
    for i in 0..n {
        out[i] = near[i] + far[i];
    }
}
