//! The page.

use std::collections::BTreeMap;
use std::fmt::Write;

use crate::Real;
use crate::known::SYNTHETIC;

/// What flashraw says that it reads and no test here has met, after its documentation.
pub(crate) const UNTESTED: &[(&str, &str)] = &[
    ("ARRI", "ARI"),
    ("Canon", "CR2, sRAW and mRAW"),
    ("Canon", "CR3, RAW and C-RAW"),
    ("Epson", "ERF"),
    ("Fujifilm", "RAF, uncompressed"),
    ("Fujifilm", "RAF, lossless and lossy compressed"),
    ("Hasselblad", "3FR, FFF"),
    ("Kodak", "DCR, DCS, KDC"),
    ("Leaf", "MOS"),
    ("Mamiya", "MEF"),
    ("Minolta", "MRW, MDC"),
    ("Nikon", "NEF of D100 and Coolpix, NRW"),
    ("Olympus", "ORF, uncompressed and compressed"),
    ("Panasonic", "RW2, versions 4 to 8"),
    ("Pentax", "PEF"),
    ("Phase One", "IIQ L and S"),
    ("Raspberry Pi", "raw data in JPEG"),
    ("Samsung", "SRW, versions 0 to 2"),
    ("Sigma", "X3F"),
    ("Sinar", "STI, CapturePro"),
    ("Sony", "ARW, versions 1, 2 and lossless; SR2, SRF"),
];

const HEAD: &str = "\
# Formats

What Darkroot reads, maker by maker, and how that is known. Made from the tests by
`UPDATE_FORMATS=1 cargo test -p darkroot-tests --test formats`; a test fails when it is old.

- **real file**: a file of a camera, or one that a program made of it, decodes in a test to the samples that are noted in
  `tests/formats.toml` (where they are coded with loss: it decodes whole).
- **synthetic**: a test makes such a file of known samples, and they come back; or a script makes it, and another reader finds
  the same. The last column names who else finds them.
- **untested**: the decoder flashraw says that it reads this; no such file was at hand.

A real file says more than a synthetic one, and one file says nothing of the maker's other cameras. `fixtures` and `raw` in
`DARKROOT_DATA` are not part of the repository.

What is in a DNG and is not used is said in a note of the report: colour tables
(RGBTables), semantic and transparency masks, depth maps, enhanced pictures; of opcodes TrimBounds,
warps of the mosaic, and bad pixels outside of OpcodeList1. Refused in words: integers of 32 bits, separate
planes, four-colour sensors.
";

/// The whole page.
pub(crate) fn page(real: &[Real]) -> String {
    let mut rows: BTreeMap<&str, Vec<[String; 3]>> = BTreeMap::new();
    let mut cameras: BTreeMap<(&str, &str), Vec<&str>> = BTreeMap::new();
    for file in real {
        cameras.entry((&file.maker, &file.kind)).or_default().push(&file.camera);
    }
    for ((maker, kind), mut of_kind) in cameras {
        of_kind.sort_unstable();
        of_kind.dedup();
        let cells = [kind.to_owned(), "real file".to_owned(), of_kind.join(", ")];
        rows.entry(maker).or_default().push(cells);
    }
    for made in SYNTHETIC {
        let cells = [made.kind.to_owned(), "synthetic".to_owned(), made.oracle.to_owned()];
        rows.entry(made.maker).or_default().push(cells);
    }
    for (maker, kind) in UNTESTED {
        rows.entry(maker).or_default().push([(*kind).to_owned(), "untested".to_owned(), String::new()]);
    }
    let mut page = HEAD.to_owned();
    for (maker, rows) in rows {
        write!(
            page,
            "\n## {maker}\n\n| format | status | cameras, or who else finds these samples |\n|---|---|---|\n"
        )
        .unwrap();
        for row in rows {
            writeln!(page, "| {} |", row.join(" | ").trim_end()).unwrap();
        }
    }
    page
}
