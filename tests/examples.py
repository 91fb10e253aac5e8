"""How many examples of a property are tried where each is expensive."""

from __future__ import annotations

import os

from hypothesis import settings

#: `make test-all` and HYPOTHESIS_PROFILE=explore try all of them.
THOROUGH = bool(
    os.environ.get("CROWDBOT_ALL_TESTS") or os.environ.get("HYPOTHESIS_PROFILE") == "explore"
)


def costly(most: int) -> settings:
    """At most so many examples, a quarter of them in `make test`."""
    return settings(max_examples=most if THOROUGH else max(10, most // 4))
