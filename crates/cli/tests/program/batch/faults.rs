//! One bad thing costs one file, or stops everything in order.

use darkroot::ProfileStore;
use darkroot::recipe::{Layer, Layers};
use darkroot_batch::{Batch, CrewOptions, Event, PlanOptions, Search, Session, SettingsByFile, Stop, find};

use super::*;

#[test]
fn bad_files_are_named_and_the_rest_goes_on() {
    let desk = Desk::with_tree();
    desk.put("in/garbage.nef", "no raw file");
    desk.put("in/empty.dng", "");
    desk.put("in/short.nef", &small_nef()[..small_nef().len() / 2]);
    std::fs::create_dir_all(desk.path("in/folder.nef")).unwrap();
    let run = desk.batch(&["--json"]);
    assert_eq!((run.code, summary(&run)), (1, [4, 0, 3, 0]), "{}", run.err);
    for name in ["garbage.nef", "empty.dng", "short.nef"] {
        assert_eq!(run.err.matches(&format!("error: in/{name}: ")).count(), 1, "{name}: {}", run.err);
    }
    assert!(desk.left_over().is_empty(), "{:?}", desk.left_over());
    let status = desk.run(&["batch", "status", "out"]);
    assert_eq!((status.code, status.out.matches("failed: ").count()), (1, 3), "{}", status.out);
}

#[cfg(unix)]
#[test]
#[cfg_attr(not(rights_count), ignore = "this user may do everything")]
fn what_may_not_be_read_or_written_is_said() {
    use std::os::unix::fs::PermissionsExt;
    let desk = Desk::with_tree();
    let close = |name: &str, mode| {
        std::fs::set_permissions(desk.path(name), std::fs::Permissions::from_mode(mode)).unwrap();
    };
    close("in/a.dng", 0o000);
    std::fs::create_dir_all(desk.path("out/day 2")).unwrap();
    close("out/day 2", 0o555);
    let run = desk.batch(&["--json"]);
    close("out/day 2", 0o755);
    assert_eq!((run.code, summary(&run)), (1, [2, 0, 2, 0]), "{}", run.err);
    assert_eq!(run.err.matches("permission denied").count(), 2, "{}", run.err);
}

#[test]
fn a_file_that_takes_too_long_is_given_up() {
    let desk = Desk::new();
    let path = sample("still-life.nef");
    desk.put("in/slow.nef", std::fs::read(path).unwrap());
    // AVIF takes longest to write: many times as long as time-outs are looked for.
    let run = desk.batch(&["--json", "--format", "avif", "--timeout", "1ms"]);
    assert_eq!((run.code, summary(&run)), (1, [0, 0, 1, 0]), "{}", run.err);
    assert!(
        run.err.contains("slow.nef: took longer than 1ms") && run.err.contains("--timeout"),
        "{}",
        run.err
    );
    assert_eq!(summary(&desk.batch(&["--json", "--format", "avif"])), [1, 0, 0, 0]);
}

#[test]
fn a_file_that_is_too_large_for_the_memory_is_given_up() {
    let desk = Desk::with_tree();
    let run = desk.batch(&["--json", "--memory", "60M"]);
    assert_eq!((run.code, summary(&run)), (1, [0, 0, 4, 0]), "{}", run.err);
    assert_eq!(run.err.matches("give more with `--memory`").count(), 4, "{}", run.err);
    assert_eq!(summary(&desk.batch(&["--json", "--memory", "100M"])), [4, 0, 0, 0]);
}

/// Runs a batch with the program in place of `sh -c SCRIPT` as worker; the outcome of each file.
#[cfg(unix)]
fn with_worker(desk: &Desk, script: &str) -> Vec<(String, Result<(), String>)> {
    with_worker_of(desk, script, 2)
}

