//! What fuzzing found, and what it made one look at.

use super::*;

/// Field type of TIFF 6.0, section 2.
const FLOAT: u16 = 11;

#[test]
fn a_field_outside_of_the_file_makes_the_other_decoder_fail_in_one_sentence() {
    const SOFTWARE: u16 = 0x0131;
    let mut forged = Forged::whole(64, 48);
    forged.entry(SOFTWARE, ASCII, 100, 0x0200_0000);
    let desk = Desk::new();
    desk.put("foe.dng", forged.finish());
    let arguments = ["develop", "foe.dng", "-o", "foe.jpg", "--decoder", "rawloader"];
    let run = desk.fails(1, &arguments, &["foe.dng", "made rawloader fail", "--decoder"]);
    let words = ["panic", "https", "\\n"];
    assert!(words.iter().all(|word| !run.err.contains(word)), "{}", run.err);
    assert_eq!(desk.names(), ["foe.dng"]);
    // The field is of no use to Darkroot, so the default decoder does not mind.
    desk.develop(&["foe.dng", "-o", "foe.jpg"]);
}

/// A DCP for two lights, whose table has as many hues as saturations and turns colours about without end.
fn dcp(side: u32) -> Vec<u8> {
    let mut forged = Forged { bytes: b"IIRC\0\0\0\0".to_vec(), entries: Vec::new() };
    let matrix: Vec<u8> = [2, 0, 0, 0, 2, 0, 0, 0, 2].iter().flat_map(|n| words(&[*n, 2])).collect();
    let matrix = forged.put(&matrix);
    let dimensions = forged.put(&words(&[side, side, 1]));
    let node = |i: u32| [if i.is_multiple_of(2) { 1e30 } else { -1e30 }, (i % 7) as f32, 1.0];
    let table: Vec<u8> = (0..side * side).flat_map(node).flat_map(f32::to_le_bytes).collect();
    let table = forged.put(&table);
    let numbers = 3 * side * side;
    forged
        .entry(0xc614, ASCII, 4, u32::from_le_bytes(*b"Foe\0"))
        .entry(0xc621, SIGNED_RATIONAL, 9, matrix)
        .entry(0xc622, SIGNED_RATIONAL, 9, matrix)
        .entry(0xc65a, SHORT, 1, 17)
        .entry(0xc65b, SHORT, 1, 21)
        .entry(0xc6f9, LONG, 3, dimensions)
        .entry(0xc6fa, FLOAT, numbers, table)
        .entry(0xc6fb, FLOAT, numbers, table);
    forged.finish()
}

#[test]
fn a_dcp_is_fitted_in_bounded_time_however_large_and_wild_its_table_is() {
    // No colour of this one can be found back, so that each costs all the steps that it may.
    let desk = Desk::new();
    desk.put("foe.dcp", dcp(2000));
    let start = Instant::now();
    let run = desk.run(&["profile", "show", "foe.dcp"]);
    assert!(start.elapsed() < Duration::from_secs(60), "took {:?}", start.elapsed());
    assert!(run.code == 0 && run.out.contains("chromatic"), "{}{}", run.out, run.err);
}

/// A DNG of so many tiles across and down, each of them these bytes of JPEG XL: what a small DNG becomes.
fn tiles(jxl: &[u8], [across, down]: [u32; 2]) -> Vec<u8> {
    let mut forged = Forged::dng(WIDTH * across, HEIGHT * down);
    let offsets: Vec<u32> = (0..across * down).map(|_| forged.put(jxl)).collect();
    let lengths = vec![jxl.len() as u32; offsets.len()];
    let [offsets, lengths] = [offsets, lengths].map(|numbers| forged.put(&words(&numbers)));
    let bits = forged.put(&[16, 0, 16, 0, 16, 0]);
    let white = forged.put(&words(&[65535; 3]));
    forged.entries.retain(|e| ![0x828d, 0x828e].contains(&e.0));
    forged
        .entry(0x0102, SHORT, 3, bits)
        .entry(0x0103, SHORT, 1, 52546)
        .entry(0x0106, SHORT, 1, 34892)
        .entry(0x0115, SHORT, 1, 3)
        .entry(0x0142, LONG, 1, WIDTH)
        .entry(0x0143, LONG, 1, HEIGHT)
        .entry(0x0144, LONG, across * down, offsets)
        .entry(0x0145, LONG, across * down, lengths)
        .entry(0xc61d, LONG, 3, white);
    forged.finish()
}

#[test]
fn tiles_that_share_out_work_of_their_own_do_not_pile_up_on_a_stack() {
    // A thread that waits for its share of a tile begins another tile meanwhile.
    let desk = Desk::with_dng();
    desk.develop(&["a.dng", "-o", "a.jxl"]);
    desk.put("foe.dng", tiles(&desk.read("a.jxl"), [60, 60]));
    for threads in ["2", "8"] {
        let arguments = ["inspect", "foe.dng"];
        let mut command = desk.command(&arguments);
        // An eighth of what a thread has by default.
        let output = command.env("DARKROOT_THREADS", threads).env("RUST_MIN_STACK", "262144").output();
        let run = Run::of(&output.unwrap(), &arguments);
        assert!(run.code == 0 && run.out.contains("JPEG XL"), "{threads} threads: {}", run.err);
    }
}
