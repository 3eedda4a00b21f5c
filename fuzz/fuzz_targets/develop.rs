#![no_main]

//! From bytes to a small tile of the picture; one in 16 with the default colours, for which a camera without a profile is
//! estimated, the others with the file's own matrix.

use std::sync::LazyLock;

use darkroot::{Cancel, Photo, ProfileChoice, ProfileStore, Settings, View};
use darkroot_fuzz::LIMITS;
use darkroot_photo::Rect;
use libfuzzer_sys::{fuzz_mutator, fuzz_target};

static STORE: LazyLock<ProfileStore> = LazyLock::new(ProfileStore::builtin);

fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    darkroot_fuzz::mutate_tiff(data, size, max_size, seed)
});

fuzz_target!(init: darkroot_fuzz::expect_panics_of_decoders(), |bytes: &[u8]| {
    let Ok(photo) = Photo::open(bytes, &LIMITS) else { return };
    let estimated = darkroot_fuzz::is_one_of(16, bytes);
    let profile = if estimated { ProfileChoice::Automatic } else { ProfileChoice::Matrix };
    let settings = Settings { profile, ..Settings::default() };
    let Ok(plan) = photo.plan(&photo.analyse(), &STORE, &settings) else { return };
    let size = plan.size();
    let tile = Rect { x: size.width / 3, y: size.height / 3, width: size.width.min(24), height: size.height.min(24) };
    let _ = plan.render(View::of(tile), &Cancel::default());
});
