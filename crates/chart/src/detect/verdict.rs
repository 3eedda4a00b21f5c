//! Whether a candidate is a chart: edges and colours at full resolution.

use super::colours::Fit;
use super::found::{Found, Rejected};
use super::pixels::SearchImage;
use super::placement::{Candidate, Family};
use super::refine::{Refined, refine};
use super::refusal::Refusal;
use crate::geometry::is_convex;
use crate::{ChartLayout, Homography, Quad};

/// Most of the variance that may stay unexplained, for lightness and for ratios of channels.
const UNEXPLAINED: [f64; 2] = [0.25, 0.22];
/// The best other reading (turned, shifted, mirrored) must leave this much more unexplained.
const CLEARLY: f64 = 1.8;
/// Least standard deviation of the logarithms of the ratios of channels: less is grey, or another chart.
const COLOURFUL: f64 = 0.08;
/// Share of the edges that must be seen in their places.
const EDGES_SEEN: f64 = 0.45;
/// Largest error of the edges, in patches.
const EDGE_ERROR: f64 = 0.045;

/// Accepts or refuses a candidate.
pub(super) fn judge(
    picture: &SearchImage,
    candidate: &Candidate,
    families: &[Family],
) -> Result<Found, Box<Rejected>> {
    let family = &families[candidate.family];
    let chart = family.layout().title.clone();
    let refuse = |nearness: f64, reason: Refusal| {
        let layout = family.layout().name.clone();
        let corners = Some(candidate.corners());
        Err(Box::new(Rejected { layout, corners, reason, nearness: nearness.min(0.99) }))
    };
    if candidate.mirrored {
        return refuse(0.8, Refusal::Mirrored { chart });
    }
    let Some(refined) = refine(picture, candidate, family) else {
        return refuse(0.3, Refusal::NoEdges { chart });
    };
    let corners = corners(&refined, family);
    let inside = |p: &[f64; 2]| {
        p[0] > -1.0 && p[1] > -1.0 && p[0] < picture.width as f64 && p[1] < picture.height as f64
    };
    if !is_convex(&corners) || !corners.iter().all(inside) {
        return refuse(0.4, Refusal::BeyondPicture { chart });
    }
    let Some(fit) = colours(picture, &refined, family) else {
        return refuse(0.4, Refusal::BeyondPicture { chart });
    };
    if refined.seen < EDGES_SEEN || refined.error > EDGE_ERROR {
        return refuse(0.6 * refined.seen / EDGES_SEEN, Refusal::Edges { chart, seen: refined.seen });
    }
    let worst = (fit.lightness / UNEXPLAINED[0]).max(fit.chroma / UNEXPLAINED[1]);
    if worst > 1.0 {
        let reason = Refusal::Colours { chart, lightness: fit.lightness, colour: fit.chroma };
        return refuse(0.95 / worst, reason);
    }
    if fit.colourfulness < COLOURFUL {
        return refuse(0.5, Refusal::Grey { chart });
    }
    if candidate.next < CLEARLY * candidate.fit.unexplained() {
        return refuse(0.9, Refusal::Ambiguous { chart });
    }
    Ok(found(&refined, family, fit, corners))
}

fn corners(refined: &Refined, family: &Family) -> Quad {
    let columns = family.columns();
    let [x, y] = refined.half;
    let (right, bottom) = (columns[columns.len() - 1] + x, (family.layout().rows - 1) as f64 + y);
    [[-x, -y], [right, -y], [right, bottom], [-x, bottom]].map(|p| refined.map.apply(p))
}

/// Points along a side of a patch's middle that are averaged.
const POINTS: usize = 9;

fn colours(picture: &SearchImage, refined: &Refined, family: &Family) -> Option<Fit> {
    let columns = family.columns();
    let seen: Option<Vec<[f64; 3]>> = (0..columns.len() * family.layout().rows)
        .map(|i| {
            let centre = [columns[i % columns.len()], (i / columns.len()) as f64];
            middle(picture, &refined.map, centre, refined.half)
        })
        .collect();
    let seen = seen?;
    Some(family.expected.fit(|i| seen[i]))
}

/// Mean over the middle 60 % of a patch without the brightest and darkest quarter.
fn middle(picture: &SearchImage, map: &Homography, centre: [f64; 2], half: [f64; 2]) -> Option<[f64; 3]> {
    let mut values: [Vec<f32>; 3] = Default::default();
    for n in 0..POINTS * POINTS {
        let offset = [n % POINTS, n / POINTS].map(|k| 1.2 * (k as f64 / (POINTS - 1) as f64 - 0.5));
        let [x, y] = map.apply([centre[0] + offset[0] * half[0], centre[1] + offset[1] * half[1]]);
        if !(x >= 0.0 && y >= 0.0 && x <= picture.width as f64 && y <= picture.height as f64) {
            return None;
        }
        for (c, values) in values.iter_mut().enumerate() {
            values.push(picture.at(c, x, y));
        }
    }
    Some(values.map(|mut v| {
        v.sort_by(f32::total_cmp);
        let half = &v[v.len() / 4..v.len() - v.len() / 4];
        half.iter().map(|v| f64::from(*v)).sum::<f64>() / half.len() as f64
    }))
}

fn found(refined: &Refined, family: &Family, fit: Fit, corners: Quad) -> Found {
    let gap = refined.half.map(|h| (0.5 / h - 1.0).max(0.0));
    let mean = (gap[0] + gap[1]) / 2.0;
    let misfit = |l: &&ChartLayout| (l.gap - mean).abs();
    let nearest = family.layouts.iter().min_by(|a, b| misfit(a).total_cmp(&misfit(b)));
    let layout = nearest.unwrap_or(family.layout());
    let middle = |a: usize, b: usize| [0, 1].map(|k| (corners[a][k] + corners[b][k]) / 2.0);
    let (left, right) = (middle(0, 3), middle(1, 2));
    let worst = (fit.lightness / UNEXPLAINED[0]).max(fit.chroma / UNEXPLAINED[1]);
    let edges = ((refined.seen - EDGES_SEEN) / (0.9 - EDGES_SEEN)).clamp(0.0, 1.0);
    let mut found = Found {
        layout: layout.name.clone(),
        corners,
        confidence: (1.0 - worst * worst) * (0.5 + 0.5 * edges),
        rotation_degrees: (right[1] - left[1]).atan2(right[0] - left[0]).to_degrees(),
        patch_pixels: 0.0,
        gap,
        columns: layout.columns,
        rows: layout.rows,
        hinge: layout.hinge,
        edge_error: refined.error,
        edges_seen: refined.seen,
        unexplained: fit.unexplained(),
    };
    let patches = found.columns * found.rows;
    let areas: f64 = (0..patches).map(|i| crate::geometry::area(&found.patch(i, 0.0))).sum();
    found.patch_pixels = (areas / patches as f64).max(0.0).sqrt();
    found
}
