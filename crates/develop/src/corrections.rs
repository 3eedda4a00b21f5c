//! Corrections that a DNG carries: gain maps, polynomials, tables, vignetting (DNG 1.7, chapter 7).
//!
//! All of them look at one sample and its place only, so they run row by row. Warps, which move pixels, are not
//! applied; the capture's notes say so.

use darkroot_photo::correction::{Area, GainMap, Vignette};
use darkroot_photo::{CameraSpace, Correction, Rgb, Size};

/// Where a run of samples lies.
#[derive(Debug, Clone, Copy)]
pub struct Run {
    /// Column of the first sample, from the left edge of the active area.
    pub x: usize,
    /// Row, from the top edge of the active area.
    pub y: usize,
    /// Samples a pixel.
    pub planes: usize,
    /// Columns from one pixel to the next: more than 1 in a picture that is made smaller.
    pub step: usize,
    /// Size of the active area.
    pub active: Size,
}

/// Whether a correction can be applied by this stage.
pub fn is_supported(correction: &Correction) -> bool {
    !matches!(correction, Correction::Warp(_))
}

/// Applies corrections to a run of linear samples (0 = black, 1 = saturated) of one row.
pub fn row(light: &mut [f32], corrections: &[Correction], run: Run) {
    for correction in corrections {
        match correction {
            Correction::Polynomial(area, c) => each(light, area, run, |v, _, _| polynomial(c, v)),
            Correction::Table(area, table) => each(light, area, run, |v, _, _| {
                let i = (v.clamp(0.0, 1.0) * 65535.0 + 0.5) as usize;
                table.get(i.min(table.len().saturating_sub(1))).map_or(v, |&t| f32::from(t) / 65535.0)
            }),
            Correction::Gain(area, map) => {
                let gains = MapRow::new(map, run);
                each(light, area, run, |v, x, plane| v * gains.at(x, plane));
            }
            Correction::RowDelta(area, values) => {
                let delta = row_value(area, values, run).unwrap_or(0.0);
                each(light, area, run, |v, _, _| v + delta);
            }
            Correction::RowScale(area, values) => {
                let scale = row_value(area, values, run).unwrap_or(1.0);
                each(light, area, run, |v, _, _| v * scale);
            }
            Correction::ColumnDelta(area, values) => {
                each(light, area, run, |v, x, _| v + column_value(area, values, x).unwrap_or(0.0));
            }
            Correction::ColumnScale(area, values) => {
                each(light, area, run, |v, x, _| v * column_value(area, values, x).unwrap_or(1.0));
            }
            Correction::Vignette(vignette) => {
                for (i, pixel) in light.chunks_exact_mut(run.planes).enumerate() {
                    let gain = vignette_gain(vignette, run.x + i * run.step, run.y, run.active);
                    for v in pixel {
                        *v *= gain;
                    }
                }
            }
            Correction::Warp(_) => {}
        }
    }
}

/// Applies corrections to a demosaiced picture whose top left pixel lies in column `x` of row `y` of the active area, and
/// each next one `step` pixels on.
pub fn picture(
    picture: &mut Rgb<CameraSpace>,
    corrections: &[Correction],
    (x, y): (usize, usize),
    step: usize,
    active: Size,
) {
    let width = picture.size().width;
    for (plane, values) in picture.planes_mut().into_iter().enumerate() {
        let of_plane: Vec<Correction> = corrections.iter().filter_map(|c| for_plane(c, plane)).collect();
        if of_plane.is_empty() {
            continue;
        }
        for (i, light) in values.chunks_exact_mut(width).enumerate() {
            row(light, &of_plane, Run { x, y: y + i * step, planes: 1, step, active });
        }
    }
}

