"""One HTML page in one file, without network requests.

A package contains ``page.html.j2``, ``page.css`` and scripts. The page's content security policy
allows only its own style sheet and scripts, by hash.
"""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Any

import jinja2
from markupsafe import Markup


@dataclass(frozen=True, slots=True, kw_only=True)
class Allowed:
    """Permissions of a page besides running its own scripts; none by default.

    Attributes:
        images: sources of generated images, such as ``blob:``.
        frames: True if it may embed others from its own site or folder.
        connect: addresses that it may connect to.
        forms: True if its forms go to its own server.
        later: scripts that it may add to itself later.
    """

    images: str = ""
    frames: bool = False
    connect: str = ""
    forms: bool = False
    later: tuple[str, ...] = ()


#: A page that only shows.
_NOTHING = Allowed()


def render_page(
    package: str,
    *,
    scripts: Sequence[str] = (),
    styles: Sequence[str] = ("page.css",),
    more_style: str = "",
    allowed: Allowed = _NOTHING,
    **values: Any,
) -> str:
    """Render the page of a package; equal input gives equal text.

    Args:
        package: the package with the parts.
        scripts: names of its script files, in order; ``PACKAGE:NAME`` is of another package.
        styles: names of its style sheets, in the same way.
        more_style: rules to add to them.
        allowed: what the page may do.
        values: further variables of the template, besides ``policy``, ``style`` and ``script``.
            Text is escaped.
    """
    sheets = (_part(package, name) for name in styles)
    style = "\n".join(filter(None, [*sheets, more_style]))
    script = "\n".join(_part(package, name) for name in scripts)
    return _template(package).render(
        policy=_policy(style, script, allowed),
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
def _policy(style: str, script: str, allowed: Allowed) -> str:
    hashes = " ".join(_hash(text) for text in (script, *allowed.later) if text)
    scripts = f"script-src {hashes}; " if hashes else ""
    pictures = f"img-src {allowed.images}; " if allowed.images else ""
    opened = "frame-src 'self'; " if allowed.frames else ""
    answered = "'self'" if allowed.forms else "'none'"
    links = f"connect-src {allowed.connect}; " if allowed.connect else ""
    return (
        f"default-src 'none'; {scripts}style-src {_hash(style)}; {pictures}{opened}{links}"
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
