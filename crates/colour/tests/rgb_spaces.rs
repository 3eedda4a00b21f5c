//! RGB spaces and their curves against colour-science 0.4.7: `RGB_COLOURSPACES[name]` with
//! `use_derived_matrix_RGB_to_XYZ = True`, its `matrix_RGB_to_XYZ`, `cctf_encoding` of 0.001, 0.01, 0.18, 0.5 and
//! `cctf_decoding` of 0.01, 0.05, 0.18, 0.5.

use darkroot_colour::{Matrix3, RgbSpace, TransferCurve};

#[test]
fn matrices_are_those_of_colour_science() {
    #[rustfmt::skip]
    let published = [
        (RgbSpace::SRGB, 1e-11, Matrix3::new(
            0.412390799266, 0.357584339384, 0.180480788402,
            0.212639005872, 0.715168678768, 0.072192315361,
            0.019330818716, 0.119194779795, 0.95053215225,
        )),
        (RgbSpace::DISPLAY_P3, 1e-11, Matrix3::new(
            0.486570948648, 0.265667693169, 0.198217285234,
            0.22897456407, 0.691738521837, 0.079286914094,
            0.0, 0.045113381859, 1.043944368901,
        )),
        (RgbSpace::ADOBE_RGB, 1e-11, Matrix3::new(
            0.57666904291, 0.185558237907, 0.188228646235,
            0.297344975251, 0.627363566255, 0.075291458494,
            0.027031361386, 0.070688852536, 0.991337536838,
        )),
        (RgbSpace::PROPHOTO, 1e-11, Matrix3::new(
            0.797760489672, 0.135185837176, 0.031349349582,
            0.288071128229, 0.71184321781, 0.000085653961,
            0.0, 0.0, 0.82510460251,
        )),
        (RgbSpace::REC2020, 1e-11, Matrix3::new(
            0.636958048301, 0.144616903586, 0.168880975164,
            0.262700212011, 0.677998071519, 0.05930171647,
            0.0, 0.028072693049, 1.060985057711,
        )),
        // colour-science has the primaries to more digits than ISO 22028-4: 0.670103, 0.329897 for red.
        (RgbSpace::ECIRGB_V2, 6e-4, Matrix3::new(
            0.650324383303, 0.177949000351, 0.136022292775,
            0.320159696395, 0.601827518042, 0.078012785562,
            0.0, 0.067980516988, 0.757124085522,
        )),
        (RgbSpace::ACES2065_1, 1e-11, Matrix3::new(
            0.952552395938, 0.0, 0.000093678632,
            0.343966449765, 0.728166096613, -0.072132546379,
            0.0, 0.0, 1.008825184352,
        )),
        (RgbSpace::ACESCG, 1e-11, Matrix3::new(
            0.662454181109, 0.134004206456, 0.156187687005,
            0.272228716781, 0.674081765811, 0.053689517408,
            -0.00557464949, 0.004060733529, 1.010339100313,
        )),
    ];
    for (space, tolerance, expected) in published {
        let found = space.to_xyz();
        assert!((found - expected).amax() < tolerance, "{}: {found}", space.name);
    }
}

#[test]
fn curves_are_those_of_colour_science() {
    const LINEAR: [f64; 4] = [0.001, 0.01, 0.18, 0.5];
    const ENCODED: [f64; 4] = [0.01, 0.05, 0.18, 0.5];
    for (curve, tolerance, encoding, decoding) in [
        (
            TransferCurve::Srgb,
            1e-12,
            [0.01292, 0.09985282273412832, 0.46135612950044164, 0.7353569830524495],
            [0.0007739938080495357, 0.003935939504088967, 0.027211780951381357, 0.21404114048223255],
        ),
        (
            RgbSpace::ADOBE_RGB.curve,
            1e-12,
            [0.043239356144868325, 0.12319303243503295, 0.45852946567989455, 0.7296583817678015],
            [3.9954205589498866e-05, 0.0013764183035726999, 0.023024029316635188, 0.21775552814439456],
        ),
        (
            TransferCurve::Romm,
            1e-12,
            [0.016, 0.0774263682681127, 0.3857114247511376, 0.6803950000871885],
            [0.000625, 0.0045514105075652005, 0.04565522728706038, 0.2871745887492587],
        ),
        // The printed constants of BT.2020 (1.099, 0.018) there, those that make the curve smooth here.
        (
            TransferCurve::Rec2020,
            3e-4,
            [0.0045, 0.045, 0.4090077288641504, 0.7055150899221212],
            [0.0022222222222222222, 0.011111111111111112, 0.04752294624529034, 0.25958940050628576],
        ),
        (
            TransferCurve::LStar,
            1e-12,
            [0.00903296296296297, 0.08991442404369852, 0.49496107610119594, 0.7606926101415558],
            [0.0011070564598794526, 0.005535282299397271, 0.02518040920086924, 0.18418651851244416],
        ),
    ] {
        for i in 0..4 {
            let (encoded, linear) = (curve.encode(LINEAR[i]), curve.decode(ENCODED[i]));
            assert!((encoded - encoding[i]).abs() < tolerance, "{curve:?}: {encoded}, not {}", encoding[i]);
            assert!((linear - decoding[i]).abs() < tolerance, "{curve:?}: {linear}, not {}", decoding[i]);
        }
    }
}
