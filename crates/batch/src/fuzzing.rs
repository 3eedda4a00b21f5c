//! A door for the targets in `fuzz/`, compiled for them alone.

use super::task::{Answer, Order};

/// What the crew makes of a line from a worker, and a worker of one from the crew: what is understood is said the same
/// way again.
///
/// # Panics
/// It is not, which is a fault.
pub fn line(line: &[u8]) {
    if let Ok(answer) = serde_json::from_slice::<Answer>(line) {
        let again = serde_json::to_vec(&answer).and_then(|line| serde_json::from_slice::<Answer>(&line));
        assert!(again.is_ok());
    }
    if let Ok(order) = serde_json::from_slice::<Order>(line) {
        let again = serde_json::to_vec(&order).and_then(|line| serde_json::from_slice::<Order>(&line));
        assert!(again.is_ok());
    }
}
