//! Photographs with labelled charts, and how what was found compares with the labels.

#![allow(dead_code, reason = "the test and the example each use a part of it")]

use std::collections::BTreeMap;
use std::error::Error;
use std::fmt;
use std::path::{Path, PathBuf};

use darkroot_chart::geometry::{area, contains};
use darkroot_chart::{Found, Homography, Quad, SearchImage};
use serde::Deserialize;

/// A photograph and its labels.
pub(crate) struct Photo {
    pub(crate) name: String,
    pub(crate) path: PathBuf,
    charts: Vec<Label>,
}

#[derive(Deserialize)]
struct Entry {
    charts: Vec<Label>,
}

#[derive(Deserialize)]
struct Label {
    #[serde(rename = "type")]
    kind: String,
    corners: Quad,
    grid: [usize; 2],
    gap_frac: [f64; 2],
    usable: serde_json::Value,
    classic_layout: bool,
    negative_for_classic24: bool,
}

/// The photographs of a folder.
pub(crate) fn read(folder: &Path) -> Result<Vec<Photo>, Box<dyn Error>> {
    let text = std::fs::read_to_string(folder.join("labels.json"))?;
    let entries: BTreeMap<String, Entry> = serde_json::from_str(&text)?;
    Ok(entries
        .into_iter()
        .map(|(name, e)| Photo { path: folder.join(&name), name, charts: e.charts })
        .collect())
}

/// The picture in linear light, as if its curve were sRGB's.
pub(crate) fn open(path: &Path) -> Result<SearchImage, Box<dyn Error>> {
    let rgb = image::open(path)?.to_rgb8();
    let linear: Vec<f32> =
        (0..256).map(|v| darkroot_colour::TransferCurve::Srgb.decode(f64::from(v) / 255.0) as f32).collect();
    let plane = |c: usize| rgb.pixels().map(|p| linear[usize::from(p.0[c])]).collect();
    Ok(SearchImage {
        width: rgb.width() as usize,
        height: rgb.height() as usize,
        planes: [plane(0), plane(1), plane(2)],
    })
}

/// What became of the labels of one photograph.
pub(crate) struct Outcome<'a> {
    pub(crate) lines: Vec<String>,
    pub(crate) invented: Vec<&'a Found>,
    pub(crate) usable: usize,
    pub(crate) found: usize,
    pub(crate) turned: usize,
    pub(crate) errors: Vec<f64>,
}

pub(crate) fn compare<'a>(photo: &Photo, found: &'a [Found]) -> Outcome<'a> {
    let mut outcome = Outcome {
        lines: Vec::new(),
        invented: Vec::new(),
        usable: 0,
        found: 0,
        turned: 0,
        errors: Vec::new(),
    };
    let mut matched = vec![false; found.len()];
    for label in &photo.charts {
        let usable = label.usable == serde_json::Value::Bool(true);
        // There is no layout to find for look-alikes but the Spyder 24.
        let spyder = label.negative_for_classic24 && photo.name.contains("Testbild1");
        let wanted = usable && (!label.negative_for_classic24 || spyder);
        let hit = (0..found.len()).find(|i| same_place(&label.corners, &found[*i].corners));
        let mut result = "-".to_owned();
        let mut turned = "";
        outcome.usable += usize::from(wanted);
        if let Some(i) = hit {
            let right = match (label.classic_layout, spyder) {
                (true, _) => found[i].columns == 6 && !found[i].layout.starts_with("spyder"),
                (_, true) => found[i].layout == "spyder24",
                _ => found[i].layout == label.kind,
            };
            if right {
                matched[i] = true;
                let error = median_error(label, &found[i]);
                result = format!("{error:.4}");
                if error > 0.5 {
                    turned = "TURNED";
                    outcome.turned += 1;
                } else if wanted {
                    outcome.found += 1;
                    outcome.errors.push(error);
                }
            }
        }
        outcome.lines.push(format!("{:>10} {usable:>7} {result:>8} {turned:>7}", label.kind));
    }
    outcome.invented = found.iter().zip(matched).filter(|(_, matched)| !matched).map(|(f, _)| f).collect();
    outcome
}

fn same_place(one: &Quad, two: &Quad) -> bool {
    let middle = |q: &Quad| [0, 1].map(|k| q.iter().map(|p| p[k]).sum::<f64>() / 4.0);
    let ratio = area(one) / area(two);
    contains(one, middle(two)) && contains(two, middle(one)) && (0.6..1.7).contains(&ratio)
}

fn median_error(label: &Label, found: &Found) -> f64 {
    let Some(map) = Homography::onto(&label.corners) else { return f64::INFINITY };
    let [columns, rows] = label.grid;
    let share = |i: usize, n: usize, gap: f64, edge: f64| {
        (i as f64 * (1.0 + gap) + edge) / (n as f64 + (n as f64 - 1.0) * gap)
    };
    let mut errors: Vec<f64> = (0..columns * rows)
        .map(|i| {
            let at = |x: f64, y: f64| {
                let (column, row) = (i % columns, i / columns);
                map.apply([
                    share(column, columns, label.gap_frac[0], x),
                    share(row, rows, label.gap_frac[1], y),
                ])
            };
            let side = area(&[at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)]).abs().sqrt();
            let (is, should) = (found.centre(i), at(0.5, 0.5));
            (is[0] - should[0]).hypot(is[1] - should[1]) / side
        })
        .collect();
    errors.sort_by(f64::total_cmp);
    errors[errors.len() / 2]
}

/// Sums over all photographs.
#[derive(Default)]
pub(crate) struct Totals {
    pub(crate) usable: usize,
    pub(crate) found: usize,
    pub(crate) turned: usize,
    pub(crate) invented: usize,
    pub(crate) errors: Vec<f64>,
}

impl Totals {
    pub(crate) fn add(&mut self, outcome: &Outcome<'_>) {
        self.usable += outcome.usable;
        self.found += outcome.found;
        self.turned += outcome.turned;
        self.invented += outcome.invented.len();
        self.errors.extend(&outcome.errors);
    }

    /// Median over the charts of the median error of their patches' centres, in patches.
    pub(crate) fn median(&self) -> f64 {
        let mut errors = self.errors.clone();
        errors.sort_by(f64::total_cmp);
        errors.get(errors.len() / 2).copied().unwrap_or(f64::INFINITY)
    }
}

impl fmt::Display for Totals {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { usable, found, turned, invented, .. } = self;
        let worst = self.errors.iter().copied().fold(0.0, f64::max);
        write!(f, "usable {usable}, found {found}, turned {turned}, invented {invented}, ")?;
        write!(f, "median error {:.4} patch, worst {worst:.4}", self.median())
    }
}
