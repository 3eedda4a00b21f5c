//! Writes the first inputs of every fuzz target: `cargo run -p darkroot-tests --example fuzz_corpora -- fuzz/corpus`.

#![allow(clippy::unwrap_used, clippy::expect_used)] // It may stop.

use std::fs;
use std::path::Path;

use darkroot::ProfileStore;
use darkroot_colour::RgbSpace;
use darkroot_photo::{Picture, PictureSpace, Samples, Size};
use darkroot_profile::export::cube::{Settings as Cube, Shaper};
use darkroot_profile::export::{clf, cube, dcp, icc};
use darkroot_profile::{Profile, file};
use darkroot_tests::{root, small_raws};

const RAW_TARGETS: [&str; 5] = ["screen", "flashraw", "rawloader", "develop", "preview"];

fn main() {
    let corpus = std::env::args_os().nth(1).expect("the folder of the corpora");
    let corpus = Path::new(&corpus);
    let put = |target: &str, name: &str, bytes: &[u8]| {
        let folder = corpus.join(target);
        fs::create_dir_all(&folder).unwrap();
        fs::write(folder.join(name), bytes).unwrap();
    };
    for (name, bytes) in small_raws::all() {
        RAW_TARGETS.iter().for_each(|target| put(target, &name, &bytes));
    }
    for which in 0..3u8 {
        put("opcodes", &format!("list-{which}"), &[&[which][..], &small_raws::opcodes()].concat());
    }
    put("exif", "directory", EXIF);

    for found in ProfileStore::builtin().all().into_iter().take(4) {
        let name = found.profile.camera().name();
        put("profile", &name, file::format(&found.profile).as_bytes());
        exports(&found.profile, &name, &put);
    }
    put("cgats", "lab", CGATS.as_bytes());
    put("cgats", "table", b"name,L,a,b\nA1,50,0,0\nA2,60,10,-10\n");
    put("cxf", "lab", CXF.as_bytes());
    put("layout", "chart", LAYOUT.as_bytes());
    put("cht", "chart", CHT.as_bytes());
    put("spectra", "rows", b"name,400,410,420,430\nred,0.1,0.2,0.3,0.2\ngreen,1,2,3,2\nblue,1e-3,0,0,5\n");
    put("spectra", "columns", b"nm;red;green;blue\n400;0.1;0.2;0.3\n410;0.1;0.2;0.3\n420;0.1;0.2;0.3\n");
    put("recipe", "recipe", b"exposure = 0.5\nwhite-balance = \"as-shot\"\nspace = \"srgb\"\nresize = 100\n");
    put("recipe", "every", darkroot::Effective::default().to_toml(|p| p.display().to_string()).as_bytes());
    JOURNAL.iter().enumerate().for_each(|(n, line)| put("journal", &n.to_string(), line.as_bytes()));
    LINES.iter().enumerate().for_each(|(n, line)| put("worker", &n.to_string(), line.as_bytes()));
    pictures(&put);
    deliveries(&put);
    descriptions(&put);
}

/// A profile in the forms of other programs.
fn exports(profile: &Profile, name: &str, put: &dyn Fn(&str, &str, &[u8])) {
    let calibration = profile.calibrations().first().unwrap();
    put("icc", name, &icc::write(profile, calibration, 3, icc::Version::Four));
    let settings = Cube { size: 3, shaper: Shaper::default(), space: RgbSpace::SRGB };
    put("cube", name, cube::write(profile, calibration, &settings).as_bytes());
    put("clf", name, clf::write(profile, calibration, 3, &RgbSpace::SRGB).as_bytes());
    let neutral = dcp::WithNeutral { calibration, neutral: [0.5, 1.0, 0.6] };
    if let Ok(dcp) = dcp::Dcp::of(profile, &[neutral]) {
        put("dcp", name, &dcp.write());
    }
}

