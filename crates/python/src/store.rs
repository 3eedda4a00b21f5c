//! The profiles that there are.

use std::sync::{Arc, OnceLock};

use darkroot::ProfileStore;

/// The user's profiles and those that are built in, as they were when first asked for.
pub(crate) fn store() -> Arc<ProfileStore> {
    static STORE: OnceLock<Arc<ProfileStore>> = OnceLock::new();
    let make = || match ProfileStore::user_folder() {
        Some(folder) => Arc::new(ProfileStore::with_user_folder(&folder)),
        None => Arc::new(ProfileStore::builtin()),
    };
    Arc::clone(STORE.get_or_init(make))
}
