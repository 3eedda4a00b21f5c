//! What a file holds beside its picture: the colours and the preview of a DNG, the gain map of an Ultra HDR JPEG.

use std::path::Path;
use std::sync::Arc;

use darkroot_develop::{Cancel, Cancelled, Kept, Plan, Recipe, Scale};
use darkroot_encode::{Format, Options};
use darkroot_photo::{Capture, Picture};

use crate::settings::Settings;
use crate::{Error, dng, hdr};

/// A job's picture, for which all is decided, and how another one of the same photograph is planned.
pub(super) struct Beside<'a> {
    pub(super) input: &'a Path,
    pub(super) capture: &'a Capture,
    pub(super) settings: &'a Settings,
    pub(super) format: Format,
    /// The recipe as it was asked for.
    pub(super) asked: &'a Recipe,
    pub(super) plan: &'a Plan,
    pub(super) planned: &'a dyn Fn(&Recipe) -> Result<Plan, Error>,
    pub(super) cancel: &'a Cancel,
}

impl Beside<'_> {
    /// The encoder's options, with all that the file holds beside the picture. Where that is nothing for a screen, `seen` gets a
    /// small one in its place.
    pub(super) fn options(
        &self,
        mut options: Options,
        seen: &mut Option<&mut dyn FnMut(&Picture)>,
        notes: &mut Vec<String>,
    ) -> Result<Options, Error> {
        let stops = self.settings.hdr;
        let is_absolute = stops > 0.0 && self.format == Format::Avif;
        if self.format == Format::Dng {
            let look = self.look()?;
            if let Some(seen) = seen.take() {
                seen(&look);
            }
            let facts = dng::facts(self.input, self.capture, self.plan, look);
            let dng = facts.map_err(|source| Error::Dng { path: self.input.to_owned(), source })?;
            options.dng = Arc::new(dng);
        }
        if is_absolute {
            if let Some(seen) = seen.take() {
                seen(&self.look()?);
            }
            options.peak = Some(hdr::peak(stops));
        } else if stops > 0.0 {
            // Both are made of the same light of the camera.
            let kept = Kept::default();
            let scale = Scale::halved(hdr::HALVINGS).unwrap_or(Scale::FULL);
            let [shown, brighter] = hdr::recipes(self.asked, stops).map(|recipe| {
                let plan = (self.planned)(&recipe)?;
                self.made(plan.render_again(plan.whole(scale), &kept, self.cancel))
            });
            options.gain_map = hdr::gain_map([&shown?, &brighter?], stops).map(Arc::new);
            if options.gain_map.is_none() {
                notes.push("nothing in the picture is brighter than white: it has no gain map".to_owned());
            }
        }
        Ok(options)
    }

    /// A small picture in sRGB, with the look that was asked for.
    fn look(&self) -> Result<Picture, Error> {
        let shown = (self.planned)(&dng::shown(self.asked))?;
        let view = shown.whole(Scale::to_show(shown.size(), dng::PREVIEW));
        self.made(shown.render(view, self.cancel))
    }

    fn made(&self, picture: Result<Picture, Cancelled>) -> Result<Picture, Error> {
        picture.map_err(|Cancelled| Error::Cancelled { path: self.input.to_owned() })
    }
}
