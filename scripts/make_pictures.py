"""Draws the pictures of README and documents, and writes the figures beside them, from one state.

Scenarios, worlds, streams and robots are drawn as they are. One run is made for the replay in the
README; the scores and times in the text beside it are those of the same run. The real-time factor
there is by CPU time. Another run is what metrics are drawn from. Pictures of pages need a browser,
installed or of playwright; without one they are left as they are, which the last line says.

Examples:
    .venv/bin/python scripts/make_pictures.py
    .venv/bin/python scripts/make_pictures.py --gallery
"""

from __future__ import annotations

import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import textwrap
from collections.abc import Callable
from pathlib import Path

ROOT = Path(__file__).parent.parent
IMAGES = ROOT / "docs" / "images"
BIN = Path(sys.executable).parent / "crowdbot"
SUITE, ID = "challenge-2020", "counter-d0250-dispersed-c20-r05"
#: Picture -> what is drawn.
GALLERY = {
    "counter": (SUITE, ID),
    "in": (SUITE, "in-d0500-fast-c20-r05"),
    "crossing": ("challenge-2021", "crossing_other-d020-usual"),
    "both": ("challenge-2026", "both-d040-never-n01"),
    "overtaking": ("social-guidelines", "robot_overtaking"),
    "intersection": ("social-guidelines", "intersection_no_gesture"),
    "hall": ("docs/tutorial/files/my_scenario.yaml",),
    "floor": ("docs/howto/files/my_floor.yaml", "heeded"),
}
#: Scripts that draw what needs no run.
WITHOUT_RUNS = ("write_world_pictures.py", "stream_pictures.py")
#: Metrics that the README shows, each with its line.
SHOWN = ("safe efficiency", "contacts", "burden", "comfort")  # fmt: skip
#: Browsers that are installed are used before that of playwright.
BROWSERS = ("chromium", "google-chrome", "chromium-browser", "google-chrome-stable")
#: Seconds of the run at which the replay is pictured.
MOMENT = 40


