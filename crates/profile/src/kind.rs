//! The kinds of models that a person can ask for.

use std::fmt;
use std::str::FromStr;

use crate::{Model, Order};

/// How a model was fitted; its name stands in profile files and on the command line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// 3x3 matrix by least squares.
    Linear,
    /// Plain polynomial of degree 2, 3 or 4 by least squares. Breaks when the exposure changes.
    Polynomial(u8),
    /// Root polynomial of order 2, 3 or 4 by plain least squares, as the papers have it.
    Root(Order),
    /// Root polynomial in the neutral-anchored basis, regularised.
    Anchored,
    /// A white-preserving matrix for each hue.
    HuePlane,
    /// The mean of an anchored and a hue-plane model.
    Half,
    /// Root polynomial fitted to the virtual training set of the spectral prior.
    Spectral,
    /// Hue-plane model and a residual over chromaticity, fitted to the virtual training set.
    Chromatic,
}

impl Kind {
    /// Every kind, the simplest first.
    pub const ALL: [Self; 12] = [
        Self::Linear,
        Self::Polynomial(2),
        Self::Polynomial(3),
        Self::Polynomial(4),
        Self::Root(Order::Two),
        Self::Root(Order::Three),
        Self::Root(Order::Four),
        Self::Anchored,
        Self::HuePlane,
        Self::Half,
        Self::Spectral,
        Self::Chromatic,
    ];

    /// Plain least squares of an order: linear or root-n.
    pub fn plain(order: Order) -> Self {
        if order == Order::One { Self::Linear } else { Self::Root(order) }
    }

    /// Whether its fit needs the reflectances of the colours.
    pub fn needs_spectra(self) -> bool {
        matches!(self, Self::Spectral | Self::Chromatic)
    }

    /// Whether its models keep colours when the exposure changes, so that they are good for pictures.
    pub fn keeps_exposure(self) -> bool {
        !matches!(self, Self::Polynomial(_))
    }

    /// Whether a model has the parts of this kind and no others.
    pub fn fits(self, model: &Model) -> bool {
        let parts = [
            model.root.is_some(),
            model.hue_plane.is_some(),
            model.residual.is_some(),
            model.polynomial.is_some(),
        ];
        match self {
            Self::Linear => parts == [true, false, false, false] && model.order() == Order::One,
            Self::Root(order) => parts == [true, false, false, false] && model.order() == order,
            Self::Anchored | Self::Spectral => parts == [true, false, false, false],
            Self::HuePlane => parts == [false, true, false, false],
            Self::Half => parts == [true, true, false, false],
            Self::Chromatic => parts == [false, true, true, false],
            Self::Polynomial(degree) => {
                parts == [false, false, false, true]
                    && model.polynomial.as_ref().is_some_and(|p| p.degree() == degree)
            }
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Linear => f.write_str("linear"),
            Self::Polynomial(degree) => write!(f, "polynomial-{degree}"),
            Self::Root(order) => write!(f, "root-{}", order.number()),
            Self::Anchored => f.write_str("anchored"),
            Self::HuePlane => f.write_str("hue-plane"),
            Self::Half => f.write_str("half"),
            Self::Spectral => f.write_str("spectral"),
            Self::Chromatic => f.write_str("chromatic"),
        }
    }
}

/// A name that is none of a model's.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "`{0}` is no model; there are linear, polynomial-2, polynomial-3, polynomial-4, root-2, root-3, root-4, \
         anchored, hue-plane, half, spectral and chromatic"
)]
pub struct UnknownKind(String);

impl FromStr for Kind {
    type Err = UnknownKind;

    fn from_str(name: &str) -> Result<Self, UnknownKind> {
        Self::ALL.into_iter().find(|k| k.to_string() == name).ok_or_else(|| UnknownKind(name.to_owned()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_is_known_by_its_name() {
        for kind in Kind::ALL {
            assert_eq!(kind.to_string().parse(), Ok(kind));
        }
        assert!("root-5".parse::<Kind>().unwrap_err().to_string().contains("anchored"));
    }
}
