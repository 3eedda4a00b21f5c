//! What is asked of one picture.

use std::sync::Arc;

use darkroot::settings::Engine;
use darkroot::{Cancel as Wish, Format, Scale, Settings, View};
use darkroot_develop::{Bits, Look, OutputSpace};
use darkroot_photo::{Picture, Rect};
use numpy::{PyArrayDescr, PyArrayDescrMethods, dtype};
use pyo3::prelude::*;

use crate::fault::{Class, OrException};
use crate::opened::Open;

/// What is asked of one picture.
pub(crate) struct Order {
    pub(crate) settings: Settings,
    pub(crate) store: Arc<darkroot::ProfileStore>,
    pub(crate) scale: Scale,
    pub(crate) region: Option<(usize, usize, usize, usize)>,
}

impl Order {
    /// Makes it. What does not depend on the settings of single pixels is kept for the next picture of the same view.
    pub(crate) fn render(&self, open: &Open, wish: &Wish) -> PyResult<Picture> {
        let plan = open.plan(&self.settings, &self.store)?;
        let mut view = plan.whole(self.scale);
        if let Some((x, y, width, height)) = self.region {
            let whole = view.rect;
            let rect = Rect { x, y, width, height };
            let inside = x.checked_add(width).is_some_and(|right| right <= whole.width)
                && y.checked_add(height).is_some_and(|bottom| bottom <= whole.height);
            if !inside || width == 0 || height == 0 {
                let words = format!(
                    "`region` ({x}, {y}, {width}, {height}) does not lie in the picture, which has {} x {} pixels at this scale",
                    whole.width, whole.height
                );
                return Err(Class::Settings.says(words));
            }
            view = View { scale: self.scale, rect };
        }
        plan.render_again(view, &open.kept, wish).or_exception()
    }
}

/// The scale that a number means.
pub(crate) fn scale_of(scale: f64) -> PyResult<Scale> {
    let fits = |halvings: &u8| (scale * f64::from(1u32 << halvings) - 1.0).abs() < 1e-9;
    (0..=6).find(fits).and_then(Scale::halved).ok_or_else(|| {
        Class::Settings.says(format!("`scale` cannot be {scale}; it is 1, 1/2, 1/4, 1/8, 1/16, 1/32 or 1/64"))
    })
}

/// Settings of a picture that goes into an array, which can have every space and every number of bits.
pub(crate) fn for_array(mut settings: Settings, wanted: Option<&Bound<'_, PyAny>>) -> PyResult<Settings> {
    if settings.engine != Engine::Darkroot {
        return Err(Class::Settings.says("`engine` goes with files: give it to `develop_file`"));
    }
    settings.format = Some(Format::Tiff);
    let measured = settings.recipe.look == Look::Linear || settings.space == Some(OutputSpace::Camera);
    let asked = wanted.map(bits_of).transpose()?;
    if let (Some(asked), Some(said)) = (asked, settings.bits)
        && asked != said
    {
        let words =
            format!("`dtype` and `bits` ask for {} and {} bits; leave one out", asked.count(), said.count());
        return Err(Class::Settings.says(words));
    }
    let usual = if measured { Bits::Float } else { Bits::Eight };
    settings.bits = Some(asked.or(settings.bits).unwrap_or(usual));
    Ok(settings)
}

fn bits_of(wanted: &Bound<'_, PyAny>) -> PyResult<Bits> {
    let py = wanted.py();
    let wanted = PyArrayDescr::new(py, wanted.clone())?;
    let is = |known: Bound<'_, PyArrayDescr>| wanted.is_equiv_to(&known);
    if is(dtype::<u8>(py)) {
        Ok(Bits::Eight)
    } else if is(dtype::<u16>(py)) {
        Ok(Bits::Sixteen)
    } else if is(dtype::<f32>(py)) {
        Ok(Bits::Float)
    } else {
        Err(Class::Settings.says(format!("`dtype` cannot be {wanted}; it is uint8, uint16 or float32")))
    }
}
