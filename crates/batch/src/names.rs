//! Where outputs of a batch go below the output folder.

use std::collections::HashMap;
use std::path::{Component, Path};

use darkroot::naming::NamingError;
use darkroot::naming::template;
pub use darkroot::naming::template::{Fields, needs_headers, needs_number};
use darkroot::{path_text, shown};

/// The tree of the inputs, mirrored.
pub const MIRRORED: &str = "{folder}/{stem}.{ext}";

/// Fills in a template: a path below the output folder, with forward slashes, as [`path_text`] writes it.
///
/// # Errors
/// A placeholder that does not exist, a path that leaves the output folder.
pub fn fill(template: &str, fields: &Fields) -> Result<String, NamingError> {
    let outside = || NamingError::Outside { template: template.to_owned() };
    if template.starts_with('/') {
        return Err(outside());
    }
    let mut parts = Vec::new();
    for part in template::fill(template, fields)?.components() {
        match part {
            Component::Normal(part) => parts.push(path_text::text(Path::new(part))),
            // A file that lies in no folder has none to name.
            Component::RootDir | Component::CurDir => {}
            Component::ParentDir | Component::Prefix(_) => return Err(outside()),
        }
    }
    if parts.is_empty() { Err(outside()) } else { Ok(parts.join("/")) }
}

/// What the name of a file's output is made of, from the file's path below its root.
pub fn fields(key: &str) -> Fields {
    let path = path_text::path(key);
    Fields {
        folder: Some(path.parent().unwrap_or(Path::new("")).to_owned()),
        name: path.file_name().unwrap_or_default().to_owned(),
        ..Fields::default()
    }
}

/// A path below a root, for people.
pub(crate) fn key_shown(key: &str) -> String {
    shown(&path_text::path(key))
}

/// The ending of a file, lower case, without the dot.
pub(crate) fn ending(key: &str) -> String {
    key.rsplit_once('.').map_or_else(String::new, |(_, ending)| ending.to_lowercase())
}

/// Two or more inputs for one output, also where names differ only in case.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}: would be written from more than one input ({})", key_shown(output), self.inputs_shown())]
pub struct Collision {
    /// The common output.
    pub output: String,
    /// Keys of its inputs.
    pub inputs: Vec<String>,
}

impl Collision {
    /// Its inputs, for people.
    pub(crate) fn inputs_shown(&self) -> String {
        self.inputs.iter().map(|key| key_shown(key)).collect::<Vec<_>>().join(", ")
    }
}

/// Finds outputs that collide. `outputs` are pairs of input and output.
pub fn collisions(outputs: &[(String, String)]) -> Vec<Collision> {
    let mut by_output: HashMap<String, Vec<usize>> = HashMap::new();
    for (i, (_, output)) in outputs.iter().enumerate() {
        by_output.entry(output.to_lowercase()).or_default().push(i);
    }
    let mut groups: Vec<Vec<usize>> = by_output.into_values().filter(|g| g.len() > 1).collect();
    groups.sort();
    let collision = |group: Vec<usize>| Collision {
        output: outputs[group[0]].1.clone(),
        inputs: group.iter().map(|&i| outputs[i].0.clone()).collect(),
    };
    groups.into_iter().map(collision).collect()
}

/// Resolves collisions: one input keeps the name, the others get the ending of their file behind the stem
/// ("DSC_1-dng.jpg"), and a number where that is not enough. `owner` tells which input an output was made from
/// before; it keeps its name, so a second run names as the first did.
pub fn resolve(outputs: &mut [(String, String)], owner: impl Fn(&str) -> Option<String>) {
    let mut taken: HashMap<String, usize> = HashMap::new();
    let mut waiting = Vec::new();
    for (i, (input, output)) in outputs.iter().enumerate() {
        let owned = owner(output);
        match taken.get(&output.to_lowercase()).copied() {
            None => {
                taken.insert(output.to_lowercase(), i);
            }
            Some(other) if owned.as_ref() == Some(input) => {
                waiting.push(other);
                taken.insert(output.to_lowercase(), i);
            }
            Some(_) => waiting.push(i),
        }
    }
    for i in waiting {
        let (input, output) = &outputs[i];
        let ending = ending(input);
        let (stem, ext) = output.rsplit_once('.').unwrap_or((output, ""));
        let name = |n: usize| match n {
            1 => format!("{stem}-{ending}.{ext}"),
            n => format!("{stem}-{ending}-{n}.{ext}"),
        };
        let free = (1..).map(name).find(|name| !taken.contains_key(&name.to_lowercase()));
        if let Some(free) = free {
            taken.insert(free.to_lowercase(), i);
            outputs[i].1 = free;
        }
    }
}

/// An input that is not developed, because another one makes its picture.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LeftOut {
    /// Key of the input.
    pub input: String,
    /// Key of the one that is developed.
    pub instead: String,
    /// The picture of both, below the output folder.
    pub output: String,
}

impl LeftOut {
    /// In words.
    pub fn words(&self) -> String {
        let [input, instead] = [&self.input, &self.instead].map(|key| key_shown(key));
        format!("{input}: left out, {} is made of {instead}", key_shown(&self.output))
    }
}