/// The part of a correction that concerns one plane, as a correction of a picture with that plane alone.
fn for_plane(correction: &Correction, plane: usize) -> Option<Correction> {
    let alone = |area: &Area| {
        let wanted = (area.plane..area.plane.saturating_add(area.planes)).contains(&plane);
        wanted.then(|| Area { plane: 0, planes: 1, ..area.clone() })
    };
    Some(match correction {
        Correction::Table(a, t) => Correction::Table(alone(a)?, t.clone()),
        Correction::Polynomial(a, c) => Correction::Polynomial(alone(a)?, c.clone()),
        Correction::Gain(a, map) => {
            let area = alone(a)?;
            let of_map = (plane - a.plane).min(map.planes - 1);
            let gains = map.gains.iter().skip(of_map).step_by(map.planes).copied().collect();
            Correction::Gain(area, GainMap { planes: 1, gains, ..map.clone() })
        }
        Correction::RowDelta(a, v) => Correction::RowDelta(alone(a)?, v.clone()),
        Correction::ColumnDelta(a, v) => Correction::ColumnDelta(alone(a)?, v.clone()),
        Correction::RowScale(a, v) => Correction::RowScale(alone(a)?, v.clone()),
        Correction::ColumnScale(a, v) => Correction::ColumnScale(alone(a)?, v.clone()),
        Correction::Vignette(v) => Correction::Vignette(v.clone()),
        Correction::Warp(_) => return None,
    })
}

/// Calls `f(value, column, plane)` for each sample of the run that the area names.
fn each(light: &mut [f32], area: &Area, run: Run, f: impl Fn(f32, usize, usize) -> f32) {
    let rect = area.rect;
    if run.y < rect.y || run.y >= rect.bottom() {
        return;
    }
    if run.step > 1 {
        // A pixel of a smaller picture stands for rows and columns of every pitch.
        for (i, v) in light.iter_mut().enumerate() {
            let x = run.x + i * run.step;
            if (rect.x..rect.right()).contains(&x) {
                *v = f(*v, x, area.plane);
            }
        }
        return;
    }
    if !(run.y - rect.y).is_multiple_of(area.row_pitch) {
        return;
    }
    let pixels = light.len() / run.planes;
    let (from, to) = (rect.x.max(run.x), rect.right().min(run.x + pixels));
    // The first column at or after `from` that the pitch hits.
    let first = rect.x + (from - rect.x).div_ceil(area.column_pitch) * area.column_pitch;
    let planes = area.plane..area.plane.saturating_add(area.planes).min(run.planes);
    for x in (first..to).step_by(area.column_pitch) {
        for plane in planes.clone() {
            let v = &mut light[(x - run.x) * run.planes + plane];
            *v = f(*v, x, plane);
        }
    }
}

fn polynomial(coefficients: &[f64], v: f32) -> f32 {
    coefficients.iter().rev().fold(0.0, |sum, &c| sum * v + c as f32)
}

fn row_value(area: &Area, values: &[f32], run: Run) -> Option<f32> {
    values.get(run.y.checked_sub(area.rect.y)? / area.row_pitch).copied()
}

fn column_value(area: &Area, values: &[f32], x: usize) -> Option<f32> {
    values.get(x.checked_sub(area.rect.x)? / area.column_pitch).copied()
}

/// A gain map interpolated to one row of the picture.
struct MapRow<'a> {
    map: &'a GainMap,
    upper: usize,
    lower: usize,
    weight: f32,
    width: f64,
}

impl<'a> MapRow<'a> {
    fn new(map: &'a GainMap, run: Run) -> Self {
        let (upper, lower, weight) =
            between((run.y as f64 + 0.5) / run.active.height as f64, map.vertical, map.rows);
        Self { map, upper, lower, weight, width: run.active.width as f64 }
    }

    fn at(&self, x: usize, plane: usize) -> f32 {
        let map = self.map;
        let (left, right, weight) = between((x as f64 + 0.5) / self.width, map.horizontal, map.columns);
        let plane = plane.min(map.planes - 1);
        let gain = |row: usize, column: usize| map.gains[(row * map.columns + column) * map.planes + plane];
        let mix = |a: f32, b: f32, w: f32| a + (b - a) * w;
        let upper = mix(gain(self.upper, left), gain(self.upper, right), weight);
        let lower = mix(gain(self.lower, left), gain(self.lower, right), weight);
        mix(upper, lower, self.weight)
    }
}

