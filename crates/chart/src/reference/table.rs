//! A table of patches, whatever file it came from: which columns hold the colours.

use darkroot_colour::{Lab, Xyz};

use super::{NotAReference, Reference, ReferenceError, checked_lab, checked_reflectance, checked_xyz};

/// Headers and rows of cells.
pub(super) struct Table {
    pub(super) columns: Vec<String>,
    pub(super) rows: Vec<Vec<String>>,
}

/// CSV: `,`, `;` or tabs; the first row names the columns.
pub(super) fn parse_csv(text: &str) -> Result<Table, ReferenceError> {
    let first = text.lines().find(|l| !l.trim().is_empty() && !l.starts_with('#')).unwrap_or_default();
    let delimiter = [b'\t', b';', b','].into_iter().find(|d| first.contains(char::from(*d)));
    let Some(delimiter) = delimiter else {
        return Err(NotAReference::NoColumns.into());
    };
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .delimiter(delimiter)
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|e| NotAReference::Csv { message: e.to_string() })?;
        rows.push(record.iter().map(str::to_owned).collect::<Vec<_>>());
    }
    if rows.len() < 2 {
        return Err(NotAReference::NoPatches.into());
    }
    let columns = rows.remove(0);
    Ok(Table { columns, rows })
}

/// Which columns hold what.
enum Columns {
    Spectra(Vec<(f64, usize)>),
    Xyz([usize; 3]),
    Lab([usize; 3]),
}

impl Table {
    /// The patches: spectra where there are some, else XYZ, else Lab.
    pub(super) fn reference(&self) -> Result<Reference, ReferenceError> {
        let columns = self.colour_columns(self.name_column())?;
        let values = match &columns {
            Columns::Spectra(places) => self.numbers(&places.iter().map(|(_, c)| *c).collect::<Vec<_>>()),
            Columns::Xyz(places) | Columns::Lab(places) => self.numbers(places),
        }?;
        let largest = values.iter().flat_map(|(_, v)| v.iter().copied()).fold(0.0, f64::max);
        // Files have either 1 or 100 for white.
        let scale = if largest > 2.0 { 0.01 } else { 1.0 };
        let colour = |(patch, values): (String, Vec<f64>)| {
            let colour = match &columns {
                Columns::Spectra(places) => {
                    let wavelengths: Vec<f64> = places.iter().map(|(nm, _)| *nm).collect();
                    let values: Vec<f64> = values.iter().map(|v| v * scale).collect();
                    checked_reflectance(&patch, &wavelengths, &values)?
                }
                Columns::Xyz(_) => {
                    checked_xyz(&patch, Xyz::new(values[0] * scale, values[1] * scale, values[2] * scale))?
                }
                Columns::Lab(_) => checked_lab(&patch, Lab { l: values[0], a: values[1], b: values[2] })?,
            };
            Ok((patch, colour))
        };
        let patches = values.into_iter().map(colour).collect::<Result<Vec<_>, ReferenceError>>()?;
        if patches.is_empty() {
            return Err(NotAReference::NoPatches.into());
        }
        Ok(Reference { patches })
    }

    /// Red, green and blue of each row, as they stand there.
    pub(super) fn rgb(&self) -> Result<Vec<[f64; 3]>, ReferenceError> {
        let columns = self.triple([["RGB_R", "R", "RED"], ["RGB_G", "G", "GREEN"], ["RGB_B", "B", "BLUE"]]);
        let columns = columns.ok_or_else(|| ReferenceError::NoRgb(self.columns.clone()))?;
        Ok(self.numbers(&columns)?.into_iter().map(|(_, v)| [v[0], v[1], v[2]]).collect())
    }

    /// Name and numbers of each row.
    fn numbers(&self, columns: &[usize]) -> Result<Vec<(String, Vec<f64>)>, ReferenceError> {
        let name = self.name_column();
        let of_row = |(index, row): (usize, &Vec<String>)| {
            let patch = patch_name(row, name, index);
            let number = |c: &usize| {
                let cell = row.get(*c).map_or("", String::as_str);
                let value: Option<f64> = cell.replace(',', ".").parse().ok().filter(|v: &f64| v.is_finite());
                value.ok_or_else(|| ReferenceError::Number { patch: patch.clone(), cell: cell.to_owned() })
            };
            let values = columns.iter().map(number).collect::<Result<Vec<_>, _>>()?;
            Ok((patch, values))
        };
        self.rows.iter().enumerate().map(of_row).collect()
    }

    /// The places of three columns, each by one of its names.
    fn triple(&self, names: [[&str; 3]; 3]) -> Option<[usize; 3]> {
        // As it is written first: `b` is not blue where there is a `B`.
        let place = |options: [&str; 3]| {
            let find = |is: fn(&str, &str) -> bool| {
                self.columns.iter().position(|c| options.iter().any(|o| is(c, o)))
            };
            find(|c, o| c == o).or_else(|| find(str::eq_ignore_ascii_case))
        };
        let [a, b, c] = names.map(place);
        Some([a?, b?, c?])
    }

