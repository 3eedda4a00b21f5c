//! Pictures that lean: how far, and straightened by that.

use darkroot_develop::tilt::{Tilt, tilt};
use darkroot_develop::{Analysis, Cancel, Error, Flip, Geometry, Recipe, Scale};
use darkroot_profile::Profile;

/// Pixels that the longer side of a picture has at least in which its lean is looked for.
const VIEW: usize = 700;

/// The lean of a picture without a turn, freed of what the lens did to its lines; `None` where nothing is sure.
pub(crate) fn leaning(
    analysis: &Analysis,
    profile: Option<&Profile>,
    asked: &Geometry,
) -> Result<Option<Tilt>, Error> {
    let geometry = Geometry { lens: asked.lens, known: asked.known, ..Geometry::default() };
    let plan = darkroot_develop::plan(analysis, profile, &Recipe { geometry, ..Recipe::default() })?;
    let view = plan.whole(Scale::to_show(plan.size(), VIEW));
    // Nobody cancels it.
    Ok(plan.render(view, &Cancel::default()).ok().and_then(|picture| tilt(&picture)))
}

/// Straightens a recipe by a lean; what was done, in words.
pub(crate) fn straighten(recipe: &mut Recipe, found: Option<Tilt>) -> String {
    let Some(tilt) = found else {
        return "nothing in the picture is sure to be level or upright: it was not straightened".to_owned();
    };
    // In a mirror a picture leans the other way.
    let side = if recipe.geometry.flip == Flip::None { 1.0 } else { -1.0 };
    recipe.geometry.straighten = side * (100.0 * tilt.degrees).round() / 100.0;
    let lines = match (tilt.level, tilt.upright) {
        (true, true) => "level and upright lines",
        (true, false) => "level lines",
        _ => "upright lines",
    };
    format!("straightened by {:+.2} degrees, as {lines} say", recipe.geometry.straighten)
}
