//! Half of the multiplications: through every place of the X-Trans array there is a line over which the array is its own
//! mirror image, but that a diagonal line exchanges red and blue. So are the equations of kriging, and their solutions:
//! two mirrored models weight two mirrored samples alike. With weights `a` and `b` of a sample and its image, one model
//! sums `a s + b t` and its image `b s + a t`; from the sums of `(a + b)/2 (s + t)` and of `(a - b)/2 (s - t)` both
//! follow, with half the products.

use std::sync::LazyLock;

use super::parts::{LANES, Lanes, lanes};
use super::sites::{Each, MODELS, PERIOD, Site, colour, reached, site};

/// A line through a pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Mirror {
    /// Exchanges left and right.
    Upright,
    /// Exchanges above and below.
    Level,
    /// Exchanges columns and rows.
    Diagonal,
    /// The other diagonal.
    Antidiagonal,
}

impl Mirror {
    const ALL: [Self; 4] = [Self::Upright, Self::Level, Self::Diagonal, Self::Antidiagonal];

    fn image(self, (dx, dy): (isize, isize)) -> (isize, isize) {
        match self {
            Self::Upright => (-dx, dy),
            Self::Level => (dx, -dy),
            Self::Diagonal => (dy, dx),
            Self::Antidiagonal => (-dy, -dx),
        }
    }

    fn is_diagonal(self) -> bool {
        matches!(self, Self::Diagonal | Self::Antidiagonal)
    }

    /// Directions that stay themselves, and two that become each other, by their numbers in `kriging::DIRECTIONS`.
    fn directions(self) -> ([usize; 2], [usize; 2]) {
        if self.is_diagonal() { ([1, 3], [0, 2]) } else { ([0, 2], [1, 3]) }
    }

    /// The line over which the array is mirrored in column `x` of row `y`.
    fn at(x: usize, y: usize) -> Self {
        let there = |(dx, dy): (isize, isize)| {
            colour((x + PERIOD).wrapping_add_signed(dx), (y + PERIOD).wrapping_add_signed(dy))
        };
        let holds = |mirror: &&Self| {
            reached().into_iter().all(|place| {
                let (here, image) = (there(place), there(mirror.image(place)));
                if mirror.is_diagonal() { here + image == 2 } else { here == image }
            })
        };
        *Self::ALL.iter().find(holds).unwrap_or(&Self::Upright)
    }
}

/// A site whose weights are those of sums and differences of mirrored samples.
pub(super) struct Mirrored {
    /// Colour of the place.
    pub(super) own: usize,
    /// Samples on the line and those beside it with their images, as numbers in [`reached`].
    on_line: Vec<usize>,
    beside: Vec<[usize; 2]>,
    error: Itself,
    missing: Missing,
    /// Models in the order in which [`Itself`] predicts.
    order: [usize; MODELS],
    /// The model whose image each model is.
    image: [usize; MODELS],
}

/// What the mirror makes of the predictions of the two colours that a place has not.
enum Missing {
    /// Each is its own image.
    Itself([Itself; 2]),
    /// They are each other's image. Weights of four models each.
    Exchanged { sums: [Weights<4>; 2], differences: [Weights<4>; 2] },
}

/// Weights with which one thing is predicted under all models, if it is its own image: of every kind of models two whose
/// direction is its own image and two whose directions are each other's.
struct Itself {
    sums: Weights<6>,
    differences: Weights<2>,
}

/// For each folded sample the weights in so many sums.
struct Weights<const N: usize>(Vec<[f32; N]>);

impl<const N: usize> Weights<N> {
    #[inline(always)]
    fn sum(&self, samples: &[Lanes]) -> [Lanes; N] {
        let mut sums = [[0f32; LANES]; N];
        for (samples, weights) in samples.iter().zip(&self.0) {
            for (sum, weight) in sums.iter_mut().zip(weights) {
                for l in 0..LANES {
                    sum[l] += weight * samples[l];
                }
            }
        }
        sums
    }
}

/// Most sums, those on the line among them, and most differences.
const MOST: usize = 40;

/// Samples around [`LANES`] pixels, folded along the line of their site.
pub(super) struct Folded {
    sums: [Lanes; MOST],
    differences: [Lanes; MOST],
}

