//! Illuminants that the CIE names, with their spectra.

use crate::spectrum::SAMPLES;
use crate::tables::{daylight, discharge, fluorescent, fluorescent_3, led};
use crate::{Spectrum, Xyz};

/// A light that the CIE publishes as a table or a formula.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Illuminant {
    /// Name as this program writes it: `D65`, `F11`, `F3.4`, `LED-B3`.
    pub name: &'static str,
    power: Power,
}

/// Where the spectrum comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Power {
    A,
    E,
    Table(&'static [f64; SAMPLES]),
}

const fn table(name: &'static str, power: &'static [f64; SAMPLES]) -> Illuminant {
    Illuminant { name, power: Power::Table(power) }
}

/// Every illuminant that [`Illuminant::by_name`] knows, in the order of CIE 015:2018.
pub const ILLUMINANTS: [Illuminant; 48] = [
    Illuminant { name: "A", power: Power::A },
    table("C", &discharge::C),
    table("D50", &daylight::D50),
    table("D55", &daylight::D55),
    table("D65", &daylight::D65),
    table("D75", &daylight::D75),
    Illuminant { name: "E", power: Power::E },
    table("F1", &fluorescent::FL1),
    table("F2", &fluorescent::FL2),
    table("F3", &fluorescent::FL3),
    table("F4", &fluorescent::FL4),
    table("F5", &fluorescent::FL5),
    table("F6", &fluorescent::FL6),
    table("F7", &fluorescent::FL7),
    table("F8", &fluorescent::FL8),
    table("F9", &fluorescent::FL9),
    table("F10", &fluorescent::FL10),
    table("F11", &fluorescent::FL11),
    table("F12", &fluorescent::FL12),
    table("F3.1", &fluorescent_3::FL3_1),
    table("F3.2", &fluorescent_3::FL3_2),
    table("F3.3", &fluorescent_3::FL3_3),
    table("F3.4", &fluorescent_3::FL3_4),
    table("F3.5", &fluorescent_3::FL3_5),
    table("F3.6", &fluorescent_3::FL3_6),
    table("F3.7", &fluorescent_3::FL3_7),
    table("F3.8", &fluorescent_3::FL3_8),
    table("F3.9", &fluorescent_3::FL3_9),
    table("F3.10", &fluorescent_3::FL3_10),
    table("F3.11", &fluorescent_3::FL3_11),
    table("F3.12", &fluorescent_3::FL3_12),
    table("F3.13", &fluorescent_3::FL3_13),
    table("F3.14", &fluorescent_3::FL3_14),
    table("F3.15", &fluorescent_3::FL3_15),
    table("HP1", &discharge::HP1),
    table("HP2", &discharge::HP2),
    table("HP3", &discharge::HP3),
    table("HP4", &discharge::HP4),
    table("HP5", &discharge::HP5),
    table("LED-B1", &led::LED_B1),
    table("LED-B2", &led::LED_B2),
    table("LED-B3", &led::LED_B3),
    table("LED-B4", &led::LED_B4),
    table("LED-B5", &led::LED_B5),
    table("LED-BH1", &led::LED_BH1),
    table("LED-RGB1", &led::LED_RGB1),
    table("LED-V1", &led::LED_V1),
    table("LED-V2", &led::LED_V2),
];

impl Illuminant {
    /// The illuminant of a name: `A`, `C`, `D50`, `D55`, `D65`, `D75`, `E`, `F1` to `F12`, `F3.1` to `F3.15`, `HP1` to
    /// `HP5`, `LED-B1` to `LED-B5`, `LED-BH1`, `LED-RGB1`, `LED-V1`, `LED-V2`. Capitals, blanks, `-` and `_` do not
    /// matter, and `FL11` is `F11`.
    pub fn by_name(name: &str) -> Option<Self> {
        let wanted = key(name);
        ILLUMINANTS.into_iter().find(|light| key(light.name) == wanted)
    }

