//! Samples of the three types that files hold.

use darkroot_photo::Samples;

/// A sample of a picture: `u8`, `u16` or `f32`.
pub trait Sample: bytemuck::Pod + Send + Sync + sealed::Sealed {
    /// Bits that it has.
    const BITS: u8;

    /// What is stored instead of it, as the difference to its left neighbour; floating point stays as it is.
    #[doc(hidden)]
    fn less(self, left: Self) -> Self;

    /// Adds its bytes, the highest one first.
    #[doc(hidden)]
    fn put_big_endian(samples: &[Self], bytes: &mut Vec<u8>);
}

impl Sample for u8 {
    const BITS: Self = 8;

    fn less(self, left: Self) -> Self {
        self.wrapping_sub(left)
    }

    fn put_big_endian(samples: &[Self], bytes: &mut Vec<u8>) {
        bytes.extend_from_slice(samples);
    }
}

impl Sample for u16 {
    const BITS: u8 = 16;

    fn less(self, left: Self) -> Self {
        self.wrapping_sub(left)
    }

    fn put_big_endian(samples: &[Self], bytes: &mut Vec<u8>) {
        bytes.extend(samples.iter().flat_map(|s| s.to_be_bytes()));
    }
}

impl Sample for f32 {
    const BITS: u8 = 32;

    fn less(self, _: Self) -> Self {
        self
    }

    fn put_big_endian(samples: &[Self], bytes: &mut Vec<u8>) {
        bytes.extend(samples.iter().flat_map(|s| s.to_be_bytes()));
    }
}

mod sealed {
    pub trait Sealed {}
    impl Sealed for u8 {}
    impl Sealed for u16 {}
    impl Sealed for f32 {}
}

/// Work that is the same for samples of every type.
pub(crate) trait ForSamples {
    /// What it makes.
    type Made;

    /// Does it.
    fn with<T: Sample>(self, samples: &[T]) -> Self::Made;

    /// Does it with those of a picture.
    fn with_all(self, samples: &Samples) -> Self::Made
    where
        Self: Sized,
    {
        match samples {
            Samples::U8(v) => self.with(v),
            Samples::U16(v) => self.with(v),
            Samples::F32(v) => self.with(v),
        }
    }
}
