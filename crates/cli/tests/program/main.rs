//! The program from end to end: arguments in, files, words and exit codes out. A panic fails every test.

#![allow(clippy::unwrap_used, clippy::panic)] // Clippy takes the helpers of tests for production code.

mod answers;
mod batch;
mod broken;
mod chart;
mod dcp_look;
mod embedded;
mod engines;
mod evaluate;
mod export;
mod formats;
mod frames;
mod geometry;
mod hdr;
mod help;
mod hostile;
mod inspect;
mod linear_dng;
mod looks;
mod luts;
mod maker_lens;
mod metadata;
mod open;
mod outputs;
mod paths;
mod profile_commands;
mod profiles;
mod recipe;
mod sandbox;
mod special;
mod stopped;
mod terminal;
mod usage;
mod watch;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;

use darkroot_photo::Size;
use darkroot_simulate::expose::expose;
use darkroot_simulate::{Camera, Exposure, Scene, dng, nef};
use tempfile::TempDir;

/// Size of the small raw files; the simulated camera leaves four pixels out on each side.
const FRAME: Size = Size { width: 104, height: 72 };
const WIDTH: u32 = 96;
const HEIGHT: u32 = 64;

/// A small DNG of the simulated camera.
fn small_dng() -> &'static [u8] {
    static BYTES: OnceLock<Vec<u8>> = OnceLock::new();
    BYTES.get_or_init(|| {
        let capture = expose(&Scene::still_life(FRAME), &Camera::simulated_one(), &Exposure::default());
        dng::write(&capture, dng::Storage::Uncompressed)
    })
}

/// A small NEF of the simulated Nikon.
fn small_nef() -> &'static [u8] {
    static BYTES: OnceLock<Vec<u8>> = OnceLock::new();
    BYTES.get_or_init(|| {
        let capture = expose(&Scene::still_life(FRAME), &Camera::nikon_d750(), &Exposure::default());
        nef::write(&capture, nef::Storage::Lossless).unwrap()
    })
}

/// A file of the repository's samples.
fn sample(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples").join(name)
}

/// A folder of real files. Tests that need one are ignored where it is not (`tests/build.rs`).
fn real_files(folder: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../..")
        .join(std::env::var_os("DARKROOT_DATA").unwrap())
        .join(folder)
}

/// A folder for one test, in which the program runs.
struct Desk {
    folder: TempDir,
    /// XDG data folder, outside of `folder`.
    data: TempDir,
}

/// What a run of the program left behind.
struct Run {
    code: i32,
    out: String,
    err: String,
}

impl Desk {
    fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap(), data: tempfile::tempdir().unwrap() }
    }

    /// With `a.dng` on it.
    fn with_dng() -> Self {
        let desk = Self::new();
        desk.put("a.dng", small_dng());
        desk
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Writes a file, in a new folder if need be.
    fn put(&self, name: &str, bytes: impl AsRef<[u8]>) {
        std::fs::create_dir_all(self.path(name).parent().unwrap()).unwrap();
        std::fs::write(self.path(name), bytes).unwrap();
    }

    fn read(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }

    /// Names of all files in the folder, sorted, hidden ones too.
    fn names(&self) -> Vec<String> {
        names(self.folder.path())
    }

    /// The program, not yet started, with an environment that is the same everywhere.
    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_darkroot"));
        command.args(arguments);
        self.prepare(&mut command);
        command
    }

    fn prepare(&self, command: &mut Command) {
        command
            .current_dir(self.folder.path())
            .env("XDG_DATA_HOME", self.data.path())
            .env("HOME", self.data.path())
            .env("DARKROOT_THREADS", "2")
            .env_remove("RUST_BACKTRACE");
    }

    /// Runs the program to its end.
    fn run(&self, arguments: &[&str]) -> Run {
        Run::of(&self.command(arguments).output().unwrap(), arguments)
    }

    /// Develops and fails unless that worked and nothing came to stdout.
    fn develop(&self, arguments: &[&str]) -> Run {
        let run = self.run(&[&["develop"], arguments].concat());
        assert_eq!((run.code, run.out.as_str()), (0, ""), "{arguments:?}: {}", run.err);
        run
    }

    /// Runs, and fails unless it ends with the code, nothing on stdout and each of the words on stderr.
    fn fails(&self, code: i32, arguments: &[&str], words: &[&str]) -> Run {
        let run = self.run(arguments);
        assert_eq!((run.code, run.out.as_str()), (code, ""), "{arguments:?}: {}", run.err);
        assert!(run.err.contains("error: "), "{arguments:?}: {}", run.err);
        for word in words {
            assert!(run.err.contains(word), "{arguments:?} says nothing of `{word}`: {}", run.err);
        }
        run
    }
}

impl Run {
    fn of(output: &Output, what: &[&str]) -> Self {
        let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).unwrap();
        let (out, err) = (text(&output.stdout), text(&output.stderr));
        let code =
            output.status.code().unwrap_or_else(|| panic!("{what:?} was ended: {}: {err}", output.status));
        assert!(code != 101 && !err.contains("panicked"), "{what:?} panicked: {err}");
        Self { code, out, err }
    }
}

/// Names of all files in a folder, sorted, hidden ones too.
fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<String> =
        entries.map(|e| e.unwrap().file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}
