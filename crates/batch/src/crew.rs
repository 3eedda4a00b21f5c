//! Workers at work: who does what, within the memory and the threads that there are.

use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::{Duration, Instant};

use super::budget::{Budget, Phase};
use super::crew_options::{CrewOptions, Workers};
use super::failure::Failure;
use super::process::Exit;
use super::running_worker::RunningWorker;
use super::stop::Stop;
use super::task::{Answer, Order};
use super::wording::Wording;
use super::work::{Next, Progress, Work};

/// How often time-outs and wishes to stop are looked at.
const TICK: Duration = Duration::from_millis(50);

/// How long a process whose answers have ended may take to end itself.
const EXIT_GRACE: Duration = Duration::from_millis(200);

/// The signal that ends a process which makes a system call that it gave up (SIGSYS).
const BREACH: i32 = 31;

/// Memory of the process that the crew works for.
const PARENT: u64 = 32 << 20;

/// An answer with the place and the number of the worker that it comes from; `None` when no more will come.
type Message = (usize, u64, Option<Answer>);

/// Workers: processes that do one file each, or threads that live from task to task.
pub(crate) struct Crew {
    options: CrewOptions,
    slots: Vec<Slot>,
    budget: Budget,
    sender: Sender<Message>,
    receiver: Receiver<Message>,
    /// Number of the next worker.
    next_number: u64,
}

/// A place for a worker.
#[derive(Default)]
struct Slot {
    /// With its number.
    worker: Option<(u64, RunningWorker)>,
    work: Option<(Work, Instant)>,
    /// The work's end was told already; the worker still has to let go of it.
    told: bool,
}

impl Slot {
    fn path(&self) -> PathBuf {
        self.work.as_ref().map(|(work, _)| work.task.input().clone()).unwrap_or_default()
    }
}

/// One call of [`Crew::perform`]: what is left to do, and who is told.
struct Round<'a> {
    queue: VecDeque<Work>,
    caller: &'a mut dyn FnMut(&Work, Progress) -> Next,
    /// No new tasks are begun.
    finishing: bool,
}

impl Crew {
    pub(crate) fn new(options: CrewOptions) -> Self {
        let (sender, receiver) = channel();
        // One more than jobs: it reads its file while the others compute.
        let slots = (0..=options.jobs.max(1)).map(|_| Slot::default()).collect::<Vec<_>>();
        let memory = options.memory.saturating_sub(PARENT);
        let budget = Budget::new(memory, options.jobs.max(1), options.threads.max(1), slots.len());
        Self { options, slots, budget, sender, receiver, next_number: 1 }
    }

    /// How errors are worded.
    pub(crate) fn wording(&self) -> &Wording {
        &self.options.wording
    }

    /// Does all the work in the queue. `caller` is told of each task's beginning and end and says how to go on.
    ///
    /// # Errors
    /// Workers cannot be started.
    pub(crate) fn perform(
        &mut self,
        queue: VecDeque<Work>,
        stop: &Stop,
        caller: &mut dyn FnMut(&Work, Progress) -> Next,
    ) -> std::io::Result<()> {
        let mut round = Round { queue, caller, finishing: false };
        loop {
            if stop.at_once() && self.can_end_workers() {
                self.end_all();
                return Ok(());
            }
            round.finishing |= stop.asked();
            self.dispatch(&mut round)?;
            let idle = self.slots.iter().all(|s| s.work.is_none());
            if idle && (round.finishing || round.queue.is_empty()) {
                return Ok(());
            }
            match self.receiver.recv_timeout(TICK) {
                Ok((slot, number, answer)) if self.is_current(slot, number) => {
                    self.answered(slot, answer, &mut round);
                }
                // From a worker that was ended.
                Ok(_) | Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return Err(std::io::ErrorKind::BrokenPipe.into()),
            }
            self.end_late_ones(&mut round);
            self.grant(round.queue.len());
        }
    }

    fn can_end_workers(&self) -> bool {
        matches!(self.options.workers, Workers::Processes(..))
    }

    fn is_current(&self, slot: usize, number: u64) -> bool {
        self.slots[slot].worker.as_ref().is_some_and(|(current, _)| *current == number)
    }

    /// Gives tasks to idle workers, as far as there is room for their files.
    fn dispatch(&mut self, round: &mut Round<'_>) -> std::io::Result<()> {
        let now = Instant::now();
        while !round.finishing {
            let Some(slot) = self.slots.iter().position(|s| s.work.is_none()) else { return Ok(()) };
            let due = |work: &Work| work.after.is_none_or(|t| t <= now);
            let Some(at) = round.queue.iter().position(due) else { return Ok(()) };
            if !self.budget.admits(round.queue[at].size) {
                return Ok(());
            }
            let Some(work) = round.queue.remove(at) else { return Ok(()) };
            match (round.caller)(&work, Progress::Begins) {
                Next::Finish => {
                    round.finishing = true;
                    round.queue.push_front(work);
                    return Ok(());
                }
                Next::Leave => continue,
                Next::GoOn | Next::Again(_) => {}
            }
            self.budget.reading(slot, work.size);
            self.start_worker(slot)?;
            let order = Order::Task(Box::new(work.task.clone()));
            self.slots[slot].work = Some((work, now));
            self.send(slot, &order);
        }
        Ok(())
    }

