//! Eight pixels at once against one after the other.

use darkroot_photo::correction::{Distortion, Projection};
use darkroot_photo::{CameraSpace, Rect, Rgb, Size};

use super::homography::{moved, scaled, turned};
use super::lens::LensWarp;
use super::resample::{Scratch, one_by_one};
use super::runs::{self, Lines};
use super::warp::Warp;

const AREA: Size = Size { width: 173, height: 131 };

/// Light of some noise and edges, of which some is less than none and one sample no number.
fn light() -> Rgb<CameraSpace> {
    let mut random = 3u32;
    let mut next = |i: usize| {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let edge = if (i / 7).is_multiple_of(5) { 4.0 } else { 0.0 };
        if i == 60 * AREA.width + 80 {
            return f32::NAN;
        }
        edge + (random >> 8) as f32 / (1 << 23) as f32 - 0.2
    };
    let mut plane = || (0..AREA.area()).map(&mut next).collect();
    Rgb::from_planes(AREA, [plane(), plane(), plane()]).unwrap()
}

/// A lens with distortion; one that draws the colours in different sizes, where it `splits`.
fn lens(splits: bool) -> LensWarp {
    let plane = |k: f64| Distortion::from([1.0 + k, 0.02, -0.03, 0.0, 0.001, -0.002]);
    let planes = if splits { vec![plane(0.004), plane(0.0), plane(-0.003)] } else { vec![plane(0.0)] };
    LensWarp::Dng { centre: [86.5, 65.5], reach: 108.0, projection: Projection::Rectilinear, planes }
}

fn part(camera: &Rgb<CameraSpace>, source: Rect) -> Rgb<CameraSpace> {
    let cut = |plane: &[f32]| {
        let rows = plane.chunks_exact(AREA.width).skip(source.y).take(source.height);
        rows.flat_map(|row| row[source.x..source.right()].to_vec()).collect()
    };
    let [r, g, b] = camera.planes();
    Rgb::from_planes(source.size(), [cut(r), cut(g), cut(b)]).unwrap()
}

#[test]
fn eight_at_once_are_what_they_are_one_by_one_to_the_bit() {
    let camera = light();
    let middle = [86.5, 65.5];
    // Turned by right angles and a little more, mirrored, larger by a little, and beyond the edges.
    for (degrees, mirror, zoom) in [
        (0.0, 1.0, 1.0),
        (1.3, 1.0, 0.97),
        (90.0, 1.0, 1.0),
        (180.8, 1.0, 1.03),
        (-91.0, 1.0, 1.0),
        (0.4, -1.0, 1.1),
    ] {
        let to_frame = turned(degrees, middle)
            * moved(middle[0], middle[1])
            * scaled(mirror * zoom, zoom)
            * moved(-middle[0], -middle[1]);
        for splits in [false, true] {
            let warp = Warp::new(to_frame, vec![lens(splits)], AREA, 1.0, 0.0);
            // All of it, and tiles of it that begin anywhere.
            for rect in [
                Rect { x: 0, y: 0, width: 173, height: 131 },
                Rect { x: 3, y: 61, width: 61, height: 9 },
                Rect { x: 101, y: 5, width: 1, height: 40 },
            ] {
                let places = warp.places(rect, 1);
                let source = warp.needs(&places, 1);
                let of_frame = part(&camera, source);
                let lines = Lines::of(&warp.taps, &places).expect("lines that run along the frame");
                let (mut fast, mut slow) = (Rgb::black(rect.size()), Rgb::black(rect.size()));
                let mut scratch = runs::Scratch::default();
                lines.resample(&warp, (&of_frame, source), &places, rect, &mut scratch, &mut fast);
                one_by_one(&warp, (&of_frame, source), &places, rect, &mut Scratch::default(), &mut slow);
                for (fast, slow) in fast.planes().into_iter().zip(slow.planes()) {
                    for (i, (a, b)) in fast.iter().zip(slow).enumerate() {
                        assert_eq!(
                            a.to_bits(),
                            b.to_bits(),
                            "{degrees} {mirror} {splits} {rect:?} {i}: {a} {b}"
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn pictures_of_another_size_have_no_lines_along_the_frame() {
    let rect = Rect { x: 0, y: 0, width: 60, height: 40 };
    for (zoom, reduction) in [(2.0, 2.0), (0.5, 0.5)] {
        let warp = Warp::new(scaled(zoom, zoom), Vec::new(), AREA, reduction, 0.0);
        assert_eq!(Lines::of(&warp.taps, &warp.places(rect, 1)), None);
    }
    // Nor has one that is turned by half a right angle.
    let warp = Warp::new(turned(45.0, [40.0, 40.0]), Vec::new(), AREA, 1.0, 0.0);
    assert_eq!(Lines::of(&warp.taps, &warp.places(rect, 1)), None);
}
