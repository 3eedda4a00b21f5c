//! The raw files in `samples/` of the repository, made anew.

use darkroot_photo::Size;

use crate::expose::expose;
use crate::{Camera, Exposure, Scene, dng, nef};

/// One file of `samples/`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Sample {
    /// Its name.
    pub name: &'static str,
    /// How it was made, in words.
    pub made: &'static str,
    /// What it holds.
    pub bytes: Vec<u8>,
}

/// Width and height of the samples.
const SIZE: Size = Size { width: 720, height: 480 };

/// All samples. They are the same, byte for byte, whenever and wherever they are made.
pub fn all() -> Vec<Sample> {
    let scene = Scene::still_life(SIZE);
    let nikon = expose(&scene, &Camera::nikon_d750(), &exposure(1));
    let simulated = expose(&scene, &Camera::simulated_one(), &exposure(2));
    let nef = nef::write(&nikon, nef::Storage::Lossless);
    let dng = dng::write(&simulated, dng::Storage::JpegTiles);
    vec![
        Sample {
            name: "still-life.nef",
            made: "Scene::still_life, daylight 5500 K, Camera::nikon_d750, lossless compressed 14-bit",
            bytes: nef.unwrap_or_default(),
        },
        Sample {
            name: "still-life.dng",
            made: "Scene::still_life, daylight 5500 K, Camera::simulated_one, lossless JPEG 14-bit",
            bytes: dng,
        },
    ]
}

/// The exposure of the samples: daylight of 5500 K, white at 0.65 of saturation, an ordinary lens, with noise.
pub fn exposure(seed: u64) -> Exposure {
    Exposure { white: 0.65, falloff: 0.2, glare: 0.005, noise: Some(seed), ..Exposure::default() }
}
