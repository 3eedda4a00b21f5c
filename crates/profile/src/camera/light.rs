//! Which light has a given white.
//!
//! A photograph tells the chromaticity of its light at best, and many lights share it. What stands in for the light is
//! the weighted mean of those that are near: daylight or a black body of that temperature, and the fluorescent lamps and
//! LEDs of the CIE, which count the less, the farther they are in temperature and tint. A white on the daylight locus is
//! mostly daylight's. A smooth filter then takes the mean to exactly that white. All of it varies continuously with the
//! white.

use std::sync::OnceLock;

use darkroot_colour::illuminant::ILLUMINANTS;
use darkroot_colour::temperature::Temperature;
use darkroot_colour::{Illuminant, Spectrum, Xy};

/// How near a lamp has to be to count: standard deviations in mired and in Duv.
const NEAR_MIRED: f64 = 25.0;
const NEAR_DUV: f64 = 0.006;

/// Weights beside that of a black body, 1: of a fluorescent lamp and of an LED right at the white, and of daylight at a
/// white of its own.
const FLUORESCENT: f64 = 0.5;
const LED: f64 = 1.0;
const DAYLIGHT: f64 = 3.0;
/// How near to the daylight locus a white has to be to be its own: a standard deviation in Duv.
const NEAR_DAY_DUV: f64 = 0.003;

/// Distance of a white from the Planckian locus up to which lights have it, and from which on none does.
const ORDINARY_DUV: f64 = 0.012;
pub(crate) const STRANGE_DUV: f64 = 0.020;

/// Between these temperatures (K) a black body becomes daylight.
const LAMP: f64 = 3500.0;
const DAY: f64 = 4500.0;

/// The light that stands in for all that have this white, about 1 in luminance. Lamps that `left_out` names take no part.
/// `None` for a white that no smooth light has.
pub fn with_white(white: Xy, left_out: impl Fn(&Illuminant) -> bool) -> Option<Spectrum> {
    let at = Temperature::of(white);
    let natural = natural(at.kelvin);
    let off = (at.duv - Temperature::of(natural.white().xy()?).duv) / NEAR_DAY_DUV;
    let mut sum = natural.scaled(1.0 + (DAYLIGHT - 1.0) * day(at.kelvin) * (-0.5 * off * off).exp());
    for Lamp { share, at: own, light, .. } in lamps().iter().filter(|lamp| !left_out(lamp.illuminant)) {
        let mired = (1e6 / own.kelvin - 1e6 / at.kelvin) / NEAR_MIRED;
        let duv = (own.duv - at.duv) / NEAR_DUV;
        let weight = *share * (-0.5 * (mired * mired + duv * duv)).exp();
        sum = added(&sum, light, weight);
    }
    filtered(&sum, white)
}

/// The light that stands in for all with this white, as [`with_white`]; but whites that no light has, as balanced samples
/// and artistic choices give them, have that of the nearest black body or daylight, with a smooth transition.
pub fn likely(white: Xy) -> Spectrum {
    let at = Temperature::of(white);
    let plausible = ((STRANGE_DUV - at.duv.abs()) / (STRANGE_DUV - ORDINARY_DUV)).clamp(0.0, 1.0);
    let natural = natural(at.kelvin);
    let near = if plausible < 1.0 {
        let own = Temperature::of(natural.white().xy().unwrap_or(white));
        Temperature { kelvin: at.kelvin, duv: own.duv + (at.duv - own.duv) * plausible }.xy()
    } else {
        white
    };
    with_white(near, |_| false).unwrap_or(natural)
}

/// A lamp that may be the light.
struct Lamp {
    illuminant: &'static Illuminant,
    share: f64,
    at: Temperature,
    /// With the luminance 1.
    light: Spectrum,
}

fn lamps() -> &'static [Lamp] {
    static LAMPS: OnceLock<Vec<Lamp>> = OnceLock::new();
    let lamp = |illuminant: &'static Illuminant| {
        let spectrum = illuminant.spectrum();
        let at = Temperature::of(spectrum.white().xy()?);
        Some(Lamp { illuminant, share: share(illuminant)?, at, light: even(&spectrum) })
    };
    LAMPS.get_or_init(|| ILLUMINANTS.iter().filter_map(lamp).collect())
}

/// The part of a kind of lamp; `None` for those that stand for no lamp that people use, or are daylight.
fn share(lamp: &Illuminant) -> Option<f64> {
    if lamp.name.starts_with("LED") {
        Some(LED)
    } else if lamp.name.starts_with('F') {
        Some(FLUORESCENT)
    } else {
        None
    }
}

/// Daylight, or a black body for warm whites, luminance 1.
pub fn natural(kelvin: f64) -> Spectrum {
    let day = day(kelvin);
    let lamp = even(&Spectrum::black_body(kelvin)).scaled(1.0 - day);
    added(&lamp, &even(&Spectrum::daylight(kelvin)), day)
}

/// From 0 for a black body to 1 for daylight.
fn day(kelvin: f64) -> f64 {
    let mired = |k: f64| 1e6 / k;
    ((mired(LAMP) - mired(kelvin)) / (mired(LAMP) - mired(DAY))).clamp(0.0, 1.0)
}

/// The light with the luminance 1.
fn even(light: &Spectrum) -> Spectrum {
    light.scaled(1.0 / light.stimulus_xyz().y)
}

fn added(a: &Spectrum, b: &Spectrum, weight: f64) -> Spectrum {
    Spectrum(std::array::from_fn(|i| a.0[i] + weight * b.0[i]))
}

/// The light through exp(a t + b t^2), with t from -1 at 380 to 1 at 780 nm, where a and b are such that it has the
/// white. By Newton's method with shortened steps.
fn filtered(light: &Spectrum, white: Xy) -> Option<Spectrum> {
    let t = Spectrum::from_fn(|nm| (nm - 580.0) / 200.0);
    let through =
        |a: f64, b: f64| Spectrum(std::array::from_fn(|i| light.0[i] * (t.0[i] * (a + b * t.0[i])).exp()));
    let off = |s: &Spectrum| s.white().xy().map(|xy| [xy.x - white.x, xy.y - white.y]);
    let size = |d: [f64; 2]| d[0].hypot(d[1]);
    let (mut a, mut b) = (0.0, 0.0);
    let mut here = off(light)?;
    for _ in 0..60 {
        if size(here) < 1e-10 {
            break;
        }
        const STEP: f64 = 1e-5;
        let (da, db) = (off(&through(a + STEP, b))?, off(&through(a, b + STEP))?);
        let slope = nalgebra::Matrix2::new(
            (da[0] - here[0]) / STEP,
            (db[0] - here[0]) / STEP,
            (da[1] - here[1]) / STEP,
            (db[1] - here[1]) / STEP,
        );
        let step = slope.try_inverse()? * nalgebra::Vector2::from(here);
        let next = (0..12).map(|n| 0.5f64.powi(n)).find_map(|share| {
            let (a, b) = (a - share * step[0], b - share * step[1]);
            let there = off(&through(a, b)).filter(|d| size(*d) < size(here))?;
            Some((a, b, there))
        });
        let Some(next) = next else { break };
        (a, b, here) = next;
    }
    (size(here) < 1e-6).then(|| even(&through(a, b)))
}
