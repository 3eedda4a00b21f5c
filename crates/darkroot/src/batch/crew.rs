//! Worker processes at work: who does what, within the memory and the threads that there are.

use std::collections::VecDeque;
use std::ffi::OsString;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::{Duration, Instant};

use super::budget::{Budget, Phase};
use super::process::{Ended, Process};
use super::stop::Stop;
use super::system;
use super::task::{Answer, Order, Task, Trouble, TroubleKind};

/// How often time-outs and wishes to stop are looked at.
const BEAT: Duration = Duration::from_millis(50);

/// How long a process whose answers have ended may take to end itself.
const LAST_MOMENT: Duration = Duration::from_millis(200);

/// Memory of the process that the crew works for.
const PARENT: u64 = 32 << 20;

/// How to run a crew.
#[derive(Debug, Clone)]
pub struct CrewOptions {
    /// Program and arguments of a worker: something that calls [`serve`](super::serve) on its stdin and stdout.
    pub worker: (PathBuf, Vec<OsString>),
    /// Files developed at once, at most.
    pub jobs: usize,
    /// Threads in all.
    pub threads: usize,
    /// Memory of all processes of the run together, bytes.
    pub memory: u64,
    /// Longest time for one file.
    pub timeout: Duration,
}

impl CrewOptions {
    /// The whole machine but for half of the free memory, with this worker.
    pub fn new(program: PathBuf, arguments: Vec<OsString>) -> Self {
        let threads = system::threads();
        let memory = system::free_memory() / 2;
        Self {
            worker: (program, arguments),
            jobs: threads,
            threads,
            memory,
            timeout: Duration::from_secs(600),
        }
    }
}

/// A task in the queue.
#[derive(Debug, Clone)]
pub(super) struct Work {
    /// The caller's number for it.
    pub(super) id: usize,
    pub(super) task: Task,
    /// Bytes of its file.
    pub(super) size: u64,
    /// Not before this moment.
    pub(super) after: Option<Instant>,
    /// Whether a worker died over it already.
    pub(super) deadly: bool,
}

impl Work {
    pub(super) fn new(id: usize, task: Task, size: u64) -> Self {
        Self { id, task, size, after: None, deadly: false }
    }
}

/// What the crew tells its caller.
pub(super) enum Moment {
    /// The task is about to be sent to a worker.
    Begun,
    /// Its answer.
    Came(Result<Answer, Trouble>),
}

/// What the caller wants next.
pub(super) enum Next {
    GoOn,
    /// The same task again after a while.
    Again(Duration),
    /// No more new tasks.
    Finish,
}

/// Workers that live from task to task.
pub(super) struct Crew {
    options: CrewOptions,
    slots: Vec<Slot>,
    budget: Budget,
    sender: Sender<(usize, u64, Option<Answer>)>,
    receiver: Receiver<(usize, u64, Option<Answer>)>,
    /// Number of the next process.
    generation: u64,
}

#[derive(Default)]
struct Slot {
    /// With its number.
    process: Option<(u64, Process)>,
    work: Option<(Work, Instant)>,
    /// The work's end was told already; the worker still has to let go of it.
    told: bool,
}

impl Crew {
    pub(super) fn new(options: CrewOptions) -> Self {
        let (sender, receiver) = channel();
        // One more than jobs: it reads its file while the others compute.
        let slots = (0..=options.jobs.max(1)).map(|_| Slot::default()).collect::<Vec<_>>();
        let memory = options.memory.saturating_sub(PARENT);
        let budget = Budget::new(memory, options.jobs.max(1), options.threads.max(1), slots.len());
        Self { options, slots, budget, sender, receiver, generation: 0 }
    }

    /// Does all the work in the queue. `hear` is told of each task's beginning and end and says how to go on.
    ///
    /// # Errors
    /// Workers cannot be started.
    pub(super) fn perform(
        &mut self,
        mut queue: VecDeque<Work>,
        stop: &Stop,
        hear: &mut dyn FnMut(&Work, Moment) -> Next,
    ) -> std::io::Result<()> {
        let mut finishing = false;
        loop {
            if stop.at_once() {
                self.kill();
                return Ok(());
            }
            finishing |= stop.asked();
            if !finishing {
                self.dispatch(&mut queue, hear, &mut finishing)?;
            }
            if self.slots.iter().all(|s| s.work.is_none()) && (finishing || queue.is_empty()) {
                return Ok(());
            }
            match self.receiver.recv_timeout(BEAT) {
                Ok((slot, generation, answer)) if self.is_current(slot, generation) => {
                    self.answered(slot, answer, &mut queue, hear, &mut finishing);
                }
                // From a process that was killed.
                Ok(_) | Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return Err(std::io::ErrorKind::BrokenPipe.into()),
            }
            self.end_late_ones(&mut queue, hear, &mut finishing);
            self.grant(queue.len());
        }
    }

