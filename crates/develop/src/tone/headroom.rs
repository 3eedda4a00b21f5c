//! Light above white, for screens that show it.
//!
//! A look's curve shows light in proportion, or nearly so, up to where it begins to hold highlights back; with headroom it goes on
//! in that proportion, and bends only where the room ends.

/// Where the curve bends, as a share of the brightest light that there is room for.
const BEND: f64 = 0.8;

/// A curve with headroom, asked for rising light.
#[derive(Debug, Clone, Copy)]
pub(super) struct Headroom {
    /// The brightest light there is room for; white is 1.
    peak: f64,
    /// Light from which on the curve may go on in proportion.
    grey: f64,
    /// The greatest share of scene light that the curve has shown from there on.
    share: f64,
}

impl Headroom {
    pub(super) fn of(stops: f32, grey: f64) -> Self {
        Self { peak: f64::from(stops).exp2(), grey, share: 0.0 }
    }

    /// What is shown of scene light of which the curve alone shows `shown`, as a share of the brightest light. Each call must be
    /// with more light than the one before.
    pub(super) fn at(&mut self, light: f64, shown: f32) -> f32 {
        let mut shown = f64::from(shown);
        if light >= self.grey {
            self.share = self.share.max(shown / light);
            shown = self.share * light;
        }
        let part = shown / self.peak;
        let bent = if part > BEND {
            BEND + (1.0 - BEND) * (1.0 - (-(part - BEND) / (1.0 - BEND)).exp())
        } else {
            part
        };
        bent as f32
    }
}
