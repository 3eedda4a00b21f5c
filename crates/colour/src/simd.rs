//! Loops compiled for the vectors of the processor at hand.

/// Runs `work` compiled for AVX2 where the processor has it.
///
/// `work` and what it calls must be `#[inline(always)]`, so that they become part of the code that is compiled for
/// AVX2. `pulp` itself takes an `FnOnce`; most closures have a separate function for that trait, which is compiled for
/// the oldest processor and too large to be inlined. Calling the closure as `FnMut` avoids it. Additions and
/// multiplications are never fused, so the results are the same on every processor.
#[inline(always)]
pub fn vectorised(work: impl FnMut()) {
    #[cfg(target_arch = "x86_64")]
    match pulp::x86::V3::try_new() {
        Some(avx2) => pulp::Simd::vectorize(avx2, Work(work)),
        None => pulp::Simd::vectorize(pulp::Scalar, Work(work)),
    }
    #[cfg(not(target_arch = "x86_64"))]
    pulp::Arch::new().dispatch(Work(work));
}

/// The same, and for AVX-512 where the processor has that: once more code, so for loops that gain by it.
#[inline(always)]
pub fn vectorised_widely(work: impl FnMut()) {
    pulp::Arch::new().dispatch(Work(work));
}

struct Work<F>(F);

impl<F: FnMut()> pulp::WithSimd for Work<F> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: pulp::Simd>(mut self, _: S) {
        (self.0)();
    }
}
