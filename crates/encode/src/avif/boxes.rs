//! The boxes of an AVIF file (AV1 Image File Format 1.1; ISO/IEC 14496-12 and 23008-12): one coded picture, what its colours
//! mean, Exif and XMP.

/// A coded picture: its configuration record (`av1C`) and its bytes.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Coded {
    configuration: Vec<u8>,
    bytes: Vec<u8>,
}

impl Coded {
    /// Takes it out of a file that holds one picture and nothing else.
    pub(super) fn of_file(file: &[u8]) -> Option<Self> {
        let meta = find(file, b"meta")?.get(4..)?;
        let properties = find(find(meta, b"iprp")?, b"ipco")?;
        let configuration = find(properties, b"av1C")?.to_vec();
        Some(Self { configuration, bytes: find(file, b"mdat")?.to_vec() })
    }
}

/// What a box of that name holds, among boxes side by side.
fn find<'a>(mut boxes: &'a [u8], name: &[u8; 4]) -> Option<&'a [u8]> {
    loop {
        let (head, rest) = boxes.split_at_checked(8)?;
        let (size, found) = head.split_at(4);
        let size = u32::from_be_bytes(size.try_into().ok()?) as usize;
        let (content, next) = rest.split_at_checked(size.checked_sub(8)?)?;
        if found == name {
            return Some(content);
        }
        boxes = next;
    }
}

/// What a file is made of.
pub(super) struct Parts<'a> {
    pub(super) width: u32,
    pub(super) height: u32,
    pub(super) coded: &'a Coded,
    pub(super) bits: u8,
    /// Primaries and transfer curve by their numbers in ITU-T H.273; 2 where an ICC profile says them.
    pub(super) named: [u16; 2],
    /// The matrix by which the colours are coded, by its number there.
    pub(super) matrix: u16,
    /// ICC profile, or nothing.
    pub(super) profile: &'a [u8],
    /// Block of Exif from its TIFF head on, or nothing.
    pub(super) exif: &'a [u8],
    /// Packet of XMP, or nothing.
    pub(super) xmp: &'a [u8],
}

const FULL_RANGE: u8 = 0x80;

impl Parts<'_> {
    /// The bytes of the file.
    pub(super) fn file(&self) -> Vec<u8> {
        // Where Exif begins in its item: at once.
        let exif: Vec<u8> = if self.exif.is_empty() { Vec::new() } else { [&[0; 4], self.exif].concat() };
        let mut items: Vec<(&[u8; 4], &[u8])> = vec![(b"av01", &self.coded.bytes)];
        items.extend([(b"Exif", &exif[..]), (b"mime", self.xmp)].into_iter().filter(|(_, b)| !b.is_empty()));
        let kind = boxed(b"ftyp", &[b"avif", &[0; 4], b"avifmif1miafMA1A"]);
        // The length of the boxes does not depend on the places that they tell.
        let length = kind.len() + self.meta(&items, 0).len() + 8;
        let meta = self.meta(&items, length as u32);
        let data: Vec<&[u8]> = items.iter().map(|(_, bytes)| *bytes).collect();
        [kind, meta, boxed(b"mdat", &data)].concat()
    }

    fn meta(&self, items: &[(&[u8; 4], &[u8])], mut place: u32) -> Vec<u8> {
        let handler = boxed(b"hdlr", &[&[0; 8], b"pict", &[0; 13]]);
        let primary = boxed(b"pitm", &[&[0; 4], &1u16.to_be_bytes()]);
        let count = (items.len() as u16).to_be_bytes();
        // Places and lengths of four bytes, no base.
        let mut places = vec![0, 0, 0, 0, 0x44, 0];
        places.extend(count);
        let (mut infos, mut about) = (Vec::new(), Vec::new());
        for (number, (name, bytes)) in (1u16..).zip(items) {
            let number = number.to_be_bytes();
            places.extend([number, [0, 0], [0, 1]].concat());
            places.extend(place.to_be_bytes());
            places.extend((bytes.len() as u32).to_be_bytes());
            place += bytes.len() as u32;
            let mime: &[u8] = if *name == b"mime" { b"\0application/rdf+xml\0" } else { b"\0" };
            // Version 2; items other than the picture are hidden.
            let hidden = u8::from(*name != b"av01");
            infos.extend(boxed(b"infe", &[&[2, 0, 0, hidden], &number, &[0, 0], *name, mime]));
            if hidden == 1 {
                about.extend(boxed(b"cdsc", &[&number, &[0, 1, 0, 1]]));
            }
        }
        let references = if about.is_empty() { about } else { boxed(b"iref", &[&[0; 4], &about]) };
        let content = [
            handler,
            primary,
            boxed(b"iloc", &[&places]),
            boxed(b"iinf", &[&[0; 4], &count, &infos]),
            references,
            self.properties(),
        ]
        .concat();
        boxed(b"meta", &[&[0; 4], &content])
    }

    /// Properties of the picture, all of them its own.
    fn properties(&self) -> Vec<u8> {
        let [primaries, curve] = self.named.map(u16::to_be_bytes);
        let mut properties = vec![
            boxed(b"ispe", &[&[0; 4], &self.width.to_be_bytes(), &self.height.to_be_bytes()]),
            boxed(b"pixi", &[&[0; 4], &[3, self.bits, self.bits, self.bits]]),
            boxed(b"av1C", &[&self.coded.configuration]),
            boxed(b"colr", &[b"nclx", &primaries, &curve, &self.matrix.to_be_bytes(), &[FULL_RANGE]]),
        ];
        if !self.profile.is_empty() {
            properties.push(boxed(b"colr", &[b"prof", self.profile]));
        }
        let mut owned = vec![0, 0, 0, 0, 0, 0, 0, 1, 0, 1, properties.len() as u8];
        // Who cannot make use of the configuration must not show the picture.
        owned.extend((1..=properties.len() as u8).map(|i| if i == 3 { 0x80 | i } else { i }));
        boxed(b"iprp", &[&boxed(b"ipco", &[&properties.concat()]), &boxed(b"ipma", &[&owned])])
    }
}

fn boxed(name: &[u8; 4], parts: &[&[u8]]) -> Vec<u8> {
    let content = parts.concat();
    [&(content.len() as u32 + 8).to_be_bytes(), &name[..], &content].concat()
}
