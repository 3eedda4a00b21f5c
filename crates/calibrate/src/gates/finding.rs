//! What a check finds: the numbers, and the same in words.

use darkroot_chart::EdgeWidth;

/// What was checked and what was found.
#[derive(Debug, Clone, PartialEq)]
pub enum Finding {
    /// How bright the white patch is.
    Exposure {
        /// Its brightest channel as a share of saturation.
        share: f64,
        /// Whether more than one in a hundred of its samples is clipped.
        clipped: bool,
    },
    /// How many patches are clipped.
    Clipping {
        /// Clipped patches.
        clipped: usize,
        /// All patches.
        all: usize,
    },
    /// Whether the light is equally strong all over the chart.
    Evenness {
        /// Largest relative difference.
        range: f64,
    },
    /// Stray light of red, green and blue as shares of white. Negative where the file's black level is too high.
    Glare([f64; 3]),
    /// Whether the light has one colour all over the chart.
    ColourOfLight {
        /// Largest change of red or blue against green, relative.
        range: f64,
        /// Error on unseen patches once the change is taken out, over the error without.
        gain: f64,
        /// Whether the unseen patches bear the change out.
        certain: bool,
    },
    /// Whether the light is the one that was named.
    Light {
        /// Temperature of the shot's white by the camera's own matrix, K.
        found: f64,
        /// Temperature of the named light, K.
        named: f64,
        /// Its name.
        name: String,
    },
    /// Relative standard error of the darkest patch.
    Noise(f64),
    /// Side of the smallest patch in pixels.
    Size(f64),
    /// The longest edge of the chart over the edge opposite to it.
    Angle(f64),
    /// Width of the patches' edges; `None` where they are too faint or too noisy to tell.
    Sharpness(Option<EdgeWidth>),
    /// Whether shots of several exposures are one picture scaled.
    Linearity(Departure),
    /// Whether shots at one exposure show the same.
    Agreement(Departure),
}

/// How far the shots of one light are from showing the same.
#[derive(Debug, Clone, PartialEq)]
pub struct Departure {
    /// Largest departure of a patch, relative, after its noise.
    pub relative: f64,
    /// Name of the shot that departs most.
    pub worst: String,
}

/// Temperatures to the nearest hundred kelvin, as a person would name them.
pub fn near(kelvin: f64) -> f64 {
    (kelvin / 100.0).round() * 100.0
}

/// Shares of red, green and blue in percent, in words.
pub fn by_channel([r, g, b]: [f64; 3]) -> String {
    format!("{:.2} (red), {:.2} (green), {:.2} (blue)", 100.0 * r, 100.0 * g, 100.0 * b)
}

