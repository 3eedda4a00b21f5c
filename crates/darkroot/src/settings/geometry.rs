//! Settings of how the picture lies in the frame: their rows of the table, and what their texts mean.

use darkroot_develop::{Crop, Flip, Lens, Resize, Turn};

use super::setting::{Changes, Group, Kind, Setting, Word};
use super::table::put;
use super::text::{NotAValue, number, numbers, one_of};
use super::words::{AUTO, SWITCH, plain, word};

const TURNS: [Word<Turn>; 4] = [
    word("0", Turn::None, ""),
    word("90", Turn::Right, "Clockwise"),
    word("180", Turn::Half, ""),
    word("270", Turn::Left, "Clockwise, or 90 anticlockwise"),
];
const FLIPS: [Word<Flip>; 3] = [
    word("off", Flip::None, ""),
    word("horizontal", Flip::Horizontal, "Left becomes right"),
    word("vertical", Flip::Vertical, "Top becomes bottom"),
];
const LENSES: [Word<Lens>; 5] = [
    word(AUTO, Lens::Auto, "What the file carries; in the linear look and in camera RGB none"),
    word("file", Lens::File, "What the file carries"),
    word("lensfun", Lens::Lensfun, "What the file carries, else what lensfun's database has of the lens"),
    word(
        "maker",
        Lens::Maker,
        "What the file carries, else what the maker's note says, which nobody has checked against pictures of the camera, else what \
         lensfun's database has of the lens",
    ),
    word("off", Lens::Off, "None"),
];

pub(super) const ROTATE: Setting = Setting {
    name: "rotate",
    alias: None,
    noun: "turn",
    kind: Kind::Words(const { &plain(&TURNS) }),
    default: "0",
    group: Group::Picture,
    placeholder: "",
    help: "Degrees by which the picture that the camera calls upright is turned, clockwise",
    changes: Changes::Picture,
    set: |to, text| put(&mut to.recipe.geometry.turn, one_of(&TURNS, text)),
};

pub(super) const FLIP: Setting = Setting {
    name: "flip",
    alias: None,
    noun: "mirroring",
    kind: Kind::Words(const { &plain(&FLIPS) }),
    default: "off",
    group: Group::Picture,
    placeholder: "",
    help: "Mirroring, after the turn",
    changes: Changes::Picture,
    set: |to, text| put(&mut to.recipe.geometry.flip, one_of(&FLIPS, text)),
};

pub(super) const STRAIGHTEN: Setting = Setting {
    name: "straighten",
    alias: None,
    noun: "angle",
    kind: Kind::Text { form: "auto, or degrees from -45 to 45", example: "\"auto\" or \"-1.5\"" },
    default: "0",
    group: Group::Picture,
    placeholder: "DEGREES",
    help: "Degrees by which the picture is then turned clockwise and cut to what is whole, -45 to 45; auto: what level and \
           upright lines say, where they are sure",
    changes: Changes::Picture,
    set: |to, text| {
        let geometry = &mut to.recipe.geometry;
        let degrees =
            if text == AUTO { Some(0.0) } else { number(text).ok().filter(|d| (-45.0..=45.0).contains(d)) };
        geometry.auto_straighten = text == AUTO;
        geometry.straighten =
            degrees.ok_or_else(|| NotAValue::plain(text, "angle", "auto, or degrees from -45 to 45"))?;
        Ok(())
    },
};

pub(super) const LENS: Setting = Setting {
    name: "lens",
    alias: None,
    noun: "correction of the lens",
    kind: Kind::Words(const { &plain(&LENSES) }),
    default: AUTO,
    group: Group::Picture,
    placeholder: "",
    help: "Which correction of the lens is applied: distortion, lateral chromatic aberration and, from lensfun and makers' notes, vignetting",
    changes: Changes::Picture,
    set: |to, text| put(&mut to.recipe.geometry.lens, one_of(&LENSES, text)),
};

pub(super) const LENS_NAME: Setting = Setting {
    name: "lens-name",
    alias: None,
    noun: "name of a lens",
    kind: Kind::Text {
        form: "auto (what the file says), or the name of a lens as lensfun has it",
        example: "\"Nikkor AF-S 18-55mm f/3.5-5.6G DX VR\"",
    },
    default: AUTO,
    group: Group::Picture,
    placeholder: "NAME",
    help: "Lens to look up with --lens lensfun and maker, where the file names none, or only its numbers; auto: what the file says",
    changes: Changes::Picture,
    set: |to, text| {
        to.recipe.lens_name = match text.trim() {
            "" => return Err(NotAValue::of(&LENS_NAME, text)),
            AUTO => None,
            name => Some(name.to_owned()),
        };
        Ok(())
    },
};

