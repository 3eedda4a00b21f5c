use super::*;

/// `.cube` of 2^3 nodes that swaps red and blue.
const SWAP: &str = "# comment\nTITLE \"swap\"\nLUT_3D_SIZE 2\nDOMAIN_MIN 0 0 0\nDOMAIN_MAX 1 1 1\n\
                    0 0 0\n0 0 1\n0 1 0\n0 1 1\n1 0 0\n1 0 1\n1 1 0\n1 1 1\n";

fn close(a: [f32; 3], b: [f32; 3]) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-5)
}

fn clf(steps: &str) -> String {
    format!(
        "<?xml version=\"1.0\"?><ProcessList xmlns=\"urn:AMPAS:CLF:v3.0\" id=\"1\" compCLFversion=\"3.0\">\
         <Description>test</Description>{steps}</ProcessList>"
    )
}

#[test]
fn cube_files_are_read_with_red_fastest_ranges_and_a_curve_before_the_table() {
    let swap = parse(SWAP).unwrap();
    for v in [[0.1, 0.5, 0.9], [1.0, 0.0, 0.3]] {
        assert!(close(swap.at(v), [v[2], v[1], v[0]]), "{v:?}");
    }
    let half =
        parse("LUT_1D_SIZE 3\nDOMAIN_MIN -1 -1 -1\nDOMAIN_MAX 1 1 1\n0 0 0\n0.5 0.5 0.5\n1 1 1\n").unwrap();
    assert!(half.is_one_curve() && close(half.at([-1.0, 0.0, 0.5]), [0.0, 0.5, 0.75]));
    let both = SWAP.replace(
        "LUT_3D_SIZE 2\nDOMAIN_MIN 0 0 0\nDOMAIN_MAX 1 1 1\n",
        "LUT_1D_SIZE 2\nLUT_1D_INPUT_RANGE 0 2\nLUT_3D_SIZE 2\nLUT_3D_INPUT_RANGE 0 1\n0 0 0\n1 1 1\n",
    );
    assert!(close(parse(&both).unwrap().at([0.4, 1.0, 2.0]), [1.0, 0.5, 0.2]));
}

#[test]
fn steps_of_clf_count_in_the_bits_that_they_state() {
    let steps = "<Matrix inBitDepth=\"10i\" outBitDepth=\"10i\"><Array dim=\"3 4 4\">0 1 0 102.3\n1 0 0 0\n0 0 1 0</Array></Matrix>\
                 <LUT1D inBitDepth=\"10i\" outBitDepth=\"8i\"><Array dim=\"2 1\">0 51</Array></LUT1D>";
    assert!(close(parse(&clf(steps)).unwrap().at([0.5, 0.25, 1.0]), [0.07, 0.1, 0.2]));
    let steps = "<Range inBitDepth=\"8i\" outBitDepth=\"32f\"><minInValue>51</minInValue><maxInValue>255</maxInValue>\
                 <minOutValue>0</minOutValue><maxOutValue>1</maxOutValue></Range>";
    assert!(close(parse(&clf(steps)).unwrap().at([0.1, 0.6, 2.0]), [0.0, 0.5, 1.0]));
    let steps = "<Log inBitDepth=\"32f\" outBitDepth=\"32f\" style=\"log2\"/>";
    assert!(close(parse(&clf(steps)).unwrap().at([0.25, 1.0, 8.0]), [-2.0, 0.0, 3.0]));
    let steps = "<LUT1D inBitDepth=\"16f\" outBitDepth=\"16f\" rawHalfs=\"true\"><Array dim=\"2 1\">0 14336</Array></LUT1D>";
    assert!(close(parse(&clf(steps)).unwrap().at([0.0, 0.5, 1.0]), [0.0, 0.25, 0.5]));
    let steps = "<Exponent inBitDepth=\"32f\" outBitDepth=\"32f\" style=\"basicFwd\"><ExponentParams channel=\"G\" exponent=\"2\"/></Exponent>";
    let lut = parse(&clf(steps)).unwrap();
    assert!(!lut.is_one_curve() && close(lut.at([0.5, 0.5, 0.5]), [0.5, 0.25, 0.5]));
}

#[test]
fn broken_files_are_sentences() {
    let good = clf(
        "<LUT3D inBitDepth=\"32f\" outBitDepth=\"32f\"><Array dim=\"2 2 2 3\">0 0 0 0 0 1 0 1 0 0 1 1 1 0 0 1 0 1 1 1 0 1 1 1</Array></LUT3D>",
    );
    assert!(parse(&good).is_ok());
    let cases = [
        (SWAP.to_owned(), "LUT_3D_SIZE 2", "LUT_3D_SIZE 3"),
        (SWAP.to_owned(), "LUT_3D_SIZE 2", "LUT_3D_SIZE 1"),
        (SWAP.to_owned(), "LUT_3D_SIZE 2", "LUT_3D_SIZE 99999999999999999999"),
        (SWAP.to_owned(), "LUT_3D_SIZE 2", ""),
        (SWAP.to_owned(), "DOMAIN_MAX 1", "DOMAIN_MAX 0"),
        (SWAP.to_owned(), "\n0 1 1", "\n0 nan 1"),
        (SWAP.to_owned(), "\n0 1 1", "\nfilm"),
        (SWAP.to_owned(), "\n0 1 1", "\n0 1 1 1"),
        (good.clone(), "2 2 2 3", "2 2 3 3"),
        (good.clone(), "2 2 2 3", "3 3 3 3"),
        (good.clone(), "2 2 2 3", "99999999999 99999999999 99999999999 3"),
        (good.clone(), ">0 0 0", ">0 NaN 0"),
        (good.clone(), "32f", "24i"),
        (good.clone(), "LUT3D", "LUT4D"),
        (good.clone(), "ProcessList", "Process"),
        (good, "</Array>", "<Array>"),
        (clf("<Log inBitDepth=\"32f\" outBitDepth=\"32f\" style=\"log2\"/>"), "log2", "log3"),
        (clf(&"<Log inBitDepth=\"32f\" outBitDepth=\"32f\" style=\"log2\"/>".repeat(65)), "test", "many"),
        (clf(""), "test", "nothing"),
    ];
    for (text, from, to) in cases {
        assert!(text.contains(from), "{from}");
        let fault = parse(&text.replace(from, to)).unwrap_err().to_string();
        assert!(!fault.contains('\n') && fault.len() < 300, "{fault}");
    }
}
