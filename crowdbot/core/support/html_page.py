"""One HTML page in one file, without network requests.

A package contains ``page.html.j2``, ``page.css`` and scripts. The page's content security policy
allows only its own style sheet and scripts, by hash.
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
    connect: str = "",
    forms: bool = False,
    later: Sequence[str] = (),
    **values: Any,
) -> str:
    """Render the page of a package; equal input gives equal text.

    Args:
        package: the package with the parts.
        scripts: names of its script files, in order; ``PACKAGE:NAME`` is of another package.
        more_style: rules to add to ``page.css``.
        images: sources of generated images, such as ``blob:``.
        frames: True if the page may embed others from its own site or folder.
        connect: addresses that it may connect to.
        forms: True if its forms go to its own server.
        later: scripts that it may add to itself later.
        values: further variables of the template, besides ``policy``, ``style`` and ``script``.
            Text is escaped.
    """
    style = "\n".join(filter(None, [_part(package, "page.css"), more_style]))
    script = "\n".join(_part(package, name) for name in scripts)
    return _template(package).render(
        policy=_policy(style, (script, *later), images, connect, frames=frames, forms=forms),
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
def _policy(
    style: str,
    scripts: tuple[str, ...],
    images: str,
    connect: str,
    *,
    frames: bool,
    forms: bool,
) -> str:
    hashes = " ".join(_hash(script) for script in scripts if script)
    allowed = f"script-src {hashes}; " if hashes else ""
    pictures = f"img-src {images}; " if images else ""
    opened = "frame-src 'self'; " if frames else ""
    answered = "'self'" if forms else "'none'"
    links = f"connect-src {connect}; " if connect else ""
    return (
        f"default-src 'none'; {allowed}style-src {_hash(style)}; {pictures}{opened}{links}"
        f"base-uri 'none'; form-action {answered}"
    )


def _hash(text: str) -> str:
    digest = base64.b64encode(hashlib.sha256(text.encode()).digest()).decode("ascii")
    return f"'sha256-{digest}'"


@cache
def _part(package: str, name: str) -> str:
    other, colon, rest = name.partition(":")
    place, name = (other, rest) if colon else (package, name)
    return resources.files(place).joinpath(name).read_text(encoding="utf-8")
