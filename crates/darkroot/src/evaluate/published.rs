//! Published colour matrices from a table: CSV with a row a camera.
//!
//! The columns are found by their names: `make`, `model`, and `D65_00`, `D65_01` ... `D65_22` for the matrix from XYZ to
//! camera RGB that serves D65, row by row. Rows without numbers there are passed over.

use std::path::Path;

use darkroot_colour::Matrix3;
use darkroot_profile::ProfileCamera;

use crate::fault::SpectraError;
use crate::{Error, files};

/// The published D65 matrix of a camera.
#[derive(Debug, Clone, PartialEq)]
pub struct Published {
    /// Maker.
    pub make: String,
    /// Model without the maker.
    pub model: String,
    /// XYZ to camera RGB.
    pub matrix: Matrix3,
}

impl Published {
    /// Maker and model in one.
    pub fn name(&self) -> String {
        format!("{} {}", self.make, self.model)
    }
}

/// Reads the table.
///
/// # Errors
/// A file that cannot be read, or without these columns.
pub fn read(path: &Path) -> Result<Vec<Published>, Error> {
    let bytes = files::read_text(path)?;
    let wrong = |fault: SpectraError| Error::spectra(path, fault);
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(bytes.as_slice());
    let head = reader.headers().map_err(|e| wrong(e.into()))?.clone();
    let column = |name: &str| {
        let place = head.iter().position(|h| h == name);
        place.ok_or_else(|| wrong(SpectraError::NoColumn { name: name.to_owned() }))
    };
    let (make, model) = (column("make")?, column("model")?);
    let mut numbers = [0; 9];
    for (i, number) in numbers.iter_mut().enumerate() {
        *number = column(&format!("D65_{}{}", i / 3, i % 3))?;
    }
    let mut all = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|e| wrong(e.into()))?;
        let cell = |i: usize| record.get(i).unwrap_or_default().to_owned();
        let values: Option<Vec<f64>> = numbers.iter().map(|i| cell(*i).parse().ok()).collect();
        if let Some(values) = values.filter(|v| v.iter().all(|v| v.is_finite())) {
            all.push(Published {
                make: cell(make),
                model: cell(model),
                matrix: Matrix3::from_row_slice(&values),
            });
        }
    }
    Ok(all)
}

/// The matrix of a camera, by any of its names.
pub fn of(all: &[Published], camera: &ProfileCamera) -> Option<Matrix3> {
    let names = std::iter::once(camera.name()).chain(camera.aliases.iter().cloned());
    names.map(|name| key(&name)).find_map(|name| named(all, &name)).map(|p| p.matrix)
}

/// The row of a camera whose [`key`] this is.
pub(super) fn named<'a>(all: &'a [Published], key: &str) -> Option<&'a Published> {
    all.iter().find(|p| self::key(&p.name()) == key)
}

/// A camera's name as it is compared: small letters and digits, without Canon's "EOS", which many leave out.
pub(super) fn key(name: &str) -> String {
    let letters = name.chars().filter(char::is_ascii_alphanumeric).collect::<String>().to_lowercase();
    letters.replace("eos", "")
}
