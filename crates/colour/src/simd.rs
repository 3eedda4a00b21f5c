//! Loops compiled for the vectors of the processor at hand.

/// Runs `work` compiled for AVX2 where the processor has it.
///
/// `work` and what it calls must be `#[inline(always)]`, so that they become part of the code that is compiled for
/// AVX2. `pulp` itself takes an `FnOnce`; most closures have a separate function for that trait, which is compiled for
/// the oldest processor and too large to be inlined. Calling the closure as `FnMut` avoids it. Additions and
/// multiplications are never fused, so the results are the same on every processor.
#[inline(always)]
pub fn vectorised(work: impl FnMut()) {
    struct Work<F>(F);
    impl<F: FnMut()> pulp::WithSimd for Work<F> {
        type Output = ();
        #[inline(always)]
        fn with_simd<S: pulp::Simd>(mut self, _: S) {
            (self.0)();
        }
    }
    pulp::Arch::new().dispatch(Work(work));
}
