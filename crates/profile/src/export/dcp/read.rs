//! Bytes to a DCP, within their bounds, by whatever program they were written.

use darkroot_colour::adaptation::bradford;
use darkroot_colour::{Matrix3, Vector3, white};

use super::file::{kind, tag};
use super::{Dcp, DcpLight, HueSatMap, light_of};
use crate::export::{DcpFault, Error};
use crate::{LookTable, Rendering, ToneCurve};

/// Most stops by which a DCP may change exposure.
const MOST_STOPS: f64 = 10.0;

/// Reads a DCP.
pub(super) fn read(bytes: &[u8]) -> Result<Dcp, Error> {
    let big = match bytes.get(..4) {
        Some(b"IIRC") => false,
        Some(b"MMCR") => true,
        _ => return Err(DcpFault::Begin.into()),
    };
    let file = File { bytes, big };
    let count = if file.has(tag::COLOR_MATRIX[1]) { 2 } else { 1 };
    let lights: Option<Vec<DcpLight>> = (0..count).map(|i| file.light(i)).collect();
    Ok(Dcp {
        camera: file.text(tag::CAMERA).ok_or(DcpFault::NoCamera)?,
        name: file.text(tag::NAME).unwrap_or_default(),
        lights: lights.ok_or(DcpFault::Light)?,
        rendering: file.rendering(),
        left_out: file.left_out(),
    })
}

/// A file whose first directory is read.
struct File<'a> {
    bytes: &'a [u8],
    /// Whether the highest byte of a number comes first.
    big: bool,
}

impl<'a> File<'a> {
    /// The first or the second light. Where there is no forward matrix the color matrix implies one, by its inverse and
    /// Bradford adaptation from the white of the light; where there is no table it is one that changes nothing.
    fn light(&self, i: usize) -> Option<DcpLight> {
        let code = self.integers(tag::ILLUMINANT[i]).and_then(|n| n.first().copied());
        let illuminant = code.and_then(|n| u16::try_from(n).ok()).unwrap_or(0);
        let color_matrix = self.matrix(tag::COLOR_MATRIX[i])?;
        let forward_matrix = if self.has(tag::FORWARD_MATRIX[i]) {
            self.matrix(tag::FORWARD_MATRIX[i])?
        } else {
            let light = light_of(illuminant).xy.xyz();
            let balance = Matrix3::from_diagonal(&(color_matrix * Vector3::from(light)));
            bradford(light, white::D50) * color_matrix.try_inverse()? * balance
        };
        let own_map = if self.has(tag::MAP[i]) { tag::MAP[i] } else { tag::MAP[0] };
        let map = if self.has(own_map) { self.map(own_map)? } else { HueSatMap::neutral() };
        Some(DcpLight { illuminant, color_matrix, forward_matrix, map })
    }

    /// What a Darkroot profile has no place for, in words.
    fn left_out(&self) -> Vec<String> {
        let mut words = Vec::new();
        for (is_out, what) in [
            (self.has(tag::LOOK) && self.look().is_none(), "its look table, which is unusable"),
            (self.has(tag::TONE_CURVE) && self.curve().is_none(), "its tone curve, which is unusable"),
            (self.has(tag::THIRD_LIGHT), "its third light"),
        ] {
            if is_out {
                words.push(what.to_owned());
            }
        }
        if let Some([_, _, layers]) = self.integers(tag::MAP_DIMENSIONS).as_deref()
            && *layers > 1
        {
            words.push(format!("all but one of the {layers} layers of its table"));
        }
        words
    }

    /// How its maker would show colours, as far as that is usable.
    fn rendering(&self) -> Rendering {
        let exposure = self.fractions(tag::EXPOSURE_OFFSET).and_then(|all| all.first().copied());
        let exposure = exposure.filter(|stops| stops.abs() <= MOST_STOPS).unwrap_or(0.0);
        Rendering { exposure, table: self.look(), curve: self.curve() }
    }

