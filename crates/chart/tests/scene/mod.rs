//! Pictures made up: a plane with a pattern, seen by some camera in some light from somewhere.

#![allow(dead_code, reason = "each test uses a part of it")]

pub(crate) mod clutter;

use darkroot_chart::{ChartLayout, Homography, Quad, SearchImage};
use darkroot_colour::{RgbSpace, Vector3, white};

/// Random numbers (SplitMix64: Steele, Lea and Flood, OOPSLA 2014), the same everywhere.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// From `low` to `high`.
    pub(crate) fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    pub(crate) fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    /// About normal, standard deviation 1.
    pub(crate) fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.within(0.0, 1.0)).sum::<f64>() - 6.0
    }

    pub(crate) fn colour(&mut self) -> [f64; 3] {
        [0; 3].map(|_| self.within(0.02, 0.95).powi(2))
    }
}

/// A number for a place, always the same for the same place and seed.
pub(crate) fn hash(seed: u64, i: i64, j: i64) -> u64 {
    Random(seed ^ (i as u64).wrapping_mul(0x1000_0001) ^ (j as u64).wrapping_mul(0x9_1000_0003)).next()
}

/// How a plane is photographed.
pub(crate) struct Shot {
    pub(crate) size: [usize; 2],
    /// From the plane to pixels.
    pub(crate) map: Homography,
    /// Camera colours of light, by rows.
    pub(crate) camera: [[f64; 3]; 3],
    /// Change of the light over the frame's width and height, in stops.
    pub(crate) shade: [f64; 2],
    /// Standard deviation of the noise of white.
    pub(crate) noise: f64,
    /// Rounds of smoothing by a pixel.
    pub(crate) blur: usize,
    /// Power of the tone curve; 1 for raw.
    pub(crate) gamma: f64,
    /// Light in a shadow whose edge runs through the frame: place and slope of the edge, share of light.
    pub(crate) shadow: Option<[f64; 3]>,
}

impl Shot {
    /// Some camera, some light, some noise.
    pub(crate) fn some(random: &mut Random, size: [usize; 2], map: Homography) -> Self {
        let camera = [0, 1, 2].map(|c| {
            let gain = random.within(0.35, 1.0);
            let mut row = [0; 3].map(|_| random.within(0.0, 0.22));
            row[c] += 1.0 - row.iter().sum::<f64>();
            row.map(|v| v * gain)
        });
        Self {
            size,
            map,
            camera,
            shade: [random.within(-1.0, 1.0), random.within(-1.0, 1.0)],
            noise: random.within(0.002, 0.012),
            blur: random.below(2),
            gamma: random.within(0.75, 1.3),
            shadow: None,
        }
    }

    /// The picture of a pattern: light in Rec. 2020 at a point of the plane.
    pub(crate) fn picture(&self, random: &mut Random, pattern: &dyn Fn(f64, f64) -> [f64; 3]) -> SearchImage {
        let [width, height] = self.size;
        let Some(back) = self.map.inverse() else {
            unreachable!("shots are made with maps that have an inverse")
        };
        let mut planes = [0; 3].map(|_| vec![0.0f32; width * height]);
        for y in 0..height {
            for x in 0..width {
                let mut light = [0.0; 3];
                for (dx, dy) in [(-0.25, -0.25), (0.25, -0.25), (-0.25, 0.25), (0.25, 0.25)] {
                    let [u, v] = back.apply([x as f64 + dx, y as f64 + dy]);
                    let seen = pattern(u, v);
                    (0..3).for_each(|c| light[c] += seen[c] / 4.0);
                }
                let (across, down) = (x as f64 / width as f64 - 0.5, y as f64 / height as f64 - 0.5);
                let mut shade = (self.shade[0] * across + self.shade[1] * down).exp2();
                if let Some([place, slope, share]) = self.shadow
                    && across + slope * down > place
                {
                    shade *= share;
                }
                for (plane, row) in planes.iter_mut().zip(&self.camera) {
                    let value = (0..3).map(|k| row[k] * light[k]).sum::<f64>() * shade;
                    plane[y * width + x] = value as f32;
                }
            }
        }
        for plane in &mut planes {
            for _ in 0..self.blur {
                smooth(plane, width, height);
            }
            for v in plane.iter_mut() {
                let value = f64::from(*v);
                let noise = self.noise * (0.1 + value.max(0.0)).sqrt() * random.normal();
                *v = (value + noise).max(0.0).powf(self.gamma).min(1.0) as f32;
            }
        }
        SearchImage { width, height, planes }
    }
}

