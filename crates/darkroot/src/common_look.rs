//! One look for a camera, by the embedded previews of several photographs.

use std::path::{Path, PathBuf};

use darkroot_develop::Look;
use darkroot_develop::camera_look::{CameraLook, common};

use crate::job::opened;
use crate::{Error, ProfileStore, Settings, files};

/// The look that a camera gave photographs.
#[derive(Debug)]
pub struct CommonLook {
    /// The camera.
    pub camera: String,
    /// The look. What the photographs differ from it stands in [`CameraLook::left`].
    pub look: CameraLook,
    /// How many photographs tell it.
    pub told_by: usize,
    /// Why others do not.
    pub without: Vec<Error>,
}

/// The look that the previews of photographs of one camera have in common; `None` where they tell none. A photograph that tells of no look is left out.
///
/// # Errors
/// A photograph of another camera.
pub fn common_look(
    paths: &[PathBuf],
    settings: &Settings,
    store: &ProfileStore,
) -> Result<Option<CommonLook>, Error> {
    let mut settings = settings.clone();
    settings.recipe.look = Look::Camera;
    let (mut camera, mut looks, mut without) = (None::<String>, Vec::new(), Vec::new());
    for path in paths {
        match look_of(path, &settings, store) {
            Err(why) => without.push(why),
            Ok((of, look)) => match &camera {
                Some(camera) if *camera != of => {
                    return Err(Error::LookOfOther { path: path.clone(), camera: of, of: camera.clone() });
                }
                _ => {
                    camera = Some(of);
                    looks.push(look);
                }
            },
        }
    }
    let found = common(&looks).zip(camera);
    Ok(found.map(|(look, camera)| CommonLook { camera, look, told_by: looks.len(), without }))
}

fn look_of(path: &Path, settings: &Settings, store: &ProfileStore) -> Result<(String, CameraLook), Error> {
    let photo = opened(path, &files::read(path)?, settings, store)?;
    let chosen = photo.profile(store, settings).map_err(|fault| fault.about(path))?;
    let analysis = photo.analyse_as_asked();
    let look = photo.camera_look(&analysis, chosen.as_ref().map(|c| c.profile.as_ref()));
    let look = look.map_err(|source| Error::Plan { path: path.to_owned(), source })?;
    Ok((photo.capture().camera.name(), look))
}
