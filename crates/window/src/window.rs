//! A window: the server, and the address that it is seen at.

use std::net::{SocketAddr, TcpListener};
use std::sync::Arc;

use darkroot::path_text;

use crate::guard::Guard;
use crate::state::Shared;
use crate::token::Token;
use crate::{Options, WindowError, api, serve};

/// A window that is listened for, and not served yet.
pub struct Window {
    listener: TcpListener,
    address: SocketAddr,
    token: Token,
    shared: Arc<Shared>,
}

/// Stack of a thread that answers, bytes: that of the main thread on most systems, which decoders are used to.
const STACK: usize = 8 << 20;

impl Window {
    /// Looks at what is to be shown and begins to listen. Connections wait until [`Window::serve`].
    ///
    /// # Errors
    /// A folder that cannot be read, an address that cannot be listened on.
    pub fn open(options: Options) -> Result<Self, WindowError> {
        let address = SocketAddr::new(options.listen, options.port);
        let shared = Shared::of(options)?;
        let failed = |reason| WindowError::Listen { address, reason };
        let listener = TcpListener::bind(address).map_err(failed)?;
        let address = listener.local_addr().map_err(failed)?;
        Ok(Self { listener, address, token: Token::new()?, shared: Arc::new(shared) })
    }

    /// The address of the page: who knows it can use the window.
    pub fn address(&self) -> String {
        let only = self.shared.roots.only.as_deref();
        let place = only.map(|name| format!("#develop={}", escaped(name))).unwrap_or_default();
        format!("http://{}/{}/{place}", self.address, self.token.text())
    }

    /// Whether others than this machine can reach it.
    pub fn is_open_to_others(&self) -> bool {
        !self.address.ip().is_loopback()
    }

    /// Answers for ever.
    ///
    /// # Errors
    /// The system gives no threads, or the listener breaks.
    pub fn serve(self) -> Result<(), WindowError> {
        let failed = |reason| WindowError::Start { reason };
        let guard = Guard { token: self.token.clone(), open: self.is_open_to_others() };
        let router = api::router(self.shared, Arc::new(guard));
        let runtime = tokio::runtime::Builder::new_multi_thread()
            .worker_threads(2)
            .max_blocking_threads(32)
            .thread_stack_size(STACK)
            .enable_io()
            .enable_time()
            .build()
            .map_err(failed)?;
        runtime.block_on(serve::serve(self.listener, router)).map_err(failed)
    }
}

/// A name as it stands behind `#` of an address.
fn escaped(name: &str) -> String {
    let is_plain = |b: u8| b.is_ascii_alphanumeric() || b"-_.~/".contains(&b);
    let name = path_text::text(name.as_ref());
    name.bytes().map(|b| if is_plain(b) { char::from(b).to_string() } else { format!("%{b:02X}") }).collect()
}
