//! A camera that is known by its spectral sensitivities: measured ones, or those that its published colour matrix and
//! what is known of other cameras make most probable. Through them the model for any light is computed, without a chart.

pub mod estimate;
pub mod known;
pub mod light;
pub mod offsets;
pub mod peers;
pub mod posterior;
pub mod refined;
pub mod regression;

pub use estimate::Estimate;
pub use known::{Judged, KnownCamera};
pub use offsets::{Difference, Family, Observation, Shares, computed, families};
pub use peers::Peers;
pub use posterior::Posterior;
pub use refined::ChartSeen;
pub use regression::Regression;
