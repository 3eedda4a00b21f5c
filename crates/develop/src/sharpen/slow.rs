//! The stage as its definition says, pixel by pixel: what the fast one is tested against.

use darkroot_photo::{CameraSpace, Rgb};

use super::kernel::RADIUS;
use super::{AROUND, BEYOND, BORDER, LEAST, MOST, SHARES, STANDS_OUT, Sharpener};

/// What the pixel in a column and row of a picture becomes; it has [`BORDER`] pixels around it.
pub(super) fn sharpened(
    picture: &Rgb<CameraSpace>,
    sharpener: &Sharpener,
    (x, y): (usize, usize),
) -> [f32; 3] {
    let width = picture.size().width as isize;
    let (x, y) = (x as isize, y as isize);
    let planes = picture.planes();
    let light = |x: isize, y: isize| -> f32 {
        let sum: f32 = (0..3).map(|c| SHARES[c] * planes[c][(y * width + x) as usize]).sum();
        sum.min(sharpener.white)
    };
    let details = |x: isize, y: isize| -> f32 {
        square(RADIUS).map(|(i, j)| sharpener.kernel.at(i, j) * light(x + i, y + j)).sum()
    };
    let power = square(AROUND).map(|(i, j)| details(x + i, y + j).powi(2)).sum::<f32>() / 25.0;
    let low = |x: isize, y: isize| square(1).map(|(i, j)| light(x + i, y + j)).fold(f32::MAX, f32::min);
    let high = |x: isize, y: isize| square(1).map(|(i, j)| light(x + i, y + j)).fold(f32::MIN, f32::max);
    let opened = square(1).map(|(i, j)| low(x + i, y + j)).fold(f32::MIN, f32::max);
    let closed = square(1).map(|(i, j)| high(x + i, y + j)).fold(f32::MAX, f32::min);
    let least = square(2).map(|(i, j)| light(x + i, y + j)).fold(f32::MAX, f32::min);
    let most = square(2).map(|(i, j)| light(x + i, y + j)).fold(f32::MIN, f32::max);

    let here = light(x, y);
    let sure = (1.0 - sharpener.noise.at(here) / power).max(0.0);
    let (height, beyond) = (most - least, BEYOND * sharpener.amount);
    let lowest = least - beyond * height.min(2.0 * least) - STANDS_OUT * (closed - here);
    let highest = most + beyond * height + STANDS_OUT * (here - opened);
    let new = (here + sharpener.amount * sure * details(x, y)).min(highest).max(lowest).min(MOST * here);
    let factor = if here > 0.0 { new.max(LEAST * here) / here } else { 1.0 };
    assert!(x >= BORDER as isize && y >= BORDER as isize);
    planes.map(|plane| factor * plane[(y * width + x) as usize])
}

/// Places of a square around nothing.
fn square(reach: usize) -> impl Iterator<Item = (isize, isize)> {
    let reach = reach as isize;
    (-reach..=reach).flat_map(move |y| (-reach..=reach).map(move |x| (x, y)))
}
