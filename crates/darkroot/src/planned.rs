//! The plan of a photograph, by what a shot of a chart tells where it does.

use std::path::Path;

use darkroot_develop::{Analysis, Plan, Recipe};

use crate::from_chart::{self, Told};
use crate::photo::Photo;
use crate::settings::{ChartShot, Settings};
use crate::store::{ChosenProfile, ProfileStore};
use crate::{Error, PlanError, provenance};

impl Photo {
    /// What the settings' shot of a chart tells; `None` where they name none. It takes as long as a chart takes to be found, and
    /// serves every plan whose settings take the same from the same shot. `input` names the photograph in messages.
    ///
    /// # Errors
    /// A file that cannot be read, shows no chart, or a shot that is not good enough.
    pub fn told_by_chart(&self, input: &Path, settings: &Settings) -> Result<Option<Told>, Error> {
        match settings.chart.shot {
            ChartShot::Itself => from_chart::of_photo(input, self, &settings.chart).map(Some),
            ChartShot::None | ChartShot::File(_) => from_chart::of_file(settings),
        }
    }

    /// As [`Photo::plan`], with the exposure, white balance and black that a shot of a chart tells, as the settings ask.
    ///
    /// # Errors
    /// As [`Photo::plan`], and a shot of another camera.
    pub fn plan_by_chart(
        &self,
        input: &Path,
        analysis: &Analysis,
        store: &ProfileStore,
        settings: &Settings,
        told: &Told,
    ) -> Result<Plan, Error> {
        let chosen = self.profile(store, settings).map_err(|fault| fault.about(input))?;
        let recipe = self.recipe(settings).map_err(|fault| match fault {
            PlanError::Settings(source) => Error::Settings { path: input.to_owned(), source },
            PlanError::Develop(source) => Error::Plan { path: input.to_owned(), source },
            PlanError::File(fault) => *fault,
        })?;
        planned(input, self, analysis, chosen.as_ref(), settings, &recipe, Some(told))
    }
}

/// The plan of a photograph whose profile and recipe are known. What was done by the chart is among its notes.
pub(crate) fn planned(
    input: &Path,
    photo: &Photo,
    analysis: &Analysis,
    chosen: Option<&ChosenProfile<'_>>,
    settings: &Settings,
    recipe: &Recipe,
    told: Option<&Told>,
) -> Result<Plan, Error> {
    let profile = chosen.map(|c| c.profile.as_ref());
    let with = |recipe: Recipe| {
        let plan = photo.plan_with(analysis, profile, recipe);
        plan.map_err(|source| Error::Plan { path: input.to_owned(), source })
    };
    let mut recipe = recipe.clone();
    let Some(told) = told else { return with(recipe) };
    told.check(input, photo.capture())?;
    if settings.chart.balance {
        recipe.balance = told.balance(None);
    }
    let stops = recipe.exposure.stops;
    let mut plan = with(recipe.clone())?;
    if settings.chart.balance {
        // The white tells the light, and that how the greys look in it.
        let light =
            provenance::light_of(settings, profile, &plan).and_then(|name| provenance::by_name(&name));
        recipe.balance = told.balance(light.as_ref());
        plan = with(recipe)?;
    }
    let notes = told.expose(&mut plan, stops, photo.capture());
    plan.notes.extend(notes);
    Ok(plan)
}
