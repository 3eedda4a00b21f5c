"""Batches: begun in the window, paused and gone on with; watched when a terminal runs them."""

import subprocess


def test_batch_to_its_end_with_a_failure(bench):
    with bench.folder(a="roll/a.nef", b="roll/b.nef", c="c.nef") as (folder, home):
        (folder / "broken.nef").write_bytes((folder / "c.nef").read_bytes()[:3000])
        with bench.window(folder, home) as window, bench.page(window, "#batch") as page:
            page.wait_for_selector("#batch button:text-is('Start')")
            assert not (folder / "pictures").exists()
            page.check("#batch .field:has-text('contact sheet') input")
            page.click("#batch button:text-is('Start')")
            page.wait_for_selector("#batch .state[data-phase=done]", timeout=120_000)
            page.wait_for_selector("#batch .failures li:has-text('broken.nef')")
            assert sorted(str(p.relative_to(folder / "pictures")) for p in folder.glob("pictures/**/*.jpg")) == [
                "c.jpg", "roll/a.jpg", "roll/b.jpg"
            ]
            page.wait_for_selector("#batch a:has-text('Contact sheet')")
            status, headers, content = window.ask("GET", "api/v1/batch/1/sheet")
            assert status == 200 and b"broken.nef" in content and "sandbox" in headers["content-security-policy"]
            assert content == (folder / "pictures/sheet.html").read_bytes()
            page.click("nav >> text=Photographs")
            page.wait_for_selector(".cell:has-text('c.nef') .badge:has-text('developed')")
            page.wait_for_selector(".cell:has-text('broken.nef') .badge:has-text('cannot be read')")


def test_pause_and_go_on(bench):
    names = {f"f{i}": f"{i:02}.nef" for i in range(24)}
    with bench.folder(**names) as (folder, home), bench.window(folder, home) as window:
        with bench.page(window, "#batch") as page:
            page.click("#batch button:text-is('Start')")
            page.wait_for_selector("#batch .figures dd:text-matches('^[1-9]\\\\d* of 24')", timeout=120_000)
            page.click("#batch button:text-is('Pause')")
            page.wait_for_selector("#batch .state[data-phase=paused]", timeout=120_000)
            done = len(list((folder / "pictures").glob("*.jpg")))
            assert 0 < done < 24, f"{done} were done"
            page.click("#batch button:text-is('Go on')")
            page.wait_for_selector("#batch .state[data-phase=done]", timeout=120_000)
            assert len(list((folder / "pictures").glob("*.jpg"))) == 24


def test_batch_of_a_terminal_is_watched(bench):
    names = {f"f{i}": f"{i:02}.nef" for i in range(16)}
    with bench.folder(**names) as (folder, home), bench.window(folder, home) as window:
        out = folder / "out"
        run = subprocess.Popen([bench.program, "batch", str(folder), "-o", str(out), "--quiet"])
        try:
            with bench.page(window, "#batch") as page:
                while not (out / ".darkroot").exists():
                    page.wait_for_timeout(50)
                page.reload()
                page.click("#batch .journals >> text=out")
                page.wait_for_selector("#batch .figures dd:text-is('16 of 16')", timeout=120_000)
                assert run.wait(timeout=60) == 0
                told = window.api("GET", "batch")[0]
                assert (told["kind"], told["total"], told["done"], told["failed"]) == ("watched", 16, 16, 0)
        finally:
            run.kill()
            run.wait()


def test_collisions_are_told_before_anything_is_written(bench):
    """And the form offers what `--on-collision` does."""
    with bench.folder(a="a.nef", b="a.dng") as (folder, home), bench.window(folder, home) as window:
        with bench.page(window, "#batch") as page:
            page.click("#batch button:text-is('Start')")
            page.wait_for_selector("#batch .state[data-phase=failed]", timeout=60_000)
            page.wait_for_selector("#batch .notice:has-text('written to one output')")
            assert list((folder / "pictures").glob("*.jpg")) == []
            page.select_option("#batch label:has-text('Files of one name') select", "prefer:dng")
            page.click("#batch button:text-is('Start')")
            page.wait_for_selector("#batch .state[data-phase=done]", timeout=60_000)
            assert [path.name for path in (folder / "pictures").glob("*")  if path.suffix] == ["a.jpg"]
            told = window.api("GET", "batch")[0]
            assert [done["input"] for done in told["recent"]] == ["a.dng"], told
    with bench.folder(a="a.nef") as (folder, home), bench.window(folder, home) as window, bench.page(window, "#batch") as page:
        page.wait_for_selector("#batch button:text-is('Start')")
        page.wait_for_timeout(500)
        assert not page.is_visible("#batch label:has-text('Files of one name')")
