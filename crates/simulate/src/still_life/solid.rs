//! Ellipsoids: fruit, balls, and bowls where the top is cut off.

use darkroot_colour::Vector3;

use crate::exact::smoothstep;

use super::skin::Skin;

/// An ellipsoid with upright third axis.
#[derive(Debug, Clone)]
pub(super) struct Solid {
    pub(super) centre: Vector3,
    radii: Vector3,
    inverse: Vector3,
    /// Cosine and sine of its turn about the upright axis.
    pub(super) turn: (f64, f64),
    /// Height above which it is cut away, so that one sees its inside.
    pub(super) open_above: Option<f64>,
    pub(super) skin: Skin,
}

/// Where a ray meets a surface.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hit {
    pub(super) distance: f64,
    pub(super) point: Vector3,
    /// Unit normal on the side of the ray.
    pub(super) normal: Vector3,
    /// Place on the unit sphere that the ellipsoid is stretched from.
    pub(super) place: Vector3,
    pub(super) inside: bool,
}

impl Solid {
    pub(super) fn new(skin: Skin, centre: [f64; 3], radii: [f64; 3]) -> Self {
        Self {
            centre: centre.into(),
            radii: radii.into(),
            inverse: radii.map(|r| 1.0 / r).into(),
            turn: (1.0, 0.0),
            open_above: None,
            skin,
        }
    }

    pub(super) fn turned(self, cosine: f64, sine: f64) -> Self {
        Self { turn: (cosine, sine), ..self }
    }

    pub(super) fn open_above(self, height: f64) -> Self {
        Self { open_above: Some(height), ..self }
    }

    /// First place where the ray `from` + distance x `along` meets it, at a positive distance.
    pub(super) fn hit(&self, from: Vector3, along: Vector3) -> Option<Hit> {
        let (o, d) = (self.to_sphere(from - self.centre), self.to_sphere(along));
        let (a, b, c) = (d.dot(&d), o.dot(&d), o.dot(&o) - 1.0);
        let discriminant = b * b - a * c;
        if discriminant < 0.0 {
            return None;
        }
        let root = discriminant.sqrt();
        let [near, far] = [(-b - root) / a, (-b + root) / a];
        let there = |distance: f64| {
            let below_rim = self.open_above.is_none_or(|z| from[2] + distance * along[2] < z);
            distance > 1e-6 && below_rim
        };
        let (distance, inside) = match (there(near), there(far)) {
            (true, _) => (near, false),
            (false, true) => (far, true),
            _ => return None,
        };
        let place = o + d * distance;
        let outward = self.turned_back(place.component_mul(&self.inverse)).normalize();
        let normal = if inside { -outward } else { outward };
        Some(Hit { distance, point: from + along * distance, normal, place, inside })
    }

    /// Share of a light in the direction `light` (unit), with tangent of its angular radius `softness`, that it
    /// hides from `point`.
    pub(super) fn shadow(&self, point: Vector3, light: Vector3, softness: f64) -> f64 {
        let (p, l) = (self.to_sphere(point - self.centre), self.to_sphere(light));
        let nearest = -p.dot(&l) / l.dot(&l);
        let penumbra = (nearest * softness / self.radius()).max(1e-3);
        let miss2 = (p + l * nearest).norm_squared();
        if nearest <= 0.0 || miss2 >= (1.0 + penumbra) * (1.0 + penumbra) {
            return 0.0;
        }
        let miss = miss2.sqrt();
        let covered = 1.0 - smoothstep(1.0 - penumbra, 1.0 + penumbra, miss);
        let largest = (1.0 / (penumbra * penumbra)).min(1.0);
        let height = point[2] + nearest * light[2];
        let open = self.open_above.map_or(0.0, |z| smoothstep(z - 0.1, z + 0.5, height));
        covered * largest * (1.0 - open)
    }

    /// Share of the sky above a surface with this normal that it hides from `point`: exact for a sphere wholly
    /// above the surface.
    pub(super) fn occlusion(&self, point: Vector3, normal: Vector3) -> f64 {
        let towards = self.centre - point;
        let cosine = normal.dot(&towards);
        if cosine <= 0.0 {
            return 0.0;
        }
        let square = towards.norm_squared();
        let radius = self.radius();
        (cosine / square.sqrt() * radius * radius / square).min(1.0)
    }

    /// The corners of a box around it.
    pub(super) fn corners(&self) -> [Vector3; 8] {
        let reach = self.radii[0].max(self.radii[1]);
        let reach = Vector3::new(reach, reach, self.radii[2]);
        std::array::from_fn(|i| {
            let side = |bit: usize| if i >> bit & 1 == 0 { -1.0 } else { 1.0 };
            self.centre + reach.component_mul(&Vector3::new(side(0), side(1), side(2)))
        })
    }

    fn radius(&self) -> f64 {
        (self.radii[0] + self.radii[1] + self.radii[2]) / 3.0
    }

    fn to_sphere(&self, v: Vector3) -> Vector3 {
        let (c, s) = self.turn;
        Vector3::new(c * v[0] + s * v[1], c * v[1] - s * v[0], v[2]).component_mul(&self.inverse)
    }

    fn turned_back(&self, v: Vector3) -> Vector3 {
        let (c, s) = self.turn;
        Vector3::new(c * v[0] - s * v[1], s * v[0] + c * v[1], v[2])
    }
}
