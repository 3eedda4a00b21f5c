//! Where outputs of a batch go below the output folder.

use std::collections::HashMap;

use darkroot::naming::NamingError;

/// The tree of the inputs, mirrored.
pub const MIRRORED: &str = "{folder}/{stem}.{ext}";

/// What a name can be made of.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Fields {
    /// The input's path below its root.
    pub key: String,
    /// Ending of the output's format.
    pub ext: String,
    /// The input's number.
    pub number: usize,
    /// Camera as it can stand in a file name; empty if unknown.
    pub camera: String,
    /// Date of the shot, 2026-05-01; empty if unknown.
    pub date: String,
    /// Name of the folder that the input lies in.
    pub parent: String,
}

/// Whether the template names what stands inside files.
pub fn needs_headers(template: &str) -> bool {
    ["{camera}", "{date}", "{year}", "{month}", "{day}"].iter().any(|name| template.contains(name))
}

/// Whether the template numbers its files.
pub fn needs_number(template: &str) -> bool {
    template.contains("{seq}")
}

/// Fills in a template: a path below the output folder, with forward slashes.
///
/// # Errors
/// A placeholder that does not exist, a path that leaves the output folder.
pub fn fill(template: &str, fields: &Fields) -> Result<String, NamingError> {
    let (folder, name) = fields.key.rsplit_once('/').unwrap_or(("", &fields.key));
    let (stem, ending) = match name.rsplit_once('.') {
        Some((stem, ending)) if !stem.is_empty() => (stem, ending),
        _ => (name, ""),
    };
    let date = |from: usize, to: usize| fields.date.get(from..to).unwrap_or("undated");
    let or = |text: &str, other: &str| if text.is_empty() { other.to_owned() } else { text.to_owned() };
    let mut out = String::new();
    let mut rest = template;
    while let Some((before, after)) = rest.split_once('{') {
        let (name, tail) =
            after.split_once('}').ok_or_else(|| NamingError::BatchPlaceholder { name: after.to_owned() })?;
        out.push_str(before);
        out.push_str(&match name {
            "folder" => folder.to_owned(),
            "stem" => stem.to_owned(),
            "suffix" => ending.to_ascii_lowercase(),
            "ext" => fields.ext.clone(),
            "parent" => fields.parent.clone(),
            "seq" => format!("{:04}", fields.number),
            "camera" => or(&fields.camera, "unknown"),
            "date" => or(&fields.date, "undated"),
            "year" => date(0, 4).to_owned(),
            "month" => date(5, 7).to_owned(),
            "day" => date(8, 10).to_owned(),
            other => return Err(NamingError::BatchPlaceholder { name: other.to_owned() }),
        });
        rest = tail;
    }
    out.push_str(rest);
    let parts: Vec<&str> =
        out.split(['/', std::path::MAIN_SEPARATOR]).filter(|p| !p.is_empty() && *p != ".").collect();
    if parts.is_empty() || parts.contains(&"..") || template.starts_with('/') {
        return Err(NamingError::Outside { template: template.to_owned() });
    }
    Ok(parts.join("/"))
}

/// Two or more inputs for one output, also where names differ only in case.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{output}: would be written from more than one input ({})", inputs.join(", "))]
pub struct Collision {
    /// The common output.
    pub output: String,
    /// Keys of its inputs.
    pub inputs: Vec<String>,
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
        let ending = input.rsplit_once('.').map_or("", |(_, e)| e).to_lowercase();
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

#[cfg(test)]
mod tests {
    use super::*;

    fn fields(key: &str) -> Fields {
        Fields { key: key.into(), ext: "jpg".into(), number: 7, parent: "roll".into(), ..Fields::default() }
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
    fn names_stay_in_the_output_folder() {
        for wrong in ["../{stem}.jpg", "/tmp/{stem}.jpg", "a/../../{stem}.jpg", ""] {
            assert!(fill(wrong, &fields("x.nef")).is_err(), "{wrong}");
        }
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
