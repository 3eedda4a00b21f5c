//! What a capture itself tells, whatever is asked of it later: each question is answered once, when it is first asked.

use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use darkroot_photo::{Capture, Counts};

use crate::auto_white::Seen;
use crate::clipped_colours::ClippedColours;
use crate::denoise::{self, Asked, Denoiser, Measured, NoiseModel};
use crate::lateral::{self, Lateral};
use crate::light::LinearLight;
use crate::mend::{Mends, Wanted};
use crate::noise::{self, Window};
use crate::sharpen::blur;
use crate::survey::{self, Survey};
use crate::white::CameraMatrix;
use crate::whites::Whites;

/// A capture, and what was found out about it. No setting has a say in it, so it serves every plan.
#[derive(Debug)]
pub struct Analysis {
    capture: Arc<Capture>,
    light: Arc<LinearLight>,
    matrix: Option<CameraMatrix>,
    survey: OnceLock<Survey>,
    noise: OnceLock<Vec<Window>>,
    samples_noise: OnceLock<Option<Measured>>,
    /// Without hot and dead pixels, and with them; each without banding, and with it.
    mends: [[OnceLock<Arc<Mends>>; 2]; 2],
    denoiser: Mutex<Option<Arc<Denoiser>>>,
    blur: OnceLock<Option<f32>>,
    lateral: OnceLock<Option<Lateral>>,
    colours: OnceLock<Option<Seen>>,
    /// For the multipliers that were asked for last: a person who drags another setting keeps them.
    clipped: Mutex<Option<([f32; 3], Arc<ClippedColours>)>>,
}

impl Analysis {
    /// An analysis that looks at the frame when something asks for it.
    pub fn deferred(capture: Arc<Capture>) -> Self {
        Self {
            light: Arc::new(LinearLight::of(&capture)),
            matrix: CameraMatrix::of(&capture),
            capture,
            survey: OnceLock::new(),
            noise: OnceLock::new(),
            samples_noise: OnceLock::new(),
            mends: Default::default(),
            denoiser: Mutex::new(None),
            blur: OnceLock::new(),
            lateral: OnceLock::new(),
            colours: OnceLock::new(),
            clipped: Mutex::new(None),
        }
    }

    /// An analysis that has looked at the frame already: plans from it cost next to nothing.
    pub fn of(capture: Arc<Capture>) -> Self {
        let analysis = Self::deferred(capture);
        rayon::join(|| analysis.colours(), || analysis.noise());
        analysis
    }

    /// The capture.
    pub fn capture(&self) -> &Arc<Capture> {
        &self.capture
    }

    /// What turns its counts into linear light.
    pub fn light(&self) -> &Arc<LinearLight> {
        &self.light
    }

    /// The maker's matrices, where there are any.
    pub fn matrix(&self) -> Option<&CameraMatrix> {
        self.matrix.as_ref()
    }

    /// Light of small blocks, and where channels clip.
    pub fn survey(&self) -> &Survey {
        self.survey.get_or_init(|| survey::survey(&self.capture, &self.light, || self.noise()))
    }

    /// Colours that tell of the light; `None` where too little of the picture is usable.
    pub(crate) fn colours(&self) -> Option<&Seen> {
        self.colours.get_or_init(|| Seen::of(self.survey())).as_ref()
    }

    /// Camera RGB of the light's white as the picture makes it most probable; `None` where too little of it is usable.
    pub fn estimated_neutral(&self, whites: &Whites<'_>) -> Option<[f64; 3]> {
        self.colours().map(|seen| seen.neutral(whites))
    }

    /// How strong the noise of samples is, by their light: as the file says, else as the picture shows. `None` where there
    /// is none to speak of, or nothing tells it.
    pub fn noise_model(&self) -> Option<NoiseModel> {
        let measured = self.measured_noise()?;
        let model = NoiseModel::from_profile(&self.capture.noise_profile).unwrap_or(measured.model);
        let step = match self.capture.counts {
            Counts::U16(_) => 1.0 / self.capture.white.0.iter().fold(f32::MIN_POSITIVE, |a, &b| a.max(b)),
            // Nobody tells light apart that 16 bits do not.
            Counts::F32(_) => 1.0 / 65535.0,
        };
        (!model.is_clean(measured.mean, step)).then_some(model)
    }

    fn measured_noise(&self) -> Option<&Measured> {
        let measured = || denoise::measured(&self.capture, &self.light, self.survey().saturation);
        self.samples_noise.get_or_init(measured).as_ref()
    }

    /// What is to be put right in samples, of what is wanted; nothing in a clean picture.
    pub(crate) fn mends(&self, wanted: Wanted) -> &Arc<Mends> {
        let found = || {
            let (model, measured) = (self.noise_model()?, self.measured_noise()?);
            Some(Mends::of((&self.capture, &self.light), (&model, measured), wanted))
        };
        let mends = &self.mends[usize::from(wanted.hot_pixels)][usize::from(wanted.banding)];
        mends.get_or_init(|| Arc::new(found().unwrap_or_default()))
    }

    /// The filter for noise: the last one, with what it knows of the frame, where the same is asked for again.
    pub(crate) fn denoiser(&self, asked: Asked) -> Option<Arc<Denoiser>> {
        let mut last = self.denoiser.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(last) = last.as_ref().filter(|last| last.asked == asked) {
            return Some(Arc::clone(last));
        }
        let filter = Arc::new(Denoiser::of(&self.capture, asked)?);
        *last = Some(Arc::clone(&filter));
        Some(filter)
    }

    /// How blurred the picture is where it is sharpest: the standard deviation of a Gaussian, in pixels. `None` where too few
    /// edges tell.
    pub fn blur(&self) -> Option<f32> {
        let measured = || {
            let (green, noise) = (self.survey().saturation[1], self.noise_model());
            blur::measured(&self.capture, &self.light, green, noise.as_ref())
        };
        *self.blur.get_or_init(measured)
    }

    /// Lateral chromatic aberration, as the picture shows it; `None` where nothing certain is known.
    pub fn lateral(&self) -> Option<Lateral> {
        let measured = || lateral::measured(&self.capture, &self.light, self.survey());
        *self.lateral.get_or_init(measured)
    }

    /// Colours where the frame is not clipped, balanced, continued into where it is.
    pub(crate) fn clipped_colours(&self, multipliers: [f32; 3]) -> Arc<ClippedColours> {
        let mut last = self.clipped.lock().unwrap_or_else(PoisonError::into_inner);
        match &*last {
            Some((of, colours)) if of.map(f32::to_bits) == multipliers.map(f32::to_bits) => {
                Arc::clone(colours)
            }
            _ => {
                let area = self.capture.active_area;
                let colours = ClippedColours::of(self.survey(), (area.x, area.y), multipliers);
                let colours = Arc::new(colours);
                *last = Some((multipliers, Arc::clone(&colours)));
                colours
            }
        }
    }

    /// Windows in which noise shows; none for other sensors than Bayer.
    pub(crate) fn noise(&self) -> &[Window] {
        self.noise.get_or_init(|| noise::windows(&self.capture, &self.light))
    }
}
