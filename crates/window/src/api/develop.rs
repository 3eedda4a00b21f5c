//! Views of a picture, and what they show.

use std::sync::Arc;
use std::time::Instant;

use axum::Json;
use axum::extract::State;
use axum::http::HeaderValue;
use axum::http::header::CONTENT_TYPE;
use axum::response::{IntoResponse, Response};
use darkroot::{Plan, Scale, Settings, View};
use darkroot_develop::{Balance, Crop, Resize};
use darkroot_photo::{Rect, Size};
use serde::{Deserialize, Serialize};
use serde_json::json;

use super::aside;
use super::asked::{Body, Edited};
use crate::fault::Fault;
use crate::opened::Open;
use crate::readout::{self, Spot};
use crate::screen::{self, Gamut, Sent};
use crate::state::Shared;
use crate::tally::tally;

/// A view that is asked for.
#[derive(Debug, Deserialize)]
pub(crate) struct Wanted {
    #[serde(flatten)]
    edited: Edited,
    /// Who asks: a newer request of the same place cancels an older one.
    place: String,
    /// The longer side of the whole picture has at least so many pixels, if it has as many; for a view of all of it.
    longest: Option<usize>,
    /// Part of the picture at full scale: column, row, width, height.
    rect: Option<[usize; 4]>,
    #[serde(default)]
    gamut: Gamut,
    #[serde(default)]
    format: Sent,
    /// Whether all of the frame is shown, whatever the crop, to choose one.
    #[serde(default)]
    uncropped: bool,
    /// Whether another is to follow at once: where that saves time, the picture is coarser, noise is left in, and in the first
    /// one of a file all that would have to be looked for in its samples; the JPEG is smaller.
    #[serde(default)]
    quick: bool,
}

/// What a view is, beside its picture.
#[derive(Debug, Serialize)]
struct About {
    /// Size of the whole picture.
    size: [usize; 2],
    /// Pixels of the whole picture along the side of one of the view.
    bin: usize,
    /// White of the light, K and tint, where it is known.
    kelvin: Option<f64>,
    tint: Option<f64>,
    tally: Option<crate::tally::Tally>,
    notes: Vec<String>,
    milliseconds: f64,
}

/// What share of the pixels along a side is enough for the first picture of a file, and for one while a setting moves.
const AT_ONCE: f64 = 0.62;
const MOVING: f64 = 0.5;

/// The largest view, pixels.
const LARGEST: usize = 40_000_000;

/// Renders a view. Its picture is the body; what is to be said of it stands in the header `darkroot-view`.
pub(crate) async fn render(
    State(shared): State<Arc<Shared>>,
    Body(wanted): Body<Wanted>,
) -> Result<Response, Fault> {
    let task = Arc::clone(&shared);
    let place = format!("{:.80}", wanted.place);
    let rendered = shared.latest.render(&place, move |cancel| {
        let start = Instant::now();
        let (open, settings) = opened(&task, &wanted.edited)?;
        let settings = screen::shown(uncropped(settings, wanted.uncropped), wanted.gamut);
        let (plan, view) = planned(&task, &open, settings, &wanted)?;
        let rendered = match wanted.rect {
            Some(_) => plan.render(view, cancel),
            None => plan.render_again(view, &open.kept, cancel),
        };
        let Ok(picture) = rendered else { return Err(replaced()) };
        let picture = screen::for_screen(picture, wanted.gamut);
        // One thread counts while another codes.
        let (counted, coded) = std::thread::scope(|scope| {
            let counted = scope.spawn(|| if wanted.rect.is_none() { tally(&picture) } else { None });
            let coded = screen::bytes(&picture, wanted.format, wanted.quick);
            (counted.join().ok().flatten(), coded)
        });
        let (bytes, kind) = coded.map_err(|e| Fault::unusable(e.to_string()))?;
        let about = About {
            size: [plan.size().width, plan.size().height],
            bin: view.scale.bin(),
            kelvin: plan.white.map(|white| white.kelvin),
            tint: plan.white.map(|white| white.tint()),
            tally: counted,
            notes: open
                .photo
                .capture()
                .notes
                .iter()
                .chain(&plan.notes)
                .map(|note| darkroot::quoted(note))
                .collect(),
            milliseconds: start.elapsed().as_secs_f64() * 1e3,
        };
        Ok((bytes, kind, about))
    });
    let (bytes, kind, about) = rendered.await.ok_or_else(replaced)??;
    let mut answer = bytes.into_response();
    answer.headers_mut().insert(CONTENT_TYPE, HeaderValue::from_static(kind));
    if let Ok(about) = HeaderValue::from_str(&ascii(&json!(about).to_string())) {
        answer.headers_mut().insert("darkroot-view", about);
    }
    Ok(answer)
}

fn replaced() -> Fault {
    Fault::conflict("a newer request replaced this one")
}

/// JSON with nothing that a header cannot hold.
fn ascii(json: &str) -> String {
    let mut text = String::with_capacity(json.len());
    for c in json.chars() {
        let mut units = [0; 2];
        match c {
            ' '..='~' => text.push(c),
            _ => c.encode_utf16(&mut units).iter().for_each(|unit| text += &format!("\\u{unit:04x}")),
        }
    }
    text
}

/// The photograph of a request, decoded, and what holds for it.
pub(crate) fn opened(shared: &Shared, edited: &Edited) -> Result<(Arc<Open>, Settings), Fault> {
    let (place, _, settings) = edited.settings(shared)?;
    let open = shared.opened.open(&place, &shared.store(), &settings)?;
    Ok((open, settings))
}

