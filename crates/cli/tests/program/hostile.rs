//! Files made to harm: each costs a sentence, some seconds and little memory.

use std::time::{Duration, Instant};

use super::*;

mod found;

/// Field types of TIFF 6.0, section 2.
const BYTE: u16 = 1;
const ASCII: u16 = 2;
const SHORT: u16 = 3;
const LONG: u16 = 4;
const RATIONAL: u16 = 5;
const UNDEFINED: u16 = 7;
const SIGNED_RATIONAL: u16 = 10;

/// A DNG of one directory, made entry by entry: whatever is asked for, also what no writer would write.
struct Forged {
    bytes: Vec<u8>,
    entries: Vec<(u16, u16, u32, u32)>,
}

impl Forged {
    /// 16-bit samples of a Bayer array of this size, with everything but the samples.
    fn dng(width: u32, height: u32) -> Self {
        let mut forged = Self { bytes: b"II*\0\0\0\0\0".to_vec(), entries: Vec::new() };
        let matrix: Vec<u8> =
            [1, 0, 0, 0, 1, 0, 0, 0, 1].iter().flat_map(|n: &i32| words(&[*n as u32, 1])).collect();
        let matrix = forged.put(&matrix);
        let neutral = forged.put(&words(&[1, 2, 1, 1, 1, 2]));
        forged
            .entry(0x00fe, LONG, 1, 0)
            .entry(0x0100, LONG, 1, width)
            .entry(0x0101, LONG, 1, height)
            .entry(0x0102, SHORT, 1, 16)
            .entry(0x0103, SHORT, 1, 1)
            .entry(0x0106, SHORT, 1, 32803)
            .entry(0x010f, ASCII, 4, u32::from_le_bytes(*b"Foe\0"))
            .entry(0x0110, ASCII, 4, u32::from_le_bytes(*b"One\0"))
            .entry(0x0115, SHORT, 1, 1)
            .entry(0x828d, SHORT, 2, 0x0002_0002)
            .entry(0x828e, BYTE, 4, u32::from_le_bytes([0, 1, 1, 2]))
            .entry(0xc612, BYTE, 4, u32::from_le_bytes([1, 4, 0, 0]))
            .entry(0xc61d, LONG, 1, 16383)
            .entry(0xc621, SIGNED_RATIONAL, 9, matrix)
            .entry(0xc628, RATIONAL, 3, neutral);
        forged
    }

    /// With grey samples in one strip.
    fn whole(width: u32, height: u32) -> Self {
        let mut forged = Self::dng(width, height);
        let length = 2 * width * height;
        let at = forged.put(&[0x00, 0x08].repeat(length as usize / 2));
        forged.entry(0x0111, LONG, 1, at).entry(0x0116, LONG, 1, height).entry(0x0117, LONG, 1, length);
        forged
    }

    /// Adds bytes and returns where they are.
    fn put(&mut self, bytes: &[u8]) -> u32 {
        let at = self.bytes.len() as u32;
        self.bytes.extend(bytes);
        self.bytes.resize(self.bytes.len().next_multiple_of(2), 0);
        at
    }

    /// Adds an entry; `value` is the value itself or its place.
    fn entry(&mut self, tag: u16, kind: u16, count: u32, value: u32) -> &mut Self {
        self.entries.retain(|e| e.0 != tag);
        self.entries.push((tag, kind, count, value));
        self
    }

    /// A directory at the end, and where it is.
    fn directory(&mut self, mut entries: Vec<(u16, u16, u32, u32)>) -> u32 {
        entries.sort_by_key(|e| e.0);
        let mut bytes = (entries.len() as u16).to_le_bytes().to_vec();
        for (tag, kind, count, value) in entries {
            bytes.extend([tag.to_le_bytes(), kind.to_le_bytes()].concat());
            bytes.extend(words(&[count, value]));
        }
        bytes.extend([0; 4]);
        self.put(&bytes)
    }

    fn finish(mut self) -> Vec<u8> {
        let entries = std::mem::take(&mut self.entries);
        let at = self.directory(entries);
        self.bytes[4..8].copy_from_slice(&at.to_le_bytes());
        self.bytes
    }
}

