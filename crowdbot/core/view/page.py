"""A drawing on a page of its own: no script, no request, and the reader's light or dark."""

from __future__ import annotations

import base64
import hashlib
from importlib import resources

import jinja2
from markupsafe import Markup

from crowdbot.core.view.shapes import Drawing
from crowdbot.core.view.svg import element, stylesheet


def to_html(drawing: Drawing) -> str:
    """One offline page; its policy allows its own style sheet, by hash, and nothing else."""
    style = f"{_asset('page.css')}\n{stylesheet()}"
    digest = base64.b64encode(hashlib.sha256(style.encode()).digest()).decode("ascii")
    template = jinja2.Environment(
        autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True, lstrip_blocks=True
    ).from_string(_asset("page.html.j2"))
    return template.render(
        title=drawing.title,
        facts=drawing.facts,
        policy=f"default-src 'none'; style-src 'sha256-{digest}'; base-uri 'none'; "
        "form-action 'none'",
        style=Markup(style),
        svg=Markup(element(drawing)),
    )


def _asset(name: str) -> str:
    return resources.files(__package__).joinpath(name).read_text(encoding="utf-8")
