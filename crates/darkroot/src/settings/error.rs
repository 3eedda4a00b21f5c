//! Settings that do not go together.

/// Settings that contradict each other. Each message says what to do.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SettingsError {
    /// The format cannot hold that many bits.
    #[error("{format} cannot hold {bits} bits a sample, only {allowed}")]
    Bits {
        /// The format.
        format: &'static str,
        /// What was asked.
        bits: u8,
        /// What it can hold.
        allowed: String,
    },
    /// The format cannot hold the space.
    #[error(transparent)]
    Space(#[from] darkroot_encode::Error),
    /// Linear light in 8 bits.
    #[error("{format} cannot hold linear light: 8 bits are too coarse for it; write a .tif or .exr file")]
    LinearInEightBits {
        /// The format.
        format: &'static str,
    },
    /// A curve on top of the linear look.
    #[error(
        "the linear look keeps numbers proportional to light, but {space} bends them; use {space}-linear"
    )]
    CurveOnLinear {
        /// The space.
        space: String,
    },
    /// Changes of a look on top of the linear one.
    #[error("numbers proportional to light leave no room for {}: choose another look for that", settings.join(", "))]
    TonesOnLinear {
        /// Names of the settings that ask for it.
        settings: Vec<&'static str>,
    },
    /// Changes of a look on top of colours as measured.
    #[error("a reproduction shows what was measured and leaves no room for {}: choose another look for that", settings.join(", "))]
    TonesOnReproduction {
        /// Names of the settings that ask for it.
        settings: Vec<&'static str>,
    },
    /// A curve where the camera's own is asked for.
    #[error("the look of the camera has a curve of its own: leave out curve, or choose another look")]
    CurveOnCamera,
    /// Something of a chart without its shot.
    #[error(
        "{setting} asks for what a chart shows, and no shot of one is named; name it with exposure-from-chart"
    )]
    NoChartShot {
        /// Name of the setting that asks for it.
        setting: &'static str,
    },
    /// An exposure from a chart where it cannot hold.
    #[error("exposure-from-chart does not go with {setting} as it is set; leave one of them out")]
    ChartWith {
        /// Name of the other setting.
        setting: &'static str,
    },
    /// Camera RGB in an integer format.
    #[error("camera RGB is for measurement: write a 32-bit .tif or an .exr file")]
    CameraNeedsFloat,
    /// The embedded JPEG, where light of the scene is asked for.
    #[error("the embedded JPEG is the camera's own rendering, and no scene light as {} asks for", settings.join(", "))]
    Preview {
        /// Names of the settings that ask for it.
        settings: Vec<&'static str>,
    },
    /// Light above white where it cannot be.
    #[error("light above white {why}: leave out hdr")]
    Hdr {
        /// Why not.
        why: &'static str,
    },
    /// Options that the second engine does not have.
    #[error("imagepipe has its own fixed rendering in sRGB and does not heed {}", settings.join(", "))]
    Engine {
        /// Names of the settings that it does not heed.
        settings: Vec<&'static str>,
    },
}