pub(super) const VIGNETTING: Setting = Setting {
    name: "vignetting",
    alias: None,
    noun: "switch",
    kind: Kind::Switch,
    default: "true",
    group: Group::Picture,
    placeholder: "BOOL",
    help: "Whether light that the lens lost towards the edges is made good, with --lens lensfun and maker",
    changes: Changes::Picture,
    set: |to, text| put(&mut to.recipe.geometry.keep_vignetting, one_of(&SWITCH, text).map(|on| !on)),
};

pub(super) const FRINGES: Setting = Setting {
    name: "ca",
    alias: None,
    noun: "switch",
    kind: Kind::Switch,
    default: "true",
    group: Group::Picture,
    placeholder: "BOOL",
    help: "Whether lateral chromatic aberration is corrected: as the file or lensfun has it, else as the picture itself shows it",
    changes: Changes::Picture,
    set: |to, text| put(&mut to.recipe.geometry.keep_fringes, one_of(&SWITCH, text).map(|on| !on)),
};

pub(super) const CROP: Setting = Setting {
    name: "crop",
    alias: None,
    noun: "crop",
    kind: Kind::Text {
        form: "default (what the maker or the file shows), active (everything that light falls on), a ratio of sides (3:2), a share \
               (80%), or a rectangle X,Y,WIDTH,HEIGHT in pixels of the developed picture",
        example: "\"3:2\" or \"120,80,3000,2000\"",
    },
    default: "default",
    group: Group::Picture,
    placeholder: "CROP",
    help: "Which part of the frame: default (what the maker or the file shows), active (everything that light falls on), 3:2, 80% of \
           each side, or X,Y,WIDTH,HEIGHT in pixels",
    changes: Changes::Picture,
    set: |to, text| put(&mut to.recipe.crop, crop(text)),
};

pub(super) const RESIZE: Setting = Setting {
    name: "resize",
    alias: None,
    noun: "size",
    kind: Kind::Text {
        form: "off, long:PIXELS or short:PIXELS (of that side), WIDTHxHEIGHT (as large as fits), a share (50%), or mp:MEGAPIXELS",
        example: "\"long:2048\" or \"50%\"",
    },
    default: "off",
    group: Group::Picture,
    placeholder: "SIZE",
    help: "Size: long:2048 or short:1080 (pixels of that side), 1920x1080 (as large as fits), 50%, mp:2 (megapixels), off",
    changes: Changes::Picture,
    set: |to, text| put(&mut to.recipe.geometry.resize, resize(text)),
};

pub(super) const ENLARGE: Setting = Setting {
    name: "enlarge",
    alias: None,
    noun: "switch",
    kind: Kind::Switch,
    default: "false",
    group: Group::Picture,
    placeholder: "BOOL",
    help: "Whether --resize may make a picture larger than it is (a share always may)",
    changes: Changes::Picture,
    set: |to, text| put(&mut to.recipe.geometry.enlarge, one_of(&SWITCH, text)),
};

pub(super) const DPI: Setting = Setting {
    name: "dpi",
    alias: None,
    noun: "resolution",
    kind: Kind::Text {
        form: "auto (what the camera wrote), a whole number from 1 to 10000, or chart:MM (by a chart whose patches are so \
               far apart)",
        example: "\"300\"",
    },
    default: AUTO,
    group: Group::Output,
    placeholder: "N",
    help: "Pixels an inch that the file states: 1 to 10000; auto is what the camera wrote; chart:MM what the chart of \
           `--exposure-from-chart` shows, whose patches are MM apart from middle to middle",
    changes: Changes::Encoding,
    set: |to, text| {
        to.chart.pitch = None;
        let Some(pitch) = text.strip_prefix("chart:") else { return put(&mut to.dpi, dpi(text)) };
        to.dpi = None;
        let pitch = number(pitch.strip_suffix("mm").unwrap_or(pitch).trim());
        let pitch = pitch.ok().filter(|pitch| (0.1..=1000.0).contains(pitch));
        to.chart.pitch =
            Some(pitch.ok_or_else(|| NotAValue::plain(text, "resolution", "a distance in millimetres"))?);
        Ok(())
    },
};

