//! What is read before a file is developed.

use std::path::Path;

use darkroot_develop::{Look, Recipe};

use crate::from_chart::{self, Told};
use crate::photo::Photo;
use crate::settings::{ChartShot, Settings};
use crate::store::ProfileStore;
use crate::{Error, files, frames};

/// A photograph, what a shot of a chart tells of it, and the hash of its file where a reproduction states it.
pub(super) struct Decoded {
    pub(super) photo: Photo,
    pub(super) told: Option<Told>,
    pub(super) hash: String,
}

pub(super) fn decoded(
    input: &Path,
    read: impl FnOnce() -> Result<Vec<u8>, Error>,
    settings: &Settings,
    store: &ProfileStore,
    recipe: &Recipe,
) -> Result<Decoded, Error> {
    let told = from_chart::of_file(settings)?;
    let bytes = read()?;
    let photo = opened(input, &bytes, settings, store)?;
    let told = match settings.chart.shot {
        ChartShot::Itself => Some(from_chart::of_photo(input, &photo, &settings.chart)?),
        _ => told,
    };
    let hash = if recipe.look == Look::Reproduction { files::sha256(&bytes) } else { String::new() };
    Ok(Decoded { photo, told, hash })
}

/// The photograph of a raw file whose bytes these are, as the settings ask for it: its samples, less dark frames and evened out by
/// flats, or its embedded JPEG.
///
/// # Errors
/// One sentence that names the file, or a frame.
pub fn opened(input: &Path, bytes: &[u8], settings: &Settings, store: &ProfileStore) -> Result<Photo, Error> {
    let of_raw = |source| Error::Raw { path: input.to_owned(), source };
    if settings.from_preview {
        let photo = Photo::open_preview(bytes, &settings.limits).map_err(of_raw)?;
        return photo.ok_or_else(|| Error::NoPreview { path: input.to_owned() });
    }
    frames::apply(Photo::open_for(bytes, store, settings).map_err(of_raw)?, settings)
}
