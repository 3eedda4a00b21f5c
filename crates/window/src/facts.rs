//! What is known of a file before it is opened: camera, date, ISO, stars, whether it has edits.

use std::collections::HashMap;
use std::sync::Mutex;

use darkroot::{Limits, metadata, recipe};
use darkroot_batch::facts::modified;
use darkroot_photo::Metadata;
use darkroot_photo::metadata::{Directory, tag};
use serde::Serialize;

use crate::roots::Place;
use crate::state::{layers, locked};

/// What a raw file says of itself.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub(crate) struct Head {
    /// The camera, by its common name.
    camera: Option<String>,
    /// Date and time as the camera writes it, `2026:05:01 12:00:00`.
    date: Option<String>,
    iso: Option<f64>,
    /// Exposure time, s.
    seconds: Option<f64>,
    f_number: Option<f64>,
    /// Focal length, mm.
    focal_length: Option<f64>,
    lens: Option<String>,
    /// Size of the upright picture in pixels.
    size: Option<[usize; 2]>,
    /// Why it cannot be read.
    fault: Option<String>,
    #[serde(skip)]
    metadata: Metadata,
}

/// A file's head and what stands beside it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Facts {
    #[serde(flatten)]
    head: Head,
    /// Stars, 0 to 5.
    stars: Option<u8>,
    /// Whether it has a sidecar of ours.
    edited: bool,
    /// What is wrong with its settings.
    settings_fault: Option<String>,
}

/// Heads that are kept, at most.
const HEADS: usize = 20_000;

/// Heads of files by name, size and time.
#[derive(Default)]
pub(crate) struct KnownFacts(Mutex<HashMap<(String, u64, i64), Head>>);

impl KnownFacts {
    /// What is known of a file.
    pub(crate) fn of(&self, name: &str, place: &Place) -> Facts {
        let head = self.head(name, place);
        let mut facts = Facts {
            stars: None,
            edited: recipe::sidecar(&place.path).symlink_metadata().is_ok(),
            settings_fault: None,
            head,
        };
        let settings = layers().and_then(|mut layers| layers.for_file(&place.path)?.settings());
        match settings {
            Ok(settings) => facts.stars = metadata::rating(&facts.head.metadata, &settings.about),
            Err(fault) => facts.settings_fault = Some(fault.to_string()),
        }
        facts
    }

    fn head(&self, name: &str, place: &Place) -> Head {
        let identity =
            std::fs::metadata(&place.path).map(|data| (name.to_owned(), data.len(), modified(&data)));
        if let Ok(identity) = &identity
            && let Some(head) = locked(&self.0).get(identity)
        {
            return head.clone();
        }
        let head = read(place);
        if let Ok(identity) = identity {
            let mut known = locked(&self.0);
            if known.len() >= HEADS {
                known.clear();
            }
            known.insert(identity, head.clone());
        }
        head
    }
}

fn read(place: &Place) -> Head {
    let fault = |words: String| Head { fault: Some(words), ..Head::default() };
    let bytes = match place.read() {
        Ok(bytes) => bytes,
        Err(error) => return fault(error.to_string()),
    };
    let capture = match darkroot_raw::header(&bytes, &Limits::default()) {
        Ok(capture) => capture,
        Err(source) => return fault(darkroot::Error::Raw { path: place.path.clone(), source }.to_string()),
    };
    let number = |tag| capture.metadata.number(Directory::Exif, tag).filter(|v| *v > 0.0);
    let text = |tag| capture.metadata.text(Directory::Exif, tag).map(darkroot::quoted);
    let size = capture.orientation.applied_to(capture.shown().size());
    Head {
        camera: Some(darkroot::quoted(&capture.camera.name())),
        date: text(tag::DATE_TIME_ORIGINAL),
        iso: number(tag::ISO),
        seconds: number(tag::EXPOSURE_TIME),
        f_number: number(tag::F_NUMBER),
        focal_length: number(tag::FOCAL_LENGTH),
        lens: text(tag::LENS_MODEL),
        size: Some([size.width, size.height]),
        fault: None,
        metadata: capture.metadata,
    }
}
