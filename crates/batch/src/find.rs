//! Which files a batch is about.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use darkroot::path_text;
use walkdir::{DirEntry, WalkDir};

use super::facts::{FOLDER, modified};
use super::filter::{Filter, FindError, MATCHING};
use super::source_fault::SourceFault;

/// What a person names as input.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Search {
    /// Folders, files and patterns (`shoot/**/*.NEF`), as [`path_text`] writes them.
    pub inputs: Vec<String>,
    /// Whether only the folders themselves are read, not those in them.
    pub flat: bool,
    /// Take files whose path below its root or whose name matches one of these, instead of all raw files.
    pub include: Vec<String>,
    /// Leave these out; folders too.
    pub exclude: Vec<String>,
    /// Whether symbolic links are followed.
    pub follow_links: bool,
    /// Whether hidden files and folders (with a leading dot) are taken.
    pub hidden: bool,
    /// Whether keys begin with their folder's name even if there is only one folder.
    pub apart: bool,
}

/// A file to develop.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Source {
    /// Where it is.
    pub path: PathBuf,
    /// Its path below its root, with forward slashes, as [`path_text`] writes it: what the output's place follows from.
    pub key: String,
    /// Size in bytes.
    pub size: u64,
    /// Time of its last change, nanoseconds since 1970.
    pub modified: i64,
}

/// What was found.
#[derive(Debug, Default)]
pub struct Sources {
    /// The files, ordered by root and path.
    pub files: Vec<Source>,
    /// What could not be read: folders without permission, broken links.
    pub faults: Vec<SourceFault>,
    /// Folders that were searched.
    pub folders: Vec<PathBuf>,
}

/// Looks up all inputs. `out` and what is below is passed over.
///
/// With one folder as input, keys are paths below it; with several, each file's key begins with its folder's name,
/// so that their trees stay apart. Files that are named themselves have their name as key.
///
/// # Errors
/// An input that is not there, a wrong pattern.
pub fn find(search: &Search, out: &Path) -> Result<Sources, FindError> {
    let mut found = Sources::default();
    let filter = Filter::new(&search.include, &search.exclude, out)?;
    let roots = expand(search)?;
    let folders = roots.iter().filter(|r| r.is_dir()).count();
    let mut seen = HashSet::new();
    for root in &roots {
        if root.is_dir() {
            let prefix = if folders > 1 || search.apart { folder_name(root) } else { String::new() };
            found.folders.push(root.clone());
            walk(root, &prefix, search, &filter, &mut seen, &mut found);
        } else if filter.keeps(&file_name(root), &file_name(root)) {
            take(root, file_name(root), &mut seen, &mut found);
        }
    }
    Ok(found)
}

/// Inputs with patterns replaced by what they match.
fn expand(search: &Search) -> Result<Vec<PathBuf>, FindError> {
    let mut roots = Vec::new();
    for input in &search.inputs {
        let path = path_text::path(input);
        if path.exists() {
            roots.push(path);
            continue;
        }
        let missing = || FindError::Missing { input: input.clone() };
        if !input.contains(['*', '?', '[']) {
            return Err(missing());
        }
        let matches = glob::glob_with(input, MATCHING)
            .map_err(|e| FindError::Pattern { pattern: input.clone(), reason: e })?;
        let before = roots.len();
        // Folders that match bring their files by the pattern itself or not at all.
        roots.extend(matches.flatten().filter(|p| p.is_file()));
        if roots.len() == before {
            return Err(missing());
        }
    }
    Ok(roots)
}

fn walk(
    root: &Path,
    prefix: &str,
    search: &Search,
    filter: &Filter,
    seen: &mut HashSet<PathBuf>,
    found: &mut Sources,
) {
    let depth = if search.flat { 1 } else { usize::MAX };
    let key = |entry: &DirEntry| {
        let below = entry.path().strip_prefix(root).unwrap_or(entry.path());
        let below: Vec<String> = below.iter().map(|part| path_text::text(Path::new(part))).collect();
        let below = below.join("/");
        if prefix.is_empty() { below } else { format!("{prefix}/{below}") }
    };
    let enter = |entry: &DirEntry| {
        if entry.depth() == 0 {
            return true;
        }
        let name = entry.file_name().to_string_lossy();
        let hidden = name.starts_with('.') && !search.hidden;
        let ours = name == FOLDER;
        if hidden || ours {
            return false;
        }
        let folder = entry.file_type().is_dir();
        !(folder && (filter.is_out(entry.path()) || filter.excludes(&key(entry), &name)))
    };
    let entries = WalkDir::new(root)
        .max_depth(depth)
        .follow_links(search.follow_links)
        .follow_root_links(true)
        .sort_by_file_name();
    for entry in entries.into_iter().filter_entry(enter) {
        let entry = match entry {
            Ok(entry) => entry,
            Err(error) => {
                found.faults.push(error.into());
                continue;
            }
        };
        if !entry.file_type().is_file() {
            continue;
        }
        let name = entry.file_name().to_string_lossy();
        let key = key(&entry);
        if filter.takes(&key, &name) {
            take(entry.path(), key, seen, found);
        }
    }
}

