use super::*;
use crate::icc;
use crate::testing::spaces;

#[test]
fn colours_of_our_own_profiles_come_back() {
    let to_xyz = LINEAR.to_xyz_under(white::D50);
    for space in spaces() {
        let profile = SourceProfile::read(&icc::profile(&space)).unwrap();
        assert!(!profile.has_tables() && profile.description().starts_with(space.name), "{}", space.name);
        for linear in [[1.0, 1.0, 1.0], [0.5, 0.2, 0.1], [0.01, 0.9, 0.3], [0.0, 0.0, 0.0]] {
            let truth = space.to_xyz_under(white::D50) * Vector3::from(linear);
            let mut pixel = linear.map(|v| space.curve.encode(v) as f32);
            profile.linearise(&mut pixel);
            let found = to_xyz * Vector3::from(pixel.map(f64::from));
            // Sixteen bits of a linear space are the coarsest.
            assert!((found - truth).amax() < 1e-4, "{}: {found} {truth}", space.name);
        }
    }
}

/// A profile of version 4 whose `A2B0` is a `lutAToBType`: a table of two nodes a channel between straight curves, to XYZ.
fn with_table() -> Vec<u8> {
    let mut table = b"mAB \0\0\0\0\x03\x03\0\0".to_vec();
    // B curves, matrix, M curves, table, A curves; each curve takes twelve bytes.
    for offset in [32u32, 0, 0, 68, 32] {
        table.extend(offset.to_be_bytes());
    }
    for _ in 0..3 {
        table.extend(b"curv\0\0\0\0\0\0\0\0");
    }
    table.extend([[2u8; 3].as_slice(), &[0; 13], &[2, 0, 0, 0]].concat());
    for node in 0..8u16 {
        for bit in [4, 2, 1] {
            table.extend((if node & bit > 0 { 0x4000u16 } else { 0 }).to_be_bytes());
        }
    }
    let mut profile = icc::profile(&RgbSpace::SRGB)[..128].to_vec();
    profile.extend(1u32.to_be_bytes());
    profile.extend(b"A2B0");
    profile.extend([144, table.len() as u32].map(u32::to_be_bytes).concat());
    profile.extend(table);
    let size = profile.len() as u32;
    profile[..4].copy_from_slice(&size.to_be_bytes());
    profile
}

#[test]
fn a_table_is_interpolated() {
    let profile = SourceProfile::read(&with_table()).unwrap();
    assert!(profile.has_tables());
    let to_xyz = LINEAR.to_xyz_under(white::D50);
    for rgb in [[1.0f32, 0.0, 0.0], [0.25, 0.5, 0.75], [1.0, 1.0, 1.0], [0.1, 0.1, 0.9]] {
        let mut pixel = rgb;
        profile.linearise(&mut pixel);
        let found = to_xyz * Vector3::from(pixel.map(f64::from));
        // 0x4000 of 16 bits of XYZ is half of 1.
        let truth = Vector3::from(rgb.map(|v| f64::from(v) * f64::from(0x4000) / 32_768.0));
        assert!((found - truth).amax() < 2e-5, "{rgb:?}: {found} {truth}");
    }
}

#[test]
fn a_picture_without_a_profile_is_srgb() {
    let read = SourceProfile::read(&icc::profile(&RgbSpace::SRGB)).unwrap();
    let (mut one, mut other) = ([0.2f32, 0.5, 0.9], [0.2f32, 0.5, 0.9]);
    read.linearise(&mut one);
    SourceProfile::srgb().linearise(&mut other);
    assert!(one.iter().zip(other).all(|(a, b)| (a - b).abs() < 1e-4), "{one:?} {other:?}");
}

#[test]
fn broken_profiles_are_errors_and_never_panics() {
    let good = [icc::profile(&RgbSpace::ECIRGB_V2), with_table()];
    assert!(SourceProfile::read(b"").is_err() && SourceProfile::read(b"no profile").is_err());
    for good in &good {
        for length in 0..good.len() {
            let _ = SourceProfile::read(&good[..length]);
        }
    }
    let mut state = 7u32;
    for i in 0..600 {
        let mut bytes = good[i % 2].clone();
        for _ in 0..3 {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let at = (state >> 8) as usize % bytes.len();
            bytes[at] = state as u8;
        }
        if let Ok(profile) = SourceProfile::read(&bytes) {
            let mut pixels = [0.0f32, 0.5, 1.0, f32::NAN, -1.0, 2.0];
            profile.linearise(&mut pixels);
        }
    }
}

#[test]
fn a_profile_of_another_kind_is_refused_in_words() {
    let mut grey = icc::profile(&RgbSpace::SRGB);
    grey[16..20].copy_from_slice(b"GRAY");
    let words = SourceProfile::read(&grey).err().unwrap().to_string();
    assert!(words.contains("Gray") && words.contains("RGB space"), "{words}");
}
