//! `darkroot open`.

use std::io::Write;
use std::net::{IpAddr, Ipv4Addr};
use std::path::PathBuf;
use std::process::{Command, Stdio};

use anyhow::{Context, Result};
use clap::Args;
use darkroot::ProfileStore;
use darkroot_batch::{CrewOptions, system};
use darkroot_raw::elsewhere::decode_at;
use darkroot_window::{Apart, Options, Window};

use crate::sandbox::Sandbox;
use crate::{Common, Outcome};

/// Look at photographs in the browser: contact sheet, developing, charts, batches
///
/// Prints the address of the page, opens it, and serves it until it is interrupted. Only this machine can reach it, and only
/// who knows the address. Files are read and written in the folders that were opened, and in your folder of profiles.
#[derive(Debug, Args)]
pub(crate) struct Open {
    /// Folders and raw files to show
    #[arg(value_name = "FOLDER|FILE", default_value = ".")]
    inputs: Vec<PathBuf>,

    /// Only print the address
    #[arg(long)]
    no_browser: bool,

    /// Port to listen on; any that is free if not given
    #[arg(long, value_name = "PORT", default_value_t = 0, hide_default_value = true)]
    port: u16,

    /// Address to listen on; others than 127.0.0.1 can be reached by other machines, unencrypted
    #[arg(long, value_name = "ADDRESS", default_value_t = IpAddr::V4(Ipv4Addr::LOCALHOST))]
    listen: IpAddr,

    #[command(flatten)]
    sandbox: Sandbox,
}

impl Open {
    pub(crate) fn run(self, common: Common) -> Result<Outcome> {
        let program = std::env::current_exe().context("this program cannot find itself to start workers")?;
        let threads = common.threads.unwrap_or_else(system::threads).max(1);
        let mut worker = vec!["worker".into()];
        self.sandbox.say(common);
        if self.sandbox.is_on() {
            decode_at(Apart::new(program.clone(), vec!["decoder".into()]));
        } else {
            worker.push("--no-sandbox".into());
        }
        let crew = CrewOptions { jobs: threads, threads, ..CrewOptions::new(program, worker) };
        let store = ProfileStore::of_user();
        for fault in &store.faults {
            crate::say(format_args!("warning: {fault}; it is not used"));
        }
        let window = Window::open(Options {
            listen: self.listen,
            port: self.port,
            store,
            profiles: ProfileStore::user_folder(),
            crew,
            ..Options::of(self.inputs)
        })?;
        if window.is_open_to_others() {
            crate::say(format_args!(
                "warning: other machines can reach this window, and what goes to and fro is not encrypted: whoever reads the \
                 address on the way can use it. `ssh -L 8377:localhost:PORT` is safer"
            ));
        }
        let address = window.address();
        writeln!(crate::out::ours(), "{address}")?;
        crate::out::finish()?;
        if !self.no_browser && !start_browser(&address) && !common.quiet {
            crate::say(format_args!("no browser could be started: open the address yourself"));
        }
        window.serve()?;
        Ok(Outcome::Done)
    }
}

/// Opens an address as the system opens links.
fn start_browser(address: &str) -> bool {
    let (program, before): (&str, &[&str]) = if cfg!(target_os = "macos") {
        ("open", &[])
    } else if cfg!(windows) {
        ("rundll32", &["url.dll,FileProtocolHandler"])
    } else {
        ("xdg-open", &[])
    };
    let quiet = Stdio::null;
    let started = Command::new(program)
        .args(before)
        .arg(address)
        .stdin(quiet())
        .stdout(quiet())
        .stderr(quiet())
        .spawn();
    match started {
        Ok(mut child) => {
            // It ends when it has told the browser; nobody need wait for that.
            std::thread::spawn(move || child.wait());
            true
        }
        Err(_) => false,
    }
}