/// A chart of flat patches as PNG, and files of other kinds that look for one passes by.
fn pictures(put: &dyn Fn(&str, &str, &[u8])) {
    let picture = image::RgbImage::from_fn(96, 64, |x, y| {
        let (column, row) = (x / 16, y / 16);
        let gap = x % 16 < 2 || y % 16 < 2;
        let level = |k: u32| if gap { 20 } else { ((column * 37 + row * 71) * k % 256) as u8 };
        image::Rgb([level(1), level(3), level(5)])
    });
    let mut png = std::io::Cursor::new(Vec::new());
    picture.write_to(&mut png, image::ImageFormat::Png).unwrap();
    put("picture", "chart.png", png.get_ref());
    for name in ["0001-neutral", "0016-monochrome"] {
        for file in fs::read_dir(root().join("tests/golden").join(name)).into_iter().flatten().flatten() {
            let path = file.path();
            if path.extension().is_some_and(|e| e == "png") && file.metadata().unwrap().len() < 20_000 {
                put("picture", name, &fs::read(path).unwrap());
            }
        }
    }
}

/// What people write into raw files and beside them.
fn descriptions(put: &dyn Fn(&str, &str, &[u8])) {
    put("xmp", "xmp", XMP.as_bytes());
    put("lut", "cube", b"TITLE \"x\"\nLUT_1D_SIZE 2\nLUT_1D_INPUT_RANGE 0 2\nLUT_3D_SIZE 2\nDOMAIN_MIN 0 0 0\n0 0 0\n1 1 1\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n1 0 1\n0 1 1\n1 1 1\n");
    put("lut", "clf", CLF.as_bytes());
    let datasets =
        b"\x1c\x01\x5a\0\x03\x1b%G\x1c\x02\x05\0\x03Fog\x1c\x02\x19\0\x03fog\x1c\x02\x37\0\x0820261127";
    put("iptc", "iim", datasets);
}

/// Finished pictures with colour profiles.
fn deliveries(put: &dyn Fn(&str, &str, &[u8])) {
    let (_, raw) = small_raws::all().into_iter().next().unwrap();
    let photo = darkroot::Photo::open(&raw, &darkroot::Limits::default()).unwrap();
    let size = Size { width: 64, height: 46 };
    let samples = (0..3 * size.area()).map(|i| (i * 7 % 251) as u8).collect();
    let space = PictureSpace::Rgb(RgbSpace::ECIRGB_V2);
    let picture = Picture { size, samples: Samples::U8(samples), space };
    for format in [darkroot::Format::Tiff, darkroot::Format::Jpeg] {
        let bytes = darkroot::encode_picture(&picture, format, photo.capture()).unwrap();
        put("delivered", format.extension(), &bytes);
    }
}

const CLF: &str = "<ProcessList id=\"1\" compCLFversion=\"3\"><Matrix inBitDepth=\"8i\" outBitDepth=\"16f\"><Array dim=\"3 3\">1 0 0 0 1 0 \
    0 0 1</Array></Matrix><Log inBitDepth=\"32f\" outBitDepth=\"32f\" style=\"cameraLinToLog\"><LogParams base=\"2\" linSideBreak=\"0.1\"/></Log>\
    <LUT1D inBitDepth=\"32f\" outBitDepth=\"10i\"><Array dim=\"2 1\">0 1023</Array></LUT1D><Range inBitDepth=\"32f\" outBitDepth=\"32f\">\
    <minInValue>0</minInValue><minOutValue>0</minOutValue></Range></ProcessList>";

const XMP: &str = "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\"><rdf:RDF xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\">\
    <rdf:Description xmlns:xmp=\"http://ns.adobe.com/xap/1.0/\" xmlns:dc=\"http://purl.org/dc/elements/1.1/\" xmp:Rating=\"4\">\
    <dc:title><rdf:Alt><rdf:li xml:lang=\"x-default\">Fog</rdf:li></rdf:Alt></dc:title><dc:subject><rdf:Bag>\
    <rdf:li>fog</rdf:li></rdf:Bag></dc:subject><dc:relation rdf:parseType=\"Resource\"><dc:type>a</dc:type></dc:relation>\
    </rdf:Description></rdf:RDF></x:xmpmeta>";

