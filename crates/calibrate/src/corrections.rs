//! Corrections of a shot by its own patches: glare, light that is stronger on one side, light whose colour changes.
//!
//! A chart has patches of known colour all over it, so the patches themselves show how the light departs from even. A model
//! of the light is fitted to them (per channel: a veil that is added to every patch, and a plane in logarithms that
//! multiplies it) and then taken out.
//!
//! Patches that were corrected by themselves look better than they are. So everything is done again in rounds, each
//! without a group of patches ([`CrossValidation`]), and models are compared on the patches of the group.

use darkroot_chart::{ChannelLight, Slope};
use darkroot_colour::difference::de2000;
use darkroot_colour::{Xyz, white};
use darkroot_profile::Order;
use darkroot_profile::fit::{Samples, plain};

/// Most groups of patches that are left out of the corrections in turn; a chart with fewer patches leaves out one each.
const MOST_ROUNDS: usize = 24;
/// A slope for each channel is believed when it brings the linear model's error on patches that no part of it has seen
/// below this share of the error with one slope for all channels...
const CERTAIN: f64 = 0.90;
/// ... and when it changes the light's colour by more than this. What no matrix fits looks like a slope, too: of 56
/// simulated shots (14 cameras, 4 lights, 24 patches) without a change of colour none passes both, with a change of 4 %
/// half do, with one of 8 % 93 in 100.
const LEAST_CHANGE: f64 = 0.03;

/// The patches of a shot.
#[derive(Clone, Copy)]
pub(crate) struct Patches<'a> {
    pub rgb: &'a [[f64; 3]],
    /// What they are, relative to D50.
    pub expected: &'a [Xyz],
    /// Where they are, -1 to 1.
    pub places: &'a [[f64; 2]],
    /// Which of them may tell of the light.
    pub used: &'a [bool],
}

/// Whether something is taken out of a shot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Correct {
    /// It stays.
    #[default]
    Never,
    /// It is, where patches that had no part in finding it are nearer to what they should be without it.
    WhereItHelps,
    /// It is.
    Always,
}

impl Correct {
    fn choices(self) -> &'static [bool] {
        match self {
            Self::Never => &[false],
            Self::WhereItHelps => &[false, true],
            Self::Always => &[true],
        }
    }
}

/// What is to be taken out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct TakeOut {
    pub glare: bool,
    pub slope: SlopeModel,
}

/// Which slope of light is taken out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum SlopeModel {
    None,
    /// One for all channels.
    Common,
    /// One for each channel.
    PerChannel,
}

/// One round of cross-validation: all patches, corrected by what the others than a group of them show.
#[derive(Debug, Clone, PartialEq)]
pub struct CrossValidation {
    /// The group: patches that had no part in the corrections.
    pub left_out: Vec<usize>,
    /// Camera RGB of all patches.
    pub rgb: Vec<[f64; 3]>,
}

/// Corrections of patches: each channel less a veil, over a slope.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Corrections {
    veil: [f64; 3],
    pub slopes: [Slope; 3],
}

impl TakeOut {
    /// What helps of what may be taken out; `slope` is the one in question.
    pub(crate) fn what_helps(
        patches: Patches<'_>,
        glare: Correct,
        even_out: Correct,
        slope: SlopeModel,
    ) -> Self {
        let one = |glare: bool, even_out: bool| Self {
            glare,
            slope: if even_out { slope } else { SlopeModel::None },
        };
        let mut choices = Vec::new();
        for even_out in even_out.choices() {
            choices.extend(glare.choices().iter().map(|glare| one(*glare, *even_out)));
        }
        // The plainest first: what follows must be better.
        let mut best = choices[0];
        if choices.len() == 1 {
            return best;
        }
        let mut least = left_out_error(patches, &rounds(patches, best)).unwrap_or(f64::INFINITY);
        for choice in choices.into_iter().skip(1) {
            let error = left_out_error(patches, &rounds(patches, choice)).unwrap_or(f64::INFINITY);
            if error < least {
                (best, least) = (choice, error);
            }
        }
        best
    }

    fn is_nothing(self) -> bool {
        !self.glare && self.slope == SlopeModel::None
    }
}

impl Corrections {
    pub(crate) fn of(patches: Patches<'_>, take_out: TakeOut) -> Self {
        let veils = |lights: [Option<ChannelLight>; 3]| lights.map(|l| l.map_or(0.0, |l| l.veil));
        match take_out.slope {
            SlopeModel::None => {
                let veil = if take_out.glare { veils(lights(patches, false)) } else { [0.0; 3] };
                Self { veil, slopes: [Slope::default(); 3] }
            }
            SlopeModel::PerChannel => {
                // Where the patches are too few for that, one slope is all that they tell.
                let [Some(r), Some(g), Some(b)] = lights(patches, true) else {
                    return Self::of(patches, TakeOut { slope: SlopeModel::Common, ..take_out });
                };
                let veil = if take_out.glare { [r.veil, g.veil, b.veil] } else { [0.0; 3] };
                Self { veil, slopes: [r.slope, g.slope, b.slope] }
            }
            SlopeModel::Common => {
                let sloped = Self { veil: [0.0; 3], slopes: [common_slope(patches, [0.0; 3]); 3] };
                if !take_out.glare {
                    return sloped;
                }
                // Glare is what is left when the slope is out, and bends the slope that is found without it.
                let even = sloped.applied(patches);
                let veil = veils(lights(Patches { rgb: &even, ..patches }, false));
                Self { veil, slopes: [common_slope(patches, veil); 3] }
            }
        }
    }

