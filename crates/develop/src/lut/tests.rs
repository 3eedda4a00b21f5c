use super::*;
use darkroot_photo::Size;

fn one(v: [f32; 3]) -> Rgb<Toned> {
    Rgb::from_planes(Size { width: 1, height: 1 }, v.map(|v| vec![v])).unwrap()
}

fn close(a: [f32; 3], b: [f32; 3], within: f32) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() <= within)
}

/// A table of `size`^3 nodes that holds a function.
fn cube(size: usize, of: impl Fn([f32; 3]) -> [f32; 3]) -> Cube {
    let at = |i: usize| i as f32 / (size - 1) as f32;
    let nodes = (0..size.pow(3)).map(|i| of([at(i / (size * size)), at(i / size % size), at(i % size)]));
    Cube::new(size, [[0.0; 3], [1.0; 3]], nodes.collect()).unwrap()
}

fn overlay(step: Step) -> Overlay {
    Overlay { lut: Arc::new(Lut { steps: vec![step] }), space: RgbSpace::SRGB }
}

/// Colours of all kinds, the corners of the cube among them.
fn colours() -> impl Iterator<Item = [f32; 3]> {
    let levels = [0.0f32, 0.013, 0.21, 0.5, 0.77, 1.0];
    (0..216).map(move |i| [levels[i % 6], levels[i / 6 % 6], levels[i / 36]])
}

#[test]
fn tetrahedra_hold_what_is_straight_between_nodes_and_keep_greys() {
    // Straight, so exact whichever tetrahedron is taken.
    let mix = |v: [f32; 3]| [0.2 + 0.5 * v[0], 0.3 * v[0] + 0.6 * v[2], 0.9 * v[1] - 0.1 * v[2]];
    let table = cube(5, mix);
    for v in colours() {
        assert!(close(table.at(v), mix(v), 1e-6), "{v:?}");
    }
    // A bent table: greys are weighted along the diagonal alone, so channels stay alike.
    let bent = cube(4, |v| v.map(|x| x * x * x));
    for i in 0..=100 {
        let [r, g, b] = bent.at([i as f32 / 100.0; 3]);
        assert!((r - g).abs() < 1e-6 && (g - b).abs() < 1e-6, "{i}");
    }
    assert_eq!(table.at([-3.0, f32::NAN, 9.0]), table.at([0.0, 0.0, 1.0]));
}

#[test]
fn tetrahedra_are_those_of_slow_weights() {
    // A node is 1 and all others 0: its weight is the distance in the tetrahedron, computed from sorted parts.
    for corner in 0..8usize {
        let nodes = (0..8).map(|i| [if i == corner { 1.0 } else { 0.0 }; 3]).collect();
        let table = Cube::new(2, [[0.0; 3], [1.0; 3]], nodes).unwrap();
        let inside = [corner >> 2 & 1, corner >> 1 & 1, corner & 1];
        for v in colours() {
            // Least of the axes that the corner has, less the greatest of those that it has not.
            let has = (0..3).filter(|c| inside[*c] == 1).map(|c| v[c]).fold(1.0, f32::min);
            let lacks = (0..3).filter(|c| inside[*c] == 0).map(|c| v[c]).fold(0.0, f32::max);
            assert!((table.at(v)[0] - (has - lacks).max(0.0)).abs() < 1e-6, "{corner} {v:?}");
        }
    }
}

#[test]
fn a_table_that_changes_nothing_changes_nothing() {
    let laid = Laid::of(&overlay(Step::Cube(cube(2, |v| v)))).unwrap();
    let to_cones = rows(&from_rgb(&RgbSpace::SRGB));
    for v in colours() {
        let cones = times(to_cones, v);
        assert!(close(look_up(one(cones), &laid).at(0, 0), cones, 2e-5), "{v:?}");
    }
}