impl Folded {
    pub(super) const NOTHING: Self = Self { sums: [[0.0; LANES]; MOST], differences: [[0.0; LANES]; MOST] };

    /// `samples` are those from the first pixel's on; `taps` says where in them each of [`reached`] is.
    #[inline(always)]
    pub(super) fn fill(&mut self, samples: &[f32], taps: &[usize], site: &Mirrored) {
        let (line, rest) = self.sums.split_at_mut(site.on_line.len());
        for (out, &number) in line.iter_mut().zip(&site.on_line) {
            *out = lanes(&samples[taps[number]..]);
        }
        for ((sum, difference), &[a, b]) in rest.iter_mut().zip(&mut self.differences).zip(&site.beside) {
            let (a, b) = (lanes(&samples[taps[a]..]), lanes(&samples[taps[b]..]));
            for l in 0..LANES {
                sum[l] = a[l] + b[l];
                difference[l] = a[l] - b[l];
            }
        }
    }
}

impl Itself {
    fn of(fold: &Fold, weights: &[Each]) -> Self {
        let ([a, b], [c, _]) = fold.mirror.directions();
        Self {
            sums: fold.sums(weights, [a, b, c, a + KIND, b + KIND, c + KIND]),
            differences: fold.differences(weights, [c, c + KIND]),
        }
    }

    #[inline(always)]
    fn predict(&self, folded: &Folded) -> [Lanes; MODELS] {
        let [a, b, c, d, e, f] = self.sums.sum(&folded.sums);
        let [g, h] = self.differences.sum(&folded.differences);
        [a, b, plus(c, g), minus(c, g), d, e, plus(f, h), minus(f, h)]
    }
}

/// What is predicted under each model, and which model each prediction is of.
pub(super) type Predictions<'a> = ([Lanes; MODELS], &'a [usize; MODELS]);

impl Mirrored {
    fn of(site: &Site, mirror: Mirror) -> Self {
        let fold = Fold::along(mirror);
        let missing = if mirror.is_diagonal() {
            let models = |kind: usize| std::array::from_fn(|direction| kind * KIND + direction);
            Missing::Exchanged {
                sums: [0, 1].map(|kind| fold.sums(&site.missing[0], models(kind))),
                differences: [0, 1].map(|kind| fold.differences(&site.missing[0], models(kind))),
            }
        } else {
            Missing::Itself([0, 1].map(|i| Itself::of(&fold, &site.missing[i])))
        };
        let ([a, b], [c, d]) = mirror.directions();
        let mut image = [0, 1, 2, 3, 4, 5, 6, 7];
        image.swap(c, d);
        image.swap(c + KIND, d + KIND);
        Self {
            own: site.own,
            error: Itself::of(&fold, &site.error),
            missing,
            order: [a, b, c, d, a + KIND, b + KIND, c + KIND, d + KIND],
            image,
            on_line: fold.on_line,
            beside: fold.beside,
        }
    }

    /// Errors of predicting the place's own sample.
    #[inline(always)]
    pub(super) fn error(&self, folded: &Folded) -> Predictions<'_> {
        (self.error.predict(folded), &self.order)
    }

    /// The two colours after the place's own.
    #[inline(always)]
    pub(super) fn missing(&self, folded: &Folded) -> [Predictions<'_>; 2] {
        match &self.missing {
            Missing::Itself([one, other]) => {
                [(one.predict(folded), &self.order), (other.predict(folded), &self.order)]
            }
            Missing::Exchanged { sums, differences } => {
                let [a, b, c, d] = sums[0].sum(&folded.sums);
                let [e, f, g, h] = sums[1].sum(&folded.sums);
                let [i, j, k, l] = differences[0].sum(&folded.differences);
                let [m, n, o, p] = differences[1].sum(&folded.differences);
                let pairs = [(a, i), (b, j), (c, k), (d, l), (e, m), (f, n), (g, o), (h, p)];
                let (mut first, mut second) = ([[0.0; LANES]; MODELS], [[0.0; LANES]; MODELS]);
                for (n, (sum, difference)) in pairs.into_iter().enumerate() {
                    first[n] = plus(sum, difference);
                    second[n] = minus(sum, difference);
                }
                [(first, &MODEL_BY_MODEL), (second, &self.image)]
            }
        }
    }
}

