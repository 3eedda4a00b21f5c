//! What lensfun's database knows of the lens of a photograph.

use darkroot_lens::{Corrections, Found, Shot, find};
use darkroot_photo::metadata::{Directory, tag};
use darkroot_photo::{Capture, Correction};

/// What is known, and words for it: what was found and is corrected, or why nothing is. `None` where the file has a
/// correction of its own, which is better. `name` is that of the lens, where a person says it.
pub(crate) fn known(capture: &Capture, name: Option<&str>) -> Option<(Option<Corrections>, String)> {
    if capture.picture_corrections.iter().any(|c| matches!(c, Correction::Warp(_))) {
        return None;
    }
    let metadata = &capture.metadata;
    let number = |tag| metadata.number(Directory::Exif, tag).filter(|v| *v > 0.0);
    let Some(focal_length) = number(tag::FOCAL_LENGTH) else {
        return Some((None, "the file names no focal length: the lens is not corrected".to_owned()));
    };
    let of_file = |tag| metadata.text(Directory::Exif, tag);
    let lens_model = name.or_else(|| of_file(tag::LENS_MODEL));
    let shot = Shot {
        lens_make: of_file(tag::LENS_MAKE).filter(|_| name.is_none()),
        lens_model,
        aperture: number(tag::F_NUMBER),
        distance: number(tag::SUBJECT_DISTANCE),
        ..Shot::new(&capture.camera.make, &capture.camera.model, focal_length)
    };
    let size = capture.default_crop.size();
    Some(match find(&shot) {
        Some(found) => {
            let corrections = found.corrections((size.width, size.height));
            (Some(corrections), format!("lens: {}{} (lensfun)", found.lens, how(found.found)))
        }
        None => {
            let lens = lens_model.map_or_else(|| "the lens".to_owned(), |name| format!("`{name}`"));
            (None, format!("lensfun's database does not know {lens} on this camera: it is not corrected"))
        }
    })
}

/// Why it is this lens, where its name does not say so.
fn how(found: Found) -> &'static str {
    match found {
        Found::Name => "",
        Found::Numbers => ", by its focal lengths and f-numbers",
        Found::Camera => ", which the camera has",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use darkroot_photo::metadata::Value;
    use darkroot_photo::{Cfa, Counts, Layout, Mosaic, Size};

    fn capture(lens: &str, focal_length: u32) -> Capture {
        let size = Size { width: 600, height: 400 };
        let layout = Layout::Cfa(Cfa::parse("RGGB").unwrap());
        let mut capture = Capture::bare(Counts::U16(Mosaic { size, layout, samples: vec![0; size.area()] }));
        capture.camera.make = "Canon".into();
        capture.camera.model = "Canon EOS 550D".into();
        let exif = Directory::Exif;
        capture.metadata.set(exif, tag::LENS_MODEL, Value::Text(lens.into()));
        capture.metadata.set(exif, tag::FOCAL_LENGTH, Value::Rationals(vec![(focal_length, 1)]));
        capture.metadata.set(exif, tag::F_NUMBER, Value::Rationals(vec![(4, 1)]));
        capture
    }

    #[test]
    fn a_lens_is_found_by_its_name_and_one_that_is_not_is_named() {
        let (found, words) = known(&capture("EF-S18-55mm f/3.5-5.6 IS", 18), None).unwrap();
        assert!(found.is_some_and(|c| c.has_distortion() && c.has_vignetting()), "{words}");
        assert!(words.contains("18-55mm") && words.contains("lensfun"), "{words}");
        let (found, words) = known(&capture("Nameless 99mm", 99), None).unwrap();
        assert!(found.is_none() && words.contains("`Nameless 99mm`"), "{words}");
        let (found, words) = known(&capture("EF-S18-55mm f/3.5-5.6 IS", 0), None).unwrap();
        assert!(found.is_none() && words.contains("focal length"), "{words}");
        // A person knows better.
        let (found, words) =
            known(&capture("Nameless 99mm", 18), Some("Canon EF-S 18-55mm f/3.5-5.6 IS")).unwrap();
        assert!(found.is_some() && words.contains("18-55mm"), "{words}");
    }
}