    /// Relative power, 380 to 780 nm every 5 nm. The scale is that of the CIE (about 100 at 560 nm for A, C, D and
    /// E) and without meaning for colours relative to the white.
    pub fn spectrum(self) -> Spectrum {
        match self.power {
            Power::A => Spectrum::illuminant_a().scaled(100.0),
            Power::E => Spectrum::constant(100.0),
            Power::Table(power) => Spectrum(*power),
        }
    }

    /// Tristimulus values of the perfect diffuser under this light for the CIE 1931 observer, Y = 1.
    pub fn white(self) -> Xyz {
        self.spectrum().white()
    }
}

/// A name without what people write differently.
fn key(name: &str) -> String {
    let plain: String =
        name.chars().filter(|c| !matches!(c, ' ' | '-' | '_')).map(|c| c.to_ascii_uppercase()).collect();
    match plain.strip_prefix("FL") {
        Some(number) => format!("F{number}"),
        None => plain,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Name; X and Z of the white with Y = 1: `sd_to_XYZ(sd_constant(1, shape), cmfs, light, method="Integration")` with
    /// shape 380-780 nm every 5 nm, colour-science 0.4.7; x and y as the CIE publishes them (`CCS_ILLUMINANTS` there).
    #[rustfmt::skip]
    const PUBLISHED: [(&str, f64, f64, f64, f64); 48] = [
        ("A", 1.098490, 0.355825, 0.44758, 0.40745),
        ("C", 0.980717, 1.182249, 0.31006, 0.31616),
        ("D50", 0.964197, 0.825123, 0.34570, 0.35850),
        ("D55", 0.956791, 0.921367, 0.33243, 0.34744),
        ("D65", 0.950430, 1.088801, 0.31270, 0.32900),
        ("D75", 0.949674, 1.226140, 0.29903, 0.31488),
        ("E", 1.000009, 1.000010, 0.33333, 0.33333),
        ("F1", 0.928675, 1.037747, 0.31310, 0.33710),
        ("F2", 0.991858, 0.673938, 0.37210, 0.37510),
        ("F3", 1.037991, 0.499326, 0.40910, 0.39410),
        ("F4", 1.092015, 0.388816, 0.44020, 0.40310),
        ("F5", 0.909018, 0.988183, 0.31380, 0.34520),
        ("F6", 0.973425, 0.602606, 0.37790, 0.38820),
        ("F7", 0.950416, 1.087489, 0.31290, 0.32920),
        ("F8", 0.964274, 0.824211, 0.34580, 0.35860),
        ("F9", 1.003797, 0.679440, 0.37410, 0.37270),
        ("F10", 0.963847, 0.823547, 0.34580, 0.35880),
        ("F11", 1.009610, 0.643506, 0.38050, 0.37690),
        ("F12", 1.081168, 0.392763, 0.43700, 0.40420),
        ("F3.1", 1.092678, 0.386877, 0.44070, 0.40330),
        ("F3.2", 1.019872, 0.658538, 0.38080, 0.37340),
        ("F3.3", 0.916891, 0.991262, 0.31530, 0.34390),
        ("F3.4", 1.095432, 0.377834, 0.44290, 0.40430),
        ("F3.5", 1.021085, 0.702544, 0.37490, 0.36720),
        ("F3.6", 0.968899, 0.808874, 0.34880, 0.36000),
        ("F3.7", 1.083787, 0.388211, 0.43840, 0.40450),
        ("F3.8", 0.996863, 0.612881, 0.38200, 0.38320),
        ("F3.9", 0.974293, 0.810540, 0.34990, 0.35910),
        ("F3.10", 0.970651, 0.838723, 0.34550, 0.35600),
        ("F3.11", 0.945074, 0.967238, 0.32450, 0.34340),
        ("F3.12", 1.084248, 0.393044, 0.43770, 0.40370),
        ("F3.13", 1.028484, 0.656489, 0.38300, 0.37240),
        ("F3.14", 0.955076, 0.815491, 0.34470, 0.36090),
        ("F3.15", 0.951076, 1.090707, 0.31270, 0.32880),
        ("HP1", 1.284484, 0.125426, 0.53300, 0.41500),
        ("HP2", 1.148979, 0.255789, 0.47780, 0.41580),
        ("HP3", 1.055739, 0.398147, 0.43020, 0.40750),
        ("HP4", 1.003806, 0.629668, 0.38120, 0.37970),
        ("HP5", 1.016791, 0.676101, 0.37760, 0.37130),
        ("LED-B1", 1.118079, 0.334111, 0.45600, 0.40780),
        ("LED-B2", 1.085948, 0.406691, 0.43570, 0.40120),
        ("LED-B3", 1.008935, 0.677153, 0.37560, 0.37230),
        ("LED-B4", 0.977235, 0.878635, 0.34220, 0.35020),
        ("LED-B5", 0.963452, 1.126435, 0.31180, 0.32360),
        ("LED-BH1", 1.100382, 0.359071, 0.44740, 0.40660),
        ("LED-RGB1", 1.082222, 0.292394, 0.45570, 0.42110),
        ("LED-V1", 1.124518, 0.348243, 0.45480, 0.40440),
        ("LED-V2", 1.001623, 0.647388, 0.37810, 0.37750),
    ];

    #[test]
    fn every_illuminant_has_its_published_white() {
        for ((name, x, z, small_x, small_y), light) in PUBLISHED.into_iter().zip(ILLUMINANTS) {
            assert_eq!(name, light.name);
            let white = light.white();
            // A is a formula here, and its table is rounded to six digits.
            assert!((white.x - x).abs() < 1.5e-6 && (white.z - z).abs() < 1.5e-6, "{name}: {white:?}");
            let xy = white.xy().unwrap();
            let error = (xy.x - small_x).abs().max((xy.y - small_y).abs());
            assert!(error < 5.3e-5, "{name}: {xy:?}"); // Printed to four decimals.
        }
    }

    #[test]
    fn reflected_colours_are_those_of_colour_science() {
        // sd_to_XYZ(r, cmfs, light, method="Integration") / 100, 380-780 nm every 5 nm, colour-science 0.4.7, with the
        // made-up reflectance r = 0.2 + 0.6 exp(-((nm - 600) / 60)^2).
        let reflectance = Spectrum::from_fn(|nm| 0.2 + 0.6 * (-((nm - 600.0) / 60.0).powi(2)).exp());
        for (name, expected, tolerance) in [
            ("A", [0.715522639379, 0.584050917413, 0.075849216768], 5e-7), // A rounded table there, a formula here.
            ("D65", [0.552012686587, 0.525398495357, 0.225985600715], 1e-11),
            ("F11", [0.64288963447, 0.566207871885, 0.133430145156], 1e-11),
            ("LED-RGB1", [0.703258837409, 0.538395981573, 0.064134771993], 1e-11),
        ] {
            let light = Illuminant::by_name(name).unwrap().spectrum();
            let found = <[f64; 3]>::from(reflectance.reflected_xyz(&light));
            for (f, e) in found.iter().zip(expected) {
                assert!((f - e).abs() < tolerance, "{name}: {found:?} is not {expected:?}");
            }
        }
    }

    #[test]
    fn names_are_found_as_people_write_them() {
        for (written, name) in [
            ("d65", "D65"),
            ("FL11", "F11"),
            ("f11", "F11"),
            ("fl3.15", "F3.15"),
            ("led-b3", "LED-B3"),
            ("LED_RGB1", "LED-RGB1"),
            ("ledv2", "LED-V2"),
            (" e ", "E"),
        ] {
            assert_eq!(Illuminant::by_name(written).map(|light| light.name), Some(name), "{written}");
        }
        for unknown in ["", "F", "F13", "FL", "D", "4700K", "LED"] {
            assert_eq!(Illuminant::by_name(unknown), None, "{unknown}");
        }
    }
}
