//! A target with a geometry of its own: a grid, greys and slanted edges beside it, described by a layout file.

use darkroot_colour::{Lab, RgbSpace, Vector3, white};

use super::*;

/// Pixels a millimetre, and the blur of edges in pixels.
const SCALE: f64 = 8.0;
const BLUR: f64 = 0.8;
/// The target's corner in the picture, and how it leans.
const CORNER: [f64; 2] = [70.0, 60.0];
const LEAN: f64 = 1.5;

/// Colours of the grid of 4 x 3 patches of 10 mm, 2 mm apart.
const GRID: [(&str, [f64; 3]); 12] = [
    ("A1", [38.0, 14.0, 15.0]),
    ("B1", [65.0, 19.0, 18.0]),
    ("C1", [50.0, -4.0, -22.0]),
    ("D1", [43.0, -13.0, 23.0]),
    ("A2", [62.0, 33.0, 52.0]),
    ("B2", [40.0, 11.0, -42.0]),
    ("C2", [51.0, 46.0, 17.0]),
    ("D2", [72.0, -24.0, 50.0]),
    ("A3", [92.0, 0.0, 0.0]),
    ("B3", [70.0, 0.0, 0.0]),
    ("C3", [50.0, 0.0, 0.0]),
    ("D3", [30.0, 0.0, 0.0]),
];
/// Greys below it, in two rows of four.
const GREYS: [f64; 8] = [95.0, 84.0, 74.0, 64.0, 54.0, 44.0, 34.0, 22.0];
/// A dark square of 12 mm at the right, five degrees from the grid, in a light field of 20 x 24 mm.
const FIELD: [f64; 4] = [52.0, 5.0, 72.0, 29.0];
const SQUARE: [f64; 2] = [62.0, 17.0];

fn square() -> [[f64; 2]; 4] {
    let (sin, cos) = 5f64.to_radians().sin_cos();
    [[-6.0, -6.0], [6.0, -6.0], [6.0, 6.0], [-6.0, 6.0]]
        .map(|[x, y]| [SQUARE[0] + x * cos - y * sin, SQUARE[1] + x * sin + y * cos])
}

fn grey_at(i: usize) -> [f64; 4] {
    let (x, y) = (12.0 * (i % 4) as f64, 40.0 + 12.0 * (i / 4) as f64);
    [x, y, x + 10.0, y + 10.0]
}

fn corners_of([left, top, right, bottom]: [f64; 4]) -> [[f64; 2]; 4] {
    [[left, top], [right, top], [right, bottom], [left, bottom]]
}

/// The integral of a normal distribution (Abramowitz and Stegun, 26.2.17: wrong by 7.5e-8).
fn normal(v: f64) -> f64 {
    let t = 1.0 / (1.0 + 0.231_641_9 * v.abs());
    let series = t
        * (0.319_381_53
            + t * (-0.356_563_782 + t * (1.781_477_937 + t * (-1.821_255_978 + t * 1.330_274_429))));
    let beyond = (-v * v / 2.0).exp() / (2.0 * std::f64::consts::PI).sqrt() * series;
    if v < 0.0 { beyond } else { 1.0 - beyond }
}

/// The target as a PNG in sRGB, under a Gaussian blur.
fn picture() -> Vec<u8> {
    let mut shapes: Vec<([[f64; 2]; 4], [f64; 3])> = Vec::new();
    for (i, (_, lab)) in GRID.iter().enumerate() {
        let (x, y) = (12.0 * (i % 4) as f64, 12.0 * (i / 4) as f64);
        shapes.push((corners_of([x, y, x + 10.0, y + 10.0]), *lab));
    }
    shapes.extend(GREYS.iter().enumerate().map(|(i, l)| (corners_of(grey_at(i)), [*l, 0.0, 0.0])));
    shapes.push((corners_of(FIELD), [80.0, 0.0, 0.0]));
    shapes.push((square(), [42.0, 0.0, 0.0]));
    let to_srgb = RgbSpace::SRGB.from_xyz_under(white::D50);
    let linear = |[l, a, b]: [f64; 3]| to_srgb * Vector3::from(Lab { l, a, b }.xyz(white::D50));
    let shapes: Vec<_> = shapes.into_iter().map(|(corners, lab)| (corners, linear(lab))).collect();
    let background = linear([24.0, 0.0, 0.0]);
    let (sin, cos) = LEAN.to_radians().sin_cos();
    let picture = image::ImageBuffer::from_fn(760, 660, |x, y| {
        let (dx, dy) = (f64::from(x) - CORNER[0], f64::from(y) - CORNER[1]);
        let (u, v) = ((dx * cos + dy * sin) / SCALE, (-dx * sin + dy * cos) / SCALE);
        let mut light = background;
        for (corners, colour) in &shapes {
            let side = |i: usize| {
                let ([ax, ay], [bx, by]) = (corners[i], corners[(i + 1) % 4]);
                ((bx - ax) * (v - ay) - (by - ay) * (u - ax)) / (bx - ax).hypot(by - ay)
            };
            let inside = (0..4).map(side).fold(f64::INFINITY, f64::min);
            light += (colour - light) * normal(inside * SCALE / BLUR);
        }
        let code = |v: f64| (RgbSpace::SRGB.curve.encode(v.clamp(0.0, 1.0)) * 65535.0).round() as u16;
        image::Rgb([code(light[0]), code(light[1]), code(light[2])])
    });
    let mut png = std::io::Cursor::new(Vec::new());
    picture.write_to(&mut png, image::ImageFormat::Png).unwrap();
    png.into_inner()
}

