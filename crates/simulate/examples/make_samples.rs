//! Writes the files of `samples/` and their manifest: `cargo run -p darkroot-simulate --example make_samples`.

use std::fmt::Write;
use std::path::Path;

use sha2::{Digest, Sha256};

fn main() -> std::io::Result<()> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples");
    let mut manifest = String::from(
        "# Written by `cargo run -p darkroot-simulate --example make_samples`, byte for byte the same each time.\n",
    );
    for sample in darkroot_simulate::samples::all() {
        std::fs::write(folder.join(sample.name), &sample.bytes)?;
        let hash = Sha256::digest(&sample.bytes).iter().fold(String::new(), |mut hash, byte| {
            let _ = write!(hash, "{byte:02x}"); // Writing to a string cannot fail.
            hash
        });
        let _ = write!(
            manifest,
            "\n[[sample]]\nname = \"{}\"\nsha256 = \"{hash}\"\nlicence = \"CC0-1.0\"\nmade = \"{}\"\n",
            sample.name, sample.made
        );
        eprintln!("samples/{}: {} bytes", sample.name, sample.bytes.len());
    }
    std::fs::write(folder.join("MANIFEST.toml"), manifest)
}
