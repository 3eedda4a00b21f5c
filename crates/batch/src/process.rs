//! One worker process, as its parent sees it.

use std::ffi::OsString;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, ExitStatus, Stdio};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use super::task::{Answer, Order};

/// The longest line that is taken from a worker, in bytes: a picture for the contact sheet and hundreds of notes. A worker
/// that was led astray might never end one.
const LONGEST_ANSWER: u64 = 4 << 20;
/// The longest line that is taken of what it says for people, in bytes.
const LONGEST_WORDS: u64 = 64 << 10;

/// A process at the other end of two pipes.
pub(crate) struct Process {
    child: Child,
    stdin: ChildStdin,
    last_line: Arc<Mutex<String>>,
}

/// How a process ended.
pub(crate) struct Exit {
    /// The signal that ended it, where there was one.
    pub(crate) signal: Option<i32>,
    /// The last line that it wrote for people.
    pub(crate) last_line: String,
}

impl Process {
    /// Starts a worker. `on_answer` gets each of its answers, and `None` once when there will be no more; it says whether it
    /// wants more of them.
    ///
    /// # Errors
    /// The system has no such program, or no room for it.
    pub(crate) fn start(
        program: &Path,
        arguments: &[OsString],
        on_answer: impl Fn(Option<Answer>) -> bool + Send + 'static,
    ) -> std::io::Result<Self> {
        let mut command = Command::new(program);
        command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        #[cfg(unix)]
        {
            // An interrupt at the keyboard is for the parent, which lets files be finished.
            use std::os::unix::process::CommandExt;
            command.process_group(0);
        }
        let mut child = command.spawn()?;
        let missing = || std::io::Error::from(std::io::ErrorKind::BrokenPipe);
        let stdin = child.stdin.take().ok_or_else(missing)?;
        let stdout = child.stdout.take().ok_or_else(missing)?;
        let stderr = child.stderr.take().ok_or_else(missing)?;
        std::thread::spawn(move || {
            let mut lines = BufReader::new(stdout);
            loop {
                let line = bounded_line(&mut lines, LONGEST_ANSWER);
                let answer = line.and_then(|line| serde_json::from_slice(&line).ok());
                let gone = answer.is_none();
                if !on_answer(answer) || gone {
                    return;
                }
            }
        });
        let last_line = Arc::new(Mutex::new(String::new()));
        let shared = Arc::clone(&last_line);
        std::thread::spawn(move || {
            let mut lines = BufReader::new(stderr);
            while let Some(line) = bounded_line(&mut lines, LONGEST_WORDS) {
                let line = String::from_utf8_lossy(&line).into_owned();
                *shared.lock().unwrap_or_else(PoisonError::into_inner) = line;
            }
        });
        Ok(Self { child, stdin, last_line })
    }

    /// Sends an order. A worker that cannot be reached is dead, and says so by the end of its answers.
    pub(crate) fn send(&mut self, order: &Order) {
        if let Ok(mut line) = serde_json::to_vec(order) {
            line.push(b'\n');
            let _ = self.stdin.write_all(&line).and_then(|()| self.stdin.flush());
        }
    }

    /// Waits so long for it to end by itself, then ends it; says how it ended.
    pub(crate) fn end(mut self, grace: Duration) -> Option<Exit> {
        let start = Instant::now();
        let status = loop {
            if let Ok(Some(status)) = self.child.try_wait() {
                break status;
            }
            if start.elapsed() >= grace {
                // That fails if it has just ended.
                let _ = self.child.kill();
                break self.child.wait().ok()?;
            }
            std::thread::sleep(Duration::from_millis(5));
        };
        let last_line = self.last_line.lock().unwrap_or_else(PoisonError::into_inner).clone();
        Some(Exit { signal: signal(&status), last_line })
    }
}

/// The next line without its end; `None` where there is none, or one longer than that.
fn bounded_line(from: &mut impl BufRead, most: u64) -> Option<Vec<u8>> {
    let mut line = Vec::new();
    from.take(most).read_until(b'\n', &mut line).ok()?;
    line.pop_if(|end| *end == b'\n').map(|_| line)
}

#[cfg(unix)]
fn signal(status: &ExitStatus) -> Option<i32> {
    std::os::unix::process::ExitStatusExt::signal(status)
}

#[cfg(not(unix))]
fn signal(_: &ExitStatus) -> Option<i32> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_without_an_end_is_none() {
        let mut lines = &b"one\ntwo\nthree"[..];
        assert_eq!(bounded_line(&mut lines, 4).unwrap(), b"one");
        assert_eq!(bounded_line(&mut lines, 100).unwrap(), b"two");
        assert_eq!(bounded_line(&mut lines, 100), None);
        assert_eq!(bounded_line(&mut BufReader::new(std::io::repeat(b'x')), 1 << 16), None);
    }
}
