//! What all requests share.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use darkroot::ProfileStore;
use darkroot::recipe::{Layer, Layers};
use darkroot_batch::{CrewOptions, Wording};

use crate::api::batch::Batches;
use crate::api::chart::Charts;
use crate::facts::KnownFacts;
use crate::latest::Latest;
use crate::opened::Opened;
use crate::roots::Roots;
use crate::small::Smalls;
use crate::{Options, WindowError};

/// What all requests share.
pub(crate) struct Shared {
    pub(crate) roots: Roots,
    pub(crate) profiles: Option<std::path::PathBuf>,
    pub(crate) crew: CrewOptions,
    pub(crate) wording: Wording,
    /// Read again when a profile was saved.
    store: Mutex<Arc<ProfileStore>>,
    pub(crate) opened: Opened,
    pub(crate) latest: Latest,
    pub(crate) facts: KnownFacts,
    pub(crate) smalls: Smalls,
    pub(crate) batches: Batches,
    pub(crate) charts: Charts,
}

impl Shared {
    pub(crate) fn of(options: Options) -> Result<Self, WindowError> {
        Ok(Self {
            roots: Roots::of(&options.inputs)?,
            profiles: options.profiles,
            crew: options.crew,
            wording: options.wording,
            store: Mutex::new(Arc::new(options.store)),
            opened: Opened::default(),
            latest: Latest::default(),
            facts: KnownFacts::default(),
            smalls: Smalls::default(),
            batches: Batches::default(),
            charts: Charts::default(),
        })
    }

    /// The profiles as they are now.
    pub(crate) fn store(&self) -> Arc<ProfileStore> {
        Arc::clone(&locked(&self.store))
    }

    /// Looks for profiles again.
    pub(crate) fn read_profiles(&self) {
        if let Some(folder) = &self.profiles {
            *locked(&self.store) = Arc::new(ProfileStore::with_user_folder(folder));
        }
    }
}

/// Settings of files as `develop` without options has them.
pub(crate) fn layers() -> Result<Layers, darkroot::RecipeError> {
    Layers::new(None, Layer::flags([])?, true)
}

/// What a lock guards. A request that broke while it held it left nothing half done there.
pub(crate) fn locked<T>(lock: &Mutex<T>) -> MutexGuard<'_, T> {
    lock.lock().unwrap_or_else(PoisonError::into_inner)
}