/// As [`with_worker`], with so many files at once.
#[cfg(unix)]
fn with_worker_of(desk: &Desk, script: &str, jobs: usize) -> Vec<(String, Result<(), String>)> {
    let program = env!("CARGO_BIN_EXE_darkroot");
    let options = PlanOptions::into(&desk.path("out"));
    let mut crew =
        CrewOptions::new("sh".into(), vec!["-c".into(), script.into(), "sh".into(), program.into()]);
    (crew.jobs, crew.threads) = (jobs, jobs);
    let search = Search { inputs: vec![desk.path("in").to_str().unwrap().into()], ..Search::default() };
    let mut settings = SettingsByFile::new(Layers::new(None, Layer::flags([]).unwrap(), true).unwrap());
    let mut run = Batch::open(&options, crew, ProfileStore::builtin()).unwrap();
    let sources = find(&search, &desk.path("out")).unwrap();
    let stop = Stop::default();
    let plan = run.plan(sources, &options, &mut settings, &Session::default(), &stop).unwrap();
    let mut outcomes = Vec::new();
    run.run(&plan, &stop, &mut |event| match event {
        Event::Done { item, .. } => outcomes.push((item.source.key.clone(), Ok(()))),
        Event::Failed { item, words, .. } => outcomes.push((item.source.key.clone(), Err(words.to_owned()))),
        _ => {}
    })
    .unwrap();
    outcomes.sort_by(|a, b| a.0.cmp(&b.0));
    outcomes
}

#[cfg(unix)]
#[test]
fn a_worker_that_crashes_costs_the_file_it_had() {
    let desk = Desk::with_tree();
    desk.put("in/hostile.nef", small_nef());
    // The worker's whole process group goes when it is handed the hostile file, as by an abort in a decoder.
    let script = "while read -r line; do case $line in *hostile*) kill -ABRT 0;; esac; echo \"$line\"; done | \"$1\" worker";
    let outcomes = with_worker(&desk, script);
    assert_eq!(outcomes.len(), 5, "{outcomes:?}");
    for (name, outcome) in outcomes {
        match outcome {
            Ok(()) => assert_ne!(name, "hostile.nef"),
            Err(error) => {
                assert_eq!(name, "hostile.nef", "{error}");
                assert!(error.contains("crashed"), "{error}");
            }
        }
    }
}

#[cfg(unix)]
#[test]
fn a_worker_that_is_ended_by_accident_costs_nothing() {
    let desk = Desk::with_tree();
    // The first worker that gets a file is killed, as when memory runs out; its file is innocent.
    let mark = desk.path("killed-once");
    let script = format!(
        "while read -r line; do if mkdir '{}' 2>/dev/null; then kill -KILL 0; fi; echo \"$line\"; done | \"$1\" worker",
        mark.display()
    );
    let outcomes = with_worker(&desk, &script);
    assert!(mark.is_dir());
    assert_eq!(outcomes.len(), 4);
    assert!(outcomes.iter().all(|(_, outcome)| outcome.is_ok()), "{outcomes:?}");
}

/// What a worker's pipe does to its answer that a file is developed: the picture is in its place by then.
#[cfg(unix)]
fn when_developed(act: &str) -> String {
    format!(
        r#""$1" worker | while read -r line; do
            case $line in *'"developed"'*) {act};; esac
            printf '%s\n' "$line"
        done"#
    )
}

#[cfg(unix)]
#[test]
fn a_worker_that_dies_between_its_picture_and_its_answer_costs_nothing() {
    let desk = Desk::with_tree();
    let mark = desk.path("killed-once");
    let script = when_developed(&format!("if mkdir '{}' 2>/dev/null; then kill -KILL 0; fi", mark.display()));
    let outcomes = with_worker(&desk, &script);
    assert!(mark.is_dir());
    assert_eq!(outcomes.len(), 4);
    assert!(outcomes.iter().all(|(_, outcome)| outcome.is_ok()), "{outcomes:?}");
    assert_eq!(summary(&desk.batch(&["--json"])), [0, 4, 0, 0]);
}