const MODEL_BY_MODEL: [usize; MODELS] = [0, 1, 2, 3, 4, 5, 6, 7];
/// Models of one kind, one for each direction.
const KIND: usize = MODELS / 2;

#[inline(always)]
fn plus(a: Lanes, b: Lanes) -> Lanes {
    let mut sum = a;
    for l in 0..LANES {
        sum[l] += b[l];
    }
    sum
}

#[inline(always)]
fn minus(a: Lanes, b: Lanes) -> Lanes {
    let mut difference = a;
    for l in 0..LANES {
        difference[l] -= b[l];
    }
    difference
}

/// Which samples are folded onto which.
struct Fold {
    mirror: Mirror,
    on_line: Vec<usize>,
    beside: Vec<[usize; 2]>,
}

impl Fold {
    fn along(mirror: Mirror) -> Self {
        let places = reached();
        let mut fold = Self { mirror, on_line: Vec::new(), beside: Vec::new() };
        for (number, &place) in places.iter().enumerate() {
            let image = places.iter().position(|&other| other == mirror.image(place)).unwrap_or(number);
            match image.cmp(&number) {
                std::cmp::Ordering::Equal => fold.on_line.push(number),
                std::cmp::Ordering::Greater => fold.beside.push([number, image]),
                std::cmp::Ordering::Less => {}
            }
        }
        fold
    }

    fn sums<const N: usize>(&self, weights: &[Each], models: [usize; N]) -> Weights<N> {
        let line = self.on_line.iter().map(|&at| models.map(|model| weights[at][model]));
        let half = |&[a, b]: &[usize; 2]| models.map(|model| 0.5 * (weights[a][model] + weights[b][model]));
        Weights(line.chain(self.beside.iter().map(half)).collect())
    }

    fn differences<const N: usize>(&self, weights: &[Each], models: [usize; N]) -> Weights<N> {
        let half = |&[a, b]: &[usize; 2]| models.map(|model| 0.5 * (weights[a][model] - weights[b][model]));
        Weights(self.beside.iter().map(half).collect())
    }
}

/// The sites of the array. It looks the same three columns and three rows on, so three rows have them all.
static SITES: LazyLock<Vec<Mirrored>> = LazyLock::new(|| {
    let place = |i: usize| (i % PERIOD, i / PERIOD);
    (0..PERIOD * PERIOD / 2).map(place).map(|(x, y)| Mirrored::of(&site(x, y), Mirror::at(x, y))).collect()
});

/// The site in column `x` of row `y` of the array.
pub(super) fn site_at(x: usize, y: usize) -> &'static Mirrored {
    let x = if y % PERIOD < 3 { x } else { x + 3 };
    &SITES[y % 3 * PERIOD + x % PERIOD]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_place_of_the_array_has_its_mirror() {
        let diagonal =
            (0..PERIOD * PERIOD).filter(|i| Mirror::at(i % PERIOD, i / PERIOD).is_diagonal()).count();
        // Four of nine: the corners of the squares of three.
        assert_eq!(diagonal, 16);
        for i in 0..PERIOD * PERIOD {
            let (x, y) = (i % PERIOD, i / PERIOD);
            let (site, mirror) = (site(x, y), Mirror::at(x, y));
            let fold = Fold::along(mirror);
            let (_, [c, d]) = mirror.directions();
            let image = |model: usize| match model % KIND {
                m if m == c => model - c + d,
                m if m == d => model - d + c,
                _ => model,
            };
            let exchanged = usize::from(mirror.is_diagonal());
            for [a, b] in fold.beside.iter().copied().chain(fold.on_line.iter().map(|&a| [a, a])) {
                for model in 0..MODELS {
                    let alike = |v: f32, w: f32| assert!((v - w).abs() < 1e-6, "{v} {w} at {x},{y}");
                    alike(site.error[a][model], site.error[b][image(model)]);
                    for colour in 0..2 {
                        alike(
                            site.missing[colour][a][model],
                            site.missing[colour ^ exchanged][b][image(model)],
                        );
                    }
                }
            }
        }
    }
}
