//! Work that is handed out in turn: to all threads, and nearly in order.

use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;

/// Hands the items out to all threads, each thread the next one when it is done with the one before, so that what comes
/// first is done first, but for as many items as there are threads. Each thread keeps one `scratch` for all its items.
///
/// # Errors
/// The first one that some item met; the rest is then not begun.
pub(crate) fn in_turn<I, S, E: Send>(
    items: I,
    scratch: impl Fn() -> S + Sync,
    work: impl Fn(&mut S, I::Item) -> Result<(), E> + Sync,
) -> Result<(), E>
where
    I: Iterator + Send,
{
    let items = Mutex::new(items);
    let next = || items.lock().unwrap_or_else(PoisonError::into_inner).next();
    (0..rayon::current_num_threads()).into_par_iter().with_max_len(1).try_for_each(|_| {
        let mut scratch = scratch();
        while let Some(item) = next() {
            if let Err(fault) = work(&mut scratch, item) {
                while next().is_some() {}
                return Err(fault);
            }
        }
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};

    #[test]
    fn every_item_is_done_once() {
        let mut seen = vec![0; 1000];
        in_turn(
            seen.chunks_mut(7),
            || (),
            |(), part| -> Result<(), ()> {
                part.iter_mut().for_each(|v| *v += 1);
                Ok(())
            },
        )
        .unwrap();
        assert!(seen.iter().all(|&n| n == 1));
    }

    #[test]
    fn after_a_fault_nothing_is_begun() {
        let done = AtomicUsize::new(0);
        let fault = in_turn(
            0..1_000_000,
            || (),
            |(), i| {
                done.fetch_add(1, Ordering::Relaxed);
                if i == 10 { Err(i) } else { Ok(()) }
            },
        );
        assert_eq!(fault, Err(10));
        assert!(done.into_inner() < 1_000_000);
    }
}
