//! Loops compiled for the vectors of the processor at hand.

/// Runs `work` compiled for AVX2 where the processor has it.
///
/// A closure handed to `pulp` itself is called by `FnOnce::call_once`, for most closures a shim that is compiled
/// for the least processor and too large to be inlined; called by `FnMut` there is none. `work` must be
/// `#[inline(always)]`, and so must be what it calls. Additions and multiplications are never fused, so the
/// results are the same on every processor.
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