fn smooth(plane: &mut [f32], width: usize, height: usize) {
    for row in plane.chunks_exact_mut(width) {
        let old = row.to_vec();
        for x in 1..width - 1 {
            row[x] = 0.25 * old[x - 1] + 0.5 * old[x] + 0.25 * old[x + 1];
        }
    }
    let old = plane.to_vec();
    for y in 1..height - 1 {
        for x in 0..width {
            let at = |y: usize| old[y * width + x];
            plane[y * width + x] = 0.25 * at(y - 1) + 0.5 * at(y) + 0.25 * at(y + 1);
        }
    }
}

/// Some place for a rectangle of this width and height, `share` of the frame's width wide and turned by `degrees`.
pub(crate) fn placed(
    random: &mut Random,
    frame: [usize; 2],
    extent: [f64; 2],
    share: f64,
    degrees: f64,
) -> Quad {
    let [width, height] = frame.map(|v| v as f64);
    let (sin, cos) = degrees.to_radians().sin_cos();
    // Half the diagonal with its tilt stays in the frame.
    let half_diagonal = 0.55 * extent[0].hypot(extent[1]);
    let scale = (share * width / extent[0].max(extent[1])).min(0.47 * width.min(height) / half_diagonal);
    let reach = half_diagonal * scale;
    let mut somewhere = |side: f64| {
        let free = (side / 2.0 - reach).max(0.0);
        side / 2.0 + random.within(-free, free)
    };
    let centre = [somewhere(width), somewhere(height)];
    [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]].map(|[x, y]| {
        let (x, y) = (x * extent[0] * scale, y * extent[1] * scale);
        let tilt = 0.05 * scale * extent[0].min(extent[1]);
        [
            centre[0] + cos * x - sin * y + random.within(-tilt, tilt),
            centre[1] + sin * x + cos * y + random.within(-tilt, tilt),
        ]
    })
}

/// Width and height of a chart in patches.
pub(crate) fn extent(layout: &ChartLayout) -> [f64; 2] {
    [layout.column_edges(layout.columns - 1)[1], layout.row_edges(layout.rows - 1)[1]]
}

/// Light of the patches in Rec. 2020.
pub(crate) fn colours(layout: &ChartLayout) -> Vec<[f64; 3]> {
    let matrix = RgbSpace::REC2020.from_xyz_under(white::D50);
    let rgb = |lab: darkroot_colour::Lab| {
        let xyz = lab.xyz(white::D50);
        let rgb = matrix * Vector3::new(xyz.x, xyz.y, xyz.z);
        [0, 1, 2].map(|c| rgb[c].max(0.001))
    };
    layout.patches.iter().map(|p| rgb(p.lab)).collect()
}

/// A chart on a card, in patches from its top left corner, before something.
pub(crate) fn chart_before<B: Fn(f64, f64) -> [f64; 3]>(
    layout: &ChartLayout,
    colours: &[[f64; 3]],
    behind: B,
) -> impl Fn(f64, f64) -> [f64; 3] + use<B> {
    let [width, height] = extent(layout);
    let columns: Vec<[f64; 2]> = (0..layout.columns).map(|c| layout.column_edges(c)).collect();
    let rows: Vec<[f64; 2]> = (0..layout.rows).map(|r| layout.row_edges(r)).collect();
    let colours = colours.to_vec();
    move |x, y| {
        let margin = 0.4;
        if x < -margin || y < -margin || x > width + margin || y > height + margin {
            return behind(x, y);
        }
        let within = |edges: &[[f64; 2]], v: f64| edges.iter().position(|e| v >= e[0] && v < e[1]);
        match (within(&columns, x), within(&rows, y)) {
            (Some(column), Some(row)) => colours[row * columns.len() + column],
            _ => [0.025; 3],
        }
    }
}

/// Blotches of some colours.
pub(crate) fn blotches(seed: u64, size: f64) -> impl Fn(f64, f64) -> [f64; 3] {
    move |x, y| {
        let (x, y) = (x / size, y / size);
        let (i, j) = (x.floor(), y.floor());
        let mut sum = [0.0; 3];
        for (di, dj) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            let (fx, fy) = (x - i, y - j);
            let weight = if di == 0 { 1.0 - fx } else { fx } * if dj == 0 { 1.0 - fy } else { fy };
            let colour = Random(hash(seed, i as i64 + di, j as i64 + dj)).colour();
            (0..3).for_each(|c| sum[c] += weight * colour[c]);
        }
        sum
    }
}
