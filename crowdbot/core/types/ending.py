"""Endings of a run in one table: names, order, texts, colours, and which count as failures."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from enum import StrEnum


class Ending(StrEnum):
    """The ending of a run, or of an attempt to make one, by its name in ``run.json``.

    Tables show endings in this order; the ending of a run of several robots is the last one that
    one of its robots has.

    Attributes:
        past: what such runs did, to follow their number.
        sentence: one such run in a line; ``{t}`` is when it ended, s.
        colour: in pages, as CSS.
        happened: what decided such a run, as a clause; empty: `crowdbot why` searches for it.
        failed: statistics rank such a run below all others, commands end with exit code 3, and
            ``campaign --retry-failed`` repeats it.
        complete: a ``run.json`` may have this status; one of a scenario without a robot has
            ``timeout``, which results and pages call ``people_alone``.
    """

    past: str
    sentence: str
    colour: str
    happened: str
    failed: bool
    complete: bool

    def __new__(  # noqa: D102
        cls,
        word: str,
        past: str = "",
        sentence: str = "",
        colour: str = "",
        happened: str = "",
        failed: bool = False,
        complete: bool = True,
    ) -> Ending:
        self = str.__new__(cls, word)
        self._value_ = word
        self.past, self.sentence, self.colour = past, sentence, colour
        self.happened, self.failed, self.complete = happened, failed, complete
        return self

    ARRIVED = (
        "arrived", "arrived", "arrived after {t:.1f} s", "light-dark(#2a7f4f, #4cc77f)",
    )  # fmt: skip
    TIMEOUT = (
        "timeout", "ran out of time", "did not arrive within {t:.1f} s",
        "light-dark(#c98a00, #e3b341)",
    )  # fmt: skip
    TOPPLED = (
        "toppled", "ended because the robot toppled", "toppled at {t:.1f} s",
        "light-dark(#8a4fa3, #c690de)", "the robot toppled",
    )  # fmt: skip
    PLANNER_FAILED = (
        "planner_failed", "ended because the planner failed", "planner failed at {t:.1f} s",
        "light-dark(#b3261e, #ff7a6e)", "the planner failed", True,
    )  # fmt: skip
    PEOPLE_ALONE = (
        "people_alone", "showed people alone", "people walked alone for {t:.1f} s",
        "light-dark(#3a6ea5, #7db4e6)", "", False, False,
    )  # fmt: skip
    INTERRUPTED = (
        "interrupted", "were interrupted", "interrupted at {t:.1f} s",
        "light-dark(#62676e, #a0a7af)", "", False, False,
    )  # fmt: skip
    NO_RUN = (
        "failed", "could not be made", "could not be made", "light-dark(#22262b, #e8e6e1)", "",
        True, False,
    )  # fmt: skip

    @property
    def heading(self) -> str:
        """Return the heading of a column."""
        return self.name.lower().replace("_", " ")


#: Endings of complete runs.
COMPLETE = tuple(ending for ending in Ending if ending.complete)
#: Endings of complete runs and of attempts that left no run, for tables of attempts.
ATTEMPTED = (*COMPLETE, Ending.PEOPLE_ALONE, Ending.NO_RUN)


def shown(counts: Mapping[str, int]) -> tuple[Ending, ...]:
    """Return the endings of a table of attempts: people alone only where there are such runs."""
    return tuple(e for e in ATTEMPTED if e != Ending.PEOPLE_ALONE or counts.get(e, 0))


def of_several(statuses: Iterable[str]) -> Ending:
    """Return the ending of a run from those of its robots: the last one in the table."""
    return max(map(Ending, statuses), key=_ORDER.index)


_ORDER = tuple(Ending)
_FAILED = frozenset(ending for ending in Ending if ending.failed)


def has_failed(status: str) -> bool:
    """Return True if a run with this status counts as failed; an unknown word does not."""
    return status in _FAILED


def ending_style() -> str:
    """Return CSS that gives each element with ``data-ending`` the colour of its ending."""
    return "\n".join(f'[data-ending="{e}"] {{ --ending: {e.colour}; }}' for e in Ending)
