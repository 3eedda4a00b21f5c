//! Memory and threads: who may go on.
//!
//! A worker first reads its file, which takes about the file's size. Then it says what the rest takes and waits
//! until there is room. Those who wait are served in their order, and nobody new is let in before them, so a large
//! file waits but does not starve. If those who wait hold so much that not even the first of them fits, the later
//! ones let go of their files and begin anew.

use super::need::WORKER;

/// What a worker is doing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Phase {
    #[default]
    Idle,
    Reading,
    Waiting,
    Dropping,
    Running,
}

#[derive(Debug, Clone, Copy, Default)]
struct Place {
    phase: Phase,
    /// Memory that it holds now.
    held: u64,
    /// Memory that it needs to go on.
    need: u64,
    threads: usize,
    /// When it came, in the order of all.
    turn: u64,
}

/// The account.
#[derive(Debug)]
pub(crate) struct Budget {
    memory: u64,
    jobs: usize,
    threads: usize,
    places: Vec<Place>,
    turn: u64,
    /// Largest need so far, per byte of file.
    ratio: f64,
}

impl Budget {
    /// For so many bytes, files at once, threads, and places for workers.
    pub(crate) fn new(memory: u64, jobs: usize, threads: usize, places: usize) -> Self {
        /// A typical need per byte of file before any is known: 24 MP in 25 MB of losslessly compressed NEF.
        const TYPICAL: f64 = 6.0;
        Self { memory, jobs, threads, places: vec![Place::default(); places], turn: 0, ratio: TYPICAL }
    }

    fn held(&self) -> u64 {
        self.places.iter().map(|p| p.held).sum()
    }

    fn count(&self, phase: Phase) -> usize {
        self.places.iter().filter(|p| p.phase == phase).count()
    }

    /// Whether a file of this size should be begun now.
    pub(crate) fn admits(&self, size: u64) -> bool {
        if self.places.iter().all(|p| p.phase == Phase::Idle) {
            return true;
        }
        if self.count(Phase::Waiting) + self.count(Phase::Dropping) > 0 {
            return false;
        }
        let expected = WORKER + (size as f64 * self.ratio) as u64;
        let ahead: u64 = self.places.iter().filter(|p| p.phase == Phase::Reading).map(|p| p.need).sum();
        let running: u64 = self.places.iter().filter(|p| p.phase == Phase::Running).map(|p| p.held).sum();
        // One may read ahead of those who compute, if its file fits beside them.
        let reads_ahead = self.count(Phase::Running) + self.count(Phase::Reading) >= self.jobs;
        let asked = if reads_ahead { WORKER + size } else { expected };
        running + ahead + asked <= self.memory
    }

    /// A worker reads a file of this size.
    pub(crate) fn reading(&mut self, place: usize, size: u64) {
        self.turn += 1;
        let need = WORKER + (size as f64 * self.ratio) as u64;
        self.places[place] =
            Place { phase: Phase::Reading, held: WORKER + size, need, threads: 0, turn: self.turn };
    }

    /// It has read it and needs this much in all.
    pub(crate) fn waits(&mut self, place: usize, size: u64, need: u64) {
        let ratio = need.saturating_sub(WORKER) as f64 / size.max(1) as f64;
        // Tiny files have needs that say nothing of large ones.
        if size > 1 << 20 {
            self.ratio = self.ratio.max(ratio.min(100.0));
        }
        let place = &mut self.places[place];
        place.phase = Phase::Waiting;
        place.need = need.max(place.held);
    }

    pub(crate) fn phase(&mut self, place: usize, phase: Phase) {
        self.places[place].phase = phase;
    }

    pub(crate) fn free(&mut self, place: usize) {
        self.places[place] = Place::default();
    }

    /// Whether that much can be had at all.
    pub(crate) fn could_ever(&self, need: u64) -> bool {
        need <= self.memory
    }

    /// Whether the worker is at something that its time is counted for.
    pub(crate) fn works(&self, place: usize) -> bool {
        matches!(self.places[place].phase, Phase::Reading | Phase::Running)
    }

    /// Whether the worker has yet to say what it needs.
    pub(crate) fn reads(&self, place: usize) -> bool {
        self.places[place].phase == Phase::Reading
    }

    /// Those who may go on now, each with its threads. `queued` more files are to come.
    pub(crate) fn grants(&mut self, queued: usize) -> Vec<(usize, usize)> {
        let mut granted = Vec::new();
        let mut waiting: Vec<usize> =
            (0..self.places.len()).filter(|&i| self.places[i].phase == Phase::Waiting).collect();
        waiting.sort_by_key(|&i| self.places[i].turn);
        for i in waiting {
            let Place { held, need, .. } = self.places[i];
            let fits = self.held() - held + need <= self.memory;
            let used: usize = self.places.iter().map(|p| p.threads).sum();
            let idle = used < self.threads.max(self.jobs) && self.count(Phase::Running) < self.jobs;
            if !(fits && idle) {
                break;
            }
            let threads = self.share(need, queued);
            let place = &mut self.places[i];
            *place = Place { phase: Phase::Running, held: need, threads, ..*place };
            granted.push((i, threads));
        }
        granted
    }

