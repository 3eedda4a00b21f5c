//! Correlated colour temperature and the distance from the Planckian locus.

use crate::spectrum::Spectrum;
use crate::{Xy, Xyz};

/// The white of a light as photographers name it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Temperature {
    /// Correlated colour temperature, 1000 to 50000 K.
    pub kelvin: f64,
    /// Distance from the Planckian locus in CIE 1960 uv; positive above it (greenish), negative below (pinkish).
    pub duv: f64,
}

/// Ends of the range searched and accepted, in mired (1e6 / K).
const MIN_MIRED: f64 = 20.0;
const MAX_MIRED: f64 = 1000.0;

/// Tint units per unit of Duv, the scale that raw developers show: a light above the Planckian locus is greenish,
/// and has a positive tint because balancing for it makes the picture more magenta.
const TINT_PER_DUV: f64 = 3000.0;

impl Temperature {
    /// From kelvin and a tint as shown by raw developers: -150 (the picture becomes greener) ..= 150 (more magenta).
    pub fn from_kelvin_tint(kelvin: f64, tint: f64) -> Self {
        Self { kelvin, duv: tint / TINT_PER_DUV }
    }

    /// The tint of this white: 0 on the Planckian locus, positive above it, as for daylight (+10).
    pub fn tint(self) -> f64 {
        self.duv * TINT_PER_DUV
    }

    /// The temperature whose Planckian chromaticity is nearest in CIE 1960 uv (the definition of CIE 015:2018,
    /// 9.5), by golden-section search over mired on Planck's law itself, sampled from 380 to 780 nm: within 0.05 mired of
    /// Ohno (2013). Limited to 1000..=50000 K.
    pub fn of(white: Xy) -> Self {
        let (u, v) = uv(white);
        let distance = |mired: f64| {
            let (pu, pv) = planckian_uv(1e6 / mired);
            (u - pu).hypot(v - pv)
        };
        let ratio = (5f64.sqrt() - 1.0) / 2.0;
        let (mut low, mut high) = (MIN_MIRED, MAX_MIRED);
        // Golden section: of the two points inside, one is inside the next bracket, too.
        let (mut a, mut b) = (high - ratio * (high - low), low + ratio * (high - low));
        let (mut at_a, mut at_b) = (distance(a), distance(b));
        while high - low > 1e-6 {
            if at_a < at_b {
                (high, b, at_b) = (b, a, at_a);
                a = high - ratio * (high - low);
                at_a = distance(a);
            } else {
                (low, a, at_a) = (a, b, at_b);
                b = low + ratio * (high - low);
                at_b = distance(b);
            }
        }
        let mired = (low + high) / 2.0;
        let kelvin = 1e6 / mired;
        let (pu, pv) = planckian_uv(kelvin);
        let (nu, nv) = normal(kelvin);
        Self { kelvin, duv: (u - pu) * nu + (v - pv) * nv }
    }

    /// The chromaticity of this white: the inverse of [`Temperature::of`].
    pub fn xy(self) -> Xy {
        let kelvin = self.kelvin.clamp(1e6 / MAX_MIRED, 1e6 / MIN_MIRED);
        let (u, v) = planckian_uv(kelvin);
        let (nu, nv) = normal(kelvin);
        xy_of_uv(u + self.duv * nu, v + self.duv * nv)
    }
}

/// Chromaticity of a black body at `kelvin`, 1000 to 50000 (CIE 1931 observer); outside that range the nearest end is
/// used.
pub fn planckian_xy(kelvin: f64) -> Xy {
    Temperature { kelvin, duv: 0.0 }.xy()
}

/// Chromaticity of daylight at a correlated colour temperature of 4000 to 25000 K (CIE 015:2018, 4.2); outside
/// that range the nearest end is used.
pub fn daylight_xy(kelvin: f64) -> Xy {
    let t = kelvin.clamp(4000.0, 25000.0);
    let x = if t <= 7000.0 {
        -4.6070e9 / t.powi(3) + 2.9678e6 / t.powi(2) + 0.09911e3 / t + 0.244063
    } else {
        -2.0064e9 / t.powi(3) + 1.9018e6 / t.powi(2) + 0.24748e3 / t + 0.237040
    };
    Xy::new(x, -3.000 * x * x + 2.870 * x - 0.275)
}

/// CIE 1960 uniform chromaticity.
fn uv(c: Xy) -> (f64, f64) {
    let d = -2.0 * c.x + 12.0 * c.y + 3.0;
    (4.0 * c.x / d, 6.0 * c.y / d)
}

fn xy_of_uv(u: f64, v: f64) -> Xy {
    let d = 2.0 * u - 8.0 * v + 4.0;
    Xy::new(3.0 * u / d, 2.0 * v / d)
}

