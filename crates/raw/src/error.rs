//! What can be wrong with a file.

use darkroot_photo::Size;

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
        "holds no raw samples ({message}); it may be a preview or a converted copy: use the camera's original"
    )]
    NoRawData {
        /// What the decoder says.
        message: String,
    },
    /// Truncated, contradictory or damaged.
    #[error("is damaged: {0}; copy it again from the card or the backup")]
    Damaged(#[from] Damage),
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
    #[error("comes from {camera}, which {decoder} does not know ({reason}); convert it to DNG first")]
    Camera {
        /// Make and model.
        camera: String,
        /// What it does not know about it.
        reason: Unknown,
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
    #[error("is too large ({0}); raise the limit if you trust this file")]
    TooLarge(TooLarge),
    /// The decoder panicked; the file is most likely damaged.
    #[error("made {decoder} fail; the file is most likely damaged: copy it again, or try the other decoder")]
    DecoderFailed {
        /// The decoder that failed.
        decoder: &'static str,
    },
    /// What a decoder in another process says of the file ([`crate::elsewhere`]), or how that process ended.
    #[error("{words}")]
    Elsewhere {
        /// The sentence.
        words: String,
    },
}

/// What is damaged in a file.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Damage {
    /// Directories inside directories, deeper than in any real file.
    #[error("its directories are nested too deep")]
    DeepDirectories,
    /// A directory that was met before.
    #[error("its directories point back at each other")]
    CircularDirectories,
    /// More directories than in any real file.
    #[error("it has too many directories")]
    ManyDirectories,
    /// More entries than in any real directory.
    #[error("one of its directories claims thousands of entries")]
    ManyEntries,
    /// Strips or tiles that share bytes.
    #[error("its strips or tiles overlap")]
    OverlappingPieces,
    /// A strip or tile (JPEG, JPEG XL) that is much larger than its place in the picture.
    #[error("one of its strips or tiles claims more samples than its place in the picture has")]
    LargeFrame,
    /// More samples than its bytes can hold.
    #[error("its {bytes} bytes cannot hold the {samples} samples that it claims")]
    FewBytes {
        /// Bytes of the file.
        bytes: u64,
        /// Samples that its headers claim.
        samples: u64,
    },
    /// An opcode list that takes longer than that of any real file.
    #[error("its {list} asks for more work than that of any camera")]
    ManyOperations {
        /// Name of the list.
        list: &'static str,
    },
    /// A black level that is infinite or not a number.
    #[error("its black level is not a number")]
    BlackLevel,
    /// What the decoder says.
    #[error("{message}")]
    Decoder {
        /// Its sentence.
        message: String,
    },
}

/// What a decoder does not know about a camera.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Unknown {
    /// The camera itself.
    #[error("not in its list")]
    Camera,
    /// Pixels of neither one sample nor three.
    #[error("{samples} samples a pixel in the layout {layout}")]
    Samples {
        /// Samples of a pixel.
        samples: u32,
        /// Name of the layout.
        layout: String,
    },
    /// The decoder sees another frame than the headers describe.
    #[error(
        "it sees {} x {} pixels of {seen_samples} samples where the file has {} x {} of {samples}",
        seen.width, seen.height, size.width, size.height
    )]
    Frame {
        /// Size that the decoder sees.
        seen: Size,
        /// Samples of a pixel that it sees.
        seen_samples: usize,
        /// Size by the headers.
        size: Size,
        /// Samples of a pixel by the headers.
        samples: usize,
    },
    /// What the decoder says.
    #[error("{message}")]
    Decoder {
        /// Its sentence.
        message: String,
    },
}

/// What is larger than the limits allow.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TooLarge {
    /// The frame.
    #[error("{} x {} pixels", .0.width, .0.height)]
    Frame(Size),
    /// A strip or tile.
    #[error("a strip or tile of {0} samples")]
    Samples(u64),
    /// What the decoder says.
    #[error("{message}")]
    Decoder {
        /// Its sentence.
        message: String,
    },
}
