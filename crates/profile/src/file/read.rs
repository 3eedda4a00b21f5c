//! From the text of a profile file to a profile.

use std::collections::BTreeMap;

use darkroot_colour::{Matrix3, Xy, Xyz};
use serde::Deserialize;

use super::{Error, FORMAT, VERSION, WHITE};
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
    let syntax = |e: toml::de::Error| Error::Syntax { detail: e.to_string().trim_end().replace('\n', " ") };
    let head: Head = toml::from_str(text).map_err(syntax)?;
    if head.format != FORMAT {
        return Err(Error::Syntax { detail: format!("its format is `{}`, not `{FORMAT}`", head.format) });
    }
    if head.version != VERSION {
        return Err(Error::Version { found: head.version });
    }
    let file: File = toml::from_str(text).map_err(syntax)?;
    debug_assert!(file.format == FORMAT && file.version == VERSION);
    if let Some(found) = file.white.filter(|w| w != WHITE) {
        return Err(Error::White { found });
    }
    let calibrations = file.calibration.into_iter().map(calibration).collect::<Result<Vec<_>, _>>()?;
    let camera =
        ProfileCamera { make: file.camera.make, model: file.camera.model, aliases: file.camera.aliases };
    Profile::new(camera, calibrations, origin(file.origin)).ok_or(Error::Empty)
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
    read_calibration(table).map_err(|what| Error::Calibration { light: name, what })
}

const NOT_FINITE: &str = "a value is not a finite number";

fn read_calibration(table: CalibrationTable) -> Result<Calibration, String> {
    let light = light(table.light, table.xy, table.kelvin)?;
    let kind: Kind = table.model.parse().map_err(|e: crate::kind::UnknownKind| e.to_string())?;
    let model = Model {
        root: table.terms.map(|terms| root_polynomial(kind, table.order, terms)).transpose()?,
        hue_plane: table.hue_plane.map(hue_plane).transpose()?,
        residual: table.residual.map(residual).transpose()?,
        polynomial: table.polynomial.map(|terms| plain_polynomial(kind, terms)).transpose()?,
    };
    if !kind.fits(&model) {
        return Err(format!("it does not have the parts of the model `{kind}`, or has others"));
    }
    let patches = table.patch.into_iter().map(patch).collect::<Result<_, _>>()?;
    Ok(Calibration { light, kind, model, figures: figures(&table.figures)?, patches })
}

fn light(name: String, [x, y]: [f64; 2], kelvin: Option<f64>) -> Result<Light, String> {
    if !(x > 0.0 && y > 0.0 && x + y < 1.0) {
        return Err(format!("xy = [{x}, {y}] is no chromaticity of a light"));
    }
    let light = Light { name, xy: Xy::new(x, y) };
    let own = light.kelvin();
    let agrees = |kelvin: f64| (kelvin / own - 1.0).abs() < 0.02;
    match kelvin {
        Some(kelvin) if !agrees(kelvin) => {
            Err(format!("kelvin = {kelvin} is not the colour temperature of its xy, {own:.0}"))
        }
        _ => Ok(light),
    }
}

fn root_polynomial(kind: Kind, order: Option<u8>, mut terms: Terms) -> Result<RootPolynomial, String> {
    let order = match (order, kind) {
        (Some(number), _) => Order::new(number).ok_or_else(|| format!("there is no order {number}"))?,
        (None, Kind::Linear) => Order::One,
        (None, Kind::Root(order)) => order,
        (None, _) => return Err("`order` is missing".to_owned()),
    };
    let coefficients =
        order.terms().iter().map(|t| take(&mut terms, &t.name())).collect::<Result<Vec<_>, _>>()?;
    nothing_left(&terms, &format!("order {}", order.number()))?;
    RootPolynomial::new(order, coefficients).ok_or_else(|| NOT_FINITE.to_owned())
}

fn plain_polynomial(kind: Kind, mut terms: Terms) -> Result<Polynomial, String> {
    let Kind::Polynomial(degree) = kind else {
        return Err(format!("the model `{kind}` has no [calibration.polynomial]"));
    };
    let coefficients = polynomial::terms(degree)
        .iter()
        .map(|t| take(&mut terms, &polynomial::name(*t)))
        .collect::<Result<Vec<_>, _>>()?;
    nothing_left(&terms, &format!("degree {degree}"))?;
    Polynomial::new(degree, coefficients).ok_or_else(|| NOT_FINITE.to_owned())
}

fn take(terms: &mut Terms, name: &str) -> Result<[f64; 3], String> {
    terms.remove(name).ok_or_else(|| format!("term `{name}` is missing"))
}

fn nothing_left(terms: &Terms, what: &str) -> Result<(), String> {
    terms.keys().next().map_or(Ok(()), |extra| Err(format!("term `{extra}` does not belong to {what}")))
}

fn hue_plane(table: HuePlaneTable) -> Result<HuePlane, String> {
    let matrix = |values: Vec<f64>| match values.as_slice() {
        [..] if values.len() == 9 => Ok(Matrix3::from_row_slice(&values)),
        _ => Err(format!("a matrix of hue_plane has {} values, not 9 numbers", values.len())),
    };
    let knots = table.matrices.into_iter().map(matrix).collect::<Result<Vec<_>, _>>()?;
    let count = knots.len();
    HuePlane::new(knots)
        .ok_or_else(|| format!("hue_plane has {count} matrices (6, 12, 18 ... are needed) or {NOT_FINITE}"))
}

fn residual(table: ResidualTable) -> Result<Residual, String> {
    let centre = |[r, g, b, x, y, z]: [f64; 6]| Centre { rgb: [r, g, b], weight: [x, y, z] };
    Residual::new(table.centres.into_iter().map(centre).collect())
        .ok_or_else(|| format!("a centre of residual has no chromaticity or {NOT_FINITE}"))
}

fn figures(table: &FiguresTable) -> Result<Figures, String> {
    let summary = |v: [f64; 4]| match v.iter().all(|v| v.is_finite()) {
        true => Ok(Summary { mean: v[0], median: v[1], p95: v[2], max: v[3] }),
        false => Err(NOT_FINITE.to_owned()),
    };
    let read =
        |t: &ErrorsTable| Ok::<_, String>(Errors { de2000: summary(t.de2000)?, de_uv: summary(t.de_uv)? });
    let errors = |table: Option<&ErrorsTable>| table.map(read).transpose();
    Ok(Figures {
        training: errors(table.training.as_ref())?,
        leave_one_out: errors(table.leave_one_out.as_ref())?,
        held_out: errors(table.held_out.as_ref())?,
    })
}

fn patch(table: PatchTable) -> Result<Patch, String> {
    let values = table.rgb.iter().chain(&table.xyz).chain([&table.de2000]);
    if !values.into_iter().all(|v| v.is_finite()) {
        return Err(format!("patch {}: {NOT_FINITE}", table.name));
    }
    let [x, y, z] = table.xyz;
    Ok(Patch { name: table.name, rgb: table.rgb, xyz: Xyz::new(x, y, z), de2000: table.de2000 })
}
