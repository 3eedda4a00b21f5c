//! What is decided before anything is written.

use super::*;

#[test]
fn the_tree_is_mirrored() {
    let desk = Desk::with_tree();
    let run = desk.batch(&[]);
    assert_eq!((run.code, run.out.as_str()), (0, ""), "{}", run.err);
    assert_eq!(desk.outputs(), ["a.jpg", "day 1/b.jpg", "day 1/c.jpg", "day 2/ü.jpg"]);
    assert!(desk.left_over().is_empty(), "{:?}", desk.left_over());
    // A batch makes the same pictures as `develop`.
    desk.develop(&["in/a.dng", "-o", "one.jpg"]);
    assert_eq!(desk.read("one.jpg"), desk.read("out/a.jpg"));
}

#[test]
fn a_dry_run_says_what_would_be_done_and_does_nothing() {
    let desk = Desk::with_tree();
    let run = desk.batch(&["--dry-run"]);
    assert_eq!(run.code, 0, "{}", run.err);
    assert_eq!(run.out.lines().count(), 4, "{}", run.out);
    assert!(run.out.contains("in/day 1/b.nef -> out/day 1/b.jpg"), "{}", run.out);
    assert!(run.err.contains("4 files to develop"), "{}", run.err);
    assert!(!desk.path("out").exists());

    let json = desk.batch(&["--dry-run", "--json"]);
    assert_eq!(events(&json, "planned").len(), 4);
    assert_eq!(events(&json, "estimate")[0]["files"], 4);
}

