"""Lines on the picture: what shall be level or upright."""

import math

from harness import save, shown, until

TOLD = ".tool-bar .told"


def value(page, name):
    return page.input_value(f"#setting-{name}")


def begun(page):
    """Opens the tool by its key, and gives the place of the picture on the page."""
    page.focus("#develop .stage")
    page.keyboard.press("l")
    page.wait_for_selector(".overlay.lines")
    until(page, "document.querySelector('#develop .stage.busy') === null")
    return page.locator("#develop .paper").bounding_box()


def draw(page, paper, start, end):
    """Draws a line between two places that are shares of the picture."""
    at = [(paper["x"] + u * paper["width"], paper["y"] + v * paper["height"]) for u, v in (start, end)]
    page.mouse.move(*at[0])
    page.mouse.down()
    page.mouse.move(*at[1], steps=5)
    page.mouse.up()


def ended(page):
    page.wait_for_selector(".overlay.lines", state="detached")


def test_a_line_along_the_horizon_straightens(bench):
    """A level line, then an upright one; undone; saved; the same by `develop`."""
    with bench.folder(a="a.nef") as (folder, home), bench.window(folder, home) as window:
        with bench.page(window, "#develop=0/a.nef") as page:
            shown(page)
            paper = begun(page)
            draw(page, paper, (0.2, 0.5), (0.8, 0.55))
            fall = math.degrees(math.atan(0.05 * paper["height"] / (0.6 * paper["width"])))
            assert "anticlockwise" in page.inner_text(TOLD), page.inner_text(TOLD)
            page.keyboard.press("Enter")
            ended(page)
            assert abs(float(value(page, "straighten")) + fall) < 0.1, (value(page, "straighten"), fall)
            page.keyboard.press("Control+z")
            until(page, "document.querySelector('#setting-straighten').value === '0'")
            # The line that is upright leans to the right below: clockwise.
            paper = begun(page)
            draw(page, paper, (0.5, 0.2), (0.55, 0.8))
            lean = math.degrees(math.atan(0.05 * paper["width"] / (0.6 * paper["height"])))
            page.click(".tool-bar >> text=Straighten")
            ended(page)
            assert abs(float(value(page, "straighten")) - lean) < 0.1, (value(page, "straighten"), lean)
            save(page)
        told = window.run("develop", folder / "a.nef", "-o", home / "a.jpg")
        assert told.returncode == 0, told.stderr


def test_lines_of_one_kind_undo_perspective(bench):
    """Two upright lines and a level one; they are there again, and are moved; none of it where it is cancelled."""
    with bench.folder(a="a.nef") as (folder, home), bench.window(folder, home) as window:
        (folder / "a.nef.darkroot.toml").write_text('straighten = 1\ncrop = "20,20,680,440"\n')
        with bench.page(window, "#develop=0/a.nef") as page:
            shown(page)
            paper = begun(page)
            draw(page, paper, (0.2, 0.1), (0.25, 0.9))
            draw(page, paper, (0.8, 0.1), (0.75, 0.9))
            draw(page, paper, (0.1, 0.5), (0.9, 0.5))
            assert page.inner_text(TOLD) == "Perspective by 2 upright and 1 level", page.inner_text(TOLD)
            page.keyboard.press("Escape")
            ended(page)
            assert value(page, "perspective") == "off" and value(page, "straighten") == "1"
            paper = begun(page)
            for line in [((0.2, 0.1), (0.25, 0.9)), ((0.8, 0.1), (0.75, 0.9)), ((0.1, 0.5), (0.9, 0.5))]:
                draw(page, paper, *line)
            page.keyboard.press("Control+z")
            assert page.inner_text(TOLD) == "Perspective by 2 upright", page.inner_text(TOLD)
            page.keyboard.press("Enter")
            ended(page)
            kind, numbers = value(page, "perspective").split(":")
            found = [float(one.rstrip("%")) for one in numbers.split(",")]
            wanted = [20, 10, 25, 90, 80, 10, 75, 90]
            assert kind == "vertical" and all(abs(a - b) < 0.3 for a, b in zip(found, wanted, strict=True)), found
            assert value(page, "straighten") == "0"
            # A crop that would lie outside is cut to what is whole.
            assert value(page, "crop") not in ("20,20,680,440", "off")
            shown_before = value(page, "perspective")
            begun(page)
            assert page.locator(".overlay.lines .handle").count() == 4, "the lines are there again"
            page.keyboard.press("Enter")
            ended(page)
            assert value(page, "perspective") == shown_before, "nothing was moved"
            save(page)
        told = window.run("develop", folder / "a.nef", "-o", home / "a.jpg")
        assert told.returncode == 0, told.stderr


def test_lines_by_keyboard(bench):
    """A line is put there, its end moved by arrows, taken away; what is found of itself; lines that meet in the picture are told."""
    with bench.folder(a="a.nef") as (folder, home), bench.window(folder, home) as window:
        with bench.page(window, "#develop=0/a.nef") as page:
            shown(page)
            begun(page)
            page.focus(".tool-bar >> text=+ Level")
            page.keyboard.press("Space")
            page.wait_for_selector(".overlay.lines .handle:focus")
            assert page.inner_text(TOLD).startswith("Turns 0°"), page.inner_text(TOLD)
            for _ in range(3):
                page.keyboard.press("Shift+ArrowUp")
            # Its first end lies higher now: it falls to the right.
            assert "anticlockwise" in page.inner_text(TOLD)
            page.keyboard.press("Delete")
            assert page.locator(".overlay.lines .handle").count() == 0
            page.keyboard.press("Control+z")
            assert page.locator(".overlay.lines .handle").count() == 2
            page.keyboard.press("Enter")
            ended(page)
            assert -20 < float(value(page, "straighten")) < 0
            paper = begun(page)
            draw(page, paper, (0.3, 0.1), (0.6, 0.9))
            draw(page, paper, (0.7, 0.1), (0.4, 0.9))
            page.keyboard.press("Enter")
            page.wait_for_selector(".tool-bar .notice[data-kind=fault]:has-text('perspective')")
            page.click(".tool-bar >> text=Auto")
            ended(page)
            assert value(page, "straighten") == "auto" and value(page, "perspective") == "off"
