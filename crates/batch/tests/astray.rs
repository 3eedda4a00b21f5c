//! Workers that are led astray: what a decoder tries then costs its file and no other.
//!
//! The worker is this program started again. Its decoders are sound, so it does what an attacker would when it words an
//! error, which is after it has read the file: what it tries stands in the file's name.

#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)] // A test may stop, and has no harness to tell.

use std::collections::BTreeMap;
use std::error::Error;
use std::fs;
use std::io::{BufReader, stdin, stdout};
use std::path::Path;
use std::process::Command;

use darkroot::ProfileStore;
use darkroot::recipe::{Layer, Layers};
use darkroot_batch::{
    Batch, CrewOptions, Event, PlanOptions, Search, Session, SettingsByFile, Stop, Summary, find, serve,
};
use darkroot_photo::Size;
use darkroot_simulate::expose::expose;
use darkroot_simulate::{Camera, Exposure, Scene, dng};

const FRAME: Size = Size { width: 104, height: 72 };

fn main() {
    match std::env::args().nth(1).as_deref() {
        Some("worker") => work(true),
        Some("open-worker") => work(false),
        _ => {
            what_a_decoder_tries_costs_its_file();
            without_a_sandbox_it_would_succeed();
            println!("test result: ok. 2 passed");
        }
    }
}

fn work(sandbox: bool) {
    let (orders, answers) = (BufReader::new(stdin()), stdout().lock());
    serve(orders, answers, &ProfileStore::builtin(), &words, sandbox).unwrap();
}

/// Does what the file's name says and tells how it went.
fn words(error: &(dyn Error + 'static)) -> String {
    let text = error.to_string();
    let file = text.split(": ").next().unwrap_or_default();
    let folder = Path::new(file).parent().unwrap();
    let out = folder.parent().unwrap().join("out");
    let worked = match Path::new(file).file_stem().unwrap().to_str().unwrap() {
        "opens-a-socket" => std::net::UdpSocket::bind("127.0.0.1:0").is_ok(),
        "starts-a-program" => Command::new("/bin/true").status().is_ok(),
        "reads-another-file" => fs::read(folder.join("good.dng")).is_ok(),
        "changes-a-file" => fs::OpenOptions::new().append(true).open(folder.join("good.dng")).is_ok(),
        "writes-a-file" => fs::write(out.join("new.jpg"), "x").is_ok(),
        "changes-the-journal" => fs::remove_file(out.join(".darkroot/journal.jsonl")).is_ok(),
        other => panic!("{other}"),
    };
    format!("{text}: {}", if worked { "reached" } else { "closed" })
}

const DEEDS: [&str; 6] = [
    "opens-a-socket",
    "starts-a-program",
    "reads-another-file",
    "changes-a-file",
    "writes-a-file",
    "changes-the-journal",
];

/// A batch of a good file and one for each deed, and what was said of those that failed, by deed.
fn run(desk: &Path, worker: &str, deeds: &[&str]) -> (Summary, BTreeMap<String, String>) {
    let (input, out) = (desk.join("in"), desk.join("out"));
    fs::create_dir(&input).unwrap();
    let capture = expose(&Scene::still_life(FRAME), &Camera::simulated_one(), &Exposure::default());
    let good = dng::write(&capture, dng::Storage::Uncompressed);
    fs::write(input.join("good.dng"), &good).unwrap();
    for deed in deeds {
        fs::write(input.join(format!("{deed}.dng")), &good[..good.len() / 2]).unwrap();
    }
    let crew = CrewOptions {
        jobs: 2,
        memory: 4 << 30,
        ..CrewOptions::new(std::env::current_exe().unwrap(), vec![worker.into()])
    };
    let options = PlanOptions::into(&out);
    let mut settings = SettingsByFile::new(Layers::new(None, Layer::flags([]).unwrap(), true).unwrap());
    let search = Search { inputs: vec![input.to_str().unwrap().to_owned()], ..Search::default() };
    let stop = Stop::default();
    let mut batch = Batch::open(&options, crew, ProfileStore::builtin()).unwrap();
    let sources = find(&search, &out).unwrap();
    let plan = batch.plan(sources, &options, &mut settings, &Session::default(), &stop).unwrap();
    let mut failures = BTreeMap::new();
    let summary = batch
        .run(&plan, &stop, &mut |event| {
            if let Event::Failed { words, .. } = event {
                let deed = DEEDS.into_iter().find(|deed| words.contains(deed)).unwrap();
                failures.insert(deed.to_owned(), words.to_owned());
            }
        })
        .unwrap();
    assert!(out.join("good.jpg").is_file(), "{failures:?}");
    assert_eq!(fs::read(input.join("good.dng")).unwrap(), good);
    (summary, failures)
}

fn what_a_decoder_tries_costs_its_file() {
    if let Some(missing) = darkroot_sandbox::offered().missing() {
        println!("skipped: {missing}");
        return;
    }
    let desk = tempfile::tempdir().unwrap();
    let (summary, failures) = run(desk.path(), "worker", &DEEDS);
    assert_eq!((summary.done, summary.failed), (1, DEEDS.len()), "{failures:?}");
    for deed in ["opens-a-socket", "starts-a-program", "writes-a-file"] {
        assert!(failures[deed].contains("was ended"), "{}", failures[deed]);
    }
    for deed in ["reads-another-file", "changes-a-file", "changes-the-journal"] {
        assert!(failures[deed].ends_with("closed"), "{}", failures[deed]);
    }
    assert!(!desk.path().join("out/new.jpg").exists());
    assert!(desk.path().join("out/.darkroot/journal.jsonl").is_file());
}

/// Else the test above would show nothing.
fn without_a_sandbox_it_would_succeed() {
    let desk = tempfile::tempdir().unwrap();
    // Without its journal the batch would end at once.
    let deeds: Vec<&str> = DEEDS.into_iter().filter(|deed| *deed != "changes-the-journal").collect();
    let (_, failures) = run(desk.path(), "open-worker", &deeds);
    for deed in deeds {
        assert!(failures[deed].ends_with("reached"), "{}", failures[deed]);
    }
}
