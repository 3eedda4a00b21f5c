//! Names of outputs.

use super::*;

fn outputs(inputs: &[&str], target: Target) -> Result<Vec<String>, NamingError> {
    let inputs: Vec<_> = inputs.iter().map(|i| (PathBuf::from(i), Format::Jpeg)).collect();
    let jobs = plan_outputs(&inputs, &target)?;
    Ok(jobs.iter().map(|j| j.output.display().to_string()).collect())
}

fn target(text: &str) -> Target {
    Target::parse(text.as_ref()).unwrap()
}

#[test]
fn outputs_lie_beside_their_inputs_or_in_the_folder() {
    assert_eq!(outputs(&["a/DSC_1.NEF"], Target::Beside).unwrap(), ["a/DSC_1.jpg"]);
    assert_eq!(outputs(&["a/x.v2.dng"], target("out/")).unwrap(), ["out/x.v2.jpg"]);
}

#[test]
fn templates_are_filled_in() {
    let names = target("out/{parent}-{stem}-{seq}.{ext}");
    assert_eq!(
        outputs(&["roll/1.nef", "roll/2.nef"], names).unwrap(),
        ["out/roll-1-0001.jpg", "out/roll-2-0002.jpg"]
    );
    let wrong = outputs(&["1.nef"], target("{name}.jpg")).unwrap_err();
    assert!(wrong.to_string().contains("{stem}"), "{wrong}");
}

#[test]
fn each_input_has_the_ending_of_its_own_format() {
    let inputs = [("x.nef".into(), Format::Jpeg), ("x.dng".into(), Format::Png)];
    let jobs = plan_outputs(&inputs, &target("out/{stem}.{ext}")).unwrap();
    assert_eq!((&jobs[0].output, &jobs[1].output), (&"out/x.jpg".into(), &"out/x.png".into()));
}

#[test]
fn two_inputs_for_one_output_are_found_before_anything_is_written() {
    for (a, b) in [("x.nef", "x.dng"), ("x.nef", "X.NEF")] {
        let error = outputs(&[a, b], Target::Beside).unwrap_err();
        assert!(matches!(error, NamingError::Collision { .. }), "{error}");
    }
    assert!(outputs(&["a.nef", "b.nef"], Target::File("c.jpg".into())).is_err());
}

#[test]
fn what_has_no_name_gives_none() {
    for input in ["-", "/dev/stdin", "/dev/fd/3", "/proc/self/fd/0"] {
        for target in [Target::Beside, target("out/"), target("{stem}.{ext}")] {
            assert!(matches!(outputs(&[input], target), Err(NamingError::NoName { .. })), "{input}");
        }
        assert_eq!(outputs(&[input], target("a.jpg")).unwrap(), ["a.jpg"]);
        assert_eq!(outputs(&[input], target("-")).unwrap(), ["-"]);
    }
    assert!(matches!(outputs(&["a.nef", "b.nef"], target("-")), Err(NamingError::Stream { count: 2 })));
}

#[test]
fn dates_are_dates() {
    assert_eq!(date("2026:05:01 10:00:00").as_deref(), Some("2026-05-01"));
    for wrong in ["", "2026", "2026:05:..", "..........", "2026/05/01 x", "20260501:00"] {
        assert_eq!(date(wrong), None, "{wrong}");
    }
}

#[cfg(unix)]
#[test]
fn names_that_are_no_unicode_are_kept_and_told_apart() {
    use std::os::unix::ffi::OsStrExt;
    let inputs =
        [&b"a/\xff.nef"[..], b"a/\xfe.nef"].map(|b| (PathBuf::from(OsStr::from_bytes(b)), Format::Jpeg));
    for target in [Target::Beside, target("a/"), target("a/{stem}.{ext}")] {
        let jobs = plan_outputs(&inputs, &target).unwrap();
        assert_eq!(jobs[0].output.as_os_str().as_bytes(), b"a/\xff.jpg");
        assert_eq!(jobs[1].output.as_os_str().as_bytes(), b"a/\xfe.jpg");
    }
    assert!(Target::parse(OsStr::from_bytes(b"\xff/{stem}.jpg")).is_err());
}

#[test]
fn an_output_over_its_input_is_refused() {
    let error = outputs(&["x.jpg"], Target::Beside).unwrap_err();
    assert!(matches!(error, NamingError::OverInput { .. }), "{error}");
}
