"""Write the replay page of one run, or of several side by side."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from crowdbot.core.replay.encode import encode, summary
from crowdbot.core.replay.scores import compared
from crowdbot.core.replay.shown_run import ShownRun
from crowdbot.core.replay.three import three_packed, three_source
from crowdbot.core.support.atomic_write import atomic_write
from crowdbot.core.support.html_page import Allowed, render_page
from crowdbot.core.types.ending import ending_style

_SCRIPTS = (
    "script/element.js", "script/decode.js", "script/motion.js", "script/sensing.js",
    "script/gaps.js", "script/colours.js", "script/scenery.js", "script/people.js",
    "script/robots.js", "script/sensors.js", "script/ghosts.js", "script/contacts.js",
    "script/thoughts.js",
    "script/canvas.js", "script/views.js", "script/timeline.js", "script/series.js",
    "script/solid_load.js", "script/solid_place.js", "script/solid_figures.js",
    "script/solid_bodies.js",
    "script/solid_people.js",
    "script/solid_robots.js", "script/solid_marks.js", "script/solid_signs.js",
    "script/solid_eye.js", "script/solid.js", "script/solid_xr.js", "script/solid_view.js",
    "script/plots.js", "script/cameras.js", "script/events.js", "script/legend.js",
    "script/readout.js",
    "script/pointers.js", "script/follow.js", "script/address.js", "script/player.js",
    "script/picture.js", "script/gif.js", "script/clip.js", "script/paper.js",
    "script/others.js", "script/controls.js", "script/app.js",
)  # fmt: skip

#: What `scenario_words` adds about one run; several runs of a scenario differ in it.
_REALISED = re.compile(r", \S+ in this run")


def write_replay(path: Path, *shown: ShownRun, title: str = "") -> None:
    """Write one offline HTML page; equal input gives equal bytes.

    Args:
        path: the file, written atomically.
        shown: the run; several runs have separate views and a common clock.
        title: heading; default: that of the first run.

    Raises:
        InputError: the path cannot be written.
    """
    atomic_write(path, _render(shown, title or shown[0].title))


def _render(shown: Sequence[ShownRun], title: str) -> str:
    packed = [encode(one) for one in shown]
    names = sorted({name for one in shown for name in _facts(one)}, key=_order(shown))
    return render_page(
        __package__,
        scripts=_SCRIPTS,
        styles=("base.css", "page.css"),
        more_style=ending_style(),
        allowed=Allowed(frames=True, later=(three_source(),)),
        three=three_packed(),
        title=title,
        words=_words(shown),
        labels=[one.label or one.title for one in shown],
        statuses=[one.status for one in shown],
        facts={name: [_facts(one).get(name, "–") for one in shown] for name in names},
        groups=compared([one.scores for one in shown]),
        meta={"runs": [meta for meta, _ in packed]},
        blobs={
            f"{i}-{n}": text for i, (_, blobs) in enumerate(packed) for n, text in blobs.items()
        },
    )


def _words(shown: Sequence[ShownRun]) -> list[str]:
    """Return what the scenarios' names mean; realised densities only where all runs agree."""
    found: dict[str, set[str]] = {}
    for words in filter(None, (one.words for one in shown)):
        found.setdefault(_REALISED.sub("", words), set()).add(words)
    return [texts.pop() if len(texts) == 1 else name for name, texts in found.items()]


def _facts(shown: ShownRun) -> dict[str, str]:
    facts = {k: v for k, v in shown.facts.items() if k.lower() != "status"}
    return facts | dict(summary(shown.run))


def _order(shown: Sequence[ShownRun]) -> Any:
    """Return a sort key that puts facts in the order of the first run that has them."""
    names: dict[str, int] = {}
    for one in shown:
        for name in _facts(one):
            names.setdefault(name, len(names))
    return names.__getitem__
