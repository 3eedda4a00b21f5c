//! Profiles with tables: `lut8Type`, `lut16Type` and `lutAToBType` of ICC.1:2022 (10.10 to 10.12), from RGB to XYZ relative to
//! D50. moxcms reads them; its own transforms go through a table of 33 steps to the other profile, which is too coarse to
//! measure by.

use darkroot_colour::{Lab, Xyz, white};
use moxcms::{
    ColorProfile, DataColorSpace, LutDataType, LutMultidimensionalType, LutStore, LutWarehouse, ToneReprCurve,
};

use super::ProfileFault;

/// Numbers that a curve is kept at; between them lie straight lines.
const STEPS: usize = 4096;

/// From encoded RGB to XYZ.
pub(super) struct Tables {
    first: [Curve; 3],
    grid: Option<Grid>,
    middle: Option<([Curve; 3], [[f32; 4]; 3])>,
    last: [Curve; 3],
    connection: Connection,
}

/// The largest number of XYZ in 16 bits (6.3.4.2).
const MOST: f64 = 1.0 + 32_767.0 / 32_768.0;

/// How a table writes colours of the connection space.
#[derive(Clone, Copy)]
enum Connection {
    Xyz,
    Lab,
    /// As version 2 wrote Lab in 16 bits: 0xff00 is the largest.
    OldLab,
}

/// A curve over 0..=1.
struct Curve(Vec<f32>);

/// A table over three channels, the last of which changes fastest.
struct Grid {
    points: [usize; 3],
    values: Vec<[f32; 3]>,
}

impl Tables {
    /// The tables for relative colorimetric rendering, else for perceptual.
    pub(super) fn of(profile: &ColorProfile) -> Result<Option<Self>, ProfileFault> {
        let Some(table) = profile.lut_a_to_b_colorimetric.as_ref().or(profile.lut_a_to_b_perceptual.as_ref())
        else {
            return Ok(None);
        };
        let lab = match profile.pcs {
            DataColorSpace::Lab => true,
            DataColorSpace::Xyz => false,
            _ => return Err(ProfileFault::Empty),
        };
        let built = match table {
            LutWarehouse::Lut(table) => Self::of_lut(table, lab),
            LutWarehouse::Multidimensional(table) => Self::of_curves(table, lab),
        };
        built.map(Some).ok_or(ProfileFault::Empty)
    }

    /// `lut8Type` and `lut16Type`.
    fn of_lut(table: &LutDataType, lab: bool) -> Option<Self> {
        if table.num_input_channels != 3 || table.num_output_channels != 3 {
            return None;
        }
        let sixteen = matches!(table.clut_table, LutStore::Store16(_));
        let curves = |store: &LutStore, entries: u16| {
            let values = values(store);
            let entries = usize::from(entries);
            let one = |c: usize| values.get(c * entries..(c + 1) * entries).and_then(Curve::of_table);
            Some([one(0)?, one(1)?, one(2)?])
        };
        Some(Self {
            first: curves(&table.input_table, table.num_input_table_entries)?,
            grid: Some(Grid::of([usize::from(table.num_clut_grid_points); 3], &table.clut_table)?),
            middle: None,
            last: curves(&table.output_table, table.num_output_table_entries)?,
            connection: match (lab, sixteen) {
                (false, _) => Connection::Xyz,
                (true, true) => Connection::OldLab,
                (true, false) => Connection::Lab,
            },
        })
    }

    /// `lutAToBType`.
    fn of_curves(table: &LutMultidimensionalType, lab: bool) -> Option<Self> {
        if table.num_input_channels != 3 || table.num_output_channels != 3 {
            return None;
        }
        let points = [0, 1, 2].map(|c| usize::from(table.grid_points[c]));
        let rows = [0, 1, 2].map(|r| {
            let row = table.matrix.v[r];
            [row[0] as f32, row[1] as f32, row[2] as f32, table.bias.v[r] as f32]
        });
        Some(Self {
            first: three_of(&table.a_curves).unwrap_or_else(Curve::straight),
            grid: match &table.clut {
                Some(clut) => Some(Grid::of(points, clut)?),
                None => None,
            },
            middle: three_of(&table.m_curves).map(|curves| (curves, rows)),
            last: three_of(&table.b_curves)?,
            connection: if lab { Connection::Lab } else { Connection::Xyz },
        })
    }