    fn curve(&self) -> Option<ToneCurve> {
        let numbers: Vec<f64> = self.floats(tag::TONE_CURVE)?.map(f64::from).collect();
        ToneCurve::new(numbers.chunks_exact(2).map(|p| [p[0], p[1]]).collect())
    }

    fn look(&self) -> Option<LookTable> {
        let divisions: [usize; 3] = self.integers(tag::LOOK_DIMENSIONS)?.try_into().ok()?;
        let numbers: Vec<f32> = self.floats(tag::LOOK)?.collect();
        let nodes = numbers.chunks_exact(3).map(|n| [n[0], n[1], n[2]]).collect();
        let coded = self.integers(tag::LOOK_ENCODING).is_some_and(|e| e == [1]);
        LookTable::new(divisions, coded, nodes)
    }

    /// Whether there is an entry, be its values usable or not.
    fn has(&self, tag: u16) -> bool {
        self.place(tag).is_some()
    }

    /// Where an entry stands.
    fn place(&self, tag: u16) -> Option<usize> {
        let start = self.long(4)?;
        let count = usize::from(self.short(start)?);
        let place = |i: usize| start.checked_add(2 + 12 * i);
        (0..count).map_while(place).find(|at| self.short(*at) == Some(tag))
    }

    /// Type, and the bytes of the values.
    fn entry(&self, tag: u16) -> Option<(u16, &'a [u8])> {
        let at = self.place(tag)?;
        let kind = self.short(at + 2)?;
        let size = match kind {
            kind::ASCII | kind::BYTE => 1,
            kind::SHORT => 2,
            kind::LONG | kind::FLOAT => 4,
            kind::SIGNED_RATIONAL => 8,
            _ => return None,
        };
        let length = self.long(at + 4)?.checked_mul(size)?;
        let from = if length <= 4 { at + 8 } else { self.long(at + 8)? };
        Some((kind, self.bytes.get(from..from.checked_add(length)?)?))
    }

    fn text(&self, tag: u16) -> Option<String> {
        let (kind, bytes) = self.entry(tag)?;
        let end = bytes.iter().position(|b| *b == 0).unwrap_or(bytes.len());
        let is_text = matches!(kind, kind::ASCII | kind::BYTE);
        is_text.then(|| String::from_utf8_lossy(&bytes[..end]).into_owned())
    }

    fn integers(&self, tag: u16) -> Option<Vec<usize>> {
        let (kind, bytes) = self.entry(tag)?;
        match kind {
            kind::SHORT => {
                Some(self.numbers::<2>(bytes).map(|b| usize::from(u16::from_le_bytes(b))).collect())
            }
            kind::LONG => Some(self.numbers::<4>(bytes).map(|b| u32::from_le_bytes(b) as usize).collect()),
            _ => None,
        }
    }

    fn matrix(&self, tag: u16) -> Option<Matrix3> {
        let numbers = self.fractions(tag)?;
        (numbers.len() == 9).then(|| Matrix3::from_row_slice(&numbers))
    }

    /// Signed fractions, all of them finite.
    fn fractions(&self, tag: u16) -> Option<Vec<f64>> {
        let (kind, bytes) = self.entry(tag)?;
        let integers: Vec<f64> = self.numbers::<4>(bytes).map(|b| i32::from_le_bytes(b).into()).collect();
        let numbers: Vec<f64> = integers.chunks_exact(2).map(|f| f[0] / f[1]).collect();
        (kind == kind::SIGNED_RATIONAL && numbers.iter().all(|v| v.is_finite())).then_some(numbers)
    }