    pub(crate) fn applied(&self, patches: Patches<'_>) -> Vec<[f64; 3]> {
        let one = |(rgb, place): (&[f64; 3], &[f64; 2])| {
            [0, 1, 2].map(|c| (rgb[c] - self.veil[c]) / self.slopes[c].at(*place))
        };
        patches.rgb.iter().zip(patches.places).map(one).collect()
    }
}

/// The slope of the patches' luminance.
fn common_slope(patches: Patches<'_>, veil: [f64; 3]) -> Slope {
    let kept: Vec<usize> = (0..patches.rgb.len()).filter(|i| patches.used[*i]).collect();
    let rgb: Vec<[f64; 3]> = kept.iter().map(|i| [0, 1, 2].map(|c| patches.rgb[*i][c] - veil[c])).collect();
    let expected: Vec<Xyz> = kept.iter().map(|i| patches.expected[*i]).collect();
    let places: Vec<[f64; 2]> = kept.iter().map(|i| patches.places[*i]).collect();
    let targets: Vec<f64> = expected.iter().map(|c| c.y).collect();
    Slope::of(&places, &luminances(&rgb, &expected), &targets).unwrap_or_default()
}

/// Glare of red, green and blue as shares of white; 0 where the patches cannot tell.
pub(crate) fn glare(patches: Patches<'_>) -> [f64; 3] {
    lights(patches, false).map(|l| l.map_or(0.0, |l| l.glare()))
}

fn lights(patches: Patches<'_>, sloped: bool) -> [Option<ChannelLight>; 3] {
    [0, 1, 2].map(|c| {
        let channel: Vec<f64> = patches.rgb.iter().map(|rgb| rgb[c]).collect();
        ChannelLight::of(patches.places, &channel, patches.expected, patches.used, sloped)
    })
}

/// The rounds that a fit has to be judged by; none where nothing is taken out.
pub(crate) fn rounds_of_a_fit(patches: Patches<'_>, take_out: TakeOut) -> Vec<CrossValidation> {
    if take_out.is_nothing() { Vec::new() } else { rounds(patches, take_out) }
}

/// Every patch as corrected by what others tell.
fn rounds(patches: Patches<'_>, take_out: TakeOut) -> Vec<CrossValidation> {
    let count = patches.rgb.len();
    let groups = count.min(MOST_ROUNDS);
    let round = |group: usize| {
        let others: Vec<bool> = (0..count).map(|i| patches.used[i] && i % groups != group).collect();
        let rgb = Corrections::of(Patches { used: &others, ..patches }, take_out).applied(patches);
        CrossValidation { left_out: (group..count).step_by(groups).collect(), rgb }
    };
    (0..groups).map(round).collect()
}

/// How the colour of the light changes over the chart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ColourChange {
    /// Largest change of red or blue against green, relative.
    pub range: f64,
    /// Error of the linear model (mean dE2000 on patches left out of everything) with a slope for each channel, over
    /// that with one slope.
    pub gain: f64,
}

impl ColourChange {
    pub(crate) fn of(patches: Patches<'_>) -> Self {
        let error =
            |slope: SlopeModel| left_out_error(patches, &rounds(patches, TakeOut { glare: true, slope }));
        let each = Corrections::of(patches, TakeOut { glare: true, slope: SlopeModel::PerChannel }).slopes;
        let against_green = |c: usize| {
            let (a, b) = (each[c].across - each[1].across, each[c].down - each[1].down);
            Slope { across: a, down: b }.range()
        };
        let gain = match (error(SlopeModel::PerChannel), error(SlopeModel::Common)) {
            (Some(each), Some(one)) if one > 0.0 => each / one,
            _ => 1.0,
        };
        Self { range: against_green(0).max(against_green(2)), gain }
    }

    /// Whether patches that had no part in finding it bear it out.
    pub fn is_certain(&self) -> bool {
        self.gain < CERTAIN && self.range > LEAST_CHANGE
    }
}

/// Mean dE2000 of the linear model on patches that took part neither in it nor in the corrections.
fn left_out_error(patches: Patches<'_>, rounds: &[CrossValidation]) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0.0);
    for round in rounds {
        let kept: Vec<usize> =
            (0..patches.rgb.len()).filter(|i| patches.used[*i] && !round.left_out.contains(i)).collect();
        let rgb = kept.iter().map(|i| round.rgb[*i]).collect();
        let xyz = kept.iter().map(|i| patches.expected[*i]).collect();
        let model = plain::root(&Samples::new(rgb, xyz, white::D50).ok()?, Order::One).ok()?.model;
        for i in round.left_out.iter().filter(|i| patches.used[**i]) {
            sum += de2000(model.xyz(round.rgb[*i]).lab(white::D50), patches.expected[*i].lab(white::D50));
            count += 1.0;
        }
    }
    (count > 0.0).then(|| sum / count)
}

/// Luminance of camera colours, by the combination of channels that fits the expected luminances best; green alone
/// where that cannot be told.
pub(crate) fn luminances(rgb: &[[f64; 3]], expected: &[Xyz]) -> Vec<f64> {
    let fitted = Samples::new(rgb.to_vec(), expected.to_vec(), white::D50)
        .and_then(|samples| plain::root(&samples, Order::One));
    match fitted {
        Ok(fit) => rgb.iter().map(|rgb| fit.model.xyz(*rgb).y).collect(),
        Err(_) => rgb.iter().map(|rgb| rgb[1]).collect(),
    }
}
