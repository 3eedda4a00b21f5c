//! Colour differences.

use crate::Lab;

/// CIEDE2000 with kL = kC = kH = 1 (CIE 142-2001, ISO/CIE 11664-6), after the implementation notes of Sharma,
/// Wu and Dalal (Color Research and Application 30(1), 2005). 1 is about what one can just see.
pub fn de2000(one: Lab, two: Lab) -> f64 {
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
    let l50 = (l - 50.0).powi(2);
    let sl = 1.0 + 0.015 * l50 / (20.0 + l50).sqrt();
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
}
