"""Draws docs/images/metrics: what each metric measures, from one run.

The scenario is scripts/metric_pictures/metrics.yaml, the planner drives beside it. Equal runs give
equal pictures, except for those of the time that planner steps take.

Examples:
    .venv/bin/python scripts/make_metric_pictures.py
    .venv/bin/python scripts/make_metric_pictures.py --runs kept
"""

from __future__ import annotations

import argparse
import re
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

import crowdbot

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))  # as a script, too

from scripts.metric_pictures import near, people, person, robot  # noqa: E402
from scripts.metric_pictures.registry import DRAWINGS  # noqa: E402
from scripts.metric_pictures.world import World, all_metrics  # noqa: E402
from scripts.write_metric_cards import with_declared, with_parameters  # noqa: E402

DRAWN = (near, people, person, robot)
HERE = Path(__file__).parent / "metric_pictures"
IMAGES = ROOT / "docs" / "images" / "metrics"
PAGES = ROOT / "docs" / "reference" / "metrics"


def main() -> int:
    """Make the run and draw all pictures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=Path, help="folder that keeps the run")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        draw(given.runs or Path(folder))
    return 0


def draw_missing() -> None:
    """Draw the metrics that have no picture yet; name those that nothing draws."""
    for metric in sorted(set(all_metrics()) - set(DRAWINGS)):
        print(f"{metric} has no drawing: write one with @draws in scripts/metric_pictures/")
    missing = [metric for metric in DRAWINGS if not (IMAGES / f"{metric}.svg").is_file()]
    if missing:
        with tempfile.TemporaryDirectory() as folder:
            draw(Path(folder), missing)


def draw(runs: Path, metrics: Sequence[str] = tuple(DRAWINGS)) -> None:
    """Draw pictures from a run below ``runs``, which is made if it is not there."""
    scenario = crowdbot.load(HERE / "metrics.yaml", "metric-pictures")
    planner = f"{HERE / 'sidestep.py'}:Sidestep"
    made = crowdbot.simulate(scenario, planner=planner, seed=0, out=runs)
    world = World.of(made)
    IMAGES.mkdir(parents=True, exist_ok=True)
    for metric in metrics:
        figure = DRAWINGS[metric].draw(world, metric)
        (IMAGES / f"{metric}.svg").write_text(figure.svg(), encoding="utf-8")


def pages() -> dict[Path, str]:
    """Return file -> text of each metric's page with its picture, declared cells and parameters."""
    found = {}
    for metric in DRAWINGS:
        page = PAGES / f"{metric}.md"
        card = with_declared(page.read_text(encoding="utf-8"), metric)
        card = with_parameters(card, metric)
        found[page] = with_picture(card, metric)
    return found


def with_picture(page: str, metric: str) -> str:
    """A metric's page with its picture before the formula."""
    line = f"![{DRAWINGS[metric].shows}](../../images/metrics/{metric}.svg)\n\n"
    bare = re.sub(r"^!\[.*\]\(../../images/metrics/.*\)\n\n", "", page, flags=re.MULTILINE)
    return bare.replace("## Formula\n", f"{line}## Formula\n", 1)


def entry(metric: str) -> str:
    """A metric's picture in the list of all, below a link to its page."""
    shows = DRAWINGS[metric].shows
    return f"[{metric}](metrics/{metric}.md)\n\n![{shows}](../images/metrics/{metric}.svg)\n"


if __name__ == "__main__":
    sys.exit(main())