#[cfg(unix)]
#[test]
fn a_picture_whose_workers_died_is_never_disowned() {
    // Each worker dies at that point; or the first does and the second fails in an ordinary way.
    let failed = r#"printf '%s\n' '{"failed":{"kind":"file","error":"an ordinary fault"}}'; continue"#;
    let marks = tempfile::tempdir().unwrap();
    let mark = marks.path().join("mark");
    let first_only = format!("if mkdir '{}' 2>/dev/null; then kill -KILL 0; fi; {failed}", mark.display());
    for act in ["kill -KILL 0", &first_only] {
        let desk = Desk::new();
        desk.put("in/a.dng", small_dng());
        // A fault of a file that was written just now is tried again for a while.
        let file = std::fs::File::options().append(true).open(desk.path("in/a.dng")).unwrap();
        file.set_modified(std::time::SystemTime::now() - Duration::from_secs(3600)).unwrap();
        let outcomes = with_worker(&desk, &when_developed(act));
        assert!(matches!(&outcomes[..], [(_, Err(_))]), "{outcomes:?}");
        assert_eq!(desk.outputs(), ["a.jpg"]);
        let run = desk.batch(&["--json"]);
        assert_eq!((run.code, summary(&run)), (0, [1, 0, 0, 0]), "{}", run.err);
        assert_eq!(summary(&desk.batch(&["--json"])), [0, 1, 0, 0]);
    }
}

#[cfg(unix)]
#[test]
fn a_foreign_picture_that_comes_after_the_plan_is_neither_replaced_nor_claimed() {
    let desk = Desk::new();
    for name in ["a", "b", "c"] {
        desk.put(&format!("in/{name}.dng"), small_dng());
    }
    // When the first file is handed out, a picture by another hand appears at the place of the last, whose worker would
    // die before it could see that.
    let place = desk.path("out/c.jpg");
    let script = format!(
        r#"while read -r line; do
            echo foreign >'{}'
            case $line in *c.dng*) kill -KILL 0;; esac
            printf '%s\n' "$line"
        done | "$1" worker"#,
        place.display()
    );
    let outcomes = with_worker_of(&desk, &script, 1);
    let [(_, Ok(())), (_, Ok(())), (_, Err(error))] = &outcomes[..] else { panic!("{outcomes:?}") };
    assert!(error.contains("exists already"), "{error}");
    assert_eq!(desk.read("out/c.jpg"), b"foreign\n");
    let run = desk.batch(&["--json"]);
    assert_eq!((run.code, summary(&run)), (1, [0, 2, 1, 0]), "{}", run.err);
    assert_eq!(desk.read("out/c.jpg"), b"foreign\n");
}

#[cfg(target_os = "linux")]
#[test]
fn a_worker_has_little_memory_before_it_reads_the_head_of_a_file() {
    let desk = Desk::new();
    desk.put("in/a.dng", small_dng());
    // When it says what a file needs it has read the head, and was not yet told to go on.
    let script = format!(
        r#"cd '{}'
        sh -c 'echo $$ >pid; exec "$1" worker' sh "$1" | while read -r line; do
            case $line in *'"needs"'*) grep 'Max data size' "/proc/$(cat pid)/limits" >>limits;; esac
            printf '%s\n' "$line"
        done"#,
        desk.folder.path().display()
    );
    let outcomes = with_worker_of(&desk, &script, 1);
    assert!(matches!(&outcomes[..], [(_, Ok(()))]), "{outcomes:?}");
    let limits = String::from_utf8(desk.read("limits")).unwrap();
    let most = (512 << 20) + 4 * small_dng().len() as u64;
    for line in limits.lines() {
        let limit: u64 = line.split_whitespace().nth(3).unwrap().parse().unwrap_or(u64::MAX);
        assert!(limit <= most, "{line}");
    }
    assert!(!limits.is_empty());
}

#[cfg(unix)]
#[test]
fn a_worker_that_talks_nonsense_is_a_fault_of_one_file_after_the_other() {
    let desk = Desk::with_tree();
    let outcomes = with_worker(&desk, "read -r line; echo nonsense");
    assert_eq!(outcomes.len(), 4);
    assert!(outcomes.iter().all(|(_, outcome)| outcome.is_err()), "{outcomes:?}");
}

/// Starts a batch of many files with one worker and lets `act` do something when the first is done.
fn while_running(desk: &Desk, files: usize, act: impl FnOnce(&Desk)) -> Run {
    use std::io::{BufRead, BufReader, Read};
    for i in 0..files {
        desk.put(&format!("in/{i:03}.nef"), small_nef());
    }
    let arguments = ["batch", "in", "-o", "out", "--json", "--jobs", "1"];
    let mut command = desk.command(&arguments);
    let mut child =
        command.stdout(std::process::Stdio::piped()).stderr(std::process::Stdio::piped()).spawn().unwrap();
    let mut out = BufReader::new(child.stdout.take().unwrap());
    let mut text = String::new();
    while !text.contains("\"event\":\"done\"") {
        assert!(out.read_line(&mut text).unwrap() > 0, "nothing was done: {text}");
    }
    act(desk);
    out.read_to_string(&mut text).unwrap();
    let mut output = child.wait_with_output().unwrap();
    output.stdout = text.into_bytes();
    Run::of(&output, &arguments)
}

