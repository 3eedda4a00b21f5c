//! Finding a chart in a picture.

use chart::{Layout, Quad};
use photo::Size;

/// The surest chart of a layout in a linear picture: corners in its pixels and confidence. The reason in words where
/// there is none.
pub(crate) fn best(_size: Size, _planes: [Vec<f32>; 3], _layout: &Layout) -> Result<(Quad, f64), String> {
    Err("no chart was found; give its corners: `--corners x,y,x,y,x,y,x,y`".to_owned())
}
