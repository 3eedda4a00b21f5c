//! A window to Darkroot in the browser: a local server in the program, and a page that is embedded in it.
//!
//! ```no_run
//! use darkroot_window::{Options, Window};
//!
//! let window = Window::open(Options::of(vec!["shoot".into()]))?;
//! println!("{}", window.address());
//! window.serve()?;
//! # Ok::<(), darkroot_window::WindowError>(())
//! ```
//!
//! Start with `api/`: a file for each group of endpoints, as `docs/window.md` lists them. `guard.rs` decides which requests
//! get there, `roots.rs` which files. The page is in `page/`.
//!
//! **What it does not do:** it has no colour science and no stages of its own: what it shows is what the library renders. It
//! opens no browser, prints nothing and reads no arguments.

mod options;
pub use options::Options;

mod error;
pub use error::WindowError;

mod apart;
mod decoder;
pub use apart::Apart;
pub use decoder::serve_decoder;

mod fault;
mod guard;
mod page;
mod roots;
mod token;

mod facts;
mod latest;
mod opened;
mod readout;
mod screen;
mod small;
mod tally;

mod running;
mod watched;

mod state;

mod api;

mod serve;
mod window;
pub use window::Window;
