//! White from neutral, and neutral from the picture, under lights that people measured in rooms and outdoors. Neither the
//! surfaces nor the lights nor the cameras are among those that the program knows.

use darkroot::evaluate::published;
use darkroot::{Photo, ProfileStore, Settings, spectra};
use darkroot_colour::{Illuminant, Matrix3, Spectrum, Vector3, white};
use darkroot_develop::{Balance, CameraMatrix, Recipe, Whites};
use darkroot_photo::{Calibration, Camera, Capture, Counts, Mosaic, Size, WhiteLevel};
use darkroot_profile::Sensitivities;

use super::data;

/// Cameras that are judged, with the names of their matrices.
const CAMERAS: [(&str, &str); 4] = [
    ("camspec_pentax_k5", "Pentax K-5"),
    ("camspec_nikon_d300s", "Nikon D300S"),
    ("camspec_sony_nex5n", "Sony NEX-5N"),
    ("camspec_canon_50d", "Canon EOS 50D"),
];
/// Numbers of lights of Simon Fraser University: daylight in rooms and outdoors, shade, lamps, and mixtures.
const LIGHTS: [usize; 19] = [2, 4, 6, 10, 11, 19, 24, 26, 29, 32, 43, 55, 59, 67, 72, 78, 87, 88, 91];
/// Pictures of each camera under each light.
const SCENES: usize = 5;
/// Blocks of a picture, each of one colour, and their side in pixels.
const ACROSS: usize = 48;
const BLOCK: usize = 8;

/// Numbers that are the same in every run (Knuth's MMIX).
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 11) as f64 + 0.5) / (1u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        (-2.0 * self.unit().ln()).sqrt() * (std::f64::consts::TAU * self.unit()).cos()
    }

    fn below(&mut self, n: usize) -> usize {
        (self.unit() * n as f64) as usize
    }
}

/// A camera as its files have it: its channels are scaled so that daylight's neutral is that of its published matrix.
struct Judged {
    sensitivities: Sensitivities,
    matrix: Matrix3,
}

fn judged() -> Vec<Judged> {
    let published = published::read(&data::folder().join("published_matrices_A_D65.csv")).unwrap();
    let d65 = Illuminant::by_name("D65").unwrap().spectrum();
    let one = |(file, name): &(&str, &str)| {
        let matrix = published.iter().find(|p| p.name() == *name).unwrap().matrix;
        let own = data::camera(file);
        let wanted = matrix * Vector3::from(d65.white());
        let scaled = |c: usize| own.0[c].scaled(wanted[c] / own.0[c].dot(&d65));
        Judged { sensitivities: Sensitivities([scaled(0), scaled(1), scaled(2)]), matrix }
    };
    CAMERAS.iter().map(one).collect()
}

fn lights() -> Vec<Spectrum> {
    let all = spectra::read(&data::folder().join("illum_sfu_measured.csv")).unwrap().lights();
    LIGHTS.iter().map(|i| all[*i].1.clone()).collect()
}

fn neutral(camera: &Sensitivities, light: &Spectrum) -> [f64; 3] {
    camera.0.each_ref().map(|s| s.dot(light))
}

/// Angle between two camera colours, degrees.
fn angle(a: [f64; 3], b: [f64; 3]) -> f64 {
    let (a, b) = (Vector3::from(a), Vector3::from(b));
    (a.dot(&b) / (a.norm() * b.norm())).clamp(-1.0, 1.0).acos().to_degrees()
}

/// Surfaces: the even half of the natural ones and of Simon Fraser's without those that others measured, too (the odd halves
/// served to choose widths), and Esser's chart; each with its CIELAB chroma and hue under D50.
fn surfaces() -> Vec<(Spectrum, f64, f64)> {
    let d50 = Illuminant::by_name("D50").unwrap().spectrum();
    let sfu = spectra::read(&data::folder().join("sfu1995_380-780_4.csv")).unwrap().lights();
    let own = |(name, _): &(String, Spectrum)| {
        let name = name.to_lowercase();
        !["munsell", "macbeth", "dupont"].iter().any(|other| name.contains(other))
    };
    let all = data::reflectances("refl_natural218_400-700_5")
        .into_iter()
        .step_by(2)
        .chain(sfu.into_iter().filter(own).step_by(2).map(|(_, s)| Spectrum(s.0.map(|v| v.min(1.0)))))
        .chain(data::reflectances("refl_iset_esserchart"));
    all.map(|s| {
        let lab = s.reflected_xyz(&d50).lab(d50.white());
        (s, lab.a.hypot(lab.b), lab.b.atan2(lab.a))
    })
    .collect()
}

