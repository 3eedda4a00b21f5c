//! AVIF with light above white: absolute light by the perceptual quantizer (SMPTE ST 2084), in the primaries of Rec. 2020, 10 bits
//! (ITU-R BT.2100-2).

use rayon::prelude::*;

/// Primaries, curve and matrix by their numbers in ITU-T H.273: BT.2020, PQ, BT.2020 with constant weights.
pub(super) const NAMED: [u16; 2] = [9, 16];
pub(super) const MATRIX: u16 = 9;

/// Largest number of 10 bits.
const LARGEST: f64 = 1023.0;
/// Light of the largest number, cd/m².
const BRIGHTEST: f64 = 10_000.0;

/// The number from 0 to 1 of light in cd/m² (ST 2084, 5.3).
fn quantized(light: f64) -> f64 {
    const M1: f64 = 2610.0 / 16384.0;
    const M2: f64 = 2523.0 / 4096.0 * 128.0;
    const C1: f64 = 3424.0 / 4096.0;
    const C2: f64 = 2413.0 / 4096.0 * 32.0;
    const C3: f64 = 2392.0 / 4096.0 * 32.0;
    let power = (light / BRIGHTEST).clamp(0.0, 1.0).powf(M1);
    ((C1 + C2 * power) / (1.0 + C3 * power)).powf(M2)
}

/// Steps of the square root of light for which the number is kept: between them it is straight.
const STEPS: usize = 1 << 14;

/// Luma and the two differences of linear light, R, G, B of each pixel side by side; 1 is light of `peak` cd/m².
pub(super) fn planes(samples: &[f32], peak: f64) -> Vec<[u16; 3]> {
    // Of the square root, dark light has steps enough.
    let table: Vec<f32> =
        (0..=STEPS).map(|i| quantized(peak * (i as f64 / STEPS as f64).powi(2)) as f32).collect();
    let coded = |light: f32| {
        let place = light.clamp(0.0, 1.0).sqrt() * STEPS as f32;
        let i = (place as usize).min(STEPS - 1);
        f64::from(table[i] + (table[i + 1] - table[i]) * (place - i as f32))
    };
    let pixel = |rgb: &[f32]| {
        let [r, g, b] = [coded(rgb[0]), coded(rgb[1]), coded(rgb[2])];
        // BT.2020, table 4.
        let luma = 0.2627 * r + 0.6780 * g + 0.0593 * b;
        let differences = [(b - luma) / 1.8814, (r - luma) / 1.4746].map(|v| v + 512.0 / LARGEST);
        [luma, differences[0], differences[1]].map(|v| (LARGEST * v).round().clamp(0.0, LARGEST) as u16)
    };
    samples.par_chunks_exact(3).map(pixel).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_has_the_numbers_of_the_standard() {
        // ITU-R BT.2408-7, table 1: 203 cd/m² is 58 %, 1000 is 75 %.
        for (light, number) in
            [(0.0, 0.0), (100.0, 0.5081), (203.0, 0.5807), (1000.0, 0.7518), (10_000.0, 1.0)]
        {
            assert!((quantized(light) - number).abs() < 1e-4, "{light}: {}", quantized(light));
        }
    }

    #[test]
    fn grey_has_no_differences_and_the_table_is_close() {
        for i in 0..=500 {
            let light = (i as f32 / 500.0).powi(3);
            let [luma, blue, red] = planes(&[light; 3], 812.0)[0];
            assert_eq!([blue, red], [512; 2]);
            let exact = LARGEST * quantized(812.0 * f64::from(light));
            assert!((f64::from(luma) - exact).abs() < 0.6, "{light}: {luma} {exact}");
        }
        let [_, blue, red] = planes(&[1.0, 0.0, 0.0], 812.0)[0];
        assert!(red > 800 && blue < 512);
    }
}
