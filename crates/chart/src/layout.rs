//! What charts look like: how many patches, where, and about which colours they have.

use colour::Lab;

/// A chart of patches in a regular grid.
#[derive(Debug, Clone, PartialEq)]
pub struct Layout {
    /// Name on the command line ("classic24").
    pub name: String,
    /// Name for people ("ColorChecker Classic, 24 patches").
    pub title: String,
    /// Patches from left to right when the chart is held as its maker prints it.
    pub columns: usize,
    /// Patches from top to bottom.
    pub rows: usize,
    /// Width of the gap between two patches, as a share of a patch's width.
    pub gap: f64,
    /// The patches row by row from the top left one on: columns times rows of them.
    pub patches: Vec<PatchPlace>,
}

/// One patch of a layout.
#[derive(Debug, Clone, PartialEq)]
pub struct PatchPlace {
    /// Its name ("A1", "dark skin").
    pub name: String,
    /// About its colour under D50: good enough to tell charts and their orientation, not to measure by.
    pub lab: Lab,
}
