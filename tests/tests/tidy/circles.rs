//! Files of one crate that use each other.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use darkroot_tests::root;

use crate::files;

/// Which other files of its crate a file uses, from its `use` lines and paths. Files are named without `.rs`.
fn used_files(folder: &Path) -> BTreeMap<String, BTreeSet<String>> {
    let sources = files(folder).into_iter().filter(|path| path.extension().is_some_and(|e| e == "rs"));
    let texts: BTreeMap<String, String> = sources
        .map(|path| {
            let text = std::fs::read_to_string(&path).unwrap();
            let text = text.split("#[cfg(test)]\nmod tests").next().unwrap().to_owned();
            (path.file_stem().unwrap().to_string_lossy().into_owned(), text)
        })
        .filter(|(name, _)| name != "lib")
        .collect();
    let word = |text: &str| text.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect::<String>();
    let used = |text: &str| {
        let mut found = BTreeSet::new();
        for path in text.split("super::").skip(1).chain(text.split("crate::").skip(1)) {
            match path.strip_prefix('{') {
                // In `use super::{a, b};` each word is a file.
                Some(list) => {
                    let list = list.split(';').next().unwrap();
                    found.extend(list.split(|c: char| !c.is_alphanumeric() && c != '_').map(str::to_owned));
                }
                None => {
                    found.insert(word(path));
                }
            }
        }
        found.retain(|name| texts.contains_key(name));
        found
    };
    texts
        .iter()
        .map(|(name, text)| {
            let mut found = used(text);
            found.remove(name);
            (name.clone(), found)
        })
        .collect()
}

/// Files that use each other, directly or by way of others, and files that use those: what is left when files that
/// use none are taken away again and again.
fn circle(mut graph: BTreeMap<String, BTreeSet<String>>) -> BTreeSet<String> {
    loop {
        let free: BTreeSet<String> =
            graph.iter().filter(|(_, used)| used.is_empty()).map(|(name, _)| name.clone()).collect();
        if free.is_empty() {
            return graph.into_keys().collect();
        }
        graph.retain(|name, _| !free.contains(name));
        for used in graph.values_mut() {
            used.retain(|name| !free.contains(name));
        }
    }
}

#[test]
fn files_of_the_batch_use_each_other_without_circles() {
    let graph = used_files(&root().join("crates/batch/src"));
    assert!(graph.len() > 20 && graph["batch"].contains("plan"), "the files were not read: {graph:?}");
    assert_eq!(circle(graph.clone()), BTreeSet::new(), "these use each other, or what does");
    // The test sees a circle where there is one.
    let mut wrong = graph;
    wrong.get_mut("plan").unwrap().insert("batch".to_owned());
    assert!(circle(wrong).contains("plan"));
}
