//! Help, completions and manual pages.

use super::*;

const COMMANDS: [&str; 5] = ["develop", "inspect", "recipe", "completions", "man"];

/// Long options of a command, as its help has them.
fn options(desk: &Desk, command: &str) -> Vec<String> {
    let help = desk.run(&[command, "--help"]);
    assert_eq!((help.code, help.err.as_str()), (0, ""));
    let mut found: Vec<String> = help
        .out
        .lines()
        .map(str::trim_start)
        .filter(|line| line.starts_with('-'))
        .filter_map(|line| line.split_whitespace().find(|word| word.starts_with("--")))
        .map(|word| word.split([',', '[']).next().unwrap_or(word).to_owned())
        .collect();
    found.sort();
    found.dedup();
    found
}

#[test]
fn help_goes_to_stdout_and_names_every_command_and_option() {
    let desk = Desk::new();
    for arguments in [&["--help"][..], &["help"], &["-h"]] {
        let help = desk.run(arguments);
        assert_eq!((help.code, help.err.as_str()), (0, ""), "{arguments:?}");
        assert!(COMMANDS.iter().all(|command| help.out.contains(command)), "{}", help.out);
    }
    let develop = options(&desk, "develop");
    for option in [
        "--output",
        "--format",
        "--overwrite",
        "--white-balance",
        "--look",
        "--profile",
        "--json",
        "--threads",
    ] {
        assert!(develop.iter().any(|o| o == option), "{option} is not in {develop:?}");
    }
    assert!(develop.len() > 15 && options(&desk, "inspect").len() > 5);
}

#[test]
fn the_version_goes_to_stdout() {
    let run = Desk::new().run(&["--version"]);
    assert_eq!((run.code, run.out), (0, format!("darkroot {}\n", env!("CARGO_PKG_VERSION"))));
}

#[test]
fn the_long_version_says_whose_measurements_are_in_the_program() {
    let run = Desk::new().run(&["--version", "--long"]);
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(run.out.starts_with(&format!("darkroot {}\n", env!("CARGO_PKG_VERSION"))));
    for word in ["Lesser General Public License", "lensfun", "by-sa/3.0", "rawtoaces", "Apache License"] {
        assert!(run.out.contains(word), "{word}");
    }
}

#[test]
fn without_a_command_there_is_help_on_stderr() {
    let run = Desk::new().run(&[]);
    assert_eq!((run.code, run.out.as_str()), (2, ""));
    assert!(run.err.contains("develop") && run.err.contains("inspect"), "{}", run.err);
}

#[test]
fn completions_know_every_option() {
    let desk = Desk::new();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let run = desk.run(&["completions", shell]);
        assert_eq!((run.code, run.err.as_str()), (0, ""), "{shell}");
        for command in COMMANDS {
            assert!(run.out.contains(command), "{shell}: {command}");
            for option in options(&desk, command) {
                let name = option.trim_start_matches("--");
                let written = if shell == "fish" { format!("-l {name}") } else { option.clone() };
                assert!(run.out.contains(&written), "{shell}: {command} {option}");
            }
        }
    }
}

#[cfg(unix)]
#[test]
#[cfg_attr(not(has_bash), ignore = "there is no bash")]
fn the_completions_for_bash_are_valid_bash() {
    let desk = Desk::new();
    desk.put("completions", desk.run(&["completions", "bash"]).out);
    let checked = Command::new("bash").arg("-n").arg(desk.path("completions")).output().unwrap();
    assert!(checked.status.success(), "{}", String::from_utf8_lossy(&checked.stderr));
}

#[test]
fn there_is_a_manual_page_for_each_command_with_every_option() {
    let desk = Desk::new();
    let run = desk.run(&["man", "pages"]);
    assert_eq!((run.code, run.out.as_str(), run.err.as_str()), (0, "", ""));
    let page =
        |name: &str| String::from_utf8(desk.read(&format!("pages/{name}"))).unwrap().replace("\\-", "-");
    assert!(page("darkroot.1").contains(".TH"));
    for command in COMMANDS {
        let page = page(&format!("darkroot-{command}.1"));
        for option in options(&desk, command) {
            assert!(page.contains(&option), "{command} {option}");
        }
    }
    let printed = desk.run(&["man"]);
    assert!(printed.code == 0 && printed.out.contains(".TH") && printed.err.is_empty());
}

#[test]
fn a_folder_for_manual_pages_that_cannot_be_made_is_named() {
    let desk = Desk::new();
    desk.put("file", "");
    desk.fails(2, &["man", "file/pages"], &["file/pages"]);
}
