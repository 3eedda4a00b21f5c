//! White points that standards name.

use crate::{Xy, Xyz};

/// D50 as the ICC profile connection space has it (ICC.1:2022, 7.2.16): X = 0.9642, Y = 1, Z = 0.8249.
pub const D50: Xyz = Xyz::new(0.9642, 1.0, 0.8249);

/// Chromaticity of D50 in ROMM RGB and eciRGB (ISO 22028-2).
pub const D50_XY: Xy = Xy::new(0.3457, 0.3585);

/// D65 as IEC 61966-2-1 has it: x = 0.3127, y = 0.3290.
pub const D65: Xyz = Xyz::new(0.3127 / 0.3290, 1.0, (1.0 - 0.3127 - 0.3290) / 0.3290);

/// Chromaticity of D65 in sRGB, Display P3, Adobe RGB and Rec. 2020.
pub const D65_XY: Xy = Xy::new(0.3127, 0.3290);

/// Chromaticity of standard illuminant A (CIE 015:2018, table T.3).
pub const A_XY: Xy = Xy::new(0.44758, 0.40745);

/// Chromaticity of the ACES white (SMPTE ST 2065-1:2021), about 6000 K.
pub const ACES_XY: Xy = Xy::new(0.32168, 0.33767);
