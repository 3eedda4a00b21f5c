//! A whole batch through the library with threads as workers: no program is started.

#![allow(clippy::unwrap_used, clippy::panic)] // Clippy takes the helpers of tests for production code.

use std::path::Path;

use darkroot::recipe::{Layer, Layers};
use darkroot::{Control, Job, ProfileStore, Settings};
use darkroot_batch::{
    Batch, CrewOptions, Event, PlanOptions, Search, Session, SettingsByFile, Stop, Summary, Wording, find,
};
use darkroot_photo::Size;
use darkroot_simulate::expose::expose;
use darkroot_simulate::{Camera, Exposure, Scene, dng, nef};

const FRAME: Size = Size { width: 104, height: 72 };

fn raw_files(folder: &Path) {
    let scene = Scene::still_life(FRAME);
    let first = expose(&scene, &Camera::simulated_one(), &Exposure::default());
    let second = expose(&scene, &Camera::nikon_d750(), &Exposure::default());
    std::fs::create_dir_all(folder.join("day 1")).unwrap();
    std::fs::write(folder.join("a.dng"), dng::write(&first, dng::Storage::Uncompressed)).unwrap();
    std::fs::write(folder.join("day 1/b.nef"), nef::write(&second, nef::Storage::Lossless).unwrap()).unwrap();
}

/// Runs a batch of `input` into `out` and returns the summary with what was said of failures.
fn run(input: &Path, out: &Path, stop: &Stop) -> (Summary, Vec<String>) {
    let store = ProfileStore::builtin();
    let crew = CrewOptions {
        jobs: 2,
        threads: 2,
        memory: 2 << 30,
        wording: Wording::new(|error| format!("{error} (said here)")),
        ..CrewOptions::in_process(store.clone())
    };
    let options = PlanOptions::into(out);
    let mut settings = SettingsByFile::new(Layers::new(None, Layer::flags([]).unwrap(), true).unwrap());
    let search = Search { inputs: vec![input.to_str().unwrap().to_owned()], ..Search::default() };
    let sources = find(&search, out).unwrap();
    let mut batch = Batch::open(&options, crew, store).unwrap();
    let plan = batch.plan(sources, &options, &mut settings, &Session::default(), stop).unwrap();
    let mut failures = Vec::new();
    let summary = batch
        .run(&plan, stop, &mut |event| {
            if let Event::Failed { words, .. } = event {
                failures.push(words.to_owned());
            }
        })
        .unwrap();
    (summary, failures)
}

#[test]
fn pictures_are_those_of_developing_each_file_alone() {
    let desk = tempfile::tempdir().unwrap();
    let (input, out) = (desk.path().join("in"), desk.path().join("out"));
    raw_files(&input);
    let (summary, failures) = run(&input, &out, &Stop::default());
    assert_eq!((summary.done, summary.failed, summary.left), (2, 0, 0), "{failures:?}");
    for (raw, picture) in [("a.dng", "a.jpg"), ("day 1/b.nef", "day 1/b.jpg")] {
        let alone = desk.path().join("alone.jpg");
        let job = Job { input: input.join(raw), output: alone.clone() };
        let settings = Settings { overwrite: true, ..Settings::default() };
        darkroot::develop(&job, &settings, &ProfileStore::builtin(), Control::default()).unwrap();
        assert!(std::fs::read(&alone).unwrap() == std::fs::read(out.join(picture)).unwrap(), "{picture}");
    }
    // The same journal: what is done is done.
    let (again, _) = run(&input, &out, &Stop::default());
    assert_eq!((again.done, again.skipped), (0, 2));
}

#[test]
fn a_damaged_file_fails_alone_in_the_words_of_the_program() {
    let desk = tempfile::tempdir().unwrap();
    let (input, out) = (desk.path().join("in"), desk.path().join("out"));
    raw_files(&input);
    let damaged = input.join("c.nef");
    std::fs::write(&damaged, b"MM\0*").unwrap();
    // Old enough that nobody is still writing it.
    let file = std::fs::File::options().write(true).open(&damaged).unwrap();
    file.set_modified(std::time::UNIX_EPOCH + std::time::Duration::from_secs(1_000_000_000)).unwrap();
    let (summary, failures) = run(&input, &out, &Stop::default());
    assert_eq!((summary.done, summary.failed), (2, 1), "{failures:?}");
    assert!(failures[0].contains("c.nef: ") && failures[0].ends_with("(said here)"), "{failures:?}");
}

#[test]
fn a_batch_that_is_told_to_stop_at_once_leaves_the_rest_and_nothing_half_done() {
    let desk = tempfile::tempdir().unwrap();
    let (input, out) = (desk.path().join("in"), desk.path().join("out"));
    raw_files(&input);
    let stop = Stop::default();
    stop.ask();
    stop.ask();
    let (summary, _) = run(&input, &out, &stop);
    assert_eq!((summary.done, summary.left, summary.interrupted), (0, 2, true));
    assert!(!out.join(".darkroot/unfinished").exists() && !out.join("a.jpg").exists());
}
