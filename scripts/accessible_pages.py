"""Extension of Sphinx: mends pages for screen readers, and keeps some pages from the search.

When all pages are written, it goes through them. axe-core finds in pages of
furo 2025.12: headings without a level, unnamed asides, blocks that scroll but take no focus, header
cells without a text, and a search page without a heading.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

_MENDED = (
    ('<p class="caption" role="heading">', '<p class="caption" role="heading" aria-level="2">'),
    ('<aside class="sidebar-drawer">', '<aside class="sidebar-drawer" aria-label="All pages">'),
    ('<aside class="toc-drawer">', '<aside class="toc-drawer" aria-label="On this page">'),
    ('<div class="table-wrapper', '<div tabindex="0" class="table-wrapper'),
    ("<pre>", '<pre tabindex="0">'),
)
_HEADING = "<h1>Search</h1>\n"
_EMPTY_HEAD = re.compile(r'<th class="head">\s*(?:<p>\s*</p>)?\s*</th>')


def mended(page: str) -> str:
    """The text of a page, with what is missing in it."""
    for made, wanted in _MENDED:
        page = page.replace(made, wanted)
    if "<h1" not in page:
        page = page.replace('<div id="search-results">', f'{_HEADING}<div id="search-results">')
    return _EMPTY_HEAD.sub("<td></td>", page)


def _mend(app: Any, error: Exception | None) -> None:
    if error is None and app.builder.name == "html":
        for path in sorted(Path(app.outdir).rglob("*.html")):
            path.write_text(mended(path.read_text(encoding="utf-8")), encoding="utf-8")


def _leave_out(app: Any, env: Any) -> None:
    """Keep the pages that ``unsearched`` names by beginnings out of the index of the search."""
    for name in env.found_docs:
        if name.startswith(tuple(app.config.unsearched)):
            env.metadata[name]["nosearch"] = ""


def setup(app: Any) -> dict[str, bool]:
    """Called by Sphinx."""
    app.add_config_value("unsearched", (), "html")
    app.connect("env-updated", _leave_out)
    app.connect("build-finished", _mend)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
