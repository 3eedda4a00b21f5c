//! What a file holds beside its picture: the colours and the preview of a DNG, the gain map of an Ultra HDR JPEG.

use std::path::Path;
use std::sync::Arc;

use darkroot_develop::{Cancel, Cancelled, Plan, Recipe, Scale};
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
    /// The encoder's options, with all that the file holds beside the picture.
    pub(super) fn options(&self, mut options: Options, notes: &mut Vec<String>) -> Result<Options, Error> {
        if self.format == Format::Dng {
            let facts = dng::facts(self.input, self.capture, self.plan, self.look()?);
            let dng = facts.map_err(|source| Error::Dng { path: self.input.to_owned(), source })?;
            options.dng = Arc::new(dng);
        }
        let stops = self.settings.hdr;
        if stops > 0.0 && self.format == Format::Avif {
            options.peak = Some(hdr::peak(stops));
        } else if stops > 0.0 {
            let [shown, brighter] = hdr::recipes(self.asked, stops).map(|recipe| {
                let plan = (self.planned)(&recipe)?;
                self.view(&plan, Scale::halved(hdr::HALVINGS).unwrap_or(Scale::FULL))
            });
            options.gain_map = hdr::gain_map([&shown?, &brighter?], stops).map(Arc::new);
            if options.gain_map.is_none() {
                notes.push("nothing in the picture is brighter than white: it has no gain map".to_owned());
            }
        }
        Ok(options)
    }

    /// Whether the picture's samples are light of the sensor or absolute light.
    pub(super) fn is_for_no_screen(&self) -> bool {
        self.format == Format::Dng || self.format == Format::Avif && self.settings.hdr > 0.0
    }

    /// A small picture in sRGB, with the look that was asked for.
    pub(super) fn look(&self) -> Result<Picture, Error> {
        let shown = (self.planned)(&dng::shown(self.asked))?;
        self.view(&shown, Scale::to_show(shown.size(), dng::PREVIEW))
    }

    fn view(&self, plan: &Plan, scale: Scale) -> Result<Picture, Error> {
        plan.render(plan.whole(scale), self.cancel)
            .map_err(|Cancelled| Error::Cancelled { path: self.input.to_owned() })
    }
}
