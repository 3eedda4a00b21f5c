"""What others try: other pages, other names, other paths, very many requests, very slow ones."""

import json
import os
import re
import socket
import threading
import time
import urllib.parse


def raw(window, request, patience=10):
    """Sends bytes and returns the first line of the answer."""
    port = int(window.base.split(":")[2].split("/")[0])
    with socket.create_connection(("127.0.0.1", port), timeout=patience) as connection:
        connection.sendall(request)
        return connection.recv(4096).split(b"\r\n")[0].decode()


def test_only_who_knows_the_token(bench):
    with bench.folder(a="a.nef") as (folder, home), bench.window(folder, home) as window:
        origin = window.base.rsplit("/", 2)[0] + "/"
        for path in ["", "api/v1/files", "main.js", "0" * 32 + "/", "0" * 32 + "/api/v1/files", "//", "..//api/v1/files"]:
            status, _, content = window.ask("GET", path, base=origin)
            assert status == 403, f"{path}: {status}"
            assert b"a.nef" not in content
        assert len(window.base.rstrip("/").rsplit("/", 1)[1]) == 32
        with bench.window(folder, home) as other:
            assert other.base.rsplit("/", 2)[1] != window.base.rsplit("/", 2)[1]


def test_other_hosts_and_origins(bench):
    """DNS rebinding brings a foreign Host; another page brings its Origin."""
    with bench.folder(a="a.nef") as (folder, home), bench.window(folder, home) as window:
        for headers in [
            {"host": "evil.example"},
            {"host": "evil.example:80"},
            {"host": "127.0.0.1.evil.example"},
            {"origin": "http://evil.example"},
            {"origin": "null"},
            {"origin": "http://localhost:1"},
            {"sec-fetch-site": "cross-site"},
            {"sec-fetch-site": "same-site"},
        ]:
            for method, path in [("GET", "api/v1/files"), ("POST", "api/v1/stars")]:
                body = {"files": ["0/a.nef"], "stars": 5} if method == "POST" else None
                status, _, _ = window.ask(method, path, body, headers)
                assert status == 403, f"{headers}: {status}"
        assert list(folder.iterdir()) == [folder / "a.nef"]
        token = window.base.rstrip("/").rsplit("/", 1)[1]
        assert "403" in raw(window, f"GET /{token}/ HTTP/1.0\r\n\r\n".encode()), "without a Host"


def test_another_page_in_the_same_browser(bench):
    """A page of another origin can neither read nor write, and cannot show the window in a frame."""
    with bench.folder(a="a.nef") as (folder, home), bench.window(folder, home) as window, bench.window(folder, home) as other:
        evil = bench.browser.new_page()
        evil.goto(other.base.rsplit("/", 2)[0] + "/")
        tried = evil.evaluate(
            """async (base) => {
                const tries = [
                    fetch(base + 'api/v1/files'),
                    fetch(base + 'api/v1/stars', { method: 'POST', body: JSON.stringify({ files: ['0/a.nef'], stars: 5 }), headers: { 'content-type': 'application/json' } }),
                    fetch(base + 'api/v1/stars', { method: 'POST', mode: 'no-cors', body: JSON.stringify({ files: ['0/a.nef'], stars: 5 }) }),
                ];
                return (await Promise.allSettled(tries)).map((t) => (t.status === 'fulfilled' ? t.value.type : 'refused'));
            }""",
            window.base,
        )
        assert tried[0] == tried[1] == "refused" and tried[2] in ("refused", "opaque"), tried
        assert list(folder.iterdir()) == [folder / "a.nef"], "another page wrote something"
        evil.close()


def test_the_policy_is_strict(bench):
    with bench.folder(a="a.nef") as (folder, home), bench.window(folder, home) as window:
        for path in ["", "main.js", "api/v1/files", "api/v1/nothing"]:
            _, headers, _ = window.ask("GET", path)
            policy = headers["content-security-policy"]
            assert policy.startswith("default-src 'none'") and "unsafe" not in policy, path
            assert headers["x-content-type-options"] == "nosniff" and headers["referrer-policy"] == "no-referrer"
        _, _, page = window.ask("GET", "")
        assert not re.search(rb"<script(?![^>]*src=)|https?://|style=", page), "something in the page is from elsewhere, or inline"


