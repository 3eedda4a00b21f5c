//! Bilinear demosaicing for any repeating array of red, green and blue filters: the plain reference.

use darkroot_photo::{CameraSpace, Cfa, Mosaic, Rgb};

use super::{signed_sqrt, signed_square};

/// Pixels around the result that it looks at.
pub const BORDER: usize = 3;

/// One neighbour of a pixel: place in the mosaic from the pixel, and weight.
type Neighbour = (isize, f32);

/// Each missing colour is the mean of the samples of that colour in the smallest square around the pixel that
/// has some, weighted by the inverse of their squared distance.
pub fn demosaic(mosaic: &Mosaic<f32>, cfa: &Cfa, border: usize, picture: &mut Rgb<CameraSpace>) {
    let width = mosaic.size.width;
    let size = picture.size();
    let kernels: Vec<[Vec<Neighbour>; 3]> = (0..cfa.width() * cfa.height())
        .map(|i| [0, 1, 2].map(|plane| kernel(cfa, i % cfa.width(), i / cfa.width(), plane, width)))
        .collect();
    let roots: Vec<f32> = mosaic.samples.iter().map(|&v| signed_sqrt(v)).collect();
    for (plane, out) in picture.planes_mut().into_iter().enumerate() {
        for y in 0..size.height {
            for x in 0..size.width {
                let (u, v) = (x + border, y + border);
                let kernel = &kernels[(v % cfa.height()) * cfa.width() + u % cfa.width()][plane];
                let centre = (v * width + u) as isize;
                let sum: f32 =
                    kernel.iter().map(|(offset, weight)| weight * roots[(centre + offset) as usize]).sum();
                out[y * size.width + x] = signed_square(sum);
            }
        }
    }
}

fn kernel(cfa: &Cfa, x: usize, y: usize, plane: usize, width: usize) -> Vec<Neighbour> {
    // Whole periods are added so that places left of and above the pixel count from 0.
    let (px, py) = (cfa.width() * BORDER, cfa.height() * BORDER);
    for reach in 0..=BORDER as isize {
        let mut found = Vec::new();
        for dy in -reach..=reach {
            for dx in -reach..=reach {
                let (u, v) = ((x + px) as isize + dx, (y + py) as isize + dy);
                if cfa.at(u as usize, v as usize).plane() == Some(plane) {
                    let distance = (dx * dx + dy * dy).max(1);
                    found.push((dy * width as isize + dx, 1.0 / distance as f32));
                }
            }
        }
        if !found.is_empty() {
            let total: f32 = found.iter().map(|f| f.1).sum();
            return found.into_iter().map(|(offset, weight)| (offset, weight / total)).collect();
        }
    }
    // Arrays of all three colours have each of them within reach.
    Vec::new()
}