/// The two map points around a place (0..=1) and the weight of the second; beyond the map its edge holds.
fn between(place: f64, (origin, spacing): (f64, f64), points: usize) -> (usize, usize, f32) {
    let last = points - 1;
    let at = if spacing > 0.0 { ((place - origin) / spacing).clamp(0.0, last as f64) } else { 0.0 };
    let first = (at as usize).min(last);
    (first, (first + 1).min(last), (at - first as f64) as f32)
}

fn vignette_gain(vignette: &Vignette, x: usize, y: usize, active: Size) -> f32 {
    let (w, h) = (active.width as f64, active.height as f64);
    let (cx, cy) = (vignette.centre.0 * w, vignette.centre.1 * h);
    let farthest = cx.max(w - cx).hypot(cy.max(h - cy));
    let r2 = ((x as f64 + 0.5 - cx).hypot(y as f64 + 0.5 - cy) / farthest).powi(2);
    let sum = vignette.coefficients.iter().rev().fold(0.0, |sum, k| (sum + k) * r2);
    (1.0 + sum) as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use darkroot_photo::Rect;

    const ACTIVE: Size = Size { width: 8, height: 4 };

    fn run(y: usize) -> Run {
        Run { x: 0, y, planes: 1, step: 1, active: ACTIVE }
    }

    fn area(x: usize, pitch: usize) -> Area {
        let rect = Rect { x, y: 0, width: 8 - x, height: 4 };
        Area { rect, plane: 0, planes: 1, row_pitch: pitch, column_pitch: pitch }
    }

    #[test]
    fn a_polynomial_touches_only_the_columns_and_rows_of_its_pitch() {
        let double = [Correction::Polynomial(area(1, 2), vec![0.0, 2.0])];
        let mut light = [1.0; 8];
        row(&mut light, &double, run(0));
        assert_eq!(light, [1.0, 2.0, 1.0, 2.0, 1.0, 2.0, 1.0, 2.0]);
        row(&mut light, &double, run(1));
        assert_eq!(light, [1.0, 2.0, 1.0, 2.0, 1.0, 2.0, 1.0, 2.0]);
        // A run that begins inside the picture keeps the phase.
        let mut part = [1.0; 3];
        row(&mut part, &double, Run { x: 2, ..run(2) });
        assert_eq!(part, [1.0, 2.0, 1.0]);
    }

    #[test]
    fn a_gain_map_is_interpolated_between_its_points() {
        let map = GainMap {
            rows: 1,
            columns: 2,
            planes: 1,
            vertical: (0.0, 1.0),
            horizontal: (0.0, 1.0),
            gains: vec![1.0, 2.0],
        };
        let mut light = [1.0; 8];
        row(&mut light, &[Correction::Gain(area(0, 1), map)], run(0));
        for (x, v) in light.iter().enumerate() {
            assert!((v - (1.0 + (x as f32 + 0.5) / 8.0)).abs() < 1e-6, "{x}: {v}");
        }
    }

    #[test]
    fn vignetting_is_brightened_most_in_the_corners() {
        let vignette = Vignette { coefficients: [1.0, 0.0, 0.0, 0.0, 0.0], centre: (0.5, 0.5) };
        let gain = |x, y| vignette_gain(&vignette, x, y, ACTIVE);
        assert!(gain(0, 0) > 1.5 && gain(0, 0) < 2.0 && gain(4, 2) < 1.1);
        assert!((gain(0, 0) - gain(7, 3)).abs() < 1e-6);
    }

    #[test]
    fn tables_count_in_16_bits_and_their_last_entry_serves_the_rest() {
        let half = [Correction::Table(area(0, 1), vec![0, 65535])];
        let mut light = [0.0, 1.0 / 65535.0, 0.5, 1.0, 0.0, 0.0, 0.0, 0.0];
        row(&mut light, &half, run(0));
        assert_eq!(&light[..4], &[0.0, 1.0, 1.0, 1.0]);
    }
}
