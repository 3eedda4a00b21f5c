//! TIFF files of one directory, in either byte order, for tests.

/// A field and its numbers; of those that stand for strips or tiles the numbers are filled in.
#[derive(Debug, Clone)]
pub(crate) struct Field {
    tag: usize,
    kind: usize,
    numbers: Numbers,
}

#[derive(Debug, Clone)]
enum Numbers {
    Given(Vec<usize>),
    Offsets,
    Lengths,
}

#[allow(dead_code)] // Each test takes what it needs.
impl Field {
    pub(crate) fn bytes(tag: usize, numbers: &[usize]) -> Self {
        Self { tag, kind: 1, numbers: Numbers::Given(numbers.to_vec()) }
    }

    pub(crate) fn shorts(tag: usize, numbers: &[usize]) -> Self {
        Self { tag, kind: 3, numbers: Numbers::Given(numbers.to_vec()) }
    }

    pub(crate) fn short(tag: usize, number: usize) -> Self {
        Self::shorts(tag, &[number])
    }

    pub(crate) fn longs(tag: usize, numbers: &[usize]) -> Self {
        Self { tag, kind: 4, numbers: Numbers::Given(numbers.to_vec()) }
    }

    pub(crate) fn long(tag: usize, number: usize) -> Self {
        Self::longs(tag, &[number])
    }

    pub(crate) fn offsets(tag: usize) -> Self {
        Self { tag, kind: 4, numbers: Numbers::Offsets }
    }

    pub(crate) fn lengths(tag: usize) -> Self {
        Self { tag, kind: 4, numbers: Numbers::Lengths }
    }

    fn count(&self, pieces: usize) -> usize {
        if let Numbers::Given(numbers) = &self.numbers { numbers.len() } else { pieces }
    }
}

/// The file of these fields and pieces, which come last.
pub(crate) fn tiff_file(fields: &[Field], pieces: Vec<Vec<u8>>, big: bool) -> Vec<u8> {
    let two = |v: usize| if big { (v as u16).to_be_bytes() } else { (v as u16).to_le_bytes() };
    let four = |v: usize| if big { (v as u32).to_be_bytes() } else { (v as u32).to_le_bytes() };
    let mut fields = fields.to_vec();
    fields.sort_by_key(|f| f.tag);
    let length = |f: &Field| [0, 1, 1, 2, 4][f.kind] * f.count(pieces.len());
    let values_at = 8 + 2 + 12 * fields.len() + 4;
    let mut at = values_at + fields.iter().map(length).filter(|&l| l > 4).sum::<usize>();
    let lengths: Vec<usize> = pieces.iter().map(Vec::len).collect();
    let mut offsets = Vec::new();
    for length in &lengths {
        offsets.push(at);
        at += length;
    }
    let mut head = if big { b"MM\0\x2a".to_vec() } else { b"II\x2a\0".to_vec() };
    let mut values = Vec::new();
    head.extend(four(8));
    head.extend(two(fields.len()));
    for field in &fields {
        let numbers = match &field.numbers {
            Numbers::Given(numbers) => numbers,
            Numbers::Offsets => &offsets,
            Numbers::Lengths => &lengths,
        };
        let bytes: Vec<u8> = match field.kind {
            1 => numbers.iter().map(|&v| v as u8).collect(),
            3 => numbers.iter().flat_map(|&v| two(v)).collect(),
            _ => numbers.iter().flat_map(|&v| four(v)).collect(),
        };
        head.extend([two(field.tag), two(field.kind)].concat());
        head.extend(four(numbers.len()));
        if length(field) > 4 {
            head.extend(four(values_at + values.len()));
            values.extend(bytes);
        } else {
            head.extend(bytes.iter().copied().chain([0; 4]).take(4));
        }
    }
    head.extend(four(0));
    [head, values, pieces.concat()].concat()
}
