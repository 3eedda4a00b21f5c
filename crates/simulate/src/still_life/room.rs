//! The window that lights the still life, the table and the backdrop.

use darkroot_colour::Vector3;

use crate::exact::smoothstep;
use crate::random::{bits, smooth_noise};

use super::skin::{Body, Material};

/// Direction to the window that lights the scene: from the left, the front and above. Of unit length.
pub(super) const KEY: [f64; 3] = [-0.48, -0.64, 0.6];
/// Irradiance from the window on a surface that faces it; 1 is what a card gets in all.
pub(super) const KEY_LIGHT: f64 = 1.2;
/// Tangents of half the window's width and height.
pub(super) const WINDOW: (f64, f64) = (0.22, 0.30);

/// Radiance of the window in a direction, relative to a perfect diffuser in full light: four panes.
pub(super) fn window(along: Vector3, blur: f64) -> f64 {
    let key = Vector3::from(KEY);
    let forward = along.dot(&key);
    if forward <= 0.0 {
        return 0.0;
    }
    let side = Vector3::new(-key[1], key[0], 0.0).normalize();
    let up = key.cross(&side);
    let (x, y) = ((along.dot(&side) / forward).abs(), (along.dot(&up) / forward).abs());
    let within = |low: f64, high: f64, v: f64| {
        smoothstep(low - blur, low + blur, v) * (1.0 - smoothstep(high - blur, high + blur, v))
    };
    let bar = if blur < 0.05 { 0.016 } else { -1.0 };
    let panes = within(bar, WINDOW.0, x) * within(bar, WINDOW.1, y);
    // Irradiance = radiance x solid angle / pi in these units.
    panes * KEY_LIGHT * std::f64::consts::PI / (4.0 * WINDOW.0 * WINDOW.1)
}

/// Oak planks along x.
pub(super) fn wood(p: Vector3) -> Body {
    const PLANK: f64 = 1.3;
    let along = (p[1] + 20.0) / PLANK;
    let plank = along.floor();
    let (shift, tone) = ((bits(5, plank as u64) % 64) as f64, (bits(6, plank as u64) % 256) as f64 / 255.0);
    let x = p[0] + shift;
    let waves = p[1] + 0.12 * smooth_noise(1, 0.5 * x, 1.5 * p[1]);
    let grain = 0.55 * smooth_noise(2, 0.35 * x, 7.0 * waves) + 0.3 * smooth_noise(3, 0.9 * x, 17.0 * waves);
    let pores = 0.16 * smooth_noise(4, 5.0 * x, 22.0 * p[1]);
    let gap = (along - plank).min(plank + 1.0 - along) * PLANK;
    let joint = smoothstep(0.0, 0.03, gap);
    Body {
        depth: 0.35 + 0.65 * joint,
        ..Body::mix(Material::OakLight, Material::OakDark, 0.30 + 0.25 * (tone - 0.5) + 0.55 * grain + pores)
    }
}

/// Painted canvas.
pub(super) fn canvas(p: Vector3) -> Body {
    let clouds = 0.6 * smooth_noise(91, 0.5 * p[0], 0.5 * p[2])
        + 0.3 * smooth_noise(92, 1.3 * p[0], 1.3 * p[2])
        + 0.15 * smooth_noise(93, 3.7 * p[0], 3.7 * p[2]);
    Body::mix(Material::WallLight, Material::WallDark, 0.5 + 0.7 * clouds)
}
