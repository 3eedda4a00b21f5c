//! Which part of a folder one machine of several takes.

use sha2::{Digest, Sha256};

/// Part `index` (from 1) of `count`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    /// Which part, 1..=count.
    pub index: u64,
    /// How many parts.
    pub count: u64,
}

/// Why a text gives no shard.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ShardError {
    /// It is neither I/N nor auto.
    #[error("`{text}` is no shard: write I/N with I from 1 to N, such as 2/8, or auto")]
    NoShard {
        /// As it was given.
        text: String,
    },
    /// A variable of the environment that should be a number.
    #[error("{variable} is `{text}`, which is no number")]
    NoNumber {
        /// Its name.
        variable: &'static str,
        /// What it says.
        text: String,
    },
    /// Slurm says which task this is, but not of how many.
    #[error("SLURM_ARRAY_TASK_COUNT is not set; give the shard as I/N")]
    NoSlurmCount,
    /// Slurm's numbers do not go together.
    #[error("SLURM_ARRAY_TASK_ID {id} does not fit {count} tasks from {first}; give the shard as I/N")]
    SlurmMisfit {
        /// Number of this task.
        id: u64,
        /// How many tasks.
        count: u64,
        /// Number of the first.
        first: u64,
    },
    /// Kubernetes says which task this is, and nobody of how many.
    #[error("set DARKROOT_SHARDS to the job's completions, or give the shard as I/N")]
    NoCompletions,
    /// There are fewer tasks than this one's number.
    #[error("JOB_COMPLETION_INDEX {index} does not fit {count} shards")]
    JobMisfit {
        /// Number of this task, from 0.
        index: u64,
        /// How many tasks.
        count: u64,
    },
    /// Neither Slurm nor Kubernetes runs this.
    #[error("a shard `auto` finds neither SLURM_ARRAY_TASK_ID nor JOB_COMPLETION_INDEX; give it as I/N")]
    NoScheduler,
}

impl Shard {
    /// The whole.
    pub const WHOLE: Self = Self { index: 1, count: 1 };

    /// Reads `I/N` (I from 1), or `auto`: the place in a Slurm job array or a Kubernetes Indexed Job, which
    /// `environment` tells.
    ///
    /// Slurm: `SLURM_ARRAY_TASK_ID`, `_MIN`, `_STEP` and `_COUNT`. Kubernetes: `JOB_COMPLETION_INDEX` from 0; the
    /// number of completions is not in its environment and must stand in `DARKROOT_SHARDS`.
    ///
    /// # Errors
    /// Another text, or an environment without such a place.
    pub fn parse(text: &str, environment: impl Fn(&str) -> Option<String>) -> Result<Self, ShardError> {
        if text == "auto" {
            return Self::from_environment(environment);
        }
        let numbers = text.split_once('/').and_then(|(i, n)| Some((i.parse().ok()?, n.parse().ok()?)));
        match numbers {
            Some((index, count)) if (1..=count).contains(&index) => Ok(Self { index, count }),
            _ => Err(ShardError::NoShard { text: text.to_owned() }),
        }
    }

    fn from_environment(environment: impl Fn(&str) -> Option<String>) -> Result<Self, ShardError> {
        let number = |variable: &'static str| -> Result<Option<u64>, ShardError> {
            let Some(text) = environment(variable) else { return Ok(None) };
            text.trim().parse().map(Some).map_err(|_| ShardError::NoNumber { variable, text })
        };
        if let Some(id) = number("SLURM_ARRAY_TASK_ID")? {
            let count = number("SLURM_ARRAY_TASK_COUNT")?.ok_or(ShardError::NoSlurmCount)?;
            let first = number("SLURM_ARRAY_TASK_MIN")?.unwrap_or(1);
            let step = number("SLURM_ARRAY_TASK_STEP")?.unwrap_or(1).max(1);
            let index = id.checked_sub(first).map(|d| d / step + 1);
            return match index {
                Some(index) if index <= count => Ok(Self { index, count }),
                _ => Err(ShardError::SlurmMisfit { id, count, first }),
            };
        }
        if let Some(index) = number("JOB_COMPLETION_INDEX")? {
            let count = number("DARKROOT_SHARDS")?.ok_or(ShardError::NoCompletions)?;
            if index < count {
                return Ok(Self { index: index + 1, count });
            }
            return Err(ShardError::JobMisfit { index, count });
        }
        Err(ShardError::NoScheduler)
    }

    /// Whether an input belongs to this part, by a hash of its path below its root: the same split on every machine
    /// and in every run, whatever else lies in the folder.
    pub fn has(&self, input: &str) -> bool {
        let digest = Sha256::digest(input.as_bytes());
        let number = digest.iter().take(8).fold(0u64, |n, &b| n << 8 | u64::from(b));
        number % self.count == self.index - 1
    }

    /// How its journal's name ends: "" for the whole, "-2-of-8" for a part.
    pub fn suffix(&self) -> String {
        if self.count == 1 { String::new() } else { format!("-{}-of-{}", self.index, self.count) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn auto(set: &[(&str, &str)]) -> Result<Shard, ShardError> {
        let find = |name: &str| set.iter().find(|(n, _)| *n == name).map(|(_, v)| (*v).to_owned());
        Shard::parse("auto", find)
    }

    #[test]
    fn every_input_is_in_exactly_one_part_of_about_equal_size() {
        let mut sizes = [0; 7];
        for i in 0..7000 {
            let name = format!("day {}/DSC_{i}.NEF", i % 3);
            let parts: Vec<u64> = (1..=7).filter(|&i| Shard { index: i, count: 7 }.has(&name)).collect();
            assert_eq!(parts.len(), 1);
            sizes[parts[0] as usize - 1] += 1;
        }
        assert!(sizes.iter().all(|s| (850..1150).contains(s)), "{sizes:?}");
    }

    #[test]
    fn the_split_never_changes() {
        let parts: Vec<u64> = ["a.nef", "b/a.nef", "c.nef", "d.nef", "ä.dng", "e.arw"]
            .iter()
            .filter_map(|name| (1..=5).find(|&i| Shard { index: i, count: 5 }.has(name)))
            .collect();
        // From `printf %s NAME | sha256sum | head -c 16`, as a number, modulo 5, plus 1.
        assert_eq!(parts, [3, 3, 5, 3, 3, 2]);
    }

    #[test]
    fn schedulers_say_which_part() {
        let slurm = [("SLURM_ARRAY_TASK_ID", "6"), ("SLURM_ARRAY_TASK_COUNT", "4")];
        let shifted = [&slurm[..], &[("SLURM_ARRAY_TASK_MIN", "0"), ("SLURM_ARRAY_TASK_STEP", "2")]].concat();
        assert_eq!(auto(&shifted), Ok(Shard { index: 4, count: 4 }));
        assert!(auto(&slurm).unwrap_err().to_string().contains("I/N"));
        let job = [("JOB_COMPLETION_INDEX", "0"), ("DARKROOT_SHARDS", "3")];
        assert_eq!(auto(&job), Ok(Shard { index: 1, count: 3 }));
        assert!(auto(&job[..1]).unwrap_err().to_string().contains("DARKROOT_SHARDS"));
        assert_eq!(auto(&[]), Err(ShardError::NoScheduler));
    }

    #[test]
    fn wrong_shards_say_what_to_write() {
        for wrong in ["", "3", "0/2", "3/2", "a/b", "1/0", "-1/2"] {
            assert!(Shard::parse(wrong, |_| None).unwrap_err().to_string().contains("I/N"), "{wrong}");
        }
    }
}