impl Finding {
    /// Name of the check.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Exposure { .. } => "exposure",
            Self::Clipping { .. } => "clipping",
            Self::Evenness { .. } => "evenness",
            Self::Glare(_) => "glare",
            Self::ColourOfLight { .. } => "colour of light",
            Self::Light { .. } => "light",
            Self::Noise(_) => "noise",
            Self::Size(_) => "size",
            Self::Angle(_) => "angle",
            Self::Sharpness(_) => "sharpness",
            Self::Linearity(_) => "linearity",
            Self::Agreement(_) => "agreement",
        }
    }

    /// The figure that is graded; NaN where it cannot be measured.
    pub fn value(&self) -> f64 {
        match self {
            Self::Exposure { share, .. } => *share,
            Self::Clipping { clipped, all } => *clipped as f64 / (*all).max(1) as f64,
            Self::Evenness { range } | Self::ColourOfLight { range, .. } => *range,
            Self::Glare(shares) => shares.iter().map(|v| v.abs()).fold(0.0, f64::max),
            Self::Light { found, named, .. } => (1e6 / found - 1e6 / named).abs(),
            Self::Noise(value) | Self::Size(value) | Self::Angle(value) => *value,
            Self::Sharpness(edges) => edges.map_or(f64::NAN, |e| e.patch),
            Self::Linearity(departure) | Self::Agreement(departure) => departure.relative,
        }
    }

    /// What was found, in words.
    pub fn words(&self) -> String {
        let percent = 100.0 * self.value();
        match self {
            Self::Exposure { .. } => format!("the white patch is at {percent:.0} % of saturation"),
            Self::Clipping { clipped, all } => format!("{clipped} of {all} patches are clipped"),
            Self::Evenness { .. } => format!("the light changes by {percent:.1} % over the chart"),
            Self::Glare(shares) => format!("stray light is {} % of white", by_channel(*shares)),
            Self::ColourOfLight { certain: true, .. } => {
                format!("the light's colour changes by {percent:.1} % over the chart")
            }
            Self::ColourOfLight { gain, .. } => format!(
                "no change of the light's colour over the chart is certain (taking {percent:.1} % out makes patches left \
                 out {gain:.2} times as wrong)"
            ),
            Self::Light { found, named, name } => format!(
                "the white of the shot is that of {:.0} K by the camera's own matrix, {:.0} mired from {name} ({named:.0} \
                 K)",
                near(*found),
                self.value()
            ),
            Self::Noise(_) => format!("the darkest patch is known to {percent:.2} %"),
            Self::Size(side) => format!("patches are {side:.0} pixels wide"),
            Self::Angle(ratio) => {
                format!("opposite edges of the chart differ by {:.0} %", 100.0 * (ratio - 1.0))
            }
            Self::Sharpness(Some(EdgeWidth { pixels, .. })) => {
                format!("the patches' edges are {pixels:.1} pixels wide, {percent:.0} % of a patch")
            }
            Self::Sharpness(None) => {
                "the patches' edges are too faint or too noisy to tell how sharp the shot is".to_owned()
            }
            Self::Linearity(_) => {
                format!("between the exposures the sensor is linear to {percent:.2} %")
            }
            Self::Agreement(_) => format!("the shots that are averaged agree to {percent:.2} %"),
        }
    }

    /// What to do about it, where it is not as it should be.
    pub fn advice(&self) -> String {
        const FOCUS: &str =
            "focus on the chart, close the aperture by two stops, hold the camera still, or come nearer";
        let advice = match self {
            Self::Exposure { share, clipped } => return exposure_advice(*share, *clipped),
            Self::Clipping { .. } => "take it with less light",
            Self::Evenness { .. } => "light it from both sides or from farther away",
            Self::Glare(_) if self.is_black_too_high() => {
                "the file's black level is too high: subtract a shot with the lens closed"
            }
            Self::Glare(_) => "shade the lens, or remove bright surfaces around",
            Self::ColourOfLight { .. } => "light the chart by one kind of lamp",
            Self::Light { .. } => "name the light that the chart stood in, best with a reference of spectra",
            Self::Noise(_) => "use a lower ISO, more light, or several shots",
            Self::Size(_) => "come nearer, or use a longer lens",
            Self::Angle(_) => "hold the camera straight before the chart",
            Self::Sharpness(Some(_)) => FOCUS,
            Self::Sharpness(None) => return format!("see whether the grid is right; {FOCUS}"),
            Self::Linearity(Departure { worst, .. }) => {
                return format!(
                    "bracket by exposure time only, in steady light; or leave out {worst}, which departs most"
                );
            }
            Self::Agreement(Departure { worst, .. }) => {
                return format!(
                    "take them from one place in steady light; or leave out {worst}, which departs most"
                );
            }
        };
        advice.to_owned()
    }

    /// Whether "glare" is negative: not stray light, but a black level that is too high.
    pub fn is_black_too_high(&self) -> bool {
        let Self::Glare(shares) = self else { return false };
        shares.iter().copied().fold(0.0, f64::min) < -super::GLARE.0 / 2.0
    }
}

fn exposure_advice(share: f64, clipped: bool) -> String {
    let stops = (0.7 / share.max(1e-6)).log2();
    let amount = match stops.abs() {
        s if s < 0.75 => "half a stop".to_owned(),
        s => format!("{s:.0} stop{}", if s >= 1.5 { "s" } else { "" }),
    };
    if clipped {
        "take it with about one stop less light".to_owned()
    } else if share < super::TOO_DARK {
        format!("take it with {amount} more light")
    } else if share < super::EXPOSURE.0 {
        format!("{amount} more light would be better")
    } else if share > super::EXPOSURE.1 {
        "half a stop less light would be better".to_owned()
    } else {
        String::new()
    }
}
