//! Captures as DNG bytes (Adobe, Digital Negative Specification 1.4).

use darkroot_colour::Matrix3;
use darkroot_photo::metadata::{Directory, Value};
use darkroot_photo::{AsShot, BlackLevel, Calibration, Capture, Cfa, Counts, Filter, Layout, Rect};

use crate::preview::preview;
use crate::tag;
use crate::tiff_writer::{Ifd, file};
use darkroot_encode::ljpeg;

/// How the samples are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Storage {
    /// 16 bits a sample in one strip. Floating-point samples are always stored so, in 32 bits.
    Uncompressed,
    /// Lossless JPEG in one strip.
    JpegStrip,
    /// Lossless JPEG in tiles of 256 x 256 pixels, as most converters write; in one strip when the picture is
    /// narrower than a tile, which LibRaw 0.22 misreads.
    #[default]
    JpegTiles,
}

/// Side of a tile, pixels; a multiple of 16 (TIFF 6.0, section 15).
const TILE: usize = 256;

/// The bytes of a DNG file: a small RGB preview, the samples, Exif. Everything that [`Capture`] says is in it but
/// its corrections.
pub fn write(capture: &Capture, storage: Storage) -> Vec<u8> {
    let mut root = Ifd::default();
    preview_directory(&mut root, capture);
    root.fields(capture.metadata.fields().iter().filter(|f| f.directory == Directory::Image))
        .text(tag::MAKE, &capture.camera.make)
        .text(tag::MODEL, &capture.camera.model)
        .shorts(tag::ORIENTATION, &[capture.orientation.exif()])
        .put(tag::DNG_VERSION, Value::Bytes(vec![1, 4, 0, 0]))
        .put(tag::DNG_BACKWARD_VERSION, Value::Bytes(vec![1, if is_float(capture) { 4 } else { 1 }, 0, 0]))
        .text(tag::UNIQUE_CAMERA_MODEL, &format!("{} {}", capture.camera.make, capture.camera.model))
        .fractions(tag::ANALOG_BALANCE, &capture.analog_balance)
        .signed_fractions(tag::BASELINE_EXPOSURE, &[capture.baseline_exposure])
        .fractions(tag::BASELINE_NOISE, &[1.0])
        .fractions(tag::BASELINE_SHARPNESS, &[1.0])
        .fractions(tag::LINEAR_RESPONSE_LIMIT, &[1.0]);
    match capture.as_shot {
        Some(AsShot::Neutral(neutral)) => root.fractions(tag::AS_SHOT_NEUTRAL, &neutral),
        Some(AsShot::White(xy)) => root.fractions(tag::AS_SHOT_WHITE_XY, &[xy.x, xy.y]),
        None => &mut root,
    };
    for (i, calibration) in (0..2).zip(&capture.calibrations) {
        calibration_tags(&mut root, calibration, i);
    }
    root.directories(tag::SUB_IFDS, vec![raw_directory(capture, storage)])
        .directories(tag::EXIF_IFD, vec![exif_directory(capture)]);
    file(&root)
}

/// Exif fields of the shot.
pub(crate) fn exif_directory(capture: &Capture) -> Ifd {
    let mut exif = Ifd::default();
    exif.fields(capture.metadata.fields().iter().filter(|f| f.directory == Directory::Exif))
        .put(tag::EXIF_VERSION, Value::Undefined(b"0230".to_vec()));
    exif
}

/// The tags of an uncompressed RGB preview.
pub(crate) fn preview_directory(ifd: &mut Ifd, capture: &Capture) {
    let (size, rgb) = preview(capture);
    ifd.longs(tag::NEW_SUBFILE_TYPE, &[1])
        .longs(tag::IMAGE_WIDTH, &[size.width])
        .longs(tag::IMAGE_LENGTH, &[size.height])
        .shorts(tag::BITS_PER_SAMPLE, &[8, 8, 8])
        .shorts(tag::COMPRESSION, &[1])
        .shorts(tag::PHOTOMETRIC, &[2])
        .pieces(tag::STRIP_OFFSETS, tag::STRIP_BYTE_COUNTS, vec![rgb])
        .shorts(tag::SAMPLES_PER_PIXEL, &[3])
        .longs(tag::ROWS_PER_STRIP, &[size.height])
        .fractions(tag::X_RESOLUTION, &[300.0])
        .fractions(tag::Y_RESOLUTION, &[300.0])
        .shorts(tag::RESOLUTION_UNIT, &[2])
        .shorts(tag::PLANAR_CONFIGURATION, &[1]);
}

