//! All that a target shows: the patches of its grid, and those and the edges beside it.

use darkroot_calibrate::shot::Chart;
use darkroot_calibrate::{MeasuredPatch, ShotError};
use darkroot_chart::{ChartLayout, EdgeLine, Measurement, Quad, Reference, ReferenceColour};
use darkroot_photo::Mosaic;

use crate::find_chart::{INSET, Place};

/// The patches and edges of a target whose place is known.
pub(super) struct Target {
    names: Vec<String>,
    colours: Vec<ReferenceColour>,
    /// The part of each patch that is measured.
    pub(super) windows: Vec<Quad>,
    /// Edges beside the grid.
    pub(super) edges: Vec<EdgeLine>,
}

impl Target {
    /// # Errors
    /// A reference that lacks a patch beside the grid.
    pub(super) fn new(place: &Place, chart: &Chart<'_>, reference: &Reference) -> Result<Self, ShotError> {
        let name = |place: &darkroot_chart::PatchPlace| place.name.clone();
        let mut all = Self {
            names: chart.layout.patches.iter().map(name).collect(),
            colours: chart.colours.clone(),
            windows: place.windows.clone(),
            edges: Vec::new(),
        };
        if let Some(beside) = &chart.layout.beside {
            let names: Vec<&str> = beside.patches.iter().map(|(place, _)| place.name.as_str()).collect();
            all.colours.extend(reference.for_patches(&names).map_err(ShotError::Reference)?);
            all.names.extend(names.into_iter().map(str::to_owned));
            // Corners of a chart that was found are a quadrilateral.
            all.windows.extend(beside.windows(&place.corners, INSET).unwrap_or_default());
            all.edges = beside.edge_lines(&place.corners).unwrap_or_default();
        }
        Ok(all)
    }

    /// Measures the patches, each in linear light.
    ///
    /// # Errors
    /// A patch that is too small or lies outside of the picture, or one to leave out that is not there.
    pub(super) fn measured(
        &self,
        light: &Mosaic<f32>,
        exclude: &[String],
    ) -> Result<Vec<MeasuredPatch>, ShotError> {
        let measured = darkroot_chart::measure(light, [f32::INFINITY; 3], &self.windows);
        let name = |i: usize| self.names[i].as_str();
        if let Some(i) = measured.iter().position(|m| !m.is_complete()) {
            return Err(ShotError::TooSmall { patch: name(i).to_owned() });
        }
        let is = |i: usize, excluded: &str| name(i).eq_ignore_ascii_case(excluded);
        if let Some(unknown) = exclude.iter().find(|e| !(0..measured.len()).any(|i| is(i, e))) {
            return Err(ShotError::NoPatch { name: unknown.clone() });
        }
        let patch = |(i, m): (usize, &Measurement)| MeasuredPatch {
            name: name(i).to_owned(),
            rgb: m.mean,
            uncertainty: m.uncertainty(),
            clipped: m.clipped,
            reference: self.colours[i].clone(),
            excluded: exclude.iter().any(|e| is(i, e)).then(|| "left out by hand".to_owned()),
        };
        Ok(measured.iter().enumerate().map(patch).collect())
    }
}

/// Millimetres between the middles of two patches of the grid, where the layout has them.
pub(super) fn pitch_of(layout: &ChartLayout) -> Option<f64> {
    let width = layout.column_edges(layout.columns.saturating_sub(1))[1];
    layout.beside.as_ref().map(|beside| beside.pitch(layout.columns, width))
}
