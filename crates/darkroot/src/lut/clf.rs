//! Common LUT Format (Academy S-2014-006, version 3): every step that the format has.
//!
//! Steps count in the bits that they state; here all are scaled so that 1 is white.

use std::str::FromStr;

use darkroot_develop::lut::{
    Cdl, Cube, Curves, Direction, Entries, Log, Lut, Outside, Power, Range, Step, half,
};
use roxmltree::{Document, Node, ParsingOptions};

use super::LutFault;

/// Each costs every pixel its time.
const MOST_STEPS: usize = 64;
/// No file has more elements.
const MOST_NODES: u32 = 10_000;

pub(super) fn parse(text: &str) -> Result<Lut, LutFault> {
    let options = ParsingOptions { allow_dtd: false, nodes_limit: MOST_NODES, ..ParsingOptions::default() };
    let document = Document::parse_with_options(text, options)
        .map_err(|e| LutFault::Xml { message: crate::shown(&e.to_string()) })?;
    let root = document.root_element();
    if root.tag_name().name() != "ProcessList" {
        return Err(LutFault::NoProcess { root: root.tag_name().name().to_owned() });
    }
    let mut steps = Vec::new();
    for node in root.children().filter(Node::is_element) {
        match node.tag_name().name() {
            "Description" | "InputDescriptor" | "OutputDescriptor" | "Info" => {}
            "Matrix" => steps.push(matrix(node)?),
            "LUT1D" => steps.push(curves(node)?),
            "LUT3D" => steps.push(cube(node)?),
            "Range" => steps.push(range(node)?),
            "Exponent" => steps.push(power(node)?),
            "Log" => steps.push(log(node)?),
            "ASC_CDL" => steps.push(cdl(node)?),
            other => return Err(LutFault::Step { element: other.to_owned() }),
        }
    }
    match steps.len() {
        0 => Err(LutFault::Empty),
        1..=MOST_STEPS => Ok(Lut { steps }),
        count => Err(LutFault::Steps { count, most: MOST_STEPS }),
    }
}

fn fault(step: &'static str, part: &'static str) -> LutFault {
    LutFault::Part { step, part }
}

fn child<'a, 'd>(node: Node<'a, 'd>, name: &str) -> Option<Node<'a, 'd>> {
    node.children().find(|c| c.tag_name().name() == name)
}

/// What 1 is in the bits that a step takes or gives.
fn white(node: Node<'_, '_>, attribute: &str) -> Option<f32> {
    match node.attribute(attribute)? {
        "8i" => Some(255.0),
        "10i" => Some(1023.0),
        "12i" => Some(4095.0),
        "16i" => Some(65535.0),
        "16f" | "32f" => Some(1.0),
        _ => None,
    }
}

fn scales(node: Node<'_, '_>, step: &'static str) -> Result<(f32, f32), LutFault> {
    let of = |name| white(node, name).ok_or_else(|| fault(step, name));
    Ok((of("inBitDepth")?, of("outBitDepth")?))
}

fn number<T: FromStr + Into<f64> + Copy>(text: &str) -> Option<T> {
    text.trim().parse().ok().filter(|v: &T| (*v).into().is_finite())
}

/// Numbers with white space between them; those that are none make it none.
fn numbers(text: &str) -> Option<Vec<f32>> {
    text.split_whitespace().map(number).collect()
}

/// The element `Array`: its sizes and its text.
fn array<'d>(node: Node<'d, '_>, step: &'static str) -> Result<(Vec<usize>, &'d str), LutFault> {
    let array = child(node, "Array").ok_or_else(|| fault(step, "Array"))?;
    let sizes =
        array.attribute("dim").and_then(|dim| dim.split_whitespace().map(|n| n.parse().ok()).collect());
    Ok((sizes.ok_or_else(|| fault(step, "dim"))?, array.text().unwrap_or_default()))
}

fn matrix(node: Node<'_, '_>) -> Result<Step, LutFault> {
    const STEP: &str = "Matrix";
    let (into, out) = scales(node, STEP)?;
    let (sizes, text) = array(node, STEP)?;
    let values = numbers(text).ok_or_else(|| fault(STEP, "Array"))?;
    let columns = match (&sizes[..2.min(sizes.len())], values.len()) {
        ([3, 3], 9) => 3,
        ([3, 4], 12) => 4,
        _ => return Err(fault(STEP, "dim")),
    };
    let at = |r: usize, c: usize| values[r * columns + c];
    let rows = [0, 1, 2].map(|r| [0, 1, 2].map(|c| at(r, c) * into / out));
    let offset = [0, 1, 2].map(|r| if columns == 4 { at(r, 3) / out } else { 0.0 });
    Ok(Step::Matrix(rows, offset))
}