    fn floats(&self, tag: u16) -> Option<impl Iterator<Item = f32> + 'a> {
        let (kind, bytes) = self.entry(tag)?;
        (kind == kind::FLOAT).then(|| self.numbers::<4>(bytes).map(f32::from_le_bytes))
    }

    /// A table; of several layers the one for middle grey.
    fn map(&self, tag: u16) -> Option<HueSatMap> {
        let dimensions = self.integers(tag::MAP_DIMENSIONS)?;
        let [hues, saturations, layers] = dimensions[..] else { return None };
        let numbers: Vec<f64> = self.floats(tag)?.map(f64::from).collect();
        let nodes: Vec<[f64; 3]> = numbers.chunks_exact(3).map(|n| [n[0], n[1], n[2]]).collect();
        let layer = hues.checked_mul(saturations).filter(|n| n.checked_mul(layers) == Some(nodes.len()))?;
        // 0.18, as it is or with the curve of sRGB.
        let coded = self.integers(tag::MAP_ENCODING).is_some_and(|e| e == [1]);
        let middle = if coded { 0.46 } else { 0.18 };
        let first = (middle * layers.checked_sub(1)? as f64).round() as usize * layer;
        let nodes = nodes.get(first..first + layer)?.to_vec();
        HueSatMap::new(hues, saturations, nodes)
    }

    fn short(&self, at: usize) -> Option<u16> {
        let bytes = self.bytes.get(at..at.checked_add(2)?)?;
        self.numbers(bytes).next().map(u16::from_le_bytes)
    }

    fn long(&self, at: usize) -> Option<usize> {
        let bytes = self.bytes.get(at..at.checked_add(4)?)?;
        self.numbers(bytes).next().map(|b| u32::from_le_bytes(b) as usize)
    }

    /// The numbers of N bytes, the lowest byte first.
    fn numbers<const N: usize>(&self, bytes: &'a [u8]) -> impl Iterator<Item = [u8; N]> + 'a {
        let big = self.big;
        bytes.chunks_exact(N).filter_map(move |b| {
            let mut number: [u8; N] = b.try_into().ok()?;
            if big {
                number.reverse();
            }
            Some(number)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::dcp::WithNeutral;
    use crate::export::dcp::file::write;
    use crate::export::tests::{calibration, models, profile};
    use crate::{Calibration, Light};
    use darkroot_colour::white;

    fn two_lights() -> Dcp {
        let one = calibration(models().remove(1));
        let light = Light { name: "A".into(), xy: white::A_XY };
        let two = Calibration { light, ..calibration(models().remove(2)) };
        let with = [&one, &two].map(|calibration| WithNeutral { calibration, neutral: [0.4, 1.0, 0.6] });
        Dcp::of(&profile(vec![one.clone(), two.clone()]), &with).unwrap()
    }

    #[test]
    fn a_file_says_what_was_written() {
        let dcp = two_lights();
        let read = read(&write(&dcp)).unwrap();
        assert_eq!((&read.camera, &read.name), (&dcp.camera, &dcp.name));
        assert_eq!(read.lights.iter().map(|l| l.illuminant).collect::<Vec<_>>(), [17, 21]);
        for (read, made) in read.lights.iter().zip(&dcp.lights) {
            assert_eq!(read.forward_matrix, made.forward_matrix);
            assert!((read.color_matrix - made.color_matrix).amax() < 1e-6);
            let nodes = read.map.nodes().iter().flatten().zip(made.map.nodes().iter().flatten());
            assert!(nodes.into_iter().all(|(a, b)| (a - b).abs() < 1e-5));
        }
    }

    #[test]
    fn broken_files_are_errors_and_no_panics() {
        let good = write(&two_lights());
        for length in [0, 3, 8, 20, 100, 250, 1000, good.len() - 1] {
            assert!(read(&good[..length]).is_err(), "{length}");
        }
        for at in 0..600 {
            let mut broken = good.clone();
            broken[at] ^= 0xff;
            if let Ok(read) = read(&broken) {
                assert!(read.lights.iter().all(|l| l.map.apply([0.1, 0.5, 0.9]).len() == 3));
            }
        }
    }
}
