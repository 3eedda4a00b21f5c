//! Files that are none, links, and outputs that are whole or not there.

use super::*;

fn put(path: &Path, text: &str, tree: Option<&Tree>, overwrite: bool) -> Result<(), io::Error> {
    Output::open(path, tree)?.write(overwrite, |out| out.write_all(text.as_bytes())).map_err(|failed| {
        match failed {
            Failed::Io(e) | Failed::Other(e) => e,
        }
    })
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .unwrap()
        .map(|e| e.unwrap().file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

#[test]
fn an_output_is_the_old_one_or_the_whole_new_one() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a");
    put(&path, "one", None, false).unwrap();
    assert_eq!(put(&path, "two", None, false).unwrap_err().kind(), io::ErrorKind::AlreadyExists);
    assert_eq!(fs::read_to_string(&path).unwrap(), "one");
    put(&path, "two", None, true).unwrap();
    assert_eq!(fs::read_to_string(&path).unwrap(), "two");
    let output = Output::open(&path, None).unwrap();
    let failed = output.write(true, |out| out.write_all(b"half").and(Err(io::Error::other("no"))));
    assert!(matches!(failed, Err(Failed::Other(_))));
    assert_eq!(
        (fs::read_to_string(&path).unwrap().as_str(), names(folder.path())),
        ("two", vec!["a".to_owned()])
    );
}

#[test]
fn what_is_read_is_bounded() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a");
    fs::write(&path, [7; 100]).unwrap();
    assert_eq!(read_up_to(&path, 100).unwrap().len(), 100);
    let error = read_up_to(&path, 99).unwrap_err();
    assert!(matches!(&error, Error::Read { source, .. } if Special::of(source).is_some()), "{error}");
    // One that has no size before it is read, as a stream has none.
    assert!(bounded(io::repeat(0), 0, 1 << 20).is_err());
    // A file that only claims to be large costs nothing.
    File::create(&path).unwrap().set_len(LARGEST + 1).unwrap();
    assert!(read(&path).unwrap_err().to_string().contains("4096 MB"));
}

#[cfg(unix)]
mod on_unix {
    use super::*;
    use std::os::unix::fs::{PermissionsExt, symlink};
    use std::os::unix::net::UnixListener;

    fn tree(root: &Path) -> Tree {
        Tree { root: root.to_owned(), scratch: root.join(".scratch") }
    }

    #[test]
    fn what_is_no_file_is_not_opened() {
        let folder = tempfile::tempdir().unwrap();
        let socket = folder.path().join("s");
        let _listener = UnixListener::bind(&socket).unwrap();
        for (path, kind) in [(socket.as_path(), "a socket"), (Path::new("/dev/zero"), "a device")] {
            let error = read(path).unwrap_err().to_string();
            assert!(error.contains(kind), "{error}");
            assert!(append(path, b"", b"x").is_err() && put(path, "x", None, true).is_err());
        }
        assert!(read(folder.path()).unwrap_err().to_string().contains("folder"));
        assert!(!Path::new("/dev/zero").symlink_metadata().unwrap().is_file());
    }

    #[test]
    fn links_below_a_tree_are_not_followed() {
        let folder = tempfile::tempdir().unwrap();
        let (root, foreign) = (folder.path().join("out"), folder.path().join("foreign"));
        for folder in [&root, &foreign] {
            fs::create_dir(folder).unwrap();
        }
        let tree = tree(&root);
        put(&root.join("a/b/c.jpg"), "x", Some(&tree), false).unwrap();
        symlink(&foreign, root.join("sub")).unwrap();
        symlink("../../../foreign", root.join("a/b/sub")).unwrap();
        for path in
            ["sub/c.jpg", "a/b/sub/c.jpg", "sub/new/c.jpg", "../foreign/c.jpg", "a/../../foreign/c.jpg"]
        {
            assert!(put(&root.join(path), "x", Some(&tree), true).is_err(), "{path}");
            assert!(open_below(&root, &root.join(path)).is_err(), "{path}");
        }
        assert!(names(&foreign).is_empty());
        // A link that stands where the output goes is replaced itself, or stays.
        fs::write(foreign.join("kept"), "kept").unwrap();
        symlink(foreign.join("kept"), root.join("d.jpg")).unwrap();
        assert!(put(&root.join("d.jpg"), "x", Some(&tree), false).is_err());
        assert!(open_below(&root, &root.join("d.jpg")).is_err());
        put(&root.join("d.jpg"), "x", Some(&tree), true).unwrap();
        assert_eq!(fs::read_to_string(foreign.join("kept")).unwrap(), "kept");
        // The tree itself may be a link.
        symlink(&root, folder.path().join("linked")).unwrap();
        let linked = self::tree(&folder.path().join("linked"));
        put(&linked.root.join("e.jpg"), "x", Some(&linked), false).unwrap();
        assert!(root.join("e.jpg").is_file());
    }

    #[test]
    fn nothing_is_read_through_a_link_or_from_above() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path().join("root");
        fs::create_dir_all(root.join("in")).unwrap();
        fs::write(root.join("in/a"), "a").unwrap();
        fs::write(folder.path().join("secret"), "s").unwrap();
        symlink(folder.path().join("secret"), root.join("file")).unwrap();
        symlink(folder.path(), root.join("folder")).unwrap();
        assert_eq!(read_below(&root, &root.join("in/a")).unwrap(), b"a");
        for path in ["file", "folder/secret", "in/../../secret", "none", "none/a", "in"] {
            assert!(read_below(&root, &root.join(path)).is_err(), "{path}");
        }
        assert!(read_below(&root, &folder.path().join("secret")).is_err());
        assert!(!root.join("none").exists());
    }

    #[test]
    fn only_unfinished_outputs_are_cleared_away() {
        let folder = tempfile::tempdir().unwrap();
        let (root, foreign) = (folder.path().join("out"), folder.path().join("foreign"));
        fs::create_dir_all(root.join("u")).unwrap();
        fs::create_dir(&foreign).unwrap();
        for name in ["out/u/.darkroot-1.part", "out/u/mine.txt", "foreign/.darkroot-2.part"] {
            fs::write(folder.path().join(name), "x").unwrap();
        }
        symlink(&foreign, root.join("linked")).unwrap();
        let _ = clear_unfinished(&root, &root.join("u"));
        assert_eq!(names(&root.join("u")), ["mine.txt"]);
        assert!(clear_unfinished(&root, &root.join("linked")).is_err());
        assert_eq!(names(&foreign), [".darkroot-2.part"]);
        fs::remove_file(root.join("u/mine.txt")).unwrap();
        clear_unfinished(&root, &root.join("u")).unwrap();
        assert!(!root.join("u").exists() && clear_unfinished(&root, &root.join("u")).is_ok());
    }

    #[test]
    fn outputs_have_the_rights_that_the_umask_gives() {
        let folder = tempfile::tempdir().unwrap();
        let (ours, usual) = (folder.path().join("a"), folder.path().join("b"));
        put(&ours, "x", None, false).unwrap();
        File::create(&usual).unwrap();
        let mode = |path: &Path| path.metadata().unwrap().permissions().mode();
        assert_eq!(mode(&ours), mode(&usual));
    }
}
