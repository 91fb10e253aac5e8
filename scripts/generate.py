"""Write everything that is made from the code and committed; ``make generate`` runs this.

Pages, tables and pictures come from models, metrics, robots and imports. JSON Schemas are written,
too, though not committed. A metric without a picture gets one by its function in
scripts/metric_pictures/, and is named if it has none. What is measured instead has commands of its
own: ``make pictures``, ``make coverage``, scripts/write_crowd_validation.py,
scripts/write_flow_validation.py and scripts/write_realism_reference.py.

Examples:
    .venv/bin/python scripts/generate.py
    .venv/bin/python scripts/generate.py --check   # write nothing; 1 if something is stale
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))  # as a script, too

from crowdbot.core.support.atomic_write import atomic_write  # noqa: E402
from scripts import (  # noqa: E402
    architecture,
    draw_robots,
    make_metric_pictures,
    write_author_surface,
    write_commands,
    write_conformance,
    write_endings,
    write_metric_index,
    write_planner_pages,
    write_planner_table,
    write_reference,
    write_rosetta_stone,
    write_schemas,
    write_study_page,
)
from scripts.fault_cases import draw as fault_cases  # noqa: E402

Texts = dict[Path, str]


def _page(path: Path, text: str) -> Texts:
    return {path: text}


def _rooms() -> Texts:
    page = architecture.PAGE
    text = page.read_text(encoding="utf-8")
    return _page(page, architecture.page_with_table(text, architecture.measure()))


def _endings() -> Texts:
    page = write_endings.PAGE
    return _page(page, write_endings.page(page.read_text(encoding="utf-8")))


#: What is made -> the texts of its files.
GENERATED: dict[str, Callable[[], Texts]] = {
    "fields of scenarios": write_reference.pages,
    "names for plugins": lambda: _page(
        write_author_surface.PAGE, write_author_surface.author_surface_page()
    ),
    "conformance checks": lambda: _page(write_conformance.PAGE, write_conformance.page()),
    "options of commands": lambda: _page(write_commands.PAGE, write_commands.page()),
    "parameters of planners": write_planner_pages.pages,
    "fields of studies": lambda: _page(write_study_page.PAGE, write_study_page.page()),
    "how planners did": lambda: _page(write_planner_table.PAGE, write_planner_table.page()),
    "list of metrics": lambda: _page(write_metric_index.PAGE, write_metric_index.page()),
    "pictures of metrics": make_metric_pictures.pages,
    "words of other simulators": lambda: _page(
        write_rosetta_stone.PAGE, write_rosetta_stone.page()
    ),
    "endings": _endings,
    "cases of fault": fault_cases.files,
    "rooms": _rooms,
    "robots from above": draw_robots.pictures,
}


def stale(what: str) -> Iterator[tuple[Path, str]]:
    """Yield each file of one kind that is not as it would be written, with its text."""
    for path, text in GENERATED[what]().items():
        if not path.is_file() or path.read_text(encoding="utf-8") != text:
            yield path, text


def main() -> int:
    """Write what is stale, or say it."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--check", action="store_true", help="write nothing; exit 1 if stale")
    check = parser.parse_args().check
    found = False
    for what in GENERATED:
        for path, text in stale(what):
            found = True
            print(f"{'stale' if check else 'wrote'}: {path.relative_to(ROOT)}")
            if not check:
                path.parent.mkdir(parents=True, exist_ok=True)
                atomic_write(path, text)
    if check:
        return int(found)
    make_metric_pictures.draw_missing()
    write_schemas.write()
    return 0


if __name__ == "__main__":
    sys.exit(main())
