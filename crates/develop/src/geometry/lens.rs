//! Where a point of the picture without the lens's distortion lies in the picture as taken.

use darkroot_lens::Corrections;
use darkroot_photo::correction::{Distortion, Projection, Warp};
use darkroot_photo::{Capture, Correction, MakerLens, Radial, Rect, Size};

/// One correction of a lens, for a picture of known size.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum LensWarp {
    /// DNG WarpRectilinear, WarpRectilinear2 or WarpFisheye (DNG 1.7, chapter 7).
    Dng {
        /// Column and row of the optical centre; the middle of the first pixel is (0.5, 0.5).
        centre: [f64; 2],
        /// Distance of the farthest corner from it, pixels.
        reach: f64,
        projection: Projection,
        /// One set of coefficients, or one for each of red, green and blue.
        planes: Vec<Distortion>,
    },
    /// What the lensfun database has.
    Measured {
        /// Column and row of the optical centre.
        centre: [f64; 2],
        corrections: Corrections,
    },
    /// What the maker's note says.
    Told {
        /// Column and row of the optical centre.
        centre: [f64; 2],
        /// Half the diagonal of what the maker shows, pixels.
        reach: f64,
        /// By what the radius of a place is multiplied, for red, green and blue, or for all.
        planes: Vec<Radial>,
    },
}

impl LensWarp {
    /// The warps that a capture's file has for its picture, in the order in which they are to be applied.
    pub(super) fn of_file(capture: &Capture, keep_fringes: bool) -> Vec<Self> {
        let size = capture.active_area.size();
        let warps = capture.picture_corrections.iter().filter_map(|correction| match correction {
            Correction::Warp(warp) => Self::dng(warp, size, keep_fringes),
            _ => None,
        });
        warps.collect()
    }

    /// `None` where nothing moves.
    fn dng(warp: &Warp, size: Size, keep_fringes: bool) -> Option<Self> {
        let last = [size.width, size.height].map(|side| side as f64 - 1.0);
        let centre = [0.5 + warp.centre.0 * last[0], 0.5 + warp.centre.1 * last[1]];
        let farthest = |i: usize| (centre[i] - 0.5).abs().max((last[i] + 0.5 - centre[i]).abs());
        let reach = farthest(0).hypot(farthest(1));
        let planes = match (warp.planes.len(), keep_fringes) {
            (0, _) => return None,
            (1 | 2, _) => warp.planes[..1].to_vec(),
            (_, true) => warp.planes[1..2].to_vec(),
            (_, false) => warp.planes[..3].to_vec(),
        };
        let still = still();
        let moves =
            warp.projection == Projection::Fisheye || !planes.iter().all(|plane| alike(plane, &still));
        (reach > 0.0 && moves).then_some(Self::Dng { centre, reach, projection: warp.projection, planes })
    }

    /// What is known of a lens whose picture lies at `shown` of the active area; `None` where it moves nothing.
    pub(super) fn known(corrections: Corrections, shown: Rect) -> Option<Self> {
        (corrections.has_distortion() || corrections.has_tca())
            .then(|| Self::Measured { centre: shown.middle(), corrections })
    }

    /// What a maker's note says of a lens whose picture lies at `shown` of the active area; `None` where it moves nothing.
    pub(super) fn told(lens: &MakerLens, shown: Rect) -> Option<Self> {
        let planes = match (lens.has_fringes(), lens.has_distortion()) {
            (true, _) => lens.places.to_vec(),
            (false, true) => lens.places[1..2].to_vec(),
            (false, false) => return None,
        };
        Some(Self::Told { centre: shown.middle(), reach: half_diagonal(shown.size()), planes })
    }

    /// Whether red, green and blue come from different places.
    pub(super) fn splits_colours(&self) -> bool {
        match self {
            Self::Dng { planes, .. } => planes.iter().any(|plane| !alike(plane, &planes[0])),
            Self::Measured { corrections, .. } => corrections.has_tca(),
            Self::Told { planes, .. } => planes.len() > 1,
        }
    }

    /// Whether places move, and not only colours beside each other.
    pub(super) fn moves_all(&self) -> bool {
        match self {
            Self::Dng { projection, planes, .. } => {
                *projection == Projection::Fisheye || !alike(&planes[planes.len() / 2], &still())
            }
            Self::Measured { corrections, .. } => corrections.has_distortion(),
            Self::Told { planes, .. } => !planes[planes.len() / 2].is_within(1.0, 1.0),
        }
    }

    /// Where the colour `channel` of a point comes from.
    pub(super) fn place(&self, channel: usize, [x, y]: [f64; 2]) -> [f64; 2] {
        match self {
            Self::Dng { centre, reach, projection, planes } => {
                let coefficients = &planes[channel.min(planes.len() - 1)];
                let moved =
                    dng_place(*projection, coefficients, (x - centre[0]) / reach, (y - centre[1]) / reach);
                [centre[0] + reach * moved[0], centre[1] + reach * moved[1]]
            }
            Self::Measured { centre, corrections } => {
                let (u, v) = corrections.place(x - centre[0], y - centre[1])[channel];
                [centre[0] + u, centre[1] + v]
            }
            Self::Told { centre, reach, planes } => {
                let (dx, dy) = (x - centre[0], y - centre[1]);
                let factor = planes[channel.min(planes.len() - 1)].at(dx.hypot(dy) / reach);
                [centre[0] + factor * dx, centre[1] + factor * dy]
            }
        }
    }
}

/// What moves nothing.
fn still() -> Distortion {
    Distortion::from([1.0, 0.0, 0.0, 0.0, 0.0, 0.0])
}

/// Distance of a picture's corners from its middle, pixels.
pub(super) fn half_diagonal(size: Size) -> f64 {
    0.5 * (size.width as f64).hypot(size.height as f64)
}

/// Where a point comes from, both in units of the reach from the centre.
fn dng_place(projection: Projection, plane: &Distortion, dx: f64, dy: f64) -> [f64; 2] {
    let square = dx * dx + dy * dy;
    let radius = square.sqrt();
    let valid = |v: f64| v.max(plane.valid[0]).min(plane.valid[1]);
    let sum = |v: f64| plane.radial.iter().rev().fold(0.0, |sum, k| sum * v + k);
    let factor = match projection {
        Projection::Rectilinear => sum(valid(radius)),
        Projection::RectilinearInverse => 1.0 / sum(valid(radius)),
        Projection::Fisheye => {
            let angle = radius.atan();
            // The angle over the radius is 1 in the middle.
            let share = if radius > 1e-9 { angle / radius } else { 1.0 };
            share * sum(angle)
        }
    };
    let [t0, t1] = plane.tangential;
    [
        factor * dx + t0 * 2.0 * dx * dy + t1 * (square + 2.0 * dx * dx),
        factor * dy + t1 * 2.0 * dx * dy + t0 * (square + 2.0 * dy * dy),
    ]
}

/// Whether two planes do the same.
fn alike(one: &Distortion, other: &Distortion) -> bool {
    let numbers = |plane: &Distortion| plane.radial.into_iter().chain(plane.tangential);
    let close = |(a, b): (f64, f64)| (a - b).abs() < 1e-9;
    numbers(one).zip(numbers(other)).all(close)
}