def main() -> int:
    """Everything, or the gallery alone."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--gallery", action="store_true", help="only what needs no run")
    parser.add_argument(
        "--runs", type=Path, help="folder that keeps the runs: what is there is not run again"
    )
    given = parser.parse_args()
    draw_gallery(IMAGES / "gallery")
    for name in WITHOUT_RUNS:
        subprocess.run([sys.executable, ROOT / "scripts" / name], check=True, stdout=sys.stderr)
    if given.gallery:
        return 0
    with tempfile.TemporaryDirectory() as folder:
        kept: Path = (given.runs or Path(folder) / "runs").resolve()
        metrics = ROOT / "scripts" / "make_metric_pictures.py"
        subprocess.run([sys.executable, metrics, "--runs", kept], check=True, stdout=sys.stderr)
        missing = draw_pages(kept, Path(folder))
    clips = ROOT / "scripts" / "make_clips.py"
    subprocess.run([sys.executable, clips], check=True, stdout=sys.stderr)
    if missing:
        print(f"no browser is installed: left as they were: {', '.join(missing)}")
    return 0


def draw_pages(runs: Path, folder: Path) -> list[str]:
    """Pictures of pages about two runs, and the figures of one of them in the README.

    Args:
        runs: root of the run directories.
        folder: for the pages.

    Returns:
        Pictures for which there is no browser.
    """
    shown = _crowdbot("simulate", SUITE, ID, "--planner", "dwa", "--out", str(runs), cwd=folder)
    run = runs / SUITE / ID / "dwa" / "seed-0"
    shown = on_an_idle_core(shown.replace(f"{runs}/", "runs/"), run)
    readme = ROOT / "README.md"
    readme.write_text(with_figures(readme.read_text(encoding="utf-8"), shown), encoding="utf-8")
    _crowdbot("simulate", SUITE, ID, "--planner", "stop_and_go", "--out", str(runs), cwd=folder)
    _crowdbot("report", str(runs), "--suite", SUITE, "--out", "report.html", cwd=folder)
    other = run.parents[1] / "stop_and_go" / "seed-0"
    _crowdbot("view", str(run), "--out", "replay.html", cwd=folder)
    _crowdbot("view", str(run), str(other), "--out", "compare.html", cwd=folder)
    pages = {
        "replay": f"replay.html#t={MOMENT}&paused",
        "compare": f"compare.html#t={MOMENT}&paused",
        "report": "report.html",
    }
    return [
        name
        for name, page in pages.items()
        if not photograph(f"{folder.as_uri()}/{page}", IMAGES / f"{name}.png")
    ]


def draw_gallery(folder: Path) -> list[Path]:
    """All pictures of scenarios; equal scenarios give equal bytes."""
    folder.mkdir(parents=True, exist_ok=True)
    made = []
    for name, words in GALLERY.items():
        file = folder / f"{name}.svg"
        _crowdbot("view", *words, "--out", str(file), cwd=ROOT)
        made.append(file)
    return made


def with_figures(readme: str, shown: str) -> str:
    """The README with the scores and the time that a run printed.

    Args:
        readme: its text.
        shown: what ``crowdbot simulate`` printed.

    Raises:
        SystemExit: the run printed no such line, or the README shows none.
    """
    for metric in SHOWN:
        pattern = re.compile(rf"^{metric} .*$", re.MULTILINE)
        line = pattern.search(shown)
        if line is None or not pattern.search(readme):
            raise SystemExit(f"{metric} is not shown by the run, or not in the README")
        readme = pattern.sub(_constant(line[0].rstrip()), readme, count=1)
    ending = re.compile(rf"^{ID} · dwa · seed 0: .*?\n?.*?real\s+time\)$", re.MULTILINE | re.DOTALL)
    values = ending.search(shown)
    if values is None or not ending.search(readme):
        raise SystemExit("how the run ended is not shown by the run, or not in the README")
    return ending.sub(_constant(values[0]), readme, count=1)


def on_an_idle_core(shown: str, run: Path) -> str:
    """What a run printed, with simulated seconds by seconds of CPU time as the real-time factor.

    By the wall clock it would say how busy the machine was that drew the pictures.
    """
    record = json.loads((run / "run.json").read_text(encoding="utf-8"))
    factor = record["sim_time"] / record["cpu_time"]
    ending = re.compile(
        rf"^({ID} [^;(]*?\d s)(;\s+was\s+complete[^/]*?again|\s+\([\d.]+ times\s+real\s+time\))$",
        re.MULTILINE,
    )
    line = ending.search(shown)
    if line is None:
        raise SystemExit("how the run ended is not shown by the run")
    text = f"{' '.join(line[1].split())} ({factor:.1f} times real time)"
    return ending.sub(_constant(textwrap.fill(text, 80)), shown, count=1)


def _constant(text: str) -> Callable[[re.Match[str]], str]:
    """What replaces every match by one text, in which a backslash is a backslash."""
    return lambda _: text


def photograph(url: str, file: Path) -> bool:
    """A picture of a page, 1280 by 800; False without a browser."""
    from playwright.sync_api import Error, sync_playwright

    try:
        with sync_playwright() as playwright:
            found = next(filter(None, map(shutil.which, BROWSERS)), None)
            browser = playwright.chromium.launch(executable_path=found, args=["--no-sandbox"])
            page = browser.new_page(viewport={"width": 1280, "height": 800})
            page.goto(url)
            page.wait_for_timeout(1000)
            page.screenshot(path=file)
            browser.close()
    except Error:
        return False
    return True


def _crowdbot(*words: str, cwd: Path) -> str:
    environment = {**os.environ, "COLUMNS": "80", "NO_COLOR": "1"}
    done = subprocess.run([BIN, *words], cwd=cwd, env=environment, capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(f"{done.stderr}crowdbot {' '.join(words)} failed")
    return done.stdout


if __name__ == "__main__":
    sys.exit(main())
