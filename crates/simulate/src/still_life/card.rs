//! Upright cards that face the camera: the colour chart, the grey card, the resolution target.

use darkroot_colour::Vector3;

use crate::chart;
use crate::exact::{cosine_of_turns, smoothstep};

use super::skin::Material;

/// A rectangle in a plane of constant depth `y`.
#[derive(Debug, Clone)]
pub(super) struct Card {
    pub(super) left: f64,
    pub(super) bottom: f64,
    pub(super) width: f64,
    pub(super) height: f64,
    pub(super) y: f64,
    pub(super) face: Face,
}

/// What is printed on a card.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Face {
    /// The 24 patches.
    Chart,
    /// 18 % grey.
    Grey,
    /// A quarter of a zone plate that reaches half a cycle per pixel, and a slanted square. The size of a pixel
    /// on the card.
    Resolution(f64),
}

/// Distance of patches and their size, as a share of the chart's width; the margin is what is left.
const PITCH: f64 = 0.156;
const PATCH: f64 = 0.130;

/// What a point of a card shows: palette entries and the share of the second.
pub(super) type Print = (usize, usize, f64);

impl Card {
    /// Distance along a ray, in units of `along`, and the place on the card: 0..1 to the right and downwards.
    pub(super) fn hit(&self, from: Vector3, along: Vector3) -> Option<(f64, f64, f64)> {
        let distance = (self.y - from[1]) / along[1];
        let at = from + along * distance;
        let right = (at[0] - self.left) / self.width;
        let down = 1.0 - (at[2] - self.bottom) / self.height;
        let there = distance > 1e-6 && (0.0..1.0).contains(&right) && (0.0..1.0).contains(&down);
        there.then_some((distance, right, down))
    }

    /// Rectangle of patch `i` of the chart in world units: left, bottom, width, height.
    pub(super) fn patch(&self, i: usize) -> [f64; 4] {
        let (column, row) = ((i % chart::COLUMNS) as f64, (i / chart::COLUMNS) as f64);
        let side = PATCH * self.width;
        let pitch = PITCH * self.width;
        let margin = (self.width - pitch * (chart::COLUMNS - 1) as f64 - side) / 2.0;
        let top = (self.height - pitch * (chart::ROWS - 1) as f64 - side) / 2.0;
        [
            self.left + margin + pitch * column,
            self.bottom + self.height - top - pitch * row - side,
            side,
            side,
        ]
    }

    /// What it shows at a place, 0..1 to the right and downwards.
    pub(super) fn print(&self, right: f64, down: f64) -> Print {
        match self.face {
            Face::Chart => {
                let (x, z) = (self.left + right * self.width, self.bottom + (1.0 - down) * self.height);
                let inside = |i: &usize| {
                    let [left, bottom, width, height] = self.patch(*i);
                    (0.0..width).contains(&(x - left)) && (0.0..height).contains(&(z - bottom))
                };
                let ink = (0..chart::PATCHES.len()).find(inside).unwrap_or(Material::Frame as usize);
                (ink, ink, 0.0)
            }
            Face::Grey => (Material::Grey18 as usize, Material::Grey18 as usize, 0.0),
            Face::Resolution(pixel) => {
                (Material::Paper as usize, Material::Ink as usize, self.ink(right, down, pixel))
            }
        }
    }

    /// Share of ink of the resolution target.
    fn ink(&self, right: f64, down: f64, pixel: f64) -> f64 {
        let panel = 0.84 * self.height;
        let margin = (self.height - panel) / 2.0;
        let (x, z) = (right * self.width - margin, down * self.height - margin);
        let on = |x: f64| (0.0..panel).contains(&x) && (0.0..panel).contains(&z);
        if on(x) {
            // The frequency grows with the distance r from the corner: f = r / (2 panel) cycles a pixel.
            let r2 = x * x + z * z;
            let frequency = r2.sqrt() / (2.0 * panel);
            let contrast = 1.0 - smoothstep(0.47, 0.55, frequency);
            return 0.5 - 0.5 * contrast * cosine_of_turns(r2 / (4.0 * panel * pixel));
        }
        let x = self.width - margin - right * self.width;
        let (u, w) = (x - panel / 2.0, z - panel / 2.0);
        // Edges slanted by 1 in 12, about 5 degrees.
        let slanted = (u + w / 12.0).abs().max((w - u / 12.0).abs()) < 0.36 * panel;
        if on(x) && slanted { 1.0 } else { 0.0 }
    }

    /// Share of a light in the direction `light` that it hides from `point`.
    pub(super) fn shadow(&self, point: Vector3, light: Vector3, softness: f64) -> f64 {
        let distance = (self.y - point[1]) / light[1];
        if distance <= 0.0 {
            return 0.0;
        }
        let at = point + light * distance;
        let penumbra = (distance * softness).max(1e-3);
        let between = |low: f64, high: f64, x: f64| {
            smoothstep(low - penumbra, low + penumbra, x)
                * (1.0 - smoothstep(high - penumbra, high + penumbra, x))
        };
        // The foot stands on the table: no light comes from below.
        between(self.left, self.left + self.width, at[0])
            * (1.0 - smoothstep(-penumbra, penumbra, at[2] - self.bottom - self.height))
    }

    /// Share of the sky that it hides from a point of the table.
    pub(super) fn occlusion(&self, point: Vector3) -> f64 {
        let near = 1.0 - smoothstep(0.0, 0.4 * self.height, (point[1] - self.y).abs());
        let beside = (point[0] - self.left - self.width / 2.0).abs() - self.width / 2.0;
        0.45 * near * (1.0 - smoothstep(-0.2, 0.3, beside))
    }
}
