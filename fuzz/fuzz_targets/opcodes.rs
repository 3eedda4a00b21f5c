#![no_main]

//! DNG's opcode lists: the input's first byte says which, the rest is the list; then a tile with what they ask for.

use std::sync::LazyLock;

use darkroot::{Cancel, Photo, ProfileChoice, ProfileStore, Settings, View};
use darkroot_fuzz::LIMITS;
use darkroot_photo::Rect;
use darkroot_tests::small_raws;
use libfuzzer_sys::fuzz_target;

static DNG: LazyLock<Vec<u8>> = LazyLock::new(|| small_raws::named("bayer-uncompressed.dng"));
static STORE: LazyLock<ProfileStore> = LazyLock::new(ProfileStore::builtin);

fuzz_target!(init: darkroot_fuzz::expect_panics_of_decoders(), |bytes: &[u8]| {
    let Some((&which, list)) = bytes.split_first() else { return };
    let list_tag = small_raws::OPCODE_LISTS[usize::from(which) % 3];
    let Ok(photo) = Photo::open(&small_raws::with_opcodes(&DNG, list_tag, list), &LIMITS) else { return };
    if photo.capture().mosaic_corrections.is_empty() && photo.capture().picture_corrections.is_empty() {
        return;
    }
    let settings = Settings { profile: ProfileChoice::Matrix, ..Settings::default() };
    let Ok(plan) = photo.plan(&photo.analyse_as_asked(), &STORE, &settings) else { return };
    let _ = plan.render(View::of(Rect { x: 8, y: 8, width: 16, height: 16 }), &Cancel::default());
});
