"""A drawing on a page of its own: no script, no request, and the reader's light or dark."""

from __future__ import annotations

from markupsafe import Markup

from crowdbot.core.support.html_page import render_page
from crowdbot.core.view.shapes import Drawing
from crowdbot.core.view.svg import element, stylesheet


def to_html(drawing: Drawing) -> str:
    """One offline page; its policy allows its own style sheet, by hash, and nothing else."""
    return render_page(
        __package__,
        more_style=stylesheet(),
        title=drawing.title,
        facts=drawing.facts,
        svg=Markup(element(drawing)),
    )
