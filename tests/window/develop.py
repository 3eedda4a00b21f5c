"""Contact sheet and developing, as a person does it."""

import io
import time

from harness import save, set_number, shown, until


def test_open_edit_reload(bench):
    """Edits are in the sidecar when they are saved, and not before; undo and redo go through them."""
    with bench.folder(a="a.nef") as (folder, home), bench.window(folder, home) as window:
        sidecar = folder / "a.nef.darkroot.toml"
        with bench.page(window, "#develop=0/a.nef") as page:
            shown(page)
            set_number(page, "exposure", "0.5")
            set_number(page, "contrast", "0.2")
            assert list(folder.iterdir()) == [folder / "a.nef"], "something was written without a click on Save"
            page.keyboard.press("Escape")
            page.focus("#develop .stage")
            page.keyboard.press("Control+z")
            until(page, "document.querySelector('#setting-contrast').value === '0'")
            page.keyboard.press("Control+Shift+z")
            until(page, "document.querySelector('#setting-contrast').value === '0.2'")
            save(page)
            assert sidecar.read_text() == "exposure = 0.5\ncontrast = 0.2\n"
            page.reload()
            shown(page)
            until(page, "document.querySelector('#setting-exposure').value === '0.5'")
            page.click("[data-setting=exposure] .reset")
            save(page)
            assert sidecar.read_text() == "contrast = 0.2\n"
            page.click("#develop button:text-is('Reset')")
            save(page)
            assert not sidecar.exists()


def test_export_is_what_develop_makes(bench):
    """Bit for bit, with the same sidecar; a picture that is there is replaced only when that is asked for."""
    with bench.folder(a="a.nef") as (folder, home), bench.window(folder, home) as window:
        with bench.page(window, "#develop=0/a.nef") as page:
            shown(page)
            set_number(page, "exposure", "-0.3")
            set_number(page, "saturation", "1.2")
            page.select_option("#setting-look", "vivid")
            save(page)
            for ending in ["jpg", "png", "tif"]:
                page.click("text=Export …")
                page.select_option(".export select >> nth=0", ending)
                page.click("text=Write picture")
                page.wait_for_selector(".export .notice:has-text('is written')", timeout=60_000)
                ours, theirs = folder / f"a.{ending}", home / f"theirs.{ending}"
                told = window.run("develop", folder / "a.nef", "-o", theirs)
                assert told.returncode == 0, told.stderr
                assert ours.read_bytes() == theirs.read_bytes(), f"{ending}: the pictures differ"
                page.click("text=Write picture")
                page.wait_for_selector(".export .notice[data-kind=fault]")
                page.click("text=Replace it")
                page.wait_for_selector(".export .notice:has-text('is written')", timeout=60_000)
                page.click(".export >> text=Close")


def test_tiles_are_the_picture(bench):
    """A tile is, sample for sample, that part of what `develop` writes."""
    from PIL import Image

    with bench.folder(a="a.nef") as (folder, home), bench.window(folder, home) as window:
        window.run("develop", folder / "a.nef", "-o", home / "a.png")
        whole = Image.open(home / "a.png").convert("RGB")
        asked = {"file": "0/a.nef", "place": "test", "rect": [100, 60, 256, 200], "format": "png"}
        _, headers, content = window.ask("POST", "api/v1/render", asked | {"edits": {}})
        tile = Image.open(io.BytesIO(content)).convert("RGB")
        assert tile.size == (256, 200)
        assert tile.tobytes() == whole.crop((100, 60, 356, 260)).tobytes()
        # A wide screen gets its own space, and the picture says so.
        _, _, content = window.ask("POST", "api/v1/render", asked | {"gamut": "display-p3"})
        assert b"P\x003" in Image.open(io.BytesIO(content)).info["icc_profile"]
        # Beside the picture there is nothing.
        status, _, _ = window.ask("POST", "api/v1/render", asked | {"rect": [100_000, 0, 5, 5]})
        assert status == 400