fn curves(node: Node<'_, '_>) -> Result<Step, LutFault> {
    const STEP: &str = "LUT1D";
    let (_, out) = scales(node, STEP)?;
    let (sizes, text) = array(node, STEP)?;
    let [length, channels @ (1 | 3)] = sizes[..] else { return Err(fault(STEP, "dim")) };
    let is = |name| node.attribute(name) == Some("true");
    // Bits of halves, where the file says so, are read as the numbers that they stand for.
    let values: Option<Vec<f32>> = if is("rawHalfs") {
        text.split_whitespace().map(|bits| bits.parse().ok().map(half)).collect()
    } else if is("halfDomain") {
        // Entries for what is no number are none themselves.
        text.split_whitespace().map(|v| v.parse().ok()).collect()
    } else {
        numbers(text)
    };
    let values = values.filter(|v| Some(v.len()) == length.checked_mul(channels));
    let values = values.ok_or_else(|| fault(STEP, "Array"))?;
    let scale = if is("rawHalfs") { 1.0 } else { out };
    let channel = |c: usize| values.iter().skip(c).step_by(channels).map(|v| v / scale).collect();
    let entries = if is("halfDomain") { Entries::Halves } else { Entries::UNIT };
    let curves = Curves::new(entries, (0..channels).map(channel).collect());
    curves.map(Step::Curves).ok_or_else(|| fault(STEP, "Array"))
}

fn cube(node: Node<'_, '_>) -> Result<Step, LutFault> {
    const STEP: &str = "LUT3D";
    let (_, out) = scales(node, STEP)?;
    let (sizes, text) = array(node, STEP)?;
    let [size, same, again, 3] = sizes[..] else { return Err(fault(STEP, "dim")) };
    if size != same || size != again {
        return Err(fault(STEP, "dim"));
    }
    let values = numbers(text).ok_or_else(|| fault(STEP, "Array"))?;
    let nodes = values.chunks_exact(3).map(|v| [v[0] / out, v[1] / out, v[2] / out]).collect();
    let cube = Cube::new(size, [[0.0; 3], [1.0; 3]], nodes).filter(|_| values.len() % 3 == 0);
    cube.map(Step::Cube).ok_or_else(|| fault(STEP, "Array"))
}

fn range(node: Node<'_, '_>) -> Result<Step, LutFault> {
    const STEP: &str = "Range";
    let (into, out) = scales(node, STEP)?;
    let value = |name: &'static str, white: f32| match child(node, name) {
        Some(at) => match at.text().and_then(number::<f32>) {
            Some(v) => Ok(Some(v / white)),
            None => Err(fault(STEP, name)),
        },
        None => Ok(None),
    };
    let (min_in, max_in) = (value("minInValue", into)?, value("maxInValue", into)?);
    let (min_out, max_out) = (value("minOutValue", out)?, value("maxOutValue", out)?);
    let pairs = (min_in.zip(min_out), max_in.zip(max_out));
    let (scale, offset) = match pairs {
        (Some((a, to_a)), Some((b, to_b))) if b > a => {
            let scale = (to_b - to_a) / (b - a);
            (scale, to_a - scale * a)
        }
        (Some((a, to_a)), None) => (1.0, to_a - a),
        (None, Some((b, to_b))) => (1.0, to_b - b),
        _ => return Err(fault(STEP, "minInValue")),
    };
    let clamps = node.attribute("style") != Some("noClamp");
    let end = |value: Option<f32>, none: f32| value.filter(|_| clamps).unwrap_or(none);
    Ok(Step::Range(Range { scale, offset, least: end(min_out, f32::MIN), most: end(max_out, f32::MAX) }))
}

/// What a step says of each channel by elements of that name, of which one without `channel` is for all three.
fn by_channel<T: Copy>(
    node: Node<'_, '_>,
    name: &str,
    default: Option<T>,
    read: impl Fn(Node<'_, '_>) -> Option<T>,
) -> Option<[T; 3]> {
    let mut found = [default; 3];
    for parameters in node.children().filter(|c| c.tag_name().name() == name) {
        let value = Some(read(parameters)?);
        match parameters.attribute("channel") {
            None => found = [value; 3],
            Some("R") => found[0] = value,
            Some("G") => found[1] = value,
            Some("B") => found[2] = value,
            Some(_) => return None,
        }
    }
    let [r, g, b] = found;
    Some([r?, g?, b?])
}

fn attribute(node: Node<'_, '_>, name: &str) -> Option<f32> {
    node.attribute(name).and_then(number)
}