#[test]
fn what_treats_channels_alike_is_a_tone_curve_and_what_does_not_is_none() {
    let gamma = Power { exponent: 1.2, offset: None, outside: Outside::Cut, direction: Direction::Forward };
    let table = |tables: Vec<Vec<f32>>| Step::Curves(Curves::new(Entries::UNIT, tables).unwrap());
    let tall = vec![0.0, 0.7, 1.0];
    for (step, expected) in [
        (Step::Matrix([[0.9, 0.0, 0.0], [0.0, 0.9, 0.0], [0.0, 0.0, 0.9]], [0.05; 3]), true),
        (Step::Matrix([[0.9, 0.1, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], [0.0; 3]), false),
        (table(vec![tall.clone()]), true),
        (table(vec![tall.clone(), tall.clone(), tall.clone()]), true),
        (table(vec![tall.clone(), tall, vec![0.0, 0.5, 1.0]]), false),
        (Step::Power([gamma; 3]), true),
        (Step::Power([gamma, gamma, Power { exponent: 1.0, ..gamma }]), false),
        (Step::Cube(cube(2, |v| v)), false),
    ] {
        let lut = Lut { steps: vec![step] };
        assert_eq!(lut.is_one_curve(), expected, "{lut:?}");
    }
}

#[test]
fn tables_over_halves_hold_every_half_and_what_lies_between() {
    let table: Vec<f32> = (0..=u16::MAX).map(|bits| 3.0 * curves::half(bits)).collect();
    let curves = Curves::new(Entries::Halves, vec![table]).unwrap();
    for v in [0.0f32, 1e-7, 5.96e-8, 3.1e-5, 0.18, 0.5, 1.0, 1.37, 100.0, 60000.0] {
        for v in [v, -v] {
            let [out, ..] = curves.at([v; 3]);
            assert!((out - 3.0 * v).abs() <= 3e-6 * v.abs(), "{v} {out}");
        }
    }
    assert!((curves.at([1e9; 3])[0] - 3.0 * 65504.0).abs() < 1.0);
}

#[test]
fn formulas_are_undone_by_their_inverses() {
    let both = [Direction::Forward, Direction::Reverse];
    let camera = |direction| Log {
        base: 10.0,
        lin_slope: 5.555_556,
        lin_offset: 0.052_272,
        log_slope: 0.247_19,
        log_offset: 0.385_537,
        direction,
        ..Log::plain(10.0, direction)
    };
    for v in [0.001f32, 0.02, 0.18, 0.7, 1.0] {
        let there_and_back = |steps: [Step; 2]| Lut { steps: steps.to_vec() }.at([v; 3]);
        for offset in [None, Some(0.055)] {
            let power = |direction| {
                Step::Power([Power { exponent: 2.4, offset, outside: Outside::Mirrored, direction }; 3])
            };
            assert!(close(there_and_back(both.map(power)), [v; 3], 1e-5), "{v} {offset:?}");
        }
        let logs = both.map(|direction| Step::Log([camera(direction).straight_below(0.010_591, None); 3]));
        assert!(close(there_and_back(logs), [v; 3], 1e-5), "{v}");
        let cdl = both.map(|direction| {
            let (slope, offset, power) = ([1.1, 0.9, 1.0], [0.02, -0.0001, 0.0], [1.1, 0.9, 1.2]);
            Step::Cdl(Cdl { slope, offset, power, saturation: 0.8, clamp: false, direction })
        });
        assert!(close(there_and_back(cdl), [v; 3], 1e-4), "{v}");
    }
    // sRGB's curve by its usual numbers.
    let srgb =
        Power { exponent: 2.4, offset: Some(0.055), outside: Outside::Cut, direction: Direction::Forward };
    for coded in [0.01f32, 0.04, 0.3, 0.9] {
        let expected = RgbSpace::SRGB.curve.decode(f64::from(coded)) as f32;
        assert!((srgb.at(coded) - expected).abs() < 2e-6, "{coded}");
    }
}

#[test]
fn tables_of_wrong_sizes_are_none() {
    assert!(Cube::new(3, [[0.0; 3], [1.0; 3]], vec![[0.0; 3]; 8]).is_none());
    assert!(Cube::new(2, [[0.0; 3], [0.0; 3]], vec![[0.0; 3]; 8]).is_none());
    assert!(Cube::new(2, [[0.0; 3], [1.0; 3]], vec![[f32::NAN; 3]; 8]).is_none());
    assert!(Curves::new(Entries::UNIT, vec![vec![0.0]]).is_none());
    assert!(Curves::new(Entries::UNIT, vec![vec![0.0, 1.0]; 2]).is_none());
    assert!(Curves::new(Entries::Halves, vec![vec![0.0, 1.0]]).is_none());
}
