//! What a stage asks of the tile that it works on. Each stage declares it beside its function; the border of a tile is
//! computed from the stages that run.

/// A stage that looks at more than one pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stage {
    /// For people.
    pub name: &'static str,
    /// Pixels that it looks at around its result, on each side.
    pub border: usize,
    /// What it does in a picture that is made smaller.
    pub when_smaller: WhenSmaller,
}

/// What a stage does in a picture that is smaller than the sensor's. Stages that declare nothing look at one pixel and
/// do the same at every size.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WhenSmaller {
    /// The same: it runs on the samples of the sensor, before they are binned.
    Same,
    /// Nothing: binning leaves nothing for it to do.
    Skipped,
}

/// Border of a tile: the most that the readers of the mosaic look at, and around that what the stages look at that
/// change the mosaic before.
pub(crate) const fn tile_border(changes: &[Stage], readers: &[Stage]) -> usize {
    let (mut around, mut most, mut i) = (0, 0, 0);
    while i < changes.len() {
        around += changes[i].border;
        i += 1;
    }
    i = 0;
    while i < readers.len() {
        if readers[i].border > most {
            most = readers[i].border;
        }
        i += 1;
    }
    around + most
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_add_up_and_the_widest_reader_counts() {
        let stage = |border| Stage { name: "", border, when_smaller: WhenSmaller::Same };
        assert_eq!(tile_border(&[], &[]), 0);
        assert_eq!(tile_border(&[stage(2), stage(1)], &[stage(3), stage(11), stage(5)]), 14);
    }
}