    /// Starts the slot's worker unless it runs.
    fn start_worker(&mut self, slot: usize) -> std::io::Result<()> {
        if self.slots[slot].worker.is_some() {
            return Ok(());
        }
        let number = self.next_number;
        self.next_number += 1;
        let sender = self.sender.clone();
        let on_answer = move |answer| sender.send((slot, number, answer)).is_ok();
        let worker = RunningWorker::start(&self.options, on_answer)?;
        self.slots[slot].worker = Some((number, worker));
        Ok(())
    }

    fn send(&mut self, slot: usize, order: &Order) {
        if let Some((_, worker)) = &mut self.slots[slot].worker {
            worker.send(order);
        }
    }

    fn answered(&mut self, slot: usize, answer: Option<Answer>, round: &mut Round<'_>) {
        match answer {
            // Once a task, so that nobody gets time for it by asking again.
            Some(Answer::Needs { bytes }) if self.budget.reads(slot) => self.needs(slot, bytes, round),
            Some(Answer::Needs { .. }) => {
                self.end_worker(slot, Duration::ZERO);
                let failure = Failure::Crashed { path: self.slots[slot].path() };
                self.end_task(slot, Err(failure), round);
            }
            Some(Answer::Dropped) => {
                if let Some((work, _)) = self.slots[slot].work.take()
                    && !self.slots[slot].told
                {
                    round.queue.push_front(work);
                }
                self.free(slot);
            }
            Some(Answer::Failed(told)) => {
                let failure = Failure::Worker { kind: told.kind, words: told.words };
                self.end_task(slot, Err(failure), round);
            }
            Some(answer) => self.end_task(slot, Ok(answer), round),
            None => {
                let failure = self.why_it_died(slot);
                // The file may be innocent (memory ran out, somebody ended the process): it gets a second chance.
                let again = |(work, _): &mut (Work, Instant)| !work.second_try && !round.finishing;
                if let Some((work, _)) = self.slots[slot].work.take_if(again) {
                    let task = work.task.once_more();
                    round.queue.push_front(Work { second_try: true, task, ..work });
                    self.free(slot);
                } else {
                    self.end_task(slot, Err(failure), round);
                }
            }
        }
    }

    /// A worker has read its file and says what the rest takes.
    fn needs(&mut self, slot: usize, bytes: u64, round: &mut Round<'_>) {
        let path = self.slots[slot].path();
        let Some((work, since)) = &mut self.slots[slot].work else { return };
        if self.budget.could_ever(bytes) {
            *since = Instant::now();
            self.budget.waits(slot, work.size, bytes);
            return;
        }
        let failure = Failure::NeverFits { path, needed: bytes, allowed: self.options.memory };
        self.send(slot, &Order::Drop);
        self.budget.phase(slot, Phase::Dropping);
        self.tell(slot, Err(failure), round);
        self.slots[slot].told = true;
    }

    /// A task came to its end: the slot is free.
    fn end_task(&mut self, slot: usize, result: Result<Answer, Failure>, round: &mut Round<'_>) {
        if !self.slots[slot].told {
            self.tell(slot, result, round);
        }
        self.free(slot);
    }

    /// The slot is free for another task. A process does one file and ends; nobody waits for that.
    fn free(&mut self, slot: usize) {
        self.slots[slot].work = None;
        self.slots[slot].told = false;
        self.budget.free(slot);
        if self.can_end_workers()
            && let Some((_, worker)) = self.slots[slot].worker.take()
        {
            std::thread::spawn(move || worker.end(EXIT_GRACE));
        }
    }

    fn tell(&mut self, slot: usize, result: Result<Answer, Failure>, round: &mut Round<'_>) {
        let Some((work, _)) = &self.slots[slot].work else { return };
        match (round.caller)(work, Progress::Ended(result)) {
            Next::GoOn | Next::Leave => {}
            Next::Finish => round.finishing = true,
            Next::Again(pause) => {
                round.queue.push_back(Work { after: Some(Instant::now() + pause), ..work.clone() });
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
    fn end_late_ones(&mut self, round: &mut Round<'_>) {
        if !self.can_end_workers() {
            return;
        }
        let limit = self.options.timeout;
        for slot in 0..self.slots.len() {
            let late = |(_, since): &(Work, Instant)| since.elapsed() > limit;
            if !self.budget.works(slot) || !self.slots[slot].work.as_ref().is_some_and(late) {
                continue;
            }
            self.end_worker(slot, Duration::ZERO);
            let failure = Failure::TookTooLong { path: self.slots[slot].path(), limit };
            self.end_task(slot, Err(failure), round);
        }
    }

    /// Ends a worker, if there is one, after so long.
    fn end_worker(&mut self, slot: usize, grace: Duration) -> Option<Exit> {
        self.slots[slot].worker.take().and_then(|(_, worker)| worker.end(grace))
    }

    /// Why a worker died.
    fn why_it_died(&mut self, slot: usize) -> Failure {
        let path = self.slots[slot].path();
        // A process stops to answer shortly before it ends.
        let exit = self.end_worker(slot, EXIT_GRACE);
        match exit {
            Some(exit) if exit.last_line.contains("memory allocation") => Failure::TooMuchMemory { path },
            Some(Exit { signal: Some(BREACH), .. }) => Failure::Breach { path },
            Some(Exit { signal: Some(9), .. }) => Failure::Ended { path },
            _ => Failure::Crashed { path },
        }
    }

    /// Ends all workers: processes at once, threads when they are done with their file.
    fn end_all(&mut self) {
        for slot in 0..self.slots.len() {
            self.end_worker(slot, Duration::ZERO);
            self.free(slot);
        }
    }
}

impl Drop for Crew {
    fn drop(&mut self) {
        self.end_all();
    }
}
