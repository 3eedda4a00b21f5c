//! Shots of a chart to a profile.

use std::path::PathBuf;

use darkroot_chart::{Layout, Reference};
use darkroot_profile::{Kind, Origin, Profile, ProfileCamera};

use crate::calibrate::{Calibrated, Choice, MeasuredPatch, calibrate};
use crate::light::NamedLight;
use crate::shot::{Fold, Gate, Shot, ShotOptions, Verdict, View, agreement, light_of, linearity, open};
use crate::{Error, Settings};

/// Shots nearer than this in light, in stops, are shots at one exposure.
const ONE_EXPOSURE: f64 = 0.2;

/// Red or blue against green, as a natural logarithm, from which the camera's white is another than the light's.
const OTHER_WHITE: f64 = 0.15;

/// What a profile is made from.
#[derive(Debug, Clone, PartialEq)]
pub struct ChartRequest {
    /// Shots of the chart with the light of each. Those under one light are an exposure bracket, or `average` is set.
    pub shots: Vec<(PathBuf, NamedLight)>,
    /// The chart.
    pub layout: Layout,
    /// What its patches are.
    pub reference: Reference,
    /// Name of the reference, for the profile ("classic24-after-2014", "my-chart.cie").
    pub reference_name: String,
    /// SHA-256 of its file; empty for those built in.
    pub reference_sha256: String,
    /// How the shots are treated.
    pub options: ShotOptions,
    /// Take the mean of shots under one light at one exposure. Without it they are refused, because two lights may
    /// have been meant.
    pub average: bool,
    /// The model; the best one if not given.
    pub kind: Option<Kind>,
    /// Day that the profile carries, YYYY-MM-DD; may be empty.
    pub date: String,
}

/// One light of a made profile.
#[derive(Debug, Clone, PartialEq)]
pub struct MadeLight {
    /// The light.
    pub light: NamedLight,
    /// The shots under it.
    pub shots: Vec<Shot>,
    /// What was checked between the shots: `linearity` of an exposure bracket, `agreement` of what is averaged; and
    /// whether the `light` is the one that was named.
    pub gates: Vec<Gate>,
    /// The calibration.
    pub calibrated: Calibrated,
    /// The first shot, to look at.
    pub view: View,
}

/// A profile and how it came about.
#[derive(Debug, Clone, PartialEq)]
pub struct MadeProfile {
    /// The profile.
    pub profile: Profile,
    /// Its lights, as they were given.
    pub lights: Vec<MadeLight>,
}

/// Measures the shots and fits the profile.
///
/// # Errors
/// Shots that cannot be used, shots of several cameras, too few patches.
pub fn make_profile(request: &ChartRequest, settings: &Settings) -> Result<MadeProfile, Error> {
    let mut lights: Vec<MadeLight> = Vec::new();
    let mut names: Vec<&str> = Vec::new();
    for (_, light) in &request.shots {
        if !names.contains(&light.light.name.as_str()) {
            names.push(&light.light.name);
        }
    }
    let mut camera: Option<darkroot_photo::Camera> = None;
    for name in names {
        let mut opened = Vec::new();
        for (path, light) in request.shots.iter().filter(|(_, l)| l.light.name == name) {
            let (shot, view) = open(path, &request.layout, &request.reference, &request.options, settings)?;
            let first = camera.get_or_insert_with(|| shot.camera.clone());
            if *first != shot.camera {
                let what = format!(
                    "was taken with {} {}, another shot with {} {}; a profile is for one camera",
                    shot.camera.common_make, shot.camera.common_model, first.common_make, first.common_model
                );
                return Err(Error::Chart { path: path.clone(), what });
            }
            opened.push((shot, view, light));
        }
        let Some((_, _, light)) = opened.first() else { continue };
        let light: NamedLight = (*light).clone();
        let (shots, mut views): (Vec<Shot>, Vec<View>) =
            opened.into_iter().map(|(shot, view, _)| (shot, view)).unzip();
        let mut gates = between(&shots, &light, request)?;
        let patches = averaged(&shots);
        let choice = Choice { kind: request.kind, folds: folds(&shots) };
        let mut calibrated = calibrate(&light, &patches, &choice)
            .map_err(|e| Error::Fit { light: name.to_owned(), what: e.to_string() })?;
        if let Some(matrix) = views.first().and_then(|view| view.matrix.as_ref()) {
            gates.push(light_of(matrix.white_of(calibrated.white_rgb), light.light.xy, name));
        }
        if let Some(as_shot) = views.first().and_then(|view| view.as_shot) {
            calibrated.notes.extend(other_white(as_shot, calibrated.white_rgb));
        }
        lights.push(MadeLight { light, shots, gates, calibrated, view: views.swap_remove(0) });
    }
    let camera = camera.ok_or(Error::NoLight)?;
    let calibrations = lights.iter().map(|l| l.calibrated.calibration.clone()).collect();
    let count = request.shots.len();
    let origin = Origin {
        summary: format!("{count} shot{} of a chart", if count == 1 { "" } else { "s" }),
        chart: request.layout.title.clone(),
        reference: request.reference_name.clone(),
        reference_sha256: request.reference_sha256.clone(),
        date: request.date.clone(),
        program: format!("darkroot {}", crate::VERSION),
        ..Origin::default()
    };
    let alias = format!("{} {}", camera.make, camera.model);
    let of = ProfileCamera {
        make: camera.common_make.clone(),
        model: camera.common_model.clone(),
        aliases: if alias.trim() == format!("{} {}", camera.common_make, camera.common_model).trim() {
            Vec::new()
        } else {
            vec![alias]
        },
    };
    let profile = Profile::new(of, calibrations, origin).ok_or(Error::NoLight)?;
    Ok(MadeProfile { profile, lights })
}

