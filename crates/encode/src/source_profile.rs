//! The ICC profile that a finished picture carries, ours or anyone's: from the numbers of the picture to colours.
//!
//! A profile of colorants and curves (ICC.1:2022, 8.3) is evaluated here, exactly for samples of 8 and 16 bits; one with
//! tables (8.2: `A2B1`, else `A2B0`) by interpolation in them; moxcms reads both. Either way the result is relative to the white of the medium, which becomes
//! D50, as relative colorimetric rendering has it.

use darkroot_colour::Vector3;
use darkroot_colour::{RgbSpace, white};
use moxcms::{ColorProfile, DataColorSpace, ParsingOptions, ProfileText, ToneReprCurve};
use rayon::prelude::*;
use std::panic::catch_unwind;

use tables::Tables;

mod tables;

/// The largest profile that is read, bytes, and the largest table in one.
const LARGEST: usize = 16 << 20;
/// Numbers that a curve is evaluated at: all that 16 bits have.
const LEVELS: usize = 1 << 16;
/// What is said where the library gave up.
const PANIC: &str = "the library for profiles gave up";
/// Pixels that are converted together.
const RUN: usize = 4096;

/// The space that pictures are converted to: linear, with D50 as its white, and wide.
pub const LINEAR: RgbSpace = RgbSpace { curve: darkroot_colour::TransferCurve::Linear, ..RgbSpace::PROPHOTO };

/// Why a profile cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ProfileFault {
    /// It is broken.
    #[error("its ICC profile cannot be read ({0}); embed the profile of its colour space again")]
    Broken(String),
    /// It is not for RGB.
    #[error("its ICC profile is for {0}, not for RGB; convert the picture to an RGB space")]
    Space(String),
    /// It has neither colorants with curves nor tables.
    #[error("its ICC profile tells no colours: it has neither colorants with curves nor a table")]
    Empty,
}

/// What the numbers of a picture mean.
pub struct SourceProfile {
    description: String,
    way: Way,
}

enum Way {
    /// Curves of red, green and blue, and the matrix to [`LINEAR`].
    Matrix { curves: [Vec<f32>; 3], matrix: [[f32; 3]; 3] },
    /// Tables.
    Tables(Box<Tables>),
}

impl SourceProfile {
    /// Reads a profile.
    ///
    /// # Errors
    /// One that is broken, larger than 16 MiB, not for RGB, or tells no colours.
    pub fn read(bytes: &[u8]) -> Result<Self, ProfileFault> {
        // Whoever made the profile may have found what the library did not think of.
        catch_unwind(|| Self::parsed(bytes)).unwrap_or_else(|_| Err(ProfileFault::Broken(PANIC.to_owned())))
    }

    fn parsed(bytes: &[u8]) -> Result<Self, ProfileFault> {
        let broken = |e: &dyn std::fmt::Display| ProfileFault::Broken(e.to_string());
        if bytes.len() > LARGEST {
            return Err(broken(&"it is larger than 16 MiB"));
        }
        let options = ParsingOptions {
            max_profile_size: LARGEST,
            max_allowed_clut_size: LARGEST / 2,
            max_allowed_trc_size: LEVELS,
        };
        let profile = ColorProfile::new_from_slice_with_options(bytes, options).map_err(|e| broken(&e))?;
        if profile.color_space != DataColorSpace::Rgb {
            return Err(ProfileFault::Space(format!("{:?}", profile.color_space)));
        }
        let way = match Tables::of(&profile)? {
            Some(tables) => Way::Tables(Box::new(tables)),
            None => matrix_of(&profile)?,
        };
        Ok(Self { description: description(&profile), way })
    }

    /// What pictures without a profile are taken for.
    pub fn srgb() -> Self {
        let matrix = to_linear(&RgbSpace::SRGB.to_xyz_under(white::D50));
        let curve: Vec<f32> =
            (0..LEVELS).map(|i| RgbSpace::SRGB.curve.decode(i as f64 / (LEVELS - 1) as f64) as f32).collect();
        let curves = [curve.clone(), curve.clone(), curve];
        Self { description: RgbSpace::SRGB.name.to_owned(), way: Way::Matrix { curves, matrix } }
    }

