"""The page of explanations: sentences and strips of pictures, in one file."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any
from urllib.parse import quote

from markupsafe import Markup

from crowdbot.core.support.html_page import render_page
from crowdbot.core.view.svg import element, stylesheet
from crowdbot.core.why.explain import CauseCount, Explanation
from crowdbot.core.why.strip import strip


def render(
    title: str, shown: Sequence[Explanation], counts: Sequence[CauseCount], out: Path
) -> str:
    """Return the page as text.

    Args:
        title: its heading.
        shown: runs with their pictures.
        counts: causes of a campaign, before the runs.
        out: file of the page, to which links to replays are relative.
    """
    return render_page(
        __package__,
        styles=("crowdbot.core.support:plain_page.css", "page.css"),
        more_style=stylesheet(),
        title=title,
        counts=[c.line for c in counts],
        runs=[_section(one, k, out) for k, one in enumerate(shown)],
    )


def _section(one: Explanation, number: int, out: Path) -> dict[str, Any]:
    pictures = enumerate(strip(one.run, one.moment))
    return {
        "title": one.title,
        "sentences": one.sentences,
        "replay": "" if one.replay is None else _link(one.replay, out),
        "pictures": [Markup(element(p, name=f"-{number}-{k}")) for k, p in pictures],
    }


def _link(replay: Path, out: Path) -> str:
    here = out.resolve().parent
    return quote(Path(os.path.relpath(replay.resolve(), here)).as_posix())
