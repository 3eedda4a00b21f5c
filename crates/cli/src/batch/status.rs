//! `darkroot batch status`.

use std::io::Write;
use std::path::PathBuf;

use anyhow::Result;
use clap::Args;
use darkroot_batch::history::{History, Known};
use darkroot_batch::journal;
use serde_json::json;

use crate::Outcome;

/// Say what the journals of an output folder know, those of all shards together
#[derive(Debug, Args)]
pub(crate) struct Status {
    /// The output folder
    #[arg(value_name = "OUT")]
    out: PathBuf,

    /// As a line of JSON
    #[arg(long)]
    json: bool,
}

impl Status {
    pub(crate) fn run(self) -> Result<Outcome> {
        let mut all = History::default();
        let mut out = crate::out::lines();
        for (name, history) in journal::read_all(&self.out)? {
            let Counts { done, failed, open } = counts(&history);
            if !self.json {
                writeln!(
                    out,
                    "{}: {done} done, {failed} failed, {open} begun and not ended",
                    darkroot::shown(&name)
                )?;
            }
            all.merge(history);
        }
        let Counts { done, failed, open } = counts(&all);
        let mut failures: Vec<_> = all.outputs.values().filter_map(|k| k.failed.as_ref()).collect();
        failures.sort_by(|a, b| a.input.cmp(&b.input));
        if self.json {
            let failures: Vec<_> =
                failures.iter().map(|f| json!({ "input": f.input, "error": f.error, "at": f.at })).collect();
            writeln!(
                crate::out::json(),
                "{}",
                json!({
                    "done": done, "failed": failed, "open": open, "damaged_lines": all.damaged,
                    "failures": failures,
                })
            )?;
        } else {
            writeln!(out, "together: {done} done, {failed} failed, {open} begun and not ended")?;
            if all.damaged > 0 {
                writeln!(out, "{} torn or damaged lines were passed over", all.damaged)?;
            }
            for failure in failures {
                writeln!(out, "failed: {}", darkroot::shown(&failure.error))?;
            }
        }
        Ok(if failed == 0 { Outcome::Done } else { Outcome::SomeFailed })
    }
}

struct Counts {
    done: usize,
    failed: usize,
    open: usize,
}

fn counts(history: &History) -> Counts {
    let count = |of: fn(&Known) -> bool| history.outputs.values().filter(|k| of(k)).count();
    Counts {
        done: count(|k| k.done.is_some() && k.failed.is_none() && !k.open),
        failed: count(|k| k.failed.is_some()),
        open: count(|k| k.open && k.failed.is_none()),
    }
}