fn words(words: &[u32]) -> Vec<u8> {
    words.iter().flat_map(|w| w.to_le_bytes()).collect()
}

/// Runs the program with at most so many kilobytes of memory.
#[cfg(target_os = "linux")]
fn limited(desk: &Desk, kilobytes: u32, arguments: &[&str]) -> Run {
    let mut command = Command::new("sh");
    let script = format!("ulimit -d {kilobytes}; exec \"$0\" \"$@\"");
    command.args(["-c", &script, env!("CARGO_BIN_EXE_darkroot")]).args(arguments);
    desk.prepare(&mut command);
    Run::of(&command.output().unwrap(), arguments)
}

/// Every command refuses the file in these words, at once, by both decoders.
fn refused_at_once(bytes: &[u8], words: &str) {
    let desk = Desk::new();
    desk.put("in/foe.dng", bytes);
    for arguments in [
        &["inspect", "in/foe.dng"][..],
        &["inspect", "in/foe.dng", "--decoder", "rawloader"],
        &["develop", "in/foe.dng", "-o", "foe.jpg"],
        &["develop", "in/foe.dng", "-o", "foe.jpg", "--decoder", "rawloader"],
        &["batch", "in", "-o", "out", "-q"],
    ] {
        let start = Instant::now();
        desk.fails(1, arguments, &[words]);
        let limit = Duration::from_secs(20);
        assert!(start.elapsed() < limit, "{arguments:?} took {:?}", start.elapsed());
    }
    assert!(!desk.path("foe.jpg").exists());
}

/// 500 fields of 2 MB each, all of them the same bytes.
fn exif_bomb() -> Vec<u8> {
    const LENGTH: u32 = 2_000_000;
    let mut forged = Forged::whole(64, 48);
    let block = forged.put(&vec![0; LENGTH as usize]);
    let exif = (0..450).map(|i| {
        let kind = [ASCII, UNDEFINED, SHORT, BYTE][i as usize % 4];
        (0x8827 + i * 17, kind, if kind == SHORT { LENGTH / 2 } else { LENGTH }, block)
    });
    let mut exif: Vec<_> = exif.collect();
    exif.extend([(0x9003, ASCII, LENGTH, block), (0xa434, ASCII, LENGTH, block)]);
    let exif = forged.directory(exif);
    let gps = forged.directory((0..50).map(|tag| (tag, ASCII, LENGTH, block)).collect());
    forged.entry(0x8769, LONG, 1, exif).entry(0x8825, LONG, 1, gps);
    for tag in [0x010e, 0x0131, 0x0132, 0x013b, 0x8298] {
        forged.entry(tag, ASCII, LENGTH, block);
    }
    forged.finish()
}

#[cfg(target_os = "linux")]
#[test]
fn many_fields_of_the_same_bytes_take_no_memory() {
    let desk = Desk::new();
    desk.put("in/foe.dng", exif_bomb());
    const KILOBYTES: u32 = 200_000;
    for arguments in [&["inspect", "in/foe.dng"][..], &["develop", "in/foe.dng", "-o", "foe.jpg"]] {
        let run = limited(&desk, KILOBYTES, arguments);
        assert_eq!(run.code, 0, "{}", run.err);
    }
    let run = limited(&desk, KILOBYTES, &["batch", "in", "-o", "out", "--name", "{camera}.jpg"]);
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(desk.read("foe.jpg").len() < 20_000);
}

/// A lossless JPEG that claims a frame of this size and four components, of one code of one bit.
fn ljpeg(side: u16, scan: usize) -> Vec<u8> {
    let mut jpeg = b"\xff\xd8\xff\xc3\0\x14\x10".to_vec();
    jpeg.extend([side.to_be_bytes(), side.to_be_bytes()].concat());
    jpeg.extend(b"\x04\0\x11\0\x01\x11\0\x02\x11\0\x03\x11\0");
    jpeg.extend(b"\xff\xc4\0\x14\0\x01\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0");
    jpeg.extend(b"\xff\xda\0\x0e\x04\0\0\x01\0\x02\0\x03\0\x01\0\0");
    jpeg.extend(vec![0; scan]);
    jpeg.extend(b"\xff\xd9");
    jpeg
}