#[test]
fn folders_files_and_patterns_are_chosen_by_the_options() {
    let desk = Desk::with_tree();
    let planned = |arguments: &[&str]| {
        let run = desk.run(&[&["batch", "-o", "out", "--dry-run", "--json"], arguments].concat());
        assert_eq!(run.code, 0, "{arguments:?} {}", run.err);
        let names = events(&run, "planned");
        names.iter().map(|v| v["output"].as_str().unwrap().to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(planned(&["in", "--no-recursive"]), ["a.jpg"]);
    assert_eq!(planned(&["in", "--include", "*.nef"]), ["day 1/b.jpg", "day 1/c.jpg"]);
    assert_eq!(planned(&["in", "--exclude", "day 1"]), ["a.jpg", "day 2/ü.jpg"]);
    assert_eq!(planned(&["in/day 1", "in/day 2"]), ["day 1/b.jpg", "day 1/c.jpg", "day 2/ü.jpg"]);
    assert_eq!(planned(&["in/*/*.nef"]), ["b.jpg", "c.jpg"]);
    assert_eq!(
        planned(&["in/a.dng", "in/day 1", "--name", "{date}-{camera}-{suffix}-{stem}-{seq}.{ext}"]),
        [
            "2026-01-01-Darkroot_Simulated_One-dng-a-0001.jpg",
            "2026-01-01-Nikon_D750-nef-b-0002.jpg",
            "2026-01-01-Nikon_D750-nef-c-0003.jpg"
        ]
    );
}

#[test]
fn collisions_are_listed_before_anything_runs() {
    let desk = Desk::with_tree();
    desk.put("in/a.nef", small_nef());
    desk.put("in/A.NEF", small_nef());
    let run = desk.fails(2, &["batch", "in", "-o", "out"], &["A.jpg: A.NEF, a.dng, a.nef", "--on-collision"]);
    assert!(!run.err.contains("day"), "{}", run.err);
    assert!(!desk.path("out/a.jpg").exists());
    desk.fails(2, &["batch", "in", "-o", "out", "--name", "{ext}/x.{ext}"], &["jpg/x.jpg"]);

    let run = desk.batch(&["--on-collision", "suffix"]);
    assert_eq!(run.code, 0, "{}", run.err);
    assert_eq!(desk.outputs().len(), 6, "{:?}", desk.outputs());
    // The names stay, so nothing is done again.
    let again = desk.batch(&["--on-collision", "suffix", "--json"]);
    assert_eq!(summary(&again), [0, 6, 0, 0], "{}", again.err);
}

#[test]
fn of_inputs_with_one_output_the_preferred_one_is_developed() {
    let desk = Desk::with_tree();
    desk.put("in/a.nef", small_nef());
    let cameras = |arguments: &[&str]| {
        let run = desk.batch(&[&["--json"], arguments].concat());
        assert_eq!(run.code, 0, "{}", run.err);
        let done = events(&run, "done");
        let input = done.iter().find(|v| v["output"] == "a.jpg").map(|v| v["input"].clone());
        let left = events(&run, "left-out");
        assert_eq!(left.len(), 1, "{}", run.out);
        (input, left[0]["input"].clone())
    };
    assert_eq!(cameras(&["--on-collision", "skip"]), (Some("a.dng".into()), "a.nef".into()));
    // What made it before goes on making it.
    assert_eq!(cameras(&["--on-collision", "skip"]), (None, "a.nef".into()));
    assert_eq!(cameras(&["--on-collision", "prefer:NEF,dng"]), (Some("a.nef".into()), "a.dng".into()));
    let shown = desk.batch(&["--on-collision", "prefer:nef", "--dry-run"]);
    assert!(shown.err.contains("a.dng: left out, a.jpg is made of a.nef"), "{}", shown.err);
    desk.fails(2, &["batch", "in", "-o", "out", "--on-collision", "prefer"], &["prefer:nef,dng"]);
}

#[test]
fn an_estimate_comes_of_a_trial_that_leaves_nothing_behind() {
    let desk = Desk::with_tree();
    let run = desk.batch(&["--dry-run", "--json"]);
    let estimate = &events(&run, "estimate")[0];
    assert_eq!((estimate["files"].as_u64(), estimate["by_experience"].as_bool()), (Some(4), Some(true)));
    assert!(estimate["seconds"].as_f64().unwrap() > 0.0 && estimate["output_bytes"].as_u64().unwrap() > 1000);
    assert!(!desk.path("out").exists());
}

#[test]
fn pictures_may_lie_beside_their_raw_files() {
    let desk = Desk::with_tree();
    let beside = ["batch", "in", "-o", "in", "--json"];
    assert_eq!(summary(&desk.run(&beside)), [4, 0, 0, 0]);
    assert!(desk.path("in/day 1/b.jpg").exists());
    assert_eq!(summary(&desk.run(&beside)), [0, 4, 0, 0]);
    // But a picture never replaces a raw file.
    desk.put("in/x.jpg", small_dng());
    desk.fails(2, &["batch", "in", "-o", "in", "--include", "x.jpg"], &["x.jpg", "overwritten"]);
}

#[test]
fn a_folder_without_raw_files_is_said() {
    let desk = Desk::new();
    desk.put("in/notes.txt", "nothing");
    let run = desk.batch(&["--json"]);
    assert_eq!((run.code, summary(&run)), (0, [0, 0, 0, 0]), "{}", run.err);
    assert!(run.err.contains("no raw files"), "{}", run.err);
}

#[test]
fn numbers_stay_when_files_come_later() {
    let desk = Desk::with_tree();
    let name = ["--name", "{seq}.{ext}", "--json"];
    assert_eq!(summary(&desk.batch(&name)), [4, 0, 0, 0]);
    desk.put("in/0-before-all.dng", small_dng());
    let run = desk.batch(&name);
    assert_eq!(summary(&run), [1, 4, 0, 0], "{}", run.err);
    assert_eq!(events(&run, "done")[0]["output"], "0005.jpg");
}

#[test]
fn pictures_that_are_not_ours_are_not_replaced() {
    let desk = Desk::with_tree();
    desk.put("out/a.jpg", "precious");
    let run = desk.batch(&["--json"]);
    assert_eq!((run.code, summary(&run)), (1, [3, 0, 1, 0]), "{}", run.err);
    assert!(run.err.contains("out/a.jpg: exists already") && run.err.contains("--overwrite"), "{}", run.err);
    assert_eq!(desk.read("out/a.jpg"), b"precious");
    assert_eq!(summary(&desk.batch(&["--json", "--overwrite"])), [1, 3, 0, 0]);
    assert_ne!(desk.read("out/a.jpg"), b"precious");
}

#[test]
fn wrong_usage_is_said_before_anything_runs() {
    let desk = Desk::with_tree();
    for (arguments, word) in [
        (&["nowhere"][..], "nowhere"),
        (&["in", "--name", "{name}.jpg"], "{stem}"),
        (&["in", "--name", "../{stem}.jpg"], "out of the output folder"),
        (&["in", "--name", "{stem}.doc"], ".doc"),
        (&["in", "--look", "linear", "--format", "jpeg"], "--look"),
        (&["in", "--shard", "3/2"], "I/N"),
        (&["in", "--shard", "auto"], "SLURM_ARRAY_TASK_ID"),
        (&["in", "--memory", "much"], "4G"),
        (&["in", "--timeout", "0s"], "10m"),
        (&["in", "--report", "r.pdf"], ".html"),
        (&["in", "--chart-shot", "auto", "--wb", "auto"], "--chart-shot"),
        (&["in", "--chart-shot", "auto", "--light", "dusk"], "dusk"),
    ] {
        let run = desk.run(&[&["batch", "-o", "out"], arguments].concat());
        assert_eq!((run.code, run.out.as_str()), (2, ""), "{arguments:?}: {}", run.err);
        assert!(run.err.contains(word), "{arguments:?}: {}", run.err);
        assert!(!desk.path("out").exists(), "{arguments:?} made the folder");
    }
    desk.fails(2, &["batch", "in"], &["-o"]);
    desk.put("in/darkroot.toml", "look = \"lively\"\n");
    desk.fails(2, &["batch", "in", "-o", "out"], &["darkroot.toml", "lively"]);
}

#[test]
fn recipes_of_folders_and_files_count_file_by_file() {
    let desk = Desk::with_tree();
    desk.put("in/day 1/darkroot.toml", "format = \"png\"\nexposure = 1\n");
    desk.put("in/day 1/c.NEF.darkroot.toml", "exposure = -1\n");
    assert_eq!(desk.batch(&[]).code, 0);
    assert_eq!(desk.outputs(), ["a.jpg", "day 1/b.png", "day 1/c.png", "day 2/ü.jpg"]);
    desk.develop(&["in/day 1/b.nef", "--exposure", "1", "-o", "b.png", "--no-recipes"]);
    desk.develop(&["in/day 1/c.NEF", "--exposure", "-1", "-o", "c.png", "--no-recipes"]);
    assert_eq!(desk.read("b.png"), desk.read("out/day 1/b.png"));
    assert_eq!(desk.read("c.png"), desk.read("out/day 1/c.png"));
}

#[test]
fn the_report_is_for_people_and_for_programs() {
    let desk = Desk::with_tree();
    desk.put("in/day 2/bad <b>.nef", "no raw file");
    let run = desk.batch(&["--report", "sheet.html", "--report", "sheet.json"]);
    assert_eq!(run.code, 1);
    let page = String::from_utf8(desk.read("sheet.html")).unwrap();
    assert_eq!(page.matches("data:image/jpeg;base64,").count(), 4);
    let (failed, first) = (page.find("bad &lt;b&gt;.nef").unwrap(), page.find("<figure>").unwrap());
    assert!(failed < first, "failures come first");
    assert!(page.contains("href=\"out/day%202/%C3%BC.jpg\""), "{page}");
    assert!(!page.contains("http"), "the page needs the network");
    let report: serde_json::Value = serde_json::from_slice(&desk.read("sheet.json")).unwrap();
    assert_eq!((report["done"].as_u64(), report["failed"].as_u64()), (Some(4), Some(1)));
    assert_eq!(report["files"][0]["status"], "failed");
    assert_eq!(report["files"][1]["journal"]["written"]["sha256"].as_str().unwrap().len(), 64);
    // Pictures that were made before are shown too.
    desk.batch(&["--report", "again.html"]);
    let page = String::from_utf8(desk.read("again.html")).unwrap();
    assert_eq!(page.matches("data:image/jpeg;base64,").count(), 4);
}
