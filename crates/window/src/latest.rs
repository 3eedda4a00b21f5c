//! The newest request wins: whoever asks again no longer wants what he asked before.

use std::collections::HashMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

use darkroot::Cancel;
use serde::Serialize;
use tokio::sync::Mutex as Turn;

use crate::state::locked;

/// Pictures that are asked for, one at a time.
#[derive(Default)]
pub(crate) struct Latest {
    /// The newest request of each place that shows pictures, while it is waited for.
    newest: Mutex<HashMap<String, Arc<Cancel>>>,
    /// One picture is rendered at a time, by all threads.
    turn: Arc<Turn<()>>,
    rendered: AtomicUsize,
    dropped: AtomicUsize,
}

/// What became of requests until now.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub(crate) struct Told {
    /// Pictures that were finished.
    rendered: usize,
    /// Requests that a newer one replaced.
    dropped: usize,
}

impl Latest {
    /// Renders for a place; `None` if a newer request of the same place came meanwhile. `render` runs where it may take its
    /// time. Whoever no longer waits for this cancels it.
    pub(crate) async fn render<T: Send + 'static>(
        &self,
        place: &str,
        render: impl FnOnce(&Cancel) -> T + Send + 'static,
    ) -> Option<T> {
        let wanted = Wanted(Arc::default());
        {
            let mut newest = locked(&self.newest);
            newest.retain(|_, cancel| Arc::strong_count(cancel) > 1);
            if let Some(older) = newest.insert(place.to_owned(), Arc::clone(&wanted.0)) {
                older.cancel();
            }
        }
        let turn = Arc::clone(&self.turn).lock_owned().await;
        if wanted.0.is_cancelled() {
            self.dropped.fetch_add(1, Ordering::SeqCst);
            return None;
        }
        let cancel = Arc::clone(&wanted.0);
        let done = tokio::task::spawn_blocking(move || {
            let done = render(&cancel);
            // The next one begins when this one has ended, also if nobody waits for it any more.
            drop(turn);
            done
        });
        let done = done.await;
        let count = if wanted.0.is_cancelled() { &self.dropped } else { &self.rendered };
        count.fetch_add(1, Ordering::SeqCst);
        if wanted.0.is_cancelled() { None } else { done.ok() }
    }

    /// What became of requests until now.
    pub(crate) fn told(&self) -> Told {
        let count = |of: &AtomicUsize| of.load(Ordering::SeqCst);
        Told { rendered: count(&self.rendered), dropped: count(&self.dropped) }
    }
}

/// A request that is cancelled when its answer is not waited for any more.
struct Wanted(Arc<Cancel>);

impl Drop for Wanted {
    fn drop(&mut self) {
        self.0.cancel();
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    fn run<T>(test: impl Future<Output = T>) -> T {
        tokio::runtime::Builder::new_multi_thread().enable_time().build().unwrap().block_on(test)
    }

    /// Renders until it is cancelled or a while has passed; whether it was finished.
    fn slowly(cancel: &Cancel) -> bool {
        for _ in 0..40 {
            if cancel.is_cancelled() {
                return false;
            }
            std::thread::sleep(Duration::from_millis(5));
        }
        true
    }

    #[test]
    fn of_ten_requests_at_once_the_first_is_stopped_and_the_last_is_rendered() {
        let latest = Arc::new(Latest::default());
        let begun = Arc::new(AtomicUsize::new(0));
        let finished = run(async {
            let mut tasks = Vec::new();
            for _ in 0..10 {
                let (latest, begun) = (Arc::clone(&latest), Arc::clone(&begun));
                tasks.push(tokio::spawn(async move {
                    let render = move |cancel: &Cancel| {
                        begun.fetch_add(1, Ordering::SeqCst);
                        slowly(cancel)
                    };
                    latest.render("a tab", render).await
                }));
                tokio::time::sleep(Duration::from_millis(2)).await;
            }
            let mut finished = Vec::new();
            for task in tasks {
                finished.push(task.await.unwrap());
            }
            finished
        });
        let expected: Vec<Option<bool>> = (0..10).map(|i| (i == 9).then_some(true)).collect();
        assert_eq!(finished, expected);
        assert_eq!(latest.told(), Told { rendered: 1, dropped: 9 });
        assert!(begun.load(Ordering::SeqCst) <= 10);
    }

    #[test]
    fn who_goes_away_stops_the_rendering_and_frees_the_turn() {
        let latest = Arc::new(Latest::default());
        run(async {
            let gone = tokio::time::timeout(Duration::from_millis(20), latest.render("a tab", slowly)).await;
            assert!(gone.is_err());
            let start = std::time::Instant::now();
            assert_eq!(latest.render("another", |_| true).await, Some(true));
            assert!(start.elapsed() < Duration::from_millis(100));
        });
        assert_eq!(latest.told().rendered, 1);
    }
}