/// Shots under one light as one: each scaled to the exposure of the first, patches that are clipped in a shot taken
/// from the others.
fn averaged(shots: &[Shot]) -> Vec<MeasuredPatch> {
    let Some((first, others)) = shots.split_first() else { return Vec::new() };
    if others.is_empty() {
        return first.patches.clone();
    }
    let scales: Vec<f64> = shots.iter().map(|s| ratio(&first.patches, &s.patches)).collect();
    let one = |i: usize| {
        let usable: Vec<(&MeasuredPatch, f64)> = shots
            .iter()
            .zip(&scales)
            .map(|(s, k)| (&s.patches[i], *k))
            .filter(|(p, _)| p.excluded.is_none())
            .collect();
        let mut patch = first.patches[i].clone();
        let Some(((best, _), count)) = usable.first().zip(Some(usable.len() as f64)) else { return patch };
        patch.excluded = None;
        patch.clipped = best.clipped;
        patch.rgb = [0, 1, 2].map(|c| usable.iter().map(|(p, k)| p.rgb[c] * k).sum::<f64>() / count);
        patch.uncertainty = [0, 1, 2]
            .map(|c| usable.iter().map(|(p, k)| (p.uncertainty[c] * k).powi(2)).sum::<f64>().sqrt() / count);
        patch
    };
    (0..first.patches.len()).map(one).collect()
}

/// What to say where the camera's white balance is not that of the light of the chart.
fn other_white(as_shot: [f64; 3], white: [f64; 3]) -> Option<String> {
    let ratio = |c: usize| (as_shot[c] / as_shot[1] * white[1] / white[c]).ln().abs();
    let gain = |c: usize| white[1] / white[c];
    (ratio(0).max(ratio(2)) > OTHER_WHITE).then(|| {
        format!(
            "the white balance in the file is not that of the chart's light: to see the chart as it is, develop with \
             `--white-balance {:.3},1,{:.3}`",
            gain(0),
            gain(2)
        )
    })
}

/// Shots under one light as one, corrected without the help of some patches.
fn folds(shots: &[Shot]) -> Vec<Fold> {
    let count = shots.iter().map(|s| s.folds.len()).min().unwrap_or(0);
    let fold = |k: usize| {
        let corrected: Vec<Shot> = shots
            .iter()
            .map(|shot| {
                let mut shot = shot.clone();
                for (patch, rgb) in shot.patches.iter_mut().zip(&shot.folds[k].rgb) {
                    patch.rgb = *rgb;
                }
                shot
            })
            .collect();
        let rgb = averaged(&corrected).iter().map(|p| p.rgb).collect();
        Fold { left_out: shots[0].folds[k].left_out.clone(), rgb }
    };
    (0..count).map(fold).collect()
}

