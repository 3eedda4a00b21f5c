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
    /// The newest request of each place that shows pictures.
    newest: Mutex<HashMap<String, Arc<Cancel>>>,
    /// One picture is rendered at a time, by all threads.
    turn: Turn<()>,
    counts: Counts,
}

#[derive(Default)]
struct Counts {
    rendered: AtomicUsize,
    dropped: AtomicUsize,
    waiting: AtomicUsize,
    most_waiting: AtomicUsize,
}

/// What became of requests until now.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub(crate) struct Told {
    /// Pictures that were finished.
    rendered: usize,
    /// Requests that a newer one replaced.
    dropped: usize,
    /// Most requests of one place that waited for their turn at once and were still wanted.
    most_waiting: usize,
}

/// Places that show pictures, at most: tabs that were closed are forgotten.
const PLACES: usize = 64;

impl Latest {
    /// Renders for a place; `None` if a newer request of the same place came meanwhile. `render` runs where it may take its
    /// time.
    pub(crate) async fn render<T: Send + 'static>(
        &self,
        place: &str,
        render: impl FnOnce(&Cancel) -> T + Send + 'static,
    ) -> Option<T> {
        let cancel = Arc::new(Cancel::default());
        {
            let mut newest = locked(&self.newest);
            if newest.len() >= PLACES && !newest.contains_key(place) {
                newest.clear();
            }
            if let Some(older) = newest.insert(place.to_owned(), Arc::clone(&cancel)) {
                older.cancel();
            }
            // Those before it are cancelled: of each place at most this one still waits.
            let waiting = 1 + self.counts.waiting.load(Ordering::SeqCst).min(newest.len() - 1);
            self.counts.most_waiting.fetch_max(waiting, Ordering::SeqCst);
        }
        self.counts.waiting.fetch_add(1, Ordering::SeqCst);
        let turn = self.turn.lock().await;
        self.counts.waiting.fetch_sub(1, Ordering::SeqCst);
        let drop_it = || {
            self.counts.dropped.fetch_add(1, Ordering::SeqCst);
            None
        };
        if cancel.is_cancelled() {
            return drop_it();
        }
        let of_task = Arc::clone(&cancel);
        let done = tokio::task::spawn_blocking(move || render(&of_task)).await;
        drop(turn);
        if cancel.is_cancelled() {
            return drop_it();
        }
        self.counts.rendered.fetch_add(1, Ordering::SeqCst);
        done.ok()
    }

    /// What became of requests until now.
    pub(crate) fn told(&self) -> Told {
        let count = |of: &AtomicUsize| of.load(Ordering::SeqCst);
        let Counts { rendered, dropped, most_waiting, .. } = &self.counts;
        Told { rendered: count(rendered), dropped: count(dropped), most_waiting: count(most_waiting) }
    }
}
