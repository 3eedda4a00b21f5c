"""Charts: what is found, what is placed by hand, and the profile that comes of it."""

from harness import shown, until


def test_chart_by_hand_gives_the_profile_of_corners(bench):
    with bench.folder(a="a.nef") as (folder, home), bench.window(folder, home) as window:
        with bench.page(window, "#chart=0/a.nef") as page:
            page.wait_for_selector("#chart .patch", timeout=120_000)
            assert page.locator("#chart .patch").count() == 24
            page.wait_for_selector("#chart .gates li[data-verdict]")
            # A corner is moved by hand: what the page then says is what the program gets.
            handle = page.locator("#chart .handle").first
            handle.focus()
            with page.expect_request(lambda r: r.url.endswith("/chart/judge")) as judged:
                handle.press("ArrowLeft")
            corners = judged.value.post_data_json["corners"]
            page.fill("#chart .with-list input", "D50")
            page.press("#chart .with-list input", "Tab")
            page.check("#chart input.switch")
            page.click("text=Make profile")
            page.wait_for_selector("#chart .report iframe", timeout=120_000)
            report = page.frame_locator("#chart .report iframe")
            report.locator("h1").wait_for(timeout=30_000)
            page.click("#chart .report >> text=Close")
            page.click("text=Save profile")
            page.wait_for_selector("#chart .notice:has-text('is saved')")
            ours = (home / "darkroot/profiles/a.toml").read_text()
            text = ",".join(str(v) for corner in corners for v in corner)
            theirs = home / "theirs.toml"
            told = window.run(
                "profile", folder / "a.nef", "--chart", "classic24", "--light", "D50", "--corners", text, "--accept", "-o", theirs
            )
            assert told.returncode == 0, told.stderr
            assert ours == theirs.read_text(), "the profiles differ"
            # The folder is developed with it.
            page.click("text=Develop a folder with it")
            page.wait_for_selector("#batch .told:has-text('a.toml')")
            page.click("#batch button:text-is('Start')")
            page.wait_for_selector("#batch .state[data-phase=done]", timeout=120_000)
            assert (folder / "pictures/a.jpg").exists()


def test_patches_are_left_out(bench):
    with bench.folder(a="a.nef") as (folder, home), bench.window(folder, home) as window:
        with bench.page(window, "#chart=0/a.nef") as page:
            page.wait_for_selector("#chart .patch", timeout=120_000)
            with page.expect_request(lambda r: r.url.endswith("/chart/judge")) as judged:
                page.locator("#chart .patch").nth(3).click()
            assert len(judged.value.post_data_json["exclude"]) == 1
            page.wait_for_selector("#chart .patch.out")
            page.wait_for_selector("#chart .told:has-text('Left out')")


def test_no_chart_is_said_and_placed_by_hand(bench):
    """A corner of the sample shows no chart."""
    with bench.folder(a="a.nef") as (folder, home), bench.window(folder, home) as window:
        told = window.api("POST", "chart/find", {"file": "0/a.nef", "chart": "sg140"})
        assert told["found"] == [] and told["rejected"]["reason"]
        with bench.page(window, "#chart=0/a.nef") as page:
            page.wait_for_selector("#chart .patch", timeout=120_000)
            page.select_option("#chart .side select", "sg140")
            page.wait_for_selector("#chart .notice:has-text('Place it by hand')", timeout=120_000)
            assert page.locator("#chart .patch").count() == 0
            page.click("text=Place by hand")
            until(page, "document.querySelectorAll('#chart .handle').length === 4")
            page.goto(window.base + "#develop=0/a.nef")
            shown(page)
