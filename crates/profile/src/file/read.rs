//! From the text of a profile file to a profile.

use std::collections::BTreeMap;
use std::sync::Arc;

use darkroot_colour::{Matrix3, Xy, Xyz};
use serde::Deserialize;

use super::rendering::{self, RenderingTable};
use super::{
    CAMERA_VERSION, CalibrationFault, Error, FORMAT, RENDERING_VERSION, SensitivitiesFault, VERSION, WHITE,
};
use crate::camera::{Judged, KnownCamera, known};
use crate::residual::Centre;
use crate::{
    Calibration, Errors, Figures, HuePlane, Kind, Light, Model, Order, Origin, Patch, Polynomial, Profile,
    ProfileCamera, Residual, RootPolynomial, Summary, polynomial,
};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    format: String,
    version: i64,
    white: Option<String>,
    camera: CameraTable,
    #[serde(default)]
    origin: OriginTable,
    #[serde(default)]
    calibration: Vec<CalibrationTable>,
    sensitivities: Option<SensitivitiesTable>,
    rendering: Option<RenderingTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SensitivitiesTable {
    red: Vec<f64>,
    green: Vec<f64>,
    blue: Vec<f64>,
    expected_de2000: Option<f64>,
    #[serde(default)]
    held_out: Vec<JudgedTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct JudgedTable {
    light: String,
    de2000: [f64; 4],
    de_uv: [f64; 4],
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct CameraTable {
    make: String,
    model: String,
    #[serde(default)]
    aliases: Vec<String>,
}

#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields, default)]
struct OriginTable {
    summary: String,
    chart: String,
    reference: String,
    reference_sha256: String,
    sensitivities: String,
    sensitivities_sha256: String,
    date: String,
    program: String,
}

type Terms = BTreeMap<String, [f64; 3]>;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct CalibrationTable {
    light: String,
    xy: [f64; 2],
    kelvin: Option<f64>,
    model: String,
    order: Option<u8>,
    terms: Option<Terms>,
    hue_plane: Option<HuePlaneTable>,
    residual: Option<ResidualTable>,
    polynomial: Option<Terms>,
    #[serde(default)]
    figures: FiguresTable,
    #[serde(default)]
    patch: Vec<PatchTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct HuePlaneTable {
    matrices: Vec<Vec<f64>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ResidualTable {
    centres: Vec<[f64; 6]>,
}

#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields, default)]
struct FiguresTable {
    training: Option<ErrorsTable>,
    leave_one_out: Option<ErrorsTable>,
    held_out: Option<ErrorsTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ErrorsTable {
    de2000: [f64; 4],
    de_uv: [f64; 4],
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PatchTable {
    name: String,
    rgb: [f64; 3],
    xyz: [f64; 3],
    de2000: f64,
}

/// Only what tells a profile of another version from a file that is none.
#[derive(Deserialize)]
struct Head {
    format: String,
    version: i64,
}

/// Reads a profile from the text of its file.
///
/// # Errors
/// Wrong syntax, unknown fields, another version, missing or extra terms, values that are not finite.
pub fn parse(text: &str) -> Result<Profile, Error> {
    let syntax = |e: toml::de::Error| syntax(text, &e);
    let head: Head = toml::from_str(text).map_err(syntax)?;
    if head.format != FORMAT {
        return Err(Error::Syntax {
            detail: format!("its format is `{}`, not `{FORMAT}`", short(&head.format)),
        });
    }
    if ![VERSION, CAMERA_VERSION, RENDERING_VERSION].contains(&head.version) {
        return Err(Error::Version { found: head.version });
    }
    let file: File = toml::from_str(text).map_err(syntax)?;
    debug_assert!(file.format == FORMAT && file.version == head.version);
    if let Some(found) = file.white.filter(|w| w != WHITE) {
        return Err(Error::White { found });
    }
    let calibrations = file.calibration.into_iter().map(calibration).collect::<Result<Vec<_>, _>>()?;
    let camera =
        ProfileCamera { make: file.camera.make, model: file.camera.model, aliases: file.camera.aliases };
    let origin = origin(file.origin);
    let rendering = match file.rendering {
        Some(table) => Some(Arc::new(rendering::read(table).ok_or(Error::Rendering)?)),
        None => None,
    };
    let profile = match file.sensitivities {
        Some(_) if !calibrations.is_empty() => Err(Error::Both),
        Some(table) => {
            let known = known_camera(table).map_err(Error::Sensitivities)?;
            Ok(Profile::of_camera(camera, known, origin))
        }
        None => Profile::new(camera, calibrations, origin).ok_or(Error::Empty),
    };
    Ok(profile?.rendered_by(rendering))
}

fn known_camera(table: SensitivitiesTable) -> Result<KnownCamera, SensitivitiesFault> {
    let samples = |channel: Vec<f64>| {
        let count = channel.len();
        <[f64; known::KEPT]>::try_from(channel).map_err(|_| SensitivitiesFault::Count(count))
    };
    let samples = [samples(table.red)?, samples(table.green)?, samples(table.blue)?];
    let judged = table
        .held_out
        .into_iter()
        .map(|JudgedTable { light, de2000, de_uv }| Some(Judged { light, errors: errors(de2000, de_uv)? }));
    let judged = judged.collect::<Option<Vec<_>>>().ok_or(SensitivitiesFault::Blind)?;
    let sound = table.expected_de2000.is_none_or(f64::is_finite);
    let known = KnownCamera::of_samples(samples).filter(|_| sound).ok_or(SensitivitiesFault::Blind)?;
    Ok(known.judged(judged).expecting(table.expected_de2000))
}

/// What the reader says, with the line that it is about.
fn syntax(text: &str, error: &toml::de::Error) -> Error {
    let before = &text.as_bytes()[..error.span().map_or(0, |s| s.start).min(text.len())];
    let number = before.iter().filter(|b| **b == b'\n').count();
    let line = short(text.lines().nth(number).unwrap_or_default().trim());
    let message = short(&error.message().trim().replace('\n', ", "));
    Error::Syntax { detail: format!("line {}, `{line}`: {message}", number + 1) }
}

/// As much of a text as tells which one it is.
fn short(text: &str) -> String {
    /// In characters.
    const MOST: usize = 200;
    match text.char_indices().nth(MOST) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text.to_owned(),
    }
}

fn origin(table: OriginTable) -> Origin {
    Origin {
        summary: table.summary,
        chart: table.chart,
        reference: table.reference,
        reference_sha256: table.reference_sha256,
        sensitivities: table.sensitivities,
        sensitivities_sha256: table.sensitivities_sha256,
        date: table.date,
        program: table.program,
    }
}

fn calibration(table: CalibrationTable) -> Result<Calibration, Error> {
    let name = table.light.clone();
    read_calibration(table).map_err(|source| Error::Calibration { light: name, source })
}

fn read_calibration(table: CalibrationTable) -> Result<Calibration, CalibrationFault> {
    let light = light(table.light, table.xy, table.kelvin)?;
    let kind: Kind = table.model.parse()?;
    let model = Model {
        root: table.terms.map(|terms| root_polynomial(kind, table.order, terms)).transpose()?,
        hue_plane: table.hue_plane.map(hue_plane).transpose()?,
        residual: table.residual.map(residual).transpose()?,
        polynomial: table.polynomial.map(|terms| plain_polynomial(kind, terms)).transpose()?,
    };
    if !kind.fits(&model) {
        return Err(CalibrationFault::Parts(kind));
    }
    let patches = table.patch.into_iter().map(patch).collect::<Result<_, _>>()?;
    Ok(Calibration { light, kind, model, figures: figures(&table.figures)?, patches })
}

fn light(name: String, [x, y]: [f64; 2], kelvin: Option<f64>) -> Result<Light, CalibrationFault> {
    if !(x > 0.0 && y > 0.0 && x + y < 1.0) {
        return Err(CalibrationFault::Chromaticity([x, y]));
    }
    let light = Light { name, xy: Xy::new(x, y) };
    let own = light.kelvin();
    let agrees = |kelvin: f64| (kelvin / own - 1.0).abs() < 0.02;
    match kelvin {
        Some(kelvin) if !agrees(kelvin) => Err(CalibrationFault::Kelvin { kelvin, own }),
        _ => Ok(light),
    }
}

fn root_polynomial(
    kind: Kind,
    order: Option<u8>,
    mut terms: Terms,
) -> Result<RootPolynomial, CalibrationFault> {
    let order = match (order, kind) {
        (Some(number), _) => Order::new(number).ok_or(CalibrationFault::Order(number))?,
        (None, Kind::Linear) => Order::One,
        (None, Kind::Root(order)) => order,
        (None, _) => return Err(CalibrationFault::NoOrder),
    };
    let coefficients =
        order.terms().iter().map(|t| take(&mut terms, &t.name())).collect::<Result<Vec<_>, _>>()?;
    nothing_left(&terms, &format!("order {}", order.number()))?;
    RootPolynomial::new(order, coefficients).ok_or(CalibrationFault::SOMEWHERE)
}

fn plain_polynomial(kind: Kind, mut terms: Terms) -> Result<Polynomial, CalibrationFault> {
    let Kind::Polynomial(degree) = kind else {
        return Err(CalibrationFault::NoPolynomial(kind));
    };
    let coefficients = polynomial::terms(degree)
        .iter()
        .map(|t| take(&mut terms, &polynomial::name(*t)))
        .collect::<Result<Vec<_>, _>>()?;
    nothing_left(&terms, &format!("degree {degree}"))?;
    Polynomial::new(degree, coefficients).ok_or(CalibrationFault::SOMEWHERE)
}

fn take(terms: &mut Terms, name: &str) -> Result<[f64; 3], CalibrationFault> {
    terms.remove(name).ok_or_else(|| CalibrationFault::MissingTerm(name.to_owned()))
}

fn nothing_left(terms: &Terms, of: &str) -> Result<(), CalibrationFault> {
    match terms.keys().next() {
        None => Ok(()),
        Some(extra) => Err(CalibrationFault::ExtraTerm { term: extra.to_string(), of: of.to_owned() }),
    }
}

fn hue_plane(table: HuePlaneTable) -> Result<HuePlane, CalibrationFault> {
    let matrix = |values: Vec<f64>| match values.as_slice() {
        [..] if values.len() == 9 => Ok(Matrix3::from_row_slice(&values)),
        _ => Err(CalibrationFault::Matrix(values.len())),
    };
    let knots = table.matrices.into_iter().map(matrix).collect::<Result<Vec<_>, _>>()?;
    let count = knots.len();
    HuePlane::new(knots).ok_or(CalibrationFault::Matrices(count))
}

fn residual(table: ResidualTable) -> Result<Residual, CalibrationFault> {
    let centre = |[r, g, b, x, y, z]: [f64; 6]| Centre { rgb: [r, g, b], weight: [x, y, z] };
    Residual::new(table.centres.into_iter().map(centre).collect()).ok_or(CalibrationFault::Centre)
}

fn figures(table: &FiguresTable) -> Result<Figures, CalibrationFault> {
    let read = |t: &ErrorsTable| errors(t.de2000, t.de_uv).ok_or(CalibrationFault::SOMEWHERE);
    let set = |table: Option<&ErrorsTable>| table.map(read).transpose();
    Ok(Figures {
        training: set(table.training.as_ref())?,
        leave_one_out: set(table.leave_one_out.as_ref())?,
        held_out: set(table.held_out.as_ref())?,
    })
}

/// `None` where a value is no finite number.
fn errors(de2000: [f64; 4], de_uv: [f64; 4]) -> Option<Errors> {
    let summary = |[mean, median, p95, max]: [f64; 4]| Summary { mean, median, p95, max };
    let finite = de2000.iter().chain(&de_uv).all(|v| v.is_finite());
    finite.then(|| Errors { de2000: summary(de2000), de_uv: summary(de_uv) })
}

fn patch(table: PatchTable) -> Result<Patch, CalibrationFault> {
    let values = table.rgb.iter().chain(&table.xyz).chain([&table.de2000]);
    if !values.into_iter().all(|v| v.is_finite()) {
        return Err(CalibrationFault::NotFinite { place: Some(format!("patch {}", table.name)) });
    }
    let [x, y, z] = table.xyz;
    Ok(Patch { name: table.name, rgb: table.rgb, xyz: Xyz::new(x, y, z), de2000: table.de2000 })
}
