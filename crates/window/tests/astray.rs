//! A decoder of the window that is led astray: it reaches nothing, and what it answers is looked at.
//!
//! The decoder is this program started again. It is sound, so it does what an attacker would when it words an error, which is
//! after it has read the file: what it tries stands in its arguments.

#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)] // A test may stop, and has no harness to tell.

use std::error::Error;
use std::fs;
use std::io::{stdin, stdout};
use std::path::Path;
use std::process::Command;

use darkroot::Limits;
use darkroot_photo::Size;
use darkroot_raw::Decoder;
use darkroot_raw::elsewhere::{Answer, Place, Question};
use darkroot_simulate::expose::expose;
use darkroot_simulate::{Camera, Exposure, Scene, dng};
use darkroot_window::{Apart, serve_decoder};

const FRAME: Size = Size { width: 104, height: 72 };
/// What a decoder tries; the first three end its process.
const DEEDS: [&str; 5] =
    ["opens-a-socket", "starts-a-program", "writes-a-file", "reads-a-file", "changes-a-file"];

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    match arguments.get(1).map(String::as_str) {
        Some("decoder") => work(&arguments, true),
        Some("open-decoder") => work(&arguments, false),
        _ => {
            what_is_decoded_apart_is_what_is_decoded_here();
            a_decoder_reaches_nothing();
            without_a_sandbox_it_would();
            what_a_decoder_says_is_looked_at();
            println!("test result: ok. 4 passed");
        }
    }
}

/// A decoder by its deed and the folder that it tries it in.
fn work(arguments: &[String], sandbox: bool) {
    let words = |error: &(dyn Error + 'static)| {
        let folder = Path::new(&arguments[3]);
        let worked = match arguments[2].as_str() {
            "opens-a-socket" => std::net::UdpSocket::bind("127.0.0.1:0").is_ok(),
            "starts-a-program" => Command::new("/bin/true").status().is_ok(),
            "reads-a-file" => fs::read(folder.join("good.dng")).is_ok(),
            "changes-a-file" => fs::OpenOptions::new().append(true).open(folder.join("good.dng")).is_ok(),
            "writes-a-file" => fs::write(folder.join("new"), "x").is_ok(),
            other => panic!("{other}"),
        };
        format!("{error}: {}", if worked { "reached" } else { "closed" })
    };
    if arguments[2] == "lies" {
        // The length of a head, and one that is none.
        print!("\x04\0\0\0lies");
        return;
    }
    serve_decoder(stdin().lock(), stdout().lock(), &words, sandbox).unwrap();
}

fn apart(kind: &str, deed: &str, folder: &Path) -> Apart {
    let arguments = vec![kind.into(), deed.into(), folder.into()];
    Apart::new(std::env::current_exe().unwrap(), arguments)
}

fn photograph() -> Vec<u8> {
    let capture = expose(&Scene::still_life(FRAME), &Camera::simulated_one(), &Exposure::default());
    dng::write(&capture, dng::Storage::Uncompressed)
}

/// What becomes of half a file.
fn failed(apart: &Apart) -> String {
    let bytes = photograph();
    let question = Question::Samples(Decoder::default());
    apart.ask(question, &bytes[..bytes.len() / 2], &Limits::default()).unwrap_err().to_string()
}

fn what_is_decoded_apart_is_what_is_decoded_here() {
    let desk = tempfile::tempdir().unwrap();
    let apart = apart("decoder", "nothing", desk.path());
    let bytes = photograph();
    let limits = Limits::default();
    let kinds = [Question::Samples(Decoder::default()), Question::Header, Question::Preview { longest: 100 }];
    for question in kinds {
        let here = question.answer(&bytes, &limits).unwrap();
        assert!(apart.ask(question, &bytes, &limits).unwrap() == here, "{question:?}");
        // The same process, or another one.
        assert!(apart.ask(question, &bytes, &limits).unwrap() == here, "{question:?} again");
    }
    let jpeg = include_bytes!("../../../docs/images/window-chart.jpg");
    let Answer::Pixels(size, rgb) = apart.ask(Question::Pixels, jpeg, &limits).unwrap() else {
        panic!("pixels were asked for")
    };
    assert_eq!(Question::Pixels.answer(jpeg, &limits), Ok(Answer::Pixels(size, rgb)));
}

fn a_decoder_reaches_nothing() {
    if let Some(missing) = darkroot_sandbox::offered().missing() {
        println!("skipped: {missing}");
        return;
    }
    let desk = tempfile::tempdir().unwrap();
    let good = photograph();
    fs::write(desk.path().join("good.dng"), &good).unwrap();
    for (i, deed) in DEEDS.into_iter().enumerate() {
        let words = failed(&apart("decoder", deed, desk.path()));
        let wanted = if i < 3 { "SIGSYS" } else { "closed" };
        assert!(words.contains(wanted), "{deed}: {words}");
    }
    assert_eq!(fs::read(desk.path().join("good.dng")).unwrap(), good);
    assert_eq!(fs::read_dir(desk.path()).unwrap().count(), 1);
}

/// Else the test above would show nothing.
fn without_a_sandbox_it_would() {
    let desk = tempfile::tempdir().unwrap();
    fs::write(desk.path().join("good.dng"), photograph()).unwrap();
    for deed in DEEDS {
        let words = failed(&apart("open-decoder", deed, desk.path()));
        assert!(words.ends_with("reached"), "{deed}: {words}");
    }
}

fn what_a_decoder_says_is_looked_at() {
    let desk = tempfile::tempdir().unwrap();
    let words = failed(&apart("decoder", "lies", desk.path()));
    assert!(words.contains("its decoder"), "{words}");
    let nobody = Apart::new(desk.path().join("no-such-program"), Vec::new());
    assert!(failed(&nobody).contains("no process can be started"), "{}", failed(&nobody));
}
