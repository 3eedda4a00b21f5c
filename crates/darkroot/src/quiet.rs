//! Panics that are caught and become errors.

/// A decoder that panics over a damaged file is caught and becomes an error; its own report helps nobody.
/// For programs, once, before they read files: Rust reports a panic on standard error before anybody can catch it.
pub fn keep_decoders_quiet() {
    const DECODERS: [&str; 4] = ["flashraw", "rawloader", "imagepipe", "moxcms"];
    let report = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |info| {
        let from_decoder =
            info.location().is_some_and(|l| DECODERS.iter().any(|decoder| l.file().contains(decoder)));
        if !from_decoder {
            report(info);
        }
    }));
}
