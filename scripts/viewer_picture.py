"""Draws a recording with the 3-D panel of Foxglove Studio, from `run.mcap` and our layout alone.

The panel is the one of @foxglove/studio-base 1.48 (MPL-2.0), on which Lichtblick is built, too; it
is not part of crowdbot. Messages are decoded by @mcap/core and @foxglove/rosmsg2-serialization.
Needs node and a browser, and once

    npm install --ignore-scripts --legacy-peer-deps --prefix scripts/js/viewer

Without a recording it runs tests/data/short_way.yaml with the small planner of
tests/core/live/pursuit.py.

    python scripts/viewer_picture.py [RUN.mcap] [--at SECONDS] [--out PICTURE.png]
"""

from __future__ import annotations

import argparse
import functools
import http.server
import json
import shutil
import subprocess
import sys
import tempfile
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from playwright.sync_api import sync_playwright

ROOT = Path(__file__).parent.parent
VIEWER = ROOT / "scripts/js/viewer"
LAYOUT = ROOT / "crowdbot/core/recording/export/crowdbot_layout.json"
SPEC = ROOT / "tests/data/short_way.yaml"
PICTURE = ROOT / "docs/images/foxglove.png"
BROWSERS = ("chromium", "google-chrome", "chromium-browser", "google-chrome-stable")
#: One topic of each thing that has to be seen.
SEEN = (
    "/map", "/walls_marker", "/pedestrians_marker", "/people_markers", "/robot_description",
    "/robot/path", "/scan", "/goal_zone", "/goal_pose", "/tf",
)  # fmt: skip
PAGE = (
    "<!doctype html><style>html,body,div{margin:0;height:100%}canvas{display:block}</style>"
    "<div><canvas></canvas></div><script src=scene.js></script>"
)


def main() -> int:
    """Draw, and say what was drawn."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("recording", type=Path, nargs="?")
    parser.add_argument("--at", type=float, default=2.0, help="simulated time, s")
    parser.add_argument("--distance", type=float, default=9.0, help="of the camera, m")
    parser.add_argument("--modules", type=Path, default=VIEWER / "node_modules")
    parser.add_argument("--out", type=Path, default=PICTURE)
    chosen = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        recording = chosen.recording or _run(folder / "runs")
        shutil.copyfile(recording, folder / "run.mcap")
        shutil.copyfile(LAYOUT, folder / "layout.json")
        (folder / "index.html").write_text(PAGE, encoding="utf-8")
        bundle = [str(VIEWER / "bundle.mjs"), str(chosen.modules.resolve())]
        subprocess.run(
            [shutil.which("node") or "node", *bundle, str(folder / "scene.js")], check=True
        )
        with _served(folder) as url:
            camera = {"distance": chosen.distance, "phi": 50, "thetaOffset": 60}
            drawn = _picture(url, chosen.at, camera, chosen.out)
    for topic, count in sorted(drawn.items()):
        print(f"{topic:24} {count:5} messages drawn")
    missing = [topic for topic in SEEN if topic not in drawn]
    if missing:
        print(f"not drawn: {', '.join(missing)}", file=sys.stderr)
    return int(bool(missing))


def _run(out: Path) -> Path:
    """Make the recording."""
    argv = [
        str(SPEC),
        "--planner",
        f"{ROOT}/tests/core/live/pursuit.py:Pursuit",
        "--record",
        "all",
        "--no-references",
    ]
    command = [sys.executable, "-m", "crowdbot", "simulate", *argv, "--out", str(out)]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    (found,) = out.glob("*/*/*/*/run.mcap")
    return found


class _Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, format: str, *args: object) -> None:
        pass


@contextmanager
def _served(folder: Path) -> Iterator[str]:
    handler = functools.partial(_Quiet, directory=str(folder))
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        thread = threading.Thread(target=server.serve_forever, daemon=True)
        thread.start()
        yield f"http://127.0.0.1:{server.server_port}/index.html"
        server.shutdown()


def _picture(url: str, at: float, camera: dict[str, float], out: Path) -> dict[str, int]:
    """Save the picture; how many messages of each topic are in it."""
    program = next(filter(None, map(shutil.which, BROWSERS)), None)
    flags = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"]
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=program, args=flags)
        page = browser.new_page(viewport={"width": 1000, "height": 640})
        page.set_default_timeout(600_000)
        page.on("pageerror", lambda error: print(error, file=sys.stderr))
        page.goto(url)
        asked = f"draw('run.mcap', 'layout.json', {at}, {json.dumps(camera)})"
        drawn: dict[str, int] = page.evaluate(asked)
        page.screenshot(path=str(out))
        browser.close()
    return drawn


if __name__ == "__main__":
    sys.exit(main())
