"""How fast the window is, in a real browser: `python tests/window/figures.py PROGRAM MAKE_RAW [PHOTOGRAPH]`.

PHOTOGRAPH is a raw file with an embedded JPEG, as cameras write it, for the contact sheet; simulated ones have none.

Prints, for a simulated NEF of 24 megapixels and a stage of 1400 x 930: file to first fitted picture, a move of a slider to its
picture, a tile pixel for pixel, ten moves at once; and for 1,000 files the first screen of the contact sheet. Each line has what
docs/window.md wants.
"""

import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from harness import Bench, SAMPLE, shown
from run import launched

#: The window of a browser in which the stage has 1400 x 930 pixels.
SIZE = {"width": 1842, "height": 1084}

MOVES = """async (moves) => {
    const slider = document.querySelector('[data-setting=exposure] input[type=range]');
    const layer = document.querySelector('#develop .layer.main');
    const times = [];
    for (let i = 0; i < moves; i++) {
        const start = performance.now();
        const seen = new Promise((done) => {
            const watch = new MutationObserver(() => { watch.disconnect(); requestAnimationFrame(() => done()); });
            watch.observe(layer, { childList: true });
        });
        slider.value = -1 + (2 * i) / moves;
        slider.dispatchEvent(new Event('input'));
        await seen;
        times.push(performance.now() - start);
        // A sharper picture follows when nothing moves; the next move does not wait for that.
    }
    return times;
}"""

BURST = """() => {
    const slider = document.querySelector('[data-setting=exposure] input[type=range]');
    for (let i = 1; i <= 10; i++) {
        slider.value = i / 5;
        slider.dispatchEvent(new Event('input'));
    }
}"""


def main():
    from playwright.sync_api import sync_playwright

    program, make_raw = sys.argv[1:3]
    with sync_playwright() as playwright, tempfile.TemporaryDirectory() as place:
        browser = launched(playwright)
        bench = Bench(program, make_raw, browser)
        folder, home = Path(place) / "shoot", Path(place) / "home"
        folder.mkdir()
        big = ["--format", "nef", "--width", "6016", "--height", "4016", "--storage", "lossless"]
        subprocess.run([make_raw, *big, "--out", folder / "a.nef"], check=True, capture_output=True)
        firsts, costs = [], []
        for _ in range(5):
            # A new program each time: nothing is decoded, the file is in the system's cache.
            with bench.window(folder, home) as window:
                page = browser.new_page(viewport=SIZE)
                page.goto(window.base + "#sheet")
                page.wait_for_selector(".thumb.there", timeout=60_000)
                start, spent = time.perf_counter(), cpu(window)
                page.evaluate("location.hash = 'develop=0/a.nef'")
                shown(page)
                firsts.append(1e3 * (time.perf_counter() - start))
                costs.append(cpu(window) - spent)
                page.close()
        tell("file to first fitted picture, ms", firsts, 700)
        print(f"  of it CPU time of the program, ms: {statistics.median(costs):.0f}")
        with bench.window(folder, home) as window:
            page = browser.new_page(viewport=SIZE)
            page.goto(window.base + "#develop=0/a.nef")
            shown(page)
            stage = page.evaluate("(({ clientWidth: w, clientHeight: h }) => [w, h])(document.querySelector('#develop .stage'))")
            print(f"stage: {stage[0]} x {stage[1]}")
            page.wait_for_timeout(1000)
            page.evaluate(MOVES, 3)
            spent = cpu(window)
            tell("slider to picture, ms", page.evaluate(MOVES, 40), 80, 150)
            print(f"  of it CPU time of the program, ms: {(cpu(window) - spent) / 40:.0f}")
            page.wait_for_timeout(1000)
            flying, most, asked = [0], [0], [0]

            def begun(request):
                if request.url.endswith("/render"):
                    flying[0] += 1
                    asked[0] += 1
                    most[0] = max(most[0], flying[0])

            page.on("request", begun)
            page.on("requestfinished", lambda r: flying.__setitem__(0, flying[0] - r.url.endswith("/render")))
            page.on("requestfailed", lambda r: flying.__setitem__(0, flying[0] - r.url.endswith("/render")))
            page.evaluate(BURST)
            page.wait_for_timeout(1500)
            print(f"ten moves at once: {asked[0]} pictures were asked for, at most {most[0]} at a time (wanted: 1 and 1 that waits)")
            tiles = []
            for i in range(12):
                body = {"file": "0/a.nef", "edits": {"exposure": f"0.{i}"}, "place": "figures", "rect": [512 * i % 5000, 1024, 512, 512], "format": "png"}
                start = time.perf_counter()
                window.ask("POST", "api/v1/render", body)
                tiles.append(1e3 * (time.perf_counter() - start))
            tell("tile of 512 x 512 pixel for pixel, ms", tiles[2:], 150)
            page.close()
        many = Path(place) / "many"
        many.mkdir()
        photograph = Path(sys.argv[3]) if len(sys.argv) > 3 else SAMPLE
        print(f"contact sheet: 1,000 times {photograph.name}")
        for i in range(1000):
            (many / f"DSC_{i:04}{photograph.suffix}").write_bytes(photograph.read_bytes())
        screens = []
        for _ in range(5):
            with bench.window(many, home) as window:
                page = browser.new_page(viewport=SIZE)
                page.goto(window.base + "#batch")
                page.wait_for_selector("#batch h2")
                start = time.perf_counter()
                page.evaluate("location.hash = 'sheet'")
                while not page.evaluate("(() => { const c = [...document.querySelectorAll('.cell')].filter((e) => e.getBoundingClientRect().top < innerHeight); return c.length > 20 && c.every((e) => e.querySelector('.thumb.there')); })()"):
                    page.wait_for_timeout(5)
                screens.append(1e3 * (time.perf_counter() - start))
                resident = Path(f"/proc/{window.process.pid}/statm")
                if resident.exists() and len(screens) == 5:
                    page.keyboard.press("End")
                    page.wait_for_timeout(4000)
                    print(f"memory of the program after 1,000 files: {int(resident.read_text().split()[1]) * 4096 >> 20} MB")
                page.close()
        tell("1,000 files: all pictures of the first screen, ms", screens, 300)
        browser.close()


def cpu(window):
    """CPU time that the program has taken, ms: unlike the others, it hardly depends on who else uses the machine."""
    fields = Path(f"/proc/{window.process.pid}/stat").read_text().rsplit(")", 1)[1].split()
    return 1e3 * (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def tell(what, times, median, most=None):
    at95 = sorted(times)[max(0, int(0.95 * len(times) + 0.5) - 1)]
    wanted = f"wanted: {median}" + (f", {most} at the 95th percentile" if most else "")
    print(f"{what}: median {statistics.median(times):.0f}, 95th percentile {at95:.0f} of {len(times)} ({wanted})", flush=True)


if __name__ == "__main__":
    main()
