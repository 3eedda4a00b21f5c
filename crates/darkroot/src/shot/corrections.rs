//! What a shot's own patches tell of its light: glare with its colour, a slope of light, a change of the light's colour
//! over the chart. What patches are corrected by must not be judged by them, so it is found again without each.

use darkroot_chart::{ChannelLight, Slope};
use darkroot_colour::difference::de2000;
use darkroot_colour::{Xyz, white};
use darkroot_profile::Order;
use darkroot_profile::fit::{Samples, plain};

use super::gates;

/// Most groups of patches that are left out of the corrections in turn; a chart with fewer patches leaves out one each.
const MOST_FOLDS: usize = 24;
/// A slope for each channel is believed when it brings the linear model's error on patches that no part of it has seen
/// below this share of the error with one slope for all channels...
const JUSTIFIED: f64 = 0.90;
/// ... and when it changes the light's colour by more than this. What no matrix fits looks like a slope, too: of 56
/// simulated shots (14 cameras, 4 lights, 24 patches) without a change of colour none passes both, with a change of 4 %
/// half do, with one of 8 % 93 in 100.
const LEAST_CHANGE: f64 = 0.03;

/// The patches of a shot.
#[derive(Clone, Copy)]
pub(super) struct Patches<'a> {
    pub rgb: &'a [[f64; 3]],
    /// What they are, relative to D50.
    pub expected: &'a [Xyz],
    /// Where they are, -1 to 1.
    pub places: &'a [[f64; 2]],
    /// Which of them may tell of the light.
    pub used: &'a [bool],
}

/// What is to be taken out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Wanted {
    pub glare: bool,
    pub slope: Sloped,
}

/// Which slope is taken out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Sloped {
    Not,
    /// One for all channels.
    Together,
    /// One for each channel.
    Each,
}

/// All patches as corrected by what the patches but some tell.
#[derive(Debug, Clone, PartialEq)]
pub struct Fold {
    /// The patches that had no say.
    pub left_out: Vec<usize>,
    /// Camera RGB of all patches.
    pub rgb: Vec<[f64; 3]>,
}

/// Corrections of patches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Corrections {
    veil: [f64; 3],
    pub slopes: [Slope; 3],
}

impl Corrections {
    pub(super) fn of(patches: Patches<'_>, wanted: Wanted) -> Self {
        let seen = |lights: [Option<ChannelLight>; 3]| lights.map(|l| l.map_or(0.0, |l| l.veil));
        match wanted.slope {
            Sloped::Not => {
                let veil = if wanted.glare { seen(lights(patches, false)) } else { [0.0; 3] };
                Self { veil, slopes: [Slope::default(); 3] }
            }
            Sloped::Each => {
                // Where the patches are too few for that, one slope is all that they tell.
                let [Some(r), Some(g), Some(b)] = lights(patches, true) else {
                    return Self::of(patches, Wanted { slope: Sloped::Together, ..wanted });
                };
                let veil = if wanted.glare { [r.veil, g.veil, b.veil] } else { [0.0; 3] };
                Self { veil, slopes: [r.slope, g.slope, b.slope] }
            }
            Sloped::Together => {
                let slanted = Self { veil: [0.0; 3], slopes: [together(patches, [0.0; 3]); 3] };
                if !wanted.glare {
                    return slanted;
                }
                // Glare is what is left when the slope is out, and bends the slope that is found without it.
                let even = slanted.applied(patches);
                let veil = seen(lights(Patches { rgb: &even, ..patches }, false));
                Self { veil, slopes: [together(patches, veil); 3] }
            }
        }
    }

    pub(super) fn applied(&self, patches: Patches<'_>) -> Vec<[f64; 3]> {
        let one = |(rgb, place): (&[f64; 3], &[f64; 2])| {
            [0, 1, 2].map(|c| (rgb[c] - self.veil[c]) / self.slopes[c].at(*place))
        };
        patches.rgb.iter().zip(patches.places).map(one).collect()
    }
}

