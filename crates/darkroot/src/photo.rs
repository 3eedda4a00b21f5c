//! A photograph in memory: what other programs stand on.
//!
//! ```no_run
//! use darkroot::{Cancel, Limits, Photo, ProfileStore, Scale, Settings};
//!
//! let bytes = std::fs::read("DSC_0001.NEF")?;
//! let photo = Photo::open(&bytes, &Limits::default())?;
//! let analysis = photo.analyse();
//! let plan = photo.plan(&analysis, &ProfileStore::builtin(), &Settings::default())?;
//! let scale = Scale::to_show(plan.size(), 1400);
//! let preview = plan.render(plan.whole(scale), &Cancel::default())?;
//! println!("{} x {}", preview.size.width, preview.size.height);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use std::borrow::Cow;
use std::sync::{Arc, OnceLock};

use darkroot_develop::camera_look::{self, CameraLook, NoCameraLook};
use darkroot_develop::tilt::Tilt;
use darkroot_develop::{Analysis, Balance, CameraMatrix, Lens, Look, Plan, Recipe, Whites};
use darkroot_photo::{Capture, Layout, Picture};
use darkroot_profile::Profile;
use darkroot_raw::{Decoder, Limits};

use crate::estimate::Estimated;
use crate::settings::{ChartShot, Engine, ProfileChoice, Settings, SettingsError};
use crate::store::{ChosenProfile, ProfileStore};
use crate::{frames, lean, lens, lut};

/// A decoded raw file.
#[derive(Debug, Clone)]
pub struct Photo {
    capture: Arc<Capture>,
    /// The camera as far as its matrix tells; made when it is first wanted.
    estimated: Arc<OnceLock<Option<Estimated>>>,
    lut: lut::Last,
    /// How far the picture leans; looked for when it is first wanted.
    tilt: Arc<OnceLock<Option<Tilt>>>,
    /// A small picture of what the camera rendered, where that was asked for.
    pub(crate) rendered: Option<Arc<Picture>>,
}

