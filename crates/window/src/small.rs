//! Small pictures for the contact sheet: what the camera embedded, else what the engine makes.

use std::collections::{HashMap, VecDeque};
use std::sync::{Arc, Mutex};

use darkroot::{Cancel, Limits, Photo, ProfileStore, Scale, Settings};
use darkroot_batch::facts::modified;
use darkroot_colour::RgbSpace;
use darkroot_photo::{Orientation, Picture, PictureSpace, Samples, Size};
use darkroot_raw::Preview;

use crate::fault::Fault;
use crate::roots::Place;
use crate::screen::{self, Gamut, Sent};
use crate::state::locked;

/// Longest side of a small picture, pixels.
const LONGEST: u32 = 640;
/// An embedded picture of at least that side is looked for, pixels.
const ENOUGH: u32 = 300;
/// The same where it is to be there at once: the thumbnails of most cameras have 160 x 120 pixels.
const ENOUGH_AT_ONCE: u32 = 120;
/// Bytes of a file within which most cameras store their small pictures.
const START: u64 = 1 << 20;
/// Bytes of all that are kept.
const KEPT: usize = 64 << 20;

/// A file as it was.
type Identity = (String, u64, i64);

/// A small picture, a JPEG in sRGB.
#[derive(Clone)]
struct Small {
    jpeg: Arc<[u8]>,
    /// Whether a finer one may be had with more work.
    coarse: bool,
}

/// Small pictures that are kept, JPEG; those that were made first go first.
#[derive(Default)]
pub(crate) struct Smalls(Mutex<Kept>);

#[derive(Default)]
struct Kept {
    pictures: HashMap<Identity, Small>,
    order: VecDeque<Identity>,
    bytes: usize,
}

impl Smalls {
    /// The small picture of a file, a JPEG in sRGB; `at_once` a coarse one will do.
    pub(crate) fn of(
        &self,
        name: &str,
        place: &Place,
        store: &ProfileStore,
        at_once: bool,
    ) -> Result<Arc<[u8]>, Fault> {
        let data = std::fs::metadata(&place.path)
            .map_err(|e| Fault::missing(format!("{}: cannot be read: {e}", darkroot::shown(&place.path))))?;
        let identity = (name.to_owned(), data.len(), modified(&data));
        let kept = locked(&self.0).pictures.get(&identity).cloned();
        if let Some(kept) = kept.filter(|kept| at_once || !kept.coarse) {
            return Ok(kept.jpeg);
        }
        let small = made(place, store, at_once)?;
        locked(&self.0).keep(identity, small.clone());
        Ok(small.jpeg)
    }
}

impl Kept {
    fn keep(&mut self, identity: Identity, picture: Small) {
        self.bytes += picture.jpeg.len();
        match self.pictures.insert(identity.clone(), picture) {
            Some(before) => self.bytes -= before.jpeg.len(),
            None => self.order.push_back(identity),
        }
        while self.bytes > KEPT {
            let Some(first) = self.order.pop_front() else { break };
            self.bytes -= self.pictures.remove(&first).map_or(0, |picture| picture.jpeg.len());
        }
    }
}

/// The small picture of a file that is not kept: an embedded one, else what the engine makes.
fn made(place: &Place, store: &ProfileStore, at_once: bool) -> Result<Small, Fault> {
    let enough = if at_once { ENOUGH_AT_ONCE } else { ENOUGH };
    let unusable = |e: darkroot::Error| Fault::unusable(e.to_string());
    let small = |preview: Preview| {
        let coarse = at_once && longest(&preview) < ENOUGH;
        Some(Small { jpeg: upright(preview)?.into(), coarse })
    };
    // The samples need not be read for a picture before them. A smaller one may stand behind them: decoding this one must
    // not cost more than reading them.
    let fits = |preview: &Preview| (enough..=3 * LONGEST).contains(&longest(preview));
    let start = place.read_start(START).map_err(unusable)?;
    if let Some(small) = embedded(&start, enough).filter(fits).and_then(small) {
        return Ok(small);
    }
    let bytes = place.read().map_err(unusable)?;
    match embedded(&bytes, enough).and_then(small) {
        Some(small) => Ok(small),
        None => Ok(Small { jpeg: developed(&bytes, place, store)?.into(), coarse: false }),
    }
}

