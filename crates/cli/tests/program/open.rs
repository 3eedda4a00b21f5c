//! `darkroot open`, as a script uses it; `tests/window` has it in a browser.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Stdio};

use super::*;

/// A window that is served, and ended with this.
struct Window {
    child: Child,
    /// `127.0.0.1:PORT`, and the token.
    host: String,
    token: String,
}

impl Drop for Window {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Window {
    fn open(desk: &Desk, arguments: &[&str]) -> Self {
        let mut command = desk.command(&[&["open", "--no-browser"], arguments].concat());
        let mut child = command.stdout(Stdio::piped()).spawn().unwrap();
        let mut line = String::new();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut line).unwrap();
        let address = line.trim().strip_prefix("http://").unwrap_or_else(|| panic!("no address: {line}"));
        let (host, rest) = address.split_once('/').unwrap();
        let token = rest.split('/').next().unwrap();
        Self { child, host: host.to_owned(), token: token.to_owned() }
    }

    /// Status and body of an answer.
    fn ask(&self, method: &str, path: &str, host: &str, body: &str) -> (u16, Vec<u8>) {
        let mut connection = TcpStream::connect(&self.host).unwrap();
        let length = body.len();
        let head = format!(
            "{method} {path} HTTP/1.1\r\nHost: {host}\r\nContent-Type: application/json\r\nContent-Length: {length}\r\nConnection: \
             close\r\n\r\n"
        );
        connection.write_all((head + body).as_bytes()).unwrap();
        let mut answer = Vec::new();
        connection.read_to_end(&mut answer).unwrap();
        let end = answer.windows(4).position(|w| w == b"\r\n\r\n").unwrap();
        let status = std::str::from_utf8(&answer[9..12]).unwrap().parse().unwrap();
        (status, answer.split_off(end + 4))
    }

    fn api(&self, method: &str, path: &str, body: &str) -> (u16, String) {
        let (status, answer) = self.ask(method, &format!("/{}/api/v1/{path}", self.token), &self.host, body);
        (status, String::from_utf8_lossy(&answer).into_owned())
    }
}

#[test]
fn a_script_edits_and_exports_what_develop_makes() {
    let desk = Desk::with_dng();
    let window = Window::open(&desk, &["."]);
    let (status, files) = window.api("GET", "files", "");
    assert!(status == 200 && files.contains("\"file\":\"0/a.dng\""), "{files}");
    let edits = r#"{"file": "0/a.dng", "edits": {"exposure": "0.5", "look": "vivid"}}"#;
    assert_eq!(window.api("POST", "export", edits).0, 200);
    assert_eq!(desk.names(), ["a.dng", "a.jpg"], "nothing but the picture is written");
    assert_eq!(window.api("PUT", "edits", edits).0, 200);
    assert_eq!(desk.read("a.dng.darkroot.toml"), b"exposure = 0.5\nlook = \"vivid\"\n");
    desk.develop(&["a.dng", "-o", "b.jpg"]);
    assert_eq!(desk.read("a.jpg"), desk.read("b.jpg"));
    let (status, fault) = window.api("POST", "export", edits);
    assert!(status == 409 && fault.contains("a.jpg"), "{status} {fault}");
}

#[test]
fn others_are_refused() {
    let desk = Desk::with_dng();
    let window = Window::open(&desk, &["a.dng"]);
    let page = format!("/{}/", window.token);
    let (status, answer) = window.ask("GET", &page, &window.host, "");
    assert!(status == 200 && answer.starts_with(b"<!doctype html>"));
    assert_eq!(window.ask("GET", &page, "evil.example", "").0, 403);
    for path in ["/", "/api/v1/files", "/00000000000000000000000000000000/api/v1/files"] {
        assert_eq!(window.ask("GET", path, &window.host, "").0, 403, "{path}");
    }
}

#[test]
fn what_cannot_be_opened_is_said() {
    let desk = Desk::with_dng();
    desk.fails(2, &["open", "--no-browser", "nowhere"], &["nowhere: cannot be opened"]);
    let window = Window::open(&desk, &["."]);
    let port = window.host.rsplit(':').next().unwrap();
    desk.fails(2, &["open", "--no-browser", "--port", port, "."], &["cannot be listened on"]);
}
