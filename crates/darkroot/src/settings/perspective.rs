//! The setting of perspective: its row of the table, and what its texts mean.

use darkroot_develop::{Lines, Marks, Perspective};

use super::setting::{Changes, Group, Kind, Setting};
use super::table::put;
use super::text::{NotAValue, number};

pub(super) const PERSPECTIVE: Setting = Setting {
    name: "perspective",
    alias: None,
    noun: "perspective",
    kind: Kind::Text {
        form: "off, the corners of what shall become a rectangle, from the top left one clockwise (X,Y,X,Y,X,Y,X,Y), or lines \
               X,Y,X,Y that shall be upright or level, one or two of a kind (vertical:... or horizontal:..., or both with ; \
               between them); in pixels, or all with %",
        example: "\"310,205,1720,190,1755,1280,290,1262\" or \"vertical:10%,5%,14%,90%,88%,5%,85%,92%\"",
    },
    default: "off",
    group: Group::Picture,
    placeholder: "MARKS",
    help: "What shall be straight: corners X,Y,X,Y,X,Y,X,Y of a rectangle (a painting, a front), clockwise from the top left; or \
           vertical:X,Y,X,Y,X,Y,X,Y, two lines that are upright (one tells the lean alone), and horizontal: for level ones, \
           both with ; between them. In pixels of the upright picture, or all with %; off",
    changes: Changes::Picture,
    set: |to, text| put(&mut to.recipe.geometry.perspective, perspective(text)),
};

/// What was marked, or off.
fn perspective(text: &str) -> Result<Option<Perspective>, NotAValue> {
    if text == "off" {
        return Ok(None);
    }
    let wrong = || NotAValue::of(&PERSPECTIVE, text);
    let shares = text.contains('%');
    let places = |text: &str| places(text, shares);
    if !text.contains(':') {
        let corners = places(text).and_then(|all| all.try_into().ok()).ok_or_else(wrong)?;
        return Ok(Some(Perspective { by: Marks::Corners(corners), shares }));
    }
    let (mut vertical, mut horizontal) = (None, None);
    for part in text.split(';') {
        let (name, marks) = part.split_once(':').ok_or_else(wrong)?;
        let lines = match places(marks).as_deref() {
            Some(&[a, b]) => Lines::One([a, b]),
            Some(&[a, b, c, d]) => Lines::Two([[a, b], [c, d]]),
            _ => return Err(wrong()),
        };
        let kind = match name.trim() {
            "vertical" => &mut vertical,
            "horizontal" => &mut horizontal,
            _ => return Err(wrong()),
        };
        if kind.replace(lines).is_some() {
            return Err(wrong());
        }
    }
    Ok(Some(Perspective { by: Marks::Lines { vertical, horizontal }, shares }))
}

/// Columns and rows, all of them with % or none.
fn places(text: &str, shares: bool) -> Option<Vec<[f64; 2]>> {
    let one = |text: &str| {
        let text = text.trim();
        let value = if shares { number(text.strip_suffix('%')?).ok()? / 100.0 } else { number(text).ok()? };
        value.is_finite().then_some(value)
    };
    let all: Vec<f64> = text.split(',').map(one).collect::<Option<_>>()?;
    all.len().is_multiple_of(2).then(|| all.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_are_read_as_people_write_them() {
        let by = |text| perspective(text).map(|asked| asked.map(|asked| (asked.by, asked.shares)));
        assert_eq!(by("off"), Ok(None));
        let corners = [[1.0, 2.0], [3.0, 4.5], [5.0, 6.0], [7.0, 8.0]];
        assert_eq!(by("1,2,3,4.5,5,6,7,8"), Ok(Some((Marks::Corners(corners), false))));
        let vertical = Some(Lines::Two([[[0.1, 0.05], [0.14, 0.9]], [[0.88, 0.05], [0.5, 1.0]]]));
        let found = by("vertical:10%,5%,14%,90%, 88%,5%,50%,100%");
        assert_eq!(found, Ok(Some((Marks::Lines { vertical, horizontal: None }, true))));
        let vertical = Some(Lines::One([[1.0, 2.0], [3.0, 40.0]]));
        let horizontal = Some(Lines::Two([[[0.0, 1.0], [9.0, 1.0]], [[0.0, 8.0], [9.0, 7.0]]]));
        let found = by("horizontal:0,1,9,1,0,8,9,7; vertical:1,2,3,40");
        assert_eq!(found, Ok(Some((Marks::Lines { vertical, horizontal }, false))));
        for wrong in [
            "1,2,3",
            "1,2,3,4,5,6,7,inf",
            "a,2,3,4,5,6,7,8",
            "vertical:1,2,3",
            "vertical:",
            "upright:1,2,3,4",
            "vertical:1,2,3,4;vertical:1,2,3,4",
            "vertical:1,2,3,4,5,6",
            "vertical:1%,2%,3%,4",
            "1,2,3,4,5,6,7,8;vertical:1,2,3,4",
        ] {
            assert!(perspective(wrong).is_err(), "{wrong}");
        }
    }
}
