//! Failures by their cause, for reports.

use maud::{Markup, html};

use super::names::key_shown;

/// Causes with the keys of their files, the one with most files first. `failures` are keys of inputs and sentences.
pub(crate) fn causes<'a>(failures: &[(&'a str, &'a str)]) -> Vec<(&'a str, Vec<&'a str>)> {
    let mut causes: Vec<(&str, Vec<&str>)> = Vec::new();
    for (input, error) in failures {
        let cause = without_path(error, input);
        match causes.iter_mut().find(|(known, _)| *known == cause) {
            Some((_, files)) => files.push(input),
            None => causes.push((cause, vec![input])),
        }
    }
    causes.sort_by_key(|(_, files)| std::cmp::Reverse(files.len()));
    causes
}

/// A sentence without the name of the input that it begins with.
fn without_path<'a>(error: &'a str, input: &str) -> &'a str {
    let name = key_shown(input);
    let after = error.find(&name).map(|at| &error[at + name.len()..]);
    after.and_then(|rest| rest.strip_prefix(": ")).unwrap_or(error)
}

/// One cause with its files; a single file stands in its sentence.
pub(crate) fn in_page(cause: &str, files: &[&str]) -> Markup {
    html! {
        @if let [file] = files {
            p { b { (key_shown(file)) } ": " (cause) }
        } @else {
            p { b { (files.len()) " files" } ": " (cause) }
            ul { @for file in files { li { (key_shown(file)) } } }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn failures_stand_by_cause_the_most_frequent_first() {
        let failures = [
            ("a.dng", "/in/a.dng: is empty"),
            ("x/b.dng", "/in/x/b.dng: is damaged"),
            ("c.dng", "/in/c.dng: is damaged"),
            ("d.dng", "the disk is full"),
        ];
        let causes = causes(&failures);
        let found: Vec<(&str, usize)> = causes.iter().map(|(cause, files)| (*cause, files.len())).collect();
        assert_eq!(found, [("is damaged", 2), ("is empty", 1), ("the disk is full", 1)]);
        let page = in_page("is damaged", &causes[0].1).into_string();
        assert!(page.contains("2 files") && page.contains("x/b.dng") && page.contains("c.dng"), "{page}");
    }
}
