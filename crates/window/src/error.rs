//! Why there is no window.

use std::io;
use std::net::SocketAddr;
use std::path::PathBuf;

use darkroot::shown;

/// Why there is no window.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WindowError {
    /// Something to show is not there, or closed to us.
    #[error("{path}: cannot be opened: {reason}", path = shown(path))]
    Input {
        /// The folder or file.
        path: PathBuf,
        /// What the system says.
        reason: io::Error,
    },
    /// Nobody can listen there.
    #[error("{address}: cannot be listened on: {reason}")]
    Listen {
        /// Address and port.
        address: SocketAddr,
        /// What the system says.
        reason: io::Error,
    },
    /// The system gives no threads or no random numbers.
    #[error("the server cannot be started: {reason}")]
    Start {
        /// What the system says.
        reason: io::Error,
    },
}
