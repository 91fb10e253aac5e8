"""Let libraries read their own files as UTF-8 where the locale has another encoding.

Drake opens Python files of its own with the locale's encoding. In ASCII it cannot be imported.
"""

from __future__ import annotations

import codecs
import locale
from contextlib import suppress

_UTF8 = ("C.UTF-8", "C.utf8", "en_US.UTF-8", "UTF-8")


def use_utf8() -> None:
    """Set the encoding of characters to UTF-8, if it is not; other parts of the locale stay."""
    try:
        if codecs.lookup(locale.getencoding()).name == "utf-8":
            return
    except LookupError:
        pass  # a codec that Python lacks
    for name in _UTF8:
        with suppress(locale.Error):
            locale.setlocale(locale.LC_CTYPE, name)
            return
