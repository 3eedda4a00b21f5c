//! What the output could not show, counted while a picture is rendered.

use std::sync::atomic::{AtomicU64, Ordering};

use darkroot_photo::{Display, Rgb};

/// Light beyond black or white from which a pixel counts: less is noise of the darkest tones and rounding.
const COUNTS: f32 = 1e-3;

/// Pixels of a picture that were cut.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Clipped {
    /// Pixels that were looked at.
    pub pixels: u64,
    /// Those with a channel above white.
    pub above: u64,
    /// Those with a channel below black, and none above white: colours outside of the output's primaries.
    pub below: u64,
}

/// A count that every thread may add to.
#[derive(Debug, Default)]
pub struct Tally {
    pixels: AtomicU64,
    above: AtomicU64,
    below: AtomicU64,
}

impl Tally {
    /// What was counted until now.
    pub fn clipped(&self) -> Clipped {
        let [pixels, above, below] =
            [&self.pixels, &self.above, &self.below].map(|count| count.load(Ordering::Relaxed));
        Clipped { pixels, above, below }
    }

    fn add(&self, counted: Clipped) {
        self.pixels.fetch_add(counted.pixels, Ordering::Relaxed);
        self.above.fetch_add(counted.above, Ordering::Relaxed);
        self.below.fetch_add(counted.below, Ordering::Relaxed);
    }
}

/// Cuts every channel at black and at white, and counts where that changes anything.
pub fn clip(mut picture: Rgb<Display>, tally: &Tally) -> Rgb<Display> {
    let [r, g, b] = picture.planes_mut();
    let mut counted = Clipped { pixels: r.len() as u64, ..Clipped::default() };
    for ((r, g), b) in r.iter_mut().zip(g.iter_mut()).zip(b.iter_mut()) {
        let (high, low) = (r.max(*g).max(*b), r.min(*g).min(*b));
        counted.above += u64::from(high > 1.0 + COUNTS);
        counted.below += u64::from(low < -COUNTS && high <= 1.0 + COUNTS);
        [*r, *g, *b] = [*r, *g, *b].map(|v| v.clamp(0.0, 1.0));
    }
    tally.add(counted);
    picture
}

#[cfg(test)]
mod tests {
    use super::*;
    use darkroot_photo::Size;

    #[test]
    fn what_is_cut_is_counted_once() {
        let planes = [vec![0.5, 1.2, -0.1, 1.0005], vec![0.5, -0.2, 0.5, 0.5], vec![0.5, 0.5, 0.5, -0.0005]];
        let picture = Rgb::from_planes(Size { width: 4, height: 1 }, planes).unwrap();
        let tally = Tally::default();
        let cut = clip(picture, &tally);
        assert_eq!(tally.clipped(), Clipped { pixels: 4, above: 1, below: 1 });
        assert_eq!([cut.at(0, 0), cut.at(1, 0), cut.at(2, 0)], [[0.5; 3], [1.0, 0.0, 0.5], [0.0, 0.5, 0.5]]);
        assert_eq!(cut.at(3, 0), [1.0, 0.5, 0.0]);
    }
}