/// Which directory, then make, an exposure time, a lens and a date.
const EXIF: &[u8] = b"\0\x03\0\x9a\x82\x05\0\x01\0\0\0\x40\0\0\0\x03\x90\x02\0\x14\0\0\0\x40\0\0\0\x34\xa4\x02\0\x04\0\0\0abc\0\0\0\0\0";

const CGATS: &str = "CGATS.17\nORIGINATOR \"x\"\nNUMBER_OF_FIELDS 4\nBEGIN_DATA_FORMAT\nSAMPLE_ID LAB_L LAB_A LAB_B\n\
END_DATA_FORMAT\nNUMBER_OF_SETS 2\nBEGIN_DATA\nA1 50.0 0.1 -0.2\nA2 20 3 4\nEND_DATA\n";

const CXF: &str = r#"<?xml version="1.0"?><cc:CxF xmlns:cc="http://colorexchangeformat.com/CxF3-core"><cc:Resources><cc:ObjectCollection>
<cc:Object ObjectType="Target" Name="A1" Id="1"><cc:ColorValues><cc:ColorCIELab ColorSpecification="c"><cc:L>50</cc:L><cc:A>1</cc:A><cc:B>2</cc:B></cc:ColorCIELab></cc:ColorValues></cc:Object>
<cc:Object ObjectType="Target" Name="A2" Id="2"><cc:ColorValues><cc:ReflectanceSpectrum StartWL="380">0.1 0.2 0.3 0.4 0.5</cc:ReflectanceSpectrum></cc:ColorValues></cc:Object>
</cc:ObjectCollection><cc:ColorSpecificationCollection><cc:ColorSpecification Id="c"/></cc:ColorSpecificationCollection></cc:Resources></cc:CxF>"#;

const LAYOUT: &str = "name = \"mine\"\ntitle = \"Mine\"\ncolumns = 2\nrows = 1\ngap = 0.2\nhinge = { after = 1, width = 0.5 }\n\
[[patch]]\nname = \"A1\"\nlab = [50.0, 1.0, -2.0]\n[[patch]]\nname = \"A2\"\nlab = [20.0, 0.0, 0.0]\n";

const CHT: &str = "BOXES 7\n  F _ _ 0 0 100 0 100 60 0 60\n  D ALL ALL _ _ 90 50 5 5 0 0\n  X A C 1 2 20 20 5 5 25 25\n\nBOX_SHRINK 3.0\n\n\
REF_ROTATION 0.0\n\nXLIST 2\n  5.0 1.0 1.0\n  25.0 1.0 1.0\n\nYLIST 2\n  5.0 1.0 1.0\n  30.0 1.0 1.0\n\n\
EXPECTED XYZ 6\n  A1 10 10 10\n  B1 20 20 20\n  C1 30 30 30\n  A2 40 40 40\n  B2 50 50 50\n  C2 60 60 60\n";

/// Behind a first byte that asks for the right sums: lines without theirs, and without the last brace.
const JOURNAL: [&str; 2] = [
    "\x01{\"event\":\"journal\",\"version\":1,\"program\":\"0.1.0\"\n{\"event\":\"begun\",\"input\":\"a.dng\",\"output\":\"a.jpg\"\n",
    "\x00{\"event\":\"begun\",\"output\":\"a.jpg\",\"sum\":\"12345678\"}\n{\"torn\n",
];

const LINES: [&str; 8] = [
    r#"{"needs":{"bytes":1000}}"#,
    r#""dropped""#,
    r#"{"header":{"camera":"a","date":"2026-05-01","pixels":6}}"#,
    r#"{"failed":{"kind":"file","error":"a.dng: is damaged"}}"#,
    r#"{"thumbnail":null}"#,
    r#"{"go":{"threads":2}}"#,
    r#"{"task":{"header":{"input":"a.dng"}}}"#,
    r#"{"task":{"look":{"input":"a.dng","layout":null}}}"#,
];
