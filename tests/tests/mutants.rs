//! Mutants of small raw files: each is a capture or a sentence, and what is a capture becomes a picture or a sentence.
//! Never a panic that leaves Darkroot, never a hang. More: `DARKROOT_MUTANTS=2000000 cargo test --release`.

#![allow(clippy::unwrap_used)] // A test may stop.

use std::sync::atomic::{AtomicUsize, Ordering};

use darkroot::settings::ProfileChoice;
use darkroot::{Cancel, Photo, ProfileStore, Settings, View};
use darkroot_develop::Lens;
use darkroot_photo::Rect;
use darkroot_raw::{Decoder, Limits, decode, header, preview};
use darkroot_tests::small_raws;
use darkroot_tests::tiff_mutator::{Random, mutate};

/// Mutants in an ordinary run.
const MUTANTS: usize = 20_000;
/// A mutant that claims more than this is refused, not tried: larger claims have tests of their own.
const LIMITS: Limits = Limits { max_samples: 1_000_000, max_side: 4096 };

#[test]
fn every_small_raw_file_is_sound_before_it_is_damaged() {
    for (name, bytes) in small_raws::all() {
        for decoder in [Decoder::Flashraw, Decoder::Rawloader] {
            let found = decode(&bytes, decoder, &LIMITS);
            // Rawloader knows no X-Trans DNG, no single channel and nothing of opcodes: it says so in words.
            assert!(decoder == Decoder::Rawloader || found.is_ok(), "{name}: {found:?}");
        }
    }
}

#[test]
fn opcode_lists_of_small_raw_files_are_read() {
    for (list, mosaic, picture) in [(51009, true, false), (51022, false, true)] {
        let bytes = small_raws::named(&format!("opcodes-{list}.dng"));
        let capture = decode(&bytes, Decoder::Flashraw, &LIMITS).unwrap();
        let found = [!capture.mosaic_corrections.is_empty(), !capture.picture_corrections.is_empty()];
        assert_eq!(found, [mosaic, picture], "{list}: {:?}", capture.notes);
    }
}

#[test]
fn notes_of_small_raw_files_on_the_lens_are_read() {
    for name in ["sony.arw", "fujifilm.raf", "olympus.orf"] {
        let capture = decode(&small_raws::named(name), Decoder::Flashraw, &LIMITS).unwrap();
        assert!(capture.maker_lens.is_some_and(|lens| lens.has_distortion()), "{name}: {:?}", capture.notes);
    }
}

#[test]
fn a_mutant_is_a_picture_or_a_sentence() {
    let files = small_raws::all();
    let mutants = std::env::var("DARKROOT_MUTANTS").ok().and_then(|n| n.parse().ok()).unwrap_or(MUTANTS);
    let (captures, pictures, refused) = (AtomicUsize::new(0), AtomicUsize::new(0), AtomicUsize::new(0));
    let count = |counter: &AtomicUsize| counter.fetch_add(1, Ordering::Relaxed);
    let store = ProfileStore::builtin();
    let try_one = |seed: usize| {
        let mut random = Random::new(seed as u64 + 1);
        let mut bytes = files[seed % files.len()].1.clone();
        mutate(&mut bytes, &mut random);
        let decoder = if random.below(4) == 0 { Decoder::Rawloader } else { Decoder::Flashraw };
        match decode(&bytes, decoder, &LIMITS) {
            Ok(capture) => {
                let size = capture.counts.size();
                assert!(size.area() > 0 && capture.active_area.right() <= size.width, "mutant {seed}");
                assert!(capture.default_crop.bottom() <= size.height, "mutant {seed}");
                count(&captures);
                let photo = Photo::from(capture);
                let tile = |plan: darkroot::Plan| {
                    let size = plan.size();
                    let view = Rect { x: 0, y: 0, width: size.width.min(32), height: size.height.min(32) };
                    plan.render(View::of(view), &Cancel::default()).is_ok()
                };
                // Estimating the camera takes longer than all the rest, and as long for every file: a hundredth do it.
                let profile = match seed % 101 {
                    0 => ProfileChoice::Automatic,
                    _ => ProfileChoice::Matrix,
                };
                let mut settings = Settings { profile, ..Settings::default() };
                settings.recipe.geometry.lens = if seed.is_multiple_of(2) { Lens::Auto } else { Lens::Maker };
                let plan = photo.plan(&photo.analyse_as_asked(), &store, &settings);
                if plan.is_ok_and(tile) {
                    count(&pictures);
                }
            }
            Err(error) => {
                assert!(!error.to_string().is_empty(), "mutant {seed}");
                count(&refused);
            }
        }
        let _ = header(&bytes, &LIMITS);
        let _ = preview(&bytes);
    };
    // Threads of our own: those of the pool would begin the next mutant while they wait for their share of this one.
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for first in 0..threads {
            let try_one = &try_one;
            scope.spawn(move || (first..mutants).step_by(threads).for_each(try_one));
        }
    });
    let [captures, pictures, refused] = [captures, pictures, refused].map(AtomicUsize::into_inner);
    // All must happen, or the damage is too weak or too strong to test anything.
    let found = format!("{captures} decoded, {pictures} developed, {refused} refused");
    assert!(captures > mutants / 10 && pictures > mutants / 20 && refused > mutants / 10, "{found}");
}
