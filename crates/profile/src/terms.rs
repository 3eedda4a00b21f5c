//! The terms of a root polynomial: r^i g^j b^k to the power 1/n, with i + j + k = n.

/// Order of a root polynomial: the highest degree before the root is taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Order {
    /// r, g, b: a matrix.
    One,
    /// 6 terms.
    Two,
    /// 13 terms.
    Three,
    /// 22 terms. The paper prints 25, three of which equal terms of order 2.
    Four,
}

impl Order {
    /// From 1, 2, 3 or 4.
    pub fn new(order: u8) -> Option<Self> {
        [Self::One, Self::Two, Self::Three, Self::Four].into_iter().find(|o| o.number() == order)
    }

    /// 1, 2, 3 or 4.
    pub fn number(self) -> u8 {
        self as u8 + 1
    }

    /// Terms of this order and all below, in the paper's sequence.
    pub fn terms(self) -> &'static [Term] {
        let count = match self {
            Self::One => 3,
            Self::Two => 6,
            Self::Three => 13,
            Self::Four => 22,
        };
        &TERMS[..count]
    }
}

/// One term: exponents of r, g and b as exact fractions, `powers[c] / root`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Term {
    /// Powers of r, g and b; they add up to `root`.
    pub powers: [u8; 3],
    /// Which root is taken: 1, 2, 3 or 4.
    pub root: u8,
}

const fn term(r: u8, g: u8, b: u8) -> Term {
    Term { powers: [r, g, b], root: r + g + b }
}

/// All terms in the order of the paper (IEEE TIP 2015, equation 8), duplicates of order 4 left out.
const TERMS: [Term; 22] = [
    term(1, 0, 0),
    term(0, 1, 0),
    term(0, 0, 1),
    // Order 2.
    term(1, 1, 0),
    term(0, 1, 1),
    term(1, 0, 1),
    // Order 3.
    term(1, 2, 0),
    term(0, 1, 2),
    term(1, 0, 2),
    term(2, 1, 0),
    term(0, 2, 1),
    term(2, 0, 1),
    term(1, 1, 1),
    // Order 4.
    term(3, 1, 0),
    term(3, 0, 1),
    term(1, 3, 0),
    term(0, 3, 1),
    term(1, 0, 3),
    term(0, 1, 3),
    term(2, 1, 1),
    term(1, 2, 1),
    term(1, 1, 2),
];

impl Term {
    /// Value for one colour. Linear terms keep their sign; inside roots, negative values count as 0.
    pub fn value(self, rgb: [f64; 3]) -> f64 {
        if self.root == 1 {
            return (0..3).map(|c| f64::from(self.powers[c]) * rgb[c]).sum();
        }
        let root = |v: f64| {
            let v = v.max(0.0);
            match self.root {
                2 => v.sqrt(),
                3 => v.cbrt(),
                _ => v.sqrt().sqrt(),
            }
        };
        (0..3).map(|c| root(rgb[c]).powi(i32::from(self.powers[c]))).product()
    }

    /// Name in profile files, as the paper prints the term: "r", "(rg)^1/2", "(r^2gb)^1/4".
    pub fn name(self) -> String {
        let factors: String = ["r", "g", "b"]
            .iter()
            .zip(self.powers)
            .map(|(letter, power)| match power {
                0 => String::new(),
                1 => (*letter).to_owned(),
                n => format!("{letter}^{n}"),
            })
            .collect();
        if self.root == 1 { factors } else { format!("({factors})^1/{}", self.root) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_term_has_degree_one_and_its_own_name() {
        let mut names: Vec<String> = TERMS.iter().map(|t| t.name()).collect();
        assert!(TERMS.iter().all(|t| t.powers.iter().sum::<u8>() == t.root));
        names.sort();
        names.dedup();
        assert_eq!(names.len(), 22);
    }

    #[test]
    fn terms_of_grey_are_the_grey() {
        for term in TERMS {
            assert!((term.value([0.3; 3]) - 0.3).abs() < 1e-15, "{}", term.name());
        }
    }

    #[test]
    fn only_linear_terms_keep_a_negative_sign() {
        assert!(TERMS[0].value([-0.1, 0.5, 0.5]) < 0.0);
        assert!(TERMS[3..].iter().all(|t| t.value([-0.1, 0.5, 0.5]) >= 0.0));
    }
}
