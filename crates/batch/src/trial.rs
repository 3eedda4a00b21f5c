//! A few files of a plan, developed into a temporary folder, to learn what such files take on this machine.

use std::collections::{BTreeMap, VecDeque};

use super::crew::Crew;
use super::crew_options::CrewOptions;
use super::estimate::{Experience, todo};
use super::item::{BatchPlan, Item};
use super::names::ending;
use super::stop::Stop;
use super::task::{Answer, Task};
use super::work::{Next, Progress, Work};

/// Endings that are tried, those with most bytes first.
const ENDINGS: usize = 3;

/// Develops up to three files for each job: of each of the most frequent endings as many as jobs, of sizes from all over. What
/// fails tells nothing. The pictures are gone afterwards.
///
/// # Errors
/// No temporary folder, or no worker.
pub fn trial(plan: &BatchPlan, crew: CrewOptions, stop: &Stop) -> std::io::Result<Experience> {
    let folder = tempfile::tempdir()?;
    let scratch = folder.path().join("unfinished");
    std::fs::create_dir(&scratch)?;
    let chosen = chosen(plan, crew.jobs.max(1));
    let queue: VecDeque<Work> = chosen
        .iter()
        .enumerate()
        .map(|(id, item)| {
            let output = folder.path().join(format!("{id}.{}", item.prepared.format.extension()));
            let task = item.task(output, folder.path(), &scratch);
            Work::new(id, Task::Develop(task), item.source.size)
        })
        .collect();
    let mut experience = Experience::default();
    Crew::new(crew).perform(queue, stop, &mut |work, progress| {
        if let Progress::Ended(Ok(Answer::Developed(developed))) = progress {
            let (key, read) = (&chosen[work.id].source.key, developed.source.size);
            experience.add(key, read, developed.written.size, developed.seconds);
        }
        Next::GoOn
    })?;
    Ok(experience)
}

/// Files that stand for the others.
fn chosen(plan: &BatchPlan, jobs: usize) -> Vec<&Item> {
    let mut groups: BTreeMap<String, Vec<&Item>> = BTreeMap::new();
    for item in todo(plan) {
        groups.entry(ending(&item.source.key)).or_default().push(item);
    }
    let mut groups: Vec<Vec<&Item>> = groups.into_values().collect();
    let bytes = |group: &[&Item]| group.iter().map(|item| item.source.size).sum::<u64>();
    groups.sort_by_key(|group| std::cmp::Reverse(bytes(group)));
    groups.into_iter().take(ENDINGS).flat_map(|group| spread(group, jobs)).collect()
}

/// So many files of sizes from all over.
fn spread(mut group: Vec<&Item>, many: usize) -> Vec<&Item> {
    group.sort_by_key(|item| item.source.size);
    let n = group.len();
    let many = n.min(many);
    (0..many).map(|i| group[(2 * i + 1) * n / (2 * many)]).collect()
}
