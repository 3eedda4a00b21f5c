//! What a capture itself tells, whatever is asked of it later: each question is answered once, when it is first asked.

use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use darkroot_colour::Xy;
use darkroot_photo::Capture;

use crate::light::LinearLight;
use crate::noise::{self, Window};
use crate::survey::{self, Survey};
use crate::white::{self, CameraMatrix};

/// A capture, and what was found out about it. No setting has a say in it, so it serves every plan.
#[derive(Debug)]
pub struct Analysis {
    capture: Arc<Capture>,
    light: Arc<LinearLight>,
    matrix: Option<CameraMatrix>,
    survey: OnceLock<Survey>,
    noise: OnceLock<Vec<Window>>,
    estimated_neutral: OnceLock<Option<[f64; 3]>>,
    /// The neutral that was last asked for, with its white.
    last_white: Mutex<Option<([f64; 3], Xy)>>,
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
            estimated_neutral: OnceLock::new(),
            last_white: Mutex::new(None),
        }
    }

    /// An analysis that has looked at the frame already: plans from it cost next to nothing.
    pub fn of(capture: Arc<Capture>) -> Self {
        let analysis = Self::deferred(capture);
        rayon::join(|| analysis.estimated_neutral(), || analysis.noise());
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
        self.survey.get_or_init(|| survey::survey(&self.capture, &self.light))
    }

    /// Camera RGB of the light's white as the picture shows it; `None` where too little of it is usable.
    pub fn estimated_neutral(&self) -> Option<[f64; 3]> {
        *self.estimated_neutral.get_or_init(|| white::estimate(self.survey(), self.matrix()))
    }

    /// Chromaticity of the white that gives a neutral, by the maker's matrices. The last one is remembered: most settings
    /// that a person changes leave the white as it is.
    #[expect(clippy::float_cmp, reason = "the very same neutral")]
    pub fn white_of(&self, neutral: [f64; 3]) -> Option<Xy> {
        let matrix = self.matrix.as_ref()?;
        let mut last = self.last_white.lock().unwrap_or_else(PoisonError::into_inner);
        match *last {
            Some((known, white)) if known == neutral => Some(white),
            _ => {
                let white = matrix.white_of(neutral);
                *last = Some((neutral, white));
                Some(white)
            }
        }
    }

    /// Windows in which noise shows; none for other sensors than Bayer.
    pub(crate) fn noise(&self) -> &[Window] {
        self.noise.get_or_init(|| noise::windows(&self.capture, &self.light))
    }
}