    /// Its name, as it says itself; may be empty.
    pub fn description(&self) -> &str {
        &self.description
    }

    /// Whether it has tables.
    pub fn has_tables(&self) -> bool {
        matches!(self.way, Way::Tables(_))
    }

    /// R, G, B of pixels side by side, 0..=1 as they are encoded, to [`LINEAR`], in place.
    pub fn linearise(&self, samples: &mut [f32]) {
        match &self.way {
            Way::Matrix { curves, matrix } => {
                samples.par_chunks_mut(3 * RUN).for_each(|run| {
                    for pixel in run.chunks_exact_mut(3) {
                        let linear = [0, 1, 2].map(|c| curves[c][level(pixel[c])]);
                        for (out, row) in pixel.iter_mut().zip(matrix) {
                            *out = row[0] * linear[0] + row[1] * linear[1] + row[2] * linear[2];
                        }
                    }
                });
            }
            Way::Tables(tables) => {
                let from_xyz = LINEAR.from_xyz_under(white::D50);
                samples.par_chunks_mut(3 * RUN).for_each(|run| {
                    for pixel in run.chunks_exact_mut(3) {
                        let xyz = tables.xyz([pixel[0], pixel[1], pixel[2]]);
                        let linear = from_xyz * Vector3::from(xyz);
                        for (out, v) in pixel.iter_mut().zip(linear.iter()) {
                            *out = *v as f32;
                        }
                    }
                });
            }
        }
    }
}

/// Place of an encoded value in a curve; 0 for what is no number.
fn level(encoded: f32) -> usize {
    (encoded.clamp(0.0, 1.0) * (LEVELS - 1) as f32 + 0.5) as usize % LEVELS
}

/// Linear RGB of a space whose matrix to XYZ (D50) this is, to [`LINEAR`].
fn to_linear(to_xyz: &darkroot_colour::Matrix3) -> [[f32; 3]; 3] {
    let matrix = LINEAR.from_xyz_under(white::D50) * to_xyz;
    [0, 1, 2].map(|row| [0, 1, 2].map(|column| matrix[(row, column)] as f32))
}

fn matrix_of(profile: &ColorProfile) -> Result<Way, ProfileFault> {
    let curve = |trc: &Option<ToneReprCurve>| {
        let evaluator = trc.as_ref().and_then(|trc| trc.make_linear_evaluator().ok());
        let evaluator = evaluator.ok_or(ProfileFault::Empty)?;
        let value = |i: usize| evaluator.evaluate_value(i as f32 / (LEVELS - 1) as f32);
        let values: Vec<f32> = (0..LEVELS).map(value).collect();
        let sound = values.iter().all(|v| v.is_finite());
        if sound { Ok(values) } else { Err(ProfileFault::Empty) }
    };
    let curves = [curve(&profile.red_trc)?, curve(&profile.green_trc)?, curve(&profile.blue_trc)?];
    let colorants = profile.colorant_matrix().v;
    let to_xyz = darkroot_colour::Matrix3::from_fn(|row, column| colorants[row][column]);
    let volume = to_xyz.determinant().abs();
    if !volume.is_finite() || volume < 1e-9 || to_xyz.iter().any(|v| !v.is_finite()) {
        return Err(ProfileFault::Empty);
    }
    Ok(Way::Matrix { curves, matrix: to_linear(&to_xyz) })
}

fn description(profile: &ColorProfile) -> String {
    match &profile.description {
        Some(ProfileText::PlainString(text)) => text.clone(),
        Some(ProfileText::Localizable(texts)) => {
            texts.first().map_or(String::new(), |text| text.value.clone())
        }
        Some(ProfileText::Description(text)) => text.ascii_string.clone(),
        None => String::new(),
    }
}

#[cfg(test)]
mod tests;
