//! The raw files of the repository.

use std::fmt::Write;

use darkroot_tests::root;
use serde::Deserialize;
use sha2::{Digest, Sha256};

use crate::files;

#[derive(Deserialize)]
struct Manifest {
    sample: Vec<Sample>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Sample {
    name: String,
    sha256: String,
    licence: String,
    made: String,
}

fn manifest() -> Vec<Sample> {
    let text = std::fs::read_to_string(root().join("samples/MANIFEST.toml")).unwrap();
    toml::from_str::<Manifest>(&text).unwrap().sample
}

#[test]
fn every_sample_stands_in_the_manifest_with_its_hash_and_licence() {
    let samples = manifest();
    assert!(!samples.is_empty());
    for sample in &samples {
        let bytes = std::fs::read(root().join("samples").join(&sample.name)).unwrap();
        let hash = Sha256::digest(&bytes).iter().fold(String::new(), |mut hex, byte| {
            write!(hex, "{byte:02x}").unwrap();
            hex
        });
        assert_eq!(hash, sample.sha256, "{}", sample.name);
        assert!(!sample.licence.is_empty() && !sample.made.is_empty(), "{}", sample.name);
    }
    for path in files(&root().join("samples")) {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let known = name == "README.md" || name == "MANIFEST.toml" || samples.iter().any(|s| s.name == name);
        assert!(known, "samples/{name} is not in the manifest");
    }
}

#[test]
fn every_sample_is_made_again_byte_for_byte() {
    let made = darkroot_simulate::samples::all();
    let listed = manifest();
    assert_eq!(made.len(), listed.len());
    for (made, listed) in made.iter().zip(&listed) {
        assert_eq!((made.name, made.made), (listed.name.as_str(), listed.made.as_str()));
        let stored = std::fs::read(root().join("samples").join(made.name)).unwrap();
        assert!(stored == made.bytes, "samples/{} is not what simulate makes", made.name);
    }
}
