//! Hints for batches and watched folders.

use std::error::Error;

use darkroot_batch::{
    BatchError, Collision, Conflict, Failure, JournalError, PlanFault, ShardError, SheetError, SourceFault,
    StopReason, WatchError,
};

/// What to do about an error of a batch.
pub(super) fn hint(error: &(dyn Error + 'static)) -> Option<String> {
    if let Some(failure) = error.downcast_ref() {
        return of_failure(failure);
    }
    if let Some(conflict) = error.downcast_ref() {
        return of_conflict(conflict);
    }
    if let Some(plan) = error.downcast_ref() {
        return of_plan(plan);
    }
    if let Some(batch) = error.downcast_ref() {
        return of_batch(batch);
    }
    if let Some(watch) = error.downcast_ref() {
        return of_watch(watch);
    }
    if let Some(JournalError::Locked { .. }) = error.downcast_ref() {
        return say("wait for it, or share the work with `--shard I/N`");
    }
    if let Some(JournalError::OtherSplit { .. }) = error.downcast_ref() {
        return say("wait for it, or give both runs a `--shard I/N` with the same N");
    }
    match error.downcast_ref() {
        Some(StopReason::Journal(inner)) => return hint(inner),
        Some(StopReason::Failure(inner)) => return of_failure(inner),
        _ => {}
    }
    if let Some(SourceFault::File(inner)) = error.downcast_ref() {
        return super::of(inner);
    }
    if let Some(SheetError::Write(inner)) = error.downcast_ref() {
        return super::of(inner);
    }
    if error.is::<Collision>() {
        return say(COLLISION);
    }
    if let Some(ShardError::NoScheduler) = error.downcast_ref() {
        return say("`--shard auto` is for array jobs");
    }
    None
}

const COLLISION: &str =
    "add `--on-collision suffix` (or skip, or prefer:nef,dng), or name them apart with `--name`";

fn say(hint: &str) -> Option<String> {
    Some(hint.to_owned())
}

fn of_failure(failure: &Failure) -> Option<String> {
    match failure {
        Failure::NeverFits { .. } => say("give more with `--memory`"),
        Failure::TookTooLong { .. } => say("give it more time with `--timeout`"),
        Failure::TooMuchMemory { .. } => say("if it is not, give more with `--memory`"),
        Failure::Ended { .. } => say("give less with `--memory` or `--jobs`, and run again"),
        Failure::Crashed { .. } => say("`darkroot inspect` tells more"),
        Failure::Conflict(conflict) => of_conflict(conflict),
        _ => None,
    }
}

fn of_conflict(conflict: &Conflict) -> Option<String> {
    match conflict {
        Conflict::NotOurs { .. } => say("add `--overwrite` to replace it, or choose another `-o`"),
        Conflict::Changed { .. } => say("add `--overwrite` to replace it, or move it away"),
        _ => None,
    }
}

fn of_plan(error: &PlanFault) -> Option<String> {
    match error {
        PlanFault::Collisions(_) => say(COLLISION),
        PlanFault::OverInput { .. } => say("choose another `-o`"),
        PlanFault::Naming(inner) => super::of(inner),
        PlanFault::Recipe(inner) => super::of(inner),
        PlanFault::Settings { source, .. } => super::of(source),
        _ => None,
    }
}

fn of_batch(error: &BatchError) -> Option<String> {
    match error {
        BatchError::Journal(inner) => hint(inner),
        BatchError::Plan(inner) => of_plan(inner),
        BatchError::Out { .. } => say("choose another `-o`"),
        BatchError::NoChart { .. } => say("name another file with `--chart-shot`, or leave it out"),
        BatchError::NoProfile { .. } => say("take the chart again, or leave out `--chart-shot`"),
        _ => None,
    }
}

fn of_watch(error: &WatchError) -> Option<String> {
    match error {
        WatchError::Batch(inner) => of_batch(inner),
        WatchError::Recipe(inner) => super::of(inner),
        WatchError::NoFolder { .. } => {
            say("name the folder that it lies in, and choose files with `--include`")
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;
    use std::time::Duration;

    use super::*;
    use crate::hint::words;

    #[test]
    fn every_failure_says_which_option_helps() {
        let path = || PathBuf::from("a.nef");
        let limit = Duration::from_secs(600);
        let cases: [(Failure, &str); 5] = [
            (Failure::NeverFits { path: path(), needed: 2_000_000_000, allowed: 1 << 20 }, "--memory"),
            (Failure::TookTooLong { path: path(), limit }, "--timeout"),
            (Failure::TooMuchMemory { path: path() }, "--memory"),
            (Failure::Ended { path: path() }, "--jobs"),
            (Failure::Crashed { path: path() }, "darkroot inspect"),
        ];
        for (failure, option) in cases {
            let words = words(&failure);
            assert!(words.starts_with("a.nef: ") && words.contains(option), "{words}");
            assert!(!failure.to_string().contains("--"), "{failure}");
        }
        let conflict = Failure::from(Conflict::NotOurs { path: path() });
        assert!(words(&conflict).ends_with("; add `--overwrite` to replace it, or choose another `-o`"));
    }

    #[test]
    fn errors_in_errors_keep_their_hint() {
        let locked = || JournalError::Locked { path: PathBuf::from("out") };
        let watch = WatchError::Batch(BatchError::Journal(locked()));
        assert!(words(&watch).contains("--shard I/N"), "{}", words(&watch));
        let collision = Collision { output: "a.jpg".into(), inputs: vec!["a.nef".into(), "a.dng".into()] };
        let plan = BatchError::Plan(PlanFault::Collisions(vec![collision]));
        let text = words(&plan);
        assert!(text.contains("a.jpg: a.nef, a.dng\n") && text.contains("--on-collision suffix"), "{text}");
    }
}
