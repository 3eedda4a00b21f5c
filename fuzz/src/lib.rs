//! What the targets share.

use std::cell::RefCell;
use std::path::Path;

use darkroot_raw::Limits;
use darkroot_tests::tiff_mutator::{Random, mutate};

/// Small, so that an input which claims much is refused and not tried: what large claims cost is tested elsewhere.
pub const LIMITS: Limits = Limits { max_samples: 300_000, max_side: 4096 };

/// Libraries that Darkroot runs behind a guard, which turns their panics into errors.
const GUARDED: [&str; 2] = ["flashraw", "rawloader"];

/// A panic ends a target, but for those of the decoders that Darkroot catches. What gets past its guard still ends it.
pub fn expect_panics_of_decoders() {
    let end = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |info| {
        let is_guarded = info.location().is_some_and(|l| GUARDED.iter().any(|name| l.file().contains(name)));
        if !is_guarded {
            end(info);
        }
    }));
}

/// Every other time damage that knows TIFF's directories, else libFuzzer's own. The place in `data`, its length and the
/// longest length are as libFuzzer gives them.
pub fn mutate_tiff(data: &mut [u8], size: usize, max_size: usize, seed: u32) -> usize {
    if seed % 2 == 0 {
        return libfuzzer_sys::fuzzer_mutate(data, size, max_size);
    }
    let mut bytes = data[..size].to_vec();
    mutate(&mut bytes, &mut Random::new(seed.into()));
    bytes.truncate(max_size.min(data.len()));
    data[..bytes.len()].copy_from_slice(&bytes);
    bytes.len()
}

/// Whether the input is one of so many, told by its bytes, so that it is so each time. For work that takes a thousand
/// times as long as reading and is of the same length for every input, such as fitting a profile.
pub fn is_one_of(many: u32, bytes: &[u8]) -> bool {
    let mixed =
        bytes.iter().fold(0x811c_9dc5_u32, |hash, byte| (hash ^ u32::from(*byte)).wrapping_mul(0x0100_0193));
    (mixed >> 8) % many == 0
}

/// The input as a file of this name, for functions that take paths. In memory where the system has such a disk.
pub fn as_file<T>(name: &str, bytes: &[u8], look: impl FnOnce(&Path) -> T) -> T {
    thread_local! {
        static FOLDER: RefCell<Option<tempfile::TempDir>> = const { RefCell::new(None) };
    }
    FOLDER.with_borrow_mut(|folder| {
        let folder = folder.get_or_insert_with(|| {
            let memory = Path::new("/dev/shm");
            let made = if memory.is_dir() { tempfile::tempdir_in(memory) } else { tempfile::tempdir() };
            made.expect("a folder for inputs")
        });
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().expect("it lies in a folder")).expect("a folder for inputs");
        std::fs::write(&path, bytes).expect("a place for inputs");
        look(&path)
    })
}