fn take(path: &Path, key: String, seen: &mut HashSet<PathBuf>, found: &mut Sources) {
    let real = std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    if !seen.insert(real) {
        return;
    }
    match std::fs::metadata(path) {
        Ok(data) => {
            found.files.push(Source {
                path: path.to_owned(),
                key,
                size: data.len(),
                modified: modified(&data),
            });
        }
        Err(error) => found.faults.push(darkroot::Error::read(path, error).into()),
    }
}

/// The last part of the path.
fn file_name(path: &Path) -> String {
    path.file_name().map(|name| path_text::text(Path::new(name))).unwrap_or_default()
}

/// A folder's own name, also for "." and "..".
fn folder_name(path: &Path) -> String {
    let real = std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    file_name(&real)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tree(files: &[&str]) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        for file in files {
            let path = folder.path().join(file);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, b"x").unwrap();
        }
        folder
    }

    fn keys(root: &Path, change: impl FnOnce(&mut Search)) -> Vec<String> {
        let mut search = Search { inputs: vec![root.to_str().unwrap().to_owned()], ..Search::default() };
        change(&mut search);
        let found = find(&search, &root.join("out")).unwrap();
        assert!(found.faults.is_empty(), "{:?}", found.faults);
        found.files.into_iter().map(|s| s.key).collect()
    }

    #[test]
    fn folders_give_their_raw_files_in_order() {
        let files = ["b/2.NEF", "b/1.nef", "a.dng", "notes.txt", ".hidden/x.nef", "b/.x.nef", "out/o.dng"];
        let folder = tree(&files);
        assert_eq!(keys(folder.path(), |_| {}), ["a.dng", "b/1.nef", "b/2.NEF"]);
        assert_eq!(keys(folder.path(), |s| s.flat = true), ["a.dng"]);
        let hidden = keys(folder.path(), |s| s.hidden = true);
        assert_eq!(hidden, [".hidden/x.nef", "a.dng", "b/.x.nef", "b/1.nef", "b/2.NEF"]);
    }

    #[test]
    fn patterns_choose_and_leave_out() {
        let folder = tree(&["a.dng", "b/1.nef", "b/2.nef", "c/3.nef", "c/4.tif"]);
        assert_eq!(
            keys(folder.path(), |s| s.include = vec!["*.NEF".into()]),
            ["b/1.nef", "b/2.nef", "c/3.nef"]
        );
        assert_eq!(keys(folder.path(), |s| s.include = vec!["c/*".into()]), ["c/3.nef", "c/4.tif"]);
        assert_eq!(keys(folder.path(), |s| s.exclude = vec!["b".into(), "a.*".into()]), ["c/3.nef"]);
        let pattern = format!("{}/**/*.nef", folder.path().display());
        assert_eq!(keys(folder.path(), |s| s.inputs = vec![pattern]), ["1.nef", "2.nef", "3.nef"]);
    }

    #[test]
    fn several_folders_keep_their_names_and_files_count_once() {
        let folder = tree(&["a/1.nef", "b/1.nef"]);
        let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
        let inputs = vec![at("a"), at("b"), at("b/1.nef")];
        assert_eq!(keys(folder.path(), |s| s.inputs = inputs), ["a/1.nef", "b/1.nef"]);
    }

    #[test]
    fn what_is_not_there_is_said() {
        let search = Search { inputs: vec!["/nowhere/at/all".into()], ..Search::default() };
        assert!(find(&search, Path::new("o")).unwrap_err().to_string().contains("/nowhere/at/all"));
        let search = Search { inputs: vec!["/nowhere/*.nef".into()], ..Search::default() };
        assert!(find(&search, Path::new("o")).is_err());
        let search = Search { inputs: vec![".".into()], exclude: vec!["a[".into()], ..Search::default() };
        assert!(matches!(find(&search, Path::new("o")), Err(FindError::Pattern { .. })));
    }

    #[cfg(unix)]
    #[test]
    fn links_are_followed_only_when_asked_for() {
        let folder = tree(&["real/1.nef", "in/2.nef"]);
        let link = |to: &str, at: &str| {
            std::os::unix::fs::symlink(folder.path().join(to), folder.path().join(at)).unwrap();
        };
        link("real", "in/linked");
        link("real/1.nef", "in/one.nef");
        let root = folder.path().join("in");
        assert_eq!(keys(&root, |_| {}), ["2.nef"]);
        assert_eq!(keys(&root, |s| s.follow_links = true), ["2.nef", "linked/1.nef"]);
        link("in", "in/round");
        let search = Search {
            inputs: vec![root.to_str().unwrap().to_owned()],
            follow_links: true,
            ..Search::default()
        };
        let found = find(&search, Path::new("o")).unwrap();
        assert!(found.faults.iter().any(|f| f.to_string().contains("round")), "{:?}", found.faults);
    }
}
