//! The X-Trans array, and the weights with which each of its sites predicts.

use darkroot_photo::Cfa;

use super::super::kriging::{COLOURFUL, DIRECTIONS, GREYISH, NOISE, solve};

/// Samples within this distance, and half a pixel more, predict.
pub(super) const REACH: usize = 4;

/// Columns and rows after which the array repeats.
pub(super) const PERIOD: usize = 6;
/// The array of every X-Trans sensor, but for where it begins.
const ARRAY: [&[u8; PERIOD]; PERIOD] = [b"GBGGRG", b"RGRBGB", b"GBGGRG", b"GRGGBG", b"BGBRGR", b"GRGGBG"];

/// The array's colour (0 red, 1 green, 2 blue) in column `x` of row `y`.
pub(super) fn colour(x: usize, y: usize) -> usize {
    match ARRAY[y % PERIOD][x % PERIOD] {
        b'R' => 0,
        b'G' => 1,
        _ => 2,
    }
}

/// Column and row of the X-Trans array at which `cfa` begins; `None` for any other array.
pub(in super::super) fn phase(cfa: &Cfa) -> Option<(usize, usize)> {
    let places = (0..PERIOD * PERIOD).map(|i| (i % PERIOD, i / PERIOD));
    let same =
        |x: usize, y: usize, (u, v): (usize, usize)| cfa.at(x, y).plane() == Some(colour(x + u, y + v));
    let six = cfa.width() == PERIOD && cfa.height() == PERIOD;
    places.clone().find(|&begin| six && places.clone().all(|(x, y)| same(x, y, begin)))
}

/// Models of the picture.
pub(super) const MODELS: usize = 8;
/// A number for each model.
pub(super) type Each = [f32; MODELS];

/// What predicts at one place of the array: weights of the samples of [`reached`], in their order.
pub(super) struct Site {
    /// Colour of the place.
    pub(super) own: usize,
    /// For the two other colours.
    pub(super) missing: [Vec<Each>; 2],
    /// For the error of predicting the place's own sample without itself.
    pub(super) error: Vec<Each>,
}

/// Places of the samples that predict, from the pixel: columns and rows.
pub(super) fn reached() -> Vec<(isize, isize)> {
    let reach = REACH as isize;
    let square = (-reach..=reach).flat_map(|dy| (-reach..=reach).map(move |dx| (dx, dy)));
    square.filter(|(dx, dy)| dx * dx + dy * dy <= reach * reach + reach).collect()
}

/// Solves the equations of kriging, every colour's mean being unknown, for column `x` of row `y` of the array.
pub(super) fn site(x: usize, y: usize) -> Site {
    let places = reached();
    let n = places.len();
    let beside = |(dx, dy): (isize, isize)| {
        colour((x + PERIOD).wrapping_add_signed(dx), (y + PERIOD).wrapping_add_signed(dy))
    };
    let own = colour(x, y);
    let others = [(own + 1) % 3, (own + 2) % 3];
    let mut site = Site {
        own,
        missing: [vec![[0.0; MODELS]; n], vec![[0.0; MODELS]; n]],
        error: vec![[0.0; MODELS]; n],
    };
    for number in 0..MODELS {
        let model = if number < MODELS / 2 { GREYISH } else { COLOURFUL };
        let direction = DIRECTIONS[number % (MODELS / 2)];
        let is = |a: usize, b: usize| if a == b { 1.0 } else { 0.0 };
        // Rows: one for each sample, one for each colour's mean. Columns: the same and three right-hand sides.
        let mut rows: Vec<Vec<f64>> = Vec::with_capacity(n + 3);
        for (i, &place) in places.iter().enumerate() {
            let c = beside(place);
            let mut row: Vec<f64> = places
                .iter()
                .map(|&(u, v)| model.likeness(direction, (u - place.0, v - place.1), beside((u, v)) == c))
                .collect();
            row[i] += NOISE;
            row.extend([0, 1, 2].map(|mean| is(c, mean)));
            row.extend(others.map(|other| model.likeness(direction, place, c == other)));
            row.push(if place == (0, 0) { 1.0 } else { 0.0 });
            rows.push(row);
        }
        for mean in 0..3 {
            let mut row: Vec<f64> = places.iter().map(|&place| is(beside(place), mean)).collect();
            row.extend([0.0; 3]);
            row.extend(others.map(|other| is(other, mean)));
            row.push(0.0);
            rows.push(row);
        }
        solve(&mut rows);
        // The error is the solution for the unit vector of the own sample over its own coefficient (Dubrule).
        let whole = rows[places.iter().position(|&place| place == (0, 0)).unwrap_or(0)][n + 5];
        for (i, row) in rows.iter().take(n).enumerate() {
            site.missing[0][i][number] = row[n + 3] as f32;
            site.missing[1][i][number] = row[n + 4] as f32;
            site.error[i][number] = (row[n + 5] / whole) as f32;
        }
    }
    site
}
