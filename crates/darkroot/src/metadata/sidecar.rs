//! The sidecar that other programs write beside a raw file: `DSC_0001.xmp` (Lightroom) or `DSC_0001.NEF.xmp` (darktable,
//! digiKam).

use std::ffi::OsString;
use std::path::Path;

use super::spaces::{PHOTOSHOP, is_of_the_raw_file};
use super::xmp::Xmp;
use crate::{files, quoted, shown};

/// No sidecar is larger, in bytes.
const LARGEST: u64 = 8 << 20;

/// What stands beside a raw file.
#[derive(Debug, Default)]
pub(crate) struct Beside {
    /// A packet of XMP, without what is of the raw file or of another program's rendering; where both names are there, the
    /// longer counts more.
    pub(crate) packet: Option<String>,
    /// Which file could not be used, why, and what can be done. The picture is made without it.
    pub(crate) left_out: Option<String>,
}

/// Looks for both sidecars of a raw file.
pub(crate) fn beside(input: &Path) -> Beside {
    let mut longer = OsString::from(input);
    longer.push(".xmp");
    let mut said = Xmp::default();
    let mut left_out = None;
    for (path, for_all) in [(input.with_extension("xmp"), true), (longer.into(), false)] {
        // Nothing, a folder that is closed to us, or a name that is too long; a link that leads nowhere is an error.
        if path == input || path.symlink_metadata().is_err() {
            continue;
        }
        let xmp = match read(&path) {
            Ok(xmp) => xmp,
            Err(why) => {
                left_out = Some(format!("{why}; the picture has nothing of it: mend it or remove it"));
                continue;
            }
        };
        // DSC_0001.xmp may be for DSC_0001.JPG.
        let ending = xmp.text(PHOTOSHOP, "SidecarForExtension");
        let ours = input.extension().and_then(|e| e.to_str());
        let other = for_all && ending.zip(ours).is_some_and(|(a, b)| !a.eq_ignore_ascii_case(b));
        if !other {
            said.lay(&xmp);
        }
    }
    said.said.retain(|name, _| !is_of_the_raw_file(&name.space, &name.local));
    Beside { packet: (!said.said.is_empty()).then(|| said.packet()), left_out }
}

/// Reads a sidecar; in words, which one cannot be used and why.
fn read(path: &Path) -> Result<Xmp, String> {
    let wrong = |why: String| format!("{}: the sidecar is no XMP: {}", shown(path), quoted(&why));
    let bytes = files::read_up_to(path, LARGEST).map_err(|e| e.to_string())?;
    let text = String::from_utf8(bytes).map_err(|_| wrong("it is not text in UTF-8".to_owned()))?;
    Xmp::parse(&text).map_err(wrong)
}
