"""Tests of the window in a real browser: `python tests/window/run.py PROGRAM MAKE_RAW [WORD ...]`. MAKE_RAW is the example of
`crates/simulate`.

Runs each function `test_...` of the files beside this one whose name has one of the words. Needs Playwright, Pillow and a
Chromium (`CHROMIUM`, or one on the path); where one is not there, says so and passes.
"""

import sys
import time
import traceback

from harness import Bench, chromium


def main():
    program, make_raw, words = sys.argv[1], sys.argv[2], sys.argv[3:]
    try:
        from playwright.sync_api import sync_playwright

        import PIL  # noqa: F401
    except ImportError as missing:
        print(f"skipped: {missing.name} is not there")
        return 0
    if not chromium():
        print("skipped: there is no Chromium")
        return 0
    import attacks
    import batches
    import charts
    import develop
    import straighten

    files = [develop, straighten, charts, batches, attacks]
    tests = [(name, test) for file in files for name, test in vars(file).items() if name.startswith("test_")]
    tests = [(name, test) for name, test in tests if not words or any(word in name for word in words)]
    failed = 0
    with sync_playwright() as playwright:
        browser = None
        for name, test in tests:
            if browser is None or not browser.is_connected():
                browser = launched(playwright)
            start = time.time()
            try:
                test(Bench(program, make_raw, browser))
                print(f"ok      {name} ({time.time() - start:.1f} s)", flush=True)
            except Exception:
                failed += 1
                print(f"FAILED  {name} ({time.time() - start:.1f} s)\n{traceback.format_exc()}", flush=True)
        browser.close()
    print(f"{len(tests) - failed} of {len(tests)} tests passed")
    return 1 if failed else 0


def launched(playwright):
    """The browser. A container may be too busy for it once."""
    for attempt in range(4):
        try:
            return playwright.chromium.launch(executable_path=chromium(), args=["--no-sandbox", "--disable-gpu"])
        except Exception:
            if attempt == 3:
                raise
            time.sleep(2)


if __name__ == "__main__":
    sys.exit(main())