    fn is_current(&self, slot: usize, generation: u64) -> bool {
        self.slots[slot].process.as_ref().is_some_and(|(number, _)| *number == generation)
    }

    /// Gives tasks to idle workers, as far as there is room for their files.
    fn dispatch(
        &mut self,
        queue: &mut VecDeque<Work>,
        hear: &mut dyn FnMut(&Work, Moment) -> Next,
        finishing: &mut bool,
    ) -> std::io::Result<()> {
        let now = Instant::now();
        while !*finishing {
            let Some(slot) = self.slots.iter().position(|s| s.work.is_none()) else { return Ok(()) };
            let Some(at) = queue.iter().position(|w| w.after.is_none_or(|t| t <= now)) else { return Ok(()) };
            if !self.budget.admits(queue[at].size) {
                return Ok(());
            }
            let Some(work) = queue.remove(at) else { return Ok(()) };
            if matches!(hear(&work, Moment::Begun), Next::Finish) {
                *finishing = true;
                queue.push_front(work);
                return Ok(());
            }
            self.budget.reading(slot, work.size);
            self.hire(slot)?;
            let order = Order::Task(Box::new(work.task.clone()));
            self.slots[slot].work = Some((work, now));
            self.send(slot, &order);
        }
        Ok(())
    }

    /// Starts the slot's process unless it runs.
    fn hire(&mut self, slot: usize) -> std::io::Result<()> {
        if self.slots[slot].process.is_some() {
            return Ok(());
        }
        self.generation += 1;
        let generation = self.generation;
        let sender = self.sender.clone();
        let hear = move |answer| sender.send((slot, generation, answer)).is_ok();
        let (program, arguments) = &self.options.worker;
        self.slots[slot].process = Some((generation, Process::start(program, arguments, hear)?));
        Ok(())
    }

    fn send(&mut self, slot: usize, order: &Order) {
        if let Some((_, process)) = &mut self.slots[slot].process {
            process.send(order);
        }
    }

    fn answered(
        &mut self,
        slot: usize,
        answer: Option<Answer>,
        queue: &mut VecDeque<Work>,
        hear: &mut dyn FnMut(&Work, Moment) -> Next,
        finishing: &mut bool,
    ) {
        match answer {
            Some(Answer::Needs { bytes }) => {
                let Some((work, since)) = &mut self.slots[slot].work else { return };
                if self.budget.could_ever(bytes) {
                    *since = Instant::now();
                    self.budget.waits(slot, work.size, bytes);
                    return;
                }
                let error = format!(
                    "{}: needs {} of memory beside the main program, but all together may have {}; give more with `--memory`",
                    work.task.input().display(),
                    megabytes(bytes),
                    megabytes(self.options.memory),
                );
                self.send(slot, &Order::Drop);
                self.budget.phase(slot, Phase::Dropping);
                let trouble = Trouble { kind: TroubleKind::File, error };
                self.tell(slot, Err(trouble), queue, hear, finishing);
                self.slots[slot].told = true;
            }
            Some(Answer::Dropped) => {
                if let Some((work, _)) = self.slots[slot].work.take()
                    && !self.slots[slot].told
                {
                    queue.push_front(work);
                }
                self.free(slot);
            }
            Some(Answer::Failed(trouble)) => self.end(slot, Err(trouble), queue, hear, finishing),
            Some(answer) => self.end(slot, Ok(answer), queue, hear, finishing),
            None => {
                let trouble = self.obituary(slot);
                // The file may be innocent (memory ran out, somebody ended the process): it gets a second chance.
                if let Some((work, _)) = self.slots[slot].work.take_if(|(w, _)| !w.deadly && !*finishing) {
                    queue.push_front(Work { deadly: true, ..work });
                    self.free(slot);
                } else {
                    self.end(slot, Err(trouble), queue, hear, finishing);
                }
            }
        }
    }

