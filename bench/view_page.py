#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""How long pages of `slabhull view` take to open in Chromium without a graphics card, and how fast they are drawn through
time, at 1280 x 800: view_page.py PAGE.html..."""
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests/tools"))
from browser import Browser  # noqa: E402

FRAMES = 60
SCRUB = f"""
    const slabs = slabhull.head.slabs;
    const [first, last] = [slabs[0].first, slabs[slabs.length - 1].last];
    let cutting = 0;
    const start = performance.now();
    for (let k = 0; k < {FRAMES}; ++k) {{
        const before = performance.now();
        slabhull.setTime(first + (k + 0.5) / {FRAMES} * (last - first));
        cutting += performance.now() - before;
        slabhull.draw();
    }}
    return [performance.now() - start, cutting];
"""


def measure(page):
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        browser = Browser(profile)
        browser.size(1280, 800)
        browser.run("document.createElement('canvas').getContext('webgl')")  # as in a browser that is open
        start = time.monotonic()
        browser.open(page.resolve())
        browser.run("slabhull.draw()")
        opened = time.monotonic() - start
        drawn, cutting = browser.run(SCRUB)
        cells = browser.run("return slabhull.head.slabs[slabhull.head.slabs.length - 1].side[1]")
        browser.close()
    print(f"{page}: {cells:,} side cells, {page.stat().st_size / 1e6:.1f} MB, opens in {opened:.2f} s, "
          f"{1000 * FRAMES / drawn:.1f} frames/s, of a frame's {drawn / FRAMES:.1f} ms {cutting / FRAMES:.1f} to cut")


if __name__ == "__main__":
    for argument in sys.argv[1:]:
        measure(Path(argument))
