//! Decoders in processes of their own, which reach nothing: a file that takes one over has got no further than its own picture.

use std::ffi::OsString;
use std::io::{self, Read};
use std::path::PathBuf;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use darkroot::Limits;
use darkroot_photo::Counts;
use darkroot_raw::elsewhere::{Answer, Place, Question};
use darkroot_raw::{Error, Preview};

use crate::decoder::{Order, Reply, Told, read_body, read_head, read_length, send};
use crate::state::locked;

/// Processes that wait for the next question about heads and embedded pictures, at most: a browser asks for six at once.
const IDLE: usize = 6;
/// Questions that one of them answers.
const QUESTIONS: u32 = 200;
/// Time for one answer.
const LONGEST: Duration = Duration::from_secs(120);

/// Starts processes that call [`crate::serve_decoder`] and asks them.
///
/// Samples are decoded by a process for each file. Heads and embedded pictures, of which a contact sheet asks for hundreds, share
/// processes: what one file does to them can falsify those of others, and reaches nothing else.
pub struct Apart {
    program: PathBuf,
    arguments: Vec<OsString>,
    idle: Mutex<Vec<Decoder>>,
}

impl Apart {
    /// With this program, called with these arguments.
    pub fn new(program: PathBuf, arguments: Vec<OsString>) -> Self {
        Self { program, arguments, idle: Mutex::default() }
    }

    fn start(&self) -> io::Result<Decoder> {
        let mut command = Command::new(&self.program);
        command.args(&self.arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null());
        #[cfg(unix)]
        {
            // An interrupt at the keyboard is for the window, whose end is theirs.
            use std::os::unix::process::CommandExt;
            command.process_group(0);
        }
        let mut child = command.spawn()?;
        let missing = || io::Error::from(io::ErrorKind::BrokenPipe);
        let orders = child.stdin.take().ok_or_else(missing)?;
        let replies = child.stdout.take().ok_or_else(missing)?;
        Ok(Decoder { child: Arc::new(Mutex::new(child)), orders, replies, left: QUESTIONS })
    }
}

impl Place for Apart {
    fn ask(&self, question: Question, bytes: &[u8], limits: &Limits) -> Result<Answer, Error> {
        let shares = !matches!(question, Question::Samples(_));
        let idle = if shares { locked(&self.idle).pop() } else { None };
        let started = idle.map_or_else(|| self.start(), Ok);
        let mut decoder = started.map_err(|e| Error::Elsewhere {
            words: format!("no process can be started to decode it: {e}"),
        })?;
        let answered = decoder.ask(question, bytes, limits);
        decoder.left -= 1;
        let mut idle = locked(&self.idle);
        if shares && answered.is_ok() && decoder.left > 0 && idle.len() < IDLE {
            idle.push(decoder);
        }
        answered?.map_err(|words| Error::Elsewhere { words })
    }
}

/// A process that decodes; it ends with this.
struct Decoder {
    child: Arc<Mutex<Child>>,
    orders: ChildStdin,
    replies: ChildStdout,
    left: u32,
}

impl Drop for Decoder {
    fn drop(&mut self) {
        let mut child = locked(&self.child);
        // It may have ended by itself.
        let _ = child.kill();
        let _ = child.wait();
    }
}

impl Decoder {
    /// An answer, or the sentence of the decoder.
    fn ask(
        &mut self,
        question: Question,
        bytes: &[u8],
        limits: &Limits,
    ) -> Result<Result<Answer, String>, Error> {
        let (done, ended) = channel::<()>();
        let child = Arc::clone(&self.child);
        let watch = move || {
            if ended.recv_timeout(LONGEST) == Err(RecvTimeoutError::Timeout) {
                let _ = locked(&child).kill();
            }
        };
        // Without a thread to watch it, nobody does.
        let _ = std::thread::Builder::new().spawn(watch);
        let order = Order { question, limits: *limits };
        let answer = send(&mut self.orders, &order, bytes).and_then(|()| self.answer(bytes.len(), limits));
        drop(done);
        answer.map_err(|e| Error::Elsewhere { words: self.end(&e) })
    }

    fn answer(&mut self, asked: usize, limits: &Limits) -> io::Result<Result<Answer, String>> {
        let from = &mut self.replies;
        let told = match read_head::<Reply>(from)?.ok_or(io::ErrorKind::UnexpectedEof)? {
            Ok(told) => told,
            Err(words) => {
                read_body(from, 0)?;
                return Ok(Err(darkroot::quoted(&words)));
            }
        };
        let invalid = || io::Error::from(io::ErrorKind::InvalidData);
        Ok(Ok(match told {
            Told::Capture(mut capture) => {
                match &mut capture.counts {
                    Counts::U16(mosaic) => mosaic.samples = samples(from, limits)?,
                    Counts::F32(mosaic) => mosaic.samples = samples(from, limits)?,
                }
                if !capture.is_sound() {
                    return Err(invalid());
                }
                Answer::Capture(capture)
            }
            Told::Preview { size, orientation } => {
                // It is a part of the file.
                let jpeg = read_body(from, asked as u64)?;
                Answer::Preview(Preview { jpeg, size, orientation })
            }
            Told::Pixels(size) => {
                let rgb = read_body(from, limits.max_samples)?;
                let pixels = size.width.checked_mul(size.height).and_then(|area| area.checked_mul(3));
                if pixels != Some(rgb.len()) {
                    return Err(invalid());
                }
                Answer::Pixels(size, rgb)
            }
            Told::Nothing => {
                read_body(from, 0)?;
                Answer::Nothing
            }
        }))
    }

    /// Why there is no answer.
    fn end(&mut self, error: &io::Error) -> String {
        let mut child = locked(&self.child);
        let _ = child.kill();
        let how = child.wait().map_or_else(|e| e.to_string(), |status| status.to_string());
        match error.kind() {
            io::ErrorKind::InvalidData => "made its decoder answer what cannot be".to_owned(),
            _ => format!("ended its decoder ({how}); the file is most likely damaged: copy it again"),
        }
    }
}

/// The samples that follow.
fn samples<T: bytemuck::Pod>(from: &mut impl Read, limits: &Limits) -> io::Result<Vec<T>> {
    let size = size_of::<T>();
    let length = read_length(from, limits.max_samples.saturating_mul(size as u64))?;
    if length % size != 0 {
        return Err(io::ErrorKind::InvalidData.into());
    }
    let mut samples = vec![T::zeroed(); length / size];
    from.read_exact(bytemuck::cast_slice_mut(&mut samples))?;
    Ok(samples)
}
