"""Pictures per second of the view in three dimensions, drawn without a graphics card.

    .venv/bin/python benchmarks/frames.py REPLAY.html|ADDRESS [--width 1280] [--height 800]

It opens the replay page of a run, or the page that `crowdbot teleop` and `walk` print the address
of, in a Chromium that has no graphics card. The run plays, or it begins to drive, in each view, and
prints pictures per second and the processor time of a picture (ms) of the page and of the process
that draws for it. The two work at the same time, so on an idle machine with two cores the larger
one sets the rate. It needs `playwright`, `psutil` and a Chromium.
"""

from __future__ import annotations

import argparse
import os
import shutil
import time
from pathlib import Path

import psutil  # type: ignore[import-untyped]
from playwright.sync_api import Page, sync_playwright

_SECONDS = 8.0
#: Name of each process in the command line of a browser's children.
_PROCESSES = {"page": "--type=renderer", "drawing": "--type=gpu-process"}


def _processor_time() -> dict[str, float]:
    """Return the processor time so far of the browser's processes, s."""
    used = dict.fromkeys(_PROCESSES, 0.0)
    for child in psutil.Process().children(recursive=True):
        for name, word in _PROCESSES.items():
            if word in child.cmdline():
                used[name] += sum(child.cpu_times()[:2])
    return used


def _measure(page: Page, view: str, solid: str) -> None:
    page.select_option("#view", view)
    while not page.evaluate(f"({solid}?.frames ?? 0) > 0"):
        page.wait_for_timeout(50)
    page.wait_for_timeout(2500)  # until the resolution is the one that it keeps
    frames, used, begin = page.evaluate(f"{solid}.frames"), _processor_time(), time.monotonic()
    page.wait_for_timeout(1000 * _SECONDS)
    count = page.evaluate(f"{solid}.frames") - frames
    passed, now = time.monotonic() - begin, _processor_time()
    width, height = page.evaluate(f"[{solid}.canvas.width, {solid}.canvas.height]")
    triangles = page.evaluate(f"{solid}.renderer.info.render.triangles")
    costs = ", ".join(f"{name} {1e3 * (now[name] - used[name]) / count:.1f} ms" for name in used)
    print(f"{view}: {count / passed:.1f} a second, {costs}; {width} x {height} pixels, "
          f"{triangles} triangles")  # fmt: skip


def main() -> None:
    """Measure the views of a page."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("page", help="replay.html, or an address")
    parser.add_argument("--width", type=int, default=1280)
    parser.add_argument("--height", type=int, default=800)
    given = parser.parse_args()
    live = given.page.startswith("http")
    solid = "eyes.solid" if live else "shown.panels[0].solid"
    with sync_playwright() as playwright:
        program = shutil.which("chromium")
        browser = playwright.chromium.launch(executable_path=program, args=["--no-sandbox"])
        page = browser.new_page(viewport={"width": given.width, "height": given.height})
        page.goto(given.page if live else Path(given.page).resolve().as_uri())
        page.wait_for_selector("html[data-ready]")
        if live:
            page.wait_for_selector("#begin:visible")
            page.keyboard.press("Enter")
        for view in ("solid", "camera", "eyes" if live else "person"):
            _measure(page, view, solid)
        count = page.evaluate(f"{solid}.run.people?.count ?? 0")
        print(f"{count} people, load {os.getloadavg()[0]:.1f}")
        browser.close()


if __name__ == "__main__":
    main()
