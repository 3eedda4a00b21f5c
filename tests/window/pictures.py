"""Makes the pictures of docs/window.md and of the README: `python tests/window/pictures.py PROGRAM FOLDER OUT`.

FOLDER has copies of the sample (`a.nef` beside others); it is best one whose path looks well. OUT is `docs/images`.
"""

import io
import sys
import tempfile
import time
from pathlib import Path

from harness import Bench, set_number, shown
from run import launched


def main():
    from PIL import Image
    from playwright.sync_api import sync_playwright

    program, folder, out = sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3])

    def keep(name, content, width=None):
        picture = Image.open(io.BytesIO(content)).convert("RGB")
        if width:
            picture = picture.resize((width, round(picture.height * width / picture.width)), Image.LANCZOS)
        picture.save(out / f"{name}.jpg", quality=84, subsampling=0, optimize=True)

    with sync_playwright() as playwright, tempfile.TemporaryDirectory() as home:
        bench = Bench(program, None, launched(playwright))
        first = sorted(folder.glob("*.[nN][eE][fF]"))[0].name
        with bench.window(folder, home) as window:
            # What the sensor saw, and what comes of it.
            for name, edits in [("before", {"space": "camera"}), ("after", {"look": "vivid", "exposure": "0.15"})]:
                body = {"file": f"0/{first}", "place": "docs", "longest": 700, "edits": edits, "format": "png"}
                _, _, content = window.ask("POST", "api/v1/render", body)
                keep(name, content, 640)
            with bench.page(window, "#sheet") as page:
                page.wait_for_timeout(4000)
                for i, stars in enumerate([5, 3, 4]):
                    page.click(f".cell >> nth={i}")
                    page.keyboard.press(str(stars))
                    page.wait_for_timeout(200)
                page.wait_for_timeout(2000)
                keep("window-sheet", page.screenshot())
                page.goto(window.base + f"#develop=0/{first}")
                shown(page)
                set_number(page, "exposure", "0.3")
                set_number(page, "contrast", "0.15")
                page.click("text=Before | after")
                page.wait_for_timeout(3000)
                page.mouse.move(700, 500)
                page.wait_for_timeout(1500)
                page.evaluate("document.querySelector('#develop .side').scrollTo(0, 0)")
                keep("window-develop", page.screenshot())
                page.goto(window.base + f"#chart=0/{first}")
                page.wait_for_selector("#chart .patch", timeout=120_000)
                page.fill("#chart .with-list input", "D50")
                page.wait_for_timeout(1500)
                keep("window-chart", page.screenshot())
                page.goto(window.base + "#batch")
                page.click("#batch button:text-is('Start')")
                page.wait_for_selector("#batch .lines tr >> nth=2", timeout=120_000)
                keep("window-batch", page.screenshot())
                page.wait_for_selector("#batch .state[data-phase=done]", timeout=120_000)
        bench.browser.close()
    print(f"{time.strftime('%X')}: written to {out}")


if __name__ == "__main__":
    main()
