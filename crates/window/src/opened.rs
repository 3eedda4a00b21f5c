//! Photographs that are held decoded, so that a slider need not wait for a decoder.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, OnceLock};

use darkroot::settings::FromChart;
use darkroot::{Analysis, Photo, Plan, ProfileStore, Settings, ToldByChart};
use darkroot_batch::facts::modified;
use darkroot_develop::{Kept, Look};

use crate::fault::Fault;
use crate::roots::Place;
use crate::state::locked;

/// Photographs held at once, at most.
const PHOTOS: usize = 3;
/// Samples of all of them together, at most: 250 million are 0.5 GB.
const SAMPLES: usize = 250_000_000;

/// A photograph, decoded and looked at.
pub(crate) struct Open {
    pub(crate) photo: Photo,
    pub(crate) analysis: Analysis,
    /// The view of the whole that was rendered last, as far as a slider may leave it as it is.
    pub(crate) kept: Kept,
    /// What its picture was developed from.
    pub(crate) path: PathBuf,
    /// What the shot of a chart told that was asked for last.
    told: Mutex<Option<(FromChart, Arc<ToldByChart>)>>,
}

impl Open {
    /// How a picture is made of it.
    pub(crate) fn plan(&self, store: &ProfileStore, settings: &Settings) -> Result<Plan, Fault> {
        let Some(told) = self.told_by_chart(settings)? else {
            let plan = self.photo.plan(&self.analysis, store, settings);
            return plan.map_err(|e| Fault::unusable(format!("{}: {e}", darkroot::shown(&self.path))));
        };
        let plan = self.photo.plan_by_chart(&self.path, &self.analysis, store, settings, &told);
        plan.map_err(|e| Fault::unusable(e.to_string()))
    }

    fn told_by_chart(&self, settings: &Settings) -> Result<Option<Arc<ToldByChart>>, Fault> {
        let mut last = locked(&self.told);
        if let Some((_, told)) = last.as_ref().filter(|(asked, _)| *asked == settings.chart) {
            return Ok(Some(Arc::clone(told)));
        }
        let told = self.photo.told_by_chart(&self.path, settings);
        let told = told.map_err(|e| Fault::unusable(e.to_string()))?.map(Arc::new);
        *last = told.clone().map(|told| (settings.chart.clone(), told));
        Ok(told)
    }
}

/// A file as it was when it was read, and how. Another state of it, or another decoder, is another photograph.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Identity {
    path: PathBuf,
    size: u64,
    modified: i64,
    rawloader: bool,
    from_preview: bool,
    /// With what the camera rendered, for its look.
    rendered: bool,
    /// Dark and flat frames.
    frames: [Option<PathBuf>; 2],
}

/// A photograph that is held, or being decoded: who comes second waits for the first.
type Slot = Arc<OnceLock<Result<Arc<Open>, Arc<str>>>>;

/// Photographs that are held, the newest first.
#[derive(Default)]
pub(crate) struct Opened(Mutex<VecDeque<(Identity, Slot)>>);

impl Opened {
    /// The photograph of a file, decoded as the settings ask.
    pub(crate) fn open(
        &self,
        place: &Place,
        store: &ProfileStore,
        settings: &Settings,
    ) -> Result<Arc<Open>, Fault> {
        let identity = identity(&place.path, settings)?;
        let slot = {
            let mut held = locked(&self.0);
            let known = held.iter().position(|(of, _)| *of == identity);
            let entry =
                known.and_then(|i| held.remove(i)).unwrap_or_else(|| (identity.clone(), Slot::default()));
            let slot = Arc::clone(&entry.1);
            held.push_front(entry);
            shorten(&mut held);
            slot
        };
        let opened = slot
            .get_or_init(|| decode(place, store, settings).map(Arc::new).map_err(|e| e.to_string().into()));
        opened.clone().map_err(|words| {
            // It may be another file next time.
            locked(&self.0).retain(|(of, _)| *of != identity);
            Fault::unusable(&*words)
        })
    }
}

/// Lets go of the photographs that were not looked at for the longest time.
fn shorten(held: &mut VecDeque<(Identity, Slot)>) {
    let samples = |slot: &Slot| match slot.get() {
        Some(Ok(open)) => {
            let counts = &open.photo.capture().counts;
            counts.size().area() * counts.layout().planes()
        }
        _ => 0,
    };
    let mut sum = 0;
    let mut count = 0;
    held.retain(|(_, slot)| {
        sum += samples(slot);
        count += 1;
        count == 1 || (count <= PHOTOS && sum <= SAMPLES)
    });
}

fn identity(path: &Path, settings: &Settings) -> Result<Identity, Fault> {
    let data = std::fs::metadata(path)
        .map_err(|e| Fault::missing(format!("{}: cannot be read: {e}", darkroot::shown(path))))?;
    Ok(Identity {
        path: path.to_owned(),
        size: data.len(),
        modified: modified(&data),
        rawloader: settings.decoder == darkroot::Decoder::Rawloader,
        from_preview: settings.from_preview,
        rendered: settings.recipe.look == Look::Camera,
        frames: [settings.dark.clone(), settings.flat.clone()],
    })
}

fn decode(place: &Place, store: &ProfileStore, settings: &Settings) -> Result<Open, darkroot::Error> {
    let bytes = place.read()?;
    let photo = darkroot::job::opened(&place.path, &bytes, settings, store)?;
    let analysis = photo.analyse_as_asked();
    Ok(Open { photo, analysis, kept: Kept::default(), path: place.path.clone(), told: Mutex::default() })
}