/// The slope of the patches' luminance.
fn together(patches: Patches<'_>, veil: [f64; 3]) -> Slope {
    let kept: Vec<usize> = (0..patches.rgb.len()).filter(|i| patches.used[*i]).collect();
    let rgb: Vec<[f64; 3]> = kept.iter().map(|i| [0, 1, 2].map(|c| patches.rgb[*i][c] - veil[c])).collect();
    let expected: Vec<Xyz> = kept.iter().map(|i| patches.expected[*i]).collect();
    let places: Vec<[f64; 2]> = kept.iter().map(|i| patches.places[*i]).collect();
    let targets: Vec<f64> = expected.iter().map(|c| c.y).collect();
    Slope::of(&places, &gates::luminances(&rgb, &expected), &targets).unwrap_or_default()
}

/// Glare of red, green and blue as shares of white; 0 where the patches cannot tell.
pub(super) fn glare(patches: Patches<'_>) -> [f64; 3] {
    lights(patches, false).map(|l| l.map_or(0.0, |l| l.glare()))
}

fn lights(patches: Patches<'_>, sloped: bool) -> [Option<ChannelLight>; 3] {
    [0, 1, 2].map(|c| {
        let channel: Vec<f64> = patches.rgb.iter().map(|rgb| rgb[c]).collect();
        ChannelLight::of(patches.places, &channel, patches.expected, patches.used, sloped)
    })
}

/// Every patch as corrected by what others tell; none where nothing is taken out.
pub(super) fn folds(patches: Patches<'_>, wanted: Wanted) -> Vec<Fold> {
    if !wanted.glare && wanted.slope == Sloped::Not {
        return Vec::new();
    }
    let count = patches.rgb.len();
    let groups = count.min(MOST_FOLDS);
    let fold = |group: usize| {
        let others: Vec<bool> = (0..count).map(|i| patches.used[i] && i % groups != group).collect();
        let rgb = Corrections::of(Patches { used: &others, ..patches }, wanted).applied(patches);
        Fold { left_out: (group..count).step_by(groups).collect(), rgb }
    };
    (0..groups).map(fold).collect()
}

/// How the colour of the light changes over the chart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ColourChange {
    /// Largest change of red or blue against green, relative.
    pub range: f64,
    /// Error of the linear model (mean dE2000 on patches left out of everything) with a slope for each channel, over
    /// that with one slope.
    pub gain: f64,
}

impl ColourChange {
    pub(super) fn of(patches: Patches<'_>) -> Self {
        let error = |slope: Sloped| left_out_error(patches, &folds(patches, Wanted { glare: true, slope }));
        let each = Corrections::of(patches, Wanted { glare: true, slope: Sloped::Each }).slopes;
        let against_green = |c: usize| {
            let (a, b) = (each[c].across - each[1].across, each[c].down - each[1].down);
            Slope { across: a, down: b }.range()
        };
        let gain = match (error(Sloped::Each), error(Sloped::Together)) {
            (Some(each), Some(one)) if one > 0.0 => each / one,
            _ => 1.0,
        };
        Self { range: against_green(0).max(against_green(2)), gain }
    }

    /// Whether patches that had no say in it bear it out.
    pub(super) fn is_justified(&self) -> bool {
        self.gain < JUSTIFIED && self.range > LEAST_CHANGE
    }
}

/// Mean dE2000 of the linear model on patches that took part neither in it nor in the corrections.
fn left_out_error(patches: Patches<'_>, folds: &[Fold]) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0.0);
    for fold in folds {
        let kept: Vec<usize> =
            (0..patches.rgb.len()).filter(|i| patches.used[*i] && !fold.left_out.contains(i)).collect();
        let rgb = kept.iter().map(|i| fold.rgb[*i]).collect();
        let xyz = kept.iter().map(|i| patches.expected[*i]).collect();
        let model = plain::root(&Samples::new(rgb, xyz, white::D50).ok()?, Order::One).ok()?.model;
        for i in fold.left_out.iter().filter(|i| patches.used[**i]) {
            sum += de2000(model.xyz(fold.rgb[*i]).lab(white::D50), patches.expected[*i].lab(white::D50));
            count += 1.0;
        }
    }
    (count > 0.0).then(|| sum / count)
}