#[test]
fn a_jpeg_that_is_larger_than_its_tile_is_refused() {
    let mut forged = Forged::dng(512, 512);
    let jpeg = ljpeg(65_535, 100_000);
    let at = forged.put(&jpeg);
    forged
        .entry(0x0103, SHORT, 1, 7)
        .entry(0x0142, LONG, 1, 512)
        .entry(0x0143, LONG, 1, 512)
        .entry(0x0144, LONG, 1, at)
        .entry(0x0145, LONG, 1, jpeg.len() as u32);
    refused_at_once(
        &forged.finish(),
        "one of its strips or tiles claims more samples than its place in the picture has",
    );
}

#[test]
fn a_jpeg_xl_that_is_larger_than_its_tile_is_refused() {
    let mut forged = Forged::dng(512, 512);
    // 2^30 pixels high and as wide.
    let jxl = [b"\xff\x0a\xfe\xff\xff\xff\x03", &[0; 100_000][..]].concat();
    let at = forged.put(&jxl);
    forged
        .entry(0x0103, SHORT, 1, 52546)
        .entry(0x0142, LONG, 1, 512)
        .entry(0x0143, LONG, 1, 512)
        .entry(0x0144, LONG, 1, at)
        .entry(0x0145, LONG, 1, jxl.len() as u32);
    refused_at_once(&forged.finish(), "one of its strips or tiles claims more samples");
}

#[test]
fn strips_that_are_all_the_same_bytes_are_refused() {
    const SIDE: u32 = 22_000;
    let mut forged = Forged::dng(SIDE, SIDE);
    let block = forged.put(&vec![1; 2 * SIDE as usize]);
    let offsets = forged.put(&words(&vec![block; SIDE as usize]));
    let lengths = forged.put(&words(&vec![2 * SIDE; SIDE as usize]));
    forged.entry(0x0111, LONG, SIDE, offsets).entry(0x0116, LONG, 1, 1).entry(0x0117, LONG, SIDE, lengths);
    refused_at_once(&forged.finish(), "its strips or tiles overlap");
}

#[test]
fn more_samples_than_the_bytes_can_hold_are_refused() {
    let mut forged = Forged::dng(20_000, 20_000);
    let at = forged.put(&[0; 10_000]);
    forged.entry(0x0111, LONG, 1, at).entry(0x0116, LONG, 1, 20_000).entry(0x0117, LONG, 1, 800_000_000);
    refused_at_once(&forged.finish(), "bytes cannot hold the 400000000 samples that it claims");
}

/// A list of the same opcode many times (DNG 1.7, chapter 7; big-endian).
fn opcodes(count: u32, id: u32, body: &[u8]) -> Vec<u8> {
    let mut list = count.to_be_bytes().to_vec();
    for _ in 0..count {
        for word in [id, 0x0103_0000, 0, body.len() as u32] {
            list.extend(word.to_be_bytes());
        }
        list.extend(body);
    }
    list
}

/// With an opcode list of the number, 1 to 3.
fn with_opcodes(number: usize, list: &[u8]) -> Vec<u8> {
    let mut forged = Forged::whole(1200, 900);
    let at = forged.put(list);
    forged.entry([0xc740, 0xc741, 0xc74e][number - 1], UNDEFINED, list.len() as u32, at);
    forged.finish()
}

/// A gain map of four points over everything.
fn gain_map() -> Vec<u8> {
    let mut body: Vec<u8> =
        [0u32, 0, 900, 1200, 0, 1, 1, 1, 2, 2].iter().flat_map(|v| v.to_be_bytes()).collect();
    body.extend([1f64, 1.0, 0.0, 0.0].iter().flat_map(|v| v.to_be_bytes()));
    body.extend(1u32.to_be_bytes());
    body.extend([1f32; 4].iter().flat_map(|v| v.to_be_bytes()));
    body
}

#[test]
fn opcode_lists_without_end_are_refused() {
    let constant = opcodes(4096, 4, &[0; 8]);
    let vignettes = opcodes(4096, 3, &[0; 56]);
    for (number, list) in [(1, constant), (2, opcodes(4096, 9, &gain_map())), (3, vignettes)] {
        refused_at_once(&with_opcodes(number, &list), &format!("its OpcodeList{number} asks for more work"));
    }
}

