//! The settings that hold for each file, from all layers.

use std::collections::HashMap;
use std::sync::Arc;

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
        for (name, text) in &texts {
            let file = name == "profile" && text != "auto" && text != "matrix";
            let text = if file { "(a file)" } else { text };
            canonical += &format!("{name}={text}\n");
        }
        let place = texts.get("profile").cloned().unwrap_or_default();
        let kept = self.kept.entry(canonical.clone() + &place);
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