def test_paths_lead_nowhere_else(bench):
    with bench.folder(a="a.nef") as (folder, home), bench.window(folder, home) as window:
        secret = folder.parent / "secret.nef"
        secret.write_bytes((folder / "a.nef").read_bytes())
        os.symlink(secret, folder / "link.nef")
        os.symlink(folder.parent, folder / "up")
        os.symlink(folder.parent, folder / "pictures")
        names = ["0/../secret.nef", "0/link.nef", "0/up/secret.nef", "0//" + str(secret), str(secret), "1/a.nef", "0/", "", "0/\0", "0/a.nef/x"]
        for name in names:
            query = urllib.parse.urlencode({"file": name})
            for path in [f"small?{query}", f"edits?{query}"]:
                status, _, content = window.ask("GET", "api/v1/" + path)
                assert status in (400, 404, 422), f"{name!r}: {status} {content[:100]!r}"
            for path, body in [
                ("render", {"file": name, "place": "x"}),
                ("export", {"file": name}),
                ("export", {"file": "0/a.nef", "folder": "0/.." if name in ("", "0/", "0/\0") else name}),
                ("chart/find", {"file": name}),
                ("batch/watch", {"out": name or "0/.."}),
            ]:
                status, _, content = window.ask("POST", "api/v1/" + path, body)
                assert status in (400, 404, 422), f"{path} {name!r}: {status} {content[:200]!r}"
            status, _, _ = window.ask("PUT", "api/v1/edits", {"file": name, "edits": {"exposure": "1"}})
            assert status in (400, 404), f"{name!r}: {status}"
        # Files that settings name are files, too.
        (folder.parent / "mine.toml").write_text("x")
        for name in ["/etc/passwd", str(folder.parent / "mine.toml")]:
            for setting in ["profile", "exposure-from-chart", "chart-reference"]:
                body = {"file": "0/a.nef", "edits": {setting: name}, "place": "x"}
                status, _, content = window.ask("POST", "api/v1/render", body)
                assert status == 400 and b"no folder that was opened" in content, content
            status, _, content = window.ask("POST", "api/v1/chart/judge", {"file": "0/a.nef", "reference": name})
            assert status == 400, content
        # Outputs go through no link either.
        for body in [{"inputs": ["0/"], "out": "0/pictures"}, {"inputs": ["0/up"], "out": "0/p"}]:
            status, _, _ = window.ask("POST", "api/v1/batch", body)
            assert status == 400
        for name in ["../x", "a/b", "", ".x", "a\0b"]:
            status, _, _ = window.ask("POST", "api/v1/export", {"file": "0/a.nef", "name": name})
            assert status == 400, name
        assert sorted(p.name for p in folder.parent.iterdir()) == ["home", "mine.toml", "secret.nef", "shoot"]


def test_names_with_markup(bench):
    """A name of a file is text wherever it is shown."""
    name = "<img src=x onerror=alert(1)>\u202egpj.nef"
    with bench.folder(a=name) as (folder, home), bench.window(folder, home) as window:
        with bench.page(window, "#sheet") as page:
            page.on("dialog", lambda dialog: (_ for _ in ()).throw(AssertionError("a script ran")))
            page.wait_for_selector(".cell .name:has-text('<img src=x onerror=alert(1)>\\\\u{202e}gpj.nef')")
            page.dblclick(".cell")
            page.wait_for_selector("#develop .layer.main img.whole", timeout=60_000)
            assert page.inner_text("#develop .file-name").startswith("<img src=x")
            assert page.locator("img[src=x]").count() == 0


