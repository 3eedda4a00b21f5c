//! The one shell of every HTML page that Darkroot writes: complete in itself, nothing from the network.

use maud::{DOCTYPE, Markup, PreEscaped, html};

/// The style that pages share; a page adds its own rules after it.
pub const STYLE: &str = include_str!("report/page.css");

/// A whole page of a body. The title is escaped; `css` goes in as it is.
pub fn page(title: &str, css: &str, body: Markup) -> String {
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width";
                title { (title) }
                style { (PreEscaped(css)) }
            }
            body { (body) }
        }
    };
    page.into_string() + "\n"
}

/// Bytes as text, to put a picture into a page (RFC 4648, section 4).
pub fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for chunk in bytes.chunks(3) {
        let word = chunk.iter().fold(0u32, |w, b| w << 8 | u32::from(*b)) << (8 * (3 - chunk.len()));
        for i in 0..4 {
            let digit = DIGITS[(word >> (18 - 6 * i) & 63) as usize];
            text.push(if i <= chunk.len() { char::from(digit) } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_is_that_of_the_standard() {
        // RFC 4648, section 10.
        for (bytes, text) in
            [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")]
        {
            assert_eq!(base64(bytes.as_bytes()), text);
        }
    }

    #[test]
    fn text_is_escaped_and_style_is_not() {
        let page = page("a <b>", "p>b{}", html! { p { "x & y" } });
        assert!(page.contains("<title>a &lt;b&gt;</title><style>p>b{}</style>"), "{page}");
        assert!(page.ends_with("<body><p>x &amp; y</p></body></html>\n"), "{page}");
    }
}
