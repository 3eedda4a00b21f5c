//! SHA-256 of texts, files and profiles, as `sha256sum` prints it.

use std::io::{self, Read};
use std::path::Path;

use darkroot_develop::OutputSpace;
use sha2::{Digest, Sha256};

use darkroot::{Engine, Error, ProfileChoice, ProfileStore, Settings};

/// Bytes that are read at once.
const BLOCK: usize = 1 << 20;

/// Of bytes.
pub(crate) fn bytes(bytes: &[u8]) -> String {
    darkroot::files::sha256(bytes)
}

/// Of a text.
pub(crate) fn text(text: &str) -> String {
    bytes(text.as_bytes())
}

/// Of a file's content.
pub(crate) fn file(path: &Path) -> io::Result<String> {
    content(&mut darkroot::files::open(path)?)
}

/// Of what an open file holds from its place on.
pub(crate) fn content(file: &mut std::fs::File) -> io::Result<String> {
    let mut digest = Sha256::new();
    let mut block = vec![0; BLOCK];
    loop {
        match file.read(&mut block)? {
            0 => return Ok(digest.finalize().iter().map(|b| format!("{b:02x}")).collect()),
            n => digest.update(&block[..n]),
        }
    }
}

/// Of the files that settings name beside the profile, and of the frames in folders that they name; empty where there are none.
pub(crate) fn files(settings: &Settings) -> Result<String, Error> {
    let mut lines = String::new();
    for named in settings.files() {
        for path in darkroot::frames::named(&named)? {
            lines += &self::file(path.as_path()).map_err(|e| Error::read(&path, e))?;
            lines.push('\n');
        }
    }
    Ok(if lines.is_empty() { lines } else { text(&lines) })
}

/// Of the profile that gives a camera's colours under these settings; empty where none does.
pub(crate) fn profile(
    settings: &Settings,
    camera: &darkroot_photo::Camera,
    store: &ProfileStore,
) -> Result<String, Error> {
    if settings.space == Some(OutputSpace::Camera) || settings.engine == Engine::Imagepipe {
        return Ok(String::new());
    }
    let of = |profile: &darkroot_profile::Profile| text(&darkroot_profile::file::format(profile));
    match &settings.profile {
        ProfileChoice::Matrix => Ok(String::new()),
        ProfileChoice::Automatic => Ok(store.find(camera).map(|f| of(&f.profile)).unwrap_or_default()),
        ProfileChoice::File(path) => store.named(path).map(|found| of(&found.profile)),
    }
}