/// Resolves collisions by leaving inputs out: one with the first of these endings (lower case) makes the picture; among those
/// that are alike, the one that made it before, else the first.
pub fn left_out(
    outputs: &[(String, String)],
    endings: &[String],
    owner: impl Fn(&str) -> Option<String>,
) -> Vec<LeftOut> {
    let rank = |input: &String| {
        let ending = ending(input);
        endings.iter().position(|e| *e == ending).unwrap_or(endings.len())
    };
    let of_group = |Collision { output, inputs }: Collision| {
        let owned = owner(&output);
        let best = inputs.iter().min_by_key(|input| (rank(input), owned.as_ref() != Some(input)));
        let instead = best.cloned().unwrap_or_default();
        inputs.into_iter().filter_map(move |input| {
            let output = output.clone();
            (input != instead).then(|| LeftOut { input, instead: instead.clone(), output })
        })
    };
    collisions(outputs).into_iter().flat_map(of_group).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fields(key: &str) -> Fields {
        Fields { ext: "jpg".into(), number: 7, parent: "roll".into(), ..super::fields(key) }
    }

    #[test]
    fn trees_are_mirrored_and_templates_filled() {
        assert_eq!(fill(MIRRORED, &fields("a/b/x.v2.NEF")).unwrap(), "a/b/x.v2.jpg");
        assert_eq!(fill(MIRRORED, &fields("x.NEF")).unwrap(), "x.jpg");
        let dated = Fields { date: "2026-05-01".into(), camera: "Nikon_D700".into(), ..fields("x.NEF") };
        let name = "{year}/{month}/{day}/{camera}-{parent}-{stem}-{suffix}-{seq}.{ext}";
        assert_eq!(fill(name, &dated).unwrap(), "2026/05/01/Nikon_D700-roll-x-nef-0007.jpg");
        assert_eq!(
            fill("{date}/{year}-{camera}.{ext}", &fields("x.NEF")).unwrap(),
            "undated/undated-unknown.jpg"
        );
        let wrong = fill("{name}.jpg", &fields("x.nef")).unwrap_err().to_string();
        assert!(wrong.contains("{stem}") && wrong.contains("{folder}"), "{wrong}");
    }

    #[test]
    fn one_of_several_inputs_is_kept_by_ending_then_by_history_then_by_order() {
        let outputs: Vec<(String, String)> = ["b.dng", "b.NEF", "b.cr2", "c.dng"]
            .map(|key| (key.to_owned(), format!("{}.jpg", &key[..1])))
            .to_vec();
        let kept = |endings: &[&str], owner: Option<&str>| {
            let endings: Vec<String> = endings.iter().map(|&e| e.to_owned()).collect();
            let left = left_out(&outputs, &endings, |_| owner.map(str::to_owned));
            assert_eq!(left.len(), 2, "{left:?}");
            left[0].instead.clone()
        };
        assert_eq!(kept(&[], None), "b.dng");
        assert_eq!(kept(&[], Some("b.cr2")), "b.cr2");
        assert_eq!(kept(&["raf", "nef", "cr2"], Some("b.dng")), "b.NEF");
        assert_eq!(kept(&["raf"], Some("b.NEF")), "b.NEF");
    }

    #[test]
    fn names_stay_in_the_output_folder() {
        for wrong in ["../{stem}.jpg", "/tmp/{stem}.jpg", "a/../../{stem}.jpg", ""] {
            assert!(fill(wrong, &fields("x.nef")).is_err(), "{wrong}");
        }
        // A camera or a file that is called so leads nowhere, and refuses nobody.
        let evil = Fields { camera: "..".into(), ..fields("a/...nef") };
        assert_eq!(fill("{camera}/{stem}/x.{ext}", &evil).unwrap(), "__/__/x.jpg");
        assert_eq!(fill(MIRRORED, &evil).unwrap(), "a/__.jpg");
    }

    fn pairs(list: &[(&str, &str)]) -> Vec<(String, String)> {
        list.iter().map(|(a, b)| ((*a).to_owned(), (*b).to_owned())).collect()
    }

    #[test]
    fn collisions_are_found_also_in_other_case() {
        let list = pairs(&[("x.nef", "x.jpg"), ("x.dng", "x.jpg"), ("y.nef", "y.jpg"), ("X.nef", "X.jpg")]);
        let found = collisions(&list);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].inputs, ["x.nef", "x.dng", "X.nef"]);
    }

    #[test]
    fn resolved_names_are_different_and_stay_so() {
        let list = [("x.dng", "x.jpg"), ("X.NEF", "X.jpg"), ("x.nef", "x.jpg"), ("x-nef.nef", "x-nef.jpg")];
        let mut first = pairs(&list);
        resolve(&mut first, |_| None);
        assert!(collisions(&first).is_empty(), "{first:?}");
        assert_eq!((first[0].1.as_str(), first[3].1.as_str()), ("x.jpg", "x-nef.jpg"));
        // The NEF was there first; a DNG that comes later does not take its name.
        let mut second = pairs(&[("x.dng", "x.jpg"), ("x.nef", "x.jpg")]);
        resolve(&mut second, |output| (output == "x.jpg").then(|| "x.nef".to_owned()));
        assert_eq!(second, pairs(&[("x.dng", "x-dng.jpg"), ("x.nef", "x.jpg")]));
    }
}