fn planckian_uv(kelvin: f64) -> (f64, f64) {
    let Xyz { x, y, z } = Spectrum::black_body(kelvin).stimulus_xyz();
    let d = x + 15.0 * y + 3.0 * z;
    (4.0 * x / d, 6.0 * y / d)
}

/// Unit normal of the Planckian locus at `kelvin`, pointing to larger v.
fn normal(kelvin: f64) -> (f64, f64) {
    let mired = 1e6 / kelvin;
    let (u0, v0) = planckian_uv(1e6 / (mired - 0.01));
    let (u1, v1) = planckian_uv(1e6 / (mired + 0.01));
    let (du, dv) = (u1 - u0, v1 - v0);
    let length = du.hypot(dv);
    let (nu, nv) = (-dv / length, du / length);
    if nv < 0.0 { (-nu, -nv) } else { (nu, nv) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::white;

    #[test]
    fn standard_illuminants_have_their_published_temperatures() {
        for (xy, kelvin, duv) in
            [(white::A_XY, 2855.5, 0.0), (white::D50_XY, 5001.0, 0.0033), (white::D65_XY, 6503.6, 0.0032)]
        {
            let t = Temperature::of(xy);
            assert!((t.kelvin - kelvin).abs() < 4.0, "{t:?} for {kelvin}");
            assert!((t.duv - duv).abs() < 2e-4, "{t:?} for {duv}");
        }
    }

    #[test]
    fn temperature_and_back_is_the_same_chromaticity() {
        for kelvin in [1500.0, 2500.0, 4000.0, 6500.0, 12000.0] {
            for duv in [-0.02, 0.0, 0.02] {
                let back = Temperature::of(Temperature { kelvin, duv }.xy());
                assert!((back.kelvin - kelvin).abs() < kelvin * 1e-3, "{back:?}, {kelvin}");
                assert!((back.duv - duv).abs() < 1e-5, "{back:?}, {duv}");
            }
        }
    }

    #[test]
    fn temperatures_are_those_of_ohno_2013() {
        // uv_to_CCT_Ohno2013(UCS_to_uv(XYZ_to_UCS(white))) of colour-science 0.4.7. Its locus has
        // the observer from 360 to 830 nm; what ours leaves out is 0.04 mired.
        for (name, kelvin, duv) in [
            ("A", 2855.5329, 0.0000017),
            ("D50", 5001.6650, 0.0032081),
            ("D65", 6502.9716, 0.0032123),
            ("F2", 4224.4777, 0.0017886),
            ("F11", 3998.6067, 0.0000499),
            ("LED-B1", 2733.4532, -0.0007049),
            ("LED-B5", 6597.5338, 0.0008848),
            ("HP1", 1959.1938, 0.0007815),
        ] {
            let white = crate::Illuminant::by_name(name).unwrap().white().xy().unwrap();
            let t = Temperature::of(white);
            assert!((t.kelvin - kelvin).abs() < kelvin * 2.5e-4, "{name}: {t:?}, not {kelvin}");
            assert!((t.duv - duv).abs() < 1.5e-5, "{name}: {t:?}, not {duv}");
        }
    }

    #[test]
    fn chromaticities_off_the_locus_are_those_of_ohno_2013() {
        // UCS_uv_to_xy(CCT_to_uv_Ohno2013([kelvin, duv])), colour-science 0.4.7.
        for (kelvin, duv, x, y) in [
            (2000.0, 0.0, 0.526676804, 0.413299440),
            (2000.0, 0.01, 0.550985588, 0.445655654),
            (2000.0, -0.01, 0.504544960, 0.383840843),
            (5000.0, 0.0, 0.345102632, 0.351610027),
            (5000.0, 0.01, 0.347090364, 0.373833327),
            (5000.0, -0.01, 0.343262943, 0.331041879),
            (10000.0, 0.0, 0.280634083, 0.288288908),
            (10000.0, 0.01, 0.274428568, 0.300297081),
            (10000.0, -0.01, 0.286526867, 0.276885896),
        ] {
            let xy = Temperature { kelvin, duv }.xy();
            assert!((xy.x - x).abs() < 8e-5 && (xy.y - y).abs() < 8e-5, "{kelvin} {duv}: {xy:?}");
        }
    }

    #[test]
    fn daylight_is_that_of_the_formula_of_the_cie() {
        // colour.temperature.CCT_to_xy_CIE_D(kelvin), colour-science 0.4.7.
        for (kelvin, x, y) in [
            (4000.0, 0.382343625, 0.383766261016),
            (6504.0, 0.312714056883, 0.329119099137),
            (7000.0, 0.305357431487, 0.321646345475),
            (10000.0, 0.2787996, 0.29196720112),
            (25000.0, 0.2498536704, 0.254799464211),
        ] {
            let xy = daylight_xy(kelvin);
            assert!((xy.x - x).abs() < 1e-11 && (xy.y - y).abs() < 1e-11, "{kelvin}: {xy:?}");
        }
    }
}
