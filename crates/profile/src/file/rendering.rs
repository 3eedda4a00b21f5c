//! The part of a profile file that says how its maker would show colours.

use std::fmt::Write;

use serde::Deserialize;

use crate::{LookTable, Rendering, ToneCurve};

/// `[rendering]`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RenderingTable {
    #[serde(default)]
    exposure: f64,
    curve: Option<Vec<[f64; 2]>>,
    look: Option<LookTableTable>,
}

/// `[rendering.look]`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct LookTableTable {
    divisions: [usize; 3],
    coded: bool,
    nodes: Vec<[f32; 3]>,
}

/// Writes what a profile has of it.
pub(super) fn write(text: &mut String, rendering: &Rendering) {
    let Rendering { exposure, table, curve } = rendering;
    // Writing to a String cannot fail.
    let _ = writeln!(text, "\n[rendering] # how its maker would show colours\nexposure = {exposure:?}");
    if let Some(curve) = curve {
        let _ = writeln!(text, "curve = {:?}", curve.points());
    }
    if let Some(table) = table {
        let (divisions, coded) = (table.divisions(), table.is_coded());
        text.push_str("\n[rendering.look] # hue shift in degrees, factors for saturation and value\n");
        let _ = writeln!(text, "divisions = {divisions:?}\ncoded = {coded}\nnodes = [");
        for row in table.nodes().chunks(divisions[1]) {
            text.push_str("    ");
            for node in row {
                let _ = write!(text, "{node:?}, ");
            }
            text.truncate(text.trim_end().len());
            text.push('\n');
        }
        text.push_str("]\n");
    }
}

/// What was read; `None` where it is unusable.
pub(super) fn read(table: RenderingTable) -> Option<Rendering> {
    let curve = match table.curve {
        Some(points) => Some(ToneCurve::new(points)?),
        None => None,
    };
    let look = match table.look {
        Some(look) => Some(LookTable::new(look.divisions, look.coded, look.nodes)?),
        None => None,
    };
    table.exposure.is_finite().then_some(Rendering { exposure: table.exposure, table: look, curve })
}