def test_requests_that_make_no_sense(bench):
    with bench.folder(a="a.nef") as (folder, home), bench.window(folder, home) as window:
        for method, path, body in [
            ("POST", "render", []), ("POST", "render", {"file": 5}), ("POST", "render", {"file": "0/a.nef", "place": "x", "edits": {"clarity": "1"}}),
            ("POST", "render", {"file": "0/a.nef", "place": "x", "edits": {"exposure": "1e999"}}),
            ("POST", "render", {"file": "0/a.nef", "place": "x", "rect": [0, 0, 2**62, 2**62]}),
            ("POST", "spot", {"file": "0/a.nef", "x": 2**62, "y": 2**62}),
            ("POST", "chart/judge", {"file": "0/a.nef", "corners": [[0, 0], [0, 0], [0, 0], [0, 0]]}),
            ("POST", "chart/judge", {"file": "0/a.nef", "corners": [[1e300, 0], [-1e300, 5], [0, 1e300], [2, 2]]}),
            ("POST", "stars", {"files": ["0/a.nef"], "stars": 999}), ("GET", "batch/99", None), ("GET", "batch/x", None),
            ("DELETE", "edits", None), ("GET", "chart/fit/7/report", None), ("POST", "facts", {"files": ["x"] * 1000}),
        ]:
            status, _, content = window.ask(method, "api/v1/" + path, body)
            assert status in (200, 400, 404, 405, 415, 422), f"{path} {body}: {status}"
            assert status == 200 or (path.startswith("batch/x") or "error" in json.loads(content)), content
        status, _, _ = window.ask("POST", "api/v1/render", {"file": "x" * (2 << 20)})
        assert status == 413
        assert window.process.poll() is None
        assert window.api("GET", "files")["files"]


def test_ten_thousand_requests(bench):
    with bench.folder(a="a.nef") as (folder, home), bench.window(folder, home) as window:
        import http.client

        host, token = window.base.split("/")[2], window.base.rstrip("/").rsplit("/", 1)[1]
        before = memory(window)
        failures = []

        def ask_many():
            connection = http.client.HTTPConnection(host, timeout=30)
            for i in range(1250):
                paths = [f"/{token}/api/v1/status", f"/{token}/api/v1/small?file=0/a.nef", f"/{token}/api/v1/edits?file=0/a.nef", f"/{token}/nothing"]
                connection.request("GET", paths[i % 4])
                answer = connection.getresponse()
                answer.read()
                if answer.status not in (200, 404):
                    failures.append(answer.status)

        threads = [threading.Thread(target=ask_many) for _ in range(8)]
        [thread.start() for thread in threads]
        [thread.join() for thread in threads]
        assert not failures, failures[:5]
        grown = memory(window) - before
        assert grown < 150 << 20, f"{grown >> 20} MB more"


def test_slow_readers_and_writers(bench):
    """Who reads nothing, or says nothing, keeps nobody else waiting."""
    with bench.folder(a="a.nef") as (folder, home), bench.window(folder, home) as window:
        port = int(window.base.split(":")[2].split("/")[0])
        token = window.base.rstrip("/").rsplit("/", 1)[1]
        idle = []
        for i in range(60):
            connection = socket.create_connection(("127.0.0.1", port))
            if i % 3 == 0:
                connection.sendall(f"GET /{token}/api/v1/small?file=0/a.nef HTTP/1.1\r\nHost: localhost\r\n\r\n".encode())
            elif i % 3 == 1:
                connection.sendall(b"GET / HTTP/1.1\r\nHo")
            idle.append(connection)
        start = time.time()
        assert window.api("GET", "files")["files"]
        body = {"file": "0/a.nef", "place": "x", "longest": 400, "edits": {}}
        status, _, _ = window.ask("POST", "api/v1/render", body)
        assert status == 200 and time.time() - start < 10
        [connection.close() for connection in idle]


def memory(window):
    """Resident memory of the program, bytes; 0 where the system does not tell."""
    try:
        with open(f"/proc/{window.process.pid}/statm") as statm:
            return int(statm.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")
    except OSError:
        return 0
