//! What can be wrong with a file.

/// Why a file could not be decoded. Each message completes "FILE: " and says what to do.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The file is something else.
    #[error("is not a raw photograph: {found}; give a raw file such as NEF, DNG, CR2, ARW or RAF")]
    NotRaw {
        /// What it is instead, in words.
        found: &'static str,
    },
    /// A raw container without raw samples in it.
    #[error(
        "holds no raw samples ({detail}); it may be a preview or a converted copy: use the camera's original"
    )]
    NoRawData {
        /// What the decoder says.
        detail: String,
    },
    /// Truncated, contradictory or damaged.
    #[error("is damaged: {detail}; copy it again from the card or the backup")]
    Damaged {
        /// What is wrong and where.
        detail: String,
    },
    /// A compression that no decoder here reads.
    #[error(
        "is compressed with {compression}, which {decoder} cannot decode; convert it to DNG with the maker's or \
         Adobe's converter, or take the embedded preview"
    )]
    Compression {
        /// The compression in words.
        compression: String,
        /// The decoder that was asked.
        decoder: &'static str,
    },
    /// A camera or mode that the decoder does not know.
    #[error("comes from {camera}, which {decoder} does not know ({detail}); convert it to DNG first")]
    Camera {
        /// Make and model.
        camera: String,
        /// What the decoder says.
        detail: String,
        /// The decoder that was asked.
        decoder: &'static str,
    },
    /// The second decoder is known to give wrong samples for this kind of file.
    #[error("would be decoded wrongly by rawloader ({reason}); take the other decoder")]
    WrongDecoder {
        /// Why.
        reason: &'static str,
    },
    /// Larger than the limits allow.
    #[error("is too large ({detail}); raise the limit if you trust this file")]
    TooLarge {
        /// Size and limit.
        detail: String,
    },
    /// The decoder panicked; the file is most likely damaged.
    #[error("made {decoder} fail; the file is most likely damaged: copy it again, or try the other decoder")]
    DecoderFailed {
        /// The decoder that failed.
        decoder: &'static str,
    },
}