/// A picture: some surfaces in patches of different sizes, in uneven light. A third of the pictures has mostly one hue, a
/// sixth few surfaces, a sixth mostly greys. Values of blocks, the brightest near 0.9.
fn scene(
    random: &mut Random,
    surfaces: &[(Spectrum, f64, f64)],
    camera: &Sensitivities,
    light: &Spectrum,
) -> Vec<[f64; 3]> {
    let theme = random.below(6);
    let hue = std::f64::consts::TAU * random.unit();
    let wanted = |(_, chroma, own): &(Spectrum, f64, f64)| match theme {
        0 | 1 => {
            let off = (own - hue).sin().atan2((own - hue).cos()) / 0.5;
            0.05 + if *chroma > 12.0 { (-0.5 * off * off).exp() } else { 0.0 }
        }
        2 => {
            if *chroma < 12.0 {
                1.0
            } else {
                0.1
            }
        }
        _ => 1.0,
    };
    let count = if theme == 3 { 3 + random.below(4) } else { 12 + random.below(38) };
    let there = |s: &Spectrum| camera.0.each_ref().map(|c| c.times(light).dot(s));
    let mut patches = Vec::new();
    while patches.len() < count {
        let surface = &surfaces[random.below(surfaces.len())];
        if random.unit() < wanted(surface) {
            let shade = (0.4 * random.normal()).exp();
            let at = (random.unit(), random.unit());
            let size = 0.2 - random.unit().ln() - random.unit().ln();
            patches.push((at, size, there(&surface.0).map(|v| v * shade)));
        }
    }
    let (tilt, slope) = (0.8 * random.normal(), 0.8 * random.normal());
    let mut blocks = Vec::new();
    for y in 0..ACROSS {
        for x in 0..ACROSS {
            let (u, v) = (x as f64 / ACROSS as f64, y as f64 / ACROSS as f64);
            let far = |p: &&((f64, f64), f64, [f64; 3])| (p.0.0 - u).hypot(p.0.1 - v) / p.1;
            let nearest = patches.iter().min_by(|a, b| far(a).total_cmp(&far(b))).unwrap();
            let shade = (tilt * (u - 0.5) + slope * (v - 0.5)).exp();
            blocks.push(nearest.2.map(|v| v * shade * (1.0 + 0.01 * random.normal())));
        }
    }
    let mut brightest: Vec<f64> = blocks.iter().map(|b| b[0].max(b[1]).max(b[2])).collect();
    brightest.sort_by(f64::total_cmp);
    let scale = 0.9 / brightest[brightest.len() * 98 / 100];
    blocks.iter().map(|b| b.map(|v| (v * scale).clamp(0.0, 1.0))).collect()
}

/// The blocks as a raw file of a camera that no profile knows.
fn capture(blocks: &[[f64; 3]], matrix: &Matrix3) -> Capture {
    const WHITE: f64 = 16383.0;
    let size = Size { width: ACROSS * BLOCK, height: ACROSS * BLOCK };
    let sample = |i: usize| {
        let (x, y) = (i % size.width, i / size.width);
        let channel = [0, 1, 1, 2][2 * (y % 2) + x % 2];
        (blocks[(y / BLOCK) * ACROSS + x / BLOCK][channel] * WHITE).round() as u16
    };
    let layout = darkroot_simulate::camera::filters("RGGB");
    let samples = (0..size.width * size.height).map(sample).collect();
    let mut capture = Capture::bare(Counts::U16(Mosaic { size, layout, samples }));
    capture.camera =
        Camera { common_make: "Nobody's".into(), common_model: "Camera".into(), ..Camera::default() };
    capture.white = WhiteLevel([WHITE as f32; 3]);
    capture.calibrations = vec![Calibration {
        kelvin: Some(6504.0),
        color_matrix: *matrix,
        forward_matrix: None,
        camera_calibration: None,
    }];
    capture
}

