//! Which requests are answered at all.
//!
//! Whoever knows the token may do what the page can. What stands here keeps out those who do not: other pages in the same
//! browser (their `Origin`), names that somebody points at this machine (`Host`), and programs of others on it.

use std::net::IpAddr;
use std::sync::Arc;

use axum::extract::{Request, State};
use axum::http::header::{self, HeaderMap, HeaderName, HeaderValue};
use axum::http::{Method, StatusCode, Uri};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};

use crate::fault::Fault;
use crate::token::Token;

/// What the guard knows.
#[derive(Clone)]
pub(crate) struct Guard {
    pub(crate) token: Token,
    /// Whether others than this machine may come.
    pub(crate) open: bool,
}

/// The page may load what this server sends, and nothing else; nobody may put it into a frame of theirs.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob:; connect-src 'self'; \
                      frame-src 'self'; font-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'self'";

/// A report that Darkroot wrote may bring its own style and pictures, and run nothing.
pub(crate) const REPORT_POLICY: &str =
    "default-src 'none'; style-src 'unsafe-inline'; img-src data:; sandbox; frame-ancestors 'self'";

const HEADERS: [(HeaderName, &str); 6] = [
    (header::CONTENT_SECURITY_POLICY, POLICY),
    (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
    (header::REFERRER_POLICY, "no-referrer"),
    (HeaderName::from_static("cross-origin-resource-policy"), "same-origin"),
    (HeaderName::from_static("cross-origin-opener-policy"), "same-origin"),
    (header::CACHE_CONTROL, "no-store"),
];

/// Checks a request, takes the token from its path, and says on every answer what a browser may do with it.
pub(crate) async fn guard(State(guard): State<Arc<Guard>>, mut request: Request, next: Next) -> Response {
    let mut answer = match admitted(&guard, &request) {
        Ok(uri) => {
            *request.uri_mut() = uri;
            next.run(request).await
        }
        Err(fault) => fault.into_response(),
    };
    for (name, value) in HEADERS {
        answer.headers_mut().entry(name).or_insert(HeaderValue::from_static(value));
    }
    answer
}

/// The address of a request without the token, if it may come in.
fn admitted(guard: &Guard, request: &Request) -> Result<Uri, Fault> {
    let refused = |words: &str| Fault::new(StatusCode::FORBIDDEN, words);
    let host = text(request.headers(), &header::HOST).unwrap_or_default();
    if !is_ours(host, guard.open) {
        return Err(refused("this name is not one of this machine's: open the address that was printed"));
    }
    let path = request.uri().path();
    let (token, rest) = path[1.min(path.len())..].split_once('/').unwrap_or_default();
    if !guard.token.is(token) {
        return Err(refused(
            "the address is not that of this window: open the one that `darkroot open` printed; it is another one each time",
        ));
    }
    if let Some(origin) = text(request.headers(), &header::ORIGIN)
        && origin.strip_prefix("http://") != Some(host)
    {
        return Err(refused("another page asked for this, which it may not"));
    }
    // A browser says where a request is from; a script says nothing.
    let site = text(request.headers(), &HeaderName::from_static("sec-fetch-site")).unwrap_or("none");
    let navigates = text(request.headers(), &HeaderName::from_static("sec-fetch-mode")) == Some("navigate");
    let from_elsewhere = !matches!(site, "same-origin" | "none");
    if from_elsewhere && !(navigates && request.method() == Method::GET && rest.is_empty()) {
        return Err(refused("another page asked for this, which it may not"));
    }
    let query = request.uri().query().map(|query| format!("?{query}")).unwrap_or_default();
    format!("/{rest}{query}").parse().map_err(|_| Fault::asked("this is no address"))
}

fn text<'h>(headers: &'h HeaderMap, name: &HeaderName) -> Option<&'h str> {
    headers.get(name).map(|value| value.to_str().unwrap_or("?"))
}

/// Whether a host is `localhost` or a number. Names can be pointed at any machine (DNS rebinding), numbers cannot. The port is
/// that of whatever brings the request here, such as a tunnel of SSH.
fn is_ours(host: &str, open: bool) -> bool {
    let name = match host.rsplit_once(':') {
        Some((name, port)) if port.bytes().all(|b| b.is_ascii_digit()) && !port.is_empty() => name,
        _ => host,
    };
    let bare = name.strip_prefix('[').and_then(|n| n.strip_suffix(']')).unwrap_or(name);
    match bare.parse::<IpAddr>() {
        Ok(address) => open || address.is_loopback(),
        Err(_) => name == "localhost",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_names_that_nobody_can_point_here_are_ours() {
        for host in ["127.0.0.1:8377", "localhost:9000", "[::1]:8377", "localhost", "127.0.0.1"] {
            assert!(is_ours(host, false), "{host}");
        }
        for host in [
            "",
            "evil.example:8377",
            "localhost.evil.example",
            "192.168.1.5:8377",
            "127.0.0.1.evil.example",
            "?",
        ] {
            assert!(!is_ours(host, false), "{host}");
        }
        assert!(is_ours("192.168.1.5:8377", true) && !is_ours("evil.example", true));
    }

    #[test]
    fn requests_of_others_are_refused() {
        let token = Token::new().unwrap();
        let guard = Guard { token: token.clone(), open: false };
        let asked = |path: &str, method: Method, headers: &[(&str, &str)]| {
            let mut request = axum::http::Request::builder().method(method).uri(path);
            for (name, value) in headers {
                request = request.header(*name, *value);
            }
            admitted(&guard, &request.body(axum::body::Body::empty()).unwrap()).map(|uri| uri.to_string())
        };
        let ours = format!("/{}/api/v1/files?a=b", token.text());
        let host = ("host", "localhost:1");
        assert_eq!(asked(&ours, Method::GET, &[host]).unwrap(), "/api/v1/files?a=b");
        assert!(asked(&ours, Method::POST, &[host, ("origin", "http://localhost:1")]).is_ok());
        for headers in [
            &[][..],
            &[("host", "evil.example")],
            &[host, ("origin", "http://localhost:2")],
            &[host, ("origin", "null")],
            &[host, ("origin", "https://evil.example")],
            &[host, ("sec-fetch-site", "cross-site")],
            &[host, ("sec-fetch-site", "same-site"), ("sec-fetch-mode", "navigate")],
        ] {
            assert!(asked(&ours, Method::GET, headers).is_err(), "{headers:?}");
        }
        for path in ["/", "/api/v1/files", "//", "/0123456789abcdef0123456789abcdef/", "*"] {
            assert!(asked(path, Method::GET, &[host]).is_err(), "{path}");
        }
        // A link in a mail or on another page may lead to the page itself.
        let front = format!("/{}/", token.text());
        let link = [host, ("sec-fetch-site", "cross-site"), ("sec-fetch-mode", "navigate")];
        assert!(asked(&front, Method::GET, &link).is_ok());
    }
}
