//! The profiles that there are.

use std::sync::{Arc, OnceLock};

use darkroot::ProfileStore;

/// The user's profiles and those that are built in, as they were when first asked for.
pub(crate) fn store() -> Arc<ProfileStore> {
    static STORE: OnceLock<Arc<ProfileStore>> = OnceLock::new();
    Arc::clone(STORE.get_or_init(|| Arc::new(ProfileStore::of_user())))
}
