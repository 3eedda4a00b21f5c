//! Cameras that the decoders know, with the color matrices that their makers or Adobe published.

use darkroot_colour::Matrix3;
use flashraw_camera_db::{CAMERAS, MATRICES};

/// A camera with its published matrix for D65.
#[derive(Debug, Clone, PartialEq)]
pub struct Listed {
    /// Maker's common name.
    pub make: String,
    /// Model's common name, without the maker.
    pub model: String,
    /// XYZ to camera RGB, for D65.
    pub color_matrix: Matrix3,
}

impl Listed {
    /// Maker and model in one.
    pub fn name(&self) -> String {
        format!("{} {}", self.make, self.model)
    }
}

/// Whether a matrix is one of the published ones, to the digits that these have.
pub fn is_listed(color_matrix: &Matrix3) -> bool {
    let values: [i32; 9] = std::array::from_fn(|i| (color_matrix[(i / 3, i % 3)] * 10_000.0).round() as i32);
    let own = CAMERAS.iter().map(|c| c.color_matrix);
    own.chain(MATRICES.iter().map(|m| m.color_matrix)).any(|listed| *listed == values)
}

/// Every camera with a usable matrix, by name, each once.
pub fn cameras() -> Vec<Listed> {
    let listed = |make: &str, model: &str, matrix: &[i32]| {
        let values: [i32; 9] = matrix.try_into().ok()?;
        let color_matrix = Matrix3::from_row_slice(&values.map(|v| f64::from(v) / 10_000.0));
        color_matrix.try_inverse()?;
        let model = model.strip_prefix(make).map_or(model, str::trim);
        Some(Listed { make: make.to_owned(), model: model.to_owned(), color_matrix })
    };
    let own = CAMERAS.iter().filter_map(|c| listed(c.canonical_make, c.canonical_model, c.color_matrix));
    let fallback = MATRICES.iter().filter_map(|m| listed(m.canonical_make, m.model_prefix, m.color_matrix));
    let mut all: Vec<Listed> = own.chain(fallback).collect();
    // A stable sort: a camera's own matrix comes before the fallback of the same name.
    all.sort_by_cached_key(|c| c.name().to_lowercase());
    all.dedup_by_key(|c| c.name().to_lowercase());
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_are_hundreds_of_cameras_each_once() {
        let all = cameras();
        assert!(all.len() > 600, "{}", all.len());
        let d850 = all.iter().find(|c| c.name() == "Nikon D850").unwrap();
        assert!((d850.color_matrix[(0, 0)] - 1.0405).abs() < 1e-9, "{}", d850.color_matrix);
        assert!(is_listed(&d850.color_matrix));
        assert!(!is_listed(&(d850.color_matrix * 1.001)));
        assert!(all.windows(2).all(|pair| pair[0].name().to_lowercase() < pair[1].name().to_lowercase()));
    }
}