    /// XYZ relative to D50 of encoded RGB.
    pub(super) fn xyz(&self, rgb: [f32; 3]) -> Xyz {
        let mut v = [0, 1, 2].map(|c| self.first[c].at(rgb[c]));
        if let Some(grid) = &self.grid {
            v = grid.at(v);
        }
        if let Some((curves, rows)) = &self.middle {
            let w = [0, 1, 2].map(|c| curves[c].at(v[c]));
            v = rows.map(|row| row[0] * w[0] + row[1] * w[1] + row[2] * w[2] + row[3]);
        }
        let v = [0, 1, 2].map(|c| f64::from(self.last[c].at(v[c])));
        match self.connection {
            Connection::Xyz => Xyz::new(MOST * v[0], MOST * v[1], MOST * v[2]),
            Connection::Lab => lab(100.0 * v[0], 255.0 * v[1] - 128.0, 255.0 * v[2] - 128.0),
            Connection::OldLab => {
                let [l, a, b] = v.map(|v| v * 65_535.0);
                lab(l * 100.0 / 65_280.0, a / 256.0 - 128.0, b / 256.0 - 128.0)
            }
        }
    }
}

fn lab(l: f64, a: f64, b: f64) -> Xyz {
    Lab { l, a, b }.xyz(white::D50)
}

fn values(store: &LutStore) -> Vec<f32> {
    match store {
        LutStore::Store8(v) => v.iter().map(|v| f32::from(*v) / 255.0).collect(),
        LutStore::Store16(v) => v.iter().map(|v| f32::from(*v) / 65_535.0).collect(),
    }
}

/// Three curves; `None` where there are not three, or one is none.
fn three_of(curves: &[ToneReprCurve]) -> Option<[Curve; 3]> {
    let [r, g, b] = curves else { return None };
    Some([Curve::of(r)?, Curve::of(g)?, Curve::of(b)?])
}

impl Curve {
    fn straight() -> [Self; 3] {
        [0, 1, 2].map(|_| Self(vec![0.0, 1.0]))
    }

    fn of(curve: &ToneReprCurve) -> Option<Self> {
        if let ToneReprCurve::Lut(values) = curve
            && values.len() > 1
        {
            return Self::of_table(&values.iter().map(|v| f32::from(*v) / 65_535.0).collect::<Vec<_>>());
        }
        let evaluator = curve.make_linear_evaluator().ok()?;
        let values = (0..=STEPS).map(|i| evaluator.evaluate_value(i as f32 / STEPS as f32));
        Self::of_table(&values.collect::<Vec<_>>())
    }

    fn of_table(values: &[f32]) -> Option<Self> {
        (values.len() > 1 && values.iter().all(|v| v.is_finite())).then(|| Self(values.to_vec()))
    }

    fn at(&self, v: f32) -> f32 {
        let last = self.0.len() - 1;
        let place = v.clamp(0.0, 1.0) * last as f32;
        let low = (place as usize).min(last - 1);
        self.0[low] + (self.0[low + 1] - self.0[low]) * (place - low as f32)
    }
}

impl Grid {
    fn of(points: [usize; 3], store: &LutStore) -> Option<Self> {
        let flat = values(store);
        let count = points.iter().try_fold(1usize, |all, n| all.checked_mul(*n))?;
        let fits = points.iter().all(|n| *n > 1) && flat.len() == 3 * count;
        fits.then(|| Self { points, values: flat.chunks_exact(3).map(|v| [v[0], v[1], v[2]]).collect() })
    }

    /// Between the four nodes of a tetrahedron, as colour management modules do it (Kasson, Plouffe and Nin, 1993).
    fn at(&self, v: [f32; 3]) -> [f32; 3] {
        let place = [0, 1, 2].map(|c| v[c].clamp(0.0, 1.0) * (self.points[c] - 1) as f32);
        let low = [0, 1, 2].map(|c| (place[c] as usize).min(self.points[c] - 2));
        let part = [0, 1, 2].map(|c| place[c] - low[c] as f32);
        let strides = [self.points[1] * self.points[2], self.points[2], 1];
        let mut order = [0, 1, 2];
        order.sort_by(|a, b| part[*b].total_cmp(&part[*a]));
        let mut node = (0..3).map(|c| low[c] * strides[c]).sum::<usize>();
        let mut here = self.values[node];
        let mut out = here;
        for c in order {
            node += strides[c];
            let next = self.values[node];
            for k in 0..3 {
                out[k] += (next[k] - here[k]) * part[c];
            }
            here = next;
        }
        out
    }
}