    /// Threads for one file: those that are free, shared with the files that will run beside it.
    fn share(&self, need: u64, queued: usize) -> usize {
        let used: usize = self.places.iter().map(|p| p.threads).sum();
        let free = self.threads.saturating_sub(used);
        let others =
            self.places.iter().filter(|p| matches!(p.phase, Phase::Reading | Phase::Waiting)).count();
        let room = (self.memory.saturating_sub(self.held_by_running()) / need.max(1)).max(1);
        let to_come = (others + queued).max(1).min(room as usize);
        let places = (self.jobs - self.count(Phase::Running).min(self.jobs - 1)).min(to_come);
        (free / places.max(1)).max(1)
    }

    fn held_by_running(&self) -> u64 {
        self.places.iter().filter(|p| p.phase == Phase::Running).map(|p| p.held).sum()
    }

    /// Those who must let go of their files so that the first who waits can go on.
    pub(crate) fn drops(&mut self) -> Vec<usize> {
        let stuck = self.count(Phase::Running) + self.count(Phase::Reading) + self.count(Phase::Dropping)
            == 0
            && self.count(Phase::Waiting) > 1;
        if !stuck {
            return Vec::new();
        }
        let mut waiting: Vec<usize> =
            (0..self.places.len()).filter(|&i| self.places[i].phase == Phase::Waiting).collect();
        waiting.sort_by_key(|&i| self.places[i].turn);
        for &i in &waiting[1..] {
            self.places[i].phase = Phase::Dropping;
        }
        waiting.split_off(1)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const MB: u64 = 1 << 20;

    #[test]
    fn a_large_file_waits_and_is_not_overtaken() {
        let mut budget = Budget::new(1000 * MB, 4, 4, 5);
        budget.reading(0, 50 * MB);
        budget.waits(0, 50 * MB, 700 * MB);
        assert_eq!(budget.grants(9), [(0, 4)], "nothing else fits beside it: it gets all threads");
        budget.reading(1, 60 * MB);
        budget.waits(1, 60 * MB, 800 * MB);
        assert!(budget.grants(9).is_empty());
        assert!(!budget.admits(MB), "nobody new before the one who waits");
        budget.free(0);
        assert_eq!(budget.grants(9), [(1, 4)]);
    }

    #[test]
    fn the_last_files_share_all_threads() {
        let mut budget = Budget::new(10_000 * MB, 8, 8, 9);
        for i in 0..2 {
            budget.reading(i, 25 * MB);
        }
        for i in 0..2 {
            budget.waits(i, 25 * MB, 150 * MB);
        }
        assert_eq!(budget.grants(0), [(0, 4), (1, 4)]);
    }

    #[test]
    fn those_who_wait_for_each_other_let_go() {
        let mut budget = Budget::new(500 * MB, 3, 3, 4);
        for i in 0..3 {
            budget.reading(i, 100 * MB);
        }
        for i in 0..3 {
            budget.waits(i, 100 * MB, 450 * MB);
        }
        assert!(budget.grants(0).is_empty());
        assert_eq!(budget.drops(), [1, 2]);
        assert!(budget.grants(0).is_empty(), "not before they have let go");
        budget.free(1);
        budget.free(2);
        assert_eq!(budget.grants(2), [(0, 3)]);
    }

    proptest! {
        /// Whatever files come: memory and threads are never overdrawn, and all files get done.
        #[test]
        fn everyone_gets_done_within_the_budget(
            files in prop::collection::vec((1u64..200, 1.0f64..30.0), 1..40),
            jobs in 1usize..6, memory in 300u64..4000,
        ) {
            let memory = memory * MB;
            let mut budget = Budget::new(memory, jobs, jobs, jobs + 1);
            let mut queue: Vec<(u64, u64)> = files
                .iter()
                .map(|&(size, ratio)| {
                    let need = (WORKER + (size as f64 * ratio) as u64 * MB).max(WORKER + size * MB);
                    (size * MB, need.min(memory))
                })
                .filter(|(size, need)| WORKER + size <= *need)
                .collect();
            let mut at: Vec<Option<(u64, u64)>> = vec![None; jobs + 1];
            let mut steps = 0;
            while !queue.is_empty() || at.iter().any(Option::is_some) {
                steps += 1;
                prop_assert!(steps < 2000, "stuck: {budget:?}");
                while let Some(place) = at.iter().position(Option::is_none) {
                    let Some(&(size, need)) = queue.last() else { break };
                    if !budget.admits(size) { break }
                    queue.pop();
                    budget.reading(place, size);
                    at[place] = Some((size, need));
                }
                for (i, file) in at.iter().enumerate() {
                    if let (Some((size, need)), Phase::Reading) = (*file, budget.places[i].phase) {
                        budget.waits(i, size, need);
                    }
                }
                budget.grants(queue.len());
                for i in budget.drops() {
                    queue.extend(at[i].take());
                    budget.free(i);
                }
                let running: Vec<&Place> = budget.places.iter().filter(|p| p.phase == Phase::Running).collect();
                prop_assert!(running.len() <= jobs);
                prop_assert!(running.iter().map(|p| p.threads).sum::<usize>() <= jobs);
                prop_assert!(running.iter().map(|p| p.held).sum::<u64>() <= memory);
                if let Some(i) = (0..at.len()).find(|&i| budget.places[i].phase == Phase::Running) {
                    at[i] = None;
                    budget.free(i);
                }
            }
        }
    }
}
