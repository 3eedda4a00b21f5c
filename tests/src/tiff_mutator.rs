//! Damage to TIFF-based files that knows what directories are: wrong tags, types, counts and offsets, entries twice or
//! gone, chains that turn back, values that are swapped. Used by the tests of mutants and by the fuzz targets.
//!
//! Blind damage mostly hits samples, or breaks the first offset and is refused at once; this gets behind the screen.

/// xorshift64* (Marsaglia 2003; Vigna 2016): damage that is the same on every machine.
#[derive(Debug, Clone)]
pub struct Random(u64);

impl Random {
    /// A sequence of its own for each seed.
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    fn next(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_f491_4f6c_dd1d)
    }

    /// A number below `n`; 0 for 0.
    pub fn below(&mut self, n: usize) -> usize {
        ((self.next() >> 11) % n.max(1) as u64) as usize
    }

    fn one_of<T: Copy>(&mut self, all: &[T]) -> Option<T> {
        all.get(self.below(all.len())).copied()
    }
}

/// Tags that decoders act on: sizes, places, compression, levels, colours, opcodes, directories, maker notes.
const TAGS: [u16; 62] = [
    254, 256, 257, 258, 259, 262, 271, 272, 273, 274, 277, 278, 279, 284, 317, 320, 322, 323, 324, 325, 330,
    339, 347, 513, 514, 529, 530, 700, 33421, 33422, 34665, 34853, 37500, 37399, 50706, 50707, 50708, 50710,
    50711, 50712, 50713, 50714, 50715, 50716, 50717, 50718, 50719, 50720, 50721, 50722, 50727, 50728, 50729,
    50740, 50829, 50830, 50964, 51008, 51009, 51022, 51111, 52525,
];
/// Bytes of a value of each TIFF type, from type 0 on; BigTIFF's are the last.
const SIZES: [u8; 19] = [1, 1, 1, 2, 4, 8, 1, 1, 2, 4, 8, 4, 8, 4, 1, 1, 8, 8, 8];
/// Numbers at which sizes, products and signs go wrong.
const NUMBERS: [u64; 22] = [
    0,
    1,
    2,
    3,
    4,
    7,
    8,
    15,
    16,
    255,
    256,
    257,
    4095,
    4096,
    32_767,
    32_768,
    65_535,
    65_536,
    0x7fff_ffff,
    0x8000_0000,
    0xffff_fffe,
    0xffff_ffff,
];
/// Values of Compression that somebody reads.
const COMPRESSIONS: [u64; 14] =
    [1, 2, 5, 6, 7, 8, 32_767, 32_770, 32_773, 32_946, 34_713, 34_892, 52_546, 65_000];
/// A walk ends here; mutants of mutants may loop.
const MOST_ENTRIES: usize = 2048;
const MOST_DIRECTORIES: usize = 64;
/// Mutants may not grow beyond twice this, bytes.
const LARGEST: usize = 1 << 20;

/// An entry of a directory: where its twelve (BigTIFF: twenty) bytes stand.
#[derive(Debug, Clone, Copy)]
struct Entry {
    at: usize,
    tag: u16,
    kind: u16,
    count: u64,
}

/// The directories of a file as far as they can be followed.
struct Layout {
    little: bool,
    big: bool,
    /// Where directories begin.
    directories: Vec<usize>,
    entries: Vec<Entry>,
    /// Where offsets of following directories stand.
    links: Vec<usize>,
}

impl Layout {
    fn of(bytes: &[u8]) -> Option<Self> {
        let (little, big) = match bytes.get(..4)? {
            [b'I', b'I', 43, 0] => (true, true),
            [b'M', b'M', 0, 43] => (false, true),
            [b'I', b'I', ..] => (true, false),
            [b'M', b'M', ..] => (false, false),
            _ => return None,
        };
        let mut layout =
            Self { little, big, directories: Vec::new(), entries: Vec::new(), links: Vec::new() };
        let first = if big { 8 } else { 4 };
        layout.links.push(first);
        let mut waiting = vec![layout.word(bytes, first)?];
        while let Some(start) = waiting.pop() {
            let Ok(start) = usize::try_from(start) else { continue };
            if start == 0
                || layout.directories.contains(&start)
                || layout.directories.len() >= MOST_DIRECTORIES
            {
                continue;
            }
            layout.directories.push(start);
            layout.directory(bytes, start, &mut waiting);
        }
        Some(layout)
    }

    /// Bytes of an entry, and of an offset or count.
    fn sizes(&self) -> (usize, usize) {
        if self.big { (20, 8) } else { (12, 4) }
    }

