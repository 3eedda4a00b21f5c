"""A window and a browser for tests: `darkroot open` on a folder of its own, and Chromium by Playwright."""

import contextlib
import json
import os
import shutil
import subprocess
import tempfile
import time
import urllib.error
import urllib.request
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
SAMPLE = REPOSITORY / "samples/still-life.nef"


def chromium():
    """Path of the browser, or None."""
    named = os.environ.get("CHROMIUM")
    return named or shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")


class Window:
    """A running `darkroot open`, and requests to it as a script makes them."""

    def __init__(self, program, folder, home, *arguments):
        self.program, self.folder, self.home = program, folder, home
        env = {**os.environ, "XDG_DATA_HOME": str(home)}
        command = [program, "open", "--no-browser", *arguments, *(folder if isinstance(folder, list) else [folder])]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=env)
        self.address = self.process.stdout.readline().strip()
        assert self.address.startswith("http://"), f"no address: {self.address!r}"
        self.base = self.address.split("#")[0]

    def ask(self, method, path, body=None, headers=None, base=None):
        """Status, headers and bytes of an answer."""
        data = None if body is None else json.dumps(body).encode()
        headers = {"content-type": "application/json", **(headers or {})}
        request = urllib.request.Request((base or self.base) + path, data, headers, method=method)
        try:
            with urllib.request.urlopen(request, timeout=60) as answer:
                return answer.status, answer.headers, answer.read()
        except urllib.error.HTTPError as error:
            return error.code, error.headers, error.read()

    def api(self, method, path, body=None):
        """What the API answers, which must be good."""
        status, _, content = self.ask(method, "api/v1/" + path, body)
        assert status == 200, f"{method} {path}: {status} {content[:300]!r}"
        return json.loads(content)

    def run(self, *arguments):
        """The program as it is run in a terminal."""
        env = {**os.environ, "XDG_DATA_HOME": str(self.home)}
        return subprocess.run([self.program, *map(str, arguments)], env=env, capture_output=True, text=True, timeout=300)

    def end(self):
        self.process.kill()
        self.process.wait()


class Bench:
    """What a test works with: a program, a browser, a folder that is gone afterwards."""

    def __init__(self, program, make_raw, browser):
        self.program, self.make_raw, self.browser = program, make_raw, browser

    @contextlib.contextmanager
    def folder(self, **files):
        """A folder with a copy of the sample by each name (`a_nef="a.nef"`), and one for profiles beside it."""
        with tempfile.TemporaryDirectory(prefix="darkroot-window-") as place:
            folder, home = Path(place).resolve() / "shoot", Path(place).resolve() / "home"
            folder.mkdir()
            home.mkdir()
            for name in files.values():
                (folder / name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(SAMPLE, folder / name)
            yield folder, home

    def big(self, path):
        """Writes a simulated photograph that is larger than the screen."""
        size = ["--width", "2400", "--height", "1600"]
        subprocess.run([self.make_raw, "--format", "nef", *size, "--out", path], check=True, capture_output=True)

    @contextlib.contextmanager
    def window(self, folder, home, *arguments):
        window = Window(self.program, folder, home, *arguments)
        try:
            yield window
        finally:
            window.end()

    @contextlib.contextmanager
    def page(self, window, place="", width=1280, height=800, expected=()):
        """A page of the window. What it complains of in the console fails the test, unless a word of it is expected."""
        page = self.browser.new_page(viewport={"width": width, "height": height})
        wrong = []
        page.on("pageerror", lambda error: wrong.append(str(error)))
        # What was not loaded is told by the page where it happened.
        harmless = ("Failed to load resource", *expected)
        page.on("console", lambda m: m.type == "error" and not any(w in m.text for w in harmless) and wrong.append(m.text))
        page.goto(window.base + place)
        try:
            yield page
        finally:
            page.close()
        assert not wrong, f"the page complained: {wrong}"


def shown(page):
    """Waits for the picture of the develop view, and for what the controls show."""
    page.wait_for_selector("#develop .layer.main img.whole", timeout=60_000)
    page.wait_for_selector("#develop[data-file]", timeout=60_000)


def set_number(page, name, value):
    """Types a value into the control of a setting, and waits for the picture of it."""
    with page.expect_response(lambda r: r.url.endswith("/render") and r.status == 200, timeout=60_000):
        page.fill(f"#setting-{name}", value)
        page.press(f"#setting-{name}", "Enter")


def until(page, condition, seconds=60):
    """Waits until JavaScript is true. The page's policy lets nothing be evaluated in it, so this asks from outside."""
    end = time.time() + seconds
    while not page.evaluate(condition):
        assert time.time() < end, f"never true: {condition}"
        page.wait_for_timeout(30)


def save(page):
    page.click("#develop button:text-is('Save')")
    page.wait_for_selector("#develop button:text-is('Saved')")
