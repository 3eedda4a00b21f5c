//! Tables of patches that a camera has seen: its RGB beside what the patches are, as Argyll's `scanin` writes them.

use super::{ReferenceColour, ReferenceError, parse_table};

/// A patch and what a camera made of it.
#[derive(Debug, Clone, PartialEq)]
pub struct PhotographedPatch {
    /// Its name; the number of its row where there is none.
    pub name: String,
    /// Linear camera RGB, black subtracted, not balanced; the largest value of the table is 1.
    pub rgb: [f64; 3],
    /// What it is.
    pub colour: ReferenceColour,
}

/// Reads a table (CGATS, Argyll's `.ti3`, CSV) with columns for camera RGB in any unit, and for spectra, XYZ or Lab.
///
/// # Errors
/// Another format, columns that are missing, values that are no numbers or no colours of surfaces.
pub fn photographed(text: &str) -> Result<Vec<PhotographedPatch>, ReferenceError> {
    let table = parse_table(text.trim_start_matches('\u{feff}'))?;
    let rgb = table.rgb()?;
    let largest = rgb.iter().flatten().copied().fold(0.0, f64::max);
    let scale = if largest > 0.0 { 1.0 / largest } else { 1.0 };
    let patches = table.reference()?.patches.into_iter().zip(rgb);
    let one = |((name, colour), rgb): (_, [f64; 3])| PhotographedPatch {
        name,
        rgb: rgb.map(|v| v * scale),
        colour,
    };
    Ok(patches.map(one).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rgb_stands_beside_the_colours_in_any_unit() {
        let text = "patch,R,G,B,X,Y,Z\nA1,1000,3000,2000,20,18,15\nA2,5000,10000,7000,85,90,74\n";
        let patches = photographed(text).unwrap();
        assert_eq!(patches[0].name, "A1");
        assert!(patches[0].rgb.iter().zip([0.1, 0.3, 0.2]).all(|(found, told)| (found - told).abs() < 1e-12));
        assert!((patches[1].colour.xyz_d50().y - 0.9).abs() < 1e-12);
        // Blue is not b*.
        for text in ["L,a,b,R,G,B\n50,10,-20,1,2,4\n", "R,G,B,L,a,b\n1,2,4,50,10,-20\n"] {
            let patch = &photographed(text).unwrap()[0];
            assert!(patch.rgb.iter().zip([0.25, 0.5, 1.0]).all(|(found, told)| (found - told).abs() < 1e-12));
            assert_eq!(
                patch.colour,
                ReferenceColour::Lab(darkroot_colour::Lab { l: 50.0, a: 10.0, b: -20.0 })
            );
        }
    }

    #[test]
    fn a_table_without_rgb_says_what_it_lacks() {
        let message = photographed("name,X,Y,Z\nA1,20,18,15\n").unwrap_err().to_string();
        assert!(message.contains("RGB_R") && message.contains("name, X, Y, Z"), "{message}");
        let message = photographed("name,R,G,B,X,Y,Z\nA1,1,red,3,20,18,15\n").unwrap_err().to_string();
        assert!(message.contains("patch A1: `red` is not a number"), "{message}");
    }
}