    fn name_column(&self) -> Option<usize> {
        const NAMES: [&str; 7] = ["SAMPLE_NAME", "SAMPLE_LOC", "SAMPLE_ID", "NAME", "PATCH", "ID", "SAMPLE"];
        let is = |wanted: &str| self.columns.iter().position(|c| c.eq_ignore_ascii_case(wanted));
        NAMES.iter().find_map(|name| is(name))
    }

    fn colour_columns(&self, name: Option<usize>) -> Result<Columns, ReferenceError> {
        let mut spectra: Vec<(f64, usize)> = self
            .columns
            .iter()
            .enumerate()
            .filter(|(i, _)| Some(*i) != name)
            .filter_map(|(i, c)| wavelength(c).map(|nm| (nm, i)))
            .collect();
        spectra.sort_by(|a, b| a.0.total_cmp(&b.0));
        if spectra.len() >= 10 {
            return Ok(Columns::Spectra(spectra));
        }
        let xyz = [["XYZ_X", "X", "CIE_X"], ["XYZ_Y", "Y", "CIE_Y"], ["XYZ_Z", "Z", "CIE_Z"]];
        if let Some(places) = self.triple(xyz) {
            return Ok(Columns::Xyz(places));
        }
        let lab = [["LAB_L", "L", "L*"], ["LAB_A", "a", "a*"], ["LAB_B", "b", "b*"]];
        if let Some(places) = self.triple(lab) {
            return Ok(Columns::Lab(places));
        }
        Err(ReferenceError::Columns(self.columns.clone()))
    }
}

fn patch_name(row: &[String], column: Option<usize>, index: usize) -> String {
    let named = column.and_then(|c| row.get(c)).map(|n| n.trim_matches('"').trim().to_owned());
    named.filter(|n| !n.is_empty()).unwrap_or_else(|| (index + 1).to_string())
}

/// The wavelength that a column's name tells: "400", "SPEC_400", "SPECTRAL_NM400", "nm400", "R_400nm", "400.00".
fn wavelength(column: &str) -> Option<f64> {
    let upper = column.trim_matches('"').to_ascii_uppercase();
    let digits = upper.trim_end_matches("NM");
    let digits = digits.trim_start_matches(|c: char| !c.is_ascii_digit());
    let prefix = &upper[..upper.find(|c: char| c.is_ascii_digit())?];
    let known =
        ["", "SPEC_", "SPECTRAL_", "SPECTRAL_NM", "SPECTRAL_NM_", "NM", "NM_", "R_", "R", "REFL_", "R_NM"];
    let nm: f64 = digits.parse().ok()?;
    (known.contains(&prefix) && (300.0..=1100.0).contains(&nm)).then_some(nm)
}

#[cfg(test)]
mod tests {
    use super::super::ReferenceColour;
    use super::*;

    #[test]
    fn wavelengths_are_found_in_names_of_columns() {
        for (name, nm) in [
            ("400", Some(400.0)),
            ("SPEC_410", Some(410.0)),
            ("SPECTRAL_NM420", Some(420.0)),
            ("nm430", Some(430.0)),
            ("R_440nm", Some(440.0)),
            ("450.00", Some(450.0)),
            ("XYZ_X", None),
            ("STDEV_500", None),
            ("12", None),
        ] {
            assert_eq!(wavelength(name), nm, "{name}");
        }
    }

    #[test]
    fn lab_xyz_and_spectra_are_read_from_csv() {
        let parse_csv = |text: &str| parse_csv(text).unwrap().reference();
        let lab = parse_csv("name,L,a,b\nA1,50,10,-20\nA2,90,0,1\n").unwrap();
        assert_eq!(lab.patches[0].0, "A1");
        assert_eq!(lab.patches[0].1, ReferenceColour::Lab(Lab { l: 50.0, a: 10.0, b: -20.0 }));
        let xyz = parse_csv("patch;X;Y;Z\nA1;20;18;15\nA2;85;90;74\n").unwrap();
        let ReferenceColour::Xyz(c) = &xyz.patches[1].1 else { panic!("{xyz:?}") };
        assert!((c.y - 0.9).abs() < 1e-12);
        let head: Vec<String> = (400..=700).step_by(10).map(|n| n.to_string()).collect();
        let row = vec!["43.5"; head.len()].join(",");
        let spectra = parse_csv(&format!("name,{}\nA1,{row}\n", head.join(","))).unwrap();
        assert!((spectra.patches[0].1.xyz_d50().y - 0.435).abs() < 1e-9);
    }

    #[test]
    fn impossible_colours_are_named() {
        for (text, words) in [
            ("name,X,Y,Z\nA1,50,10,-20\n", "are these columns Lab?"),
            ("name,X,Y,Z\nA1,150,140,100\n", "perfect white"),
            ("name,L,a,b\nA1,250,0,0\n", "between 0 and 100"),
            ("name,L,a,b\nA1,grey,0,0\n", "`grey` is not a number"),
            ("name,R,G,B\nA1,1,2,3\n", "name, R, G, B"),
            ("name,L,a,b\n", "no patches"),
            ("hello", "no columns"),
        ] {
            let message = parse_csv(text).and_then(|table| table.reference()).unwrap_err().to_string();
            assert!(message.contains(words), "{text}: {message}");
        }
    }
}