/// What is said to be the neutral by the mean, by a mean of the sixth power, and by that of edges (van de Weijer, Gevers and
/// Gijsenij, "Edge-based color constancy", IEEE TIP 16(9), 2007).
fn classics(blocks: &[[f64; 3]]) -> [[f64; 3]; 3] {
    let usable: Vec<[f64; 3]> =
        blocks.iter().copied().filter(|b| b.iter().all(|v| (0.002..0.98).contains(v))).collect();
    let mean = |power: i32| {
        [0, 1, 2].map(|c| usable.iter().map(|b| b[c].powi(power)).sum::<f64>().powf(1.0 / f64::from(power)))
    };
    let edge = |c: usize| {
        let at = |x: usize, y: usize| blocks[y * ACROSS + x][c];
        let inner = (1..ACROSS - 1).flat_map(|y| (1..ACROSS - 1).map(move |x| (x, y)));
        let steep = inner.map(|(x, y)| (at(x + 1, y) - at(x - 1, y)).hypot(at(x, y + 1) - at(x, y - 1)));
        steep.map(|e| e.powi(6)).sum::<f64>().powf(1.0 / 6.0)
    };
    [mean(1), mean(6), [edge(0), edge(1), edge(2)]]
}

#[test]
#[cfg_attr(not(has_spectra), ignore = "needs `spectra` in DARKROOT_DATA")]
fn the_white_is_found_in_pictures() {
    let (surfaces, store) = (surfaces(), ProfileStore::builtin());
    let mut random = Random(7);
    let names = ["most probable white", "grey world", "shades of grey", "grey edge"];
    let mut errors: [Vec<f64>; 4] = Default::default();
    for camera in judged() {
        for light in lights() {
            let right = neutral(&camera.sensitivities, &light);
            for _ in 0..SCENES {
                let blocks = scene(&mut random, &surfaces, &camera.sensitivities, &light);
                let photo = Photo::from(capture(&blocks, &camera.matrix));
                let recipe = Recipe { balance: Balance::Auto, ..Recipe::default() };
                let settings = Settings { recipe, ..Settings::default() };
                let plan = photo.plan(&photo.analyse_as_asked(), &store, &settings).unwrap();
                errors[0].push(angle(plan.multipliers().map(|m| 1.0 / f64::from(m)), right));
                for (errors, found) in errors[1..].iter_mut().zip(classics(&blocks)) {
                    errors.push(angle(found, right));
                }
            }
        }
    }
    let mean = |of: &[f64]| of.iter().sum::<f64>() / of.len() as f64;
    let figures = errors.each_mut().map(|of| {
        of.sort_by(f64::total_cmp);
        [mean(of), of[of.len() / 2], mean(&of[of.len() * 3 / 4..])]
    });
    for (name, [mean, median, worst]) in names.iter().zip(figures) {
        println!("{name}: mean {mean:.2}, median {median:.2}, worst quarter {worst:.2} degrees");
    }
    assert!(figures[0][0] < 5.8, "{figures:?}");
    assert!(figures[1..].iter().all(|other| other[0] > 1.4 * figures[0][0] && other[2] > figures[0][2]));
}

/// The neutral of a light gives its chromaticity through the estimated camera. That is about as near as by the matrix alone:
/// what both do not know is the spectrum of lamps, and measured sensitivities do not help (0.0027).
#[test]
#[cfg_attr(not(has_spectra), ignore = "needs `spectra` in DARKROOT_DATA")]
fn the_white_follows_from_the_neutral() {
    let uv = |xy: darkroot_colour::Xy| {
        let d = -2.0 * xy.x + 12.0 * xy.y + 3.0;
        (4.0 * xy.x / d, 9.0 * xy.y / d)
    };
    let mut off = [0.0; 2];
    let mut count = 0.0;
    for camera in judged() {
        let photo = Photo::from(capture(&vec![[0.5; 3]; ACROSS * ACROSS], &camera.matrix));
        let matrix = CameraMatrix::of(photo.capture()).unwrap();
        let estimated = photo.estimated().unwrap();
        let whites = Whites::of(Some(&matrix), Some(&estimated.profile));
        for light in lights() {
            let right = uv(light.white().xy().unwrap());
            let seen = neutral(&camera.sensitivities, &light);
            let found = [whites.white_of(seen).unwrap(), matrix.white_of(seen)];
            for (off, found) in off.iter_mut().zip(found.map(uv)) {
                *off += (found.0 - right.0).hypot(found.1 - right.1);
            }
            count += 1.0;
            // And back.
            let again = whites.neutral_of(found[0]).unwrap();
            assert!(angle(again, seen) < 1e-3, "{}", angle(again, seen));
        }
        let daylight = whites.neutral_of(white::D65_XY).unwrap();
        assert!(angle(daylight, matrix.neutral_of(white::D65_XY).unwrap()) < 1e-6);
    }
    let [camera, by_matrix] = off.map(|o| o / count);
    println!("u'v' off by the estimated camera {camera:.4}, by its matrix {by_matrix:.4}");
    assert!(camera < 0.0031, "{camera} {by_matrix}");
}