/// The smallest embedded picture whose longest side has `enough` pixels.
fn embedded(bytes: &[u8], enough: u32) -> Option<Preview> {
    darkroot_raw::preview_to_show(bytes, enough).ok()?
}

/// The longest side of an embedded picture as stored.
fn longest(preview: &Preview) -> u32 {
    u32::try_from(preview.size.width.max(preview.size.height)).unwrap_or(u32::MAX)
}

/// An embedded picture upright and no larger than it must be; `None` where it is not sound.
fn upright(preview: Preview) -> Option<Vec<u8>> {
    let fits = longest(&preview) <= LONGEST;
    if fits && preview.orientation == Orientation::Upright && preview.jpeg.len() < 128 << 10 {
        return Some(preview.jpeg);
    }
    let (stored, rgb) = darkroot_raw::preview_pixels(&preview.jpeg, &Limits::default()).ok()?;
    let (stored, rgb) = smaller(stored, &rgb, stored.width.max(stored.height).div_ceil(LONGEST as usize));
    if stored.area() == 0 {
        return None;
    }
    let size = preview.orientation.applied_to(stored);
    let mut samples = vec![0; 3 * size.area()];
    for (i, pixel) in rgb.chunks_exact(3).enumerate() {
        let (u, v) = preview.orientation.place(i % stored.width, i / stored.width, stored);
        let at = 3 * (v * size.width + u);
        samples[at..at + 3].copy_from_slice(pixel);
    }
    let picture = Picture { size, samples: Samples::U8(samples), space: PictureSpace::Rgb(RgbSpace::SRGB) };
    Some(screen::bytes(&picture, Sent::Jpeg, true).ok()?.0)
}

/// Each pixel the mean of `side` x `side` ones; what is left over at the right and below is left out.
fn smaller(size: Size, rgb: &[u8], side: usize) -> (Size, Vec<u8>) {
    let small = Size { width: size.width / side, height: size.height / side };
    let count = u32::try_from(side * side).unwrap_or(u32::MAX);
    let mut means = Vec::with_capacity(3 * small.area());
    let mut sums = vec![0u32; 3 * small.width];
    for rows in rgb.chunks_exact(3 * size.width * side).take(small.height) {
        sums.fill(0);
        for row in rows.chunks_exact(3 * size.width) {
            for (sum, pixels) in sums.as_chunks_mut::<3>().0.iter_mut().zip(row.chunks_exact(3 * side)) {
                for pixel in pixels.as_chunks::<3>().0 {
                    (0..3).for_each(|c| sum[c] += u32::from(pixel[c]));
                }
            }
        }
        means.extend(sums.iter().map(|sum| ((sum + count / 2) / count) as u8));
    }
    (small, means)
}

/// What the engine makes of it with the defaults.
fn developed(bytes: &[u8], place: &Place, store: &ProfileStore) -> Result<Vec<u8>, Fault> {
    let fault = |words: String| Fault::unusable(format!("{}: {words}", darkroot::shown(&place.path)));
    let settings = screen::shown(Settings::default(), Gamut::Srgb);
    let photo = Photo::open(bytes, &Limits::default()).map_err(|source| {
        Fault::unusable(darkroot::Error::Raw { path: place.path.clone(), source }.to_string())
    })?;
    let plan = photo.plan(&photo.analyse_as_asked(), store, &settings).map_err(|e| fault(e.to_string()))?;
    let view = plan.whole(Scale::to_show(plan.size(), ENOUGH as usize));
    let picture = plan.render(view, &Cancel::default()).map_err(|e| fault(e.to_string()))?;
    screen::bytes(&picture, Sent::Jpeg, false).map(|(bytes, _)| bytes).map_err(|e| fault(e.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_smaller_picture_has_the_means_of_whole_blocks() {
        // Five columns and three rows: the last column and the last row are left over.
        let red = [10, 20, 0, 4, 9, 30, 40, 0, 4, 9, 1, 1, 1, 1, 1];
        let rgb: Vec<u8> = red.into_iter().flat_map(|v| [v, 100, 0]).collect();
        let (size, means) = smaller(Size { width: 5, height: 3 }, &rgb, 2);
        assert_eq!((size, means), (Size { width: 2, height: 1 }, vec![25, 100, 0, 2, 100, 0]));
        let same = smaller(Size { width: 5, height: 3 }, &rgb, 1);
        assert_eq!(same, (Size { width: 5, height: 3 }, rgb));
    }
}
