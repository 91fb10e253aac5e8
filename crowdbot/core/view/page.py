"""A drawing on its own page, without scripts or requests, in the reader's light or dark mode."""

from __future__ import annotations

from markupsafe import Markup

from crowdbot.core.support.html_page import render_page
from crowdbot.core.view.shapes import Drawing
from crowdbot.core.view.svg import element, stylesheet
from crowdbot.dsl.identity.canonical import PREFIX


def to_html(drawing: Drawing) -> str:
    """Return one offline page; its policy allows only its own style sheet, by hash."""
    return render_page(
        __package__,
        more_style=stylesheet(),
        title=drawing.title,
        facts=drawing.facts,
        hashes={n: text for n, text in drawing.facts.items() if text.startswith(PREFIX)},
        svg=Markup(element(drawing)),
    )
