//! Spectra from files: CSV with a row for each spectrum.
//!
//! The first row is `name` and the wavelengths in nm, each further row a name and the values; `,`, `;` and tabs
//! separate. The same the other way round (a row for each wavelength, its number first) is read too.

use std::path::Path;

use darkroot_colour::Spectrum;
use darkroot_colour::measured::Measured;

use darkroot_profile::Sensitivities;

use crate::fault::SpectraError;
use crate::{Error, files};

/// The spectra of one file.
#[derive(Debug, Clone, PartialEq)]
pub struct SpectraFile {
    /// Name and spectrum of each row.
    pub spectra: Vec<(String, Measured)>,
    /// SHA-256 of the file, hexadecimal.
    pub sha256: String,
}

impl SpectraFile {
    /// As reflectances, 380 to 780 nm every 5 nm: smoothly interpolated where the samples are wider apart, and
    /// held between 0 and 1.
    pub fn reflectances(&self) -> Vec<Spectrum> {
        self.spectra.iter().map(|(_, s)| clamped(&smooth(s), 1.0)).collect()
    }

    /// As lights: linear in between, or the mean around each sample where they are closer than 5 nm.
    pub fn lights(&self) -> Vec<(String, Spectrum)> {
        self.spectra.iter().map(|(name, s)| (name.clone(), clamped(&s.averaged(), f64::INFINITY))).collect()
    }

    /// Only the spectra of these names, in their sequence.
    ///
    /// # Errors
    /// A name that the file does not have; it is given back.
    pub fn only(&self, names: &[String]) -> Result<Self, String> {
        let find =
            |name: &String| self.spectra.iter().find(|(n, _)| n == name).cloned().ok_or_else(|| name.clone());
        let spectra = names.iter().map(find).collect::<Result<_, _>>()?;
        Ok(Self { spectra, sha256: self.sha256.clone() })
    }
}

/// Reads a file of spectra.
///
/// # Errors
/// A file that cannot be read, or is not laid out as above.
pub fn read(path: &Path) -> Result<SpectraFile, Error> {
    let bytes = files::read_text(path)?;
    let sha256 = files::sha256(&bytes);
    let wrong = |fault: SpectraError| Error::spectra(path, fault);
    let text = String::from_utf8(bytes).map_err(|_| wrong(SpectraError::NotText))?;
    let spectra = parse(&text).map_err(wrong)?;
    Ok(SpectraFile { spectra, sha256 })
}

/// Reads a camera's sensitivities: a file of three spectra, red, green and blue, by name or in that sequence.
///
/// # Errors
/// As [`read`], and a file without exactly three spectra.
pub fn read_sensitivities(path: &Path) -> Result<(Sensitivities, SpectraFile), Error> {
    let file = read(path)?;
    let named = |letter: &str| {
        let is = |name: &str| name.trim().to_lowercase().starts_with(letter);
        file.spectra.iter().find(|(name, _)| is(name)).map(|(_, s)| s)
    };
    let channels = match (named("r"), named("g"), named("b"), file.spectra.as_slice()) {
        (Some(r), Some(g), Some(b), [_, _, _]) => [r, g, b],
        (_, _, _, [(_, r), (_, g), (_, b)]) => [r, g, b],
        (_, _, _, all) => {
            return Err(Error::spectra(path, SpectraError::NotThree { count: all.len() }));
        }
    };
    let sensitivities = Sensitivities(channels.map(|s| clamped(&smooth(s), f64::INFINITY)));
    Ok((sensitivities, file))
}

fn smooth(measured: &Measured) -> Spectrum {
    measured.smooth().unwrap_or_else(|| measured.spectrum())
}

fn clamped(spectrum: &Spectrum, highest: f64) -> Spectrum {
    Spectrum(spectrum.0.map(|v| v.clamp(0.0, highest)))
}