fn plan(shared: &Shared, open: &Open, settings: &Settings) -> Result<Plan, Fault> {
    open.plan(&shared.store(), settings)
}

/// What a view is rendered by. A quick one is coarse, unless what is kept of it serves.
fn planned(shared: &Shared, open: &Open, settings: Settings, wanted: &Wanted) -> Result<(Plan, View), Fault> {
    let by = |settings: &Settings, share: f64| {
        let plan = plan(shared, open, settings)?;
        let view = view(&plan, wanted, share)?;
        Ok::<_, Fault>((plan, view))
    };
    if !wanted.quick {
        return by(&settings, 1.0);
    }
    if open.kept.is_empty() {
        return by(&screen::at_once(settings), AT_ONCE);
    }
    let (whole, of_whole) = by(&settings, 1.0)?;
    if whole.is_kept(of_whole, &open.kept) {
        return Ok((whole, of_whole));
    }
    by(&screen::with_noise(settings), MOVING)
}

fn uncropped(mut settings: Settings, yes: bool) -> Settings {
    if yes {
        settings.recipe.crop = Crop::Default;
    }
    settings
}

/// The view that is wanted; of a whole one, that share of the pixels along a side is enough.
fn view(plan: &Plan, wanted: &Wanted, share: f64) -> Result<View, Fault> {
    let view = match (wanted.rect, wanted.longest) {
        (Some([x, y, width, height]), _) => View::of(Rect { x, y, width, height }),
        (None, Some(longest)) => {
            plan.whole(Scale::to_show(plan.size(), (share * longest as f64).ceil() as usize))
        }
        (None, None) => plan.whole(Scale::FULL),
    };
    let within = Rect::full(plan.size_at(view.scale)).intersection(view.rect);
    let Some(rect) = within else { return Err(Fault::asked("the rectangle lies outside of the picture")) };
    if rect.size().area() > LARGEST {
        return Err(Fault::asked(format!("a view has at most {} million pixels", LARGEST / 1_000_000)));
    }
    Ok(View { rect, ..view })
}

/// Where a crop can lie.
#[derive(Debug, Serialize)]
pub(crate) struct Frame {
    /// Size of the upright picture that crops are counted in, before it is straightened.
    canvas: [usize; 2],
    /// What is shown of it without a crop: column, row, width, height. A rectangle in it lies in the picture whole.
    shown: [usize; 4],
    /// The part that the settings ask for, in the same pixels.
    crop: [usize; 4],
}

/// Where the crop of a file lies, and where it can.
pub(crate) async fn frame(
    State(shared): State<Arc<Shared>>,
    Body(edited): Body<Edited>,
) -> Result<Json<Frame>, Fault> {
    aside(move || {
        let (open, mut settings) = opened(&shared, &edited)?;
        settings.recipe.geometry.resize = Resize::None;
        let settings = screen::shown(settings, Gamut::Srgb);
        let size = |settings: &Settings| plan(&shared, &open, settings).map(|plan| plan.size());
        let all = uncropped(settings.clone(), true);
        let mut canvas = all.clone();
        canvas.recipe.geometry.straighten = 0.0;
        canvas.recipe.geometry.auto_straighten = false;
        canvas.recipe.geometry.perspective = None;
        let (canvas, shown) = (size(&canvas)?, size(&all)?);
        let middle = |inner: Size| {
            // A part of a turned picture may begin between two pixels: whole ones that lie in it.
            let within = |whole: usize, part: usize| {
                let start = whole.saturating_sub(part).div_ceil(2);
                (start, (whole + part) / 2 - start)
            };
            let (x, width) = within(canvas.width, inner.width);
            let (y, height) = within(canvas.height, inner.height);
            [x, y, width, height]
        };
        let crop = match settings.recipe.crop {
            Crop::Rect { x, y, width, height } => [x, y, width, height],
            _ => middle(size(&settings)?),
        };
        Ok(Json(Frame { canvas: [canvas.width, canvas.height], shown: middle(shown), crop }))
    })
    .await
}

/// A spot that is asked for.
#[derive(Debug, Deserialize)]
pub(crate) struct SpotAt {
    #[serde(flatten)]
    edited: Edited,
    /// Column and row in the developed picture.
    x: usize,
    y: usize,
    #[serde(default)]
    gamut: Gamut,
}

/// Side of a grey spot that a person points at, pixels.
const GREY: usize = 32;

/// The white balance that makes a spot grey, as a text of `white-balance`: multipliers, which stay what they are when the picture
/// is cropped or turned.
pub(crate) async fn balance(
    State(shared): State<Arc<Shared>>,
    Body(at): Body<SpotAt>,
) -> Result<Json<String>, Fault> {
    aside(move || {
        let (open, settings) = opened(&shared, &at.edited)?;
        let mut settings = screen::shown(settings, at.gamut);
        settings.recipe.balance = Balance::Spot { x: at.x, y: at.y, side: GREY };
        let [red, green, blue] = plan(&shared, &open, &settings)?.multipliers();
        Ok(Json(format!("{:.4},1,{:.4}", red / green, blue / green)))
    })
    .await
}

/// What a spot of the picture is.
pub(crate) async fn spot(
    State(shared): State<Arc<Shared>>,
    Body(at): Body<SpotAt>,
) -> Result<Json<Spot>, Fault> {
    aside(move || {
        let (open, settings) = opened(&shared, &at.edited)?;
        readout::spot(&open, &shared.store(), &settings, at.gamut, [at.x, at.y]).map(Json)
    })
    .await
}
