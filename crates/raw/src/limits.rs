//! How much a file may ask for.

/// Bounds on what decoding one file may allocate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Limits {
    /// Largest number of samples (width x height x samples a pixel). A sample takes two bytes, four in
    /// floating-point files.
    pub max_samples: u64,
    /// Largest width or height in pixels.
    pub max_side: u32,
}

impl Default for Limits {
    /// 500 million samples: a 150 megapixel linear DNG, about 1 GB.
    fn default() -> Self {
        Self { max_samples: 500_000_000, max_side: 65_535 }
    }
}
