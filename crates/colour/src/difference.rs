//! Colour differences.

use crate::{Lab, Luv};

/// CIE 1976 dE\*ab: the distance in CIELAB (CIE 015:2018, 8.2.1).
pub fn de76(one: Lab, two: Lab) -> f64 {
    (two.l - one.l).hypot(two.a - one.a).hypot(two.b - one.b)
}

/// CIE 1976 dE\*uv: the distance in CIELUV (CIE 015:2018, 8.2.2).
pub fn de_uv(one: Luv, two: Luv) -> f64 {
    (two.l - one.l).hypot(two.u - one.u).hypot(two.v - one.v)
}

/// CIE94 for graphic arts (CIE 116-1995): kL = kC = kH = 1, K1 = 0.045, K2 = 0.015. Not symmetrical: chroma is
/// weighted by that of `reference`.
pub fn de94(reference: Lab, sample: Lab) -> f64 {
    cie94(reference, sample, 1.0, 0.045, 0.015)
}

/// CIE94 for textiles (CIE 116-1995): kL = 2, K1 = 0.048, K2 = 0.014. Not symmetrical, as [`de94`].
pub fn de94_textiles(reference: Lab, sample: Lab) -> f64 {
    cie94(reference, sample, 2.0, 0.048, 0.014)
}

fn cie94(reference: Lab, sample: Lab, kl: f64, k1: f64, k2: f64) -> f64 {
    let dl = sample.l - reference.l;
    let dc = sample.chroma() - reference.chroma();
    // dH^2 = da^2 + db^2 - dC^2; rounding may take it below 0.
    let dh2 = (sample.a - reference.a).powi(2) + (sample.b - reference.b).powi(2) - dc * dc;
    let (sc, sh) = (1.0 + k1 * reference.chroma(), 1.0 + k2 * reference.chroma());
    ((dl / kl).powi(2) + (dc / sc).powi(2) + dh2.max(0.0) / (sh * sh)).sqrt()
}

/// CIEDE2000 with kL = kC = kH = 1 (CIE 142-2001, ISO/CIE 11664-6), after the implementation notes of Sharma,
/// Wu and Dalal (Color Research and Application 30(1), 2005). 1 is about what one can just see.
pub fn de2000(one: Lab, two: Lab) -> f64 {
    ciede2000(one, two, |l| {
        let l50 = (l - 50.0).powi(2);
        1.0 + 0.015 * l50 / (20.0 + l50).sqrt()
    })
}

/// [`de2000`] with the lightness weight SL = 1: lightness counts the same in the dark, in the middle and in the light,
/// as dcamprof and others have it for fitting camera profiles.
pub fn de2000_sl1(one: Lab, two: Lab) -> f64 {
    ciede2000(one, two, |_| 1.0)
}

