//! The tables that `build.rs` writes, read where they lie.
//!
//! `lenses.tsv` has a line for each mount (`M`, name, compatible mounts), camera (`C`, makers, models, mount, crop factor)
//! and lens (`L`, see [`Lens`]), with tabs between fields and the character U+001F between texts of a field.
//! `numbers.bin` has the coefficients, `f32` with the low byte first: for each lens its rows of distortion, TCA and
//! vignetting.

const TEXT: &str = include_str!(concat!(env!("OUT_DIR"), "/lenses.tsv"));
const NUMBERS: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/numbers.bin"));

/// The texts of a field; the first is the one that cameras write.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Texts(&'static str);

impl Texts {
    pub(crate) fn iter(self) -> impl Iterator<Item = &'static str> {
        self.0.split('\u{1f}').filter(|text| !text.is_empty())
    }

    pub(crate) fn first(self) -> &'static str {
        self.iter().next().unwrap_or_default()
    }
}

/// A camera of the database.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Camera {
    pub(crate) makers: Texts,
    pub(crate) models: Texts,
    pub(crate) mount: &'static str,
    /// Diagonal of a 36 mm x 24 mm frame through that of the sensor.
    pub(crate) crop: f64,
}

impl Camera {
    /// Whether its lens cannot be changed: mounts of such cameras are written with a small letter.
    pub(crate) fn is_fixed(&self) -> bool {
        is_fixed(self.mount)
    }

    /// Mounts of lenses that fit, with or without adapter.
    pub(crate) fn mounts(&self) -> Vec<&'static str> {
        let compatible = lines("M").filter(|line| field(line, 1) == self.mount);
        let compatible = compatible.flat_map(|line| Texts(field(line, 2)).iter());
        std::iter::once(self.mount).chain(compatible).collect()
    }
}

/// Whether a mount belongs to cameras whose lens cannot be changed.
pub(crate) fn is_fixed(mount: &str) -> bool {
    mount.starts_with(|first: char| first.is_ascii_lowercase())
}

/// A lens of the database, as measured on one size of sensor: its line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Lens(&'static str);

impl Lens {
    pub(crate) fn makers(self) -> Texts {
        Texts(field(self.0, 1))
    }

    pub(crate) fn models(self) -> Texts {
        Texts(field(self.0, 2))
    }

    pub(crate) fn mounts(self) -> Texts {
        Texts(field(self.0, 3))
    }

    /// Shortest and longest focal length in mm; 0 if not known.
    pub(crate) fn focal_range(self) -> (f64, f64) {
        (number(self.0, 4), number(self.0, 5))
    }

    /// Crop factor of the camera that it was measured with.
    pub(crate) fn crop(self) -> f64 {
        number(self.0, 6)
    }

    /// Aspect ratio of the pictures that it was measured with, at least 1.
    pub(crate) fn aspect(self) -> f64 {
        number(self.0, 7)
    }

    /// Whether distortion is of the model `poly5`, else it is `ptlens`.
    pub(crate) fn is_poly5(self) -> bool {
        field(self.0, 8) == "poly5"
    }

    /// Focal length in mm and three coefficients (`a b c`, or `k1 k2 0`).
    pub(crate) fn distortion(self) -> Vec<[f64; 4]> {
        rows(self.count(9), self.count(10))
    }

    /// Focal length in mm; constant, linear and quadratic coefficient of red; of blue.
    pub(crate) fn tca(self) -> Vec<[f64; 7]> {
        rows(self.count(9) + 4 * self.count(10), self.count(11))
    }

    /// Focal length in mm, f-number, distance in m, and three coefficients.
    pub(crate) fn vignetting(self) -> Vec<[f64; 6]> {
        rows(self.count(9) + 4 * self.count(10) + 7 * self.count(11), self.count(12))
    }

    fn count(self, index: usize) -> usize {
        field(self.0, index).parse().unwrap_or_default()
    }
}

/// The cameras whose lines have all of these texts somewhere: a first choice that is cheap.
pub(crate) fn cameras(with: &[&str]) -> impl Iterator<Item = Camera> {
    lines("C").filter(move |line| with.iter().all(|text| line.contains(text))).map(|line| Camera {
        makers: Texts(field(line, 1)),
        models: Texts(field(line, 2)),
        mount: field(line, 3),
        crop: number(line, 4),
    })
}

/// The lenses whose lines have all of these texts somewhere.
pub(crate) fn lenses(with: &[&str]) -> impl Iterator<Item = Lens> {
    lines("L").filter(move |line| with.iter().all(|text| line.contains(text))).map(Lens)
}

fn lines(kind: &str) -> impl Iterator<Item = &'static str> {
    TEXT.lines().filter(move |line| field(line, 0) == kind)
}

fn field(line: &str, index: usize) -> &str {
    line.split('\t').nth(index).unwrap_or_default()
}

fn number(line: &str, index: usize) -> f64 {
    field(line, index).parse().unwrap_or_default()
}

/// `count` rows from the number `from` on; none if the table ends before.
fn rows<const N: usize>(from: usize, count: usize) -> Vec<[f64; N]> {
    let end = from + N * count;
    let bytes = NUMBERS.get(4 * from..4 * end).unwrap_or_default();
    let numbers: Vec<f64> = bytes.as_chunks().0.iter().map(|b| f64::from(f32::from_le_bytes(*b))).collect();
    numbers.as_chunks().0.to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_line_has_all_that_it_must() {
        let (mut distortion, mut tca, mut vignetting) = (0, 0, 0);
        for lens in lenses(&[]) {
            assert!(lens.crop() > 0.0 && lens.aspect() >= 1.0, "{lens:?}");
            assert!(lens.mounts().iter().count() > 0 && !lens.models().first().is_empty(), "{lens:?}");
            assert_eq!(lens.distortion().len(), lens.count(10), "{lens:?}");
            assert_eq!(lens.tca().len(), lens.count(11), "{lens:?}");
            assert_eq!(lens.vignetting().len(), lens.count(12), "{lens:?}");
            distortion += lens.distortion().len();
            tca += lens.tca().len();
            vignetting += lens.vignetting().len();
        }
        for camera in cameras(&[]) {
            assert!(camera.crop > 0.0 && !camera.mount.is_empty(), "{camera:?}");
        }
        // Counted in the XML files of lensfun 0.7.0; what is missing was measured again.
        assert_eq!((cameras(&[]).count(), lenses(&[]).count()), (1041, 1543));
        assert!(distortion > 6300 && tca > 3600 && vignetting > 29000, "{distortion} {tca} {vignetting}");
        assert_eq!(NUMBERS.len(), 4 * (4 * distortion + 7 * tca + 6 * vignetting));
    }

    #[test]
    fn a_body_takes_the_lenses_of_compatible_mounts() {
        let camera = cameras(&[]).find(|c| c.models.first() == "Canon EOS 550D").unwrap();
        let mounts = camera.mounts();
        assert!(mounts.contains(&"Canon EF-S") && mounts.contains(&"Canon EF"));
        assert!(!mounts.contains(&"Nikon Z"));
    }
}
