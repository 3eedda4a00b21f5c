//! Small raw files of every kind that `simulate` writes, to be damaged.

use darkroot_colour::Spectrum;
use darkroot_photo::{BlackLevel, Layout, Orientation, Size};
use darkroot_simulate::camera::{filters, x_trans};
use darkroot_simulate::expose::expose;
use darkroot_simulate::makers::{self, RafNotes};
use darkroot_simulate::{Camera, Scene, dng, nef, samples};

use crate::tiff_mutator::with_entry;

/// Tags of the three opcode lists of DNG.
pub const OPCODE_LISTS: [u16; 3] = [51008, 51009, 51022];
/// Type of bytes that nothing is said about.
pub const UNDEFINED: u16 = 7;

/// Width and height: two tiles of the smallest kind, and more rows than any stage looks at.
const SIZE: Size = Size { width: 64, height: 48 };

/// Each with a name.
pub fn all() -> Vec<(String, Vec<u8>)> {
    let scene = Scene::still_life(SIZE);
    let shot = |camera: &Camera| {
        let exposure = samples::exposure(3);
        expose(&scene, camera, &exposure)
    };
    let mut files = Vec::new();
    let nikons = [("14", Camera::nikon_d750()), ("12", Camera::nikon_d750_12_bit())];
    for (bits, camera) in nikons {
        for storage in [nef::Storage::Lossless, nef::Storage::Uncompressed] {
            let bytes = nef::write(&shot(&camera), storage).expect("a NEF holds what a Nikon gives");
            files.push((format!("nikon-{bits}-{storage:?}.nef").to_lowercase(), bytes));
        }
    }
    let layouts = [
        ("bayer", filters("RGGB")),
        ("x-trans", x_trans()),
        ("rgb", Layout::Rgb),
        ("monochrome", Layout::Monochrome),
    ];
    for (name, layout) in layouts {
        let camera = Camera { layout, ..Camera::simulated_one() };
        for storage in [dng::Storage::Uncompressed, dng::Storage::JpegStrip, dng::Storage::JpegTiles] {
            let bytes = dng::write(&shot(&camera), storage);
            files.push((format!("{name}-{storage:?}.dng").to_lowercase(), bytes));
        }
    }
    let plain = dng::write(&shot(&Camera::simulated_one()), dng::Storage::Uncompressed);
    for list in OPCODE_LISTS {
        let bytes = with_opcodes(&plain, list, &opcodes());
        files.push((format!("opcodes-{list}.dng"), bytes));
    }
    let upright = darkroot_simulate::Exposure {
        orientation: Orientation::from_exif(6),
        light: Spectrum::illuminant_a(),
        ..samples::exposure(4)
    };
    let masked = Camera { masked: (8, 4), ..Camera::simulated_one() };
    files.push((
        "masked.dng".to_owned(),
        dng::write(&expose(&scene, &masked, &upright), dng::Storage::JpegStrip),
    ));
    files.extend(with_lens_notes(&scene));
    files
}

/// Files of makers whose notes describe the lens: gentle ones, as far as the numbers are believed.
fn with_lens_notes(scene: &Scene) -> [(String, Vec<u8>); 3] {
    let shot = |camera: &Camera| expose(scene, camera, &samples::exposure(3));
    let camera = Camera::simulated_one();
    let sony = [(0x7035, vec![8, 0, 9, 19, 28, 0, -9, -19, -28]), (0x7037, vec![4, 0, -64, -128, -256])];
    let knots: Vec<f64> = (1..=9).map(|i| f64::from(i) / 9.0).collect();
    let list = |values: [f64; 9]| [vec![416.5], knots.clone(), values.to_vec()].concat();
    let fujifilm = RafNotes {
        lens: vec![(0xf00b, list([-1.0; 9])), (0xf010, list([90.0; 9]))],
        records: vec![(0x0115, vec![9, 16])],
        part: 0,
    };
    let twelve = Camera { bits: 12, white: 4000, black: BlackLevel::uniform(256.0), ..camera.clone() };
    let olympus = [(0x150a, vec![-0.05, 0.01, 0.0, 1.0]), (0x150c, vec![0.0, 1e-3, 0.0, 0.0, -1e-3, 0.0])];
    [
        ("sony.arw", makers::arw(&shot(&camera), &sony, Some((56, 32)))),
        ("fujifilm.raf", makers::raf(&shot(&camera), &fujifilm)),
        ("olympus.orf", makers::orf(&shot(&twelve), &olympus)),
    ]
    .map(|(name, bytes)| (name.to_owned(), bytes.expect("such a file holds what the camera gives")))
}

/// The one of this name.
pub fn named(name: &str) -> Vec<u8> {
    all().into_iter().find(|(n, _)| n == name).expect("there is such a file").1
}

/// A DNG with an opcode list of these bytes.
pub fn with_opcodes(dng: &[u8], list: u16, opcodes: &[u8]) -> Vec<u8> {
    let count = u32::try_from(opcodes.len()).expect("lists are small");
    with_entry(dng, list, UNDEFINED, count, opcodes)
}

/// An opcode list with one of each opcode that Darkroot knows (DNG 1.7, chapter 7).
pub fn opcodes() -> Vec<u8> {
    let words = |words: &[u32]| words.iter().flat_map(|w| w.to_be_bytes()).collect::<Vec<u8>>();
    let numbers = |numbers: &[f64]| numbers.iter().flat_map(|n| n.to_be_bytes()).collect::<Vec<u8>>();
    let area = words(&[0, 0, 48, 64, 0, 1, 1, 1]);
    let table = [&words(&[2])[..], &[0, 10, 1, 0]].concat();
    let map = [words(&[2, 2]), numbers(&[1.0, 1.0, 0.0, 0.0]), words(&[1])].concat();
    let gains = [1.0f32, 1.1, 1.2, 0.9].iter().flat_map(|g| g.to_be_bytes()).collect::<Vec<u8>>();
    let factors = [1.0f32; 48].iter().flat_map(|g| g.to_be_bytes()).collect::<Vec<u8>>();
    let bodies: Vec<(u32, Vec<u8>)> = vec![
        (1, [words(&[1]), numbers(&[1.0, 0.01, 0.0, 0.0, 0.0, 0.0, 0.5, 0.5])].concat()),
        (3, numbers(&[0.1, 0.0, 0.0, 0.0, 0.0, 0.5, 0.5])),
        (4, words(&[0, 0])),
        (5, words(&[0, 1, 1, 3, 3, 8, 8, 9, 9])),
        (6, words(&[0, 0, 48, 64])),
        (7, [area.clone(), table].concat()),
        (8, [area.clone(), words(&[2]), numbers(&[0.0, 1.0, 0.1])].concat()),
        (9, [area.clone(), map, gains].concat()),
        (10, [area.clone(), words(&[48]), factors.clone()].concat()),
        (12, [area, words(&[48]), factors].concat()),
    ];
    let mut list = words(&[bodies.len() as u32]);
    for (id, body) in bodies {
        list.extend(words(&[id, 0x0103_0000, 1, body.len() as u32]));
        list.extend(body);
    }
    list
}
