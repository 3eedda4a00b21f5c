#![no_main]

//! Recipes: what is read becomes settings, and what is written of it says the same.

use std::path::Path;

use darkroot::recipe::{Layer, Layers};
use darkroot_fuzz::as_file;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    as_file("recipe.toml", bytes, |path| {
        let Ok(flags) = Layer::flags([]) else { return };
        let Ok(mut layers) = Layers::new(Some(path), flags, false) else { return };
        let Ok(effective) = layers.for_file(Path::new("a.dng")) else { return };
        let _ = effective.settings();
        let texts = effective.texts();
        let again = darkroot::Effective::from_texts(&texts);
        assert!(again.is_ok_and(|again| again.texts() == texts));
    });
});
