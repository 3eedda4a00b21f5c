//! What `--version --long` says: the licence, and whose measurements are in the program.

use std::io::Write as _;

use crate::out;

/// Whose measurements are built in, as it stands beside them.
const LENSES: &str = include_str!("../../lens/NOTICE");
const CAMERAS: &str = include_str!("../../../profiles/NOTICE");
const CHARTS: &str = include_str!("../../chart/NOTICE");

/// Says all of it and ends the program.
pub(crate) fn say_all() -> ! {
    let text = format!(
        "darkroot {}\n\nFree software under the GNU Lesser General Public License, version 3 or later \
         (https://www.gnu.org/licenses/lgpl-3.0), without any warranty.\n\nLenses\n\n{}\n\nCameras\n\n{}\n\nCharts\n\n{}\n",
        env!("CARGO_PKG_VERSION"),
        LENSES.trim(),
        CAMERAS.trim(),
        CHARTS.trim(),
    );
    let said = out::ours().write_all(text.as_bytes()).and_then(|()| out::finish());
    std::process::exit(i32::from(said.is_err()))
}
