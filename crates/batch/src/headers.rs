//! Asking workers for what stands at the head of each file.

use std::collections::VecDeque;

use super::crew::Crew;
use super::facts::Header;
use super::find::Source;
use super::stop::Stop;
use super::task::{Answer, Task};
use super::work::{Next, Progress, Work};

/// Camera and date of every file; of those that cannot be read, nothing.
pub(crate) fn read_headers(crew: &mut Crew, sources: &[Source], stop: &Stop) -> Vec<Header> {
    let mut headers = vec![Header::default(); sources.len()];
    let queue: VecDeque<Work> = sources
        .iter()
        .enumerate()
        .map(|(id, s)| Work::new(id, Task::Header { input: s.path.clone() }, s.size))
        .collect();
    let taken = crew.perform(queue, stop, &mut |work, progress| {
        if let Progress::Ended(Ok(Answer::Header(header))) = progress {
            headers[work.id] = header;
        }
        Next::GoOn
    });
    // If no worker can be started, the run itself will say so.
    drop(taken);
    headers
}