/// Pixels an inch.
fn dpi(text: &str) -> Result<Option<u32>, NotAValue> {
    match text {
        AUTO => Ok(None),
        _ => match text.parse() {
            Ok(dpi) if (1..=10_000).contains(&dpi) => Ok(Some(dpi)),
            _ => Err(NotAValue::plain(text, "resolution", "auto, or a whole number from 1 to 10000")),
        },
    }
}

/// A share of the form `50%`, more than 0.
fn share(text: &str) -> Option<f64> {
    let share = number(text.strip_suffix('%')?.trim()).ok()? / 100.0;
    (share > 0.0).then_some(share)
}

/// A crop: default, active, `3:2`, `80%` or `X,Y,WIDTH,HEIGHT`.
fn crop(text: &str) -> Result<Crop, NotAValue> {
    let usage =
        || NotAValue::plain(text, "crop", "default, active, a ratio 3:2, a share 80%, or X,Y,WIDTH,HEIGHT");
    match text {
        "default" => return Ok(Crop::Default),
        "active" => return Ok(Crop::Active),
        _ => {}
    }
    if let Some((a, b)) = text.split_once(':') {
        let sides = [number(a.trim()), number(b.trim())];
        return match sides {
            [Ok(a), Ok(b)] if a > 0.0 && b > 0.0 && a.max(b) <= 100.0 * a.min(b) => {
                Ok(Crop::Aspect(a.max(b) / a.min(b)))
            }
            _ => Err(usage()),
        };
    }
    if text.ends_with('%') {
        return share(text).filter(|share| *share <= 1.0).map(Crop::Share).ok_or_else(usage);
    }
    match numbers::<usize>(text).as_deref() {
        Some(&[x, y, width, height]) if width > 0 && height > 0 => Ok(Crop::Rect { x, y, width, height }),
        _ => Err(usage()),
    }
}

/// A size: off, `long:2048`, `short:1080`, `1920x1080`, `50%` or `mp:2`.
fn resize(text: &str) -> Result<Resize, NotAValue> {
    let usage = || {
        NotAValue::plain(
            text,
            "size",
            "off, long:PIXELS, short:PIXELS, WIDTHxHEIGHT, a share 50%, or mp:MEGAPIXELS",
        )
    };
    let pixels = |text: &str| text.trim().parse::<usize>().ok().filter(|n| *n > 0).ok_or_else(usage);
    if text == "off" {
        return Ok(Resize::None);
    }
    if text.ends_with('%') {
        return share(text).map(Resize::Share).ok_or_else(usage);
    }
    if let Some((kind, value)) = text.split_once(':') {
        return match kind {
            "long" => pixels(value).map(Resize::Long),
            "short" => pixels(value).map(Resize::Short),
            "mp" => {
                number(value.trim()).ok().filter(|mp| *mp > 0.0).map(Resize::Megapixels).ok_or_else(usage)
            }
            _ => Err(usage()),
        };
    }
    match text.split_once(['x', 'X']) {
        Some((width, height)) => Ok(Resize::Fit { width: pixels(width)?, height: pixels(height)? }),
        None => Err(usage()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn crops_are_read_as_people_write_them() {
        assert_eq!(crop("default"), Ok(Crop::Default));
        assert_eq!(crop("3:2"), Ok(Crop::Aspect(1.5)));
        assert_eq!(crop("2:3"), Ok(Crop::Aspect(1.5)));
        assert_eq!(crop("80%"), Ok(Crop::Share(0.8)));
        assert_eq!(crop("1, 2,30,40"), Ok(Crop::Rect { x: 1, y: 2, width: 30, height: 40 }));
        for wrong in
            ["", "3:0", "3:", "-1:2", "1:1000", "0%", "101%", "1,2,3", "1,2,0,4", "1,2,3,-4", "whole"]
        {
            assert!(crop(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn sizes_are_read_as_people_write_them() {
        assert_eq!(resize("off"), Ok(Resize::None));
        assert_eq!(resize("long:2048"), Ok(Resize::Long(2048)));
        assert_eq!(resize("short:1080"), Ok(Resize::Short(1080)));
        assert_eq!(resize("1920x1080"), Ok(Resize::Fit { width: 1920, height: 1080 }));
        assert_eq!(resize("50%"), Ok(Resize::Share(0.5)));
        assert_eq!(resize("mp:2.5"), Ok(Resize::Megapixels(2.5)));
        for wrong in ["", "2048", "long:0", "long:x", "0x5", "5x", "-50%", "mp:0", "mp:-1", "wide:3", "nan%"]
        {
            assert!(resize(wrong).is_err(), "{wrong}");
        }
    }
}