def test_exposure_from_a_chart(bench):
    """The view shows what `develop` writes, and says what the chart told; a shot without a chart is told at once."""
    from PIL import Image

    with bench.folder(a="a.nef") as (folder, home), bench.window(folder, home) as window:
        edits = {"exposure-from-chart": "auto", "look": "reproduction"}
        asked = {"file": "0/a.nef", "place": "test", "rect": [100, 60, 256, 200], "format": "png", "edits": edits}
        status, headers, content = window.ask("POST", "api/v1/render", asked)
        assert status == 200, content
        assert "the exposure is that of" in headers["darkroot-view"], headers["darkroot-view"]
        options = [word for name, text in edits.items() for word in (f"--{name}", text)]
        assert window.run("develop", folder / "a.nef", "-o", home / "a.png", "--bits", "8", *options).returncode == 0
        whole = Image.open(home / "a.png").convert("RGB").crop((100, 60, 356, 260))
        assert Image.open(io.BytesIO(content)).convert("RGB").tobytes() == whole.tobytes()
        status, _, words = window.ask("POST", "api/v1/render", asked | {"edits": {"exposure-from-chart": "auto", "chart-layout": "sg140"}})
        assert status == 422 and b"chart" in words, (status, words)


def test_pixel_for_pixel(bench):
    """A double click shows pixels, tiles come; dragging moves; F fits."""
    with bench.folder() as (folder, home):
        bench.big(folder / "a.nef")
        with bench.window(folder, home) as window, bench.page(window, "#develop=0/a.nef", width=1100) as page:
            shown(page)
            page.dblclick("#develop .stage", position={"x": 300, "y": 200})
            page.wait_for_selector("#develop img.tile", timeout=60_000)
            assert page.inner_text("#develop .zoom") == "100 %"
            before = page.evaluate("document.querySelector('#develop .paper').style.left")
            page.mouse.move(400, 350)
            page.mouse.down()
            page.mouse.move(320, 350, steps=4)
            page.mouse.up()
            assert page.evaluate("document.querySelector('#develop .paper').style.left") != before
            page.keyboard.press("f")
            assert page.inner_text("#develop .zoom") == "Fit"


def test_white_balance_crop_and_spot(bench):
    """A grey spot is picked, a crop drawn, the picture turned; a spot is read."""
    with bench.folder(a="a.nef") as (folder, home), bench.window(folder, home) as window:
        with bench.page(window, "#develop=0/a.nef") as page:
            shown(page)
            page.click("text=Pick grey")
            page.click("#develop .stage", position={"x": 780, "y": 410})
            until(page, "document.querySelector('#setting-white-balance').value.endsWith('as-shot') === false")
            page.mouse.move(500, 300)
            until(page, "/^[-\\d. ]+$/.test(document.querySelector('.spot dd').textContent)")
            page.keyboard.press("c")
            page.wait_for_selector(".overlay.crop .edge[width]")
            corner = page.locator(".overlay.crop .handle").first.bounding_box()
            page.mouse.move(corner["x"] + 7, corner["y"] + 7)
            page.mouse.down()
            page.mouse.move(corner["x"] + 157, corner["y"] + 107, steps=4)
            page.mouse.up()
            page.click("[aria-label='Turn a tenth of a degree clockwise']")
            page.keyboard.press("Enter")
            until(page, "/^\\d+,\\d+,\\d+,\\d+$/.test(document.querySelector('#setting-crop').value)")
            save(page)
            text = (folder / "a.nef.darkroot.toml").read_text()
            assert "straighten = 0.1" in text and "crop = " in text and "white-balance = " in text, text
            told = window.run("develop", folder / "a.nef", "-o", home / "a.jpg")
            assert told.returncode == 0, told.stderr


def test_before_and_after(bench):
    """Before is rendered without the edits, and shown at the left of the handle."""
    with bench.folder(a="a.nef") as (folder, home), bench.window(folder, home) as window:
        with bench.page(window, "#develop=0/a.nef") as page:
            shown(page)
            set_number(page, "exposure", "1")
            page.click("text=Before | after")
            page.wait_for_selector("#develop .layer.before img.whole", timeout=60_000)
            until(page, "document.querySelector('.layer.before').style.clipPath === 'inset(0px 50% 0px 0px)'")
            page.click("text=Before | after")
            page.keyboard.down("b")
            until(page, "document.querySelector('.layer.before').style.clipPath.includes(' 0%') && !document.querySelector('.layer.before').hidden")
            page.keyboard.up("b")
            until(page, "document.querySelector('.layer.before').hidden")