fn raw_directory(capture: &Capture, storage: Storage) -> Ifd {
    let mut ifd = Ifd::default();
    let size = capture.counts.size();
    let planes = capture.counts.layout().planes();
    let area = capture.active_area;
    let crop = capture.default_crop;
    ifd.longs(tag::NEW_SUBFILE_TYPE, &[0])
        .longs(tag::IMAGE_WIDTH, &[size.width])
        .longs(tag::IMAGE_LENGTH, &[size.height])
        .shorts(tag::SAMPLES_PER_PIXEL, &[planes as u16])
        .shorts(tag::PLANAR_CONFIGURATION, &[1])
        .longs(tag::ACTIVE_AREA, &[area.y, area.x, area.bottom(), area.right()])
        .longs(tag::DEFAULT_CROP_ORIGIN, &[crop.x - area.x, crop.y - area.y])
        .longs(tag::DEFAULT_CROP_SIZE, &[crop.width, crop.height])
        .fractions(tag::DEFAULT_SCALE, &[capture.pixel_aspect, 1.0])
        .longs(tag::WHITE_LEVEL, &capture.white.0.map(|w| w.round() as usize)[..planes]);
    if let Some(user) = capture.user_crop {
        let share = |at: usize, from: usize, side: usize| (at - from) as f64 / side as f64;
        let (across, down) = (|x| share(x, crop.x, crop.width), |y| share(y, crop.y, crop.height));
        let shares = [down(user.y), across(user.x), down(user.bottom()), across(user.right())];
        ifd.fractions(tag::DEFAULT_USER_CROP, &shares);
    }
    match capture.counts.layout() {
        Layout::Cfa(cfa) => cfa_tags(&mut ifd, &cfa.shifted(area.x, area.y)),
        Layout::Monochrome | Layout::Rgb => {
            ifd.shorts(tag::PHOTOMETRIC, &[34892]); // LinearRaw
        }
    }
    black_tags(&mut ifd, &capture.black, area, planes);
    sample_tags(&mut ifd, capture, storage);
    ifd
}

fn cfa_tags(ifd: &mut Ifd, cfa: &Cfa) {
    let (width, height) = (cfa.width(), cfa.height());
    let codes = (0..width * height).map(|i| code(cfa.at(i % width, i / width))).collect();
    ifd.shorts(tag::PHOTOMETRIC, &[32803])
        .shorts(tag::CFA_REPEAT_PATTERN_DIM, &[height as u16, width as u16])
        .put(tag::CFA_PATTERN, Value::Bytes(codes))
        .put(tag::CFA_PLANE_COLOR, Value::Bytes(vec![0, 1, 2]))
        .shorts(tag::CFA_LAYOUT, &[1]);
}

/// Colour codes of TIFF/EP, 5.4.8.
pub(crate) fn code(filter: Filter) -> u8 {
    match filter {
        Filter::Red => 0,
        Filter::Green => 1,
        Filter::Blue => 2,
        Filter::Other('C') => 3,
        Filter::Other('M') => 4,
        Filter::Other('Y') => 5,
        Filter::Other(_) => 6,
    }
}

/// DNG counts black levels from the top left corner of the active area.
fn black_tags(ifd: &mut Ifd, black: &BlackLevel, area: Rect, planes: usize) {
    let bare = BlackLevel { row_deltas: Vec::new(), column_deltas: Vec::new(), ..black.clone() };
    let mut values = Vec::new();
    for y in 0..black.rows {
        for x in 0..black.columns {
            values.extend((0..planes).map(|p| f64::from(bare.at(area.x + x, area.y + y, p))));
        }
    }
    ifd.shorts(tag::BLACK_LEVEL_REPEAT_DIM, &[black.rows as u16, black.columns as u16])
        .fractions(tag::BLACK_LEVEL, &values);
    for (tag, deltas, from, to) in [
        (tag::BLACK_LEVEL_DELTA_H, &black.column_deltas, area.x, area.right()),
        (tag::BLACK_LEVEL_DELTA_V, &black.row_deltas, area.y, area.bottom()),
    ] {
        if let Some(deltas) = deltas.get(from..to) {
            let deltas: Vec<f64> = deltas.iter().map(|&d| f64::from(d)).collect();
            ifd.signed_fractions(tag, &deltas);
        }
    }
}

