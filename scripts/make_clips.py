"""Films thirty scenarios as small clips for the gallery, and writes the gallery's page of clips.

Each clip is the start of a run with one of our planners, four times as fast as real time, drawn by
the exporter of films. WebP of few pixels: all clips together take at most `MOST` bytes.

Examples:
    .venv/bin/python scripts/make_clips.py
    .venv/bin/python scripts/make_clips.py --only blind_corner
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from fnmatch import fnmatchcase
from pathlib import Path
from typing import NamedTuple

import crowdbot
from crowdbot.core.view.film import FilmedRun

ROOT = Path(__file__).parent.parent
FOLDER = ROOT / "docs" / "images" / "clips"
PAGE = ROOT / "docs" / "gallery_of_clips.md"
#: Bytes of all clips together.
MOST = 3_000_000
#: Width in px, pictures a second, times real time, s of the run at most.
WIDTH, RATE, SPEED, SECONDS = 300, 8.0, 4.0, 24.0
#: Quality of WebP, of 100; colours are flat.
QUALITY = 40


class Clip(NamedTuple):
    """One clip: the scenario, what it shows, the planner, and the second at which it starts."""

    suite: str
    scenario: str
    text: str
    planner: str = "dwa"
    start: float = 0.0

    @property
    def file(self) -> Path:
        """The file of the clip."""
        return FOLDER / f"{self.scenario}.webp"


CLIPS = (
    Clip("challenge-2020", "counter-d0125-dispersed-c20-r05", "People come towards the robot."),
    Clip("challenge-2020", "counter-d0250-dispersed-c20-r05", "Twice as many come towards it."),
    Clip("challenge-2020", "counter-d0500-fast-c20-r05", "A dense, fast stream against it."),
    Clip("challenge-2020", "in-d0250-fast-c20-r05", "People walk the robot's way."),
    Clip("challenge-2020", "in-d0500-dispersed-c20-r05", "A dense stream carries it along."),
    Clip("challenge-2021", "crossing_other-d020-usual", "Two corridors cross."),
    Clip("challenge-2021", "pillars_along-d020-usual", "Pillars divide the stream."),
    Clip("challenge-2021", "corner_along-d020-usual", "Around a corner."),
    Clip("challenge-2021", "bottleneck_along-d020-usual", "Through a bottleneck."),
    Clip("challenge-2021", "street_along-d020-usual", "Along a street."),
    Clip("challenge-2026", "in-d020-attentive-n01", "People who notice the robot early."),
    Clip("challenge-2026", "counter-d040-late-n02", "People who notice it late."),
    Clip("challenge-2026", "both-d040-never-n01", "Two streams; some never notice it."),
    Clip("shared-control", "goal_directed-d020-n01", "A synthetic user drives a wheelchair."),
    Clip("social-guidelines", "frontal_approach", "A person comes straight on."),
    Clip("social-guidelines", "robot_overtaking", "A slow person ahead."),
    Clip("social-guidelines", "pedestrian_overtaking", "A fast person behind."),
    Clip("social-guidelines", "crossing_left", "A person crosses from the left."),
    Clip("social-guidelines", "crossing_child", "A child crosses."),
    Clip("social-guidelines", "blind_corner", "A person behind a blind corner."),
    Clip("social-guidelines", "narrow_doorway", "Who goes through the door first?"),
    Clip("social-guidelines", "narrow_hallway_pair", "A pair in a narrow hallway."),
    Clip("social-guidelines", "intersection_no_gesture", "An intersection between walls."),
    Clip("social-guidelines", "entering_elevator", "Into a lift."),
    Clip("social-guidelines", "group_standing", "A group that stands and talks."),
    Clip("social-guidelines", "group_split", "A group that must not be split."),
    Clip("social-guidelines", "leading_human", "The robot leads a person."),
    Clip("social-guidelines", "perpendicular_traffic", "Traffic from the side."),
    Clip("social-guidelines", "circular_crossing", "Everyone crosses in the middle."),
    Clip("social-guidelines", "crowd_navigation", "A small crowd in a room."),
)


def main() -> int:
    """Film the wanted scenarios, and write the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", metavar="GLOB", default="*", help="film only these scenarios")
    given = parser.parse_args()
    FOLDER.mkdir(parents=True, exist_ok=True)
    for clip in CLIPS:
        if fnmatchcase(clip.scenario, given.only):
            film(clip)
            print(f"{clip.file.relative_to(ROOT)}: {clip.file.stat().st_size // 1024} KB")
    PAGE.write_text(page(), encoding="utf-8")
    size = sum(clip.file.stat().st_size for clip in CLIPS if clip.file.is_file())
    if size > MOST:
        raise SystemExit(f"the clips take {size} bytes, more than {MOST}")
    return 0


def film(clip: Clip) -> None:
    """Simulate the start of a run, and write its pictures."""
    scenario = crowdbot.load(
        clip.suite, clip.scenario, set={"robots.robot.task.time_limit": SECONDS}
    )
    with tempfile.TemporaryDirectory() as folder:
        run = crowdbot.simulate(
            scenario, planner=clip.planner, references=False, replay=False, record="none",
            metrics="success", out=folder, suite=clip.suite,
        )  # fmt: skip
        filmed = FilmedRun(tracks=(run.trajectories,), title="", width=WIDTH, legend=False)
        images = [*filmed.images(filmed.times(clip.start, None, RATE, SPEED))]
    first, *rest = images
    first.save(
        clip.file, save_all=True, append_images=rest, duration=round(1000 / RATE), loop=0,
        quality=QUALITY, method=4, minimize_size=True,
    )  # fmt: skip


def page() -> str:
    """Return the page of all clips, by suite."""
    lines = [
        "# Thirty scenarios in motion", "",
        f"The first {SECONDS:g} seconds of {len(CLIPS)} scenarios, {SPEED:g} times as fast, driven "
        "by `dwa`: people in blue with an arrow where they walk, the robot in orange with its "
        "path, its goal in green. `make pictures` films them again; the [gallery](gallery.md) has "
        "still pictures; `crowdbot export RUN_DIR --to webm` films a run of yours.",
    ]  # fmt: skip
    suite = ""
    for clip in CLIPS:
        if clip.suite != suite:
            suite = clip.suite
            lines += ["", f"## {suite}", "", "| clip | scenario |", "|---|---|"]
        picture = f"![{clip.text}](images/clips/{clip.file.name})"
        lines.append(f"| {picture} | `{clip.scenario}`: {clip.text} |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    sys.exit(main())
