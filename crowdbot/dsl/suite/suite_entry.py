"""SuiteEntry: a scenario's place in its suite, and the changes that ``--set`` made to it."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from crowdbot.dsl.suite.axis_words import AxisWords

#: Longest readable part of a folder's suffix, bytes.
_LONGEST = 60
#: Suite of all documents with a single scenario.
NO_SUITE = "scenarios"
_DIGEST = re.compile(r"\+[0-9a-f]{4}(?=\+|$)")
_UNSAFE = re.compile(r"[^\w.=-]+")


@dataclass(frozen=True, slots=True, kw_only=True)
class SuiteEntry:
    """A scenario's place in its suite, as stored in the records of its runs.

    Attributes:
        suite: id of the suite; ``scenarios`` for a document with a single scenario.
        axes: axis of the suite -> label, in the suite's order.
        words: axis -> quantity that it varies and the value here, in words.
        position: of the scenario in the suite.
        altered: the ``key=value`` texts with which the scenario was changed.
    """

    suite: str = NO_SUITE
    axes: Mapping[str, str] = field(default_factory=dict)
    words: Mapping[str, AxisWords] = field(default_factory=dict)
    position: int = 0
    altered: Sequence[str] = ()

    def folder(self, scenario: str) -> str:
        """Return the folder of a scenario's runs; its name contains the changes by ``--set``.

        Args:
            scenario: its id, with the digest of what was altered.
        """
        digest = altered_digest(scenario) if self.altered else ""
        name = scenario.replace(digest, altered_suffix(self.altered), 1) if digest else scenario
        return f"{self.suite}/{name}"


#: The entry of a scenario that comes from no suite.
IN_NO_SUITE = SuiteEntry()


def altered_suffix(overrides: Sequence[str]) -> str:
    """Return ``+``, the changes in words, and their digest; empty without changes.

    Only the last part of each key is shown: ``+time_limit=2-1f3a``.
    """
    if not overrides:
        return ""
    shown = [text.partition("=") for text in overrides]
    words = [f"{key.strip().rpartition('.')[2]}={value.strip()}" for key, _, value in shown]
    name = "+" + "+".join(_UNSAFE.sub("_", word) for word in words)
    kept = name.encode()[:_LONGEST].decode(errors="ignore")
    return f"{kept}-{digest_of(overrides)}"


def altered_digest(scenario: str) -> str:
    """Return the suffix of a scenario's id for changes, such as ``+1f3a``; empty without."""
    found = _DIGEST.search(scenario)
    return found.group() if found else ""


def digest_of(overrides: Sequence[str]) -> str:
    """Return four hexadecimal digits, a hash of the changes in a scenario's id."""
    return hashlib.sha256("\n".join(overrides).encode()).hexdigest()[:4]