fn parse(text: &str) -> Result<Vec<(String, Measured)>, SpectraError> {
    let rows = rows(text)?;
    let number = |cell: &String| cell.parse::<f64>().ok();
    let first = rows.first().ok_or(SpectraError::Empty)?;
    let by_row = first.len() > 2 && first[1..].iter().all(|cell| number(cell).is_some());
    let rows = if by_row { rows } else { transposed(&rows) };
    let (head, body) = rows.split_first().ok_or(SpectraError::Empty)?;
    let wavelengths = head[1..]
        .iter()
        .map(|cell| number(cell).ok_or_else(|| SpectraError::Wavelength { cell: cell.clone() }))
        .collect::<Result<Vec<_>, _>>()?;
    let spectrum = |row: &Vec<String>| {
        let name = row[0].clone();
        let values = row[1..]
            .iter()
            .map(|cell| {
                number(cell).ok_or_else(|| SpectraError::Number { name: name.clone(), cell: cell.clone() })
            })
            .collect::<Result<Vec<_>, _>>()?;
        match Measured::new(&wavelengths, &values) {
            Ok(measured) => Ok((name, measured)),
            Err(source) => Err(SpectraError::Spectrum { name, source }),
        }
    };
    let spectra = body.iter().map(spectrum).collect::<Result<Vec<_>, _>>()?;
    if spectra.is_empty() {
        return Err(SpectraError::NoSpectrum);
    }
    Ok(spectra)
}

fn rows(text: &str) -> Result<Vec<Vec<String>>, SpectraError> {
    let first = text.lines().find(|l| !l.trim().is_empty() && !l.starts_with('#')).unwrap_or_default();
    let delimiter = [b'\t', b';', b','].into_iter().find(|d| first.contains(char::from(*d))).unwrap_or(b',');
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .delimiter(delimiter)
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(text.trim_start_matches('\u{feff}').as_bytes());
    let record = |r: Result<csv::StringRecord, csv::Error>| {
        Ok::<Vec<String>, SpectraError>(r?.iter().map(str::to_owned).collect())
    };
    reader.records().map(record).collect()
}

/// Rows as columns; the reader has seen to equal lengths.
fn transposed(rows: &[Vec<String>]) -> Vec<Vec<String>> {
    let width = rows.first().map_or(0, Vec::len);
    (0..width).map(|c| rows.iter().map(|row| row[c].clone()).collect()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(step: usize) -> String {
        let nm: Vec<usize> = (400..=700).step_by(step).collect();
        let line = |name: &str, f: &dyn Fn(f64) -> f64| {
            let values: Vec<String> = nm.iter().map(|w| f(*w as f64).to_string()).collect();
            format!("{name},{}\n", values.join(","))
        };
        let head: Vec<String> = nm.iter().map(ToString::to_string).collect();
        format!("name,{}\n", head.join(",")) + &line("one", &|w| w / 1000.0) + &line("two", &|_| 0.5)
    }

    #[test]
    fn rows_and_columns_are_both_read() {
        let by_row = parse(&table(10)).unwrap();
        assert_eq!(by_row.iter().map(|(n, _)| n.as_str()).collect::<Vec<_>>(), ["one", "two"]);
        assert!((by_row[0].1.at(555.0) - 0.555).abs() < 1e-12);
        let turned: String =
            transposed(&rows(&table(10)).unwrap()).iter().map(|row| row.join(";") + "\n").collect();
        assert_eq!(parse(&turned).unwrap(), by_row);
    }

    #[test]
    fn faults_of_a_table_are_named() {
        for (text, word) in [
            (String::new(), "empty"),
            ("name,400,410\na,1".to_owned(), "table"),
            (table(10).replace("0.5", "half"), "`half`"),
            (table(10).replace("name,400", "name,450"), "ascend"),
            (table(10).lines().next().unwrap_or_default().to_owned(), "no spectrum"),
            ("name,400,401\na,1,2".to_owned(), "700 nm"),
        ] {
            let message = parse(&text).unwrap_err().to_string();
            assert!(message.contains(word), "{message}");
        }
    }
}
