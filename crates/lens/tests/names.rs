//! Names as cameras write them, and the lenses that they mean.

#![allow(clippy::unwrap_used)] // Clippy takes the helpers of tests for production code.

use darkroot_lens::{Found, Shot, find};

/// Exif `Make`, `Model`, `LensMake`, `LensModel` (or what the maker note has), focal length in mm, and a lens of the
/// database.
type Row = (&'static str, &'static str, &'static str, &'static str, f64, &'static str);

#[rustfmt::skip] // A line each.
const BY_NAME: [Row; 58] = [
    ("NIKON CORPORATION", "NIKON Z 6", "", "NIKKOR Z 24-70mm f/4 S", 24.0, "Nikkor Z 24-70mm f/4 S"),
    ("NIKON CORPORATION", "NIKON Z 6_2", "NIKON", "NIKKOR Z 24-70mm f/2.8 S", 35.0, "Nikkor Z 24-70mm f/2.8 S"),
    ("NIKON CORPORATION", "NIKON Z 50", "NIKON", "NIKKOR Z DX 16-50mm f/3.5-6.3 VR", 16.0, "Nikkor Z DX 16-50mm f/3.5-6.3 VR"),
    ("NIKON CORPORATION", "NIKON Z 6", "NIKON", "NIKKOR Z 50mm f/1.8 S", 50.0, "Nikkor Z 50mm f/1.8 S"),
    ("NIKON CORPORATION", "NIKON Z 6", "", "AF-S NIKKOR 50mm f/1.8G", 50.0, "Nikon AF-S Nikkor 50mm f/1.8G"),
    ("NIKON CORPORATION", "NIKON D5000", "", "AF-S DX VR Zoom-Nikkor 18-55mm f/3.5-5.6G", 18.0, "Nikon AF-S DX Zoom-Nikkor 18-55mm f/3.5-5.6G VR"),
    ("NIKON CORPORATION", "NIKON D5300", "", "AF-S DX VR Nikkor 18-55mm f/3.5-5.6G II", 18.0, "Nikon AF-S DX VR Nikkor 18-55mm f/3.5-5.6G II"),
    ("NIKON CORPORATION", "NIKON D5000", "", "AF-S DX Nikkor 35mm f/1.8G", 35.0, "Nikon AF-S DX Nikkor 35mm f/1.8G"),
    ("NIKON CORPORATION", "NIKON D700", "", "AF-S Zoom-Nikkor 24-70mm f/2.8G ED", 24.0, "Nikon AF-S Zoom-Nikkor 24-70mm f/2.8G ED"),
    ("NIKON CORPORATION", "NIKON D700", "", "AF-S Nikkor 50mm f/1.8G", 50.0, "Nikon AF-S Nikkor 50mm f/1.8G"),
    ("NIKON CORPORATION", "NIKON D750", "", "AF-S Nikkor 24-120mm f/4G ED VR", 70.0, "Nikon AF-S Nikkor 24-120mm f/4G ED VR 170"),
    ("NIKON CORPORATION", "NIKON D7000", "", "Tokina AT-X 116 PRO DX (AF 11-16mm f/2.8)", 11.0, "Tokina 11-16mm f/2.8 AT-X 116 AF Pro DX"),
    ("Canon", "Canon EOS 550D", "", "EF-S18-55mm f/3.5-5.6 IS", 18.0, "Canon EF-S 18-55mm f/3.5-5.6 IS"),
    ("Canon", "Canon EOS 550D", "", "Canon EF-S18-55mm f/3.5-5.6 IS II", 18.0, "Canon EF-S 18-55mm f/3.5-5.6 IS II"),
    ("Canon", "Canon EOS 350D DIGITAL", "", "EF-S18-55mm f/3.5-5.6", 18.0, "Canon EF-S 18-55mm f/3.5-5.6"),
    ("Canon", "Canon EOS 550D", "", "EF50mm f/1.8 II", 50.0, "Canon EF 50mm f/1.8 MkII"),
    ("Canon", "Canon EOS 5D Mark III", "", "EF24-70mm f/2.8L II USM", 50.0, "Canon EF 24-70mm f/2.8L II USM"),
    ("Canon", "Canon EOS 5D Mark III", "", "EF24-105mm f/4L IS USM", 50.0, "Canon EF 24-105mm f/4L IS USM"),
    ("Canon", "Canon EOS 6D", "", "EF70-200mm f/2.8L IS II USM", 100.0, "Canon EF 70-200mm f/2.8L IS II USM"),
    ("Canon", "Canon EOS R6", "", "EF100mm f/2.8L Macro IS USM", 100.0, "Canon EF 100mm f/2.8L Macro IS USM"),
    ("Canon", "Canon EOS R5", "Canon", "RF24-105mm F4 L IS USM", 24.0, "Canon RF 24-105mm F4L IS USM"),
    ("Canon", "Canon EOS R", "Canon", "RF35mm F1.8 MACRO IS STM", 35.0, "Canon RF 35mm F1.8 MACRO IS STM"),
    ("Canon", "Canon EOS M50", "", "EF-M15-45mm f/3.5-6.3 IS STM", 15.0, "Canon EF-M 15-45mm f/3.5-6.3 IS STM"),
    ("Canon", "Canon EOS 7D", "", "Sigma 17-50mm f/2.8 EX DC OS HSM", 20.0, "Sigma 17-50mm f/2.8 EX DC OS HSM"),
    ("Canon", "Canon EOS 6D", "", "35mm F1.4 DG HSM | Art 012", 35.0, "Sigma 35mm f/1.4 DG HSM | A"),
    ("Canon", "Canon EOS 6D", "", "TAMRON SP 24-70mm F/2.8 Di VC USD A007", 35.0, "Tamron SP 24-70mm f/2.8 Di VC USD"),
    ("SONY", "ILCE-7M3", "", "FE 24-70mm F2.8 GM", 24.0, "Sony FE 24-70mm f/2.8 GM"),
    ("SONY", "ILCE-7M3", "", "FE 24-70mm F2.8 GM II", 24.0, "Sony FE 24-70mm f/2.8 GM II"),
    ("SONY", "ILCE-7M3", "", "FE 24-105mm F4 G OSS", 24.0, "Sony FE 24-105mm f/4 G OSS"),
    ("SONY", "ILCE-7RM3", "", "FE 55mm F1.8 ZA", 55.0, "Sony FE 55mm f/1.8 ZA"),
    ("SONY", "ILCE-7M3", "", "FE 35mm F1.4 GM", 35.0, "Sony FE 35mm f/1.4 GM (SEL35F14GM)"),
    ("SONY", "ILCE-6000", "", "E PZ 16-50mm F3.5-5.6 OSS", 16.0, "Sony E PZ 16-50mm f/3.5-5.6 OSS"),
    ("SONY", "ILCE-6300", "", "E 35mm F1.8 OSS", 35.0, "Sony E 35mm f/1.8 OSS"),
    ("SONY", "ILCE-6500", "", "30mm F1.4 DC DN | Contemporary 016", 30.0, "SIGMA 30mm f/1.4 DC DN | Contemporary C 016"),
    ("SONY", "ILCE-7M3", "", "24-70mm F2.8 DG DN | Art 019", 28.0, "Sigma 24-70mm F2.8 DG DN | Art 019"),
    ("SONY", "ILCE-7M3", "", "E 28-75mm F2.8-2.8", 28.0, "Tamron E 28-75mm F2.8-2.8"),
    ("SONY", "SLT-A77V", "", "DT 16-50mm F2.8 SSM", 20.0, "Sony DT 16-50mm f/2.8 SSM (SAL1650)"),
    ("FUJIFILM", "X-T1", "FUJIFILM", "XF18-55mmF2.8-4 R LM OIS", 18.0, "Fujifilm XF18-55mmF2.8-4 R LM OIS"),
    ("FUJIFILM", "X-T3", "FUJIFILM", "XF16-55mmF2.8 R LM WR", 18.0, "Fujifilm XF16-55mmF2.8 R LM WR"),
    ("FUJIFILM", "X-E1", "FUJIFILM", "XF35mmF1.4 R", 35.0, "Fujifilm XF35mmF1.4 R"),
    ("FUJIFILM", "X-T20", "FUJIFILM", "XC16-50mmF3.5-5.6 OIS II", 35.0, "Fujifilm XC16-50mmF3.5-5.6 OIS II"),
    ("OLYMPUS IMAGING CORP.  ", "E-M5            ", "OLYMPUS", "OLYMPUS M.12-40mm F2.8", 12.0, "Olympus M.Zuiko Digital ED 12-40mm f/2.8 Pro"),
    ("OLYMPUS CORPORATION", "E-M10MarkII", "OLYMPUS", "OLYMPUS M.14-42mm F3.5-5.6 EZ", 14.0, "Olympus M.Zuiko Digital ED 14-42mm f/3.5-5.6 EZ"),
    ("OLYMPUS CORPORATION", "E-M1", "OLYMPUS", "OLYMPUS M.45mm F1.8", 45.0, "Olympus M.Zuiko Digital 45mm f/1.8"),
    ("OM Digital Solutions", "OM-1", "OLYMPUS", "OLYMPUS M.12-100mm F4.0", 45.0, "Olympus M.Zuiko Digital ED 12-100mm f/4.0 IS Pro"),
    ("Panasonic", "DMC-GX7", "", "LUMIX G 20/F1.7 II", 20.0, "Panasonic Lumix G 20mm f/1.7 II Asph."),
    ("Panasonic", "DMC-GX80", "", "LUMIX G VARIO 12-32/F3.5-5.6", 20.0, "Panasonic Lumix G Vario 12-32mm f/3.5-5.6 Asph. Mega OIS"),
    ("Panasonic", "DC-G9", "", "LEICA DG 12-60/F2.8-4.0", 20.0, "Panasonic LEICA DG 12-60/F2.8-4.0"),
    ("Panasonic", "DMC-GH4", "Panasonic", "LUMIX G VARIO 14-140/F3.5-5.6", 20.0, "Panasonic Lumix G Vario 14-140mm f/3.5-5.6"),
    ("Panasonic", "DC-S5", "Panasonic", "LUMIX S 20-60/F3.5-5.6", 20.0, "Panasonic Lumix S 20-60/F3.5-5.6"),
    ("PENTAX", "PENTAX K-5", "", "smc PENTAX-DA* 16-50mm F2.8 ED AL [IF] SDM", 18.0, "Pentax smc Pentax-DA* 16-50mm f/2.8 ED AL IF SDM"),
    ("RICOH IMAGING COMPANY, LTD.", "PENTAX K-1", "", "HD PENTAX-D FA 24-70mm F2.8ED SDM WR", 24.0, "Pentax HD Pentax-D FA 24-70mm f/2.8 ED SDM WR"),
    ("Canon", "Canon PowerShot S95", "", "", 6.0, "Canon PowerShot S95 & compatibles"),
    ("SONY", "DSC-RX100M3", "", "24-70mm F1.8-2.8", 8.8, "Sony DSC-RX100 III & compatibles"),
    ("FUJIFILM", "X100V", "FUJIFILM", "", 23.0, "Fujifilm X100V & compatibles"),
    ("RICOH IMAGING COMPANY, LTD.", "GR", "", "GR LENS", 18.3, "Ricoh GR & compatibles"),
    ("LEICA CAMERA AG", "LEICA Q2", "", "SUMMILUX 1:1.7/28 ASPH.", 28.0, "LEICA CAMERA AG LEICA Q2 & compatibles"),
    ("Panasonic", "DMC-LX100", "", "", 10.9, "Leica DMC-LX100 & compatibles"),
];

/// Only focal lengths and f-numbers, as Nikon writes them into `LensModel`.
#[rustfmt::skip]
const BY_NUMBERS: [Row; 3] = [
    ("NIKON CORPORATION", "NIKON D7500", "", "16.0-80.0 mm f/2.8-4.0", 24.0, "Nikon AF-S DX Nikkor 16-80mm f/2.8-4E ED VR"),
    ("NIKON CORPORATION", "NIKON D850", "", "200.0-500.0 mm f/5.6", 300.0, "Nikon AF-S Nikkor 200-500mm f/5.6E ED VR"),
    ("NIKON CORPORATION", "NIKON D850", "NIKON", "24.0-120.0 mm f/4.0", 50.0, "Nikon AF-S Nikkor 24-120mm f/4G ED VR 170"),
];

/// With why there is no match.
#[rustfmt::skip]
const NOT_FOUND: [Row; 20] = [
    ("NIKON CORPORATION", "NIKON D5500", "", "18.0-55.0 mm f/3.5-5.6", 24.0, "several lenses have these numbers"),
    ("NIKON CORPORATION", "NIKON D850", "", "24.0-70.0 mm f/2.8", 24.0, "several lenses have these numbers"),
    ("NIKON CORPORATION", "NIKON D7500", "", "50.0 mm f/1.8", 50.0, "no zoom lens"),
    ("NIKON CORPORATION", "NIKON D90", "", "NIKKOR Z 24-70mm f/4 S", 50.0, "fits no D90"),
    ("NIKON CORPORATION", "NIKON D5000", "", "AF-S DX VR Zoom-Nikkor 18-55mm f/3.5-5.6G", 85.0, "has no 85 mm"),
    ("NIKON CORPORATION", "NIKON Z 6", "Viltrox", "NIKKOR Z 24-70mm f/4 S", 24.0, "of another maker"),
    ("Canon", "Canon EOS 550D", "", "EF-S18-55mm f/3.5-5.6 IS III", 35.0, "there is no third"),
    ("Canon", "Canon EOS 6D", "", "EF70-200mm f/2.8L IS II USM +1.4x", 200.0, "with a converter"),
    ("Canon", "Canon EOS 6D", "", "EF70-200mm f/2.8L IS II USM", 280.0, "with a converter that is not written"),
    ("Canon", "Canon EOS 550D", "", "50mm", 50.0, "anybody's"),
    ("Canon", "Canon EOS 550D", "", "18-55mm", 20.0, "anybody's"),
    ("Canon", "Canon EOS 550D", "", "----", 50.0, "no name"),
    ("Canon", "Canon EOS 550D", "", "", 50.0, "no name"),
    ("Canon", "Canon EOS 6D", "", "150-600mm F5-6.3 DG OS HSM", 300.0, "one of two lines"),
    ("SONY", "ILCE-7M3", "", "EF24-70mm f/2.8L II USM", 50.0, "on an adapter that the database does not know"),
    ("SONY", "ILCE-7M3", "", "FE 24-70mm F2.8", 50.0, "only part of a name"),
    ("RICOH IMAGING COMPANY, LTD.", "PENTAX K-3", "", "HD PENTAX-DA 15mm F4 ED AL Limited", 15.0, "only the one with the older coating is known"),
    ("Acme", "Nonesuch", "", "NIKKOR Z 24-70mm f/4 S", 35.0, "no crop factor"),
    ("Canon", "Canon PowerShot S95", "", "", 400.0, "not its lens"),
    ("Panasonic", "DMC-LX3", "", "", 5.1, "frames of four shapes, each with a crop factor"),
];

fn shot<'a>((make, model, lens_make, lens, focal, _): &'a Row) -> Shot<'a> {
    let said = |text: &'a str| Some(text).filter(|t| !t.is_empty());
    Shot { lens_make: said(lens_make), lens_model: said(lens), ..Shot::new(make, model, *focal) }
}