    fn directory(&mut self, bytes: &[u8], start: usize, waiting: &mut Vec<u64>) {
        let (size, _) = self.sizes();
        let head = if self.big { 8 } else { 2 };
        let Some(count) = self.read(bytes, start, head) else { return };
        let count = usize::try_from(count).unwrap_or(usize::MAX).min(MOST_ENTRIES);
        let Some(first) = start.checked_add(head) else { return };
        for at in (0..count).map(|i| first + size * i) {
            if self.entries.len() >= MOST_ENTRIES {
                return;
            }
            let Some(entry) = self.entry(bytes, at) else { return };
            if matches!(entry.tag, 330 | 34665 | 34853) {
                let (value, length) = self.value(bytes, &entry);
                let offsets = (0..length / 4).take(8).filter_map(|i| self.read(bytes, value + 4 * i, 4));
                waiting.extend(offsets);
            }
            self.entries.push(entry);
        }
        let link = first + size * count;
        self.links.push(link);
        waiting.extend(self.word(bytes, link));
    }

    fn entry(&self, bytes: &[u8], at: usize) -> Option<Entry> {
        let number = |from, length| self.read(bytes, at + from, length);
        Some(Entry {
            at,
            tag: number(0, 2)? as u16,
            kind: number(2, 2)? as u16,
            count: number(4, self.sizes().1)?,
        })
    }

    /// Where the value of an entry stands, and its length as far as it lies in the file.
    fn value(&self, bytes: &[u8], entry: &Entry) -> (usize, usize) {
        let (_, word) = self.sizes();
        let size = SIZES.get(usize::from(entry.kind)).copied().unwrap_or(1);
        let length = usize::try_from(entry.count.saturating_mul(size.into())).unwrap_or(usize::MAX);
        let inline = entry.at + 4 + word;
        let at = if length <= word {
            inline
        } else {
            let offset = self.word(bytes, inline).and_then(|o| usize::try_from(o).ok());
            offset.unwrap_or(usize::MAX).min(bytes.len())
        };
        (at, length.min(bytes.len().saturating_sub(at)))
    }

    fn word(&self, bytes: &[u8], at: usize) -> Option<u64> {
        self.read(bytes, at, self.sizes().1)
    }

    fn read(&self, bytes: &[u8], at: usize, length: usize) -> Option<u64> {
        let part = bytes.get(at..at.checked_add(length)?)?;
        let add = |n: u64, b: &u8| n << 8 | u64::from(*b);
        Some(if self.little { part.iter().rev().fold(0, add) } else { part.iter().fold(0, add) })
    }

    fn write(&self, bytes: &mut [u8], at: usize, length: usize, number: u64) {
        let all = if self.little { number.to_le_bytes() } else { number.to_be_bytes() };
        let part = if self.little { &all[..length] } else { &all[8 - length..] };
        if let Some(place) = at.checked_add(length).and_then(|end| bytes.get_mut(at..end)) {
            place.copy_from_slice(part);
        }
    }
}

/// Damages a file in one to four places. What has no directories is damaged blindly.
pub fn mutate(bytes: &mut Vec<u8>, random: &mut Random) {
    for _ in 0..=random.below(4) {
        match Layout::of(bytes) {
            Some(layout) if !layout.entries.is_empty() && random.below(8) > 0 => {
                directories(bytes, &layout, random);
            }
            _ => blindly(bytes, random),
        }
    }
}

/// One thing that can be wrong with a directory.
fn directories(bytes: &mut Vec<u8>, layout: &Layout, random: &mut Random) {
    let Some(entry) = random.one_of(&layout.entries) else { return };
    let (size, word) = layout.sizes();
    let (count_at, value_at) = (entry.at + 4, entry.at + 4 + word);
    match random.below(14) {
        0 => layout.write(bytes, entry.at, 2, u64::from(random.one_of(&TAGS).unwrap_or(0))),
        1 => layout.write(bytes, entry.at + 2, 2, random.below(SIZES.len()) as u64),
        2 => {
            let near = [entry.count / 2, entry.count.wrapping_sub(1), entry.count + 1, 2 * entry.count];
            let count = match random.below(2) {
                0 => random.one_of(&near),
                _ => random.one_of(&NUMBERS),
            };
            layout.write(bytes, count_at, word, count.unwrap_or(0));
        }
        3 => layout.write(bytes, value_at, word, random.one_of(&NUMBERS).unwrap_or(0)),
        // The value, or where it stands, is that of another entry.
        4 => {
            if let Some(other) = random.one_of(&layout.entries) {
                let number = layout.word(bytes, other.at + 4 + word).unwrap_or(0);
                layout.write(bytes, value_at, word, number);
            }
        }
        // It lies anywhere, or across the end.
        5 => {
            let anywhere = random.below(bytes.len() + 16) as u64;
            layout.write(bytes, value_at, word, anywhere);
        }
        // It lies on a directory.
        6 => {
            if let Some(start) = random.one_of(&layout.directories) {
                layout.write(bytes, value_at, word, start as u64);
            }
        }
        // The whole entry is that of another: twice there, and one is gone.
        7 | 8 => {
            if let Some(other) = random.one_of(&layout.entries)
                && other.at + size <= bytes.len()
                && entry.at + size <= bytes.len()
            {
                bytes.copy_within(other.at..other.at + size, entry.at);
            }
        }
        // The chain turns back, or ends.
        9 => {
            let (link, start) = (random.one_of(&layout.links), random.one_of(&layout.directories));
            let start = if random.below(4) == 0 { 0 } else { start.unwrap_or(0) as u64 };
            layout.write(bytes, link.unwrap_or(0), word, start);
        }
        // A directory has more or fewer entries.
        10 => {
            let start = random.one_of(&layout.directories).unwrap_or(0);
            let head = if layout.big { 8 } else { 2 };
            let count = layout.read(bytes, start, head).unwrap_or(0);
            let near = [count.wrapping_sub(1), count + 1, count / 2, 4096, 65_535];
            layout.write(bytes, start, head, random.one_of(&near).unwrap_or(0));
        }
        11 => {
            let compressions: Vec<_> = layout.entries.iter().filter(|e| e.tag == 259).collect();
            if let Some(entry) = random.one_of(&compressions) {
                layout.write(bytes, entry.at + 4 + word, 2, random.one_of(&COMPRESSIONS).unwrap_or(1));
            }
        }
        // One number of a value.
        12 => {
            let (at, length) = layout.value(bytes, &entry);
            let unit = usize::from(SIZES.get(usize::from(entry.kind)).copied().unwrap_or(1)).min(4);
            let at = at + unit * random.below(length / unit);
            layout.write(bytes, at, unit, random.one_of(&NUMBERS).unwrap_or(0));
        }
        // A larger value of the same kind, at the end.
        _ => {
            let (at, length) = layout.value(bytes, &entry);
            if bytes.len() < LARGEST && length > 0 {
                let value = bytes[at..at + length].to_vec();
                let times = 1 + random.below(4);
                let end = bytes.len() as u64;
                bytes.extend(value.iter().cycle().take((length * times).min(LARGEST)));
                layout.write(bytes, count_at, word, entry.count.saturating_mul(times as u64));
                layout.write(bytes, value_at, word, end);
            }
        }
    }
}

