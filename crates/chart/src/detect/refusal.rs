//! Why what looks like a chart is none.

/// Why what came nearest to a chart was refused. Charts have their titles here.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Refusal {
    /// Nothing like patches in rows and columns.
    #[error("no flat patches lie in rows and columns as on a chart")]
    NoLattice,
    /// Flat regions in rows and columns that are like no chart.
    #[error(
        "{patches} flat patches lie in rows and columns, but their colours are not those of a known chart that is wholly \
         in the picture"
    )]
    UnknownColours {
        /// How many there are.
        patches: usize,
    },
    /// A mirror image.
    #[error("a {chart} would have to be mirrored to look like this")]
    Mirrored {
        /// The chart that it would be.
        chart: String,
    },
    /// Nothing where the patches' edges should be.
    #[error("patches like those of a {chart} have no edges that agree with its grid")]
    NoEdges {
        /// The chart that it would be.
        chart: String,
    },
    /// A chart that is cut off.
    #[error("a {chart} would reach beyond the picture")]
    BeyondPicture {
        /// The chart that it would be.
        chart: String,
    },
    /// Edges that are elsewhere.
    #[error("of the patches' edges of a {chart} only {:.0} % are in their places", 100.0 * seen)]
    Edges {
        /// The chart that it would be.
        chart: String,
        /// Share of the edges that are in their places.
        seen: f64,
    },
    /// Other colours.
    #[error(
        "its colours are not those of a {chart}: {:.0} % of lightness and {:.0} % of colour do not fit any light and camera",
        100.0 * lightness, 100.0 * colour
    )]
    Colours {
        /// The chart that it would be.
        chart: String,
        /// Share of the variance of lightness that is not explained.
        lightness: f64,
        /// Share of the variance of colour that is not explained.
        colour: f64,
    },
    /// Greys.
    #[error("it has too little colour for a {chart}")]
    Grey {
        /// The chart that it would be.
        chart: String,
    },
    /// Turned or shifted it would fit about as well.
    #[error("it could be a {chart} in more than one way")]
    Ambiguous {
        /// The chart that it would be.
        chart: String,
    },
}
