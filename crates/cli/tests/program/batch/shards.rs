//! Several machines share one folder.

use super::*;

fn desk() -> Desk {
    let desk = Desk::new();
    for i in 0..24 {
        desk.put(&format!("in/{i:02}.nef"), small_nef());
    }
    desk
}

#[test]
fn shards_share_the_work_and_status_adds_it_up() {
    let desk = desk();
    let mut together = 0;
    for shard in ["1/3", "2/3", "3/3"] {
        let run = desk.batch(&["--shard", shard, "--json"]);
        assert_eq!(run.code, 0, "{}", run.err);
        let [done, unchanged, failed, left] = summary(&run);
        assert!(done > 0 && (unchanged, failed, left) == (0, 0, 0), "{shard}: {done}");
        together += done;
    }
    assert_eq!((together, desk.outputs().len()), (24, 24));
    assert!(desk.left_over().is_empty(), "{:?}", desk.left_over());
    let status = desk.run(&["batch", "status", "out"]);
    assert!(status.out.contains("together: 24 done, 0 failed"), "{}", status.out);
    assert!(status.out.contains("journal-2-of-3.jsonl"), "{}", status.out);
    // What shards did is done, for all: another split, or one machine, finds nothing left.
    assert_eq!(summary(&desk.batch(&["--json", "--shard", "1/2"]))[0], 0);
    assert_eq!(summary(&desk.batch(&["--json"])), [0, 24, 0, 0]);
}

#[test]
fn schedulers_tell_the_shard() {
    let desk = desk();
    let arguments = ["batch", "in", "-o", "out", "--shard", "auto", "--json"];
    let slurm = |id: &str| {
        let mut command = desk.command(&arguments);
        command
            .env("SLURM_ARRAY_TASK_ID", id)
            .env("SLURM_ARRAY_TASK_COUNT", "2")
            .env("SLURM_ARRAY_TASK_MIN", "0");
        Run::of(&command.output().unwrap(), &arguments)
    };
    let first = summary(&slurm("0"))[0];
    let mut command = desk.command(&arguments);
    command.env("JOB_COMPLETION_INDEX", "1").env("DARKROOT_SHARDS", "2");
    let second = summary(&Run::of(&command.output().unwrap(), &arguments))[0];
    assert_eq!(first + second, 24);
    assert_eq!(summary(&slurm("1"))[0], 0);
}

#[cfg(unix)]
#[test]
#[cfg_attr(not(has_parallel), ignore = "GNU parallel is not installed")]
fn gnu_parallel_runs_the_shards_of_the_guide() {
    let desk = desk();
    // The guide's command, with this build of the program.
    let guide =
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/batch.md")).unwrap();
    let line = guide.lines().find(|l| l.starts_with("parallel ")).unwrap();
    let line = line
        .replace("darkroot batch", &format!("{} batch", env!("CARGO_BIN_EXE_darkroot")))
        .replace("/photos/shoot", "in")
        .replace("/photos/pictures", "out");
    let mut command = Command::new("sh");
    command.args(["-c", &line]);
    desk.prepare(&mut command);
    let run = Run::of(&command.output().unwrap(), &["parallel"]);
    assert_eq!(run.code, 0, "{}", run.err);
    assert_eq!(desk.outputs().len(), 24);
    assert!(desk.run(&["batch", "status", "out"]).out.contains("together: 24 done"));
}

#[test]
fn a_whole_run_beside_a_shard_waits_and_fails_nothing() {
    use std::process::Stdio;
    let desk = desk();
    let mut shard = desk.command(&["batch", "in", "-o", "out", "--shard", "1/2", "--jobs", "1", "--json"]);
    let mut shard = shard.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    wait_for("the shard", || desk.path("out/.darkroot/journal-1-of-2.jsonl").exists().then_some(()));
    let whole = desk.batch(&["--json"]);
    let third = desk.batch(&["--json", "--shard", "1/3"]);
    let other = desk.batch(&["--json", "--shard", "2/2"]);
    let ended = shard.try_wait().unwrap().is_some();
    let shard = Run::of(&shard.wait_with_output().unwrap(), &["shard"]);
    assert_eq!((shard.code, summary(&shard)[2]), (0, 0), "{}", shard.err);
    assert_eq!((other.code, summary(&other)[2]), (0, 0), "{}", other.err);
    for beside in [whole, third] {
        if ended && beside.code == 0 {
            eprintln!("skipped: the shard was at its end");
            continue;
        }
        assert!(beside.code == 2 && beside.err.contains("one of 2 parts"), "{}", beside.err);
        assert!(beside.err.contains("--shard I/N") && beside.out.is_empty(), "{}", beside.err);
    }
    let run = desk.batch(&["--json"]);
    assert_eq!((run.code, summary(&run)), (0, [0, 24, 0, 0]), "{}", run.err);
}
