//! Pictures in development: three planes of floats, and a type that says what they mean.

use std::marker::PhantomData;

use crate::Size;

/// Linear camera RGB, balanced: the white of the light is (1,1,1).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Camera {}

/// Scene-linear Rec. 2020, unbounded, white (1,1,1).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scene {}

/// Oklab's cone-like responses to the light that a display shall show, 1 = white: a look has been applied.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Toned {}

/// Linear light in the output's primaries: 0..=1 after a look, unbounded in the linear look.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Display {}

/// A picture of three planes in the space `S`.
#[derive(Debug, Clone, PartialEq)]
pub struct Rgb<S> {
    size: Size,
    planes: [Vec<f32>; 3],
    space: PhantomData<S>,
}

impl<S> Rgb<S> {
    /// A picture of zeros.
    pub fn black(size: Size) -> Self {
        let plane = || vec![0.0; size.area()];
        Self { size, planes: [plane(), plane(), plane()], space: PhantomData }
    }

    /// A picture of these three planes, row by row; `None` unless each has `size.area()` values.
    pub fn from_planes(size: Size, planes: [Vec<f32>; 3]) -> Option<Self> {
        planes.iter().all(|p| p.len() == size.area()).then_some(Self { size, planes, space: PhantomData })
    }

    /// Takes another size. The values mean nothing then: whoever asks for this writes all of them.
    pub fn resize(&mut self, size: Size) {
        self.size = size;
        for plane in &mut self.planes {
            plane.resize(size.area(), 0.0);
        }
    }

    /// Size in pixels.
    pub fn size(&self) -> Size {
        self.size
    }

    /// The red, green and blue plane, row by row.
    pub fn planes(&self) -> [&[f32]; 3] {
        let [r, g, b] = &self.planes;
        [r, g, b]
    }

    /// The three planes, to be written.
    pub fn planes_mut(&mut self) -> [&mut [f32]; 3] {
        let [r, g, b] = &mut self.planes;
        [r, g, b]
    }

    /// The colour in column `x` of row `y`.
    pub fn at(&self, x: usize, y: usize) -> [f32; 3] {
        let i = y * self.size.width + x;
        [self.planes[0][i], self.planes[1][i], self.planes[2][i]]
    }

    /// The same planes as another space. Only a stage that has just changed their meaning may say this.
    pub fn into_space<T>(self) -> Rgb<T> {
        Rgb { size: self.size, planes: self.planes, space: PhantomData }
    }
}
