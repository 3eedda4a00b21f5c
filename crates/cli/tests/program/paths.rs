//! Nothing that stands in a file, and no link in a folder of outputs, leads a picture elsewhere.

use darkroot_photo::metadata::{Directory, Value, tag};

use super::*;

/// A DNG whose camera and date are these texts.
pub(crate) fn dng_by(make: &str, model: &str, date: &str) -> Vec<u8> {
    let mut metadata = darkroot_simulate::expose::metadata();
    metadata.set(Directory::Exif, tag::DATE_TIME_ORIGINAL, Value::Text(date.to_owned()));
    let exposure = Exposure { metadata, ..Exposure::default() };
    let mut capture = expose(&Scene::still_life(FRAME), &Camera::simulated_one(), &exposure);
    capture.camera.make = make.to_owned();
    capture.camera.model = model.to_owned();
    dng::write(&capture, dng::Storage::Uncompressed)
}

#[test]
fn a_camera_that_is_called_like_a_way_out_leads_nowhere() {
    for (make, model) in [("", ".."), ("..", ""), ("..", ".."), ("../..", "x"), ("/tmp", "x"), (".", ".")] {
        let desk = Desk::new();
        desk.put("in/a.dng", dng_by(make, model, "..:..:.. x"));
        desk.put("in/...dng", small_dng());
        let run = desk.run(&["develop", "in/a.dng", "-o", "below/out/{camera}/{date}/{day}/{stem}.jpg"]);
        assert_eq!(run.code, 0, "{}", run.err);
        assert_eq!(desk.names(), ["below", "in"]);
        assert_eq!(names(&desk.path("below")), ["out"], "{make} {model}");
        let run = desk.batch_of_names("{camera}/{year}/{month}/{day}/{stem}/x.{ext}");
        assert_eq!(run.code, 0, "{}", run.err);
        assert_eq!((desk.names().len(), names(&desk.path("in"))), (3, vec!["...dng".into(), "a.dng".into()]));
    }
}

impl Desk {
    fn batch_of_names(&self, template: &str) -> Run {
        self.run(&["batch", "in", "-o", "out", "--name", template, "--json"])
    }
}

#[cfg(unix)]
mod on_unix {
    use super::*;
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    use std::os::unix::fs::symlink;

    fn desk() -> Desk {
        let desk = Desk::new();
        desk.put("in/sub/a.dng", small_dng());
        desk.put("in/b.dng", small_dng());
        desk.put("foreign/kept.txt", "kept");
        std::fs::create_dir(desk.path("out")).unwrap();
        desk
    }

    #[test]
    fn no_batch_writes_through_a_link_in_its_folder() {
        let desk = desk();
        symlink("../foreign", desk.path("out/sub")).unwrap();
        let run = desk.run(&["batch", "in", "-o", "out"]);
        assert_eq!(run.code, 1, "{}", run.err);
        for word in ["out/sub is a symbolic link", "move it away"] {
            assert!(run.err.contains(word), "no `{word}` in {}", run.err);
        }
        assert_eq!(names(&desk.path("foreign")), ["kept.txt"]);
        assert!(desk.path("out/b.jpg").is_file());
        std::fs::remove_file(desk.path("out/sub")).unwrap();
        let again = desk.run(&["batch", "in", "-o", "out"]);
        assert!(again.code == 0 && desk.path("out/sub/a.jpg").is_file(), "{}", again.err);
    }

    #[test]
    fn a_linked_folder_of_journals_is_refused_and_loses_nothing() {
        for inner in ["unfinished/x", "unfinished/.darkroot-1.part", "journal.jsonl"] {
            let desk = desk();
            desk.put(&format!("foreign/{inner}"), "precious");
            symlink("../foreign", desk.path("out/.darkroot")).unwrap();
            let run = desk.run(&["batch", "in", "-o", "out"]);
            assert!(run.code == 2 && run.err.contains("symbolic link"), "{}", run.err);
            assert_eq!(desk.read(&format!("foreign/{inner}")), b"precious");
        }
        // One level below.
        let desk = desk();
        desk.put("foreign/.darkroot-1.part", "precious");
        std::fs::create_dir(desk.path("out/.darkroot")).unwrap();
        symlink("../../foreign", desk.path("out/.darkroot/unfinished")).unwrap();
        symlink("../../foreign/log", desk.path("out/.darkroot/journal-1-of-2.jsonl")).unwrap();
        desk.run(&["batch", "in", "-o", "out"]);
        assert_eq!(names(&desk.path("foreign")), [".darkroot-1.part", "kept.txt"]);
        let shard = desk.run(&["batch", "in", "-o", "out", "--shard", "1/2"]);
        assert!(shard.code == 2 && shard.err.contains("symbolic link"), "{}", shard.err);
        // What lies among unfinished outputs and is none stays.
        let desk = self::desk();
        desk.put("out/.darkroot/unfinished/mine.txt", "precious");
        desk.put("out/.darkroot/unfinished/.darkroot-7.part", "half");
        assert_eq!(desk.run(&["batch", "in", "-o", "out"]).code, 0);
        assert_eq!(names(&desk.path("out/.darkroot/unfinished")), ["mine.txt"]);
    }

    #[test]
    fn names_that_are_no_unicode_are_kept() {
        let desk = Desk::new();
        let name = |bytes: &[u8]| OsStr::from_bytes(bytes).to_owned();
        let (a, b) = (name(b"a\xff.dng"), name(b"a\xfe.dng"));
        std::fs::create_dir_all(desk.path("in").join(name(b"r\xe9"))).unwrap();
        for path in [desk.path("in").join(&a), desk.path("in").join(name(b"r\xe9")).join(&b)] {
            std::fs::write(path, small_dng()).unwrap();
        }
        let template = desk
            .command(&["develop", "-o", "t/{parent}-{stem}.{ext}"])
            .arg(desk.path("in").join(&a))
            .output();
        assert!(template.unwrap().status.success());
        assert!(desk.path("t").join(name(b"in-a\xff.jpg")).is_file());
        let output = desk.command(&["develop", "in", "-o"]).arg(name(b"o\xff.png")).output().unwrap();
        assert_eq!(output.status.code(), Some(1));
        let run =
            desk.run(&["batch", "in", "-o", "out", "--json", "--report", "r.json", "--report", "r.html"]);
        assert_eq!(run.code, 0, "{}", run.err);
        assert!(desk.path("out").join(name(b"a\xff.jpg")).is_file());
        assert!(desk.path("out").join(name(b"r\xe9")).join(name(b"a\xfe.jpg")).is_file());
        assert!(
            run.err.contains(r"a\xff.jpg") && run.out.contains(r#""output":"a\u0000ff.jpg""#),
            "{}",
            run.out
        );
        let page = String::from_utf8(desk.read("r.html")).unwrap();
        assert!(page.contains("out/a%FF.jpg"), "{page}");
        // The journal knows them again.
        let again = desk.run(&["batch", "in", "-o", "out", "--json"]);
        assert!(again.out.contains(r#""unchanged":2"#) && again.out.contains(r#""done":0"#), "{}", again.out);
    }
}