fn layout() -> String {
    let mut text =
        "name = \"house\"\ntitle = \"House target\"\ncolumns = 4\nrows = 3\ngap = 0.2\nsize = [46, 34]\n"
            .to_owned();
    for (name, lab) in GRID {
        text += &format!("[[patch]]\nname = \"{name}\"\nlab = {lab:?}\n");
    }
    for (i, l) in GREYS.iter().enumerate() {
        text += &format!("[[beside]]\nname = \"K{i}\"\nlab = [{l}, 0, 0]\nat = {:?}\n", grey_at(i));
    }
    let square = square();
    for i in 0..4 {
        text += &format!("[[edge]]\nfrom = {:?}\nto = {:?}\nclear = 3\n", square[i], square[(i + 1) % 4]);
    }
    text
}

fn reference() -> String {
    let mut text =
        "CGATS.17\nBEGIN_DATA_FORMAT\nSAMPLE_ID LAB_L LAB_A LAB_B\nEND_DATA_FORMAT\nBEGIN_DATA\n".to_owned();
    for (name, [l, a, b]) in GRID {
        text += &format!("{name} {l} {a} {b}\n");
    }
    GREYS.iter().enumerate().for_each(|(i, l)| text += &format!("K{i} {l} 0 0\n"));
    text + "END_DATA\n"
}

#[test]
fn a_target_with_slanted_edges_beside_its_grid_is_found_and_all_of_it_is_measured() {
    let desk = Desk::new();
    desk.put("house.png", picture());
    desk.put("house.toml", layout());
    desk.put("house.cie", reference());
    let asked = ["verify", "house.png", "--chart", "house.toml", "--reference", "house.cie"];
    let run = desk.run(&[&asked[..], &["--json", "--report", "r.html"]].concat());
    let told = figures(&run);
    let number = |place: &str| told.pointer(place).and_then(serde_json::Value::as_f64).unwrap();
    assert!(number("/de2000/max") < 0.2, "{}", told["de2000"]);
    // Four of the grid and eight beside it.
    assert_eq!(told["greys"].as_array().unwrap().len(), 12, "{}", told["greys"]);
    assert_eq!(told["windows"].as_array().unwrap().len(), 20);
    // exp(-2 (pi s f)^2) is a half at 0.1874 / s.
    let sfr50 = number("/edges/sfr50");
    assert!(
        (sfr50 / (0.187_39 / BLUR) - 1.0).abs() < 0.03 && told["edges"]["count"] == 4,
        "{}",
        told["edges"]
    );
    assert!(number("/edges/misregistration") < 0.02 && number("/edges/peak") < 1.0, "{}", told["edges"]);
    // The layout has millimetres, so the pixels an inch follow without `--chart-pitch`.
    let inch = number("/scale/pixels_an_inch");
    assert!((inch / (25.4 * SCALE) - 1.0).abs() < 0.005, "{inch}");
    let page = String::from_utf8(desk.read("r.html")).unwrap();
    assert!(page.contains(">K7<") && page.contains("slanted edges"));
    // The same by corners that are given by hand.
    let (sin, cos) = LEAN.to_radians().sin_cos();
    let place = |[x, y]: [f64; 2]| {
        let (x, y) = (x * SCALE, y * SCALE);
        format!("{},{}", CORNER[0] + x * cos - y * sin, CORNER[1] + x * sin + y * cos)
    };
    let corners = corners_of([0.0, 0.0, 46.0, 34.0]).map(place).join(",");
    let by_hand = figures(&desk.run(&[&asked[..], &["--json", "--corners", &corners]].concat()));
    let difference = by_hand["edges"]["sfr50"].as_f64().unwrap() - sfr50;
    assert!(difference.abs() < 0.002, "{difference}");
}

#[test]
fn what_is_wrong_with_a_target_is_said() {
    let desk = Desk::new();
    desk.put("house.png", picture());
    desk.put("house.cie", reference().replace("K3 64 0 0\n", ""));
    desk.put("house.toml", layout());
    let asked = ["verify", "house.png", "--chart", "house.toml", "--reference", "house.cie"];
    desk.fails(1, &asked, &["house.png", "K3"]);
    desk.put("house.toml", layout().replace("size = [46, 34]\n", ""));
    desk.fails(2, &asked, &["house.toml", "`size`"]);
    // What stands beside the grid must be in the picture.
    desk.put("house.cie", reference());
    desk.put("house.toml", layout().replace("at = [0.0, 40.0, 10.0, 50.0]", "at = [0.0, 90.0, 10.0, 99.0]"));
    desk.fails(1, &asked, &["house.png", "outside of the picture"]);
}
