//! What `batch` and `watch` have in common: which files, where to, and how much of the machine.

use std::path::PathBuf;
use std::time::Duration;

use anyhow::{Context, Result, ensure};
use clap::Args;
use darkroot::path_text;
use darkroot_batch::{
    ChartShot, CrewOptions, OnCollision, PlanOptions, Search, Shard, Wording, Workers, names, system,
};

use crate::Common;
use crate::picture::Picture;
use crate::sandbox::Sandbox;
use crate::values;

/// Which files, where to, and how much of the machine.
#[derive(Debug, Clone, Args)]
pub(crate) struct Work {
    /// Folders (with all folders in them), files, patterns ('shoot/**/*.NEF')
    #[arg(required = true, value_name = "IN")]
    pub(crate) inputs: Vec<PathBuf>,

    /// Folder of the pictures; the tree of IN is mirrored below it
    #[arg(short, long, required = true, value_name = "OUT", help_heading = "Output")]
    pub(crate) output: Option<PathBuf>,

    /// Names below OUT, from {folder} {stem} {suffix} {ext} {parent} {camera} {date} {year} {month} {day} {seq}
    #[arg(long, value_name = "TEMPLATE", default_value = names::MIRRORED, help_heading = "Output")]
    name: String,

    /// When several inputs would become one output: refuse (do nothing, list them), suffix (DSC_1-dng.jpg), skip (the first
    /// one is developed), or prefer:nef,dng (the one with the first of these endings is)
    #[arg(long, value_name = "WAY", default_value = "refuse", help_heading = "Output")]
    on_collision: OnCollision,

    /// Replace pictures in OUT that are not from a batch, or were changed since
    #[arg(long, help_heading = "Output")]
    overwrite: bool,

    /// Only the folders themselves, not those in them
    #[arg(long, help_heading = "Input")]
    no_recursive: bool,

    /// Only files that match (by name or path below IN); also files that are not named like raw files
    #[arg(long, value_name = "PATTERN", help_heading = "Input")]
    include: Vec<String>,

    /// No files or folders that match
    #[arg(long, value_name = "PATTERN", help_heading = "Input")]
    exclude: Vec<String>,

    /// Follow symbolic links
    #[arg(long, help_heading = "Input")]
    follow_links: bool,

    /// Take hidden files and folders too
    #[arg(long, help_heading = "Input")]
    hidden: bool,

    /// White balance and profile from a shot of a colour chart: a file, or `auto` for the shot that shows one in each
    /// folder
    #[arg(long, value_name = "FILE", help_heading = "Session colour")]
    chart_shot: Option<String>,

    /// The chart, as `darkroot profile` takes it; any with a built-in reference if not given
    #[arg(long, value_name = "NAME", requires = "chart_shot", help_heading = "Session colour")]
    chart: Option<String>,

    /// Its reference, as `darkroot profile` takes it
    #[arg(long, value_name = "FILE", requires = "chart_shot", help_heading = "Session colour")]
    reference: Option<String>,

    /// The light of the session, as `darkroot profile` takes it; the one that each chart shot shows if not given
    #[arg(long, value_name = "LIGHT", requires = "chart_shot", help_heading = "Session colour")]
    light: Option<String>,

    /// Files developed at once; one for each thread if not given
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..), help_heading = "Machine")]
    jobs: Option<u16>,

    /// Memory of all processes of this run together, such as 4G; half of what is free if not given
    #[arg(long, value_name = "SIZE", value_parser = size, help_heading = "Machine")]
    memory: Option<u64>,

    /// Longest time for one file, such as 90s or 10m
    #[arg(long, value_name = "TIME", default_value = "10m", value_parser = values::time, help_heading = "Machine")]
    timeout: Duration,

    /// Only part I of N of the files, or `auto` inside a Slurm array or a Kubernetes Indexed Job
    #[arg(long, value_name = "I/N", value_parser = shard, help_heading = "Machine")]
    shard: Option<Shard>,

    #[command(flatten, next_help_heading = "Machine")]
    sandbox: Sandbox,

    #[command(flatten)]
    pub(crate) picture: Picture,
}

