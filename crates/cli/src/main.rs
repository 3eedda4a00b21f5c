//! The program `darkroot`: arguments to settings to the library.
//!
//! Data goes to stdout, words to stderr. Exit codes: 0 all done, 1 some file failed, 2 wrong usage, 3
//! what was judged is not good enough, 130 interrupted.

mod batch;
mod chart;
mod deadline;
mod decoder;
mod develop;
mod evaluate;
mod hint;
mod inspect;
mod interrupt;
mod open;
mod out;
mod picture;
mod profile;
mod progress;
mod recipe;
mod sandbox;
mod shell;
mod usage;
mod values;
mod verify;
mod version;

use std::process::ExitCode;

pub(crate) use out::say;

use clap::{Args, Parser, Subcommand};

/// Develop raw photographs with exposure-invariant colour.
#[derive(Debug, Parser)]
#[command(name = "darkroot", version, max_term_width = 100, arg_required_else_help = true)]
struct Cli {
    #[command(subcommand)]
    command: Command,

    #[command(flatten)]
    common: Common,
}

/// Options of every command.
#[derive(Debug, Clone, Copy, Args)]
struct Common {
    /// Say nothing but errors
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    quiet: bool,

    /// Say more: white balance, demosaicing, decoder
    #[arg(short, long, global = true)]
    verbose: bool,

    /// Number of threads; all cores if not given
    #[arg(long, global = true, value_name = "N", env = "DARKROOT_THREADS")]
    threads: Option<usize>,
}

/// Threads for each core at most: more only stand in each other's way.
const THREADS_OF_CORE: usize = 4;

impl Common {
    /// Starts the threads that every command has: one that hears interrupts, and those that develop.
    fn start_threads(self) {
        interrupt::handle();
        if let Some(threads) = self.threads {
            // Fails only when the pool exists already, which nothing before this makes.
            let _ = rayon::ThreadPoolBuilder::new().num_threads(threads).build_global();
        }
    }

    /// Takes no more threads than the machine can use, and says so.
    fn bound_threads(&mut self) {
        self.threads = self.threads.map(|asked| self.at_most(asked, "threads are used"));
    }

    /// A number of threads or processes that the machine can use: that which was asked for, or fewer, which is said.
    fn at_most(self, asked: usize, of: &str) -> usize {
        let cores = darkroot_batch::system::threads();
        let most = THREADS_OF_CORE * cores;
        if asked > most && !self.quiet {
            let machine = if cores == 1 { "one core".to_owned() } else { format!("{cores} cores") };
            say(format_args!("note: this machine has {machine}: {most} {of}, not {asked}"));
        }
        asked.min(most)
    }
}

#[derive(Debug, Subcommand)]
enum Command {
    Develop(develop::Develop),
    Batch(Box<batch::Batch>),
    Watch(Box<batch::Watch>),
    Open(open::Open),
    Inspect(inspect::Inspect),
    Recipe(recipe::Recipe),
    Profile(profile::Profile),
    Verify(verify::Verify),
    Chart(chart::Chart),
    Evaluate(evaluate::Evaluate),
    Completions(shell::Completions),
    Man(shell::Man),
    Worker(batch::Worker),
    Decoder(decoder::Decoder),
}

/// Exit code when some file failed.
const SOME_FAILED: u8 = 1;

/// How a command that ran to its end came out.
enum Outcome {
    Done,
    SomeFailed,
    /// It was told to stop before the end.
    Interrupted,
    /// What was judged is not good enough.
    Rejected,
}

fn main() -> ExitCode {
    let mut cli = usage::parse();
    darkroot::keep_decoders_quiet();
    cli.common.bound_threads();
    let common = cli.common;
    // Some commands give up what they do not need first, and must be the only thread then.
    let is_confined = matches!(
        cli.command,
        Command::Develop(_)
            | Command::Inspect(_)
            | Command::Chart(_)
            | Command::Verify(_)
            | Command::Worker(_)
            | Command::Decoder(_)
    );
    if !is_confined {
        common.start_threads();
    }
    let outcome = match cli.command {
        Command::Develop(command) => command.run(common),
        Command::Batch(command) => command.run(common),
        Command::Watch(command) => command.run(common),
        Command::Open(command) => command.run(common),
        Command::Inspect(command) => command.run(common),
        Command::Recipe(command) => command.run(),
        Command::Profile(command) => command.run(common),
        Command::Verify(command) => command.run(common),
        Command::Chart(command) => command.run(common),
        Command::Evaluate(command) => command.run(),
        Command::Completions(command) => command.run(),
        Command::Man(command) => command.run(),
        Command::Worker(command) => command.run(),
        Command::Decoder(command) => command.run(),
    };
    let outcome = outcome.and_then(|outcome| {
        out::finish()?;
        Ok(outcome)
    });
    match outcome {
        Ok(Outcome::Done) => ExitCode::SUCCESS,
        Ok(Outcome::SomeFailed) => ExitCode::from(SOME_FAILED),
        Ok(Outcome::Rejected) => ExitCode::from(3),
        Ok(Outcome::Interrupted) => ExitCode::from(130),
        // Whoever reads our output has seen enough.
        Err(error) if is_broken_pipe(&error) => ExitCode::SUCCESS,
        Err(error) if error.chain().any(|cause| out::NoStdout::within(cause).is_some()) => {
            crate::say(format_args!("error: {error}"));
            ExitCode::from(1)
        }
        Err(error) => {
            crate::say(format_args!("error: {}", chain(&error)));
            ExitCode::from(2)
        }
    }
}

/// An error with what it comes from, and their hints; what a message has said already is not said again.
fn chain(error: &anyhow::Error) -> String {
    let mut told = String::new();
    for cause in error.chain() {
        let text = cause.to_string();
        if told.is_empty() {
            told = hint::words(cause);
        } else if !told.contains(&text) {
            told += ": ";
            told += &hint::words(cause);
        } else if let Some(hint) = hint::of(cause).filter(|hint| !told.contains(hint.as_str())) {
            told += "; ";
            told += &hint;
        }
    }
    told
}

fn is_broken_pipe(error: &anyhow::Error) -> bool {
    let io = error.chain().find_map(|cause| cause.downcast_ref::<std::io::Error>());
    io.is_some_and(|e| e.kind() == std::io::ErrorKind::BrokenPipe)
}
