//! What charts look like: how many patches, where, and about which colours they have.

use std::sync::LazyLock;

use darkroot_colour::Lab;
use serde::Deserialize;
use thiserror::Error;

mod argyll;

mod beside;
pub use beside::{Beside, EdgePlace};

/// A chart of patches in a regular grid.
#[derive(Debug, Clone, PartialEq)]
pub struct ChartLayout {
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
    /// The wider gap of charts that fold.
    pub hinge: Option<Hinge>,
    /// The patches row by row from the top left one on: columns times rows of them.
    pub patches: Vec<PatchPlace>,
    /// What stands beside the grid, which pictures are judged by, too.
    pub beside: Option<Beside>,
}

/// Where a chart folds.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Hinge {
    /// How many columns are left of it.
    pub after: usize,
    /// How much wider than the other gaps this one is, as a share of a patch's width.
    pub width: f64,
}

/// One patch of a layout.
#[derive(Debug, Clone, PartialEq)]
pub struct PatchPlace {
    /// Its name ("A1", "dark skin").
    pub name: String,
    /// About its colour under D50: good enough to tell charts and their orientation, not to measure by.
    pub lab: Lab,
}

/// Why a text is no layout.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum LayoutError {
    /// The text is not TOML, or a field is missing or unknown.
    #[error("the layout cannot be read: {}; see the guide for its fields", .0.message())]
    Toml(#[from] toml::de::Error),
    /// A line of a .cht file is not what Argyll's format has there.
    #[error("line {line} of the .cht file cannot be read: {what}")]
    Cht {
        /// Number of the line, from 1.
        line: usize,
        /// What is wrong.
        what: &'static str,
    },
    /// Boxes do not form one regular grid.
    #[error("the chart's patches are not a regular grid ({0}); darkroot recognises only grids")]
    NotAGrid(&'static str),
    /// There is no colour for a patch.
    #[error(
        "the layout gives no colour for patch {0}: add about its Lab or XYZ, by which the chart is recognised"
    )]
    NoColour(String),
    /// The number of patches does not fit columns and rows.
    #[error("{patches} patches do not fill {columns} columns and {rows} rows")]
    Count {
        /// Patches listed.
        patches: usize,
        /// Columns stated.
        columns: usize,
        /// Rows stated.
        rows: usize,
    },
    /// What stands beside the grid makes no sense.
    #[error("what stands beside the grid cannot be used: {0}")]
    Beside(&'static str),
    /// A number is out of its range.
    #[error("{0} is out of range: columns and rows 2 to 60, gap 0 to 1, hinge inside the chart, L 0 to 110")]
    Range(&'static str),
}

const BUILT_IN: &str = include_str!("../data/layouts.toml");

/// The tables that layouts and references name.
pub(crate) const TABLES: [(&str, &str); 7] = [
    ("classic24_before_2014.csv", include_str!("../data/classic24_before_2014.csv")),
    ("classic24_after_2014.csv", include_str!("../data/classic24_after_2014.csv")),
    ("sg140_before_2014.csv", include_str!("../data/sg140_before_2014.csv")),
    ("sg140_after_2014.csv", include_str!("../data/sg140_after_2014.csv")),
    ("dc240.csv", include_str!("../data/dc240.csv")),
    ("spyder24.csv", include_str!("../data/spyder24.csv")),
    ("spyder48.csv", include_str!("../data/spyder48.csv")),
];

static LAYOUTS: LazyLock<Vec<ChartLayout>> = LazyLock::new(|| {
    let listed: Listed = toml::from_str(BUILT_IN).unwrap_or_default();
    listed.layout.into_iter().filter_map(|stored| stored.layout().ok()).collect()
});

impl ChartLayout {
    /// The charts Darkroot knows.
    pub fn builtin() -> Vec<Self> {
        LAYOUTS.clone()
    }

    /// The chart of this name.
    pub fn by_name(name: &str) -> Option<Self> {
        LAYOUTS.iter().find(|l| l.name == name).cloned()
    }

    /// A user's chart from TOML: `name`, `columns`, `rows`, `gap`, and per patch `[[patch]]` a `name` and about its
    /// `lab` under D50. `title` and `hinge = { after, width }` may follow, and what stands beside the grid in millimetres
    /// ([`Beside`]): `size` of the grid, `[[beside]]` with `name`, `lab` and `at`, `[[edge]]` with `from`, `to` and `clear`.
    pub fn from_toml(text: &str) -> Result<Self, LayoutError> {
        let own: Own = toml::from_str(text)?;
        let title = own.title.unwrap_or_else(|| own.name.clone());
        let place =
            |p: OwnPatch| PatchPlace { name: p.name, lab: Lab { l: p.lab[0], a: p.lab[1], b: p.lab[2] } };
        let patches: Vec<PatchPlace> = own.patch.into_iter().map(place).collect();
        let (columns, rows, gap, hinge) = (own.columns, own.rows, own.gap, own.hinge);
        let at = |p: OwnBeside| (place(OwnPatch { name: p.name, lab: p.lab }), p.at);
        let beside = match own.size {
            Some(size) => {
                let patches = own.beside.into_iter().map(at).collect();
                Some(Beside { size, patches, edges: own.edge })
            }
            None if own.beside.is_empty() && own.edge.is_empty() => None,
            None => return Err(LayoutError::Beside("`size`, the grid's width and height in mm, is missing")),
        };
        let beside = beside.map(|beside| beside.checked(&patches)).transpose()?;
        Self { name: own.name, title, columns, rows, gap, hinge, patches, beside }.checked()
    }

    /// A user's chart from the text of an Argyll chart recognition file (.cht) with its table of expected colours.
    pub fn from_cht(name: &str, text: &str) -> Result<Self, LayoutError> {
        argyll::layout(name, text)?.checked()
    }

    /// Left and right edge of a column in patch widths from the chart's left edge.
    pub fn column_edges(&self, column: usize) -> [f64; 2] {
        let hinge = self.hinge.filter(|h| column >= h.after).map_or(0.0, |h| h.width);
        let left = column as f64 * (1.0 + self.gap) + hinge;
        [left, left + 1.0]
    }

    /// Top and bottom edge of a row in patch heights from the chart's top edge.
    pub fn row_edges(&self, row: usize) -> [f64; 2] {
        let top = row as f64 * (1.0 + self.gap);
        [top, top + 1.0]
    }

    fn checked(self) -> Result<Self, LayoutError> {
        let fits = |n: usize| (2..=60).contains(&n);
        if !fits(self.columns) || !fits(self.rows) {
            return Err(LayoutError::Range("the number of columns or rows"));
        }
        if !(0.0..=1.0).contains(&self.gap) {
            return Err(LayoutError::Range("the gap"));
        }
        let hinge = |h: Hinge| h.after > 0 && h.after < self.columns && (0.0..=10.0).contains(&h.width);
        if !self.hinge.is_none_or(hinge) {
            return Err(LayoutError::Range("the hinge"));
        }
        if self.patches.len() != self.columns * self.rows {
            let (patches, columns, rows) = (self.patches.len(), self.columns, self.rows);
            return Err(LayoutError::Count { patches, columns, rows });
        }
        let sane = |lab: Lab| (0.0..=110.0).contains(&lab.l) && lab.a.abs() < 200.0 && lab.b.abs() < 200.0;
        let beside = self.beside.iter().flat_map(|beside| beside.patches.iter().map(|(place, _)| place));
        if !self.patches.iter().chain(beside).all(|p| sane(p.lab)) {
            return Err(LayoutError::Range("a colour"));
        }
        Ok(self)
    }
}

/// Reads a table of `data/`: a comment, a header, then name, L, a, b.
pub(crate) fn table(text: &str) -> Option<Vec<(String, Lab)>> {
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_reader(text.as_bytes());
    reader
        .deserialize::<(String, f64, f64, f64)>()
        .map(|row| row.ok().map(|(name, l, a, b)| (name, Lab { l, a, b })))
        .collect()
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct Listed {
    layout: Vec<Stored>,
}

/// A layout whose patches stand in a table of `data/`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Stored {
    name: String,
    title: String,
    columns: usize,
    rows: usize,
    gap: f64,
    hinge: Option<Hinge>,
    patches: String,
}

impl Stored {
    fn layout(self) -> Result<ChartLayout, LayoutError> {
        let text = TABLES.iter().find(|(name, _)| *name == self.patches).map(|(_, text)| *text);
        let rows = text.and_then(table).ok_or(LayoutError::NoColour(self.patches))?;
        let patches = rows.into_iter().map(|(name, lab)| PatchPlace { name, lab }).collect();
        let Self { name, title, columns, rows, gap, hinge, .. } = Self { patches: String::new(), ..self };
        ChartLayout { name, title, columns, rows, gap, hinge, patches, beside: None }.checked()
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Own {
    name: String,
    title: Option<String>,
    columns: usize,
    rows: usize,
    gap: f64,
    hinge: Option<Hinge>,
    patch: Vec<OwnPatch>,
    size: Option<[f64; 2]>,
    #[serde(default)]
    beside: Vec<OwnBeside>,
    #[serde(default)]
    edge: Vec<EdgePlace>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct OwnPatch {
    name: String,
    lab: [f64; 3],
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct OwnBeside {
    name: String,
    lab: [f64; 3],
    at: [f64; 4],
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_built_in_layout_is_read() {
        let names: Vec<String> = ChartLayout::builtin().into_iter().map(|l| l.name).collect();
        let all = [
            "classic24",
            "passport24",
            "mini24",
            "nano24",
            "cameratrax24",
            "sg140",
            "dc240",
            "spyder24",
            "spyder48",
        ];
        assert_eq!(names, all);
    }

    #[test]
    fn the_classic_begins_with_dark_skin_and_ends_with_black() {
        let classic = ChartLayout::by_name("classic24").unwrap();
        assert_eq!(classic.patches[0].name, "dark skin");
        assert_eq!(classic.patches[23].name, "black");
        assert!(classic.patches[18].lab.l > 95.0);
    }

    #[test]
    fn a_hinge_moves_the_columns_behind_it() {
        let spyder = ChartLayout::by_name("spyder48").unwrap();
        assert!((spyder.column_edges(4)[0] - spyder.column_edges(3)[1] - 1.77).abs() < 1e-9);
    }

    #[test]
    fn a_layout_of_ones_own_is_read_from_toml() {
        let mut text = "name = \"mine\"\ncolumns = 2\nrows = 2\ngap = 0.1\n".to_owned();
        for name in ["A1", "B1", "A2", "B2"] {
            text += &format!("[[patch]]\nname = \"{name}\"\nlab = [50, 10, -10.5]\n");
        }
        let layout = ChartLayout::from_toml(&text).unwrap();
        assert_eq!((layout.columns, layout.patches.len(), layout.title.as_str()), (2, 4, "mine"));
        let short = text.replace("rows = 2", "rows = 3");
        assert_eq!(
            ChartLayout::from_toml(&short),
            Err(LayoutError::Count { patches: 4, columns: 2, rows: 3 })
        );
        assert_eq!(
            ChartLayout::from_toml(&text.replace("gap = 0.1", "gap = nan")),
            Err(LayoutError::Range("the gap"))
        );
        assert!(matches!(ChartLayout::from_toml("columns = 2"), Err(LayoutError::Toml(_))));
    }
}
