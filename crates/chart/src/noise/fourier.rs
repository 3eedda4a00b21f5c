//! Filters of small squares in the frequency domain. Squares are at most some hundred pixels wide, so a plain transform along
//! rows and columns does.

use std::f64::consts::TAU;

/// A square filtered by a real, even response to the frequency in cycles a pixel; beyond its edges the square repeats.
pub(super) fn filtered(square: &[f64], side: usize, response: impl Fn(f64) -> f64) -> Vec<f64> {
    let turns: Vec<(f64, f64)> = (0..side).map(|i| (TAU * i as f64 / side as f64).sin_cos()).collect();
    let plain: Vec<Complex> = square.iter().map(|v| (*v, 0.0)).collect();
    let mut spectrum =
        transposed_transform(&transposed_transform(&plain, side, &turns, -1.0), side, &turns, -1.0);
    let cycles = |i: usize| i.min(side - i) as f64 / side as f64;
    for (i, value) in spectrum.iter_mut().enumerate() {
        let gain = response(cycles(i % side).hypot(cycles(i / side)));
        *value = (value.0 * gain, value.1 * gain);
    }
    let back = transposed_transform(&transposed_transform(&spectrum, side, &turns, 1.0), side, &turns, 1.0);
    back.iter().map(|(real, _)| real / (side * side) as f64).collect()
}

/// Real and imaginary part.
type Complex = (f64, f64);

/// The discrete Fourier transform of each row, written as a column: done twice it is that of the square.
fn transposed_transform(rows: &[Complex], side: usize, turns: &[(f64, f64)], sign: f64) -> Vec<Complex> {
    let mut columns = vec![(0.0, 0.0); rows.len()];
    for (y, row) in rows.chunks_exact(side).enumerate() {
        for frequency in 0..side {
            let mut sum = (0.0, 0.0);
            let mut at = 0;
            for value in row {
                let (sin, cos) = (sign * turns[at].0, turns[at].1);
                sum = (sum.0 + value.0 * cos - value.1 * sin, sum.1 + value.0 * sin + value.1 * cos);
                at += frequency;
                if at >= side {
                    at -= side;
                }
            }
            columns[frequency * side + y] = sum;
        }
    }
    columns
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wave_is_weighed_by_the_response_at_its_frequency() {
        // Three waves across and four down a square of 20: 0.25 cycles a pixel.
        let side = 20;
        let wave = |i: usize| (TAU * (3 * (i % side) + 4 * (i / side)) as f64 / side as f64).cos();
        let square: Vec<f64> = (0..side * side).map(wave).collect();
        let seen = filtered(&square, side, |f| if (f - 0.25).abs() < 1e-9 { 0.5 } else { 7.0 });
        for (i, v) in seen.iter().enumerate() {
            assert!((v - 0.5 * wave(i)).abs() < 1e-9, "{i}: {v}");
        }
    }
}