#[test]
fn inputs_that_go_away_or_are_cut_meanwhile_are_named() {
    let desk = Desk::new();
    let run = while_running(&desk, 60, |desk| {
        std::fs::remove_file(desk.path("in/059.nef")).unwrap();
        desk.put("in/058.nef", &small_nef()[..small_nef().len() / 2]);
    });
    assert_eq!((run.code, summary(&run)), (1, [58, 0, 2, 0]), "{}", run.err);
    assert!(run.err.contains("in/059.nef: cannot be read: there is no such file"), "{}", run.err);
    assert!(run.err.contains("error: in/058.nef: "), "{}", run.err);
}

#[test]
fn an_output_folder_that_vanishes_stops_the_run_in_order() {
    let desk = Desk::new();
    let run = while_running(&desk, 200, |desk| {
        std::fs::rename(desk.path("out"), desk.path("elsewhere")).unwrap();
    });
    assert_eq!(run.code, 1, "{}", run.err);
    assert_eq!(run.err.matches("the output folder is gone").count(), 1, "{}", run.err);
    let [done, _, failed, left] = summary(&run);
    assert!(left > 0 && failed <= 2 && done + failed + left == 200, "{done} {failed} {left}");
}

/// Runs a script as the owner of everything, with a place to mount disks.
#[cfg(target_os = "linux")]
fn as_owner(desk: &Desk, script: &str) -> Output {
    let mut command = Command::new("unshare");
    command.args(["-rm", "sh", "-c", script, "sh", env!("CARGO_BIN_EXE_darkroot")]);
    desk.prepare(&mut command);
    command.output().unwrap()
}

#[cfg(target_os = "linux")]
#[test]
#[cfg_attr(not(can_mount), ignore = "no disk can be mounted here")]
fn a_full_disk_stops_the_run_and_the_next_one_goes_on() {
    let desk = Desk::new();
    for i in 0..40 {
        desk.put(&format!("in/{i:02}.nef"), small_nef());
    }
    std::fs::create_dir_all(desk.path("out")).unwrap();
    // Pictures of about 18 kB as TIFF: some 8 find room.
    let script = "mount -t tmpfs -o size=200k tmpfs out || exit 9
        \"$1\" batch in -o out --format tiff --json >full.json 2>full.err; echo $? >full.code
        find out -type f >full.files
        mount -o remount,size=20m out
        \"$1\" batch in -o out --format tiff --json >more.json 2>more.err; echo $? >more.code
        find out -type f >more.files; cat out/.darkroot/journal.jsonl >journal";
    let output = as_owner(&desk, script);
    assert!(output.status.success(), "{output:?}");
    let text = |name: &str| String::from_utf8(desk.read(name)).unwrap();
    let run = |name: &str| Run {
        code: text(&format!("{name}.code")).trim().parse().unwrap(),
        out: text(&format!("{name}.json")),
        err: text(&format!("{name}.err")),
    };
    let full = run("full");
    let [done, _, failed, left] = summary(&full);
    assert_eq!((full.code, failed), (1, 0), "{}", full.err);
    assert!(done > 0 && left > 0 && done + left == 40, "{done} {left}: {}", full.err);
    assert!(full.err.contains("full") || full.err.contains("No space"), "{}", full.err);
    assert!(!text("full.files").contains(".part"), "{}", text("full.files"));
    let more = run("more");
    assert_eq!((more.code, more.err.contains("error")), (0, false), "{}", more.err);
    let [more_done, unchanged, ..] = summary(&more);
    assert_eq!(more_done + unchanged, 40);
    assert!(unchanged >= done);
    // Forty pictures, the journal, and who is at work.
    assert_eq!(text("more.files").lines().count(), 42, "{}", text("more.files"));
}
