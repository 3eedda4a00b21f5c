//! Why there is no plan.

use std::path::PathBuf;

use darkroot::shown;

use super::names::{Collision, key_shown};

/// Why there is no plan.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PlanFault {
    /// Names of outputs.
    #[error(transparent)]
    Naming(#[from] darkroot::NamingError),
    /// Settings.
    #[error(transparent)]
    Recipe(#[from] darkroot::RecipeError),
    /// Settings that contradict each other.
    #[error("{input}: {source}", input = shown(input))]
    Settings {
        /// The first input that they hold for.
        input: PathBuf,
        /// What contradicts.
        source: darkroot::SettingsError,
    },
    /// Outputs with one name.
    #[error("{}", collision_list(.0))]
    Collisions(Vec<Collision>),
    /// An output is an input.
    #[error("{path}: is an input of this batch and would be overwritten by a picture", path = shown(path))]
    OverInput {
        /// The file.
        path: PathBuf,
    },
}

fn collision_list(collisions: &[Collision]) -> String {
    const SHOWN: usize = 20;
    let mut text =
        format!("several inputs would be written to one output, for {} of them:", collisions.len());
    for c in collisions.iter().take(SHOWN) {
        text += &format!("\n  {}: {}", key_shown(&c.output), c.inputs_shown());
    }
    if collisions.len() > SHOWN {
        text += &format!("\n  and {} more", collisions.len() - SHOWN);
    }
    text
}
