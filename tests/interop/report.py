#!/usr/bin/env python3
"""The report on a profile in a real browser: report.py DARKROOT [CHART-SHOT]

Makes a profile of the chart in samples/still-life.nef (or of another shot), opens its report in headless Chromium and
checks that every picture and plot has a size and that the console is silent. Prints which tool is missing when one is.
"""
import html
import json
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

browser = next((b for b in ("chromium", "chromium-browser", "google-chrome") if shutil.which(b)), None)
if browser is None:
    print("skipped: no Chromium is installed")
    sys.exit(0)

PROBE = """<script>
const sizes = [...document.querySelectorAll('svg, img')].map(e => {
  const r = e.getBoundingClientRect();
  return [e.tagName.toLowerCase(), Math.round(r.width), Math.round(r.height), e.naturalWidth ?? 1];
});
document.title = JSON.stringify(sizes);
</script></body>"""

darkroot = sys.argv[1]
shot = sys.argv[2] if len(sys.argv) > 2 else "samples/still-life.nef"
with tempfile.TemporaryDirectory() as folder:
    report, probed = Path(folder, "report.html"), Path(folder, "probed.html")
    subprocess.run(
        [darkroot, "profile", "-q", shot, "--light", "5500K", "--accept", "-o", Path(folder, "p.toml"), "--report", report],
        check=True,
    )
    page = report.read_text()
    probed.write_text(page.replace("</body>", PROBE))
    flags = ["--headless", "--no-sandbox", "--disable-gpu", "--enable-logging=stderr", "--window-size=1100,1600"]
    run = subprocess.run([browser, *flags, "--dump-dom", f"file://{probed}"], capture_output=True, text=True, timeout=120)
title = re.search(r"<title>(.*?)</title>", run.stdout, re.S)
sizes = json.loads(html.unescape(title.group(1)))
console = [line for line in run.stderr.splitlines() if "CONSOLE" in line]
empty = [s for s in sizes if s[1] < 50 or s[2] < 50 or s[3] == 0]
print(f"{len(sizes)} pictures and plots: {sizes}")
print(f"console: {console or 'silent'}; without size: {empty or 'none'}")
network = re.findall(r"(?:src|href)=\"(?!data:)[^\"]*\"", page)
print(f"network: {network or 'none'}")
sys.exit(1 if console or empty or network or len(sizes) < 5 else 0)