/// Damage anywhere, more often near the start.
fn blindly(bytes: &mut Vec<u8>, random: &mut Random) {
    if bytes.is_empty() {
        return;
    }
    let length = bytes.len();
    let at = if random.below(2) == 0 { random.below(length.min(4096)) } else { random.below(length) };
    match random.below(5) {
        0 => bytes[at] = random.below(256) as u8,
        1 => bytes[at] ^= 1 << random.below(8),
        2 => {
            let end = (at + 4).min(length);
            bytes[at..end].fill(random.one_of(&[0, 0xff, 0x7f, 0x80]).unwrap_or(0));
        }
        3 => {
            let from = random.below(length);
            let count = (1 + random.below(64)).min(length - at.max(from));
            bytes.copy_within(from..from + count, at);
        }
        _ if random.below(8) == 0 => bytes.truncate(at.max(1)),
        _ => {}
    }
}

/// The file with one more entry in the directory of its samples (the last one that has strips or tiles): the directory
/// is written anew at the end. Files that have no directory stay as they are.
pub fn with_entry(bytes: &[u8], tag: u16, kind: u16, count: u32, value: &[u8]) -> Vec<u8> {
    let mut out = bytes.to_vec();
    let Some(layout) = Layout::of(bytes).filter(|l| !l.big) else { return out };
    let samples = layout.entries.iter().rev().find(|e| matches!(e.tag, 273 | 324));
    let before = |at: &&usize| samples.is_some_and(|s| **at < s.at);
    let Some(&start) = layout.directories.iter().filter(before).max() else { return out };
    let entries = layout.read(bytes, start, 2).unwrap_or(0) as usize;
    let Some(old) = bytes.get(start + 2..start + 2 + 12 * entries) else { return out };
    out.resize(out.len().next_multiple_of(2), 0);
    let value_at = out.len();
    out.extend_from_slice(value);
    out.resize(out.len().next_multiple_of(2), 0);
    let directory_at = out.len();
    out.resize(directory_at + 2 + 12 * (entries + 1) + 4, 0);
    layout.write(&mut out, directory_at, 2, entries as u64 + 1);
    let mut all: Vec<[u8; 12]> = old.as_chunks().0.to_vec();
    let mut new = [0; 12];
    layout.write(&mut new, 0, 2, tag.into());
    layout.write(&mut new, 2, 2, kind.into());
    layout.write(&mut new, 4, 4, count.into());
    if value.len() <= 4 {
        new[8..8 + value.len()].copy_from_slice(value);
    } else {
        layout.write(&mut new, 8, 4, value_at as u64);
    }
    all.push(new);
    all.sort_by_key(|entry| layout.read(entry, 0, 2));
    out[directory_at + 2..directory_at + 2 + 12 * (entries + 1)].copy_from_slice(all.as_flattened());
    // Whoever pointed at the old directory points at the new one.
    let pointers = layout.entries.iter().filter(|e| e.tag == 330).map(|e| layout.value(bytes, e));
    let places = pointers.flat_map(|(at, length)| (at..at + length).step_by(4)).chain(layout.links.clone());
    for place in places {
        if layout.read(bytes, place, 4) == Some(start as u64) {
            layout.write(&mut out, place, 4, directory_at as u64);
        }
    }
    out
}
