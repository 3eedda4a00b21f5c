//! The profiles of the repository.

use std::collections::BTreeMap;
use std::path::PathBuf;

use darkroot_colour::white;
use darkroot_tests::root;

use crate::files;

/// Every profile of the repository with its text.
fn profiles() -> Vec<(PathBuf, String)> {
    let all = files(&root().join("profiles")).into_iter();
    all.filter(|path| path.extension().is_some_and(|e| e == "toml"))
        .map(|path| (path.clone(), std::fs::read_to_string(&path).unwrap()))
        .collect()
}

/// What is wrong with a profile, in words.
fn fault(text: &str) -> Option<String> {
    let profile = match darkroot_profile::file::parse(text) {
        Ok(profile) => profile,
        Err(error) => return Some(error.to_string()),
    };
    if profile.origin().summary.is_empty() {
        return Some("has no origin: how was it made?".to_owned());
    }
    profile.calibrations().iter().find_map(|calibration| {
        let white = calibration.model.xyz([1.0; 3]);
        let off = [white.x - white::D50.x, white.y - white::D50.y, white.z - white::D50.z];
        let wrong = off.iter().any(|d| d.abs() > 1e-6);
        wrong.then(|| format!("maps white to {white:?} under {}", calibration.light.name))
    })
}

#[test]
fn every_profile_parses_and_maps_white_to_white() {
    for (path, text) in profiles() {
        assert_eq!(fault(&text), None, "{}", path.display());
        let profile = darkroot_profile::file::parse(&text).unwrap();
        assert_eq!(
            darkroot_profile::file::parse(&darkroot_profile::file::format(&profile)).as_ref(),
            Ok(&profile)
        );
    }
}

#[test]
fn a_profile_lies_in_the_folder_of_its_maker_under_the_name_of_its_camera() {
    let plain = |s: &str| s.to_lowercase().replace(|c: char| !c.is_alphanumeric(), "");
    let mut taken = BTreeMap::new();
    for (path, text) in profiles() {
        let camera = darkroot_profile::file::parse(&text).unwrap().camera().clone();
        let folder = path.parent().unwrap().file_name().unwrap().to_string_lossy().into_owned();
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        assert_eq!(plain(&folder), plain(&camera.make), "{}", path.display());
        assert!(plain(&name).contains(&plain(&camera.model)), "{}", path.display());
        assert_eq!(taken.insert(plain(&camera.name()), path.clone()), None, "{}", path.display());
    }
}

#[test]
fn a_profile_that_tints_white_is_found() {
    let good =
        std::fs::read_to_string(root().join("tests/golden/0015-root-polynomial/profile.toml")).unwrap();
    assert_eq!(fault(&good), None);
    assert!(fault(&good.replace("0.68", "0.69")).unwrap().contains("maps white to"));
    assert!(fault(&good.replace("summary = \"written", "summary = \"\" #")).unwrap().contains("origin"));
}
