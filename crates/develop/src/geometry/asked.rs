//! What a person asks of the picture's frame.

use darkroot_lens::Corrections;

use super::Perspective;

/// Which part of the frame is developed, in the upright picture. What lies outside of a picture that was straightened is
/// never shown.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Crop {
    /// What the maker shows, or the part of it that was chosen in the camera.
    #[default]
    Default,
    /// Everything that light falls on.
    Active,
    /// The largest middle part of what the maker shows with sides of this ratio: the long one to the short one. The picture
    /// stays upright or level.
    Aspect(f64),
    /// This share of the width and the height of what the maker shows, in the middle; more than 0, at most 1.
    Share(f64),
    /// A rectangle of what the maker shows, in pixels.
    Rect {
        /// First column.
        x: usize,
        /// First row.
        y: usize,
        /// Number of columns.
        width: usize,
        /// Number of rows.
        height: usize,
    },
}

/// How the picture lies in the frame, and how large it gets.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Geometry {
    /// Clockwise quarter turns of the picture that the camera says is upright.
    pub turn: Turn,
    /// Mirroring, after turning.
    pub flip: Flip,
    /// Degrees by which the picture is then turned clockwise, -45..=45.
    pub straighten: f64,
    /// Whether the lean of the picture is to be found, and undone by `straighten`. Whoever has the photograph looks for it
    /// ([`tilt`](crate::tilt)) and sets that.
    pub auto_straighten: bool,
    /// What of the upright picture, before it is straightened, shall be upright, level or a rectangle.
    pub perspective: Option<Perspective>,
    /// What is done about the lens.
    pub lens: Lens,
    /// What a database knows of the lens, for [`Lens::Lensfun`] and [`Lens::Maker`]. Whoever knows the photograph's metadata sets it.
    pub known: Option<Corrections>,
    /// Whether the lens's loss of light towards the edges is left, where `known` or the maker's note has it.
    pub keep_vignetting: bool,
    /// Whether red and blue stay where the lens put them.
    pub keep_fringes: bool,
    /// Size of the picture.
    pub resize: Resize,
    /// Whether `resize` may make it larger than it is.
    pub enlarge: bool,
}

/// Clockwise quarter turns.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Turn {
    /// None.
    #[default]
    None,
    /// A quarter turn.
    Right,
    /// Half a turn.
    Half,
    /// Three quarters, or one anticlockwise.
    Left,
}

/// Mirroring.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Flip {
    /// None.
    #[default]
    None,
    /// Left becomes right.
    Horizontal,
    /// Top becomes bottom.
    Vertical,
}

/// Which correction of the lens is applied.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Lens {
    /// What the file carries; in the linear look and in camera RGB none.
    #[default]
    Auto,
    /// What the file carries.
    File,
    /// What the file carries, else what the lensfun database knows.
    Lensfun,
    /// What the file carries, else what the maker's note says, which could not be checked, else what the lensfun database knows.
    Maker,
    /// None.
    Off,
}

/// Size of the picture; ratios of sides stay.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Resize {
    /// As the sensor gives it.
    #[default]
    None,
    /// Pixels of the long side.
    Long(usize),
    /// Pixels of the short side.
    Short(usize),
    /// As large as fits into so many columns and rows.
    Fit {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// So many times as long and as wide; it may make a picture larger.
    Share(f64),
    /// Millions of pixels.
    Megapixels(f64),
}