fn power(node: Node<'_, '_>) -> Result<Step, LutFault> {
    const STEP: &str = "Exponent";
    let style = node.attribute("style").unwrap_or_default();
    let (kind, direction) = match style.strip_suffix("Rev") {
        Some(kind) => (kind, Direction::Reverse),
        None => (style.strip_suffix("Fwd").ok_or_else(|| fault(STEP, "style"))?, Direction::Forward),
    };
    let (has_foot, outside) = match kind {
        "basic" => (false, Outside::Cut),
        "basicMirror" => (false, Outside::Mirrored),
        "basicPassThru" => (false, Outside::Kept),
        "monCurve" => (true, Outside::Cut),
        "monCurveMirror" => (true, Outside::Mirrored),
        _ => return Err(fault(STEP, "style")),
    };
    let plain = Power { exponent: 1.0, offset: None, outside: Outside::Kept, direction };
    let read = |node: Node<'_, '_>| {
        let exponent = attribute(node, "exponent").filter(|e| *e > 0.0)?;
        let offset = if has_foot { Some(attribute(node, "offset")?) } else { None };
        // A foot without offset is none, and one under a straight line cannot be.
        let offset = offset.filter(|o| *o > 0.0 && exponent > 1.0);
        Some(Power { exponent, offset, outside, direction })
    };
    let powers = by_channel(node, "ExponentParams", Some(plain), read);
    powers.map(Step::Power).ok_or_else(|| fault(STEP, "ExponentParams"))
}

fn log(node: Node<'_, '_>) -> Result<Step, LutFault> {
    const STEP: &str = "Log";
    use Direction::{Forward, Reverse};
    let plain = |base, direction| Ok(Step::Log([Log::plain(base, direction); 3]));
    let (direction, of_camera) = match node.attribute("style").unwrap_or_default() {
        "log10" => return plain(10.0, Forward),
        "log2" => return plain(2.0, Forward),
        "antiLog10" => return plain(10.0, Reverse),
        "antiLog2" => return plain(2.0, Reverse),
        "linToLog" => (Forward, false),
        "logToLin" => (Reverse, false),
        "cameraLinToLog" => (Forward, true),
        "cameraLogToLin" => (Reverse, true),
        _ => return Err(fault(STEP, "style")),
    };
    let read = |node: Node<'_, '_>| {
        let or = |name, default: f32| match node.attribute(name) {
            Some(text) => number(text),
            None => Some(default),
        };
        let log = Log {
            base: or("base", 2.0)?,
            lin_slope: or("linSideSlope", 1.0)?,
            lin_offset: or("linSideOffset", 0.0)?,
            log_slope: or("logSideSlope", 1.0)?,
            log_offset: or("logSideOffset", 0.0)?,
            ..Log::plain(2.0, direction)
        };
        let usable = log.base > 1.0 && log.lin_slope > 0.0 && log.log_slope.abs() > 0.0;
        if !usable {
            return None;
        }
        if !of_camera {
            return Some(log);
        }
        let slope = match node.attribute("linearSlope") {
            Some(text) => Some(number(text).filter(|s: &f32| s.abs() > 0.0)?),
            None => None,
        };
        let from = attribute(node, "linSideBreak")?;
        (log.lin_slope * from + log.lin_offset > 0.0).then(|| log.straight_below(from, slope))
    };
    by_channel(node, "LogParams", None, read).map(Step::Log).ok_or_else(|| fault(STEP, "LogParams"))
}

fn cdl(node: Node<'_, '_>) -> Result<Step, LutFault> {
    const STEP: &str = "ASC_CDL";
    let (direction, clamp) = match node.attribute("style").unwrap_or("Fwd") {
        "Fwd" => (Direction::Forward, true),
        "Rev" => (Direction::Reverse, true),
        "FwdNoClamp" => (Direction::Forward, false),
        "RevNoClamp" => (Direction::Reverse, false),
        _ => return Err(fault(STEP, "style")),
    };
    let three = |name: &'static str, default: f32, fits: fn(f32) -> bool| {
        let Some(at) = child(node, "SOPNode").and_then(|sop| child(sop, name)) else {
            return Ok([default; 3]);
        };
        let values = at.text().and_then(numbers).filter(|v| v.iter().all(|v| fits(*v)));
        values.and_then(|v| v.try_into().ok()).ok_or_else(|| fault(STEP, name))
    };
    let saturation = match child(node, "SatNode").and_then(|sat| child(sat, "Saturation")) {
        Some(at) => at.text().and_then(number).filter(|v: &f32| *v >= 0.0),
        None => Some(1.0),
    };
    let back = direction == Direction::Reverse;
    let cdl = Cdl {
        slope: three("Slope", 1.0, |v| v >= 0.0)?,
        offset: three("Offset", 0.0, |_| true)?,
        power: three("Power", 1.0, |v| v > 0.0)?,
        saturation: saturation.ok_or_else(|| fault(STEP, "Saturation"))?,
        clamp,
        direction,
    };
    let undoable = cdl.saturation > 0.0 && cdl.slope.iter().all(|s| *s > 0.0);
    if back && !undoable { Err(fault(STEP, "Slope")) } else { Ok(Step::Cdl(cdl)) }
}
