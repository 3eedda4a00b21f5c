//! What tests make themselves and read back.

/// A kind of file that a test makes.
pub(crate) struct Synthetic {
    pub(crate) maker: &'static str,
    /// Container, compression, bits, layout.
    pub(crate) kind: &'static str,
    /// Where the test is.
    pub(crate) file: &'static str,
    pub(crate) test: &'static str,
    /// Another reader that finds the same samples in such a file, and the script that asks it.
    pub(crate) oracle: &'static str,
}

const READ_BACK: &str = "crates/simulate/tests/flashraw_reads_them.rs";
const FLOATS: &str = "crates/raw/tests/float_jpeg_xl.rs";
const MENDED: &str = "crates/raw/tests/mended.rs";
const EMBEDDED: &str = "crates/cli/tests/program/embedded.rs";
const NEF_SCRIPT: &str = "LibRaw (`tests/interop/nef.py`)";
const DNG_SCRIPT: &str = "Adobe DNG SDK (`tests/interop/dng.py`)";
const ANY: &str = "DNG of any maker";
const TRUTH: &str = "the samples it was made of";

const fn nikon(
    kind: &'static str,
    file: &'static str,
    test: &'static str,
    oracle: &'static str,
) -> Synthetic {
    Synthetic { maker: "Nikon", kind, file, test, oracle }
}

const fn dng(kind: &'static str, file: &'static str, test: &'static str, oracle: &'static str) -> Synthetic {
    Synthetic { maker: ANY, kind, file, test, oracle }
}

/// Kinds that only a script makes, beside another reader: `case` is how the script calls them.
const fn by_script(
    maker: &'static str,
    kind: &'static str,
    case: &'static str,
    oracle: &'static str,
) -> Synthetic {
    let file =
        if matches!(maker.as_bytes(), b"Nikon") { "tests/interop/nef.py" } else { "tests/interop/dng.py" };
    Synthetic { maker, kind, file, test: case, oracle }
}

/// All of them.
pub(crate) const SYNTHETIC: &[Synthetic] = &[
    nikon(
        "NEF, uncompressed, 12 bits packed",
        READ_BACK,
        "every_storage_of_nef_gives_back_the_samples",
        NEF_SCRIPT,
    ),
    nikon(
        "NEF, uncompressed, 14 bits in words",
        READ_BACK,
        "every_storage_of_nef_gives_back_the_samples",
        NEF_SCRIPT,
    ),
    nikon(
        "NEF, lossless, 12 and 14 bits",
        READ_BACK,
        "every_storage_of_nef_gives_back_the_samples",
        NEF_SCRIPT,
    ),
    nikon(
        "NEF, lossy (type 1), 12 and 14 bits",
        READ_BACK,
        "lossy_nef_gives_back_what_the_curve_and_dropped_bits_leave",
        NEF_SCRIPT,
    ),
    nikon(
        "NEF, lossy with split (type 2), 12 and 14 bits",
        READ_BACK,
        "lossy_nef_gives_back_what_the_curve_and_dropped_bits_leave",
        NEF_SCRIPT,
    ),
    nikon(
        "NEF, 12 bits packed from the lowest bit up (told by the samples)",
        MENDED,
        "nikon_s_packed_samples_are_read_in_the_order_that_makes_a_picture",
        TRUTH,
    ),
    nikon(
        "NEF, 14 bits packed either way (told by the samples)",
        MENDED,
        "nikon_s_packed_samples_are_read_in_the_order_that_makes_a_picture",
        TRUTH,
    ),
    nikon(
        "NEF, High Efficiency: refused; the embedded JPEG by `--from-preview`",
        EMBEDDED,
        "the_embedded_jpeg_is_developed_as_the_camera_rendered_it_and_says_so",
        TRUTH,
    ),
    by_script("Nikon", "NEF, small (sNEF)", "small (sNEF)", NEF_SCRIPT),
    by_script("Nikon", "NEF of Z cameras, rows padded to 16 bytes", "rows padded to 16 bytes", NEF_SCRIPT),
    by_script(
        ANY,
        "uncompressed, 8 to 16 bits, either byte order",
        "integer {bits} {way}-endian",
        DNG_SCRIPT,
    ),
    by_script(
        ANY,
        "uncompressed floating point, 16, 24 and 32 bits",
        "float {bits} {way}-endian",
        DNG_SCRIPT,
    ),
    by_script(
        ANY,
        "deflated floating point, 16, 24 and 32 bits, every predictor",
        "deflate float {bits} predictor {predictor}",
        DNG_SCRIPT,
    ),
    by_script(
        ANY,
        "deflated integers, 8 and 16 bits, every predictor",
        "deflate {bits} predictor",
        DNG_SCRIPT,
    ),
    by_script(ANY, "JPEG XL, 8 to 16 bits, Bayer and linear", "JPEG XL {bits} {way}-endian", DNG_SCRIPT),
    by_script(ANY, "JPEG XL with loss, integer and floating point", "JPEG XL float 16 lossy", DNG_SCRIPT),
    by_script(ANY, "lossless JPEG, 8 to 16 bits", "lossless JPEG {bits}", DNG_SCRIPT),
    dng("uncompressed, 16 bits", READ_BACK, "every_storage_of_dng_gives_back_the_samples", DNG_SCRIPT),
    dng(
        "lossless JPEG in strips and tiles",
        READ_BACK,
        "every_storage_of_dng_gives_back_the_samples",
        DNG_SCRIPT,
    ),
    dng("every Bayer order, X-Trans, masked borders", READ_BACK, "every_filter_array_arrives", TRUTH),
    dng("black levels by row and column", READ_BACK, "black_levels_arrive_with_their_drift", TRUTH),
    dng("floating point, 32 bits", READ_BACK, "floating_point_samples_arrive_as_they_are", DNG_SCRIPT),
    dng(
        "JPEG XL, floating point, strips and tiles, either byte order",
        FLOATS,
        "every_sample_arrives_bit_for_bit_from_strips_and_tiles_of_both_byte_orders",
        DNG_SCRIPT,
    ),
    dng(
        "rows and columns stored in fields",
        MENDED,
        "rows_and_columns_in_fields_come_together_as_adobe_s_sdk_has_it",
        DNG_SCRIPT,
    ),
    dng("deflate, 8 bits, every predictor", MENDED, "differences_of_8_bits_are_summed_in_8_bits", DNG_SCRIPT),
];