impl Work {
    /// The output folder.
    pub(crate) fn out(&self) -> Result<PathBuf> {
        self.output.clone().context("name the folder of the pictures with `-o OUT`")
    }

    pub(crate) fn search(&self) -> Search {
        Search {
            inputs: self.inputs.iter().map(|input| path_text::text(input)).collect(),
            flat: self.no_recursive,
            include: self.include.clone(),
            exclude: self.exclude.clone(),
            follow_links: self.follow_links,
            hidden: self.hidden,
            apart: false,
        }
    }

    pub(crate) fn plan_options(&self) -> Result<PlanOptions> {
        let mut options = PlanOptions::into(&self.out()?);
        options.template.clone_from(&self.name);
        options.on_collision = self.on_collision.clone();
        options.overwrite = self.overwrite;
        options.shard = self.shard.unwrap_or(Shard::WHOLE);
        Ok(options)
    }

    /// Where session colours come from, if they were asked for.
    pub(crate) fn chart_shot(&self) -> Result<Option<ChartShot>> {
        let Some(text) = &self.chart_shot else { return Ok(None) };
        ensure!(
            !self.picture.names_colours(),
            "`--chart-shot` gives white balance and profile: leave out `--white-balance` and `--profile`"
        );
        // What is wrong with them is said before anything runs.
        if let Some(chart) = &self.chart {
            let layout = darkroot::charts::layout(chart)?;
            darkroot::charts::reference(self.reference.as_deref(), &layout)?;
        }
        if let Some(light) = &self.light {
            darkroot::light::find(light)?;
        }
        Ok(Some(ChartShot {
            file: (text != "auto").then(|| PathBuf::from(text)),
            layout: self.chart.clone(),
            reference: self.reference.clone(),
            light: self.light.clone(),
        }))
    }

    /// How much of the machine the workers get.
    pub(crate) fn crew(&self, common: Common) -> Result<CrewOptions> {
        let program = std::env::current_exe().context("this program cannot find itself to start workers")?;
        let threads = common.threads.unwrap_or_else(system::threads).max(1);
        let arguments = if self.sandbox.is_on() { &["worker"][..] } else { &["worker", "--no-sandbox"] };
        self.sandbox.say(common);
        Ok(CrewOptions {
            workers: Workers::Processes(program, arguments.iter().map(Into::into).collect()),
            jobs: self.jobs.map_or(threads, |jobs| common.at_most(jobs.into(), "files at once")),
            threads,
            memory: self.memory.unwrap_or_else(|| system::free_memory() / 2),
            timeout: self.timeout,
            wording: Wording::new(crate::hint::words),
        })
    }
}

/// `--memory`: bytes, or K, M, G, T for powers of 1024.
fn size(text: &str) -> Result<u64, String> {
    let wrong = || format!("`{text}` is no size: write a number with K, M, G or T, such as 4G or 1500M");
    let plain = text.trim_end_matches(['b', 'B']).trim_end_matches('i');
    let (number, unit) = match plain.chars().last() {
        Some(c) if c.is_ascii_alphabetic() => (&plain[..plain.len() - 1], c.to_ascii_uppercase()),
        _ => (plain, 'B'),
    };
    let power = "BKMGT".find(unit).ok_or_else(wrong)?;
    let number: f64 = number.trim().parse().map_err(|_| wrong())?;
    let bytes = number * 1024f64.powi(power as i32);
    if bytes.is_finite() && bytes >= 1.0 { Ok(bytes as u64) } else { Err(wrong()) }
}

fn shard(text: &str) -> Result<Shard, String> {
    Shard::parse(text, |name| std::env::var(name).ok()).map_err(|e| crate::hint::words(&e))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_read_as_people_write_them() {
        for (text, bytes) in
            [("4G", 4 << 30), ("1.5g", 3 << 29), ("512MiB", 512 << 20), ("2GB", 2 << 30), ("4096", 4096)]
        {
            assert_eq!(size(text), Ok(bytes), "{text}");
        }
        for wrong in ["", "G", "4X", "-1G", "lots", "0"] {
            assert!(size(wrong).is_err(), "{wrong}");
        }
    }
}
