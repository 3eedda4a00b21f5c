//! One worker as a thread of this process, as the crew sees it.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::JoinHandle;

use darkroot::ProfileStore;

use super::task::{Answer, Order};
use super::wording::Wording;
use super::worker::{Connection, Host, work};

/// A thread at the other end of a channel.
pub(crate) struct Thread {
    orders: Sender<Order>,
    thread: JoinHandle<()>,
}

impl Thread {
    /// Starts a worker. `on_answer` gets each of its answers, and `None` once when there will be no more; it says
    /// whether it wants more of them.
    ///
    /// # Errors
    /// The system has no room for a thread.
    pub(crate) fn start(
        store: ProfileStore,
        wording: Wording,
        on_answer: impl Fn(Option<Answer>) -> bool + Send + 'static,
    ) -> std::io::Result<Self> {
        let (orders, received) = channel();
        let run = move || {
            let mut connection = Channels { orders: received, on_answer: &on_answer };
            let words = |error: &(dyn std::error::Error + 'static)| wording.of(error);
            let host = Host { store: &store, words: &words, own_process: false, sandbox: false };
            // The tasks themselves are guarded; this is for what is not expected at all.
            let _ = catch_unwind(AssertUnwindSafe(|| while work(&mut connection, &host).unwrap_or(false) {}));
            on_answer(None);
        };
        let thread = std::thread::Builder::new().name("darkroot-worker".into()).spawn(run)?;
        Ok(Self { orders, thread })
    }

    /// Sends an order. A thread that has ended has said so by the end of its answers.
    pub(crate) fn send(&self, order: &Order) {
        let _ = self.orders.send(order.clone());
    }

    /// Takes no more orders from here and waits until the file in work, if there is one, is done with.
    pub(crate) fn end(self) {
        drop(self.orders);
        let _ = self.thread.join();
    }
}

struct Channels<'a> {
    orders: Receiver<Order>,
    on_answer: &'a dyn Fn(Option<Answer>) -> bool,
}

impl Connection for Channels<'_> {
    fn next(&mut self) -> std::io::Result<Option<Order>> {
        Ok(self.orders.recv().ok())
    }

    fn say(&mut self, answer: Answer) -> std::io::Result<()> {
        let heard = (self.on_answer)(Some(answer));
        if heard { Ok(()) } else { Err(std::io::ErrorKind::BrokenPipe.into()) }
    }
}
