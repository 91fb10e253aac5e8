"""One HTML page in one file, without network requests.

A package contains ``page.html.j2``, ``page.css`` and scripts. The page's content security policy
allows only its own style sheet and script, by hash.
"""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Sequence
from functools import cache
from importlib import resources
from typing import Any

import jinja2
from markupsafe import Markup


def render_page(
    package: str,
    *,
    scripts: Sequence[str] = (),
    more_style: str = "",
    images: str = "",
    frames: bool = False,
    **values: Any,
) -> str:
    """Render the page of a package; equal input gives equal text.

    Args:
        package: the package with the parts.
        scripts: names of its script files, in order.
        more_style: rules to add to ``page.css``.
        images: sources of generated images, such as ``blob:``.
        frames: True if the page may embed others from its own site or folder.
        values: further variables of the template, besides ``policy``, ``style`` and ``script``.
            Text is escaped.
    """
    style = "\n".join(filter(None, [_part(package, "page.css"), more_style]))
    script = "\n".join(_part(package, name) for name in scripts)
    return _template(package).render(
        policy=_policy(style, script, images, frames=frames),
        style=Markup(style),
        script=Markup(script),
        **values,
    )


@cache
def _template(package: str) -> jinja2.Template:
    return jinja2.Environment(
        autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True, lstrip_blocks=True
    ).from_string(_part(package, "page.html.j2"))


@cache
def _policy(style: str, script: str, images: str, *, frames: bool) -> str:
    scripts = f"script-src {_hash(script)}; " if script else ""
    pictures = f"img-src {images}; " if images else ""
    opened = "frame-src 'self'; " if frames else ""
    return (
        f"default-src 'none'; {scripts}style-src {_hash(style)}; {pictures}{opened}"
        "base-uri 'none'; form-action 'none'"
    )


def _hash(text: str) -> str:
    digest = base64.b64encode(hashlib.sha256(text.encode()).digest()).decode("ascii")
    return f"'sha256-{digest}'"


@cache
def _part(package: str, name: str) -> str:
    return resources.files(package).joinpath(name).read_text(encoding="utf-8")