/// CIEDE2000 with the weight of lightness SL as a function of the mean L\*.
fn ciede2000(one: Lab, two: Lab, lightness_weight: impl Fn(f64) -> f64) -> f64 {
    const POW25_7: f64 = 6_103_515_625.0; // 25^7
    let mean_chroma7 = ((one.chroma() + two.chroma()) / 2.0).powi(7);
    let g = 0.5 * (1.0 - (mean_chroma7 / (mean_chroma7 + POW25_7)).sqrt());

    let (a1, a2) = ((1.0 + g) * one.a, (1.0 + g) * two.a);
    let (c1, c2) = (a1.hypot(one.b), a2.hypot(two.b));
    let hue =
        |a: f64, b: f64| if a == 0.0 && b == 0.0 { 0.0 } else { b.atan2(a).to_degrees().rem_euclid(360.0) };
    let (h1, h2) = (hue(a1, one.b), hue(a2, two.b));
    let achromatic = c1 * c2 == 0.0;

    let dl = two.l - one.l;
    let dc = c2 - c1;
    let dh = if achromatic {
        0.0
    } else {
        match h2 - h1 {
            d if d > 180.0 => d - 360.0,
            d if d < -180.0 => d + 360.0,
            d => d,
        }
    };
    let big_dh = 2.0 * (c1 * c2).sqrt() * (dh / 2.0).to_radians().sin();

    let l = (one.l + two.l) / 2.0;
    let c = (c1 + c2) / 2.0;
    let h = if achromatic {
        h1 + h2
    } else if (h1 - h2).abs() <= 180.0 {
        (h1 + h2) / 2.0
    } else if h1 + h2 < 360.0 {
        (h1 + h2 + 360.0) / 2.0
    } else {
        (h1 + h2 - 360.0) / 2.0
    };

    let cosine = |degrees: f64| degrees.to_radians().cos();
    let t = 1.0 - 0.17 * cosine(h - 30.0) + 0.24 * cosine(2.0 * h) + 0.32 * cosine(3.0 * h + 6.0)
        - 0.20 * cosine(4.0 * h - 63.0);
    let sl = lightness_weight(l);
    let sc = 1.0 + 0.045 * c;
    let sh = 1.0 + 0.015 * c * t;
    let rotation = 30.0 * (-((h - 275.0) / 25.0).powi(2)).exp();
    let c7 = c.powi(7);
    let rt = -2.0 * (c7 / (c7 + POW25_7)).sqrt() * (2.0 * rotation).to_radians().sin();

    let (tl, tc, th) = (dl / sl, dc / sc, big_dh / sh);
    (tl * tl + tc * tc + th * th + rt * tc * th).max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The 34 pairs of Sharma, Wu and Dalal (2005), table 1: L a b, L a b, dE.
    const SHARMA: &str = include_str!("../tests/ciede2000_sharma_2005.csv");

    #[test]
    fn the_published_pairs_of_sharma_have_their_published_difference() {
        let mut pairs = 0;
        for line in SHARMA.lines().skip(1) {
            let v: Vec<f64> = line.split(',').map(|x| x.parse().unwrap()).collect();
            let one = Lab { l: v[0], a: v[1], b: v[2] };
            let two = Lab { l: v[3], a: v[4], b: v[5] };
            assert!((de2000(one, two) - v[6]).abs() < 5e-5, "{line}: {}", de2000(one, two));
            assert!((de2000(two, one) - v[6]).abs() < 5e-5, "{line}, turned round");
            pairs += 1;
        }
        assert_eq!(pairs, 34);
    }

    #[test]
    fn differences_are_those_of_colour_science() {
        // colour.delta_E(a, b, method="CIE 1976"), delta_E_CIE1994(a, b), delta_E_CIE1994(b, a),
        // delta_E_CIE1994(a, b, textiles=True), delta_E(a, b, method="CIE 2000"), colour-science 0.4.7. The last
        // column is a second program for CIEDE2000 (numpy) with SL = 1.
        for (a, b, expected) in [
            (
                [100.0, 21.57210357, 272.22819350],
                [100.0, 426.67945353, 72.39590835],
                [451.7133019736, 83.7792255009, 56.938394665, 88.3355530575, 94.0356490267, 94.0356490267],
            ),
            (
                [50.0, 2.5, 0.0],
                [73.0, 25.0, -18.0],
                [36.8680078117, 34.689163198, 26.1397516445, 28.2502634962, 27.1492313007, 29.5545225831],
            ),
            (
                [60.2574, -34.0099, 36.2677],
                [60.4626, -34.1751, 39.4387],
                [3.1819238017, 1.3909947095, 1.35761871006, 1.38973332088, 1.2644200136, 1.2683124601],
            ),
            (
                [22.7233, 20.0904, -46.694],
                [23.0331, 14.973, -42.5619],
                [6.5846798867, 2.5561330876, 2.72514857851, 2.53098889226, 2.0372582697, 2.048787003],
            ),
        ] {
            let (a, b) = (Lab::from(a), Lab::from(b));
            let found =
                [de76(a, b), de94(a, b), de94(b, a), de94_textiles(a, b), de2000(a, b), de2000_sl1(a, b)];
            for (f, e) in found.iter().zip(expected) {
                assert!((f - e).abs() < 1e-8, "{found:?} is not {expected:?}");
            }
        }
    }

    #[test]
    fn without_sl_a_step_of_dark_greys_counts_in_full() {
        let (one, two) = (Lab { l: 5.0, ..Lab::default() }, Lab { l: 6.0, ..Lab::default() });
        assert!((de2000_sl1(one, two) - 1.0).abs() < 1e-12);
        assert!(de2000(one, two) < 0.62);
    }
}