/// Light of one set of patches over that of another: the median over patches that both have.
fn ratio(one: &[MeasuredPatch], other: &[MeasuredPatch]) -> f64 {
    let usable = |p: &MeasuredPatch| p.excluded.is_none();
    let mut ratios: Vec<f64> = one
        .iter()
        .zip(other)
        .filter(|(a, b)| usable(a) && usable(b) && b.rgb[1] > 0.0)
        .map(|(a, b)| a.rgb[1] / b.rgb[1])
        .collect();
    ratios.sort_by(f64::total_cmp);
    ratios.get(ratios.len() / 2).copied().unwrap_or(1.0)
}

/// Checks of the shots under one light against the first of them.
fn between(shots: &[Shot], light: &NamedLight, request: &ChartRequest) -> Result<Vec<Gate>, Error> {
    let Some((first, others)) = shots.split_first() else { return Ok(Vec::new()) };
    let stops = |s: &Shot| ratio(&first.patches, &s.patches).log2();
    if !request.average
        && let Some((one, other)) = twins(shots, stops)
    {
        return Err(Error::SeveralShots {
            one: one.path.clone(),
            other: other.path.clone(),
            light: light.light.name.clone(),
        });
    }
    let gate = |differs: bool, judge: fn(f64, &str) -> Gate| {
        let compared = others.iter().filter(|s| (stops(s).abs() > ONE_EXPOSURE) == differs);
        let worst = compared
            .map(|s| (departure(&first.patches, &s.patches), s))
            .max_by(|(a, _), (b, _)| a.total_cmp(b));
        worst.map(|(found, shot)| (judge(found, &shot.path.display().to_string()), shot))
    };
    let mut gates = Vec::new();
    for (gate, shot) in [gate(true, linearity), gate(false, agreement)].into_iter().flatten() {
        if gate.verdict == Verdict::Refused && !request.options.accept {
            let what = format!("{}; {} (or add `--accept`)", gate.words, gate.advice);
            return Err(Error::Chart { path: shot.path.clone(), what });
        }
        gates.push(gate);
    }
    Ok(gates)
}

/// The first two shots at one exposure, if there are any.
fn twins(shots: &[Shot], stops: impl Fn(&Shot) -> f64) -> Option<(&Shot, &Shot)> {
    let light: Vec<f64> = shots.iter().map(stops).collect();
    let pairs = (0..shots.len()).flat_map(|i| (i + 1..shots.len()).map(move |j| (i, j)));
    let mut near = pairs.filter(|(i, j)| (light[*i] - light[*j]).abs() <= ONE_EXPOSURE);
    near.next().map(|(i, j)| (&shots[i], &shots[j]))
}

/// How far two sets of patches are from being the same scaled: the largest relative departure of a channel of a patch
/// from the channel's median ratio, less three standard errors of its noise.
fn departure(one: &[MeasuredPatch], other: &[MeasuredPatch]) -> f64 {
    let pairs: Vec<(&MeasuredPatch, &MeasuredPatch)> =
        one.iter().zip(other).filter(|(a, b)| a.excluded.is_none() && b.excluded.is_none()).collect();
    let of_channel = |c: usize| {
        let ratio = |(a, b): &(&MeasuredPatch, &MeasuredPatch)| a.rgb[c] / b.rgb[c];
        let mut ratios: Vec<f64> = pairs.iter().map(ratio).collect();
        ratios.sort_by(f64::total_cmp);
        let Some(scale) = ratios.get(ratios.len() / 2) else { return 0.0 };
        let beyond = |pair: &(&MeasuredPatch, &MeasuredPatch)| {
            let (a, b) = pair;
            let noise = (a.uncertainty[c] / a.rgb[c]).hypot(b.uncertainty[c] / b.rgb[c]);
            (ratio(pair) / scale - 1.0).abs() - 3.0 * noise
        };
        pairs.iter().map(beyond).fold(0.0, f64::max)
    };
    (0..3).map(of_channel).fold(0.0, f64::max)
}
