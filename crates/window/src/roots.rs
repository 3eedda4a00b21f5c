//! The folders that were opened, and names of files in them.
//!
//! A file's name is the number of its folder and the path below it, `0/roll/DSC_0001.NEF`, as [`path_text`] writes paths. No
//! name leads out of a folder: `..` is none, and no link below a folder is followed.

use std::path::{Component, Path, PathBuf};

use darkroot::{files, path_text, shown};
use darkroot_batch::Search;

use crate::WindowError;
use crate::fault::Fault;

/// The folders that were opened.
#[derive(Debug, Clone)]
pub(crate) struct Roots {
    folders: Vec<PathBuf>,
    /// What is shown: folders, or files alone.
    inputs: Vec<PathBuf>,
    /// The one file that was opened, if it was one.
    pub(crate) only: Option<String>,
}

/// A file or folder below a folder that was opened.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Place {
    /// The folder that was opened.
    pub(crate) root: PathBuf,
    /// The file.
    pub(crate) path: PathBuf,
}

impl Roots {
    /// Of folders and files.
    pub(crate) fn of(inputs: &[PathBuf]) -> Result<Self, WindowError> {
        let mut roots = Self { folders: Vec::new(), inputs: Vec::new(), only: None };
        for input in inputs {
            let failed = |reason| WindowError::Input { path: input.clone(), reason };
            let path = input.canonicalize().map_err(failed)?;
            let folder = if path.is_dir() { path.clone() } else { path.parent().unwrap_or(&path).to_owned() };
            // A folder that cannot be read is better told now.
            std::fs::read_dir(&folder).map_err(failed)?;
            if !roots.folders.contains(&folder) {
                roots.folders.push(folder);
            }
            roots.inputs.push(path);
        }
        if let [path] = &roots.inputs[..] {
            roots.only = path.is_file().then(|| roots.name(path)).flatten();
        }
        Ok(roots)
    }

    /// The folders.
    pub(crate) fn folders(&self) -> &[PathBuf] {
        &self.folders
    }

    /// Where files are looked for.
    pub(crate) fn search(&self) -> Search {
        let inputs = self.inputs.iter().map(|path| path_text::text(path)).collect();
        Search { inputs, ..Search::default() }
    }

    /// The name of a path, if it is below one of the folders.
    pub(crate) fn name(&self, path: &Path) -> Option<String> {
        let below = |(i, root): (usize, &PathBuf)| Some((i, path.strip_prefix(root).ok()?));
        let (i, rest) =
            self.folders.iter().enumerate().filter_map(below).min_by_key(|b| b.1.components().count())?;
        Some(format!("{i}/{}", path_text::text(rest)))
    }

    /// The place of a name; whether something is there is not looked at.
    pub(crate) fn place(&self, name: &str) -> Result<Place, Fault> {
        let refused =
            || Fault::asked(format!("{}: lies in no folder that was opened", darkroot::quoted(name)));
        let (number, rest) = name.split_once('/').unwrap_or((name, ""));
        let root = number.parse::<usize>().ok().and_then(|i| self.folders.get(i)).ok_or_else(refused)?;
        let rest = path_text::path(rest);
        if !rest.components().all(|part| matches!(part, Component::Normal(_))) {
            return Err(refused());
        }
        Ok(Place { root: root.clone(), path: root.join(rest) })
    }

    /// The place of a file that is there, and to which no link leads.
    pub(crate) fn file(&self, name: &str) -> Result<Place, Fault> {
        let place = self.place(name)?;
        place.check()?;
        match std::fs::metadata(&place.path) {
            Ok(data) if data.is_file() => Ok(place),
            Ok(_) => Err(Fault::asked(format!("{}: is no file", shown(&place.path)))),
            Err(e) => Err(Fault::missing(format!("{}: cannot be read: {e}", shown(&place.path)))),
        }
    }

    /// Whether a path lies in one of the folders, with no link on the way.
    pub(crate) fn has(&self, path: &Path) -> bool {
        self.name(path).is_some_and(|name| self.file(&name).is_ok())
    }
}

impl Place {
    /// The bytes of the file.
    pub(crate) fn read(&self) -> Result<Vec<u8>, darkroot::Error> {
        files::read_below(&self.root, &self.path)
    }

    /// Its first bytes, at most so many.
    pub(crate) fn read_start(&self, most: u64) -> Result<Vec<u8>, darkroot::Error> {
        files::read_start_below(&self.root, &self.path, most)
    }

    /// Whether a link lies on the way from the folder.
    pub(crate) fn check(&self) -> Result<(), Fault> {
        let mut at = self.root.clone();
        for part in self.path.strip_prefix(&self.root).unwrap_or(Path::new("")).components() {
            at.push(part);
            if at.is_symlink() {
                return Err(Fault::asked(format!(
                    "{}: is a symbolic link, and the window follows none; open the folder that it leads to",
                    shown(&at)
                )));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_lead_nowhere_else() {
        let folder = tempfile::tempdir().unwrap();
        let base = folder.path().canonicalize().unwrap();
        std::fs::create_dir_all(base.join("open/roll")).unwrap();
        for file in ["secret.nef", "open/a.nef", "open/roll/b ü.nef"] {
            std::fs::write(base.join(file), "x").unwrap();
        }
        let roots = Roots::of(&[base.join("open"), base.join("open/roll")]).unwrap();
        assert_eq!(roots.name(&base.join("open/roll/b ü.nef")).as_deref(), Some("1/b ü.nef"));
        assert_eq!(roots.name(&base.join("secret.nef")), None);
        for name in ["0/a.nef", "0/roll/b ü.nef", "1/b ü.nef"] {
            assert_eq!(roots.file(name).unwrap().read().unwrap(), b"x", "{name}");
        }
        let absolute = format!("0/{}", base.join("secret.nef").to_str().unwrap());
        for name in [
            "",
            "0",
            "0/",
            "2/a.nef",
            "0/../secret.nef",
            "0/./../secret.nef",
            "-1/a.nef",
            "0/roll",
            &absolute,
        ] {
            assert!(roots.file(name).is_err(), "{name}");
        }
        #[cfg(unix)]
        {
            use std::os::unix::fs::symlink;
            symlink(base.join("secret.nef"), base.join("open/link.nef")).unwrap();
            symlink(&base, base.join("open/up")).unwrap();
            for name in ["0/link.nef", "0/up/secret.nef"] {
                let fault = roots.file(name).unwrap_err();
                assert!(fault.words.contains("symbolic link"), "{}", fault.words);
                assert!(roots.place(name).unwrap().read().is_err());
            }
        }
    }
}
