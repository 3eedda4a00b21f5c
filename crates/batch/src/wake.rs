//! When to look again: at once when the system says that something changed, and every so often in any case.
//!
//! Notifications only save time. They get lost, and shares do not send any for what other machines do; what counts
//! is what is found when one looks.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use notify::{Config, ErrorKind, Event, RecommendedWatcher, RecursiveMode, Watcher};

use super::stop::Stop;
use darkroot::shown;

/// How often to look where notifications come too.
const RARELY: Duration = Duration::from_secs(30);
/// How often to look where they cannot come.
const OFTEN: Duration = Duration::from_secs(5);
/// How soon to look again after a change, at the earliest: changes come in swarms.
const PAUSE: Duration = Duration::from_millis(100);
/// Looking takes a fifth of the time at most.
const SHARE: u32 = 4;
/// How often wishes to stop are looked at.
const TICK: Duration = Duration::from_millis(50);

/// What wakes a watch.
pub(crate) struct Wake {
    watcher: Option<RecommendedWatcher>,
    /// How often to look if that is all there is.
    poll: Option<Duration>,
    /// Folders that are watched, and which ones they were: a card that comes back is another one.
    watched: HashMap<PathBuf, Option<FolderIdentity>>,
    /// Kept so that the receiver has a sender without a watcher, too.
    sender: SyncSender<()>,
    receiver: Receiver<()>,
    /// Why notifications fail.
    trouble: Arc<Mutex<Option<String>>>,
}

impl Wake {
    /// By looking every so often, or by notifications. Changes in `out` wake nobody.
    pub(crate) fn new(poll: Option<Duration>, out: &Path, follow_links: bool) -> Self {
        let (sender, receiver) = sync_channel(1);
        let trouble = Arc::default();
        let mut wake = Self { watcher: None, poll, watched: HashMap::new(), sender, receiver, trouble };
        if poll.is_none() {
            let config = Config::default().with_follow_symlinks(follow_links);
            match RecommendedWatcher::new(wake.handler(real(out)), config) {
                Ok(watcher) => wake.watcher = Some(watcher),
                Err(error) => wake.fail(&error),
            }
        }
        wake
    }

    /// What is called when something changed, in a thread of its own.
    fn handler(&self, out: PathBuf) -> impl FnMut(notify::Result<Event>) + Send + 'static {
        let (sender, trouble) = (self.sender.clone(), Arc::clone(&self.trouble));
        move |event| {
            match event {
                Ok(event) if !concerns(&event, &out) => return,
                Ok(_) => {}
                Err(error) => note(&trouble, &error),
            }
            // If it is full, the watch will wake up anyway.
            let _ = sender.try_send(());
        }
    }

    fn fail(&self, error: &notify::Error) {
        note(&self.trouble, error);
    }

    /// How often it looks, if that is all it does.
    pub(crate) fn polling(&self) -> Option<Duration> {
        self.poll
    }

    /// Watches these folders, which are there. If that is not possible, looks every so often from now on and says
    /// why, once.
    pub(crate) fn follow(&mut self, folders: &[PathBuf]) -> Option<String> {
        if self.poll.is_some() {
            return None;
        }
        self.watched.retain(|folder, _| folders.contains(folder));
        for folder in folders {
            let now = identity(folder);
            if self.watched.get(folder).is_some_and(|then| *then == now) {
                continue;
            }
            let path = real(folder);
            if let Some(kind) = share(&path) {
                let words = format!("{}: is on a share ({kind})", shown(folder));
                *self.trouble.lock().unwrap_or_else(PoisonError::into_inner) = Some(words);
                break;
            }
            let Some(watcher) = &mut self.watcher else { break };
            // It is not watched any more if it is another one.
            let _ = watcher.unwatch(&path);
            match watcher.watch(&path, RecursiveMode::Recursive) {
                Ok(()) => {
                    self.watched.insert(folder.clone(), now);
                }
                // It vanished just now, or a folder in it did.
                Err(error) if is_missing(&error) => {}
                Err(error) => {
                    self.fail(&error);
                    break;
                }
            }
        }
        let words = self.trouble.lock().unwrap_or_else(PoisonError::into_inner).take()?;
        self.watcher = None;
        self.watched.clear();
        self.poll = Some(OFTEN);
        Some(words)
    }

    /// Waits until it is time to look: something changed, a file settles at `next`, or it was long enough. `cost` is
    /// how long the last look took.
    pub(crate) fn wait(&self, next: Option<Instant>, cost: Duration, stop: &Stop) {
        let start = Instant::now();
        let earliest = start + PAUSE.max(cost * SHARE);
        let rest = start + self.poll.unwrap_or(RARELY);
        let mut until = next.map_or(rest, |next| next.min(rest)).max(earliest);
        while !stop.asked() {
            let left = until.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return;
            }
            if self.receiver.recv_timeout(left.min(TICK)).is_ok() {
                until = until.min(earliest.max(Instant::now()));
            }
        }
    }
}

fn note(trouble: &Mutex<Option<String>>, error: &notify::Error) {
    *trouble.lock().unwrap_or_else(PoisonError::into_inner) = Some(match &error.kind {
        ErrorKind::MaxFilesWatch => {
            "the system watches no more folders for this user (fs.inotify.max_user_watches)".to_owned()
        }
        _ => format!("the system does not tell of changes ({error})"),
    });
}

