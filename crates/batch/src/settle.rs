//! Which files have stopped growing, and which of them were seen to already.

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use super::find::Source;

/// What is known of the files that are there. It forgets those that are not, so it does not grow with time.
#[derive(Debug)]
pub(crate) struct Settle {
    /// How long a file must stay as it is.
    wait: Duration,
    files: HashMap<PathBuf, Seen>,
}

/// A file as it was last seen.
#[derive(Debug)]
struct Seen {
    size: u64,
    modified: i64,
    /// Since when it has been so.
    since: Instant,
    state: State,
}

#[derive(Debug)]
enum State {
    /// Not developed yet.
    New,
    /// Developed or failed; nothing more until it changes.
    Taken,
    /// It cannot be developed for this reason, which may go away without a change of the file.
    Held { words: String, again: Instant },
}

impl Settle {
    pub(crate) fn new(wait: Duration) -> Self {
        Self { wait, files: HashMap::new() }
    }

    /// Takes note of what is there now, and returns what can be developed. `away` are input folders that are not
    /// there: what was taken from them is remembered for when they come back.
    pub(crate) fn look(&mut self, files: &[Source], away: &[PathBuf], now: Instant) -> Vec<Source> {
        let there: HashSet<&Path> = files.iter().map(|f| f.path.as_path()).collect();
        let is_away = |path: &Path| away.iter().any(|folder| path.starts_with(folder));
        self.files.retain(|path, seen| {
            there.contains(path.as_path()) || matches!(seen.state, State::Taken) && is_away(path)
        });
        for file in files {
            match self.files.get(&file.path) {
                Some(seen) if (seen.size, seen.modified) == (file.size, file.modified) => {}
                _ => {
                    let Source { size, modified, .. } = *file;
                    self.files
                        .insert(file.path.clone(), Seen { size, modified, since: now, state: State::New });
                }
            }
        }
        files.iter().filter(|f| self.due(&f.path).is_some_and(|due| due <= now)).cloned().collect()
    }

    /// When a file can be developed if it stays as it is; never, if it was.
    fn due(&self, path: &Path) -> Option<Instant> {
        let seen = self.files.get(path)?;
        match &seen.state {
            State::New => Some(seen.since + self.wait),
            State::Held { again, .. } => Some(*again),
            State::Taken => None,
        }
    }

    /// When the next file can be developed if all stay as they are.
    pub(crate) fn next(&self) -> Option<Instant> {
        self.files.keys().filter_map(|path| self.due(path)).min()
    }

    /// Whether a file has stopped growing.
    pub(crate) fn is_settled(&self, path: &Path, now: Instant) -> bool {
        self.files.get(path).is_some_and(|seen| seen.since + self.wait <= now)
    }

    /// The file was developed, or failed, as it was.
    pub(crate) fn take(&mut self, path: &Path) {
        if let Some(seen) = self.files.get_mut(path) {
            seen.state = State::Taken;
        }
    }

    /// The file has to wait for something else than itself.
    pub(crate) fn hold(&mut self, path: &Path, words: String, again: Instant) {
        if let Some(seen) = self.files.get_mut(path) {
            seen.state = State::Held { words, again };
        }
    }

    /// Why files are held.
    pub(crate) fn reasons(&self) -> HashSet<String> {
        let words = |seen: &Seen| match &seen.state {
            State::Held { words, .. } => Some(words.clone()),
            _ => None,
        };
        self.files.values().filter_map(words).collect()
    }