fn calibration_tags(root: &mut Ifd, calibration: &Calibration, i: u16) {
    let rows = |m: &Matrix3| -> Vec<f64> { m.transpose().iter().copied().collect() };
    root.signed_fractions(tag::COLOR_MATRIX_1 + i, &rows(&calibration.color_matrix));
    if let Some(kelvin) = calibration.kelvin {
        root.shorts(tag::CALIBRATION_ILLUMINANT_1 + i, &[light_source(kelvin)]);
    }
    if let Some(forward) = &calibration.forward_matrix {
        root.signed_fractions(tag::FORWARD_MATRIX_1 + i, &rows(forward));
    }
    if let Some(specimen) = &calibration.camera_calibration {
        root.signed_fractions(tag::CAMERA_CALIBRATION_1 + i, &rows(specimen));
    }
}

/// Exif code (tag LightSource) of the standard illuminant nearest to `kelvin`: A, D50, D55, D65, D75.
fn light_source(kelvin: f64) -> u16 {
    let lights = [(2856.0, 17), (5003.0, 23), (5503.0, 20), (6504.0, 21), (7504.0, 22)];
    let distance = |k: f64| (1e6 / k - 1e6 / kelvin).abs();
    lights.into_iter().min_by(|a, b| distance(a.0).total_cmp(&distance(b.0))).map_or(0, |(_, code)| code)
}

fn is_float(capture: &Capture) -> bool {
    matches!(capture.counts, Counts::F32(_))
}

fn sample_tags(ifd: &mut Ifd, capture: &Capture, storage: Storage) {
    let size = capture.counts.size();
    let planes = capture.counts.layout().planes();
    let strip = |ifd: &mut Ifd, compression: u16, bits: u16, bytes: Vec<u8>| {
        ifd.shorts(tag::BITS_PER_SAMPLE, &vec![bits; planes])
            .shorts(tag::COMPRESSION, &[compression])
            .longs(tag::ROWS_PER_STRIP, &[size.height])
            .pieces(tag::STRIP_OFFSETS, tag::STRIP_BYTE_COUNTS, vec![bytes]);
    };
    let samples = match &capture.counts {
        Counts::F32(mosaic) => {
            let bytes = mosaic.samples.iter().flat_map(|s| s.to_le_bytes()).collect();
            strip(ifd, 1, 32, bytes);
            ifd.shorts(tag::SAMPLE_FORMAT, &vec![3; planes]);
            return;
        }
        Counts::U16(mosaic) => &mosaic.samples,
    };
    let largest = samples.iter().copied().max().unwrap_or(0);
    let needed = (16 - largest.leading_zeros()).max(2) as u8;
    let bits = capture.source.bits.clamp(needed, 16);
    match storage {
        Storage::Uncompressed => {
            strip(ifd, 1, 16, samples.iter().flat_map(|s| s.to_le_bytes()).collect());
        }
        Storage::JpegTiles if size.width >= TILE => {
            let mut tiles = Vec::new();
            for y in (0..size.height).step_by(TILE) {
                for x in (0..size.width).step_by(TILE) {
                    let tile = tile(samples, size.width, size.height, planes, (x, y));
                    tiles.push(ljpeg::encode(&tile, TILE * planes, components(planes, TILE), bits));
                }
            }
            ifd.shorts(tag::BITS_PER_SAMPLE, &vec![u16::from(bits); planes])
                .shorts(tag::COMPRESSION, &[7])
                .longs(tag::TILE_WIDTH, &[TILE])
                .longs(tag::TILE_LENGTH, &[TILE])
                .pieces(tag::TILE_OFFSETS, tag::TILE_BYTE_COUNTS, tiles);
        }
        Storage::JpegStrip | Storage::JpegTiles => {
            let bytes = ljpeg::encode(samples, size.width * planes, components(planes, size.width), bits);
            strip(ifd, 7, u16::from(bits), bytes);
        }
    }
}

/// JPEG components: the colours of a pixel, or two neighbours of a filter array, so that each sample is predicted
/// from one of its own colour.
fn components(planes: usize, width: usize) -> usize {
    if planes == 1 && width.is_multiple_of(2) { 2 } else { planes }
}

/// One tile, the last column and row repeated where it reaches beyond the picture.
fn tile(samples: &[u16], width: usize, height: usize, planes: usize, (x, y): (usize, usize)) -> Vec<u16> {
    let mut tile = Vec::with_capacity(TILE * TILE * planes);
    for row in (y..y + TILE).map(|row| row.min(height - 1)) {
        for column in (x..x + TILE).map(|column| column.min(width - 1)) {
            let at = (row * width + column) * planes;
            tile.extend_from_slice(&samples[at..at + planes]);
        }
    }
    tile
}
