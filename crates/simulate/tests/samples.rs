//! The files in `samples/` are what this crate makes.

use std::path::Path;

#[test]
fn the_samples_are_made_again_byte_for_byte() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples");
    for sample in darkroot_simulate::samples::all() {
        let stored = std::fs::read(folder.join(sample.name)).unwrap();
        assert!(
            stored == sample.bytes,
            "{} has changed: run `cargo run -p darkroot-simulate --example make_samples`",
            sample.name
        );
    }
}