def test_wrong_values_are_told_at_their_control(bench):
    with bench.folder(a="a.nef") as (folder, home), bench.window(folder, home) as window:
        with bench.page(window, "#develop=0/a.nef") as page:
            shown(page)
            page.fill("#setting-white-balance", "blueish")
            page.press("#setting-white-balance", "Enter")
            page.wait_for_selector("[data-setting=white-balance] .notice:has-text('blueish')")
            page.fill("#setting-white-balance", "5200K")
            page.press("#setting-white-balance", "Enter")
            page.wait_for_selector("[data-setting=white-balance] .notice", state="hidden")


def test_contact_sheet(bench):
    """A thousand files: the first screen soon, few cells, keyboard and stars, a filter."""
    with bench.folder(a="0.nef") as (folder, home):
        for i in range(1, 1000):
            (folder / f"{i}.nef").hardlink_to(folder / "0.nef")
        with bench.window(folder, home) as window, bench.page(window, "#sheet") as page:
            until(page, "document.querySelectorAll('.thumb.there').length >= 12")
            assert page.inner_text("#sheet .tools .count") == "1,000 photographs"
            assert page.locator(".cell").count() < 120, "cells that nobody sees are there"
            page.keyboard.press("End")
            page.wait_for_selector(".cell.focused:has-text('999.nef')")
            page.keyboard.press("Home")
            page.keyboard.press("ArrowRight")
            page.keyboard.press("4")
            page.wait_for_selector(".cell.focused .stars:has-text('★★★★')")
            assert (folder / "1.nef.darkroot.toml").read_text() == 'set-tag = "xmp:Rating=4"\n'
            page.select_option("[aria-label=Rating]", "4")
            until(page, "document.querySelectorAll('.cell').length === 1")
            page.keyboard.press("Escape")
            page.select_option("[aria-label=Rating]", "0")
            page.fill("[aria-label='Find by name']", "77")
            page.wait_for_selector(".count:has-text('of 1,000')")
            page.focus(".cells-frame")
            page.keyboard.press("Enter")
            shown(page)
            assert "develop=" in page.url


def test_copy_to_a_selection(bench):
    with bench.folder(a="a.nef", b="b.nef", c="c.nef") as (folder, home), bench.window(folder, home) as window:
        (folder / "b.nef.darkroot.toml").write_text("straighten = 1\nexposure = 2\n")
        with bench.page(window, "#develop=0/a.nef") as page:
            shown(page)
            set_number(page, "exposure", "0.5")
            set_number(page, "saturation", "1.1")
            page.click("#develop button:text-is('Copy')")
            save(page)
            page.click("nav >> text=Photographs")
            page.click(".cell:has-text('b.nef')")
            page.click(".cell:has-text('c.nef')", modifiers=["Control"])
            page.click("text=Paste settings of a.nef")
            page.wait_for_selector("#sheet .notice:has-text('2 files')")
        assert (folder / "b.nef.darkroot.toml").read_text() == "exposure = 0.5\nsaturation = 1.1\nstraighten = 1\n"
        assert (folder / "c.nef.darkroot.toml").read_text() == "exposure = 0.5\nsaturation = 1.1\n"


def test_ten_fast_moves_render_what_is_seen_last(bench):
    """What is asked for while a picture is rendered replaces what waited before: nothing queues."""
    with bench.folder(a="a.nef") as (folder, home), bench.window(folder, home) as window:
        with bench.page(window, "#develop=0/a.nef") as page:
            shown(page)
            flying, most = [0], [0]

            def begun(request):
                if request.url.endswith("/render"):
                    flying[0] += 1
                    most[0] = max(most[0], flying[0])

            def ended(request):
                flying[0] -= request.url.endswith("/render")

            page.on("request", begun)
            page.on("requestfinished", ended)
            page.on("requestfailed", ended)
            page.evaluate("""() => {
                const slider = document.querySelector('[data-setting=exposure] input[type=range]');
                for (let i = 1; i <= 10; i++) {
                    slider.value = i / 10;
                    slider.dispatchEvent(new Event('input'));
                }
                slider.dispatchEvent(new Event('change'));
            }""")
            page.wait_for_timeout(1500)
            until(page, "document.querySelector('#setting-exposure').value === '1'")
            assert most[0] <= 2, f"{most[0]} requests at once"


