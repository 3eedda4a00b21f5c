//! The settings that hold for each file, from all layers.

use std::collections::HashMap;
use std::sync::Arc;

use darkroot::Key;
use darkroot::naming::Target;
use darkroot::recipe::Layers;

use super::find::Source;
use super::item::FileSettings;
use super::plan_fault::PlanFault;

/// Settings by folder and file, each kind kept once.
#[derive(Debug)]
pub struct SettingsByFile {
    layers: Layers,
    kept: HashMap<String, Arc<FileSettings>>,
}

impl SettingsByFile {
    /// From layers of settings.
    pub fn new(layers: Layers) -> Self {
        Self { layers, kept: HashMap::new() }
    }

    /// What holds for a file. `target` tells the format where no setting does.
    pub(crate) fn of(&mut self, source: &Source, target: &Target) -> Result<Arc<FileSettings>, PlanFault> {
        let effective = self.layers.for_file(&source.path)?;
        let mut settings = effective.settings()?;
        let format = effective.format(target, &settings, self.layers.flags())?;
        settings.format = Some(format);
        let texts = effective.texts();
        let mut canonical = format!("format={}\n", format.extension());
        let mut places = String::new();
        for (name, text) in &texts {
            // What a file says counts, not where it lies; the name of a camera stands for its profile.
            let file = match Key::from_name(name) {
                Some(Key::PROFILE) => text != "auto" && text != "matrix",
                Some(key) => key.is_file(text),
                None => false,
            };
            if file {
                places += &format!("{name}={text}\n");
            }
            let text = if file { "(a file)" } else { text };
            canonical += &format!("{name}={text}\n");
        }
        let kept = self.kept.entry(canonical.clone() + &places);
        if let std::collections::hash_map::Entry::Occupied(kept) = kept {
            return Ok(Arc::clone(kept.get()));
        }
        settings
            .resolve(format)
            .map_err(|e| PlanFault::Settings { input: source.path.clone(), source: e })?;
        let prepared = Arc::new(FileSettings { texts, settings, format, canonical });
        Ok(Arc::clone(kept.or_insert(prepared)))
    }
}
