//! A rebuilt colour becomes white while its last channel goes towards its limit.
//!
//! How far it has gone is told by the channels of the camera, which have limits; the colour changes in scene light, where an
//! even change looks even. A camera's channels overlap: in a magenta that has hardly any green, a little more of the camera's
//! green is already much more of the scene's, and it would turn white within half a stop.

use std::array::from_fn;

use darkroot_colour::simd::vectorised;
use darkroot_photo::{CameraSpace, Rgb, Scene};

use super::{CLIPPED, ENDED, RUN, Rebuild, TRUSTED, Treatment, least, most, reaches, smooth};

/// Share of its limit from which on a last channel makes the colour white, at most: less where channels clip far apart, for
/// which there is more room then.
const NEARLY: f32 = 0.8;
/// In this power of light the darkest channel goes to white evenly: eyes and the curves of looks see ratios of dark light.
const EVENLY: f32 = 0.2;
/// Share of the brightest channel that a darkest one has at least before it goes to white.
const DARKEST: f32 = 1e-4;
/// What lies below that, of colours beyond Rec. 2020, is gone at this whiteness.
const INSIDE: f32 = 0.3;

/// How white each pixel of a rebuilt picture is to become, from 0 to 1; nothing where none is.
#[derive(Debug, Clone, PartialEq)]
pub struct Whitening(Option<Vec<f32>>);

impl Whitening {
    /// From balanced camera RGB that was rebuilt. Corrections that make limits differ from place to place leave nothing to
    /// compare with.
    pub fn of(picture: &Rgb<CameraSpace>, treatment: &Treatment) -> Self {
        let Treatment::Rebuild(Rebuild { limits, uneven: false, .. }) = treatment else { return Self(None) };
        let [r, g, b] = picture.planes();
        let scale = limits.map(|l| 1.0 / l);
        let mut shares: Option<Vec<f32>> = None;
        for (i, ((r, g), b)) in r.chunks(RUN).zip(g.chunks(RUN)).zip(b.chunks(RUN)).enumerate() {
            let is_bright = |plane: &[f32], c: usize| reaches(plane, TRUSTED * limits[c]);
            if !is_bright(r, 0) && !is_bright(g, 1) && !is_bright(b, 2) {
                continue;
            }
            let shares = shares.get_or_insert_with(|| vec![0.0; picture.size().area()]);
            let out = &mut shares[i * RUN..][..r.len()];
            vectorised(
                #[inline(always)]
                || {
                    for (out, ((r, g), b)) in out.iter_mut().zip(r.iter().zip(g).zip(b)) {
                        *out = whiteness([r * scale[0], g * scale[1], b * scale[2]]);
                    }
                },
            );
        }
        Self(shares)
    }
}

/// How white to make a colour whose channels, rebuilt, have these shares of their limits: 0 as long as none is clipped, 1
/// where the last one ends. In between there is as much room as between the first and the last channel's clipping.
#[inline(always)]
fn whiteness(shares: [f32; 3]) -> f32 {
    let (least, most) = (least(shares), most(shares));
    let begin = (least / most.max(TRUSTED)).clamp(0.05, NEARLY);
    let t = ((least - begin) / (ENDED.0 - begin)).clamp(0.0, 1.0);
    t * t * t.sqrt() * smooth(most, TRUSTED, CLIPPED)
}

/// Makes the scene light of a picture as white as that.
pub fn whiten(picture: &mut Rgb<Scene>, whitening: &Whitening) {
    let Whitening(Some(shares)) = whitening else { return };
    let [r, g, b] = picture.planes_mut();
    for (((r, g), b), &share) in r.iter_mut().zip(g).zip(b).zip(shares) {
        if share > 0.0 {
            [*r, *g, *b] = towards_white([*r, *g, *b], share);
        }
    }
}

/// A colour on its way to the white that is as bright as its brightest channel: the best guess of how bright the surface is
/// at least.
fn towards_white(colour: [f32; 3], share: f32) -> [f32; 3] {
    let (white, low) = (most(colour), least(colour));
    let span = white - low;
    if !(span > 0.0 && white > 0.0) {
        return colour;
    }
    let part = (low / white).max(DARKEST);
    let wanted = white * ((1.0 - share) * part.powf(EVENLY) + share).powf(1.0 / EVENLY);
    let beyond = (low - white * part) * (1.0 - smooth(share, 0.0, INSIDE));
    let kept = (white - wanted - beyond) / span;
    from_fn(|c| white - (white - colour[c]) * kept)
}
