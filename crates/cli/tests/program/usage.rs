//! Exit codes, and what goes to stdout and to stderr.

use serde_json::Value;

use super::*;

#[test]
fn wrong_usage_is_exit_code_2_and_says_what_is_right() {
    let desk = Desk::with_dng();
    let wrong: [(&[&str], &str); 22] = [
        (&["develop"], "FILE"),
        (&["inspect"], "FILE"),
        (&["enlarge"], "enlarge"),
        (&["develop", "a.dng", "--clarity"], "--clarity"),
        (&["develop", "a.dng", "--wb", "warm"], "5200K"),
        (&["develop", "a.dng", "--wb", "1,2"], "2.1,1,1.5"),
        (&["develop", "a.dng", "--exposure", "bright"], "stops"),
        (&["develop", "a.dng", "--exposure", "21"], "20"),
        (&["develop", "a.dng", "--quality", "0"], "1..=100"),
        (&["develop", "a.dng", "--quality", "101"], "1..=100"),
        (&["develop", "a.dng", "--space", "cmyk"], "adobe-rgb"),
        (&["develop", "a.dng", "--look", "film"], "neutral"),
        (&["develop", "a.dng", "--contrast", "2"], "-1"),
        (&["develop", "a.dng", "--look", "linear", "--shadows", "1", "-o", "a.tif"], "no room for shadows"),
        (&["develop", "a.dng", "--bits", "12"], "16"),
        (&["develop", "a.dng", "--bits", "16"], "only 8"),
        (&["develop", "a.dng", "--format", "gif"], "tiff"),
        (&["develop", "a.dng", "--highlights", "burn"], "rebuild"),
        (&["develop", "a.dng", "--engine", "other"], "imagepipe"),
        (&["develop", "a.dng", "--threads", "many"], "many"),
        (&["develop", "a.dng", "-q", "-v"], "--quiet"),
        (&["completions", "tcsh"], "zsh"),
    ];
    for (arguments, word) in wrong {
        desk.fails(2, arguments, &[word]);
    }
    assert_eq!(desk.names(), ["a.dng"]);
}

#[test]
fn what_this_file_cannot_do_is_exit_code_1_and_names_the_file() {
    let desk = Desk::with_dng();
    let wrong: [(&[&str], &str); 4] = [
        (&["--wb", "1000K"], "2000 to 25000 K"),
        (&["--wb", "1,0,1"], "more than 0"),
        (&["--wb", "spot:96,0"], "96 x 64"),
        (&["--wb", "5000K,500"], "-150 to 150"),
    ];
    for (arguments, word) in wrong {
        desk.fails(1, &[&["develop", "a.dng"], arguments].concat(), &["a.dng", word]);
    }
    assert_eq!(desk.names(), ["a.dng"]);
}

#[test]
fn words_go_to_stderr_as_many_as_were_asked_for() {
    let desk = Desk::with_dng();
    let say = |arguments: &[&str]| desk.develop(&[&["a.dng", "--overwrite"], arguments].concat()).err;
    assert_eq!(say(&["--quiet"]), "");
    let usual = say(&[]);
    assert!(usual.contains("a.dng -> a.jpg (96 x 64, sRGB, 8 bits"), "{usual}");
    assert!(usual.contains("colours: ") && !usual.contains("white balance"), "{usual}");
    let more = say(&["-v"]);
    for word in ["white balance: ", " K, tint ", "demosaic: ", "decoder: flashraw", "Darkroot Simulated One"]
    {
        assert!(more.contains(word), "no `{word}` in {more}");
    }
    // Errors are said even then.
    desk.fails(1, &["develop", "none.dng", "--quiet"], &["none.dng"]);
}

#[test]
fn what_had_to_be_assumed_is_said() {
    let desk = Desk::new();
    let mut capture = expose(&Scene::still_life(FRAME), &Camera::simulated_one(), &Exposure::default());
    capture.as_shot = None;
    desk.put("a.dng", dng::write(&capture, dng::Storage::JpegStrip));
    let run = desk.run(&["develop", "a.dng", "--json"]);
    assert!(run.err.contains("note: no white balance is recorded"), "{}", run.err);
    let report: Value = serde_json::from_str(&run.out).unwrap();
    let notes: Vec<&str> = report["notes"].as_array().unwrap().iter().map(|n| n.as_str().unwrap()).collect();
    assert!(notes.iter().any(|n| n.contains("white balance")), "{notes:?}");
}

#[test]
fn each_file_has_its_line_of_json_done_or_failed() {
    let desk = Desk::with_dng();
    desk.put("bad.dng", "text");
    let run = desk.run(&["develop", "a.dng", "bad.dng", "--json", "-o", "out/", "--exposure", "1"]);
    assert_eq!(run.code, 1);
    let lines: Vec<Value> = run.out.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(lines.len(), 2);
    let (good, bad) = (&lines[0], &lines[1]);
    assert_eq!((good["status"].as_str(), bad["status"].as_str()), (Some("done"), Some("failed")));
    assert_eq!((good["input"].as_str(), good["output"].as_str()), (Some("a.dng"), Some("out/a.jpg")));
    assert!(good["colours"].as_str().unwrap().starts_with("estimated from the camera's matrix"));
    assert!(good["profile"].is_null() && good["notes"].as_array().unwrap().is_empty(), "{good}");
    assert_eq!(
        (good["width"].as_u64(), good["height"].as_u64(), good["bits"].as_u64()),
        (Some(96), Some(64), Some(8))
    );
    assert_eq!((good["format"].as_str(), good["space"].as_str()), (Some("JPEG"), Some("sRGB")));
    assert!((good["gain"].as_f64().unwrap() - 2.0).abs() < 1e-6, "{good}");
    assert!((good["kelvin"].as_f64().unwrap() / 5500.0 - 1.0).abs() < 0.05, "{good}");
    assert_eq!(good["multipliers"].as_array().unwrap().len(), 3);
    assert!(bad["error"].as_str().unwrap().contains("bad.dng"), "{bad}");
}

#[test]
fn the_number_of_threads_comes_from_the_option_or_the_environment() {
    let desk = Desk::with_dng();
    for threads in ["1", "7", "0"] {
        desk.develop(&["a.dng", "--threads", threads, "--overwrite"]);
    }
    let wrong = desk.command(&["develop", "a.dng"]).env("DARKROOT_THREADS", "x").output().unwrap();
    let run = Run::of(&wrong, &["DARKROOT_THREADS=x"]);
    assert!(run.code == 2 && run.err.contains("threads"), "{}", run.err);
}

#[test]
fn a_reader_that_stops_reading_is_no_panic() {
    let desk = Desk::with_dng();
    let runs: [&[&str]; 4] = [
        &["inspect", "a.dng"],
        &["completions", "bash"],
        &["man"],
        &["develop", "a.dng", "--json", "-o", "json.jpg"],
    ];
    for arguments in runs {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let output = desk.command(arguments).stdout(writer).output().unwrap();
        Run::of(&output, arguments);
    }
}

#[test]
fn words_that_nobody_reads_do_not_stop_the_work() {
    let desk = Desk::with_dng();
    desk.put("b.nef", small_nef());
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    let output = desk.command(&["develop", "a.dng", "b.nef"]).stderr(writer).output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(desk.names(), ["a.dng", "a.jpg", "b.jpg", "b.nef"]);
}
