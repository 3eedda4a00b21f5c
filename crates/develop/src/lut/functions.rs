//! Steps that are formulas, as the Common LUT Format defines them (Academy S-2014-006, version 3).

use super::alike;

/// A straight line from one range to another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// Factor.
    pub scale: f32,
    /// What is added after it.
    pub offset: f32,
    /// Least value that comes out.
    pub least: f32,
    /// Greatest value that comes out.
    pub most: f32,
}

impl Range {
    #[inline]
    pub(super) fn at(self, v: f32) -> f32 {
        let out = v * self.scale + self.offset;
        // What is no number becomes the least.
        if out > self.least { out.min(self.most) } else { self.least }
    }
}

/// Which way a formula is taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// As it is named.
    Forward,
    /// Its inverse.
    Reverse,
}

/// What a power makes of values below 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outside {
    /// 0.
    Cut,
    /// What it makes of the value above 0, below it.
    Mirrored,
    /// The value itself.
    Kept,
}

/// A power, with or without a straight piece at its foot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Power {
    /// Exponent.
    pub exponent: f32,
    /// Offset of a curve with a straight piece (0.055 in sRGB); `None` for a plain power.
    pub offset: Option<f32>,
    /// Below 0.
    pub outside: Outside,
    /// Whether the power or its root is taken.
    pub direction: Direction,
}

impl Power {
    #[inline]
    pub(super) fn at(&self, v: f32) -> f32 {
        let curve = |v: f32| match self.offset {
            None if self.direction == Direction::Forward => v.powf(self.exponent),
            None => v.powf(1.0 / self.exponent),
            Some(offset) => self.with_foot(v, offset),
        };
        match self.outside {
            _ if v >= 0.0 => curve(v),
            Outside::Cut if self.offset.is_some() => curve(v),
            Outside::Cut => 0.0,
            Outside::Mirrored => -curve(-v),
            Outside::Kept => v,
        }
    }

    /// ((v + offset) / (1 + offset))^exponent, below its break the tangent through 0.
    fn with_foot(&self, v: f32, offset: f32) -> f32 {
        let g = self.exponent;
        let foot = offset / (g - 1.0);
        let slope = (g - 1.0) / offset * (offset * g / ((g - 1.0) * (1.0 + offset))).powf(g);
        match self.direction {
            Direction::Forward if v >= foot => ((v + offset) / (1.0 + offset)).powf(g),
            Direction::Forward => v * slope,
            Direction::Reverse if v >= foot * slope => (1.0 + offset) * v.powf(1.0 / g) - offset,
            Direction::Reverse => v / slope,
        }
    }
}

/// A logarithm, as cameras have it or plain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Log {
    /// Base.
    pub base: f32,
    /// Factor of linear values before the logarithm.
    pub lin_slope: f32,
    /// What is added to them.
    pub lin_offset: f32,
    /// Factor of the logarithm.
    pub log_slope: f32,
    /// What is added to it.
    pub log_offset: f32,
    /// Linear value below which the curve is straight, and the slope there; `None` where it is a logarithm all over.
    pub straight: Option<(f32, f32)>,
    /// From linear values to logarithms, or back.
    pub direction: Direction,
}

impl Log {
    /// A logarithm to a base, and nothing else.
    pub fn plain(base: f32, direction: Direction) -> Self {
        Self {
            base,
            lin_slope: 1.0,
            lin_offset: 0.0,
            log_slope: 1.0,
            log_offset: 0.0,
            straight: None,
            direction,
        }
    }

    /// A curve with a straight piece below `lin_break` that goes on with the slope of the logarithm there, or with `slope`.
    #[must_use]
    pub fn straight_below(self, lin_break: f32, slope: Option<f32>) -> Self {
        let inside = self.lin_slope * lin_break + self.lin_offset;
        let tangent = self.log_slope * self.lin_slope / (inside * self.base.ln());
        Self { straight: Some((lin_break, slope.unwrap_or(tangent))), ..self }
    }

    fn forward(&self, v: f32) -> f32 {
        let inside = (self.lin_slope * v + self.lin_offset).max(f32::MIN_POSITIVE);
        self.log_slope * inside.ln() / self.base.ln() + self.log_offset
    }

    fn backward(&self, v: f32) -> f32 {
        (self.base.powf((v - self.log_offset) / self.log_slope) - self.lin_offset) / self.lin_slope
    }

    #[inline]
    pub(super) fn at(&self, v: f32) -> f32 {
        match (self.straight, self.direction) {
            (Some((from, slope)), Direction::Forward) if v < from => self.forward(from) + slope * (v - from),
            (Some((from, slope)), Direction::Reverse) if v < self.forward(from) => {
                from + (v - self.forward(from)) / slope
            }
            (_, Direction::Forward) => self.forward(v),
            (_, Direction::Reverse) => self.backward(v),
        }
    }
}

/// Colour decision list of the American Society of Cinematographers (ASC CDL 1.2).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cdl {
    /// Factor of each channel, not below 0.
    pub slope: [f32; 3],
    /// What is added to each.
    pub offset: [f32; 3],
    /// Exponent of each, more than 0.
    pub power: [f32; 3],
    /// Factor of what lies apart from the luma of Rec. 709, not below 0.
    pub saturation: f32,
    /// Whether values are cut to 0..=1 between the parts.
    pub clamp: bool,
    /// Forward or back.
    pub direction: Direction,
}

impl Cdl {
    pub(super) fn is_one_curve(&self) -> bool {
        alike(self.slope) && alike(self.offset) && alike(self.power) && (self.saturation - 1.0).abs() <= 0.0
    }

    fn cut(&self, v: f32) -> f32 {
        if self.clamp { v.clamp(0.0, 1.0) } else { v }
    }

    /// A power that leaves what is below 0 as it is.
    fn power(v: f32, exponent: f32) -> f32 {
        if v < 0.0 { v } else { v.powf(exponent) }
    }

    fn saturated(v: [f32; 3], saturation: f32) -> [f32; 3] {
        let luma = 0.2126 * v[0] + 0.7152 * v[1] + 0.0722 * v[2];
        v.map(|v| luma + saturation * (v - luma))
    }

    pub(super) fn at(&self, v: [f32; 3]) -> [f32; 3] {
        match self.direction {
            Direction::Forward => {
                let graded = [0, 1, 2]
                    .map(|c| Self::power(self.cut(v[c] * self.slope[c] + self.offset[c]), self.power[c]));
                Self::saturated(graded, self.saturation).map(|v| self.cut(v))
            }
            Direction::Reverse => {
                let v = Self::saturated(v.map(|v| self.cut(v)), 1.0 / self.saturation).map(|v| self.cut(v));
                [0, 1, 2].map(|c| {
                    self.cut((Self::power(v[c], 1.0 / self.power[c]) - self.offset[c]) / self.slope[c])
                })
            }
        }
    }
}