/// Why there is no plan for a photograph.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PlanError {
    /// Settings that contradict each other.
    #[error(transparent)]
    Settings(#[from] SettingsError),
    /// The profile or the table that was asked for cannot be used.
    #[error(transparent)]
    File(#[from] Box<crate::Error>),
    /// The capture cannot be developed like that.
    #[error(transparent)]
    Develop(#[from] darkroot_develop::Error),
}

impl Photo {
    /// Decodes the bytes of a raw file.
    ///
    /// # Errors
    /// Anything wrong with the file, in one sentence.
    pub fn open(bytes: &[u8], limits: &Limits) -> Result<Self, darkroot_raw::Error> {
        Self::open_with(bytes, Decoder::default(), limits)
    }

    /// As [`Photo::open`], by a decoder of one's choice.
    ///
    /// # Errors
    /// As [`Photo::open`].
    pub fn open_with(bytes: &[u8], decoder: Decoder, limits: &Limits) -> Result<Self, darkroot_raw::Error> {
        darkroot_raw::decode(bytes, decoder, limits).map(Self::from)
    }

    /// As [`Photo::open_with`] the decoder of the settings, and makes ready meanwhile, on another thread, what the header of
    /// the file tells: the camera where the store has no profile for it, and the model for the white as shot.
    ///
    /// # Errors
    /// As [`Photo::open`].
    pub fn open_for(
        bytes: &[u8],
        store: &ProfileStore,
        settings: &Settings,
    ) -> Result<Self, darkroot_raw::Error> {
        let open = || {
            let photo = Self::open_with(bytes, settings.decoder, &settings.limits)?;
            let is_asked = settings.recipe.look == Look::Camera;
            Ok(if is_asked { photo.with_preview(bytes, &settings.limits) } else { photo })
        };
        if settings.profile != ProfileChoice::Automatic || settings.engine != Engine::Darkroot {
            return open();
        }
        let foreseen = || {
            let header = Self::from(darkroot_raw::header(bytes, &settings.limits).ok()?);
            header.make_ready(store, settings);
            Some(header)
        };
        let (photo, header) = rayon::join(open, foreseen);
        let photo = photo?;
        let same = |header: &Self| {
            let (a, b) = (&header.capture, &photo.capture);
            let balance = |capture: &Capture| capture.analog_balance.map(f64::to_bits);
            a.camera == b.camera && a.calibrations == b.calibrations && balance(a) == balance(b)
        };
        Ok(match header.filter(same) {
            Some(header) => Self { estimated: header.estimated, ..photo },
            None => photo,
        })
    }

    /// Finds the profile and, where the white as shot is to be it, the model for that white: both are remembered.
    fn make_ready(&self, store: &ProfileStore, settings: &Settings) {
        let Ok(Some(chosen)) = self.any_profile(store, settings) else { return };
        if settings.light.is_some() || settings.recipe.balance != Balance::AsShot {
            return;
        }
        let matrix = CameraMatrix::of(&self.capture);
        let white = Whites::of(matrix.as_ref(), Some(&chosen.profile)).as_shot(&self.capture);
        if let Some((known, white)) = chosen.profile.known_camera().zip(white) {
            known.model_for(white);
        }
    }

    /// The embedded JPEG of a raw file, which the camera rendered for display; `None` when it has none. A
    /// [look](darkroot_develop::Look) has no say in its plan, nor has a profile.
    ///
    /// # Errors
    /// As [`Photo::open`].
    pub fn open_preview(bytes: &[u8], limits: &Limits) -> Result<Option<Self>, darkroot_raw::Error> {
        Ok(darkroot_raw::decode_preview(bytes, limits)?.map(Self::from))
    }

    /// The photograph with what the camera rendered of it, for [`Look::Camera`]; `bytes` are those of the file. Without a preview
    /// that can be decoded it stays as it is.
    #[must_use]
    pub fn with_preview(self, bytes: &[u8], limits: &Limits) -> Self {
        let small = |preview: Self| camera_look::small(preview.capture).ok().map(Arc::new);
        let rendered = Self::open_preview(bytes, limits).ok().flatten().and_then(small);
        Self { rendered, ..self }
    }

    /// The photograph with the dark frames of the settings taken off, and evened out by their flats. Where they name none it
    /// stays as it is. Jobs on files do this on their own.
    ///
    /// # Errors
    /// Frames that cannot be read, or that are of another camera or size.
    pub fn with_frames(self, settings: &Settings) -> Result<Self, crate::Error> {
        frames::apply(self, settings)
    }

    /// A capture, and what the camera rendered of it.
    pub(crate) fn with_rendered(capture: Capture, rendered: Option<Arc<Picture>>) -> Self {
        Self { rendered, ..Self::from(capture) }
    }

    /// The capture alone; a copy where it is shared.
    pub(crate) fn into_capture(self) -> Capture {
        Arc::unwrap_or_clone(self.capture)
    }

    /// What the file says, and its samples.
    pub fn capture(&self) -> &Capture {
        &self.capture
    }

    /// Looks at the samples once, for every plan to come: noise, clipping, light. No setting has a say in it.
    pub fn analyse(&self) -> Analysis {
        Analysis::of(Arc::clone(&self.capture))
    }

    /// An analysis that looks at the samples as far as one plan asks, and when it asks: for a program that makes one
    /// picture and no more.
    pub fn analyse_as_asked(&self) -> Analysis {
        Analysis::deferred(Arc::clone(&self.capture))
    }

    /// Prepares development: all that depends on settings and not on the part of the picture. Cheap, so that it can be
    /// done again for each move of a slider. The format says which space and sample type the picture has by default.
    ///
    /// # Errors
    /// Settings that contradict each other, a profile that cannot be used, a photograph that cannot be developed like
    /// that.
    pub fn plan(
        &self,
        analysis: &Analysis,
        store: &ProfileStore,
        settings: &Settings,
    ) -> Result<Plan, PlanError> {
        let chosen = self.profile(store, settings)?;
        let recipe = self.recipe(settings)?;
        let mut plan = self.plan_with(analysis, chosen.as_ref().map(|c| c.profile.as_ref()), recipe)?;
        if settings.chart.shot != ChartShot::None {
            plan.notes
                .push("exposure, black and white of a chart are taken by jobs on files only".to_owned());
        }
        Ok(plan)
    }

    /// The recipe that the settings mean, with the table that they name.
    pub(crate) fn recipe(&self, settings: &Settings) -> Result<Recipe, PlanError> {
        let mut recipe = settings.resolve(settings.format.unwrap_or_else(|| settings.default_format()))?;
        recipe.lut = self.lut.of(settings).map_err(Box::new)?;
        Ok(recipe)
    }

    /// As [`Photo::plan`], where the profile and the recipe are known already; what the metadata tell of the lens is looked
    /// up where the recipe asks for it.
    ///
    /// # Errors
    /// A photograph that cannot be developed like that.
    pub(crate) fn plan_with(
        &self,
        analysis: &Analysis,
        profile: Option<&Profile>,
        mut recipe: Recipe,
    ) -> Result<Plan, darkroot_develop::Error> {
        let by_note = recipe.geometry.lens == Lens::Maker && self.capture.maker_lens.is_some();
        let looks_up = matches!(recipe.geometry.lens, Lens::Lensfun | Lens::Maker) && !by_note;
        let asked = looks_up && !self.capture.rendered;
        let (known, note) =
            asked.then(|| lens::known(&self.capture, recipe.lens_name.as_deref())).flatten().unzip();
        recipe.geometry.known = known.flatten();
        let lean = match (recipe.geometry.auto_straighten, self.tilt.get()) {
            (false, _) => None,
            (true, Some(found)) => Some(lean::straighten(&mut recipe, *found)),
            (true, None) => {
                let found = lean::leaning(analysis, profile, &recipe.geometry)?;
                Some(lean::straighten(&mut recipe, *self.tilt.get_or_init(|| found)))
            }
        };
        let look = match recipe.look {
            Look::Camera if !self.capture.rendered => Some(self.camera_look(analysis, profile)?),
            _ => None,
        };
        if let Some(look) = &look {
            recipe = camera_look::with(look, recipe);
        }
        let mut plan = darkroot_develop::plan(analysis, profile, &recipe)?;
        plan.notes.extend(note);
        plan.notes.extend(lean);
        plan.notes.extend(look.map(|look| {
            format!(
                "the look is that of the embedded preview, as {} would make it (median difference {:.1} L*)",
                look.words(),
                look.left
            )
        }));
        Ok(plan)
    }

    /// The look that the camera gave the photograph, by the preview that it was [opened with](Self::with_preview).
    ///
    /// # Errors
    /// No preview, one that tells of no look, or a photograph that cannot be developed.
    pub fn camera_look(
        &self,
        analysis: &Analysis,
        profile: Option<&Profile>,
    ) -> Result<CameraLook, darkroot_develop::Error> {
        let rendered = self.rendered.as_ref().ok_or(NoCameraLook::NoPreview)?;
        camera_look::fit(analysis, profile, rendered)
    }

    /// The profile that gives the colours, with the place it is from: where the store has none for the camera, what its
    /// matrix tells of it ([`Photo::estimated`]). `None` where the file's own matrices serve as they are. Where the settings
    /// name a light, the profile is the one for that light alone.
    ///
    /// # Errors
    /// A file that cannot be read, is no profile, or is for another camera; a light where there is no profile.
    pub fn profile<'a>(
        &'a self,
        store: &'a ProfileStore,
        settings: &Settings,
    ) -> Result<Option<ChosenProfile<'a>>, Box<crate::Error>> {
        if self.capture.rendered {
            return Ok(None);
        }
        let chosen = self.any_profile(store, settings)?;
        match (&settings.light, chosen) {
            (None, chosen) => Ok(chosen),
            (Some(light), Some(chosen)) => Ok(Some(chosen.under(light))),
            (Some(_), None) if *self.capture.counts.layout() == Layout::Monochrome => Ok(None),
            (Some(light), None) => {
                Err(Box::new(crate::Error::LightOfMatrix { light: light.light.name.clone() }))
            }
        }
    }

    /// The profile for all lights.
    fn any_profile<'a>(
        &'a self,
        store: &'a ProfileStore,
        settings: &Settings,
    ) -> Result<Option<ChosenProfile<'a>>, Box<crate::Error>> {
        let found = store.for_camera(&self.capture.camera, &settings.profile).map_err(Box::new)?;
        if found.is_some() || settings.profile != ProfileChoice::Automatic {
            return Ok(found);
        }
        Ok(self.estimated().map(|estimated| ChosenProfile {
            profile: Cow::Borrowed(&estimated.profile),
            place: Cow::Owned(estimated.words()),
            estimated: true,
        }))
    }

    /// The camera that the file's matrix makes most probable ([`crate::estimate()`]).
    pub fn estimated(&self) -> Option<&Estimated> {
        self.estimated.get_or_init(|| crate::estimate(&self.capture)).as_ref()
    }
}

impl From<Capture> for Photo {
    fn from(capture: Capture) -> Self {
        Self {
            capture: Arc::new(capture),
            estimated: Arc::default(),
            tilt: Arc::default(),
            lut: lut::Last::default(),
            rendered: None,
        }
    }
}
