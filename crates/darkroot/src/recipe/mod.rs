//! Settings as layers: what holds for a file, and who said so.
//!
//! ```no_run
//! use darkroot::Key;
//! use darkroot::recipe::{Layer, Layers};
//!
//! let flags = Layer::flags([(Key::named("exposure"), "0.5".to_owned())])?;
//! let mut layers = Layers::new(None, flags, true)?;
//! let effective = layers.for_file("roll/DSC_0001.NEF".as_ref())?;
//! let (look, origin) = effective.get(Key::named("look"));
//! println!("{look} ({origin})");
//! let settings = effective.settings()?;
//! # Ok::<(), darkroot::recipe::RecipeError>(())
//! ```
//!
//! In rising priority: defaults, `darkroot.toml` in the folders above the file (the nearer folder counts more),
//! the recipe that was named, flags, and the sidecar `DSC_0001.NEF.darkroot.toml` beside the file. Each layer
//! holds texts as a person writes them on the command line; the table of [`settings`](crate::settings) knows what they mean.

pub mod layer;
pub use layer::{Layer, Origin};

pub mod layers;
pub use layers::{FOLDER_FILE, Layers, edits, sidecar};

pub mod written;
pub use written::write_sidecar;

pub mod effective;
pub use effective::Effective;

pub mod error;
pub use error::{RecipeError, Unreadable};

mod file;