#[test]
fn names_lead_to_their_lenses() {
    let mut wrong = Vec::new();
    for row in BY_NAME.iter().chain(&BY_NUMBERS) {
        let found = find(&shot(row));
        // The maker stands before the model where the model does not begin with it.
        if !found
            .as_ref()
            .is_some_and(|found| found.lens == row.5 || found.lens.ends_with(&format!(" {}", row.5)))
        {
            wrong.push(format!("{row:?}: {:?}", found.map(|found| found.lens)));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn it_is_said_by_what_a_lens_was_found() {
    for row in &BY_NUMBERS {
        assert_eq!(find(&shot(row)).unwrap().found, Found::Numbers, "{row:?}");
    }
    for row in &BY_NAME {
        let fixed = row.5.contains("& compatibles");
        assert_eq!(
            find(&shot(row)).unwrap().found,
            if fixed { Found::Camera } else { Found::Name },
            "{row:?}"
        );
    }
}

#[test]
fn nothing_is_guessed() {
    for row in &NOT_FOUND {
        assert_eq!(find(&shot(row)).map(|found| found.lens), None, "{row:?}");
    }
}

#[test]
fn a_crop_factor_stands_for_a_camera_that_is_not_known() {
    let shot = Shot { lens_model: Some("NIKKOR Z 24-70mm f/4 S"), ..Shot::new("Acme", "Nonesuch", 35.0) };
    let shot = Shot { lens_make: Some("NIKON"), crop_factor: Some(1.0), ..shot };
    let found = find(&shot).unwrap();
    assert!(found.camera.is_none() && found.has_distortion() && !found.has_vignetting());
    // A lens that was measured on a small sensor says nothing of the corners of a larger one.
    let shot =
        Shot { lens_model: Some("AF-S DX Zoom-Nikkor 18-55mm f/3.5-5.6G VR"), focal_length: 18.0, ..shot };
    assert!(!find(&shot).unwrap().has_distortion());
    let shot = Shot { crop_factor: Some(1.5), ..shot };
    assert!(find(&shot).unwrap().has_distortion());
}

#[test]
fn no_metadata_do_harm() {
    let numbers = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 0.0, -1.0, 1e-300, 1e300, 24.0];
    let long = "f/2.8 ".repeat(10_000);
    for text in ["", " ", "\t\n\u{1f}", "1:", "|", "(", "+++", "ﬀ İ ß 日本", "NIKKOR Z 24-70mm f/4 S", &long]
    {
        for a in numbers {
            for b in numbers {
                let shot = Shot {
                    camera_make: text,
                    camera_model: text,
                    lens_make: Some(text),
                    lens_model: Some(text),
                    focal_length: a,
                    aperture: Some(b),
                    distance: Some(a),
                    crop_factor: Some(b),
                };
                let _ = find(&shot);
                let known = Shot {
                    camera_make: "NIKON CORPORATION",
                    camera_model: "NIKON Z 6",
                    crop_factor: None,
                    ..shot
                };
                if let Some(found) = find(&Shot { lens_make: None, ..known }) {
                    for size in [(0, 0), (1, 1), (6000, 4000), (usize::MAX, 1)] {
                        let corrections = found.corrections(size);
                        assert!(corrections.gain(b, a).is_finite(), "{shot:?}");
                        let _ = corrections.place(a, b);
                    }
                }
            }
        }
    }
}
