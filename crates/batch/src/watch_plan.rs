//! The plan of one round of a watch: what can be developed now, and what must wait for what.

use std::collections::{HashMap, HashSet};
use std::error::Error;
use std::rc::Rc;

use super::batch::Batch;
use super::batch_error::BatchError;
use super::find::{Source, Sources};
use super::history::Known;
use super::item::{BatchPlan, Item, PlanOptions};
use super::names::Collision;
use super::plan_fault::PlanFault;
use super::session::Session;
use super::settings_by_file::SettingsByFile;
use super::stop::Stop;

/// What planning a round takes.
pub(crate) struct PlanOfRound<'a> {
    pub(crate) batch: &'a mut Batch,
    pub(crate) options: &'a PlanOptions,
    pub(crate) settings: &'a mut SettingsByFile,
    pub(crate) session: &'a Session,
    pub(crate) stop: &'a Stop,
}

/// A round's files, sorted by what is to be done with them.
#[derive(Default)]
pub(crate) struct Planned {
    /// Those that can be developed or are done.
    pub(crate) plan: BatchPlan,
    /// Those that must wait, with the reason.
    pub(crate) held: Vec<(Source, Rc<dyn Error>)>,
    /// Those that another shard sees to.
    pub(crate) elsewhere: Vec<Source>,
}

impl PlanOfRound<'_> {
    /// Plans the files that are ready.
    ///
    /// Others that are there take part where they have an output that one of these would get, so that names collide,
    /// or are resolved, as in a batch of all.
    pub(crate) fn make(mut self, ready: Vec<Source>, found: &Sources) -> Result<Planned, BatchError> {
        let wanted: HashSet<String> = ready.iter().map(|s| s.key.clone()).collect();
        let mut owners = owners(self.batch, found);
        let mut files = ready;
        let mut planned = Planned::default();
        loop {
            match self.plan(files.clone()) {
                Ok(plan) => {
                    let others = others(&plan.items, &owners, &files);
                    if others.is_empty() {
                        return Ok(finish(planned, plan, files, &wanted));
                    }
                    files.extend(others.into_iter().cloned());
                    files.sort_by(|a, b| a.key.cmp(&b.key));
                }
                Err(BatchError::Plan(PlanFault::Collisions(collisions))) => {
                    for collision in collisions {
                        hold_colliding(&collision, &mut files, &wanted, &mut planned);
                        owners.retain(|_, owner| !collision.inputs.contains(&owner.key));
                    }
                }
                Err(BatchError::Plan(error)) => {
                    let before = files.len();
                    // Those that were developed earlier are only asked for their names.
                    files.retain(|f| wanted.contains(&f.key));
                    owners.clear();
                    files = self.sound(files, &mut planned)?;
                    if files.len() == before {
                        // Each is right and all together are not.
                        let error: Rc<dyn Error> = Rc::new(error);
                        planned.held.extend(files.drain(..).map(|file| (file, Rc::clone(&error))));
                    }
                }
                Err(error) => return Err(error),
            }
        }
    }

    fn plan(&mut self, files: Vec<Source>) -> Result<BatchPlan, BatchError> {
        let sources = Sources { files, ..Sources::default() };
        self.batch.plan(sources, self.options, self.settings, self.session, self.stop)
    }

    /// The files that can be planned; others wait, such as those whose settings are wrong.
    fn sound(&mut self, files: Vec<Source>, planned: &mut Planned) -> Result<Vec<Source>, BatchError> {
        let mut sound = Vec::new();
        for file in files {
            match self.plan(vec![file.clone()]) {
                Ok(_) => sound.push(file),
                Err(BatchError::Plan(error)) => planned.held.push((file, Rc::new(error))),
                Err(error) => return Err(error),
            }
        }
        Ok(sound)
    }
}

/// The plan without files that only lent it their names; what is not in it belongs to another shard.
fn finish(
    mut planned: Planned,
    mut plan: BatchPlan,
    files: Vec<Source>,
    wanted: &HashSet<String>,
) -> Planned {
    plan.items.retain(|item| wanted.contains(&item.source.key));
    let here: HashSet<&str> = plan.items.iter().map(|i| i.source.key.as_str()).collect();
    let elsewhere = |f: &Source| wanted.contains(&f.key) && !here.contains(f.key.as_str());
    planned.elsewhere = files.into_iter().filter(elsewhere).collect();
    planned.plan = plan;
    planned
}

/// Takes the inputs of one output out of the files.
fn hold_colliding(
    collision: &Collision,
    files: &mut Vec<Source>,
    wanted: &HashSet<String>,
    planned: &mut Planned,
) {
    let reason: Rc<dyn Error> = Rc::new(collision.clone());
    let colliding = files.extract_if(.., |f| collision.inputs.contains(&f.key));
    let held = colliding.filter(|file| wanted.contains(&file.key));
    planned.held.extend(held.map(|file| (file, Rc::clone(&reason))));
}

/// Which of the files that are there an output was made from, by the output in lower case.
fn owners<'s>(batch: &Batch, found: &'s Sources) -> HashMap<String, &'s Source> {
    let there: HashMap<&str, &Source> = found.files.iter().map(|s| (s.key.as_str(), s)).collect();
    let owner = |(output, known): (&String, &Known)| {
        let done = known.done.as_ref().map(|d| d.input.as_str());
        let input = done.or_else(|| known.failed.as_ref().map(|f| f.input.as_str()))?;
        Some((output.to_lowercase(), *there.get(input)?))
    };
    batch.history().outputs.iter().filter_map(owner).collect()
}

/// Files that are not planned, but have an output that one of the items would get.
fn others<'s>(items: &[Item], owners: &HashMap<String, &'s Source>, planned: &[Source]) -> Vec<&'s Source> {
    let planned: HashSet<&str> = planned.iter().map(|s| s.key.as_str()).collect();
    let mut found = HashSet::new();
    items
        .iter()
        .filter_map(|item| owners.get(&item.output.to_lowercase()).copied())
        .filter(|owner| !planned.contains(owner.key.as_str()) && found.insert(owner.key.as_str()))
        .collect()
}
