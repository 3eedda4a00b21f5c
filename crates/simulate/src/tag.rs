//! Tag numbers of TIFF 6.0, TIFF/EP, Exif 2.32 and DNG 1.4.

pub(crate) use darkroot_photo::metadata::tag::{MAKE, MODEL, ORIENTATION};

pub(crate) const NEW_SUBFILE_TYPE: u16 = 254;
pub(crate) const IMAGE_WIDTH: u16 = 256;
pub(crate) const IMAGE_LENGTH: u16 = 257;
pub(crate) const BITS_PER_SAMPLE: u16 = 258;
pub(crate) const COMPRESSION: u16 = 259;
pub(crate) const PHOTOMETRIC: u16 = 262;
pub(crate) const STRIP_OFFSETS: u16 = 273;
pub(crate) const SAMPLES_PER_PIXEL: u16 = 277;
pub(crate) const ROWS_PER_STRIP: u16 = 278;
pub(crate) const STRIP_BYTE_COUNTS: u16 = 279;
pub(crate) const X_RESOLUTION: u16 = 282;
pub(crate) const Y_RESOLUTION: u16 = 283;
pub(crate) const PLANAR_CONFIGURATION: u16 = 284;
pub(crate) const RESOLUTION_UNIT: u16 = 296;
pub(crate) const TILE_WIDTH: u16 = 322;
pub(crate) const TILE_LENGTH: u16 = 323;
pub(crate) const TILE_OFFSETS: u16 = 324;
pub(crate) const TILE_BYTE_COUNTS: u16 = 325;
pub(crate) const SUB_IFDS: u16 = 330;
pub(crate) const SAMPLE_FORMAT: u16 = 339;
pub(crate) const JPEG_INTERCHANGE_FORMAT: u16 = 513;
pub(crate) const JPEG_INTERCHANGE_FORMAT_LENGTH: u16 = 514;

pub(crate) const CFA_REPEAT_PATTERN_DIM: u16 = 33421;
pub(crate) const CFA_PATTERN: u16 = 33422;
pub(crate) const SENSING_METHOD: u16 = 37399;

pub(crate) const EXIF_IFD: u16 = 34665;
pub(crate) const EXIF_VERSION: u16 = 36864;
pub(crate) const MAKER_NOTE: u16 = 37500;

pub(crate) const DNG_VERSION: u16 = 50706;
pub(crate) const DNG_BACKWARD_VERSION: u16 = 50707;
pub(crate) const UNIQUE_CAMERA_MODEL: u16 = 50708;
pub(crate) const CFA_PLANE_COLOR: u16 = 50710;
pub(crate) const CFA_LAYOUT: u16 = 50711;
pub(crate) const BLACK_LEVEL_REPEAT_DIM: u16 = 50713;
pub(crate) const BLACK_LEVEL: u16 = 50714;
pub(crate) const BLACK_LEVEL_DELTA_H: u16 = 50715;
pub(crate) const BLACK_LEVEL_DELTA_V: u16 = 50716;
pub(crate) const WHITE_LEVEL: u16 = 50717;
pub(crate) const DEFAULT_SCALE: u16 = 50718;
pub(crate) const DEFAULT_CROP_ORIGIN: u16 = 50719;
pub(crate) const DEFAULT_CROP_SIZE: u16 = 50720;
pub(crate) const COLOR_MATRIX_1: u16 = 50721;
pub(crate) const CAMERA_CALIBRATION_1: u16 = 50723;
pub(crate) const ANALOG_BALANCE: u16 = 50727;
pub(crate) const AS_SHOT_NEUTRAL: u16 = 50728;
pub(crate) const AS_SHOT_WHITE_XY: u16 = 50729;
pub(crate) const BASELINE_EXPOSURE: u16 = 50730;
pub(crate) const BASELINE_NOISE: u16 = 50731;
pub(crate) const BASELINE_SHARPNESS: u16 = 50732;
pub(crate) const LINEAR_RESPONSE_LIMIT: u16 = 50734;
pub(crate) const CALIBRATION_ILLUMINANT_1: u16 = 50778;
pub(crate) const ACTIVE_AREA: u16 = 50829;
pub(crate) const FORWARD_MATRIX_1: u16 = 50964;
pub(crate) const DEFAULT_USER_CROP: u16 = 51125;