fn is_missing(error: &notify::Error) -> bool {
    match &error.kind {
        ErrorKind::PathNotFound => true,
        ErrorKind::Io(io) => io.kind() == std::io::ErrorKind::NotFound,
        _ => false,
    }
}

/// Whether something happened that can make a file ready. Reading is nothing, and outputs are ours.
fn concerns(event: &Event, out: &Path) -> bool {
    let ours = |path: &PathBuf| path.starts_with(out);
    !event.kind.is_access() && (event.paths.is_empty() || !event.paths.iter().all(ours))
}

fn real(path: &Path) -> PathBuf {
    std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned())
}

/// What tells a folder from another one at the same place.
type FolderIdentity = (u64, u64, Option<std::time::SystemTime>);

fn identity(folder: &Path) -> Option<FolderIdentity> {
    let data = std::fs::metadata(folder).ok()?;
    #[cfg(unix)]
    let place = {
        use std::os::unix::fs::MetadataExt;
        (data.dev(), data.ino())
    };
    #[cfg(not(unix))]
    let place = (0, 0);
    Some((place.0, place.1, data.created().ok()))
}

/// Kind of the network disk that a folder is on, where the system tells and it is one.
fn share(folder: &Path) -> Option<String> {
    let table = std::fs::read_to_string("/proc/self/mountinfo").ok()?;
    kind_of_mount(&table, folder).filter(|kind| is_share(kind))
}

/// Type of the mounted disk that a path is on, from the system's table of mounts.
fn kind_of_mount(table: &str, path: &Path) -> Option<String> {
    let mount = |line: &str| {
        let (head, tail) = line.split_once(" - ")?;
        let point = head.split(' ').nth(4)?.replace("\\040", " ");
        path.starts_with(&point).then(|| (point.len(), tail.split(' ').next().unwrap_or_default().to_owned()))
    };
    // Of several at one place, the last covers the others.
    table.lines().filter_map(mount).max_by_key(|(length, _)| *length).map(|(_, kind)| kind)
}

/// Disks that other machines write to as well, unseen by this one.
fn is_share(kind: &str) -> bool {
    const SHARES: [&str; 16] = [
        "nfs", "nfs4", "cifs", "smb3", "smbfs", "9p", "afs", "ceph", "lustre", "gpfs", "beegfs", "davfs",
        "virtiofs", "vboxsf", "prl_fs", "drvfs",
    ];
    SHARES.contains(&kind) || kind.starts_with("fuse.")
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: &str = "22 1 8:1 / / rw,relatime shared:1 - ext4 /dev/sda1 rw
30 22 0:40 / /mnt/my\\040share rw - nfs4 server:/export rw
31 30 8:2 / /mnt/my\\040share/local rw shared:2 - xfs /dev/sdb rw
32 22 0:41 / /mnt/my\\040share/local rw - fuse.sshfs host: rw";

    #[test]
    fn shares_are_known_by_the_mount_that_a_folder_lies_on() {
        let kind = |path: &str| kind_of_mount(TABLE, path.as_ref()).unwrap();
        assert_eq!(kind("/home/me"), "ext4");
        assert_eq!(kind("/mnt/my share/x"), "nfs4");
        assert_eq!(kind("/mnt/my shares"), "ext4");
        assert_eq!(kind("/mnt/my share/local/x"), "fuse.sshfs");
        assert!(is_share("nfs4") && is_share("fuse.sshfs") && !is_share("ext4") && !is_share("tmpfs"));
        assert_eq!(kind_of_mount("", "/a".as_ref()), None);
    }

    #[test]
    fn a_change_wakes_at_once_and_an_output_does_not() {
        let folder = tempfile::tempdir().unwrap();
        let (input, out) = (folder.path().join("in"), folder.path().join("in/out"));
        std::fs::create_dir_all(&out).unwrap();
        let mut wake = Wake::new(None, &out, false);
        if wake.follow(std::slice::from_ref(&input)).is_some() {
            eprintln!("skipped: there are no notifications here");
            return;
        }
        std::fs::write(out.join("a.jpg"), b"x").unwrap();
        assert!(wake.receiver.recv_timeout(Duration::from_millis(300)).is_err());
        std::fs::write(input.join("a.nef"), b"x").unwrap();
        let start = Instant::now();
        wake.wait(None, Duration::ZERO, &Stop::default());
        assert!(start.elapsed() < RARELY);
    }

    #[test]
    fn without_notifications_it_waits_no_longer_than_asked() {
        let wake = Wake::new(Some(Duration::from_millis(20)), Path::new("out"), false);
        let start = Instant::now();
        wake.wait(None, Duration::ZERO, &Stop::default());
        assert!(start.elapsed() >= PAUSE && start.elapsed() < OFTEN);
    }

    #[test]
    fn a_wish_to_stop_ends_the_wait() {
        let wake = Wake::new(Some(Duration::from_secs(3600)), Path::new("out"), false);
        let stop = Stop::default();
        stop.ask();
        wake.wait(None, Duration::ZERO, &stop);
    }
}
