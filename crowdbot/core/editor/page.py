"""The page of the editor: one HTML text that talks to its own server alone."""

from __future__ import annotations

from crowdbot.core.support.html_page import Allowed, render_page

_SCRIPTS = ("geometry.js", "items.js", "sheet.js", "talk.js", "tools.js", "app.js")


def page(name: str, token: str) -> str:
    """Return the page for one file.

    Args:
        name: name of the file.
        token: token of the server.
    """
    return render_page(
        "crowdbot.core.editor",
        scripts=_SCRIPTS,
        allowed=Allowed(connect="'self'"),
        name=name,
        token=token,
    )