    /// How many files are held.
    pub(crate) fn held(&self) -> usize {
        self.files.values().filter(|s| matches!(s.state, State::Held { .. })).count()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WAIT: Duration = Duration::from_secs(2);

    fn file(name: &str, size: u64, modified: i64) -> Source {
        Source { path: name.into(), key: name.into(), size, modified }
    }

    fn paths(ready: &[Source]) -> Vec<&str> {
        ready.iter().map(|s| s.key.as_str()).collect()
    }

    /// A settler and a clock that stands where one wants it to.
    fn watch() -> (Settle, impl Fn(u64) -> Instant) {
        let start = Instant::now();
        (Settle::new(WAIT), move |milliseconds| start + Duration::from_millis(milliseconds))
    }

    #[test]
    fn a_file_is_ready_when_it_has_been_the_same_for_the_whole_time() {
        let (mut settle, at) = watch();
        let files = [file("a", 1, 1)];
        assert!(settle.look(&files, &[], at(0)).is_empty());
        assert_eq!(settle.next(), Some(at(2000)));
        assert!(settle.look(&files, &[], at(1999)).is_empty() && !settle.is_settled("a".as_ref(), at(1999)));
        assert_eq!(paths(&settle.look(&files, &[], at(2000))), ["a"]);
        assert!(settle.is_settled("a".as_ref(), at(2000)));
    }

    #[test]
    fn a_file_that_grows_or_is_rewritten_at_its_size_is_not_ready() {
        let (mut settle, at) = watch();
        for step in 0..100 {
            // Every second another size, and then, at the same size, another time of change.
            let now = file("a", step.min(50), step.max(50) as i64);
            assert!(settle.look(&[now], &[], at(1000 * step)).is_empty(), "{step}");
        }
        let last = [file("a", 50, 99)];
        assert!(settle.look(&last, &[], at(99_000 + 1999)).is_empty());
        assert_eq!(paths(&settle.look(&last, &[], at(99_000 + 2000))), ["a"]);
    }

    #[test]
    fn one_that_still_grows_does_not_hold_up_the_others() {
        let (mut settle, at) = watch();
        settle.look(&[file("a", 1, 1), file("b", 1, 1)], &[], at(0));
        assert_eq!(paths(&settle.look(&[file("a", 1, 1), file("b", 2, 2)], &[], at(2000))), ["a"]);
        assert_eq!(settle.next(), Some(at(2000)));
        settle.take("a".as_ref());
        assert_eq!(settle.next(), Some(at(4000)));
    }

    #[test]
    fn what_was_taken_comes_again_only_when_it_changes() {
        let (mut settle, at) = watch();
        settle.look(&[file("a", 1, 1)], &[], at(0));
        settle.take("a".as_ref());
        assert!(settle.look(&[file("a", 1, 1)], &[], at(1_000_000)).is_empty());
        assert_eq!(settle.next(), None);
        assert!(settle.look(&[file("a", 1, 2)], &[], at(1_000_000)).is_empty());
        assert_eq!(paths(&settle.look(&[file("a", 1, 2)], &[], at(1_002_000))), ["a"]);
    }

    #[test]
    fn what_is_held_comes_again_at_its_time_or_when_it_has_changed_and_settled() {
        let (mut settle, at) = watch();
        settle.look(&[file("a", 1, 1), file("b", 1, 1)], &[], at(0));
        settle.hold("a".as_ref(), "why".into(), at(10_000));
        settle.hold("b".as_ref(), "why".into(), at(10_000));
        assert_eq!((settle.held(), settle.reasons()), (2, HashSet::from(["why".to_owned()])));
        assert!(settle.look(&[file("a", 1, 1), file("b", 2, 2)], &[], at(3000)).is_empty());
        assert_eq!(paths(&settle.look(&[file("a", 1, 1), file("b", 2, 2)], &[], at(5000))), ["b"]);
        assert_eq!(paths(&settle.look(&[file("a", 1, 1)], &[], at(10_000))), ["a"]);
    }

    #[test]
    fn files_that_are_gone_are_forgotten_unless_their_whole_folder_is_away() {
        let (mut settle, at) = watch();
        let files = [file("card/a", 1, 1), file("card/new", 1, 1), file("disk/b", 1, 1)];
        settle.look(&files, &[], at(0));
        settle.take("card/a".as_ref());
        settle.take("disk/b".as_ref());
        settle.look(&[], &["card".into()], at(1));
        assert_eq!((settle.files.len(), settle.next()), (1, None));
        settle.look(&files, &[], at(2));
        assert_eq!(paths(&settle.look(&files, &[], at(2002))), ["card/new", "disk/b"]);
        settle.look(&[], &[], at(2003));
        assert!(settle.files.is_empty());
    }
}