#[test]
fn opcode_lists_as_cameras_write_them_are_applied() {
    let desk = Desk::new();
    desk.put("a.dng", with_opcodes(2, &opcodes(8, 9, &gain_map())));
    let run = desk.run(&["inspect", "a.dng", "--json"]);
    let facts: serde_json::Value = serde_json::from_str(&run.out).unwrap();
    assert_eq!(facts["corrections"], serde_json::json!([8, 0]), "{}", run.err);
    desk.develop(&["a.dng", "-o", "a.jpg"]);
}

/// A PNG of 39,000 x 39,000 pixels of one bit, as far as its header goes.
const LARGE_PNG: &[u8] = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\x98\x58\0\0\x98\x58\x01\0\0\0\0\xe6\x1d\x25\xd3\
    \0\0\0\x0cIDAT\x78\x9c\x63\x60\xa0\x3d\0\0\0\x64\0\x01\x86\x64\x3c\x35\0\0\0\0IEND\xae\x42\x60\x82";

#[test]
fn a_picture_counts_by_what_it_becomes() {
    let desk = Desk::new();
    desk.put("large.png", LARGE_PNG);
    desk.fails(1, &["chart", "large.png"], &["is too large to look for a chart in (39000 x 39000 pixels)"]);
}

#[test]
fn a_file_that_takes_longer_than_it_may_ends_the_program_in_order() {
    let desk = Desk::new();
    desk.put("slow.nef", std::fs::read(sample("still-life.nef")).unwrap());
    desk.put("b.dng", small_dng());
    let (slow, all) = (["slow.nef", "-o", "out/{stem}.avif"], ["slow.nef", "b.dng", "-o", "out/{stem}.avif"]);
    std::fs::create_dir(desk.path("out")).unwrap();
    let words = ["slow.nef: took longer than 1ms", "--timeout"];
    desk.fails(1, &[&["develop", "--timeout", "1ms"], &slow[..]].concat(), &words);
    let more = [&words[..], &["the file after it was not begun"]].concat();
    desk.fails(1, &[&["develop", "--timeout", "1ms"], &all[..]].concat(), &more);
    assert!(names(&desk.path("out")).is_empty(), "{:?}", names(&desk.path("out")));
    desk.fails(
        1,
        &["inspect", "slow.nef", "--timeout", "1ns"],
        &["slow.nef: took longer than 1ns", "--timeout"],
    );

    let run = desk.run(&[&["develop", "--json", "--timeout", "1ms"], &slow[..]].concat());
    let line: serde_json::Value = serde_json::from_str(&run.out).unwrap();
    assert_eq!((run.code, &line["status"]), (1, &"failed".into()), "{line}");
    assert!(line["error"].as_str().unwrap().contains("took longer"), "{line}");
    desk.fails(2, &["develop", "slow.nef", "--timeout", "never"], &["`never` is no time"]);
    desk.develop(&[&slow[..], &["--timeout", "10m"]].concat());
}

#[test]
fn threads_beyond_use_are_not_started() {
    let desk = Desk::with_dng();
    let start = Instant::now();
    let run = desk.develop(&["a.dng", "--threads", "5000"]);
    assert!(start.elapsed() < Duration::from_secs(20), "{:?}", start.elapsed());
    assert!(run.err.contains("note: this machine has ") && run.err.contains("not 5000"), "{}", run.err);
    let run = desk.develop(&["a.dng", "--threads", "5000", "--overwrite", "--quiet"]);
    assert_eq!(run.err, "");
    assert_eq!(
        desk.develop(&["a.dng", "--threads", "2", "--overwrite"]).err.matches("note: this").count(),
        0
    );
    let run = desk.run(&["batch", ".", "-o", "out", "--threads", "5000"]);
    assert!(run.code == 0 && run.err.contains("not 5000"), "{}", run.err);
    let run = desk.run(&["batch", ".", "-o", "other", "--jobs", "5000"]);
    assert!(run.code == 0 && run.err.contains("files at once, not 5000"), "{}", run.err);
}