def test_two_tabs(bench):
    """Who saves second is told, and may load or overwrite."""
    with bench.folder(a="a.nef") as (folder, home), bench.window(folder, home) as window:
        sidecar = folder / "a.nef.darkroot.toml"
        with bench.page(window, "#develop=0/a.nef") as first, bench.page(window, "#develop=0/a.nef") as second:
            shown(first)
            shown(second)
            set_number(first, "exposure", "0.5")
            set_number(second, "exposure", "0.7")
            save(first)
            second.click("#develop button:text-is('Save')")
            second.wait_for_selector("#develop .notice:has-text('somebody else')")
            assert sidecar.read_text() == "exposure = 0.5\n"
            second.click("text=Save over it")
            second.wait_for_selector("#develop button:text-is('Saved')")
            assert sidecar.read_text() == "exposure = 0.7\n"
            set_number(first, "exposure", "0.6")
            first.click("#develop button:text-is('Save')")
            first.click("text=Load theirs")
            until(first, "document.querySelector('#setting-exposure').value === '0.7'")


def test_broken_file(bench):
    with bench.folder(a="a.nef") as (folder, home):
        (folder / "broken.nef").write_bytes((folder / "a.nef").read_bytes()[:3000])
        with bench.window(folder, home) as window, bench.page(window, "#sheet") as page:
            page.wait_for_selector(".cell:has-text('broken.nef') .badge:has-text('cannot be read')")
            page.dblclick(".cell:has-text('broken.nef')")
            page.wait_for_selector("#develop .notice[data-kind=fault]:has-text('broken.nef')")
            page.keyboard.press("Escape")
            page.goto(window.base + "#develop=0/a.nef")
            shown(page)


def test_folder_that_vanishes(bench):
    import shutil

    with bench.folder(a="a.nef") as (folder, home), bench.window(folder, home) as window:
        with bench.page(window, "#develop=0/a.nef") as page:
            shown(page)
            kept = folder.with_name("elsewhere")
            shutil.move(folder, kept)
            page.fill("#setting-exposure", "0.5")
            page.press("#setting-exposure", "Enter")
            page.wait_for_selector("#develop .notice[data-kind=fault]:has-text('a.nef')")
            page.reload()
            page.wait_for_selector("#develop .notice[data-kind=fault]")
            page.goto(window.base + "#sheet")
            page.wait_for_selector("#sheet .notice[data-kind=fault]")
            shutil.move(kept, folder)
            page.goto(window.base + "#develop=0/a.nef")
            page.reload()
            shown(page)


def test_server_killed_and_started_again(bench):
    with bench.folder(a="a.nef") as (folder, home):
        with bench.window(folder, home) as window:
            port = window.base.split(":")[2].split("/")[0]
            with bench.page(window, "#develop=0/a.nef") as page:
                shown(page)
                set_number(page, "exposure", "0.5")
                window.end()
                page.click("#develop button:text-is('Save')")
                page.wait_for_selector("#lost:visible")
                page.wait_for_selector("#develop .notice:has-text('does not answer')")
                assert page.input_value("#setting-exposure") == "0.5", "the edits are gone"
                deadline = time.time() + 20
                while True:
                    try:
                        again = bench.window(folder, home, "--port", port)
                        second = again.__enter__()
                        break
                    except AssertionError:
                        assert time.time() < deadline, "the port is not free again"
                        time.sleep(0.5)
                try:
                    # The new window has a new address; the old page may not use it.
                    page.click("#develop button:text-is('Save')")
                    page.wait_for_selector("#develop .notice:has-text('open the one that')")
                    assert not (folder / "a.nef.darkroot.toml").exists()
                    page.goto(second.base + "#develop=0/a.nef")
                    shown(page)
                finally:
                    again.__exit__(None, None, None)