    /// A task came to its end: the slot is free.
    fn end(
        &mut self,
        slot: usize,
        result: Result<Answer, Trouble>,
        queue: &mut VecDeque<Work>,
        hear: &mut dyn FnMut(&Work, Moment) -> Next,
        finishing: &mut bool,
    ) {
        if !self.slots[slot].told {
            self.tell(slot, result, queue, hear, finishing);
        }
        self.free(slot);
    }

    fn free(&mut self, slot: usize) {
        self.slots[slot].work = None;
        self.slots[slot].told = false;
        self.budget.free(slot);
    }

    fn tell(
        &mut self,
        slot: usize,
        result: Result<Answer, Trouble>,
        queue: &mut VecDeque<Work>,
        hear: &mut dyn FnMut(&Work, Moment) -> Next,
        finishing: &mut bool,
    ) {
        let Some((work, _)) = &self.slots[slot].work else { return };
        match hear(work, Moment::Came(result)) {
            Next::GoOn => {}
            Next::Finish => *finishing = true,
            Next::Again(pause) => {
                queue.push_back(Work { after: Some(Instant::now() + pause), ..work.clone() });
            }
        }
    }

    /// Lets those go on for whom there is room, in the order in which they came.
    fn grant(&mut self, queued: usize) {
        for (slot, threads) in self.budget.grants(queued) {
            if let Some((_, since)) = &mut self.slots[slot].work {
                *since = Instant::now();
            }
            self.send(slot, &Order::Go { threads });
        }
        for slot in self.budget.drops() {
            self.send(slot, &Order::Drop);
        }
    }

    /// Ends workers that take too long over their file. Waiting for room is not counted.
    fn end_late_ones(
        &mut self,
        queue: &mut VecDeque<Work>,
        hear: &mut dyn FnMut(&Work, Moment) -> Next,
        finishing: &mut bool,
    ) {
        for slot in 0..self.slots.len() {
            let limit = self.options.timeout;
            let late = |(_, since): &(Work, Instant)| since.elapsed() > limit;
            let busy = self.budget.works(slot);
            if !busy || !self.slots[slot].work.as_ref().is_some_and(late) {
                continue;
            }
            let name = self.slots[slot].work.as_ref().map(|(w, _)| w.task.input().display().to_string());
            self.fire(slot, Duration::ZERO);
            let error = format!(
                "{}: took longer than {}; give it more time with `--timeout`",
                name.unwrap_or_default(),
                humantime::format_duration(limit),
            );
            self.end(slot, Err(Trouble { kind: TroubleKind::Died, error }), queue, hear, finishing);
        }
    }

    /// Ends a process, if there is one, after so long.
    fn fire(&mut self, slot: usize, patience: Duration) -> Option<Ended> {
        self.slots[slot].process.take().and_then(|(_, process)| process.end(patience))
    }

    /// Why a worker died, in one sentence.
    fn obituary(&mut self, slot: usize) -> Trouble {
        let name = self.slots[slot].work.as_ref().map(|(w, _)| w.task.input().display().to_string());
        let name = name.unwrap_or_default();
        // The end of its answers comes a moment before its end.
        let ended = self.fire(slot, LAST_MOMENT);
        let error = if ended.as_ref().is_some_and(|e| e.last_words.contains("memory allocation")) {
            format!(
                "{name}: took more memory than such a file should; it is damaged, or give more with `--memory`"
            )
        } else {
            match ended.and_then(|e| e.signal) {
                Some(9) => format!(
                    "{name}: the system ended the process that worked on it, most likely for want of memory; give \
                     less with `--memory` or `--jobs`, and run again"
                ),
                _ => format!(
                    "{name}: its decoder crashed, which cost only this file; it is most likely damaged (`darkroot \
                     inspect` tells more)"
                ),
            }
        };
        Trouble { kind: TroubleKind::Died, error }
    }

    /// Ends everyone at once.
    pub(super) fn kill(&mut self) {
        for slot in 0..self.slots.len() {
            self.fire(slot, Duration::ZERO);
            self.free(slot);
        }
    }
}

impl Drop for Crew {
    fn drop(&mut self) {
        self.kill();
    }
}

/// Bytes for people.
pub fn megabytes(bytes: u64) -> String {
    let mega = bytes as f64 / 1e6;
    match mega {
        m if m >= 1000.0 => format!("{:.1} GB", m / 1000.0),
        m if m >= 1.0 => format!("{m:.0} MB"),
        m => format!("{:.0} kB", m * 1000.0),
    }
}
